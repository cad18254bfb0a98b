//! Hunts for planted bugs: `mutants.html` and the summary for a terminal.

use crate::error::ReportError;
use crate::files::Destination;
use crate::innocents;
use crate::numbers::{count, duration};
use crate::page::origin::origin;
use crate::page::{self, Page};
use crate::sighting::sighting;
use crate::table::{Cell, Table};
use crate::terminal::TableOptions;
use crate::words::plain;
use etalon_record::{AreaTally, Catch, Hunt, MutantRecord, OutputFolder};
use maud::{Markup, html};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The page of a hunt.
pub const HUNT_PAGE: &str = "mutants.html";

/// The files that [`write_hunt`] wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenHunt {
    /// The page, [`HUNT_PAGE`] in the folder.
    pub html: PathBuf,
    /// The file that `etalon_record::Hunt::read` reads.
    pub json: PathBuf,
}

/// Writes `mutants.json` and `mutants.html` into a folder, and creates the folder if it does not exist.
///
/// # Errors
/// Returns an error if the folder cannot be written to.
pub fn write_hunt(folder: &Path, hunt: &Hunt) -> Result<WrittenHunt, ReportError> {
    let json = hunt.write(folder)?;
    let html = write_hunt_page(&OutputFolder::open(folder)?, hunt)?;
    Ok(WrittenHunt { html, json })
}

/// Writes the page of a hunt.
pub(crate) fn write_hunt_page(to: &dyn Destination, hunt: &Hunt) -> Result<PathBuf, ReportError> {
    to.write(HUNT_PAGE, html(hunt).as_bytes())
}

/// Returns a table with a row per area, the totals, and the bugs that were only noticed, survived, or were
/// caught only by other areas. The text always ends in a newline.
pub fn hunt_table(hunt: &Hunt, options: TableOptions) -> String {
    let mut text = String::new();
    if !hunt.mutants.is_empty() {
        let (table, _) = area_table().terminal(areas(hunt), options, &[]);
        text += &format!("{table}\n\n{}\n", totals(hunt));
    }
    text.extend(innocents::totals(hunt).map(|line| format!("{line}\n")));
    for (title, mutants) in noted(hunt) {
        if !mutants.is_empty() {
            text += &format!("\n{title}\n");
        }
        for m in mutants {
            text += &format!("  {}\n", plain(&m.mutant.name, 100));
            if let Some(first) = m.first.as_ref() {
                text += &format!("      {}\n", plain(&first.case, options.room(5)));
            }
        }
    }
    let complaints = hunt.complaints().map(|(mutant, why)| {
        let name = plain(&mutant.mutant.name, 100);
        format!("  {name}: {why}\n")
    });
    let wrong = complaints.collect::<String>() + &innocents::complaints(hunt, options.room(5));
    if !wrong.is_empty() {
        text += &format!("\n{}\n{wrong}", options.paint("Wrong", "31"));
    }
    text
}

/// Returns the page.
fn html(hunt: &Hunt) -> String {
    let main = html! {
        (head(hunt))
        @if !hunt.mutants.is_empty() {
            (by_area(hunt))
            (lists(hunt))
        }
        @if !hunt.innocents.is_empty() { (innocents::section(hunt)) }
        @if !hunt.mutants.is_empty() { (all(hunt)) }
    };
    Page::new(
        &format!("etalon mutants {}", hunt.provenance.started),
        "mutants.json in this folder",
        &main,
    )
    .html()
}

fn head(hunt: &Hunt) -> Markup {
    let complaints: Vec<_> = hunt.complaints().collect();
    let totals = [
        (Catch::Caught, "Some case failed."),
        (
            Catch::Noticed,
            "Some texels lie outside the yardstick, none is wrong.",
        ),
        (Catch::Survived, "Every case passed."),
        (Catch::Broken, "It could not be drawn: a bug of the mutant."),
    ];
    let occurs = |outcome| outcome != Catch::Broken || hunt.count(outcome) > 0;
    let totals = totals.into_iter().filter(|(outcome, _)| occurs(*outcome));
    let totals = totals.map(|(outcome, about)| {
        let count = hunt.count(outcome) as u64;
        (class(outcome), count, outcome.name(), about)
    });
    html! {
        header {
            h1 { "etalon mutants" }
            p.lead { (lead(hunt)) }
            @if hunt.mutants.is_empty() {
            } @else if complaints.is_empty() {
                p.state.good { b { "✓ Every planted bug is caught." } }
            } @else {
                p.state.bad {
                    b { "✗ " (count(complaints.len() as u64, "planted bug")) " with a wrong outcome." }
                }
                ul { @for (mutant, why) in &complaints {
                    li { a href={ "#" (mutant.mutant.name) } { (mutant.mutant.name) } ": " (why) }
                } }
            }
            @if !hunt.innocents.is_empty() { (innocents::state(hunt)) }
            dl.facts {
                (origin(&hunt.provenance))
                dt { "Scope" } dd {
                    @if !hunt.mutants.is_empty() { (count(hunt.mutants.len() as u64, "planted bug")) ", " }
                    @if !hunt.innocents.is_empty() { (count(hunt.innocents.len() as u64, "innocent")) ", " }
                    (count(hunt.cases, "case")) ", " (duration(hunt.seconds))
                    @if !hunt.full && !hunt.mutants.is_empty() { "; an area ends at a bug's first Fail" }
                }
            }
        }
        @if !hunt.mutants.is_empty() { (page::totals(totals)) }
    }
}

/// Returns the sentence below the title.
fn lead(hunt: &Hunt) -> &'static str {
    match (hunt.mutants.is_empty(), hunt.innocents.is_empty()) {
        (true, _) => "Behaviours that specifications permit, and the verdicts on them.",
        (_, true) => {
            "Bugs planted in a rasterizer that passes the suite, and the cases that catch them."
        }
        _ => {
            "Bugs planted in a rasterizer that passes the suite, and the cases that catch them; and behaviours that specifications permit, and the verdicts on them."
        }
    }
}

