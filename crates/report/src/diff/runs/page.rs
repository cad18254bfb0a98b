//! The comparison of two runs as a page.

use super::data::{CaseChange, ChangeDirection, Fact, RunDiff, both_names};
use super::table::{area_table, method_table, pair_table};
use super::times::statement;
use super::{phrases, pixels};
use crate::command;
use crate::error::ReportError;
use crate::files::replace_at;
use crate::lists::grouped;
use crate::numbers::count;
use crate::page::Page;
use crate::page::adapter::breakable;
use crate::picture::Strip;
use crate::table::Table;
use crate::words::{name, plain};
use maud::{Markup, html};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

const OWN_STYLE: &str = include_str!("runs.css");
/// The maximum number of changes of each direction that the page lists.
const LISTED: usize = 1000;
/// The maximum number of changes of a case file and direction that are shown in full.
const BODIES: usize = 20;
/// The maximum number of bytes of all pictures of the page together.
const PICTURE_BYTES: usize = 4 << 20;
/// The maximum number of rows of a table of cases.
const ROWS: usize = 500;

/// Writes a comparison of two runs as one page. The folders of the runs hold the frames for its pictures.
///
/// # Errors
/// Returns an error if the path names no file, or the file cannot be written.
pub fn write_page(
    path: &Path,
    diff: &RunDiff,
    folders: [&Path; 2],
) -> Result<PathBuf, ReportError> {
    replace_at(path, page(diff, &folders).as_bytes())
}

fn page(diff: &RunDiff, folders: &[&Path; 2]) -> String {
    let mut budget = PICTURE_BYTES;
    let main = html! {
        (head(diff))
        @for direction in ChangeDirection::ALL { (section(diff, direction, folders, &mut budget)) }
        (only(diff))
        (times(diff))
        (methods(diff))
        (pairs(diff))
        (reading())
        (about(diff))
    };
    Page::new(
        &format!("etalon diff: {}", headline(diff)),
        "the records and frames of two runs",
        &main,
    )
    .style(OWN_STYLE)
    .html()
}

fn headline(diff: &RunDiff) -> String {
    let [worse, better, other] = ChangeDirection::ALL.map(|d| diff.count(d));
    format!(
        "{worse} worse, {better} better, {other} other{}",
        phrases::beside(diff)
    )
}

fn head(diff: &RunDiff) -> Markup {
    let same: u64 = diff.pairs.iter().map(|p| p.same).sum();
    html! {
        header {
            h1 { "etalon diff" }
            p.lead { "Changes of verdicts, pixels and times between two runs." }
            @for warning in &diff.warnings { p.state.bad { b { "! " } (warning) } }
            @if diff.pairs.is_empty() {
                p.state.bad { b { "! Nothing was compared." } }
            }
            @if diff.worse() {
                p.state.bad { b { "✗ " (headline(diff)) } "; " (same) " the same." }
            } @else if diff.pairs.is_empty() {
            } @else if !diff.untold.is_empty() {
                p.state.o { b { "? Nothing is shown to be worse: " (headline(diff)) } "; " (same) " the same." }
            } @else if diff.changes.is_empty() {
                p.state.good { b { "✓ Nothing changed" } " in " (count(same, "record")) "." }
            } @else {
                p.state.good { b { "✓ Nothing is worse: " (headline(diff)) } "; " (same) " the same." }
            }
            nav {
                @for direction in ChangeDirection::ALL {
                    @if diff.count(direction) > 0 {
                        @let [.., title] = phrases::look(direction);
                        a href={ "#" (direction.name()) } { (title) } " "
                    }
                }
                @if !diff.only.is_empty() { a href="#only" { "In one run only" } " " }
                @if !diff.times.is_empty() { a href="#times" { "Times" } " " }
                @if !diff.methods.is_empty() { a href="#methods" { "Methods" } }
            }
        }
    }
}

/// A property of both runs.
struct Both {
    name: String,
    sides: [Markup; 2],
    differs: bool,
}

