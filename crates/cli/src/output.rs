//! Standard output, standard error and the terminal.
//!
//! A reader that closes the pipe, as `head` does, never changes an exit code: it has what it wanted. Unlike
//! `println!` and `eprintln!`, nothing here panics. [`print()`] is for commands that produce their output on
//! standard output: any other failed write is an error. [`summarize`] is for commands that produce a folder: a
//! failed write of the summary is not an error. JSON goes through [`print()`], because a program must not take
//! truncated output as complete.
//!
//! Texts from outside, such as names of devices, must not command a terminal, so hidden characters are escaped here,
//! where all output passes. Only the suite's own colours pass, if there are any.

use crate::failure::Failure;
use etalon_frame::is_hidden;
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
    print_all(&for_terminal(text, color()))
}

fn print_all(text: &str) -> Result<(), Failure> {
    match write_output(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::incomplete(format!(
            "cannot write the output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Writes a command's output as indented JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print_all(&json(value)?)
}

/// Writes a summary of a folder to standard output. A failed write is reported on standard error and is no
/// error.
pub(crate) fn summarize(text: &str) {
    match write_output(for_terminal(text, color()).as_bytes()) {
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
    Ok(escaped(&text, json_escape))
}

/// Returns the escape of a character in JSON.
fn json_escape(c: char) -> String {
    let mut units = [0; 2];
    let units = c.encode_utf16(&mut units).iter();
    units.map(|unit| format!("\\u{unit:04x}")).collect()
}

/// Returns a text whose hidden characters, except tabs and ends of lines, are escaped.
fn escaped(text: &str, escape: impl Fn(char) -> String) -> String {
    let mut result = String::with_capacity(text.len());
    for c in text.chars() {
        if is_hidden(c) && !matches!(c, '\n' | '\t') {
            result.push_str(&escape(c));
        } else {
            result.push(c);
        }
    }
    result
}

/// Returns a text for a terminal, in colours or without.
fn for_terminal(text: &str, color: bool) -> String {
    let escape = |c: char| c.escape_unicode().to_string();
    let mut parts = text.split("\u{1b}[");
    let mut result = escaped(parts.next().unwrap_or_default(), escape);
    // Each part follows an introducer of a control sequence; only `m`, colours, is kept.
    for part in parts {
        let code = part
            .split_once('m')
            .filter(|(code, _)| color && code.bytes().all(|b| b.is_ascii_digit() || b == b';'));
        if code.is_some() {
            result.push_str("\u{1b}[");
        } else {
            result.push_str("\\u{1b}[");
        }
        result += &escaped(part, escape);
    }
    result
}

/// The most characters of a line on standard error.
const MOST_ON_A_LINE: usize = 8000;

/// Returns the lines of a message, without the ends of very long ones.
fn without_long_ends(text: &str) -> String {
    let lines = text
        .split('\n')
        .map(|line| match line.char_indices().nth(MOST_ON_A_LINE) {
            Some((end, _)) => format!("{}…", &line[..end]),
            None => line.to_owned(),
        });
    lines.collect::<Vec<_>>().join("\n")
}

/// Writes a line to standard error; see [`say!`].
pub(crate) fn write_error(line: Arguments<'_>) {
    let line = for_terminal(&without_long_ends(&line.to_string()), false);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_colour_sequences_pass_and_only_to_a_colour_terminal() {
        let text = "a\u{1b}[31mb\u{1b}[0m\u{1b}[2J\u{202e}\n";
        assert_eq!(
            for_terminal(text, false),
            "a\\u{1b}[31mb\\u{1b}[0m\\u{1b}[2J\\u{202e}\n"
        );
        assert_eq!(
            for_terminal(text, true),
            "a\u{1b}[31mb\u{1b}[0m\\u{1b}[2J\\u{202e}\n"
        );
    }

    #[test]
    fn escaped_json_reads_back_equal() {
        let value = ["\u{1b}[31m\u{7f}\u{9b}\u{202e}\u{e0001}"];
        let text = json(&value).unwrap();
        assert!(!text.chars().any(|c| is_hidden(c) && c != '\n'), "{text}");
        let read: [String; 1] = serde_json::from_str(&text).unwrap();
        assert_eq!(read, value);
    }

    #[test]
    fn a_long_line_is_cut() {
        let text = without_long_ends(&format!("{}\nb", "a".repeat(5 << 20)));
        assert_eq!(text, format!("{}…\nb", "a".repeat(MOST_ON_A_LINE)));
    }
}
