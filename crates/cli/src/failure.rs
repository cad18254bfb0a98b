//! Errors of commands: a message and an exit code.

use std::error::Error;
use std::fmt::Display;
use std::io::{self, ErrorKind};
use std::path::Path;

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

/// Returns the reason for what this binary lacks: the feature that was left out, and how to get it.
#[cfg(not(feature = "full"))]
pub(crate) fn left_out(feature: &str) -> String {
    format!(
        "this etalon was built without the feature `{feature}`: cargo install etalon --features {feature}"
    )
}

/// Returns true if the disk is full, or a file or a user may not become larger.
fn is_full(error: &(dyn Error + 'static)) -> bool {
    let mut error = Some(error);
    while let Some(cause) = error {
        let kind = cause.downcast_ref().map(io::Error::kind);
        if let Some(ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge) =
            kind
        {
            return true;
        }
        error = cause.source();
    }
    false
}

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

    /// Returns the failure for an error in the user's input; a full disk makes a result incomplete.
    pub(crate) fn of(error: impl Error + 'static) -> Self {
        if is_full(&error) {
            Self::incomplete(error)
        } else {
            Self::usage(error)
        }
    }

    /// Returns the failure of a file that the user named; a full disk is incomplete.
    pub(crate) fn of_file(action: &str, path: &Path, error: &io::Error) -> Self {
        let message = format!("cannot {action} {}: {error}", path.display());
        if is_full(error) {
            Self::incomplete(message)
        } else {
            Self::usage(message)
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
