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

/// The error that ended a command early.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The exit code.
    pub(crate) code: u8,
    /// The message, which is printed.
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn usage(message: impl Display) -> Self {
        Self {
            code: USAGE,
            message: message.to_string(),
        }
    }

    pub(crate) fn incomplete(message: impl Display) -> Self {
        Self {
            code: INCOMPLETE,
            message: message.to_string(),
        }
    }

    pub(crate) fn nothing(message: impl Display) -> Self {
        Self {
            code: NOTHING,
            message: message.to_string(),
        }
    }
}

impl From<io::Error> for Failure {
    /// Converts an I/O error on a pipe.
    fn from(error: io::Error) -> Self {
        Self::incomplete(error)
    }
}
