//! Areas against adapters.

use crate::mark::{class, mark};
use crate::page::adapter::breakable;
use crate::run::grid::{Grid, Tally};
use crate::words::Tone;
use etalon_record::Verdict;
use maud::{Markup, html};

pub(crate) fn section(grid: &Grid<'_>) -> Markup {
    html! {
        section id="matrix" {
            h2 { "Areas and adapters" }
            p {
                "A cell has the colour of its worst unexpected verdict. A dashed edge means that "
                "bad verdicts in it were expected. Each cell leads to its list."
            }
            div.wide { table.matrix {
                caption.vh { "Verdicts by area and adapter" }
                thead { tr {
                    th scope="col" { "Area" }
                    @for adapter in &grid.adapters { th scope="col" { (breakable(adapter)) } }
                } }
                tbody {
                    @for (a, area) in grid.areas.iter().enumerate() {
                        tr {
                            th scope="row" { a href={ "#a" (a) } { (area.name) } }
                            @for column in 0..grid.adapters.len() {
                                (cell(grid, &format!("#l{a}-{column}"), area.on(column)))
                            }
                        }
                    }
                    tr.sum {
                        th scope="row" { "all" }
                        @for column in 0..grid.adapters.len() {
                            (cell(grid, "#findings", grid.areas.iter().flat_map(|a| a.on(column))))
                        }
                    }
                }
            } }
        }
    }
}

fn cell(grid: &Grid<'_>, link: &str, records: impl Iterator<Item = usize>) -> Markup {
    let tally = Tally::of(records.map(|i| grid.record(i)));
    html! {
        td class=(cell_class(&tally)) {
            @if tally.total > 0 {
                a href=(link) {
                    @for (verdict, tone, n) in tally.entries() {
                        span.c { b { (n) } " " (mark(verdict, tone)) }
                    }
                }
            } @else {
                span.c { "no record" }
            }
        }
    }
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
