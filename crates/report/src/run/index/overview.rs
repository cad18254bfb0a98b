//! Sections on the run as a whole: areas by adapter, cases that were not drawn, and dead expectations.

use crate::mark::{class, mark};
use crate::numbers::count;
use crate::page::adapter::breakable;
use crate::run::dead::meaning;
use crate::run::grid::{Area, Grid, Tally};
use crate::run::undrawn::{Undrawn, undrawn};
use crate::table::{Cell, Table, some};
use crate::words::{Tone, plain};
use etalon_record::{Dead, Run, Verdict};
use maud::{Markup, html};

/// Areas against adapters.
pub(crate) fn matrix(grid: &Grid<'_>) -> Markup {
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

/// The maximum number of rows of each table.
const ROWS: usize = 500;

/// The cases that were not drawn: a row per reason, a column per adapter.
pub(crate) fn not_drawn(run: &Run) -> Markup {
    let reasons = undrawn(run);
    let undrawn_records: u64 = reasons.iter().map(Undrawn::records).sum();
    let mut table = Table::<&Undrawn>::new("")
        .spoken("Reasons why cases were not drawn")
        .head("Reason", |reason| {
            html! { (mark(reason.verdict, Tone::Plain)) ": " (plain(&reason.reason, 300)) }
        })
        .number("Records", |reason| reason.records());
    for adapter in &run.header.adapters {
        if reasons.iter().any(|reason| reason.on(&adapter.name) > 0) {
            table = table.number(breakable(&adapter.name), |reason| {
                some(reason.on(&adapter.name))
            });
        }
    }
    html! {
        @if !reasons.is_empty() {
            section id="undrawn" {
                h2 { "Not drawn" }
                p {
                    b { (undrawn_records) } " of " (count(run.records.len() as u64, "record"))
                    " are of cases that were not drawn. Nothing is known about them."
                }
                (table.page(reasons.iter().take(ROWS)))
                @if reasons.len() > ROWS {
                    p.note { "and " (count((reasons.len() - ROWS) as u64, "other reason")) }
                }
            }
        }
    }
}

/// The dead expectations.
pub(crate) fn dead(dead: &[Dead]) -> Markup {
    html! {
        @if !dead.is_empty() {
            section id="dead" {
                h2 { "Dead expectations" }
                p { "They excuse nothing: correct or remove them." }
                ul { @for entry in dead.iter().take(ROWS) {
                    li { (meaning(entry.kind)) ": " code { (plain(&entry.place, 200)) } ": " (plain(&entry.about, 300)) }
                } }
                @if dead.len() > ROWS { p.note { "and " (dead.len() - ROWS) " more" } }
            }
        }
    }
}
