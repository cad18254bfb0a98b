//! Innocents on the page of a hunt and in its summary: behaviours that a specification permits, and the verdicts on them.

use crate::numbers::count;
use crate::sighting::sighting;
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
            p.state.good { b { "✓ " (count(hunt.innocents.len() as u64, "innocent")) ": no accusation." } }
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
                "Behaviours that some specification permits, of the kind that hardware has, judged under each "
                "specification. Where a behaviour is permitted, no case may fail. Where it is forbidden, a case may "
                "have the verdict of the evidence, and no worse one. Profiles combine what a kind of hardware does, as "
                "far as a specification permits it; they and the rasterizer itself are drawn with all cases, single "
                "behaviours with some of each file and with all files that show them."
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
        .text(
            "Verdicts",
            |i| html! { @for (names, tally) in grouped(i) { (verdicts(&names, tally)) } },
        )
        .text("Behaviour", |i| &*i.innocent.about)
        .text("Source", |i| &*i.innocent.source)
        .text("Permissions", |i| i.innocent.permissions.join(", "))
        .number("Cases that differ", |i| i.changed)
}

/// Returns the tallies that differ, each with the short names of its specifications.
fn grouped(innocent: &InnocentRecord) -> Vec<(String, &InnocentTally)> {
    let mut groups: Vec<(Vec<&str>, &InnocentTally)> = Vec::new();
    let shown = |t: &InnocentTally| {
        let worst = t.worst.as_ref().map(|w| w.verdict);
        (t.forbidden, t.imprecise, t.violations, t.shared, worst)
    };
    for tally in &innocent.specifications {
        let name = tally.specification.split(" (").next().unwrap_or_default();
        match groups
            .iter_mut()
            .find(|(_, known)| shown(known) == shown(tally))
        {
            Some((names, _)) => names.push(name),
            None => groups.push((vec![name], tally)),
        }
    }
    let all = innocent.specifications.len();
    let named = groups.into_iter().map(|(names, tally)| {
        let is_all = names.len() == all;
        (
            if is_all {
                "All".to_owned()
            } else {
                names.join(", ")
            },
            tally,
        )
    });
    named.collect()
}

fn verdicts(names: &str, tally: &InnocentTally) -> Markup {
    html! {
        div {
            b { (names) } ": "
            @match tally.due() {
                None => "permitted",
                Some(verdict) => { "forbidden (" (verdict) ")" }
            }
            @if tally.imprecise > 0 { ", " (tally.imprecise) " imprecise" }
            @if let Some(worst) = &tally.worst {
                ", " (count(tally.violations, "violation")) " up to " (worst.verdict)
                @if tally.is_accused() { " ✗ " (sighting(worst)) }
            }
            @if let Some(shared) = tally.shared { ", " (shared) " like the rasterizer itself" }
        }
    }
}
