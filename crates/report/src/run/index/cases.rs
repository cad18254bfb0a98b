//! The search over all cases, and the view of one case. The script shows and fills both.

use super::consensus::{Consensus, Votes};
use crate::numbers::count;
use crate::run::grid::{RunGrid, VerdictTally};
use crate::words;
use etalon_record::Verdict;
use maud::{Markup, html};

pub(crate) fn section(grid: &RunGrid<'_>, scripts: &[(String, String)]) -> Markup {
    html! {
        section id="cases" aria-labelledby="cases-title" hidden {
            nav aria-label="Report" { a href="#" id="cases-back" { "Report" } }
            h1 id="cases-title" { "Cases" }
            (controls(grid))
            p id="only" hidden {}
            p.count id="count" role="status" aria-live="polite" {}
            div.wide id="rows" {
                table.cases id="case-table" aria-describedby="keys" {
                    caption.vh { "Cases, what the adapters agree on, and the verdict on each adapter" }
                    thead { tr {
                        th scope="col" aria-sort="ascending" { button type="button" data-sort="case" { "Case" } }
                        th scope="col" aria-sort="none" { button type="button" data-sort="consensus" { "Consensus" } }
                    } }
                }
            }
            nav.pages id="pages" aria-label="Pages of cases" hidden {
                button type="button" id="page-back" { "Previous page" }
                span id="page-at" {}
                button type="button" id="page-on" { "Next page" }
            }
            p.note id="keys" {
                "Keys: " kbd { "/" } " searches; in the table " kbd { "↓" } " " kbd { "↑" } " or " kbd { "j" } " "
                kbd { "k" } " move over rows, " kbd { "Enter" } " opens a case or a group, " kbd { "Esc" }
                " leads back."
            }
            details {
                summary { "What the words mean" }
                p {
                    @for verdict in Verdict::ALL {
                        span.key { i { (words::symbol(verdict)) } " " (words::name(verdict)) } " "
                    }
                    "A verdict in parentheses was expected, or due in a selftest. " b { "Imprecise" }
                    " is legal, but outside the yardstick, a tighter band of quality."
                }
                p {
                    "One group per case file, one row per case, one column per adapter. The consensus is what "
                    "more than half of the adapters that drew a case agree on: that it is right (pass, "
                    "imprecise, measured) or that it is not. Not supported and skipped have no vote, and "
                    "selftests that are due to fail are left out."
                }
            }
            @if !scripts.is_empty() {
                p id="galleries" {
                    "Galleries of reference pictures: "
                    @for (i, (area, ..)) in scripts.iter().enumerate() {
                        @if i > 0 { ", " }
                        a href={ "#gallery=" (area) } { (area) }
                    }
                }
            }
        }
    }
}

/// Returns the element in which the script shows a case.
pub(crate) fn view() -> Markup {
    html! { article id="case" aria-labelledby="case-title" hidden {} }
}

fn controls(grid: &RunGrid<'_>) -> Markup {
    let tally = VerdictTally::of(&grid.run.records);
    let mut verdicts: Vec<Verdict> = tally.entries().map(|(v, _, _)| v).collect();
    verdicts.sort_by_key(|v| std::cmp::Reverse(v.severity()));
    verdicts.dedup();
    let bad = [("bad".to_owned(), "any bad one".to_owned())];
    let each = verdicts.into_iter().map(|v| {
        (
            v.name().to_owned(),
            format!("{} {}", words::symbol(v), words::name(v)),
        )
    });
    let none = [("none".to_owned(), "no record".to_owned())];
    let verdicts = bad.into_iter().chain(each).chain(none).collect();
    let (odd, apart) = odd(grid);
    let names = grid
        .adapters
        .iter()
        .zip(&odd)
        .map(|(name, n)| format!("{name} ({n})"));
    let any = format!("any one adapter ({})", odd.iter().sum::<u64>());
    let mut differs = vec![("any".to_owned(), any)];
    differs.extend((0..).map(|i: usize| i.to_string()).zip(names));
    html! {
        form.filter id="filter" role="search" aria-labelledby="cases-title" {
            div.search {
                label for="f-q" { "Search" }
                input id="f-q" type="search" autocomplete="off" spellcheck="false"
                    aria-describedby="f-q-help" aria-keyshortcuts="/" enterkeyhint="search";
                small id="f-q-help" { "All words must occur in the id, or in the name of an adapter; * matches anything." }
            }
            label.check { input id="f-messages" type="checkbox"; "search messages too" }
            (select("verdict", "Verdict", "any", verdicts))
            (select("on", "On adapter", "any", numbered(&mut grid.adapters.iter().copied())))
            (select("area", "Area", "any", numbered(&mut grid.areas.iter().map(|area| area.name))))
            (select("odd", "Differs only on", "–", differs))
            label.check { input id="f-unexpected" type="checkbox"; "unexpected only (" (tally.unexpected) ")" }
            label.check { input id="f-disagree" type="checkbox"; "adapters disagree (" (count(apart, "case")) ")" }
            button type="button" id="f-clear" { "Clear filters" }
            button type="button" id="f-groups" aria-controls="case-table" { "Open all groups" }
        }
    }
}

fn numbered(names: &mut dyn Iterator<Item = &str>) -> Vec<(String, String)> {
    let named = names.enumerate();
    named
        .map(|(i, name)| (i.to_string(), name.to_owned()))
        .collect()
}

/// Returns a control of the filter: options with their values, after one that filters nothing.
fn select(id: &str, label: &str, nothing: &str, options: Vec<(String, String)>) -> Markup {
    html! {
        div {
            label for={ "f-" (id) } { (label) }
            select id={ "f-" (id) } {
                option value="" { (nothing) }
                @for (value, text) in options { option value=(value) { (text) } }
            }
        }
    }
}

/// Returns the number of cases that differ on each adapter only, and the number that the adapters disagree on.
fn odd(grid: &RunGrid<'_>) -> (Vec<u64>, u64) {
    let mut odd = vec![0; grid.adapters.len()];
    let mut apart = 0;
    for case in grid.cases() {
        let consensus = Consensus::of(grid, case);
        apart += u64::from(matches!(consensus.votes, Votes::Odd | Votes::Split));
        if let Some(column) = consensus.only() {
            odd[column] += 1;
        }
    }
    (odd, apart)
}
