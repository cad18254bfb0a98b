//! `index.html` of a run.
//!
//! The totals, the matrix and the findings need no script; the script adds the table of all cases, with
//! search and filters, and the view of one case. Every view has an address:
//! `index.html#q=less&on=cpu`, `index.html#case=depth/compare/compare=less`.

mod assertions;
mod cases;
mod causes;
mod consensus;
mod data;
mod detail;
mod facts;
mod findings;
mod overview;

use crate::catalogue::scripts;
use crate::chart;
use crate::mark::class;
use crate::methods::{self, Methods};
use crate::numbers::count;
use crate::page::origin::origin;
use crate::page::{self, Page};
use crate::run::grid::{Grid, Tally};
use crate::run::undrawn::{Undrawn, undrawn};
use crate::words::{self, Tone};
use etalon_record::{Dead, Run, Verdict};
use maud::{Markup, html};
use std::path::Path;

const CASES_STYLE: &str = include_str!("index/cases.css");
/// The script, inside one function so that the page adds no global names.
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("../page/base.js"),
    include_str!("index/script/data.js"),
    include_str!("index/script/state.js"),
    include_str!("index/script/table.js"),
    include_str!("index/script/case.js"),
    include_str!("index/script/scene.js"),
    include_str!("index/script/keys.js"),
    include_str!("index/script/route.js"),
    "})();\n"
);
/// Returns the page. Frame files are read from the folder when they are needed.
pub(crate) fn page(
    folder: &Path,
    run: &Run,
    dead: &[Dead],
    methods: Option<&Methods<'_>>,
) -> String {
    let grid = Grid::new(run);
    let plan = findings::Plan::new(&grid);
    let scripts = scripts(folder);
    let drivers = methods::driver_section(&grid);
    let charts = drivers.as_ref().map(|_| chart::style());
    let main = html! {
        (cases::view())
        div id="report" {
            (head(run, dead, methods.is_some(), drivers.is_some()))
            @if run.records.is_empty() {
                p { "No case was run." }
            } @else {
                (causes::section(&grid))
                (totals(run))
                (overview::matrix(&grid))
                (overview::not_drawn(run))
                (overview::dead(dead))
                @if let Some(methods) = methods { (methods::section(methods)) }
                @if let Some(drivers) = drivers { (drivers) }
                (cases::section(&grid, &scripts))
            }
            // Before the long sections, so that the table works while the rest is still read.
            (data::block(&grid, &plan, &scripts))
            (page::script(SCRIPT))
            @if !run.records.is_empty() {
                (findings::section(folder, &grid, &plan))
                (assertions::section(&grid))
            }
            (page::adapter::section(&run.header.adapters, &run.header.absent))
        }
    };
    Page::new(&title(run), "run.jsonl and frames/ in this folder", &main)
        .style(CASES_STYLE)
        .style(&charts.unwrap_or_default())
        .script(SCRIPT, !scripts.is_empty())
        .html()
}

fn title(run: &Run) -> String {
    let bad = run.records.iter().filter(|r| r.unexpected()).count();
    match bad {
        0 => format!("etalon {}", run.header.started),
        n => format!("{n} unexpected – etalon {}", run.header.started),
    }
}

fn head(run: &Run, dead: &[Dead], methods: bool, drivers: bool) -> Markup {
    let h = &run.header;
    html! {
        header {
            h1 { "etalon" }
            p.lead { "Conformance of graphics drivers' per-fragment operations." }
            (state(run, dead))
            dl.facts {
                (origin!(h))
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

/// The state of the run: incomplete, unexpected records, improvements.
fn state(run: &Run, dead: &[Dead]) -> Markup {
    let tally = Tally::of(&run.records);
    let improvements = run.records.iter().filter(|r| r.improvement()).count() as u64;
    let undrawn: u64 = undrawn(run).iter().map(Undrawn::records).sum();
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
                ", by " a href="#causes" { "cause" } " and under " a href="#findings" { "Findings" } "."
            }
        } @else if !run.records.is_empty() {
            p.state.good { b { (words::symbol(Verdict::Pass)) " Nothing unexpected." } }
        }
        @if undrawn > 0 {
            p.soft {
                a href="#undrawn" { (count(undrawn, "record")) } " of " (run.records.len())
                " are of cases that were not drawn."
            }
        }
        @if !dead.is_empty() {
            p.soft { a href="#dead" { (count(dead.len() as u64, "dead expectation")) } "." }
        }
        @if improvements > 0 {
            p.state.good {
                b { (count(improvements, "improvement")) }
                ": their expectations can be removed."
            }
        }
    }
}

/// Counts over the whole run, which also serve as the legend.
fn totals(run: &Run) -> Markup {
    let tally = Tally::of(&run.records);
    page::totals(tally.entries().map(|(verdict, tone, n)| {
        let name =
            html! { i { (words::symbol(verdict)) } " " (words::name(verdict)) (tone.suffix()) };
        (class(verdict, tone), n, name, sentence(verdict, tone))
    }))
}

fn sentence(verdict: Verdict, tone: Tone) -> &'static str {
    match tone {
        Tone::Plain => words::meaning(verdict),
        Tone::Excused => {
            "Named by the expectations or settled by triage, or a selftest that is due to fail."
        }
        Tone::Missed => "A selftest that is due to fail, and did not: the suite missed a bug.",
    }
}
