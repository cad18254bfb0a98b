//! Tables: a column is its name and the cell that it makes of a row. A page, a terminal and Markdown show the
//! same table.

use crate::numbers::capital;
use crate::terminal::TableOptions;
use crate::words::plain;
use maud::{Markup, PreEscaped, html};
use tabled::builder::Builder;
use tabled::settings::object::{Cell as Place, Columns, Rows};
use tabled::settings::peaker::Priority;
use tabled::settings::{Alignment, Color, Style, Width};

/// The maximum number of characters of a cell on a terminal.
const LONGEST: usize = 160;

/// The maximum number of rows that a table of a page shows before its summary.
const FIRST: usize = 5;

/// The content of a cell.
#[derive(Clone, Default)]
pub(crate) struct Cell {
    /// The content on a terminal; `None` if there is nothing to show.
    text: Option<String>,
    /// The content on a page, if it is more than the text.
    html: Option<Markup>,
    attributes: Vec<(&'static str, String)>,
    color: Option<Color>,
}

impl Cell {
    /// Adds a class, which colours the cell on a page.
    pub(crate) fn class(mut self, class: &str) -> Self {
        match self
            .attributes
            .iter_mut()
            .find(|(name, _)| *name == "class")
        {
            Some((_, classes)) => *classes = format!("{classes} {class}"),
            None if class.is_empty() => {}
            None => self.attributes.push(("class", class.to_owned())),
        }
        self
    }

    /// Adds an attribute of the cell on a page.
    pub(crate) fn with(mut self, name: &'static str, value: impl Into<Option<String>>) -> Self {
        let attribute = value.into().map(|value| (name, value));
        self.attributes.splice(0..0, attribute);
        self
    }

    /// Sets the content on a page, if it is more than the text.
    pub(crate) fn on_page(self, html: Markup) -> Self {
        let html = Some(html);
        Self { html, ..self }
    }

    /// Sets the colour of the cell on a terminal.
    pub(crate) fn color(self, color: Option<Color>) -> Self {
        Self { color, ..self }
    }

    /// Returns the content on a page.
    pub(crate) fn shown(&self) -> Markup {
        let text = self.text.as_deref().unwrap_or("–");
        self.html.clone().unwrap_or_else(|| html! { (text) })
    }

    fn on_terminal(&self) -> String {
        let text = self.text.as_deref();
        text.map_or_else(|| "·".to_owned(), |text| plain(text, LONGEST))
    }

    /// Returns the element on a page.
    pub(crate) fn element(&self, name: &str) -> Markup {
        let attribute = |(name, value): &(&str, String)| html! { " " (name) "=" (PreEscaped("\"")) (value) (PreEscaped("\"")) };
        let attributes = self.attributes.iter().map(attribute);
        let attributes: String = attributes.map(|html| html.0).collect();
        PreEscaped(format!("<{name}{attributes}>{}</{name}>", self.shown().0))
    }
}

impl From<Markup> for Cell {
    fn from(html: Markup) -> Self {
        Self::default().on_page(html)
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(content: Option<T>) -> Self {
        content.map_or_else(Self::default, Into::into)
    }
}

macro_rules! from_text {
    ($($text:ty)*) => { $(
        impl From<$text> for Cell {
            fn from(text: $text) -> Self {
                let text = Some(text.to_string());
                Self { text, ..Self::default() }
            }
        }
    )* };
}
from_text!(String &String &str usize u32 u64);

/// Returns the name of a column whose first letter a page does not capitalise.
pub(crate) fn as_is(name: &str) -> Cell {
    Cell::from(name).on_page(html! { (name) })
}

/// Returns a count, or `None` for 0.
pub(crate) fn some(count: u64) -> Option<u64> {
    (count > 0).then_some(count)
}

/// A table of rows of type `R`.
pub(crate) struct Table<'a, R> {
    class: &'static str,
    caption: Option<(String, bool)>,
    columns: Vec<TableColumn<'a, R>>,
    row_class: Box<dyn Fn(&R) -> &'static str + 'a>,
}

struct TableColumn<'a, R> {
    name: Cell,
    kind: ColumnKind,
    cell: Box<dyn Fn(&R) -> Cell + 'a>,
    on_terminal: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum ColumnKind {
    Head,
    Text,
    Number,
}

macro_rules! columns {
    ($($about:literal $name:ident $kind:ident)*) => { $(
        #[doc = $about]
        pub(crate) fn $name<C: Into<Cell>>(mut self, name: impl Into<Cell>, cell: impl Fn(&R) -> C + 'a) -> Self {
            self.columns.push(TableColumn {
                name: name.into(),
                kind: ColumnKind::$kind,
                cell: Box::new(move |row| cell(row).into()),
                on_terminal: true,
            });
            self
        }
    )* };
}

impl<'a, R> Table<'a, R> {
    /// Returns a table without columns, with its classes on a page.
    pub(crate) fn new(class: &'static str) -> Self {
        Self {
            class,
            caption: None,
            columns: Vec::new(),
            row_class: Box::new(|_| ""),
        }
    }

    /// Sets the caption on a page.
    pub(crate) fn caption(mut self, text: impl Into<String>) -> Self {
        self.caption = Some((text.into(), true));
        self
    }

    /// Sets the caption on a page for screen readers only.
    pub(crate) fn spoken(mut self, text: impl Into<String>) -> Self {
        self.caption = Some((text.into(), false));
        self
    }

    /// Sets the class of a row on a page.
    pub(crate) fn row_class(mut self, class: impl Fn(&R) -> &'static str + 'a) -> Self {
        self.row_class = Box::new(class);
        self
    }

    columns! {
        "Adds a column of the names of rows." head Head
        "Adds a column of texts." text Text
        "Adds a column of numbers." number Number
    }

