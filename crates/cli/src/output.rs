//! Standard output and the terminal.

use crate::failure::Failure;
use etalon_report::TableOptions;
use serde::Serialize;
use std::io::{self, IsTerminal, Write};

/// Writes text to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(())
}

/// Writes a value as indented JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|e| Failure::incomplete(format!("cannot write JSON: {e}")))?;
    text.push('\n');
    print(&text)
}

/// True if standard output takes colours (<https://no-color.org>).
pub(crate) fn color() -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
    !refused && io::stdout().is_terminal()
}

/// Returns the width of the terminal in columns, 120 without a terminal.
pub(crate) fn width() -> usize {
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
