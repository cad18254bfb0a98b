//! Standard output, standard error and the terminal.
//!
//! A reader that closes the pipe, as `head` does, never changes an exit code: it has what it wanted. Unlike
//! `println!` and `eprintln!`, nothing here panics. [`print()`] is for commands that produce their output on
//! standard output: any other failed write is an error. [`summarize`] is for commands that produce a folder: a
//! failed write of the summary is not an error. JSON goes through [`print()`], because a program must not take
//! truncated output as complete.

use crate::failure::Failure;
use etalon_process::write_output;
use etalon_report::TableOptions;
use serde::Serialize;
use std::fmt::Arguments;
use std::io::{self, ErrorKind, IsTerminal, Write};

/// Writes a command's output to standard output.
///
/// # Errors
/// If a write fails, except because the reader closed the pipe.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match write_output(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::incomplete(format!(
            "cannot write the output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Writes a command's output as indented JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print(&json(value)?)
}

/// Writes a summary of a folder to standard output. A failed write is reported on standard error and is no
/// error.
pub(crate) fn summarize(text: &str) {
    match write_output(text.as_bytes()) {
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

/// Writes a line to standard error; see [`say!`].
pub(crate) fn write_error(line: Arguments<'_>) {
    // If standard error fails, there is nowhere to report it.
    let _ = io::stderr()
        .lock()
        .write_all(format!("{line}\n").as_bytes());
}

/// Writes a line to standard error; ignores failures.
macro_rules! say {
    ($($argument:tt)*) => {
        $crate::output::write_error(format_args!($($argument)*))
    };
}
pub(crate) use say;

/// Returns true if output is coloured: on a terminal, unless `NO_COLOR` is set (<https://no-color.org>).
pub(crate) fn color() -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
    !refused && io::stdout().is_terminal()
}

/// A width that no line reaches: without a terminal, lines stay whole.
const UNLIMITED: usize = 1 << 20;

/// Returns the width of the terminal in columns; without a terminal, lines are neither wrapped nor cut.
pub(crate) fn width() -> usize {
    if !io::stdout().is_terminal() {
        return UNLIMITED;
    }
    let known = terminal_size::terminal_size_of(io::stdout())
        .map(|(columns, _)| usize::from(columns.0))
        .filter(|columns| *columns >= 40);
    known.unwrap_or(120)
}

/// Returns the width and colour options for tables on this terminal.
pub(crate) fn table_options() -> TableOptions {
    TableOptions {
        width: width(),
        color: color(),
    }
}
