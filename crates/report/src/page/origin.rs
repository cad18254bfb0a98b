//! The first facts of a page: the origin of its data.

use crate::words::machine;
use etalon_record::Provenance;
use maud::{Markup, html};

/// Returns the entries for a list of facts: start, command, machine and suite.
pub(crate) fn origin(from: &Provenance) -> Markup {
    html! {
        dt { "Started" } dd { (from.started) }
        dt { "Command" } dd { code { (from.command.join(" ")) } }
        dt { "Machine" } dd { (machine(&from.machine)) }
        dt { "Suite" } dd {
            "etalon " (from.etalon)
            @if let Some(commit) = &from.commit { ", commit " code { (commit) } }
        }
    }
}
