//! The adapters of a run, and the remedies for absent ones.

use crate::page::adapter::details;
use etalon_record::Header;
use maud::{Markup, html};

pub(crate) fn section(header: &Header) -> Markup {
    html! {
        section id="adapters" {
            h2 { "Adapters" }
            @if header.adapters.is_empty() { p { "None." } }
            @for adapter in &header.adapters { (details(adapter)) }
            @if !header.absent.is_empty() {
                h3 { "Absent" }
                div.wide { table.text {
                    caption.vh { "Adapters that are absent" }
                    thead { tr { th scope="col" { "Adapter" } th scope="col" { "Reason" } th scope="col" { "Remedy" } } }
                    tbody {
                        @for absent in &header.absent {
                            tr { th scope="row" { (absent.name) } td { (absent.reason) } td { (absent.remedy) } }
                        }
                    }
                } }
            }
        }
    }
}
