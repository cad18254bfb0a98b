//! A program, the process that keeps it, and the worker's handle of that process.

use etalon_process::ProcessGroup;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, BufRead, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// The time that a program has to end on request.
const GRACE: Duration = Duration::from_secs(2);
/// The pause between checks of a program.
const PAUSE: Duration = Duration::from_millis(20);

/// A program with a folder of its own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeptProgram {
    /// The name in messages, such as "the browser".
    pub name: String,
    /// The words of its command.
    pub command: Vec<String>,
    /// Environment variables on top of the worker's; `None` removes one.
    pub environment: BTreeMap<String, Option<String>>,
    /// A new folder, which is removed with the program; see [`new_folder`].
    pub folder: PathBuf,
    /// Files of the folder: names and contents.
    pub files: BTreeMap<String, String>,
}

/// The worker's handle of a keeper. Dropping it makes the keeper end the program.
pub struct Kept {
    keeper: Child,
    /// The pipe to the keeper. Its end shows that the worker ended.
    _input: ChildStdin,
    /// The program's folder.
    folder: PathBuf,
}

impl Kept {
    /// Starts a keeper by its command, and a program.
    ///
    /// # Errors
    /// If the keeper cannot be started.
    pub fn start(mut keeper: Command, program: &KeptProgram) -> io::Result<Self> {
        // A separate process group, so that the worker's signals do not reach it.
        etalon_process::separate(&mut keeper);
        let mut keeper = keeper.stdin(Stdio::piped()).stdout(Stdio::null()).spawn()?;
        let missing = || io::Error::other("the keeper has no input");
        let mut input = keeper.stdin.take().ok_or_else(missing)?;
        serde_json::to_writer(&mut input, program)?;
        input.write_all(b"\n")?;
        input.flush()?;
        Ok(Self {
            keeper,
            _input: input,
            folder: program.folder.clone(),
        })
    }

    /// Returns true while the program runs.
    pub fn lives(&mut self) -> bool {
        matches!(self.keeper.try_wait(), Ok(None))
    }

    /// Waits a moment for the keeper's last messages about a program that seems to have ended.
    pub fn wait(&mut self) {
        within_grace(|| !self.lives());
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        if !self.lives() {
            // A keeper that was killed has left it; another one has removed it.
            let _ = fs::remove_dir_all(&self.folder);
        }
    }
}

/// Waits until something is so, at most for [`GRACE`].
fn within_grace(mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() && begun.elapsed() < GRACE {
        thread::sleep(PAUSE);
    }
}

/// Returns an unused path for a temporary folder.
pub fn new_folder(prefix: &str) -> PathBuf {
    std::env::temp_dir().join(format!("{prefix}{}", token()))
}

/// Returns a token that cannot be guessed: 128 bits of the keys that the system gives for hash tables.
pub fn token() -> String {
    let word = || RandomState::new().build_hasher().finish();
    format!("{:016x}{:016x}", word(), word())
}

/// Keeps a program until `input` or the program ends. Messages go to standard error. `guard` is the command of a
/// guard, which ends the program if the keeper is killed; see [`guard`](crate::guard()).
///
/// # Errors
/// If the first line of `input` is not a [`KeptProgram`], or it cannot be started.
pub fn keep(mut input: impl BufRead + Send + 'static, guard: Option<Command>) -> io::Result<()> {
    let mut line = String::new();
    input.read_line(&mut line)?;
    let program: KeptProgram = serde_json::from_str(&line)?;
    make(&program.folder)?;
    let kept = keep_started(&program, input, guard);
    remove(&program.folder);
    kept
}

fn keep_started(
    program: &KeptProgram,
    mut input: impl BufRead + Send + 'static,
    guard: Option<Command>,
) -> io::Result<()> {
    for (name, text) in &program.files {
        fs::write(program.folder.join(name), text)?;
    }
    let (mut child, group) = start(program, guard)?;
    let (sender, ended) = channel::<()>();
    thread::Builder::new().spawn(move || {
        // Nothing is sent; only the end matters.
        let _ = io::copy(&mut input, &mut io::sink());
        drop(sender);
    })?;
    loop {
        let is_over = ended.recv_timeout(PAUSE) != Err(RecvTimeoutError::Timeout);
        // The end of the program can be what ended the worker, so it is looked for once more.
        if let Some(status) = child.try_wait()? {
            eprintln!("{} has ended: {status}", program.name);
            break;
        }
        if is_over {
            break;
        }
    }
    end(&mut child, &group);
    Ok(())
}

/// Creates a folder that only this user can open.
fn make(folder: &Path) -> io::Result<()> {
    #[cfg_attr(not(unix), expect(unused_mut, reason = "only Unix has modes"))]
    let mut builder = fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

fn start(program: &KeptProgram, guard: Option<Command>) -> io::Result<(Child, ProcessGroup)> {
    let (name, words) = program.command.split_first().unzip();
    let name = name.map_or("", String::as_str);
    let mut command = match guard {
        Some(mut guard) => {
            // The end of this pipe, into which nothing is written, shows that the keeper ended.
            guard.arg(name).stdin(Stdio::piped());
            guard
        }
        None => {
            let mut command = Command::new(name);
            command.stdin(Stdio::null());
            command
        }
    };
    command
        .args(words.unwrap_or_default())
        .stdout(Stdio::null());
    for (variable, value) in &program.environment {
        match value {
            Some(value) => command.env(variable, value),
            None => command.env_remove(variable),
        };
    }
    ProcessGroup::start(&mut command)
        .map_err(|error| io::Error::new(error.kind(), format!("{name}: {error}")))
}

/// Ends a program and all its processes.
fn end(child: &mut Child, group: &ProcessGroup) {
    if group.ask() {
        within_grace(|| matches!(child.try_wait(), Ok(Some(_))));
    }
    group.kill();
    // Killing fails only if the process has ended or cannot be ended.
    let _ = child.kill();
    let _ = child.wait();
}

/// Removes a folder. Ending processes might still write to it, so it tries again for a while.
fn remove(folder: &Path) {
    within_grace(|| fs::remove_dir_all(folder).is_ok() || !folder.exists());
}
