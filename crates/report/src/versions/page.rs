//! `versions.html`: cases by releases, grouped by finding.

use super::groups::{Course, Group, groups};
use crate::numbers::count;
use crate::page::Page;
use crate::page::origin::Origin;
use etalon_record::{CaseVersions, Standing, Versions};
use maud::{Markup, html};

/// The page.
pub(super) fn page(versions: &Versions) -> String {
    let groups = groups(versions);
    let main = html! {
        (head(versions, &groups))
        (overview(versions, &groups))
        @for (number, group) in groups.iter().enumerate() {
            @if shown(group) { (section(versions, number, group)) }
        }
    };
    Page {
        title: &format!("etalon: {} over its releases", versions.header.line),
        styles: &[],
        script: None,
        beside: false,
        main,
        source: "versions.jsonl in this folder",
    }
    .html()
}

/// True if a group has rows of its own.
fn shown(group: &Group<'_>) -> bool {
    matches!(group.course, Course::Bad | Course::Flaky)
}

fn head(versions: &Versions, groups: &[Group<'_>]) -> Markup {
    let header = &versions.header;
    let origin = Origin {
        started: &header.started,
        command: &header.command,
        machine: &header.machine,
        etalon: &header.etalon,
        commit: header.commit.as_deref(),
    };
    let of = |course: Course| -> u64 {
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
                (origin.facts())
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
                        span.big { (of(course)) } " " span.m { (word) } small { (about) }
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
                div.wide { table.figures {
                    thead { tr {
                        th { "Finding" } th { "Cases" } th { "Bad in" } th { "Versions of a finding" }
                    } }
                    tbody {
                        @for (number, group) in groups.iter().enumerate() { @if shown(group) {
                            tr {
                                th scope="row" {
                                    a href={ "#g" (number) } { (title(group)) }
                                    @if group.finding.is_none() { br; small { (group.cases[0].case) } }
                                }
                                td.num { (group.cases.len()) }
                                td { (bad(group)) }
                                td { @if let Some(range) = &group.range { code { (range) } } }
                            }
                        } }
                    }
                } }
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

fn bad<'a>(group: &'a Group<'_>) -> &'a str {
    match group.course {
        Course::Flaky => "flaky",
        _ => &group.bad,
    }
}

fn section(versions: &Versions, number: usize, group: &Group<'_>) -> Markup {
    html! {
        section {
            h3 id={ "g" (number) } { (title(group)) ": " (bad(group)) }
            div.wide { table.cases {
                thead { tr {
                    th { "Case" }
                    @for release in &versions.header.releases { th { (release.version) } }
                } }
                tbody { @for case in &group.cases { (row(case)) } }
            } }
        }
    }
}

fn row(case: &CaseVersions) -> Markup {
    let standings = case.standings();
    html! {
        tr {
            th scope="row" { (case.case) }
            @for (i, standing) in standings.iter().enumerate() {
                @let changes = i > 0 && changed(standings[i - 1], *standing);
                (cell(case, i, *standing, changes))
            }
        }
    }
}

/// True if a case is mended or broken between two releases.
fn changed(before: Option<Standing>, now: Option<Standing>) -> bool {
    let decided = |s: Option<Standing>| matches!(s, Some(Standing::Good | Standing::Bad));
    decided(before) && decided(now) && before != now
}

fn cell(case: &CaseVersions, release: usize, standing: Option<Standing>, changes: bool) -> Markup {
    let verdict = case.verdicts[release];
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
    html! {
        td class=(class) title=(title) {
            @if verdict.is_some() { (symbol) b { (word) } } @else { "·" b { (word) } }
        }
    }
}
