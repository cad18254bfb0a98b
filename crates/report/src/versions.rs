//! Cases over the releases of one driver: `versions.html` and the summary for a terminal.

mod groups;

use crate::error::ReportError;
use crate::files::replace;
use crate::numbers::count;
use crate::page::Page;
use crate::page::origin::origin;
use crate::table::{Cell, Table, as_is};
use crate::terminal::TableOptions;
use crate::words::plain;
use etalon_record::{CaseVersions, ReleaseRecord, Standing, Verdict, Versions};
use groups::{Course, Group, groups};
use maud::{Markup, html};
use std::path::{Path, PathBuf};

/// The page of a search over releases.
pub const VERSIONS_PAGE: &str = "versions.html";

/// Writes `versions.jsonl` and `versions.html` into a folder and returns the path of the page.
///
/// # Errors
/// Returns an error if the folder cannot be written to.
pub fn write_versions(folder: &Path, versions: &Versions) -> Result<PathBuf, ReportError> {
    versions.write(folder)?;
    replace(folder, VERSIONS_PAGE, page(versions).as_bytes())
}

/// A table with a row per finding and span of releases, and the totals. Always ends in a newline.
pub fn versions_table(versions: &Versions, options: TableOptions) -> String {
    let groups = groups(versions);
    let mut totals = [0_usize; 4];
    for group in &groups {
        totals[group.course.clone() as usize] += group.cases.len();
    }
    let bad = |group: &&Group<'_>| matches!(group.course, Course::Bad | Course::Flaky);
    let rows: Vec<&Group<'_>> = groups.iter().filter(bad).collect();
    let mut text = String::new();
    if !rows.is_empty() {
        let table = Table::new("")
            .text("finding", |group: &&Group<'_>| {
                let first = || format!("none: {}", plain(&group.cases[0].case, 120));
                group.finding.map_or_else(first, str::to_owned)
            })
            .text("bad in", |group| group.bad().to_owned())
            .text("versions of a finding", |group| {
                group.range.clone().unwrap_or_default()
            })
            .number("cases", |group| group.cases.len());
        text = format!("{}\n\n", table.terminal(rows, options, &[]).0);
    }
    let [bad, flaky, good, unknown] = totals.map(|n| n as u64);
    text.push_str(&format!(
        "{} of {}, oldest {}, newest {}: {} bad in some, {flaky} flaky, {good} good in all that were drawn, \
         {unknown} not drawn or not asserted\n",
        count(versions.cases.len() as u64, "case"),
        plain(&versions.header.line, 64),
        end(versions.header.releases.first()),
        end(versions.header.releases.last()),
        bad,
    ));
    text
}

fn end(release: Option<&ReleaseRecord>) -> String {
    release.map_or_else(String::new, |r| plain(&r.version, 40))
}

/// The page.
fn page(versions: &Versions) -> String {
    let groups = groups(versions);
    let main = html! {
        (head(versions, &groups))
        (overview(versions, &groups))
        @for (number, group) in groups.iter().enumerate() {
            @if shown(group) { (section(versions, number, group)) }
        }
    };
    Page::new(
        &format!("etalon: {} over its releases", versions.header.line),
        "versions.jsonl in this folder",
        &main,
    )
    .html()
}

fn findings<'a>() -> Table<'a, (usize, &'a Group<'a>)> {
    Table::new("figures")
        .head("Finding", |(number, group): &(usize, &'a Group<'a>)| {
            html! {
                a href={ "#g" (number) } { (title(group)) }
                @if group.finding.is_none() { br; small { (group.cases[0].case) } }
            }
        })
        .number("Cases", |(_, group)| group.cases.len())
        .text("Bad in", |(_, group)| group.bad())
        .text("Versions of a finding", |(_, group)| {
            html! { @if let Some(range) = &group.range { code { (range) } } }
        })
}

/// True if a group has rows of its own.
fn shown(group: &Group<'_>) -> bool {
    matches!(group.course, Course::Bad | Course::Flaky)
}

