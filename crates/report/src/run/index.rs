//! `index.html`: one self-contained page that works from the file system.
//!
//! What a reader must know stands in the page as it is; its script adds the table of all cases, with
//! search and filters, and the view of one case. Whatever is looked at has its address:
//! `index.html#q=less&on=cpu`, `index.html#case=depth/compare/compare=less`.

pub(crate) mod adapters;
mod assertions;
mod cases;
mod consensus;
mod data;
mod detail;
mod facts;
mod findings;
mod link;
mod matrix;

pub(crate) use adapters::breakable;
pub use detail::quoted;

use crate::methods::{self, Methods};
use crate::run::grid::{Grid, Tally};
use crate::words::{self, Tone, count};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_record::{Run, Verdict};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};
use std::path::Path;

pub(crate) const STYLE: &str = include_str!("../page/style.css");
const CASES_STYLE: &str = include_str!("index/cases.css");
/// In one function, so that the page has no global names but the browser's.
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("index/script/data.js"),
    include_str!("index/script/state.js"),
    include_str!("index/script/table.js"),
    include_str!("index/script/case.js"),
    include_str!("index/script/keys.js"),
    include_str!("index/script/route.js"),
    "})();\n"
);
/// Nothing may be fetched, whatever a hostile name should manage to smuggle in.
pub(crate) const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// As [`POLICY`], and no script runs but the page's own.
fn policy() -> String {
    let digest = STANDARD.encode(Sha256::digest(SCRIPT));
    format!(
        "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{digest}'; \
         base-uri 'none'; form-action 'none'"
    )
}

/// The whole page. Frame files are read from the folder as they are needed.
pub(crate) fn page(folder: &Path, run: &Run, methods: Option<&Methods<'_>>) -> String {
    let grid = Grid::new(run);
    let plan = findings::Plan::new(&grid);
    let drivers = methods::driver_section(&grid);
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy());
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title(run)) }
                style {
                    (PreEscaped(STYLE)) (PreEscaped(CASES_STYLE))
                    @if drivers.is_some() { (PreEscaped(methods::CHART_STYLE)) }
                }
            }
            body {
                a.skip href="#main" { "Skip to the content" }
                main id="main" tabindex="-1" {
                    (cases::view())
                    div id="report" {
                        (head(run, methods.is_some(), drivers.is_some()))
                        @if run.records.is_empty() {
                            p { "No case was run, so there is nothing to report." }
                        } @else {
                            (totals(run))
                            (matrix::section(&grid))
                            @if let Some(methods) = methods { (methods::section(methods)) }
                            @if let Some(drivers) = drivers { (drivers) }
                            (cases::section(&grid))
                        }
                        // Before what is long, so that the table can be used while the rest is read.
                        (data::block(&grid, &plan))
                        script { (PreEscaped(SCRIPT)) }
                        @if !run.records.is_empty() {
                            (findings::section(folder, &grid, &plan))
                            (assertions::section(&grid))
                        }
                        (adapters::section(&run.header))
                        footer { "Made by etalon from run.jsonl and frames/ in this folder." }
                    }
                }
            }
        }
    }
    .into_string()
}

fn title(run: &Run) -> String {
    let bad = run.records.iter().filter(|r| r.unexpected()).count();
    match bad {
        0 => format!("etalon {}", run.header.started),
        n => format!("{n} unexpected – etalon {}", run.header.started),
    }
}

