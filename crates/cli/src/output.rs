//! Standard output, standard error and the terminal.
//!
//! A reader that goes away, as `head` does, never changes an exit code: it has what it wanted. Nothing here panics, as
//! `println!` and `eprintln!` do. [`print()`] is for commands whose product is what they print, so that any other failed
//! write is an error; [`summarize`] for people, of those whose product is a folder, where none is. JSON is read by programs,
//! which must not take a part for the whole.

use crate::failure::Failure;
use etalon_report::TableOptions;
use serde::Serialize;
use std::fmt::Arguments;
use std::fs::File;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::os::fd::AsFd;

/// Writes text, the product of a command, to standard output.
///
/// # Errors
/// If a write fails for any other reason than that the reader closed the pipe.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match write(text) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::incomplete(format!(
            "cannot write the output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Writes a value, the product of a command, as indented JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print(&json(value)?)
}

/// Writes a summary of what a folder holds to standard output. A failed write is told and changes nothing.
pub(crate) fn summarize(text: &str) {
    match write(text) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            say!("cannot write the summary: {error}");
        }
        _ => {}
    }
}

fn json(value: &impl Serialize) -> Result<String, Failure> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|e| Failure::incomplete(format!("cannot write JSON: {e}")))?;
    text.push('\n');
    Ok(text)
}

fn write(text: &str) -> io::Result<()> {
    let out = io::stdout().lock();
    // The standard library takes a write to a descriptor that is not open for writing for a success.
    File::from(out.as_fd().try_clone_to_owned()?).write_all(text.as_bytes())
}

/// Writes a line to standard error; see [`say!`].
pub(crate) fn write_error(line: Arguments<'_>) {
    // Nobody is left to tell.
    let _ = io::stderr()
        .lock()
        .write_all(format!("{line}\n").as_bytes());
}

/// Writes a line to standard error, if somebody reads it.
macro_rules! say {
    ($($argument:tt)*) => {
        $crate::output::write_error(format_args!($($argument)*))
    };
}
pub(crate) use say;

/// True if standard output takes colours (<https://no-color.org>).
pub(crate) fn color() -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
    !refused && io::stdout().is_terminal()
}

/// A width that nothing reaches: what is no terminal gets whole lines.
const UNLIMITED: usize = 1 << 20;

/// Returns the width of the terminal in columns; without a terminal nothing is wrapped or cut.
pub(crate) fn width() -> usize {
    if !io::stdout().is_terminal() {
        return UNLIMITED;
    }
    let known = rustix::termios::tcgetwinsize(io::stdout())
        .ok()
        .map(|size| usize::from(size.ws_col))
        .filter(|columns| *columns >= 40);
    known.unwrap_or(120)
}

/// Returns the width and colours of tables on this terminal.
pub(crate) fn table_options() -> TableOptions {
    TableOptions {
        width: width(),
        color: color(),
    }
}
