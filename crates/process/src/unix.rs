//! Unix: process groups and signals.

use rustix::process::{Pid, Signal, getpid, kill_process, kill_process_group};
use std::fs::{self, File};
use std::io::{self, Write};
use std::os::fd::AsFd;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus};
use std::thread;

/// Keeps Ctrl-C at the terminal away from the program.
pub fn separate(command: &mut Command) -> &mut Command {
    command.process_group(0)
}

/// A program and all the processes that it starts.
#[derive(Debug)]
pub struct Group(Option<Pid>);

impl Group {
    /// Starts a program in a group of its own.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start(command: &mut Command) -> io::Result<(Child, Self)> {
        let child = separate(command).spawn()?;
        let leader = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
        Ok((child, Self(leader)))
    }

    /// Asks the processes to end. Returns true if the system has a way to ask.
    pub fn ask(&self) -> bool {
        self.signal(Signal::TERM);
        true
    }

    /// Kills the processes.
    pub fn kill(&self) {
        self.signal(Signal::KILL);
    }

    fn signal(&self, signal: Signal) {
        if let Some(leader) = self.0 {
            // The processes might have ended already.
            let _ = kill_process_group(leader, signal);
        }
    }
}

/// Returns the signal that ended a process.
pub fn signal(status: ExitStatus) -> Option<i32> {
    status.signal()
}

/// Returns the bytes of memory that a process uses, resident and swapped; `None` if the system does not
/// report it.
pub fn memory(child: &Child) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
    let field = |name: &str| -> Option<u64> {
        let line = status.lines().find_map(|l| l.strip_prefix(name))?;
        line.trim_end_matches("kB").trim().parse().ok()
    };
    Some((field("VmRSS:")? + field("VmSwap:").unwrap_or(0)) * 1024)
}

/// Writes to standard output.
///
/// # Errors
/// If a write fails.
pub fn write_output(bytes: &[u8]) -> io::Result<()> {
    let out = io::stdout().lock();
    // The standard library reports success for writes to a closed standard output, so write to the
    // descriptor.
    File::from(out.as_fd().try_clone_to_owned()?).write_all(bytes)
}

/// Returns standard output for use by the caller alone; all other output goes to standard error.
///
/// # Errors
/// If the system refuses a descriptor.
pub fn private_output() -> io::Result<File> {
    let private = rustix::io::dup(io::stdout())?;
    rustix::stdio::dup2_stdout(io::stderr())?;
    Ok(File::from(private))
}

/// Replaces this process with another program; returns only if that fails.
pub fn replace(command: &mut Command) -> io::Error {
    command.exec()
}

/// Ends this process as an access to invalid memory does.
pub fn crash() -> ! {
    // Sends the signal, since safe code cannot read invalid memory. The first signal only removes the
    // standard library's handler.
    loop {
        let _ = kill_process(getpid(), Signal::SEGV);
        thread::yield_now();
    }
}
