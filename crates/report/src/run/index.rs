//! `index.html` of a run.
//!
//! The page tells what changed since the last run, what is new, what is known and what was not drawn, in this
//! order; then come the matrix and everything else. All parts but two work without a script; the script adds the
//! table of all cases, with search and filters, and the view of one case. Every view has an address:
//! `index.html#q=less&on=cpu`, `index.html#case=depth/compare/compare=less`.

mod assertions;
mod cases;
mod causes;
mod changed;
mod consensus;
mod data;
pub(crate) mod detail;
mod facts;
mod findings;
mod matrix;
mod overview;

use crate::bench;
use crate::chart;
use crate::mark::class;
use crate::methods::{self, Methods};
use crate::news::RunNews;
use crate::numbers::count;
use crate::page::origin::origin;
use crate::page::{self, Page};
use crate::run::beside;
use crate::run::grid::{RunGrid, VerdictTally};
use crate::run::reasons::{total, undrawn};
use crate::words::{self, Tone};
use etalon_record::{Bench, Dead, Run, Verdict};
use maud::{Markup, html};
use std::path::Path;

const STYLE: &str = concat!(
    include_str!("index/matrix.css"),
    include_str!("index/cases.css")
);
/// In one function, so that the page has no global names but the browser's.
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

/// What the page shows beside the records.
#[derive(Clone, Copy)]
pub(crate) struct PageParts<'a> {
    /// The scripts of the case files, by file.
    pub(crate) scripts: &'a [(String, String)],
    pub(crate) dead: &'a [Dead],
    pub(crate) methods: Option<&'a Methods<'a>>,
    pub(crate) news: Option<&'a RunNews>,
    /// The frame times.
    pub(crate) timed: Option<&'a Bench>,
}

/// Returns the page. Frame files are read from the folder when they are needed.
pub(crate) fn page(folder: &Path, run: &Run, beside: &PageParts<'_>) -> String {
    let PageParts {
        scripts,
        dead,
        methods,
        news,
        timed,
    } = *beside;
    let grid = RunGrid::new(run);
    let plan = findings::FindingPlan::new(&grid);
    let drivers = methods::driver_section(&grid);
    let speed = timed.and_then(bench::of_run);
    let charts = drivers
        .as_ref()
        .or(speed.as_ref())
        .map(|_| chart::style() + bench::STYLE);
    let links = [
        ("methods", "Methods", methods.is_some()),
        ("speed", "Speed and accuracy of drivers", speed.is_some()),
        ("accuracy", "Accuracy of drivers", drivers.is_some()),
    ];
    let main = html! {
        (cases::view())
        div id="report" {
            (head(run, dead, news, &links))
            @if run.records.is_empty() {
                p { "No case was run." }
            } @else {
                @if let Some(news) = news { (changed::section(news)) }
                (causes::section(&grid, news))
                (beside::section(run))
                (overview::known(run))
                (overview::not_drawn(run))
                (matrix::section(&grid))
                (totals(run))
                (overview::dead(dead))
                @if let Some(methods) = methods { (methods::section(methods)) }
                @if let Some(speed) = speed { (speed) }
                @if let Some(drivers) = drivers { (drivers) }
                (cases::section(&grid, scripts))
            }
            // Before the long sections, so that the table works while the rest is still read.
            (data::block(&grid, &plan, scripts))
            (page::script(SCRIPT))
            @if !run.records.is_empty() {
                (findings::section(folder, &grid, &plan))
                (assertions::section(&grid))
            }
            (page::adapter::section(&run.header.adapters, &run.header.absent))
            (about(run))
        }
    };
    Page::new(&title(run), "run.jsonl and frames/ in this folder", &main)
        .style(STYLE)
        .style(&charts.unwrap_or_default())
        .script(SCRIPT, !scripts.is_empty())
        .html()
}

fn title(run: &Run) -> String {
    match run.unexpected() {
        0 => format!("etalon {}", run.header.provenance.started),
        n => format!("{n} unexpected – etalon {}", run.header.provenance.started),
    }
}

fn head(run: &Run, dead: &[Dead], news: Option<&RunNews>, links: &[(&str, &str, bool)]) -> Markup {
    let h = &run.header;
    html! {
        header {
            h1 { "etalon" }
            p.lead {
                (count(h.cases, "case")) " on " (count(h.adapters.len() as u64, "adapter"))
                ", " (count(run.records.len() as u64, "record")) ", started " (h.provenance.started)
            }
            (state(run, dead, news))
            @if !run.records.is_empty() {
            nav aria-label="Parts of the page" {
                a href="#matrix" { "Matrix" } " "
                @for (place, name, is_there) in links {
                    @if *is_there { a href={ "#" (place) } { (name) } " " }
                }
                a href="#cases" { "All cases" } " "
                a href="#findings" { "Findings" } " "
                a href="#asserted" { "What was asserted" } " "
                a href="#adapters" { "Adapters" } " "
                a href="#about" { "About the run" }
            }
            }
        }
    }
}

/// Returns the state of the run, in the order of the page: what is missing, changed, new, known and not drawn.
fn state(run: &Run, dead: &[Dead], news: Option<&RunNews>) -> Markup {
    let tally = VerdictTally::of(run.all_records());
    let beside = run.unexpected_beside();
    let improvements = run.records.iter().filter(|r| r.improvement()).count() as u64;
    let undrawn = total(&undrawn(run));
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
        @if let Some(news) = news {
            p.state.n {
                b { "Since the last run: " }
                a href="#changed" { (news.broken.len()) " broken, " (news.fixed.len()) " fixed" } "."
            }
        }
        @if tally.unexpected > 0 {
            p.state.bad {
                b { (words::symbol(Verdict::Fail)) " " (count(tally.unexpected, "unexpected record")) }
                ", by " a href="#causes" { "cause" } " and under " a href="#findings" { "Findings" } "."
                @if beside > 0 {
                    " " a href="#beside" { (beside) " beside the selected cases" } "."
                }
            }
        } @else if !run.records.is_empty() {
            p.state.good { b { (words::symbol(Verdict::Pass)) " Nothing unexpected." } }
        }
        @if tally.known > 0 {
            p.soft { b { "Known: " } a href="#known" { (count(tally.known, "bad verdict")) } "." }
        }
        @if improvements > 0 {
            p.state.good {
                b { (count(improvements, "improvement")) }
                ": their expectations can be removed."
            }
        }
        @if undrawn > 0 {
            p.soft {
                b { "Not drawn: " }
                a href="#undrawn" { (undrawn) " of " (count(run.records.len() as u64, "record")) } "."
            }
        }
        @if !dead.is_empty() {
            p.soft { a href="#dead" { (count(dead.len() as u64, "dead expectation")) } "." }
        }
    }
}

/// Returns the section on the origin of the run.
fn about(run: &Run) -> Markup {
    let settings = words::settings(&run.header.settings);
    html! {
        section id="about" {
            h2 { "About the run" }
            dl.facts {
                (origin(&run.header.provenance))
                @if !settings.is_empty() { dt { "Settings" } dd { (settings.join(", ")) } }
            }
        }
    }
}

/// Counts over the whole run, which also serve as the legend.
fn totals(run: &Run) -> Markup {
    let tally = VerdictTally::of(&run.records);
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
