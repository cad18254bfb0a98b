//! What the run says nothing about: cases that were not drawn, and expectations that are dead.

use crate::mark::mark;
use crate::numbers::count;
use crate::page::adapter::breakable;
use crate::run::dead::meaning;
use crate::run::undrawn::{Undrawn, undrawn};
use crate::words::{Tone, plain};
use etalon_record::{Dead, Run};
use maud::{Markup, html};

/// The most rows of each table.
const ROWS: usize = 500;

/// The cases that were not drawn: a row per reason, a column per adapter.
pub(crate) fn section(run: &Run) -> Markup {
    let reasons = undrawn(run);
    let all: u64 = reasons.iter().map(Undrawn::records).sum();
    let names: Vec<&str> = run
        .header
        .adapters
        .iter()
        .map(|a| a.name.as_str())
        .collect();
    let used: Vec<&str> = names
        .into_iter()
        .filter(|name| reasons.iter().any(|r| of(r, name) > 0))
        .collect();
    html! {
        @if !reasons.is_empty() {
            section id="undrawn" {
                h2 { "Not drawn" }
                p {
                    b { (all) } " of " (count(run.records.len() as u64, "record"))
                    " are of cases that were not drawn. Nothing is known about them."
                }
                div.wide { table {
                    caption.vh { "Reasons why cases were not drawn" }
                    thead { tr {
                        th scope="col" { "Reason" } th scope="col" { "Records" }
                        @for name in &used { th scope="col" { (breakable(name)) } }
                    } }
                    tbody { @for reason in reasons.iter().take(ROWS) {
                        tr {
                            th scope="row" {
                                (mark(reason.verdict, Tone::Plain)) ": " (plain(&reason.reason, 300))
                            }
                            td.num { (reason.records()) }
                            @for name in &used {
                                td.num { @match of(reason, name) { 0 => { "·" } n => { (n) } } }
                            }
                        }
                    } }
                } }
                @if reasons.len() > ROWS {
                    p.note { "and " (count((reasons.len() - ROWS) as u64, "other reason")) }
                }
            }
        }
    }
}

fn of(reason: &Undrawn, adapter: &str) -> u64 {
    let mut adapters = reason.adapters.iter();
    adapters
        .find(|(name, _)| name == adapter)
        .map_or(0, |(_, n)| *n)
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
