//! The command of a guard, which ends a program with the process that started it.

use std::io;
use std::process::Command;

/// Returns the command of a guard, without the words of its program.
///
/// # Errors
/// If the system does not tell the path of this program.
pub fn guard(input: bool) -> io::Result<Command> {
    let mut guard = Command::new(std::env::current_exe()?);
    guard.arg("worker");
    if !input {
        guard.arg("--no-input");
    }
    guard.arg("--guard");
    Ok(guard)
}
