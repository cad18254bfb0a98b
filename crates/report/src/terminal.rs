//! The look of tables on a terminal.

use tabled::Table;
use tabled::builder::Builder;
use tabled::settings::object::{Columns, Rows};
use tabled::settings::peaker::Priority;
use tabled::settings::{Alignment, Color, Style, Width};

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

    /// Text in an ANSI colour, given by its number.
    pub(crate) fn paint(self, text: &str, color: &str) -> String {
        match self.color {
            true => format!("\u{1b}[{color}m{text}\u{1b}[0m"),
            false => text.to_owned(),
        }
    }
}

/// A table whose first columns hold text and all others numbers. Does not wrap its cells yet.
pub(crate) fn table(builder: Builder, options: TableOptions, text_columns: usize) -> Table {
    let mut table = builder.build();
    table
        .with(Style::rounded())
        .modify(Columns::new(text_columns..), Alignment::right());
    if options.color {
        table.modify(Rows::first(), Color::BOLD);
    }
    table
}

/// Leaves out columns of a table that is wider than the terminal, in the order of `optional`, until the rest fits.
/// Returns their places before.
pub(crate) fn fit(
    builder: Builder,
    options: TableOptions,
    optional: &[usize],
) -> (Builder, Vec<usize>) {
    let rows: Vec<Vec<String>> = builder.into();
    let columns = rows.first().map_or(0, Vec::len);
    let widest = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let mut left_out: Vec<usize> = Vec::new();
    // A border and two spaces for each column, and the last border.
    let mut width: usize = (0..columns).map(|column| widest(column) + 3).sum::<usize>() + 1;
    for column in optional {
        if width <= options.width {
            break;
        }
        left_out.push(*column);
        width -= widest(*column) + 3;
    }
    let mut narrow = Builder::default();
    for row in rows {
        let cells = row.into_iter().enumerate();
        let kept = cells.filter(|(column, _)| !left_out.contains(column));
        narrow.push_record(kept.map(|(_, cell)| cell).collect::<Vec<_>>());
    }
    (narrow, left_out)
}

/// Lines of parts joined by commas, broken between parts where they do not fit, with what is before the first and
/// so many spaces before the others.
pub(crate) fn listed(
    before: &str,
    parts: &[String],
    indent: usize,
    options: TableOptions,
) -> String {
    let mut text = before.to_owned();
    let mut column = before.chars().count();
    for (i, part) in parts.iter().enumerate() {
        let length = part.chars().count() + 2;
        if i > 0 && column + length > options.width {
            text.push_str(&format!("\n{}", " ".repeat(indent)));
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

/// The text of a table, its cells wrapped to the width of the terminal.
pub(crate) fn wrapped(mut table: Table, options: TableOptions) -> String {
    table.with(
        Width::wrap(options.width)
            .keep_words(true)
            .priority(Priority::max(true)),
    );
    table.to_string()
}

/// A count in a table; a dot for none.
pub(crate) fn dotted(n: u64) -> String {
    match n {
        0 => "·".to_owned(),
        n => n.to_string(),
    }
}
