//! Errors of programs that cannot be printed.

use thiserror::Error;

/// An error from printing a program.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum BundleError {
    /// A call uses an object that no recorded call created.
    #[error("{function} uses {kind} {number}, which no recorded call made")]
    Unknown {
        /// The call.
        function: String,
        /// The kind of object.
        kind: String,
        /// The object's number in the API.
        number: u64,
    },
    /// A call has arguments that cannot be printed.
    #[error("a call of {0} cannot be printed")]
    Call(String),
    /// A value that must be checked was not read.
    #[error("{0} was not read")]
    Unread(String),
}
