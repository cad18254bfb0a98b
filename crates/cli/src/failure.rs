//! Errors of commands: a message and an exit code.

use std::fmt::Display;
use std::io;

/// Wrong usage or bad input.
pub(crate) const USAGE: u8 = 64;
/// Nothing was selected.
pub(crate) const NOTHING: u8 = 4;
/// The run is incomplete.
pub(crate) const INCOMPLETE: u8 = 3;
/// Only improvements.
pub(crate) const IMPROVED: u8 = 2;
/// An unexpected bad result.
pub(crate) const UNEXPECTED: u8 = 1;

/// The reason for which a command ended early.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The reader closed standard output.
    Closed,
    /// An error that is printed.
    Message {
        /// The exit code.
        code: u8,
        /// The message.
        message: String,
    },
}

impl Failure {
    pub(crate) fn usage(message: impl Display) -> Self {
        Self::Message {
            code: USAGE,
            message: message.to_string(),
        }
    }

    pub(crate) fn incomplete(message: impl Display) -> Self {
        Self::Message {
            code: INCOMPLETE,
            message: message.to_string(),
        }
    }

    pub(crate) fn nothing(message: impl Display) -> Self {
        Self::Message {
            code: NOTHING,
            message: message.to_string(),
        }
    }
}

impl From<io::Error> for Failure {
    /// Converts an error of writing to standard output.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::Closed
        } else {
            Self::incomplete(format!("cannot write the output: {error}"))
        }
    }
}