fn head(versions: &Versions, groups: &[Group<'_>]) -> Markup {
    let header = &versions.header;
    let counted = |course: Course| -> u64 {
        let same = groups.iter().filter(|g| g.course == course);
        same.map(|g| g.cases.len() as u64).sum()
    };
    html! {
        header {
            h1 { (header.line) " over its releases" }
            p.lead {
                "Each case is drawn with the oldest and the newest release and by halving between; what lies between two \
                 releases of one standing is taken to have it, and is checked once in the middle."
            }
            dl.facts {
                (origin!(header))
                dt { "Scope" } dd {
                    (count(versions.cases.len() as u64, "case")) ", " (count(header.releases.len() as u64, "release"))
                }
            }
        }
        section {
            h2 { "Totals" }
            ul.totals {
                @for (class, course, word, about) in [
                    ("f", Course::Bad, "bad", "In some releases."),
                    ("o", Course::Flaky, "flaky", "Not the same each time, in some release."),
                    ("p", Course::Good, "good", "In all releases that were drawn."),
                    ("u", Course::Unknown, "unknown", "Not drawn, or nothing was asserted."),
                ] {
                    li class=(class) {
                        span.big { (counted(course)) } " " span.m { (word) } small { (about) }
                    }
                }
            }
            p {
                (key("f", "✗", "bad")) (key("p", "✓", "good")) (key("o", "~", "flaky"))
                (key("u", "–", "not drawn or not asserted")) (key("u", "·", "as its neighbours, not drawn"))
            }
        }
    }
}

fn key(class: &str, symbol: &str, words: &str) -> Markup {
    html! { span class={ "key " (class) } { i { (symbol) } " " (words) } }
}

fn overview(versions: &Versions, groups: &[Group<'_>]) -> Markup {
    html! {
        section {
            h2 { "By finding" }
            @if !groups.iter().any(shown) {
                p.state.good { b { "✓ No case is bad in any release." } }
            } @else {
                (findings().page(groups.iter().enumerate().filter(|(_, group)| shown(group))))
            }
            p.note {
                "The releases: "
                @for (i, release) in versions.header.releases.iter().enumerate() {
                    @if i > 0 { "; " }
                    (release.version) " is " code { (release.adapter) } " (" (release.driver) ")"
                }
                "."
            }
        }
    }
}

fn title<'a>(group: &Group<'a>) -> &'a str {
    group.finding.unwrap_or("no finding")
}

fn section(versions: &Versions, number: usize, group: &Group<'_>) -> Markup {
    let rows = group.cases.iter().map(|case| (*case, case.standings()));
    let mut table = Table::<(&CaseVersions, Vec<Option<Standing>>)>::new("cases")
        .head("Case", |(case, _)| &*case.case);
    for (i, release) in versions.header.releases.iter().enumerate() {
        table = table.text(as_is(&release.version), move |(case, standings)| {
            let changes = i > 0 && changed(standings[i - 1], standings[i]);
            cell(case.verdicts[i], standings[i], changes)
        });
    }
    html! {
        section {
            h3 id={ "g" (number) } { (title(group)) ": " (group.bad()) }
            (table.page(rows))
        }
    }
}

/// True if a case is mended or broken between two releases.
fn changed(before: Option<Standing>, now: Option<Standing>) -> bool {
    let decided = |s: Option<Standing>| matches!(s, Some(Standing::Good | Standing::Bad));
    decided(before) && decided(now) && before != now
}

fn cell(verdict: Option<Verdict>, standing: Option<Standing>, changes: bool) -> Cell {
    let (class, symbol) = match standing {
        Some(Standing::Bad) => ("f", "✗"),
        Some(Standing::Good) => ("p", "✓"),
        Some(Standing::Flaky) => ("o", "~"),
        Some(Standing::Unknown) | None => ("u", "–"),
    };
    let title = verdict.map_or("not drawn", |v| v.name());
    let word = match (changes, standing) {
        (true, Some(Standing::Good)) => " fixed",
        (true, Some(Standing::Bad)) => " broken",
        _ => "",
    };
    let symbol = verdict.map_or("·", |_| symbol);
    Cell::from(html! { (symbol) b { (word) } })
        .class(class)
        .with("title", title.to_owned())
}