/// Returns a table of both sides. Rows that differ are marked.
fn both(rows: impl IntoIterator<Item = Both>) -> Markup {
    Table::new("two")
        .row_class(|row: &Both| if row.differs { "differs" } else { "" })
        .head("", |row| row.name.clone())
        .text("Before", |row| row.sides[0].clone())
        .text("After", |row| row.sides[1].clone())
        .page(rows)
}

fn facts(facts: &[Fact]) -> Markup {
    let shown = |text: &str| {
        html! { @if text.is_empty() { span.soft { "–" } } @else { (plain(text, 600)) } }
    };
    both(facts.iter().map(|fact| Both {
        name: format!("{}{}", fact.name, if fact.differs() { " ≠" } else { "" }),
        sides: [shown(&fact.before), shown(&fact.after)],
        differs: fact.differs(),
    }))
}

fn pairs(diff: &RunDiff) -> Markup {
    html! {
        section id="adapters" {
            h2 { "Adapters" }
            @if !diff.pairs.is_empty() { (pair_table().page(&diff.pairs)) }
            @for pair in &diff.pairs {
                @if !pair.facts.is_empty() {
                    @let differ = pair.facts.iter().filter(|f| f.differs()).count() as u64;
                    details open[differ > 0] {
                        summary { code { (pair.name()) } " " small { (count(differ, "fact")) " differ" @if differ == 1 { "s" } } }
                        (facts(&pair.facts))
                    }
                }
            }
            @for unpaired in &diff.unpaired {
                p.soft {
                    @if unpaired.worse { b { "✗ " } }
                    code { (unpaired.adapter) } " " (phrases::side(unpaired.side)) ": "
                    (count(unpaired.records, "record")) ", not compared."
                }
            }
        }
    }
}

fn section(
    diff: &RunDiff,
    direction: ChangeDirection,
    folders: &[&Path; 2],
    budget: &mut usize,
) -> Markup {
    let total = diff.count(direction);
    if total == 0 {
        return html! {};
    }
    // Chooses the first change of every kind before any second change, then groups the chosen changes by case
    // file.
    let chosen: HashSet<*const CaseChange> = phrases::spread(&diff.changes, direction)
        .into_iter()
        .take(LISTED)
        .map(std::ptr::from_ref)
        .collect();
    let these = diff.changes.iter().filter(|c| c.direction == direction);
    let these = these.filter(|c| chosen.contains(&std::ptr::from_ref(*c)));
    let files = grouped(these.map(|change| (&*change.case_file, change)));
    let left = total - chosen.len() as u64;
    let [.., title] = phrases::look(direction);
    html! {
        section id=(direction.name()) {
            h2 { (title) " (" (total) ")" }
            @if left > 0 {
                p.note { (left) " more are left out here; " code { "etalon diff --format json" } " has them all." }
            }
            @for (file, changes) in &files {
                div.file {
                    h3 { code { (file) } " " small { (count(changes.len() as u64, "change")) } }
                    @for (i, change) in changes.iter().enumerate() {
                        @if i < BODIES {
                            details.d {
                                summary { (line(change)) }
                                div.body { (body(change, folders, budget)) }
                            }
                        } @else {
                            p.d { (line(change)) }
                        }
                    }
                }
            }
        }
    }
}

fn line(change: &CaseChange) -> Markup {
    let [sign, ..] = phrases::look(change.direction);
    html! {
        span class={ "chip " (change.direction.name()) } {
            (sign) " " (phrases::verdicts(change))
        }
        " " code { (change.case) } " " small { (breakable(&both_names(&change.adapter))) }
    }
}