    /// Leaves the column that was added last out of terminals.
    pub(crate) fn only_on_page(mut self) -> Self {
        if let Some(column) = self.columns.last_mut() {
            column.on_terminal = false;
        }
        self
    }

    /// Returns the table on a page.
    pub(crate) fn page(&self, rows: impl IntoIterator<Item = R>) -> Markup {
        let class = |class: &'static str| (!class.is_empty()).then_some(class);
        html! {
            div.wide { table class=[class(self.class)] {
                @if let Some((caption, seen)) = &self.caption { caption class=[(!seen).then_some("vh")] { (caption) } }
                thead { tr { @for column in &self.columns { th scope="col" {
                    @match (&column.name.html, column.page_name()) {
                        (None, Some(name)) => (name),
                        _ => (column.name.shown()),
                    }
                } } } }
                tbody { @for row in rows {
                    tr class=[class((self.row_class)(&row))] { @for column in &self.columns { (self.cell_on_page(column, &row)) } }
                } }
            } }
        }
    }

    /// Returns the table on a page: the first rows, then the other rows folded behind a summary.
    pub(crate) fn folded(&self, rows: &[R]) -> Markup
    where
        R: Copy,
    {
        let (first, others) = rows.split_at(rows.len().min(FIRST));
        html! {
            (self.page(first.iter().copied()))
            @if !others.is_empty() {
                details {
                    summary { (others.len()) " more" }
                    (self.page(others.iter().copied()))
                }
            }
        }
    }

    fn cell_on_page(&self, column: &TableColumn<'a, R>, row: &R) -> Markup {
        let cell = (column.cell)(row);
        // A stacked table has no head on a narrow screen.
        let name = column
            .page_name()
            .filter(|_| self.class.contains("stacked"));
        match column.kind {
            ColumnKind::Head => cell.with("scope", "row".to_owned()).element("th"),
            ColumnKind::Text => cell.with("data-head", name).element("td"),
            ColumnKind::Number => cell.with("data-head", name).class("num").element("td"),
        }
    }

    /// Returns the lines of the table's head in Markdown, and a line per row. The cells' texts must already
    /// be Markdown.
    pub(crate) fn markdown(&self, rows: impl IntoIterator<Item = R>) -> (String, Vec<String>) {
        let line = |cell: &dyn Fn(&TableColumn<'a, R>) -> Cell| {
            let cells = self
                .columns
                .iter()
                .map(|c| cell(c).text.unwrap_or_default());
            format!("| {} |", cells.collect::<Vec<_>>().join(" | "))
        };
        let mark = |c: &TableColumn<'a, R>| match c.kind {
            ColumnKind::Head | ColumnKind::Text => "---|",
            ColumnKind::Number => "---:|",
        };
        let marks: String = self.columns.iter().map(mark).collect();
        let head = format!("{}\n|{marks}", line(&|c| c.name.clone()));
        let rows = rows.into_iter().map(|row| line(&|c| (c.cell)(&row)));
        (head, rows.collect())
    }

    /// Returns the table on a terminal. Leaves out columns in the order of `optional` until the rest fits,
    /// and returns the names of the columns left out.
    pub(crate) fn terminal(
        &self,
        rows: impl IntoIterator<Item = R>,
        options: TableOptions,
        optional: &[&'static str],
    ) -> (String, Vec<&'static str>) {
        let columns: Vec<&TableColumn<'a, R>> =
            self.columns.iter().filter(|c| c.on_terminal).collect();
        let names: Vec<String> = columns.iter().map(|c| c.name.on_terminal()).collect();
        let cells = |row| columns.iter().map(|c| (c.cell)(&row)).collect();
        let rows: Vec<Vec<Cell>> = rows.into_iter().map(cells).collect();
        let widest = |x: usize| {
            let cells = rows.iter().map(|row| row[x].on_terminal().chars().count());
            cells.fold(names[x].chars().count(), usize::max)
        };
        // A border and two spaces for each column, and the last border.
        let mut width: usize = (0..columns.len()).map(|x| widest(x) + 3).sum::<usize>() + 1;
        let mut shown: Vec<usize> = (0..columns.len()).collect();
        let mut left_out = Vec::new();
        for name in optional {
            if width <= options.width {
                break;
            }
            if let Some(place) = shown.iter().position(|x| names[*x] == *name) {
                width -= widest(shown.remove(place)) + 3;
                left_out.push(*name);
            }
        }
        let mut builder = Builder::default();
        builder.push_record(shown.iter().map(|x| &names[*x]));
        for row in &rows {
            builder.push_record(shown.iter().map(|x| row[*x].on_terminal()));
        }
        let mut table = builder.build();
        table.with(Style::rounded());
        for (place, x) in shown.iter().enumerate() {
            if columns[*x].kind == ColumnKind::Number {
                table.modify(Columns::one(place), Alignment::right());
            }
            for (y, row) in rows.iter().enumerate().filter(|_| options.color) {
                if let Some(color) = &row[*x].color {
                    table.modify(Place::new(y + 1, place), color.clone());
                }
            }
        }
        if options.color {
            table.modify(Rows::first(), Color::BOLD);
        }
        let wrap = Width::wrap(options.width).keep_words(true);
        table.with(wrap.priority(Priority::max(true)));
        (table.to_string(), left_out)
    }
}

impl<R> TableColumn<'_, R> {
    /// Returns the text of the name on a page. It begins with a capital letter, unless [`as_is`] made it.
    fn page_name(&self) -> Option<String> {
        let text = self.name.text.as_deref();
        text.map(|text| match self.name.html {
            None => capital(text),
            Some(_) => text.to_owned(),
        })
    }
}
