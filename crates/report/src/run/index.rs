//! The pages of a run: `index.html`, `details.html`, and the scripts with the records.
//!
//! `index.html` tells the verdict, what is new, the matrix, what is known and what was not drawn, and works without a
//! script. Its script adds the search, the table of cases and the view of one case, which load the records of an area
//! when they need them. Every view has an address: `index.html#q=less&on=cpu`, `index.html#case=depth/compare/compare=less`.
//! `details.html` has everything about the run as a whole.

mod assertions;
mod bodies;
mod cases;
mod causes;
mod changed;
mod consensus;
mod data;
pub(crate) mod detail;
mod details;
mod facts;
mod matrix;
mod overview;
mod parts;

pub(crate) use data::RECORDS;
pub(crate) use parts::{INDEX, PageParts};

use crate::error::ReportError;
use crate::files::Destination;
use crate::methods;
use crate::news::RunNews;
use crate::numbers::count;
use crate::page::{self, Page, link};
use crate::run::beside;
use crate::run::grid::{RunGrid, VerdictTally};
use crate::run::reasons::{PageReasons, total};
use crate::words;
use etalon_record::{Dead, Run, Verdict};
use maud::{Markup, html};
use parts::DETAILS;
use std::path::Path;

const STYLE: &str = concat!(
    include_str!("index/matrix.css"),
    include_str!("index/cases.css"),
    include_str!("index/case.css")
);
/// In one function, so that the page has no global names but the browser's.
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("../page/base.js"),
    include_str!("../page/compare.js"),
    include_str!("index/script/data.js"),
    include_str!("index/script/state.js"),
    include_str!("index/script/table.js"),
    include_str!("index/script/case.js"),
    include_str!("index/script/scene.js"),
    include_str!("index/script/matrix.js"),
    include_str!("index/script/keys.js"),
    include_str!("index/script/route.js"),
    "})();\n"
);

/// Writes the pages and the scripts with the records. Returns their paths. Frame files are read from the folder when
/// they are needed.
///
/// # Errors
/// Returns an error if a file cannot be written.
pub(crate) fn write(
    to: &dyn Destination,
    folder: &Path,
    run: &Run,
    parts: &PageParts<'_>,
) -> Result<Vec<String>, ReportError> {
    let grid = RunGrid::new(run);
    let reasons = PageReasons::new(run);
    let mut written = match run.records.is_empty() {
        true => Vec::new(),
        false => data::write(to, folder, &grid, &reasons)?,
    };
    to.write(DETAILS, details::page(&grid, &reasons, parts).as_bytes())?;
    to.write(INDEX, page(&grid, &reasons, parts).as_bytes())?;
    written.extend([DETAILS, INDEX].map(str::to_owned));
    Ok(written)
}

fn page(grid: &RunGrid<'_>, reasons: &PageReasons, parts: &PageParts<'_>) -> String {
    let PageParts {
        scripts,
        dead,
        methods,
        news,
        ..
    } = *parts;
    let run = grid.run;
    let main = html! {
        (cases::view())
        @if !run.records.is_empty() { (cases::section(grid, scripts)) }
        div id="report" {
            (head(run, reasons, news))
            @if run.records.is_empty() {
                p { "No case was run." }
            } @else {
                @if let Some(news) = news { (changed::section(news)) }
                (causes::section(grid, news))
                (beside::section(run))
                (matrix::section(grid))
                @if let Some(methods) = methods { (methods::section(methods)) }
                (overview::known(run, reasons))
                (overview::not_drawn(run, reasons))
            }
            (rest(run, dead))
        }
        @if !run.records.is_empty() {
            (data::block(grid, scripts))
            (page::script(SCRIPT))
        }
    };
    Page::new(&title(run), "run.jsonl and frames/ in this folder", &main)
        .style(STYLE)
        .script(SCRIPT, true)
        .html()
}