fn body(change: &CaseChange, folders: &[&Path; 2], budget: &mut usize) -> Markup {
    let [old, new] = &change.adapter;
    let run = |adapter: &str| command::run(&change.case, adapter);
    let verdict = Both {
        name: "verdict".to_owned(),
        sides: [0, 1].map(|i| {
            html! {
                b { (name(change.verdict[i])) }
                @if change.unexpected[i] { " (unexpected)" }
                br; small { (change.headline[i]) }
            }
        }),
        differs: change.verdict[0] != change.verdict[1],
    };
    let details = change.details.iter().map(|detail| Both {
        name: phrases::title(detail),
        sides: [&detail.before, &detail.after]
            .map(|value| html! { (plain(&phrases::value(value), 600)) }),
        differs: true,
    });
    html! {
        (both([verdict].into_iter().chain(details)))
        @if let Some(said) = phrases::expectation(change) { p { "The verdict is " (said) "." } }
        @if let Some(frame) = &change.frame {
            @for said in phrases::frame(frame) { p.cap { (said) } }
            @if !frame.equal() { (pictures(folders, frame, budget)) }
        }
        @if let Some(error) = &change.frame_error { p.note { "No pictures: " (error) } }
        p.again {
            "Draw it again: " code { (run(old)) }
            @if old != new { " and " code { (run(new)) } }
        }
    }
}

fn pictures(folders: &[&Path; 2], frame: &super::data::FrameChange, budget: &mut usize) -> Markup {
    if *budget == 0 {
        return html! { p.note { "These pictures were left out to keep the page small." } };
    }
    let strips = pixels::strips(folders, frame);
    *budget = budget.saturating_sub(strips.iter().map(Strip::bytes).sum());
    html! {
        @for strip in &strips {
            (strip)
        }
        p.cap {
            "Difference: " span.cross { "✗" } " another code; the brighter, the farther, in codes (for floats "
            "units in the last place) on a logarithmic scale."
        }
    }
}

fn only(diff: &RunDiff) -> Markup {
    let files = phrases::only_by_file(&diff.only);
    html! {
        @if !files.is_empty() {
            section id="only" {
                h2 { "In one run only (" (diff.only.len()) ")" }
                ul {
                    @for (file, n) in files.iter().take(ROWS) {
                        li {
                            @if file.worse { b { "✗ " } }
                            (phrases::side(file.side)) ", " (breakable(&file.adapter)) ": "
                            @if *n == 1 { code { (file.case) } ", " (name(file.verdict)) }
                            @else { (count(*n, "case")) " of " code { (file.case_file) } }
                        }
                    }
                }
                @if files.len() > ROWS { p.note { "and of " (files.len() - ROWS) " more case files" } }
            }
        }
    }
}

fn times(diff: &RunDiff) -> Markup {
    html! {
        @if !diff.times.is_empty() {
            section id="times" {
                h2 { "Times" }
                p { (statement()) }
                (area_table().page(diff.times.iter().take(ROWS)))
            }
        }
    }
}

fn methods(diff: &RunDiff) -> Markup {
    html! {
        @if !diff.methods.is_empty() {
            section id="methods" {
                h2 { "Frame times of methods" }
                p { "Medians while nothing else was drawn or judged, of one process each. " (statement()) }
                (method_table().page(diff.methods.iter().take(ROWS)))
                @if diff.methods.len() > ROWS { p.note { "and " (diff.methods.len() - ROWS) " more" } }
            }
        }
    }
}

/// Returns the facts about both runs.
fn about(diff: &RunDiff) -> Markup {
    let differ = diff.facts.iter().filter(|fact| fact.differs()).count() as u64;
    html! {
        section id="about" {
            h2 { "About the runs" }
            details {
                summary { (count(differ, "fact")) " differ" @if differ == 1 { "s" } }
                (facts(&diff.facts))
            }
        }
    }
}

fn reading() -> Markup {
    html! {
        section {
            h2 { "Worse and better" }
            p {
                b { "Worse" } " is a record that is unexpected and whose partner in the first run is not; a right verdict (pass, imprecise, measured) that became a wrong one; a wrong "
                "verdict that became a graver one; a case that was right and is no longer supported; a case that "
                "both runs select and the second has no record of; and an adapter that vanished. " b { "Better" } " is the "
                "reverse. Other pixels, counters and distances under the same verdict are " b { "other" }
                " changes, and so is pass to imprecise, which is legal."
            }
        }
    }
}
