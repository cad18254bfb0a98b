//! Unix: process groups and signals.

use rustix::event::{PollFd, PollFlags, poll};
use rustix::io::Errno;
use rustix::process::{
    Pid, Resource, Rlimit, Signal, getpgid, getpgrp, getpid, getppid, kill_process,
    kill_process_group, setrlimit,
};
use std::fs::{self, File};
use std::io::{self, Write};
use std::os::fd::AsFd;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus};
use std::thread;
use std::time::Duration;

/// Keeps Ctrl-C at the terminal away from the program.
pub fn separate(command: &mut Command) -> &mut Command {
    command.process_group(0)
}

/// A program and all the processes that it starts.
#[derive(Debug)]
pub struct ProcessGroup(Option<Pid>);

impl ProcessGroup {
    /// Starts a program in a group of its own.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start(command: &mut Command) -> io::Result<(Child, Self)> {
        let child = separate(command).spawn()?;
        let leader = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
        Ok((child, Self(leader)))
    }

    /// Starts a worker in a group of its own.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start_worker(command: &mut Command) -> io::Result<(Child, Self)> {
        Self::start(command)
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

/// The parent of this process.
#[derive(Debug)]
pub struct Parent(Option<Pid>);

impl Parent {
    /// Returns the parent at this moment.
    pub fn now() -> Self {
        Self(getppid())
    }

    /// Returns true if the parent has ended since.
    pub fn has_ended(&self) -> bool {
        getppid() != self.0
    }
}

/// Kills this process, and all of its group if it leads the group.
pub fn end_group() -> ! {
    let this = getpid();
    if getpgrp() == this {
        let _ = kill_process_group(this, Signal::KILL);
    }
    loop {
        let _ = kill_process(this, Signal::KILL);
        thread::yield_now();
    }
}

/// Makes a write beyond the limit of a file's size an error, instead of the end of this process.
pub fn report_large_files() {
    // SAFETY: ignoring a signal runs no code. Nothing else in this process handles it.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

/// Waits until no process holds the other end of standard input. Reads nothing.
pub fn wait_for_end_of_input() {
    // Linux reports the end of a pipe in any case, and the end of a socket on request.
    #[cfg(target_os = "linux")]
    let end = PollFlags::RDHUP;
    #[cfg(not(target_os = "linux"))]
    let end = PollFlags::empty();
    let input = io::stdin();
    loop {
        let mut polled = [PollFd::new(&input, end)];
        match poll(&mut polled, None) {
            Ok(0) | Err(Errno::INTR) => {}
            Ok(_) | Err(_) => return,
        }
    }
}

/// Makes the system kill a program when the thread that starts it ends, where the system can: on Linux.
pub fn end_with_thread(command: &mut Command) {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::set_parent_process_death_signal;
        let starter = getpid();
        let request = move || {
            set_parent_process_death_signal(Some(Signal::KILL))?;
            // It might have ended before the request.
            if getppid() == Some(starter) {
                Ok(())
            } else {
                Err(io::ErrorKind::BrokenPipe.into())
            }
        };
        // SAFETY: between fork and exec, it makes two system calls and allocates nothing.
        unsafe { command.pre_exec(request) };
    }
}

/// Ends this process as another one ended.
pub fn end_like(status: ExitStatus) -> ! {
    let signal = status.signal();
    if let Some(signal) = signal.and_then(Signal::from_named_raw) {
        // The other process has left its memory already.
        let none = Rlimit {
            current: Some(0),
            maximum: Some(0),
        };
        let _ = setrlimit(Resource::Core, none);
        // The first signal only removes a handler of the standard library.
        for _ in 0..2 {
            let _ = kill_process(getpid(), signal);
            thread::sleep(Duration::from_millis(1));
        }
    }
    // The number that a shell gives to a signal.
    std::process::exit(status.code().unwrap_or(128 + signal.unwrap_or(0)))
}

/// Returns the signal that ended a process.
pub fn signal(status: ExitStatus) -> Option<i32> {
    status.signal()
}

/// Returns the bytes of memory that a process and its descendants of the same group use, resident and swapped;
/// `None` if the system does not report it.
pub fn memory(child: &Child) -> Option<u64> {
    let leader = Pid::from_raw(i32::try_from(child.id()).ok()?)?;
    memory_of(leader, getpgid(Some(leader)).ok()?)
}

fn memory_of(process: Pid, group: Pid) -> Option<u64> {
    let id = process.as_raw_nonzero();
    let status = fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let field = |name: &str| -> Option<u64> {
        let line = status.lines().find_map(|l| l.strip_prefix(name))?;
        line.trim_end_matches("kB").trim().parse().ok()
    };
    let own = (field("VmRSS:")? + field("VmSwap:").unwrap_or(0)) * 1024;
    let threads = fs::read_dir(format!("/proc/{id}/task"))
        .into_iter()
        .flatten();
    let children = threads.flatten().filter_map(|thread| {
        let numbers = fs::read_to_string(thread.path().join("children")).ok()?;
        let pids = numbers
            .split_whitespace()
            .filter_map(|n| Pid::from_raw(n.parse().ok()?));
        let of_group = pids.filter(|pid| getpgid(Some(*pid)) == Ok(group));
        // A child can end at any time.
        Some(
            of_group
                .filter_map(|pid| memory_of(pid, group))
                .sum::<u64>(),
        )
    });
    Some(own + children.sum::<u64>())
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
    // Programs that this process starts must not hold it.
    let private = rustix::io::fcntl_dupfd_cloexec(io::stdout(), 3)?;
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
