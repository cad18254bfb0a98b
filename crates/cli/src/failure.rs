//! Errors as the user meets them: one message and an exit code.

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
/// Something unexpected and bad.
pub(crate) const UNEXPECTED: u8 = 1;

/// Why a command did not come to its end.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Standard output was closed by its reader.
    Closed,
    /// Anything that the user is told.
    Told {
        /// The exit code.
        code: u8,
        /// The message.
        message: String,
    },
}

impl Failure {
    pub(crate) fn usage(message: impl Display) -> Self {
        Self::Told {
            code: USAGE,
            message: message.to_string(),
        }
    }

    pub(crate) fn incomplete(message: impl Display) -> Self {
        Self::Told {
            code: INCOMPLETE,
            message: message.to_string(),
        }
    }

    pub(crate) fn nothing(message: impl Display) -> Self {
        Self::Told {
            code: NOTHING,
            message: message.to_string(),
        }
    }
}

impl From<io::Error> for Failure {
    /// From writing to standard output.
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::Closed
        } else {
            Self::incomplete(format!("cannot write the output: {error}"))
        }
    }
}
