//! Texts on a terminal.

/// The width and colours that a terminal report may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableOptions {
    /// Columns of the terminal. Tables leave out columns; only what is still too wide is wrapped.
    pub width: usize,
    /// True if ANSI colours may be used. The caller knows `NO_COLOR` and whether this is a terminal.
    pub color: bool,
}

impl Default for TableOptions {
    fn default() -> Self {
        Self {
            width: 100,
            color: false,
        }
    }
}

impl TableOptions {
    /// The columns that are left for text which is indented by this many, at least 20.
    pub(crate) fn room(self, indent: usize) -> usize {
        self.width.saturating_sub(indent + 1).max(20)
    }

    /// Text in an ANSI colour, given by its number; none if there is no number.
    pub(crate) fn paint(self, text: &str, color: &str) -> String {
        if self.color && !color.is_empty() {
            format!("\u{1b}[{color}m{text}\u{1b}[0m")
        } else {
            text.to_owned()
        }
    }
}

/// Lines of parts joined by commas, broken between parts where they do not fit, with what is before the first and
/// so many spaces before the others.
pub(crate) fn listed(
    before: &str,
    parts: &[impl AsRef<str>],
    indent: usize,
    options: TableOptions,
) -> String {
    let mut text = before.to_owned();
    let mut column = before.chars().count();
    for (i, part) in parts.iter().enumerate() {
        let part = part.as_ref();
        let length = part.chars().count() + 2;
        if i > 0 && column + length > options.width {
            text += &format!("\n{}", " ".repeat(indent));
            column = indent;
        }
        text.push_str(part);
        column += length;
        if i + 1 < parts.len() {
            text.push_str(", ");
        }
    }
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    lines.join("\n")
}
