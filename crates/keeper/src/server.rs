//! The server of a driver, such as virgl's: the driver's library sends its commands to a socket, and the server
//! executes them on another driver.
//!
//! Each worker has its own server. Some libraries look only at one fixed path. A link at that path leads to the server
//! of the worker that is opening its driver. A library connects once, and workers open one at a time.

use crate::kept::{Kept, KeptProgram, new_folder};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

/// The part of a word that is replaced by the path of the socket.
const SOCKET: &str = "{socket}";
/// The time that a server has to start listening.
const START: Duration = Duration::from_secs(10);
/// The pause between checks of a socket.
const PAUSE: Duration = Duration::from_millis(10);

/// The server of a driver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Server {
    /// The words of its command. `{socket}` is replaced by a new path.
    pub command: Vec<String>,
    /// Environment variables on top of the worker's; `null` removes one.
    #[serde(default)]
    pub environment: BTreeMap<String, Option<String>>,
    /// The path at which the driver looks for the server.
    pub socket: PathBuf,
}

/// An error from starting a server.
#[derive(Debug, Error)]
pub enum NotServed {
    /// Another server has the path.
    #[error("another server is at {}, the only path at which the driver looks", .0.display())]
    Taken(PathBuf),
    /// Another user's worker was killed and has left its link at the path.
    #[error("a link that only another user can remove is at {}, the only path at which the driver looks", .0.display())]
    Left(PathBuf),
    /// The server has ended.
    #[error("the server {0} ends before it listens")]
    Ended(String),
    /// The server does not listen.
    #[error("the server {0} does not listen within {limit} s", limit = START.as_secs())]
    Silent(String),
    /// The system refuses a process, a link or a lock.
    #[error("{what}: {error}")]
    System {
        /// The object that was wanted.
        what: String,
        /// The system's error.
        error: io::Error,
    },
}

impl NotServed {
    /// Returns what the user can do about it, as an imperative.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Taken(_) => "end that server",
            Self::Left(_) => "remove that link as its owner or as root",
            Self::Ended(_) | Self::Silent(_) => {
                "see its own messages, by its command in a terminal"
            }
            Self::System { .. } => "see to the rights of the folder of temporary files",
        }
    }
}

/// A running server, which ends when this is dropped.
pub struct Served {
    _kept: Kept,
    /// The link to the server's socket, until the driver is open.
    link: Option<Link>,
}

/// A link to the socket of a server. While it exists, no other worker makes one.
struct Link {
    path: PathBuf,
    _lock: File,
}

impl Drop for Link {
    fn drop(&mut self) {
        // The file might be removed already.
        let _ = fs::remove_file(&self.path);
    }
}

impl Server {
    /// Returns what is wrong with the description, if anything.
    pub fn fault(&self) -> Option<&'static str> {
        let mut words = self.command.iter();
        if self.command.first().is_none_or(String::is_empty) {
            Some("`server` names no command")
        } else if !words.any(|word| word.contains(SOCKET)) {
            Some("`server` needs a word with `{socket}`, the path at which it listens")
        } else if !self.socket.has_root() {
            Some("the `socket` of a `server` is a path from the root")
        } else {
            None
        }
    }

    /// Starts a keeper by its command, and the server. Then leads the driver to the server.
    ///
    /// # Errors
    /// If it does not listen, or the driver cannot be led to it.
    pub fn start(&self, keeper: Command) -> Result<Served, NotServed> {
        let name = || self.command.first().cloned().unwrap_or_default();
        let folder = new_folder("etalon-server-");
        let socket = folder.join("socket");
        let text = socket.display().to_string();
        let words = self.command.iter();
        let program = KeptProgram {
            name: format!("the server {}", name()),
            command: words.map(|word| word.replace(SOCKET, &text)).collect(),
            environment: self.environment.clone(),
            folder,
            files: BTreeMap::new(),
        };
        let mut kept = Kept::start(keeper, &program).map_err(system("no server is started"))?;
        let begun = Instant::now();
        while !socket.exists() {
            if !kept.lives() {
                return Err(NotServed::Ended(name()));
            }
            if begun.elapsed() > START {
                return Err(NotServed::Silent(name()));
            }
            thread::sleep(PAUSE);
        }
        // The path exists a moment before the server listens.
        thread::sleep(PAUSE);
        Ok(Served {
            _kept: kept,
            link: Some(Link::new(&self.socket, &socket)?),
        })
    }
}

impl Served {
    /// Lets other workers connect their drivers: this worker's is connected.
    pub fn connected(&mut self) {
        self.link = None;
    }
}

impl Link {
    /// Waits until no other worker has a link at this path, then makes one.
    fn new(path: &Path, socket: &Path) -> Result<Self, NotServed> {
        let mut lock_path = path.as_os_str().to_owned();
        lock_path.push(".lock");
        let lock = lock_file(lock_path.as_ref());
        let lock = lock.and_then(|file| file.lock().map(|()| file));
        let lock = lock.map_err(system(&format!("no lock at {}", lock_path.display())))?;
        // A killed worker leaves a link, and a killed server a socket without a listener.
        let is_link = fs::symlink_metadata(path).map(|found| found.is_symlink());
        let left = match is_link {
            Ok(true) => true,
            Ok(false) if is_served(path) => return Err(NotServed::Taken(path.to_owned())),
            Ok(false) => true,
            Err(_) => false,
        };
        let removed = if left { fs::remove_file(path) } else { Ok(()) };
        if let Err(error) = &removed
            && error.kind() == io::ErrorKind::PermissionDenied
        {
            return Err(NotServed::Left(path.to_owned()));
        }
        let linked = removed.and_then(|()| link(socket, path));
        linked.map_err(system(&format!("no link at {}", path.display())))?;
        Ok(Self {
            path: path.to_owned(),
            _lock: lock,
        })
    }
}

/// Opens the file of a lock that all users share.
fn lock_file(path: &Path) -> io::Result<File> {
    // A lock does not need write permission. In a shared temporary folder, Linux refuses to open another user's
    // file with the option to create it.
    match File::open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        opened => return opened,
    }
    let file = OpenOptions::new().append(true).create(true).open(path)?;
    #[cfg(unix)]
    file.set_permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644))?;
    Ok(file)
}

fn system(what: &str) -> impl FnOnce(io::Error) -> NotServed {
    let what = what.to_owned();
    |error| NotServed::System { what, error }
}

/// Returns true if a server listens at a path.
#[cfg(unix)]
fn is_served(path: &Path) -> bool {
    std::os::unix::net::UnixStream::connect(path).is_ok()
}

#[cfg(unix)]
fn link(socket: &Path, path: &Path) -> io::Result<()> {
    std::os::unix::fs::symlink(socket, path)
}

#[cfg(not(unix))]
fn is_served(path: &Path) -> bool {
    path.exists()
}

#[cfg(not(unix))]
fn link(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}
