//! The sections without news: known failures, cases that were not drawn, dead expectations.

use super::parts::{DETAILS, INDEX, SAME_PAGE};
use crate::numbers::count;
use crate::run::blind::blind_spots;
use crate::run::dead::meaning;
use crate::run::reasons::{PageReasons, ReasonRecords, total};
use crate::table::Table;
use crate::words::{plain, symbol};
use etalon_record::{Dead, Run};
use maud::{Markup, html};

/// The maximum number of rows of a list on the first page.
const FIRST: usize = 120;
/// The maximum number of rows of a list on the page of details.
const ROWS: usize = 1000;

/// Returns the failures that were expected: a row per reason.
pub(super) fn known(run: &Run, reasons: &PageReasons) -> Markup {
    let hidden = blind_spots(run.all_records());
    let known = &reasons.known;
    html! {
        @if !known.is_empty() {
            section id="known" {
                h2 { "Known" }
                p {
                    (count(total(known), "bad verdict")) " of " (count(known.len() as u64, "reason"))
                    " that the expectations or the triage name. They do not count against the run."
                }
                (first_rows(&table("Known failures by reason", SAME_PAGE), known, 0))
                @if !hidden.is_empty() {
                    p {
                        b { "Hidden: " } "an adapter draws every case of " (count(hidden.len() as u64, "kind"))
                        " wrong as expected, so that no other bug can show there."
                    }
                    @let rows: Vec<NumberedReason<'_>> = hidden.iter().take(FIRST).map(|spot| (None, spot)).collect();
                    (table("Cases that an adapter draws wrong throughout", SAME_PAGE).folded(&rows))
                }
            }
        }
    }
}

/// Returns the cases that were not drawn: a row per reason.
pub(super) fn not_drawn(run: &Run, reasons: &PageReasons) -> Markup {
    let undrawn = &reasons.undrawn;
    html! {
        @if !undrawn.is_empty() {
            section id="undrawn" {
                h2 { "Not drawn" }
                p {
                    b { (total(undrawn)) } " of " (count(run.records.len() as u64, "record"))
                    " are of cases that were not drawn. Nothing is known about them."
                }
                (first_rows(&table("Reasons why cases were not drawn", SAME_PAGE), undrawn, reasons.known.len()))
            }
        }
    }
}

/// Returns all reasons.
pub(super) fn reasons(reasons: &PageReasons) -> Markup {
    let all = reasons.known.iter().chain(&reasons.undrawn).enumerate();
    let rows = all
        .take(ROWS)
        .map(|(number, reason)| (Some(number), reason));
    let left = (reasons.known.len() + reasons.undrawn.len()).saturating_sub(ROWS);
    html! {
        section id="reasons" {
            h2 { "All reasons" }
            p { "The reasons of known failures, then the reasons why cases were not drawn." }
            (table("Reasons of known failures and of cases that were not drawn", INDEX).page(rows))
            @if left > 0 { p.note { "and " (count(left as u64, "other reason")) } }
        }
    }
}

/// A reason, and its number if its cases can be listed.
type NumberedReason<'a> = (Option<usize>, &'a ReasonRecords);

/// Returns a table of reasons. `page` is the page that lists the cases.
fn table<'a>(caption: &str, page: &'static str) -> Table<'a, NumberedReason<'a>> {
    Table::new("reasons stacked")
        .spoken(caption)
        .head("Reason", move |(number, reason): &NumberedReason<'_>| {
            let text = plain(
                &format!("{} {}", symbol(reason.verdict), reason.sentence()),
                300,
            );
            html! {
                @if let Some(number) = number { a href={ (page) "#reason=" (number) } { (text) } }
                @else { (text) }
            }
        })
        .number("Records", |(_, reason)| reason.records())
        .text("Adapters", |(_, reason)| adapters(reason))
}

/// Returns the first reasons; the numbers of reasons begin with `start`.
fn first_rows<'a>(
    table: &Table<'a, NumberedReason<'a>>,
    reasons: &'a [ReasonRecords],
    start: usize,
) -> Markup {
    let numbered = reasons.iter().zip(start..).take(FIRST);
    let rows: Vec<NumberedReason<'a>> = numbered.map(|(reason, n)| (Some(n), reason)).collect();
    html! {
        (table.folded(&rows))
        @if reasons.len() > FIRST {
            p.note {
                "and " a href={ (DETAILS) "#reasons" } { (count((reasons.len() - FIRST) as u64, "other reason")) }
            }
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
