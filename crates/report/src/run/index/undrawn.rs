//! What the run says nothing about: cases that were not drawn, and expectations that are dead.

use crate::mark::mark;
use crate::numbers::count;
use crate::page::adapter::breakable;
use crate::run::dead::meaning;
use crate::run::undrawn::{Undrawn, undrawn};
use crate::table::{Table, some};
use crate::words::{Tone, plain};
use etalon_record::{Dead, Run};
use maud::{Markup, html};

/// The most rows of each table.
const ROWS: usize = 500;

/// The cases that were not drawn: a row per reason, a column per adapter.
pub(crate) fn section(run: &Run) -> Markup {
    let reasons = undrawn(run);
    let all: u64 = reasons.iter().map(Undrawn::records).sum();
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
                    b { (all) } " of " (count(run.records.len() as u64, "record"))
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
                ul { @for one in dead.iter().take(ROWS) {
                    li { (meaning(one.kind)) ": " code { (plain(&one.place, 200)) } ": " (plain(&one.about, 300)) }
                } }
                @if dead.len() > ROWS { p.note { "and " (dead.len() - ROWS) " more" } }
            }
        }
    }
}
