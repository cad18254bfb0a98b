//! The error of a program that cannot be printed.

use thiserror::Error;

/// The error of a program that cannot be printed.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum BundleError {
    /// A call uses an object that no recorded call made.
    #[error("{function} uses {kind} {number}, which no recorded call made")]
    Unknown {
        /// The call.
        function: String,
        /// The kind of object.
        kind: String,
        /// The API's number of it.
        number: u64,
    },
    /// A call has arguments that cannot be printed.
    #[error("a call of {0} cannot be printed")]
    Call(String),
    /// A value that must be checked was not read.
    #[error("{0} was not read")]
    Unread(String),
}
