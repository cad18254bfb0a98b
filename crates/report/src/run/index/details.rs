//! `details.html`: what is known about the run as a whole.

use super::parts::{INDEX, PageParts};
use super::{assertions, matrix, overview};
use crate::bench;
use crate::chart;
use crate::mark::class;
use crate::methods;
use crate::page::origin::origin;
use crate::page::{self, Page};
use crate::run::grid::{RunGrid, VerdictTally};
use crate::run::reasons::PageReasons;
use crate::words::{self, Tone};
use etalon_record::{Run, Verdict};
use maud::{Markup, html};

const STYLE: &str = include_str!("matrix.css");

/// Returns the page.
pub(super) fn page(grid: &RunGrid<'_>, reasons: &PageReasons, parts: &PageParts<'_>) -> String {
    let run = grid.run;
    let drivers = methods::driver_section(grid);
    let speed = parts.timed.and_then(bench::of_run);
    let charts = drivers.as_ref().or(speed.as_ref());
    let charts = charts.map(|_| chart::style() + bench::STYLE);
    let drawn = !run.records.is_empty();
    let links = [
        ("totals", "Totals", drawn),
        ("speed", "Speed and accuracy of drivers", speed.is_some()),
        ("accuracy", "Accuracy of drivers", drivers.is_some()),
        ("asserted", "What was asserted", drawn),
        ("by-driver", "The matrix by driver", drawn),
        ("reasons", "All reasons", drawn),
        ("dead", "Dead expectations", !parts.dead.is_empty()),
        ("adapters", "Adapters", true),
        ("about", "About the run", true),
    ];
    let main = html! {
        header {
            h1 { "Details of a run" }
            p.lead { a href=(INDEX) { "Verdicts and cases" } }
            nav aria-label="Parts of the page" {
                @for (place, name, is_there) in links {
                    @if is_there { a href={ "#" (place) } { (name) } " " }
                }
            }
        }
        @if drawn { (totals(run)) }
        @if let Some(speed) = speed { (speed) }
        @if let Some(drivers) = drivers { (drivers) }
        @if drawn {
            (assertions::section(grid))
            (matrix::by_driver(grid))
            (overview::reasons(reasons))
        }
        (overview::dead(parts.dead))
        (page::adapter::section(&run.header.adapters, &run.header.absent))
        (about(run))
    };
    Page::new(
        "etalon: details of a run",
        "run.jsonl in this folder",
        &main,
    )
    .style(STYLE)
    .style(&charts.unwrap_or_default())
    .html()
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
        Tone::Excused => "Named by the expectations or settled by triage.",
        Tone::Due => "A selftest that fails, as it is due to: it shows that the suite can fail.",
        Tone::Missed => "A selftest that is due to fail, and did not: the suite missed a bug.",
    }
}