fn title(run: &Run) -> String {
    match run.unexpected() {
        0 => format!("etalon {}", run.header.provenance.started),
        n => format!("{n} unexpected – etalon {}", run.header.provenance.started),
    }
}

fn head(run: &Run, reasons: &PageReasons, news: Option<&RunNews>) -> Markup {
    let h = &run.header;
    html! {
        header {
            h1 { "etalon: " (words::counted(h.cases, "case")) " on " (words::counted(h.adapters.len() as u64, "adapter")) }
            p.lead { "Started " (h.provenance.started) }
            (state(run, reasons, news))
            @if !run.records.is_empty() { (search()) }
        }
    }
}

/// Returns the search of the first page. The table of cases answers it.
fn search() -> Markup {
    html! {
        form.find id="find" role="search" aria-label="Cases" hidden {
            input id="find-q" type="search" autocomplete="off" spellcheck="false" enterkeyhint="search"
                aria-label="Search cases" placeholder="Search cases and adapters: blend softpipe" aria-keyshortcuts="/";
            button type="submit" { "Search" }
            a href="#cases" { "All cases" }
        }
        noscript {
            p.note {
                "The search, the table of all cases and the view of a case need scripts, which are disabled here. "
                "The rest of this page does not."
            }
        }
    }
}

/// Returns the links to everything else.
fn rest(run: &Run, dead: &[Dead]) -> Markup {
    let link = |place: &str, name: &str| html! { a href={ (DETAILS) "#" (place) } { (name) } " " };
    html! {
        nav aria-label="Details" {
            @if !run.records.is_empty() {
                (link("totals", "Totals"))
                (link("asserted", "What was asserted"))
                (link("by-driver", "The matrix by driver"))
            }
            @if !dead.is_empty() { (link("dead", "Dead expectations")) }
            (link("adapters", "Adapters"))
            (link("about", "About the run"))
        }
    }
}

/// Returns the state of the run, in the order of the page: what is missing, changed, new, known and not drawn.
fn state(run: &Run, reasons: &PageReasons, news: Option<&RunNews>) -> Markup {
    let tally = VerdictTally::of(run.all_records());
    let beside = run.unexpected_beside();
    let improvements = run.records.iter().filter(|r| r.improvement()).count() as u64;
    let undrawn = total(&reasons.undrawn);
    let imprecise = tally.plain(Verdict::Imprecise);
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
                a href="#changed" { (news.broken.len()) " broken, " (news.fixed.len()) " fixed" }
                @if !news.uncompared.is_empty() { ", " (news.uncompared.len()) " bad without an earlier run to compare" } "."
            }
        }
        @if !run.records.is_empty() {
            @if let Some((failures, first)) = words::new_failures(run) {
                p.state.bad {
                    b { "✗ " a href="#unexpected=1" { (failures) } } ": first "
                    a href=(link::case(&first.case)) { code { (first.case) } } " on " (first.adapter) ", " (words::why(first))
                }
            } @else {
                p.state.good[run.missing() == 0] { b { (words::nothing_unexpected(run)) } }
            }
        }
        @if beside > 0 {
            p.state.bad { a href="#beside" { (count(beside, "failure")) " beside the selected cases" } "." }
        }
        @if improvements > 0 {
            p.state.good {
                b { (count(improvements, "improvement")) }
                ": their expectations can be removed."
            }
        }
        p.soft {
            @if tally.known > 0 {
                a href="#known" { "Known: " (words::counted(tally.known, "bad verdict")) } " "
                "of " (words::counted(reasons.known.len() as u64, "reason")) ". "
            }
            @if undrawn > 0 {
                a href="#undrawn" { "Not drawn: " (words::counted(undrawn, "record")) } ". "
            }
            @if imprecise > 0 {
                a href="#verdict=imprecise" { "Imprecise: " (words::counted(imprecise, "record")) }
                ", legal but outside the yardstick, a tighter band of quality."
            }
        }
    }
}
