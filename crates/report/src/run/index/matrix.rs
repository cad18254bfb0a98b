//! Areas against adapters.

use crate::mark::{class, mark};
use crate::page::adapter::breakable;
use crate::run::grid::{Area, Grid, Tally};
use crate::table::{Cell, Table};
use crate::words::Tone;
use etalon_record::Verdict;
use maud::{Markup, html};

pub(crate) fn section(grid: &Grid<'_>) -> Markup {
    // An area, or all of them.
    type Row<'a> = Option<(usize, &'a Area<'a>)>;
    let mut table = Table::<Row<'_>>::new("matrix")
        .spoken("Verdicts by area and adapter")
        .row_class(|row| row.map_or("sum", |_| ""))
        .head("Area", |row| match row {
            Some((a, area)) => html! { a href={ "#a" (a) } { (area.name) } },
            None => html! { "all" },
        });
    for (column, adapter) in grid.adapters.iter().enumerate() {
        table = table.text(breakable(adapter), move |row| match row {
            Some((a, area)) => cell(grid, &format!("#l{a}-{column}"), area.on(column)),
            None => cell(
                grid,
                "#findings",
                grid.areas.iter().flat_map(|area| area.on(column)),
            ),
        });
    }
    html! {
        section id="matrix" {
            h2 { "Areas and adapters" }
            p {
                "A cell has the colour of its worst unexpected verdict. A dashed edge means that "
                "bad verdicts in it were expected. Each cell leads to its list."
            }
            (table.page(grid.areas.iter().enumerate().map(Some).chain([None])))
        }
    }
}

fn cell(grid: &Grid<'_>, link: &str, records: impl Iterator<Item = usize>) -> Cell {
    let tally = Tally::of(records.map(|i| grid.record(i)));
    let shown = html! {
        @if tally.total > 0 {
            a href=(link) {
                @for (verdict, tone, n) in tally.entries() {
                    span.c { b { (n) } " " (mark(verdict, tone)) }
                }
            }
        } @else {
            span.c { "no record" }
        }
    };
    Cell::from(shown).class(cell_class(&tally))
}

fn cell_class(tally: &Tally) -> &'static str {
    if let Some(worst) = tally.worst {
        return class(worst, Tone::Plain);
    }
    let judged = [Verdict::Pass, Verdict::Imprecise, Verdict::Measured];
    match (
        judged.iter().any(|v| tally.plain(*v) > 0),
        tally.excused() > 0,
    ) {
        (true, true) => "p x",
        (true, false) => "p",
        (false, true) => "u x",
        (false, false) => "u",
    }
}