fn head(run: &Run, methods: bool, drivers: bool) -> Markup {
    let h = &run.header;
    html! {
        header {
            h1 { "etalon" }
            p.lead { "Whether graphics drivers do per-fragment operations right." }
            (state(run))
            dl.facts {
                dt { "Started" } dd { (h.started) }
                dt { "Command" } dd { code { (h.command.join(" ")) } }
                dt { "Machine" } dd { (h.machine.cpu) ", " (count(u64::from(h.machine.cores), "core")) ", " (h.machine.os) }
                dt { "Suite" } dd {
                    "etalon " (h.etalon)
                    @if let Some(commit) = &h.commit { ", commit " code { (commit) } }
                }
                dt { "Scope" } dd {
                    (count(h.cases, "case")) " on " (count(h.adapters.len() as u64, "adapter"))
                    ", " (count(run.records.len() as u64, "record"))
                }
                @let settings = words::settings(&h.settings);
                @if !settings.is_empty() { dt { "Settings" } dd { (settings.join(", ")) } }
            }
            @if !run.records.is_empty() {
            nav aria-label="Parts of the page" {
                a href="#matrix" { "Matrix" } " "
                @if methods { a href="#methods" { "Methods" } " " }
                @if drivers { a href="#accuracy" { "Accuracy of drivers" } " " }
                a href="#cases" { "All cases" } " "
                a href="#findings" { "Findings" } " "
                a href="#asserted" { "What was asserted" } " "
                a href="#adapters" { "Adapters" }
            }
            }
        }
    }
}

/// What a reader must know first.
fn state(run: &Run) -> Markup {
    let tally = Tally::of(&run.records);
    let improvements = run.records.iter().filter(|r| r.improvement()).count() as u64;
    let missing = run.missing();
    html! {
        @if run.truncated || missing > 0 {
            p.state.bad {
                b { "! Incomplete. " }
                @if missing > 0 {
                    (missing) " of " (run.header.expected_records()) " records are missing. "
                }
                @if run.truncated { "The last record was cut off: the run did not end by itself." }
            }
        }
        @if tally.unexpected > 0 {
            p.state.bad {
                b { (words::symbol(Verdict::Fail)) " " (count(tally.unexpected, "unexpected record")) }
                ", listed under " a href="#findings" { "Findings" } "."
            }
        } @else if !run.records.is_empty() {
            p.state.good { b { (words::symbol(Verdict::Pass)) " Nothing unexpected." } }
        }
        @if improvements > 0 {
            p.state.good {
                b { (count(improvements, "improvement")) }
                ": entries of the expectations may go."
            }
        }
    }
}

/// Counts over the whole run, which are the legend at the same time.
fn totals(run: &Run) -> Markup {
    let tally = Tally::of(&run.records);
    html! {
        section {
            h2 { "Totals" }
            ul.totals {
                @for (verdict, tone, n) in tally.entries() {
                    li class=(class(verdict, tone)) {
                        span.big { (n) } " " (mark(verdict, tone))
                        small { (sentence(verdict, tone)) }
                    }
                }
            }
        }
    }
}

fn sentence(verdict: Verdict, tone: Tone) -> &'static str {
    match tone {
        Tone::Plain => words::meaning(verdict),
        Tone::Excused => "Named by the expectations, or a selftest that is due to fail.",
        Tone::Missed => "A selftest that is due to fail, and did not: the suite missed a bug.",
    }
}

/// A verdict as symbol and word.
fn mark(verdict: Verdict, tone: Tone) -> Markup {
    html! { span.m { i { (words::symbol(verdict)) } " " (words::name(verdict)) (tone.suffix()) } }
}

/// The class that colours a verdict: a fixed letter, never taken from a record.
fn class(verdict: Verdict, tone: Tone) -> &'static str {
    match (verdict, tone) {
        (_, Tone::Missed) => "f",
        (Verdict::Fail, Tone::Excused) => "f x",
        (Verdict::Open, Tone::Excused) => "o x",
        (_, Tone::Excused) => "b x",
        (Verdict::Pass, Tone::Plain) => "p",
        (Verdict::Imprecise, Tone::Plain) => "i",
        (Verdict::Fail, Tone::Plain) => "f",
        (Verdict::Open, Tone::Plain) => "o",
        (Verdict::Measured, Tone::Plain) => "n",
        (Verdict::NotSupported | Verdict::Skipped, Tone::Plain) => "u",
        (_, Tone::Plain) => "b",
    }
}

/// `12.3 %`, with as many digits as tell it from 0 and 100.
fn percent(share: f64) -> String {
    let value = share * 100.0;
    if value == 0.0 || value == 100.0 {
        format!("{value} %")
    } else {
        format!("{:.1} %", value.clamp(0.1, 99.9))
    }
}
