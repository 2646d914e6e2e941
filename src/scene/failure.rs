//! Why no scene was read from a file.

use std::io;
use std::path::Path;

use rara_base::error::Error;

pub(super) enum Failure {
    Io(io::Error),
    /// What is wrong with the file.
    Format(String),
    /// There is no memory for this.
    Memory(String),
    /// What is wrong with a file beside it.
    Other(Error),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self::Format(message)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Other(error)
    }
}

impl Failure {
    /// The error that it is in a file of this name.
    pub(super) fn error_in(self, name: &Path) -> Error {
        match self {
            Self::Io(error) => Error::io(name)(error),
            Self::Format(message) => Error::format(name, message),
            Self::Memory(what) => Error::Memory(format!(
                "{}: no memory for {what}; free some or split the file",
                name.display()
            )),
            Self::Other(error) => error,
        }
    }
}
