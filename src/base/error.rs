//! One error type for the whole crate: what is wrong, where, and what to do about it.

use std::path::PathBuf;

/// Everything that can go wrong for reasons the caller could not foresee.
///
/// The text of each error is one or two plain sentences that name the place (file, byte, line or element) and the
/// remedy. Misuse of the library panics with a sentence instead; repairable data is repaired, counted and reported by the
/// loader.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be opened, read or written.
    #[error("{path}: {source}{}", remedy(source), path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// A file was read, but its content cannot be used.
    #[error("{path}: {message}", path = path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The mistake, its place in the file, and the remedy.
        message: String,
    },
    /// The caller asked for something that is not possible, for example a clip plane with a zero normal.
    #[error("{0}")]
    Invalid(String),
    /// No Vulkan device can be used, or the chosen device does not have a required feature.
    #[error("{0}")]
    Device(String),
    /// The device was lost. Nothing on it can be used any more: what was made from it is dropped, then the device, and
    /// whoever goes on does so with another one.
    #[error(
        "the device was lost ({call}): the driver crashed, was reset or stopped a submission that ran too long; \
         nothing on this device can be used any more"
    )]
    DeviceLost {
        /// The call that reported it.
        call: &'static str,
    },
    /// A Vulkan call failed.
    #[error("{call} failed: {text}")]
    Vulkan {
        /// The call.
        call: &'static str,
        /// Its result code, a negative `VkResult`.
        code: i32,
        /// The sentence that Vulkan has for that code.
        text: String,
    },
    /// The device does not have enough free memory for the request.
    #[error("{0}")]
    Memory(String),
    /// The request would take more device memory than `Device::set_memory_budget` allows. Nothing was allocated.
    #[error("{0}")]
    Budget(String),
    /// The validation layer reported something; the messages are the layer's own.
    #[error("the validation layer reported {} message(s); the first: {}", .0.len(), .0.first().map_or("", |m| m.as_str()))]
    Validation(Vec<String>),
}

impl Error {
    /// This error after the messages of the validation layer, which are likely its cause.
    #[doc(hidden)]
    pub fn after(self, mut messages: Vec<String>) -> Self {
        if messages.is_empty() {
            return self;
        }
        messages.push(self.to_string());
        Self::Validation(messages)
    }

    /// Fails if the validation layer has reported anything.
    #[doc(hidden)]
    pub fn validated(messages: Vec<String>) -> Result<()> {
        if messages.is_empty() {
            Ok(())
        } else {
            Err(Self::Validation(messages))
        }
    }

    /// Returns a function for `map_err` that makes an [`Error::Io`] for `path`.
    pub fn io(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { path, source }
    }

    /// Returns an [`Error::Format`] for `path`. It is one line of bounded length, whatever the message quotes of a file: of
    /// more than a thousand characters the middle is left out, and control characters are escaped.
    pub fn format(path: impl Into<PathBuf>, message: impl Into<String>) -> Self {
        Self::Format {
            path: path.into(),
            message: on_a_line(&message.into(), 1000),
        }
    }
}

/// What to do about an operating system's error, where that is known.
fn remedy(error: &std::io::Error) -> &'static str {
    use std::io::ErrorKind as Kind;
    match error.kind() {
        Kind::NotFound => "; check the name",
        Kind::PermissionDenied => "; ask for the right to it, or name another place",
        Kind::ReadOnlyFilesystem => "; name a place that can be written to",
        Kind::StorageFull | Kind::QuotaExceeded => "; make room, or name another place",
        Kind::InvalidFilename => "; give it a shorter or simpler name",
        Kind::OutOfMemory => "; end other programs, or raise what this one may take",
        _ => "",
    }
}

/// The crate's result type.
pub type Result<T> = std::result::Result<T, Error>;

/// A text whose control characters are escaped, of which the middle is left out where it has more than so many characters.
pub fn on_a_line(text: &str, most: usize) -> String {
    let count = text.chars().count();
    let (first, last) = match count > most {
        true => (most * 2 / 3, most / 3 - 5),
        false => (count, 0),
    };
    let mut line = String::new();
    let mut add = |c: char| match c.is_control() {
        true => line.extend(c.escape_debug()),
        false => line.push(c),
    };
    text.chars().take(first).for_each(&mut add);
    if count > most {
        " ... ".chars().for_each(&mut add);
        text.chars().skip(count - last).for_each(&mut add);
    }
    line
}

/// At most the first 60 characters of what a file says, control characters escaped, to quote in a message.
pub fn shortened(text: &str) -> String {
    let mut quoted: String = text.chars().take(60).flat_map(char::escape_debug).collect();
    if text.chars().nth(60).is_some() {
        quoted.push_str("...");
    }
    quoted
}
