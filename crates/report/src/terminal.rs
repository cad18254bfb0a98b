//! Texts for a terminal.

/// The width and colours available to a terminal report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableOptions {
    /// The number of columns of the terminal. Tables leave out columns first, and wrap only if they are still
    /// too wide.
    pub width: usize,
    /// True if ANSI colours can be used. The caller checks `NO_COLOR` and whether the output is a terminal.
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
    /// Returns the number of columns left for text that is indented by `indent`, at least 20.
    pub(crate) fn room(self, indent: usize) -> usize {
        self.width.saturating_sub(indent + 1).max(20)
    }

    /// Returns text in an ANSI colour, given by its number, or unchanged text if the number is empty.
    pub(crate) fn paint(self, text: &str, color: &str) -> String {
        if self.color && !color.is_empty() {
            format!("\u{1b}[{color}m{text}\u{1b}[0m")
        } else {
            text.to_owned()
        }
    }
}

/// Joins parts by commas and breaks lines between parts if they do not fit. The first line begins with
/// `before`, the others with `indent` spaces.
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
