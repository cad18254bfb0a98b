//! The guard of a program: a process between the program and its user.
//!
//! Guard and program are in one process group. The guard's standard input is a pipe from the process that uses the
//! program. When that process ends, even by SIGKILL and before the program has done anything, the guard
//! waits [`GRACE`] and kills the group.

use etalon_process::Parent;
use std::ffi::OsString;
use std::io;
use std::process::{Command, ExitStatus, Stdio};
use std::thread;
use std::time::Duration;

/// The time that a program has to end by itself.
const GRACE: Duration = Duration::from_secs(5);

/// Runs `words`, a program and its arguments, until it ends or standard input does. Returns its exit status. `input` is
/// true if the program reads standard input.
///
/// # Errors
/// If it cannot be started.
pub fn guard(words: &[OsString], input: bool) -> io::Result<ExitStatus> {
    let no_word = || io::Error::from(io::ErrorKind::InvalidInput);
    let (program, arguments) = words.split_first().ok_or_else(no_word)?;
    let mut command = Command::new(program);
    command.args(arguments);
    if !input {
        command.stdin(Stdio::null());
    }
    // A guard that is killed takes the program along.
    etalon_process::end_with_thread(&mut command);
    let parent = Parent::now();
    // `thread::spawn` panics if no thread can start.
    thread::Builder::new().spawn(|| {
        etalon_process::wait_for_end_of_input();
        thread::sleep(GRACE);
        etalon_process::end_group()
    })?;
    let status = command.spawn()?.wait()?;
    if parent.has_ended() {
        // Nothing else ends children that the program has left.
        etalon_process::end_group()
    }
    Ok(status)
}
