//! Every case on every adapter, by case file.

use super::{class, mark};
use crate::grid::{CaseFile, CaseRow, Grid, Tally};
use crate::html::findings::Plan;
use crate::words::{self, Tone};
use etalon_record::Verdict;
use maud::{Markup, html};

pub(crate) fn section(grid: &Grid<'_>, plan: &Plan) -> Markup {
    let mut number = 0;
    html! {
        section id="cases" {
            h2 { "All cases" }
            p {
                "One group per case file, one row per case, one column per adapter."
                @for verdict in Verdict::ALL {
                    " " span.key { i { (words::symbol(verdict)) } " " (words::name(verdict)) }
                }
                " A verdict in parentheses was expected or due."
            }
            @for area in &grid.areas {
                h3 { (area.name) }
                @for file in &area.files {
                    (group(grid, plan, file, { number += 1; number - 1 }))
                }
            }
        }
    }
}

fn group(grid: &Grid<'_>, plan: &Plan, file: &CaseFile<'_>, number: usize) -> Markup {
    let tally = Tally::of(file.all().map(|i| grid.record(i)));
    html! {
        details {
            summary {
                code { (file.name) } " "
                small { (words::count(file.cases.len() as u64, "case")) }
                @for (verdict, tone, n) in tally.entries() {
                    span class={ "chip " (class(verdict, tone)) } { (n) " " (mark(verdict, tone)) }
                }
            }
            div.wide id={ "g" (number) } { table.cases {
                thead { tr {
                    th { "Case" }
                    @for adapter in &grid.adapters { th { (super::adapters::breakable(adapter)) } }
                } }
                tbody { @for case in &file.cases { (row(grid, plan, file, case)) } }
            } }
        }
    }
}

fn row(grid: &Grid<'_>, plan: &Plan, file: &CaseFile<'_>, case: &CaseRow<'_>) -> Markup {
    let rest = case.id.strip_prefix(file.name).unwrap_or(case.id);
    let rest = rest.trim_start_matches('/');
    html! {
        tr {
            th { (if rest.is_empty() { case.id } else { rest }) }
            @for record in &case.records {
                @match record {
                    Some(index) => (cell(grid, plan, *index)),
                    None => td title="no record" {},
                }
            }
        }
    }
}

fn cell(grid: &Grid<'_>, plan: &Plan, index: usize) -> Markup {
    let record = grid.record(index);
    let (verdict, tone) = (record.verdict, Tone::of(record));
    let symbol = words::symbol(verdict);
    let text = match tone {
        Tone::Excused => format!("({symbol})"),
        Tone::Missed => format!("{symbol} not caught"),
        Tone::Plain if verdict.is_bad() => format!("{symbol} {}", words::name(verdict)),
        Tone::Plain => symbol.to_owned(),
    };
    html! {
        td class=(class(verdict, tone)) title={ (words::name(verdict)) (tone.suffix()) } {
            @if plan.lists(index) {
                a href={ "#r" (index) } { (text) }
            } @else {
                (text)
            }
        }
    }
}
