//! The sections without news: known failures, cases that were not drawn, dead expectations.

use crate::mark::mark;
use crate::numbers::count;
use crate::run::blind::blind_spots;
use crate::run::dead::meaning;
use crate::run::reasons::{ReasonRecords, known as known_reasons, total, undrawn};
use crate::table::Table;
use crate::words::{Tone, plain};
use etalon_record::{Dead, Run};
use maud::{Markup, html};

/// The most rows of each list.
const ROWS: usize = 500;

/// Returns the failures that were expected: a row per reason.
pub(super) fn known(run: &Run) -> Markup {
    let reasons = known_reasons(run);
    let hidden = blind_spots(run.all_records());
    html! {
        @if !reasons.is_empty() {
            section id="known" {
                h2 { "Known" }
                p {
                    (count(total(&reasons), "bad verdict")) " of " (count(reasons.len() as u64, "reason"))
                    " in the expectations or the triage."
                }
                (table("Known failures by reason", &reasons))
                @if !hidden.is_empty() {
                    p {
                        b { "Hidden: " } "an adapter draws every case of " (count(hidden.len() as u64, "kind"))
                        " wrong as expected, so that no other bug can show there."
                    }
                    (table("Cases that an adapter draws wrong throughout", &hidden))
                }
            }
        }
    }
}

/// Returns the cases that were not drawn: a row per reason.
pub(super) fn not_drawn(run: &Run) -> Markup {
    let reasons = undrawn(run);
    html! {
        @if !reasons.is_empty() {
            section id="undrawn" {
                h2 { "Not drawn" }
                p {
                    b { (total(&reasons)) } " of " (count(run.records.len() as u64, "record"))
                    " are of cases that were not drawn. Nothing is known about them."
                }
                (table("Reasons why cases were not drawn", &reasons))
            }
        }
    }
}

fn table(caption: &str, reasons: &[ReasonRecords]) -> Markup {
    let shown: Vec<&ReasonRecords> = reasons.iter().take(ROWS).collect();
    let table = Table::<&ReasonRecords>::new("reasons stacked")
        .spoken(caption)
        .head("Reason", |reason| {
            html! { (mark(reason.verdict, Tone::Plain)) ": " (plain(&reason.text, 300)) }
        })
        .number("Records", |reason| reason.records())
        .text("Adapters", |reason| adapters(reason));
    html! {
        (table.folded(&shown))
        @if reasons.len() > ROWS {
            p.note { "and " (count((reasons.len() - ROWS) as u64, "other reason")) }
        }
    }
}

/// Returns the adapters of a reason; if there are many, folded behind their number.
fn adapters(reason: &ReasonRecords) -> Markup {
    let list = reason.each().join(", ");
    html! {
        @if reason.adapters.len() > 3 {
            details { summary { (reason.adapters.len()) " adapters" } (list) }
        } @else { (list) }
    }
}

/// Returns the dead expectations.
pub(super) fn dead(dead: &[Dead]) -> Markup {
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
