//! Cases over the releases of one driver: `versions.html` and the summary for a terminal.

mod groups;

use crate::error::ReportError;
use crate::files::Destination;
use crate::numbers::count;
use crate::page::origin::origin;
use crate::page::{self, Page};
use crate::table::{Cell, Table, as_is};
use crate::terminal::TableOptions;
use crate::words::plain;
use etalon_record::{CaseVersions, OutputFolder, ReleaseRecord, Standing, Verdict, Versions};
use groups::{CaseGroup, ResultCourse, groups};
use maud::{Markup, html};
use std::path::{Path, PathBuf};

/// The page of a search over releases, `versions.html`.
pub const VERSIONS_PAGE: &str = "versions.html";

/// Writes `versions.jsonl` and `versions.html` into a folder and returns the path of the page.
///
/// # Errors
/// Returns an error if the folder cannot be written to.
pub fn write_versions(folder: &Path, versions: &Versions) -> Result<PathBuf, ReportError> {
    versions.write(folder)?;
    write_versions_page(&OutputFolder::open(folder)?, versions)
}

/// Writes the page of a search over releases.
pub(crate) fn write_versions_page(
    to: &dyn Destination,
    versions: &Versions,
) -> Result<PathBuf, ReportError> {
    to.write(VERSIONS_PAGE, html(versions).as_bytes())
}

/// Returns a table with a row per finding and span of releases, and the totals. The text always ends in a
/// newline.
pub fn versions_table(versions: &Versions, options: TableOptions) -> String {
    let groups = groups(versions);
    let rows: Vec<_> = groups.iter().enumerate().filter(shown).collect();
    let mut text = String::new();
    if !rows.is_empty() {
        text = format!("{}\n\n", findings().terminal(rows, options, &[]).0);
    }
    let [bad, flaky, good, unknown] = totals(&groups);
    text += &format!(
        "{} of {}, oldest {}, newest {}: {bad} bad in some, {flaky} flaky, {good} good in all that were drawn, \
         {unknown} not drawn or not asserted\n",
        count(versions.cases.len() as u64, "case"),
        plain(&versions.header.line, 64),
        end(versions.header.releases.first()),
        end(versions.header.releases.last()),
    );
    text
}

fn end(release: Option<&ReleaseRecord>) -> String {
    release.map_or_else(String::new, |r| plain(&r.version, 40))
}

/// Returns the page.
fn html(versions: &Versions) -> String {
    let groups = groups(versions);
    let main = html! {
        (head(versions, &groups))
        (overview(versions, &groups))
        @for (number, group) in groups.iter().enumerate().filter(shown) { (section(versions, number, group)) }
    };
    Page::new(
        &format!("etalon: {} over its releases", versions.header.line),
        "versions.jsonl in this folder",
        &main,
    )
    .html()
}

/// Returns a table with a row per group, which links to the group by its number on the page.
fn findings<'a>() -> Table<'a, (usize, &'a CaseGroup<'a>)> {
    Table::new("figures")
        .head("finding", |(number, group): &(usize, &'a CaseGroup<'a>)| {
            let first = &group.cases[0].case;
            let none = || format!("none: {}", plain(first, 120));
            let shown = html! {
                a href={ "#g" (number) } { (title(group)) }
                @if group.finding.is_none() { br; small { (first) } }
            };
            Cell::from(group.finding.map_or_else(none, str::to_owned)).on_page(shown)
        })
        .text("bad in", |(_, group)| group.bad())
        .text("versions of a finding", |(_, group)| {
            let range = group.range.as_deref();
            let shown = html! { @if let Some(range) = range { code { (range) } } };
            Cell::from(range.unwrap_or_default()).on_page(shown)
        })
        .number("cases", |(_, group)| group.cases.len())
}

/// Returns true if a group has rows in the table.
fn shown((_, group): &(usize, &CaseGroup<'_>)) -> bool {
    matches!(group.course, ResultCourse::Bad | ResultCourse::Flaky)
}

/// Returns the number of cases by how they changed over the releases.
fn totals(groups: &[CaseGroup<'_>]) -> [u64; 4] {
    let mut totals = [0; 4];
    for group in groups {
        totals[group.course as usize] += group.cases.len() as u64;
    }
    totals
}

fn head(versions: &Versions, groups: &[CaseGroup<'_>]) -> Markup {
    let header = &versions.header;
    let [bad, flaky, good, unknown] = totals(groups);
    let totals = [
        ("f", bad, "bad", "In some releases."),
        (
            "o",
            flaky,
            "flaky",
            "Not the same each time, in some release.",
        ),
        ("p", good, "good", "In all releases that were drawn."),
        (
            "u",
            unknown,
            "unknown",
            "Not drawn, or nothing was asserted.",
        ),
    ];
    html! {
        header {
            h1 { (header.line) " over its releases" }
            p.lead {
                "Each case is drawn with the oldest and the newest release, then by bisection between them. Releases between \
                 two with the same standing are assumed to share it; one in the middle is checked."
            }
            dl.facts {
                (origin(&header.provenance))
                dt { "Scope" } dd {
                    (count(versions.cases.len() as u64, "case")) ", " (count(header.releases.len() as u64, "release"))
                }
            }
        }
        (page::totals(totals))
        p {
            (key("f", "✗", "bad")) (key("p", "✓", "good")) (key("o", "~", "flaky"))
            (key("u", "–", "not drawn or not asserted")) (key("u", "·", "as its neighbours, not drawn"))
        }
    }
}

fn key(class: &str, symbol: &str, words: &str) -> Markup {
    html! { span class={ "key " (class) } { i { (symbol) } " " (words) } }
}

fn overview(versions: &Versions, groups: &[CaseGroup<'_>]) -> Markup {
    html! {
        section {
            h2 { "By finding" }
            @if !groups.iter().enumerate().any(|group| shown(&group)) {
                p.state.good { b { "✓ No case is bad in any release." } }
            } @else {
                (findings().page(groups.iter().enumerate().filter(shown)))
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

fn title<'a>(group: &CaseGroup<'a>) -> &'a str {
    group.finding.unwrap_or("no finding")
}

fn section(versions: &Versions, number: usize, group: &CaseGroup<'_>) -> Markup {
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

/// Returns true if a case was fixed or broken between two releases.
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
