//! Why a command did not do its work, as a sentence and an exit status.

use std::fmt;
use std::process::ExitCode;

use super::output::{counted, program};

#[derive(Debug)]
pub enum Failure {
    /// The command line is wrong: exit status 2.
    Usage(String),
    /// Clap's help, asked for by typing nothing: exit status 2.
    Help(clap::Error),
    /// The work failed: exit status 1.
    Work(rara::Error),
}

impl Failure {
    /// A failure for library errors that the command line has caused.
    pub(super) fn usage(error: impl fmt::Display) -> Self {
        Self::Usage(error.to_string())
    }

    /// The same failure of a part of the work that has a name.
    pub(super) fn in_job(self, name: &str) -> Self {
        match self {
            Self::Usage(message) => Self::Usage(format!("{name}: {message}")),
            Self::Work(error) if !matches!(error, rara::Error::Validation(_)) => {
                Self::Work(rara::Error::Invalid(format!("{name}: {}", chain(&error))))
            }
            other => other,
        }
    }

    /// The lines before the failure itself: every message of the validation layer.
    pub(super) fn details(&self) -> impl Iterator<Item = String> {
        let messages = match self {
            Self::Work(rara::Error::Validation(messages)) => messages.as_slice(),
            _ => &[],
        };
        messages
            .iter()
            .map(|message| format!("validation: {}", folded(message)))
    }

    pub(super) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Usage(_) | Self::Help(_) => ExitCode::from(2),
            Self::Work(_) => ExitCode::FAILURE,
        }
    }
}

impl From<rara::Error> for Failure {
    fn from(error: rara::Error) -> Self {
        Self::Work(error)
    }
}

impl From<clap::Error> for Failure {
    fn from(error: clap::Error) -> Self {
        if error.kind() == clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Self::Help(error);
        }
        Self::Usage(one_line(&error.to_string()))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Usage(message) => write!(f, "{}: {message}", program()),
            Self::Help(help) => write!(f, "{help}"),
            Self::Work(rara::Error::Validation(messages)) => write!(
                f,
                "{}: the validation layer had something to say, {}, see above; this is a fault of rara or of \
                 the driver: please report it",
                program(),
                counted(messages.len() as u64, "time")
            ),
            Self::Work(error) => write!(f, "{}: {}", program(), chain(error)),
        }
    }
}

/// What the standard library says of numbers that it cannot read, and what is said in its place.
const NUMBERS: [(&str, &str); 5] = [
    ("invalid digit found in string", "expected a whole number"),
    (
        "cannot parse integer from empty string",
        "expected a whole number",
    ),
    (
        "number too large to fit in target type",
        "this number is too large",
    ),
    (
        "number too small to fit in target type",
        "this number is too small",
    ),
    ("invalid float literal", "expected a number"),
];

/// Clap's message without its layout: what is wrong and its tip, but not the usage and the pointer to `--help`.
fn one_line(message: &str) -> String {
    let said = NUMBERS
        .iter()
        .fold(message.to_owned(), |text, (theirs, ours)| {
            text.replace(theirs, ours)
        });
    let message = said.strip_prefix("error: ").unwrap_or(&said);
    let parts = message
        .split("\n\n")
        .filter(|part| !part.starts_with("Usage:") && !part.starts_with("For more information"));
    let lines: Vec<String> = parts.map(folded).filter(|part| !part.is_empty()).collect();
    lines.join("; ")
}

/// A text on one line.
fn folded(text: impl AsRef<str>) -> String {
    let words: Vec<_> = text.as_ref().split_whitespace().collect();
    words.join(" ")
}

/// An error and its causes on one line; a cause that its effect already quotes is not repeated.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        let cause_text = cause.to_string();
        if !text.contains(&cause_text) {
            text = format!("{text}: {cause_text}");
        }
        source = cause.source();
    }
    text
}

#[cfg(test)]
mod tests;
