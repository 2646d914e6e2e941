//! Why a viewer did not do what it was asked for.

use std::fmt;

use rara::Error;

/// Why a viewer did not do what it was asked for.
#[derive(Debug)]
pub enum Failure {
    /// There is nothing like what was asked for, as a layer of a name.
    Asked(String),
    /// A step of the script could not be done.
    Script(String),
    /// The work failed.
    Work(Error),
}

impl Failure {
    /// True when the failure is only that a file could not be written.
    pub(super) fn concerns_a_file(&self) -> bool {
        matches!(self, Self::Work(Error::Io { .. } | Error::Format { .. }))
    }

    /// True when it is a failure of a scene, so that another may be shown.
    pub(super) fn is_of_the_scene(&self) -> bool {
        matches!(
            self,
            Self::Asked(_)
                | Self::Work(
                    Error::Io { .. } | Error::Format { .. } | Error::Invalid(_) | Error::Memory(_)
                )
        )
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Work(error)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Asked(message) | Self::Script(message) => f.write_str(message),
            Self::Work(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Failure {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_outlives_a_file_that_cannot_be_written_and_nothing_else() {
        let concerns_a_file = |error: Error| Failure::from(error).concerns_a_file();
        let disk = Error::io("a.png")(std::io::Error::other("the disk is full"));
        assert!(concerns_a_file(disk));
        assert!(concerns_a_file(Error::format("a.png", "no folder")));
        for fatal in [
            Error::Validation(vec!["a hazard".into()]),
            Error::Device("the window was lost".into()),
            Error::DeviceLost {
                call: "vkWaitForFences",
            },
            Error::Memory("none is left".into()),
        ] {
            assert!(!concerns_a_file(fatal));
        }
    }
}
