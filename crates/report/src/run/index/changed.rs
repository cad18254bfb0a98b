//! The changes since the last run of each adapter.

use crate::lists::{self, grouped};
use crate::mark::mark;
use crate::news::{NewsEntry, RunNews};
use crate::page::adapter::adapter;
use crate::page::link;
use crate::table::Table;
use crate::words::{Tone, plain};
use etalon_frame::CaseId;
use maud::{Markup, html};

/// The most rows of each kind.
const ROWS: usize = 60;

/// Returns the section: what broke, what was fixed, and the runs that this one was compared with.
pub(super) fn section(news: &RunNews) -> Markup {
    let runs = news
        .since
        .iter()
        .map(|since| (since.run.as_deref(), &*since.adapter));
    html! {
        section id="changed" {
            h2 { "Changed since the last run" }
            @if news.broken.is_empty() && news.fixed.is_empty() { p { "Nothing broke, and nothing was fixed." } }
            (kind("broken", &news.broken))
            (kind("bad, nothing to compare", &news.uncompared))
            (kind("fixed", &news.fixed))
            (kind("no longer counted, but not fixed", &news.undecided))
            details {
                summary { "Compared with" }
                ul { @for (run, adapters) in grouped(runs) {
                    li {
                        @match run { Some(run) => (plain(run, 300)), None => "no earlier run" }
                        ": " (adapters.join(", "))
                    }
                } }
            }
        }
    }
}

fn kind(name: &str, entries: &[NewsEntry]) -> Markup {
    let mut shown: Vec<&NewsEntry> = entries.iter().collect();
    // The first of each case file and adapter comes before the second of any.
    lists::spread(&mut shown, |entry| {
        (
            CaseId::new(&entry.case).file(),
            &*entry.adapter,
            entry.verdict,
        )
    });
    shown.truncate(ROWS);
    let table = Table::<&NewsEntry>::new("stacked")
        .spoken(format!("Records that are {name} since the last run"))
        .text("Now", |entry| mark(entry.verdict, Tone::Plain))
        .head("Case", |entry| {
            html! { a href=(link::case(&entry.case)) { code { (plain(&entry.case, 300)) } } }
        })
        .text("Adapter", |entry| adapter(&entry.adapter))
        .text("Before", |entry| plain(&entry.note, 300));
    html! {
        @if !entries.is_empty() {
            h3 { (entries.len()) " " (name) }
            (table.folded(&shown))
            @if entries.len() > ROWS { p.note { "and " (entries.len() - ROWS) " more; summary.md and the history have them" } }
        }
    }
}
