//! The look of tables on a terminal.

use tabled::Table;
use tabled::builder::Builder;
use tabled::settings::object::{Columns, Rows};
use tabled::settings::peaker::Priority;
use tabled::settings::{Alignment, Color, Style, Width};

/// The width and colours that a terminal report may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableOptions {
    /// Columns of the terminal. Long lines are cut, cells of tables are wrapped.
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
