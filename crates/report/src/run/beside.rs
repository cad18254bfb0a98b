//! Unexpected records beside those of the selected cases. Expected ones are among the known failures.

use crate::mark::mark;
use crate::table::Table;
use crate::words::{Tone, headline, plain};
use etalon_record::{Record, Run};
use maud::{Markup, html};

/// The maximum number of rows.
const LISTED: usize = 60;

/// Returns the table of the unexpected records beside the selected cases.
pub(super) fn section(run: &Run) -> Markup {
    let unexpected = run.beside.iter().filter(|r| r.unexpected());
    let records: Vec<&Record> = unexpected.take(LISTED).collect();
    let table = Table::<&Record>::new("stacked")
        .spoken("Records beside the selected cases")
        .text("Adapter", |record| record.adapter.clone())
        .head(
            "Record",
            |record| html! { (mark(record.verdict, Tone::of(record))) ": " (plain(&headline(record), 300)) },
        )
        .text("Case", |record| record.case.clone());
    html! {
        @if !records.is_empty() {
            section id="beside" {
                h2 { "Beside the selected cases" }
                p { "What an adapter denies although its API's version requires it, and workers that failed after \
                     their last case." }
                (table.folded(&records))
            }
        }
    }
}
