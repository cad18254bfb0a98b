//! The command that starts a worker.

use etalon_backend::Unavailable;
use std::path::PathBuf;
use thiserror::Error;

/// The command that starts a worker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// The adapter's name.
    pub adapter: String,
    /// The program.
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// Environment variables on top of the parent's; `None` removes one.
    pub environment: Vec<(String, Option<String>)>,
}

/// Why a worker did not start.
#[derive(Debug, Error)]
pub enum StartError {
    /// The worker reports that its adapter is unavailable.
    #[error("{0}")]
    Unavailable(Unavailable),
    /// The worker died, hung or broke the protocol.
    #[error("{0}")]
    Broken(String),
}
