//! The first facts of a page: where its data comes from.

use crate::words::machine;
use etalon_record::Machine;
use maud::{Markup, html};

/// The origin of a run, a bench or a hunt, as its header states it.
pub(crate) struct Origin<'a> {
    /// The time of the start, RFC 3339.
    pub(crate) started: &'a str,
    /// The command line, program first.
    pub(crate) command: &'a [String],
    /// The machine.
    pub(crate) machine: &'a Machine,
    /// The suite's version.
    pub(crate) etalon: &'a str,
    /// The commit that the suite was built from, where it is known.
    pub(crate) commit: Option<&'a str>,
}

impl Origin<'_> {
    /// Returns the entries for a list of facts.
    pub(crate) fn facts(&self) -> Markup {
        html! {
            dt { "Started" } dd { (self.started) }
            dt { "Command" } dd { code { (self.command.join(" ")) } }
            dt { "Machine" } dd { (machine(self.machine)) }
            dt { "Suite" } dd {
                "etalon " (self.etalon)
                @if let Some(commit) = self.commit { ", commit " code { (commit) } }
            }
        }
    }
}
