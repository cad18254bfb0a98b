//! The adapters of a run, and the remedies for absent ones.

use crate::page::adapter::details;
use crate::table::Table;
use etalon_record::{AbsentAdapter, Header};
use maud::{Markup, html};

pub(crate) fn section(header: &Header) -> Markup {
    html! {
        section id="adapters" {
            h2 { "Adapters" }
            @if header.adapters.is_empty() { p { "None." } }
            @for adapter in &header.adapters { (details(adapter)) }
            @if !header.absent.is_empty() {
                h3 { "Absent" }
                (absent().page(&header.absent))
            }
        }
    }
}

fn absent<'a>() -> Table<'a, &'a AbsentAdapter> {
    Table::new("text")
        .spoken("Adapters that are absent")
        .head("Adapter", |absent: &&AbsentAdapter| &*absent.name)
        .text("Reason", |absent| &*absent.reason)
        .text("Remedy", |absent| &*absent.remedy)
}
