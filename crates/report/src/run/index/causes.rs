//! The causes of a run's unexpected verdicts: records of one adapter that violate the same way, with the condition on
//! axes that tells them from the others.
//!
//! A hundred red rows are a dozen bugs. Nothing here knows a bug: the groups come from records alone.

use crate::mark::{class, mark};
use crate::news::RunNews;
use crate::numbers::count;
use crate::page::link;
use crate::run::grid::RunGrid;
use crate::words::{self, Tone};
use etalon_diagnose::{Condition, Symptom};
use etalon_record::{Record, Verdict};
use maud::{Markup, html};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// The maximum number of causes that are shown before a summary.
const FIRST: usize = 12;
/// The maximum number of causes behind that summary.
const LISTED: usize = 24;
/// The maximum number of listed case files of a cause.
const FILES: usize = 6;

/// The unexpected records with one symptom on one adapter.
struct ListedCause<'a> {
    adapter: &'a str,
    kind: Symptom,
    records: usize,
    /// By case file: what its failing cases have in common, and the first of them.
    files: Vec<(&'a str, Condition, &'a Record)>,
}

/// Returns the section; empty if no record is unexpected.
pub(crate) fn section(grid: &RunGrid<'_>, news: Option<&RunNews>) -> Markup {
    let causes = causes(grid);
    let verdicts: usize = causes.iter().map(|c| c.records).sum();
    html! {
        @if !causes.is_empty() {
            section id="causes" {
                h2 { "New" }
                p {
                    (count(verdicts as u64, "unexpected verdict")) " in " (count(causes.len() as u64, "group"))
                    ", by adapter and kind of violation, worst first."
                    @if let Some(old @ 1..) = news.map(|news| news.old.len()) { " In the last run, " (old) " were unexpected already." }
                }
                @let (first, others) = causes.split_at(causes.len().min(FIRST));
                @for cause in first { (entry(cause)) }
                @if !others.is_empty() {
                    details {
                        summary { (others.len()) " more" }
                        @for cause in others.iter().take(LISTED) { (entry(cause)) }
                        @if others.len() > LISTED {
                            p.note { "and " (others.len() - LISTED) " more, among " a href="#unexpected=1" { "all unexpected cases" } "." }
                        }
                    }
                }
            }
        }
    }
}

fn entry(cause: &ListedCause<'_>) -> Markup {
    let tone = Tone::Plain;
    let kind = match cause.kind.text() {
        text if text.is_empty() => words::name(cause.kind.verdict).to_owned(),
        text => text,
    };
    let files = cause.files.iter().take(FILES);
    html! {
        div.cause {
            p {
                span class={ "chip " (class(cause.kind.verdict, tone)) } { (cause.records) " " (mark(cause.kind.verdict, tone)) }
                " " code { (cause.adapter) } " " b { (kind) }
            }
            ul {
                @for (file, condition, first) in files {
                    li {
                        a href=(link::case(&first.case)) { code { (first.case) } } ": " (words::headline(first))
                        @if condition.failing > 1 {
                            " · " a href=(link::filter(file, cause.adapter)) { (count(condition.failing as u64, "case")) " of " (file) } " " (condition.text())
                        }
                    }
                }
                @if cause.files.len() > FILES { li { "and " (count((cause.files.len() - FILES) as u64, "more file")) } }
            }
        }
    }
}

fn causes<'a>(grid: &RunGrid<'a>) -> Vec<ListedCause<'a>> {
    let mut found: BTreeMap<(usize, Symptom), BTreeMap<&'a str, Vec<&'a Record>>> = BTreeMap::new();
    let mut drawn: BTreeMap<(usize, &str), Vec<&str>> = BTreeMap::new();
    for file in grid.files() {
        for column in 0..grid.adapters.len() {
            for index in file.on(column) {
                let record = grid.record(index);
                if !matches!(record.verdict, Verdict::NotSupported | Verdict::Skipped) {
                    drawn
                        .entry((column, file.name))
                        .or_default()
                        .push(&record.case);
                }
                if record.unexpected() {
                    let of_kind = found
                        .entry((column, Symptom::of(record).broad()))
                        .or_default();
                    of_kind.entry(file.name).or_default().push(record);
                }
            }
        }
    }
    let mut causes: Vec<ListedCause<'a>> = found
        .into_iter()
        .map(|((column, kind), files)| {
            let mut files: Vec<_> = files
                .into_iter()
                .filter_map(|(name, records)| {
                    let failing: Vec<&str> = records.iter().map(|r| r.case.as_str()).collect();
                    let drawn_cases = drawn.get(&(column, name)).map_or(&[][..], Vec::as_slice);
                    Some((
                        name,
                        Condition::of(&failing, drawn_cases),
                        *records.first()?,
                    ))
                })
                .collect();
            files.sort_by_key(|(_, condition, _)| Reverse(condition.failing));
            ListedCause {
                adapter: grid.adapters[column],
                kind,
                records: files
                    .iter()
                    .map(|(_, condition, _)| condition.failing)
                    .sum(),
                files,
            }
        })
        .collect();
    causes.sort_by_key(|c| (Reverse(c.kind.verdict.severity()), Reverse(c.records)));
    causes
}
