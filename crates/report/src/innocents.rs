//! Innocents on the page of a hunt and in its summary: legal behaviours, and whether a case accuses them.

use crate::hunt::sighting;
use crate::numbers::count;
use crate::table::{Cell, Table};
use crate::words::plain;
use etalon_record::{Hunt, InnocentRecord, InnocentTally};
use maud::{Markup, html};
use std::collections::{BTreeMap, BTreeSet};

/// The specifications' verdicts in a line for a terminal; `None` without innocents.
pub(super) fn totals(hunt: &Hunt) -> Option<String> {
    let first = hunt.innocents.first()?;
    Some(format!(
        "{} innocents with {} permissions, {} specifications, {} cases: {} accused",
        hunt.innocents.len(),
        permissions(hunt),
        first.specifications.len(),
        hunt.cases,
        accused(hunt)
    ))
}

/// Returns the number of permissions that the innocents use.
fn permissions(hunt: &Hunt) -> usize {
    let used = hunt.innocents.iter().flat_map(|i| &i.innocent.permissions);
    used.collect::<BTreeSet<_>>().len()
}

/// Returns the number of innocents that some specification accuses of more than its evidence supports.
fn accused(hunt: &Hunt) -> usize {
    let is_accused = |i: &&InnocentRecord| i.specifications.iter().any(InnocentTally::is_accused);
    hunt.innocents.iter().filter(is_accused).count()
}

/// Returns lines for a terminal about the innocents whose verdicts are wrong: the specifications with each reason, and
/// the case with the worst verdict.
pub(super) fn complaints(hunt: &Hunt, room: usize) -> String {
    let mut text = String::new();
    for innocent in &hunt.innocents {
        let mut reasons: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for (specification, why) in innocent.complaints(hunt.every_case) {
            reasons.entry(why).or_default().push(specification);
        }
        let name = plain(&innocent.innocent.name, 100);
        for (why, specifications) in &reasons {
            text += &format!(
                "  {name}: {why}: {}\n",
                plain(&specifications.join(", "), 200)
            );
        }
        let accused = innocent.specifications.iter().filter(|t| t.is_accused());
        let worst = accused
            .filter_map(|t| t.worst.as_ref())
            .max_by_key(|w| w.verdict.severity());
        text.extend(worst.map(|w| format!("      {}: {}\n", w.verdict, plain(&w.case, room))));
    }
    text
}

/// Returns the sentence of the page's head, in its colour.
pub(super) fn state(hunt: &Hunt) -> Markup {
    let wrong: Vec<_> = hunt.innocent_complaints().collect();
    html! {
        @if wrong.is_empty() {
            p.state.good { b { "✓ No innocent is accused: none of " (count(hunt.innocents.len() as u64, "legal behaviour")) "." } }
        } @else {
            p.state.bad { b { "✗ " (count(wrong.len() as u64, "wrong verdict")) " on innocents." } }
            ul { @for (innocent, specification, why) in &wrong {
                li { a href={ "#innocent/" (innocent.innocent.name) } { (innocent.innocent.name) } ", " (specification) ": " (why) }
            } }
        }
    }
}

/// Returns the section of all innocents.
pub(super) fn section(hunt: &Hunt) -> Markup {
    html! {
        section {
            h2 { "Innocents" }
            p {
                "Behaviours that some specification permits, of the kind that hardware has. Each is drawn in every case "
                "and judged under each specification. If it is permitted, no case may fail; if it is forbidden, a case must "
                "show it, with no more than the verdict that the evidence supports."
            }
            (table().page(&hunt.innocents))
        }
    }
}

fn table<'a>() -> Table<'a, &'a InnocentRecord> {
    Table::new("figures")
        .head("Name", |i: &&InnocentRecord| {
            let name = &i.innocent.name;
            Cell::from(name).with("id", format!("innocent/{name}"))
        })
        .text("Behaviour", |i| &*i.innocent.about)
        .text("Source", |i| &*i.innocent.source)
        .text("Permissions", |i| i.innocent.permissions.join(", "))
        .number("Cases that differ", |i| i.changed)
        .text(
            "Verdicts",
            |i| html! { @for tally in &i.specifications { (verdicts(tally)) } },
        )
}

fn verdicts(tally: &InnocentTally) -> Markup {
    let due = match tally.due() {
        None => "permitted".to_owned(),
        Some(verdict) => format!("due {verdict}"),
    };
    html! {
        div {
            b { (tally.specification) } " " (due)
            @if tally.imprecise > 0 { ", " (tally.imprecise) " imprecise" }
            @if let Some(worst) = &tally.worst {
                ", " (tally.violations) " at most " (worst.verdict)
                @if tally.is_accused() { " " (sighting(worst)) }
            }
        }
    }
}
