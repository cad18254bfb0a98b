//! The first facts of a page: the origin of its data.

use crate::words::machine;
use etalon_record::Machine;
use maud::{Markup, html};

/// Returns the facts of a header's origin: start, command, machine and suite.
macro_rules! origin {
    ($header:expr) => {{
        let header = &$header;
        let suite = (&*header.etalon, header.commit.as_deref());
        $crate::page::origin::facts(&header.started, &header.command, &header.machine, suite)
    }};
}
pub(crate) use origin;

/// Returns the entries for a list of facts. The suite is its version and, if it is known, its commit.
pub(crate) fn facts(
    started: &str,
    command: &[String],
    machine: &Machine,
    (etalon, commit): (&str, Option<&str>),
) -> Markup {
    html! {
        dt { "Started" } dd { (started) }
        dt { "Command" } dd { code { (command.join(" ")) } }
        dt { "Machine" } dd { (self::machine(machine)) }
        dt { "Suite" } dd {
            "etalon " (etalon)
            @if let Some(commit) = commit { ", commit " code { (commit) } }
        }
    }
}