/// Returns the class that colours an outcome, a fixed letter.
fn class(outcome: Catch) -> &'static str {
    match outcome {
        Catch::Caught => "p",
        Catch::Noticed => "i",
        Catch::Survived => "o",
        Catch::Broken => "b",
    }
}

fn by_area(hunt: &Hunt) -> Markup {
    html! {
        section {
            h2 { "By area" }
            p {
                "The bugs that each area's cases see. Each bug has an area that must see it without the others; the last "
                "column counts an area's bugs that it sees."
            }
            (area_table().page(areas(hunt)))
        }
    }
}

fn lists(hunt: &Hunt) -> Markup {
    html! {
        @for (title, mutants) in noted(hunt) { @if !mutants.is_empty() {
            section {
                h2 { (title) }
                ul { @for m in mutants { li {
                    a href={ "#" (m.mutant.name) } { (m.mutant.name) } ": " (m.mutant.about) " "
                } } }
            }
        } }
    }
}

fn all(hunt: &Hunt) -> Markup {
    html! {
        section {
            h2 { "All planted bugs" }
            (all_table().page(&hunt.mutants))
        }
    }
}

fn all_table<'a>() -> Table<'a, &'a MutantRecord> {
    let outcome = |m: &&MutantRecord| {
        let shown = html! { span.chip { (m.outcome.name()) } };
        Cell::from(shown).class(class(m.outcome))
    };
    Table::new("figures")
        .head("Name", |m: &&MutantRecord| {
            Cell::from(&m.mutant.name).with("id", m.mutant.name.clone())
        })
        .text("Effect", |m| &*m.mutant.about)
        .text("Source", |m| &*m.mutant.source)
        .text("Outcome", outcome)
        .text("Cases that failed / were imprecise / passed", |m| {
            html! { @for area in &m.areas { (tally(area, area.area == m.mutant.area)) } }
        })
        .text(
            "First seen",
            |m| html! { @if let Some(first) = &m.first { (sighting(first)) } },
        )
}

fn tally(area: &AreaTally, is_own: bool) -> Markup {
    html! {
        @if area.fail + area.imprecise + area.broken > 0 || is_own {
            div {
                @if is_own { b { (area.area) } } @else { (area.area) }
                " " (area.fail) " / " (area.imprecise) " / " (area.pass)
                @if area.broken > 0 { ", " (area.broken) " broken" }
            }
        }
    }
}

/// The results of one area.
struct AreaRow<'a> {
    area: &'a str,
    /// The number of bugs that this area must catch alone.
    own: usize,
    /// The number of these bugs for which the area's own cases suffice.
    own_reached: usize,
    /// The numbers of bugs, of any area, that this area caught, noticed without catching, and missed.
    counts: [usize; 3],
}

/// Returns the results of all areas, in alphabetical order.
fn areas(hunt: &Hunt) -> Vec<AreaRow<'_>> {
    let tallies = || hunt.mutants.iter().flat_map(|m| &m.areas);
    let names: BTreeSet<&str> = tallies().map(|t| t.area.as_str()).collect();
    let row = |area| {
        let mut row = AreaRow {
            area,
            own: 0,
            own_reached: 0,
            counts: [0; 3],
        };
        for mutant in &hunt.mutants {
            if mutant.mutant.area == area {
                row.own += 1;
                row.own_reached += usize::from(mutant.by_own_area());
            }
            let tally = mutant.areas.iter().find(|t| t.area == area);
            let place = tally.map_or(2, |t| match (t.fail, t.imprecise) {
                (1.., _) => 0,
                (0, 1..) => 1,
                (0, 0) => 2,
            });
            row.counts[place] += 1;
        }
        row
    };
    names.into_iter().map(row).collect()
}

/// Returns the table of areas.
fn area_table<'a>() -> Table<'a, AreaRow<'a>> {
    Table::new("")
        .head("area", |row: &AreaRow<'_>| row.area)
        .number("caught", |row| row.counts[0])
        .number("imprecise only", |row| row.counts[1])
        .number("passed", |row| row.counts[2])
        .number("own bugs caught", |row| {
            format!("{} of {}", row.own_reached, row.own)
        })
}

/// Returns the bugs to look at: those only noticed, survived, or caught only by cases of other areas.
fn noted(hunt: &Hunt) -> [(&'static str, Vec<&MutantRecord>); 3] {
    let found = |outcome| hunt.mutants.iter().filter(move |m| m.outcome == outcome);
    let seen = |m: &&MutantRecord| matches!(m.outcome, Catch::Caught | Catch::Noticed);
    let elsewhere = hunt
        .mutants
        .iter()
        .filter(seen)
        .filter(|m| !m.by_own_area());
    [
        ("Noticed", found(Catch::Noticed).collect()),
        ("Survived", found(Catch::Survived).collect()),
        ("Caught by other areas only", elsewhere.collect()),
    ]
}

/// Returns the totals in one line.
fn totals(hunt: &Hunt) -> String {
    let counted = |outcome: Catch| format!("{} {}", hunt.count(outcome) as u64, outcome.name());
    let mut parts = vec![
        counted(Catch::Caught),
        counted(Catch::Noticed),
        counted(Catch::Survived),
    ];
    if hunt.count(Catch::Broken) > 0 {
        parts.push(counted(Catch::Broken));
    }
    format!(
        "{} planted bugs, {} cases, {}: {}",
        hunt.mutants.len(),
        hunt.cases,
        duration(hunt.seconds),
        parts.join(", ")
    )
}
