//! The command that starts a worker.

use crate::protocol::receive;
use etalon_backend::Unavailable;
use etalon_record::Release;
use serde::{Deserialize, Serialize};
use std::ffi::OsStr;
use std::io::{self, Read};
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;
use thiserror::Error;

/// The time that a driver may take to start.
pub const START_TIMEOUT: Duration = Duration::from_secs(60);

/// The command that starts a worker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// The adapter's name.
    pub adapter: String,
    /// The path of the worker's program, usually that of the running one.
    pub program: PathBuf,
    /// The program's arguments.
    pub arguments: Vec<String>,
    /// Environment variables that are added to the parent's; `None` removes one.
    pub environment: Vec<(String, Option<String>)>,
    /// The command that starts the program elsewhere; `None` starts it here.
    pub launcher: Option<Launcher>,
    /// The release of the driver, if the adapter's description states it.
    pub release: Option<Release>,
    /// The time limit for opening the adapter.
    pub patience: Duration,
    /// True if only one worker of the adapter can run at a time.
    pub alone: bool,
}

/// A command prefix that starts a worker in another userland, in a container or on another machine.
///
/// Some prefixes split the worker's arguments again (ssh's remote shell), and others lose its environment
/// (a container). The worker therefore receives what it needs through its standard input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launcher {
    /// The words of the prefix; at least one.
    pub prefix: Vec<String>,
    /// The adapter that the worker opens, as the text after its `--open`.
    pub open: String,
}

/// The first message to a worker that a launcher started.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setup {
    /// The adapter that the worker opens, as the text after `--open` would name it.
    pub open: String,
    /// The environment variables that the worker needs; `None` means that a variable must not be set.
    pub environment: Vec<(String, Option<String>)>,
}

impl Setup {
    /// Reads the first message of the parent.
    ///
    /// # Errors
    /// If the input ends before the message, or is something else.
    pub fn receive(mut input: impl Read) -> io::Result<Self> {
        receive(&mut input)?.ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }

    /// Returns the variables that differ from those of this process.
    pub fn missing(&self) -> Vec<(String, Option<String>)> {
        let differs = |(name, wanted): &&(String, Option<String>)| {
            let set = std::env::var_os(name);
            set.as_deref() != wanted.as_deref().map(OsStr::new)
        };
        self.environment.iter().filter(differs).cloned().collect()
    }
}

impl Launch {
    /// Returns the worker's command. Its environment is set here too, because prefixes that run on this
    /// machine pass it on.
    pub(crate) fn command(&self) -> Command {
        let mut command = match self.launcher.as_ref().map(|l| l.prefix.as_slice()) {
            Some([first, rest @ ..]) => {
                let mut command = Command::new(first);
                command.args(rest).arg(&self.program);
                command
            }
            _ => Command::new(&self.program),
        };
        command.args(&self.arguments);
        for (name, value) in &self.environment {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        command
    }
}

/// The reason why a worker did not start.
#[derive(Debug, Error)]
pub enum StartError {
    /// The worker reports that its adapter is unavailable.
    #[error("{0}")]
    Unavailable(Unavailable),
    /// No worker greeted through the launcher, which says nothing about the driver.
    #[error("{0}")]
    Launcher(String),
    /// The worker died, hung or broke the protocol.
    #[error("{0}")]
    Broken(String),
}
