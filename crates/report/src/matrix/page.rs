//! `matrix.html`: heat maps of the performance matrix.
//!
//! Every adapter has tables of the same shape, so a script can compare two of them cell by cell. Without
//! scripts the page lacks only this comparison.

use super::csv::state;
use super::data::{CellOutcome, Matrix, MatrixCell, MatrixEntry, unit};
use super::heat::Heat;
use super::roofline;
use super::table::half_width;
use crate::bench::figures::{incomplete, limits};
use crate::chart;
use crate::numbers::{count, digits, duration};
use crate::page::adapter::breakable;
use crate::page::origin::origin;
use crate::page::{Page, script};
use crate::table::{self, Table, as_is};
use etalon_record::{CellRate, Measure, Time};
use etalon_stats::{RATE_CONFIDENCE, quantile};
use maud::{Markup, html};

const OWN_STYLE: &str = include_str!("page/matrix.css");
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("../page/base.js"),
    include_str!("page/matrix.js"),
    "})();\n",
);

/// Returns the page.
pub(crate) fn page(matrix: &Matrix<'_>) -> String {
    let main = html! {
        (head(matrix))
        (explanation())
        section id="compare" hidden {
            h2 { "Two adapters" }
            p {
                label { "Rates of " select id="one" {} } " "
                label { "over those of " select id="other" {} }
            }
            div id="ratios" {}
        }
        @if let Some(section) = roofline::section(matrix) { (section) }
        @for (i, adapter) in matrix.adapters.iter().enumerate() { (of_adapter(matrix, i, adapter)) }
        section id="samples" {
            h2 { "Samples" }
            @for (i, adapter) in matrix.adapters.iter().enumerate() {
                h3 { (breakable(adapter)) }
                @for (place, cell) in matrix.cells.iter().enumerate() { (samples(cell, adapter, &id(i, place))) }
            }
        }
        (script(SCRIPT))
    };
    Page::new(
        &format!("etalon matrix {}", matrix.bench.header.provenance.started),
        "bench.jsonl in this folder",
        &main,
    )
    .style(&chart::style())
    .style(OWN_STYLE)
    .script(SCRIPT, false)
    .html()
}

fn head(matrix: &Matrix<'_>) -> Markup {
    let h = &matrix.bench.header;
    let entries = || matrix.cells.iter().flat_map(|c| c.results.values());
    let below = entries()
        .filter(|e| matches!(e.outcome, CellOutcome::Below(_)))
        .count() as u64;
    html! {
        header {
            h1 { "Performance matrix" }
            p.lead { "Rates of fixed-function work, of pictures that were judged right." }
            (incomplete(matrix.bench))
            dl.facts {
                (origin(&h.provenance))
                dt { "Scope" } dd {
                    (count(matrix.cells.len() as u64, "cell")) " (" (h.profile) ") on "
                    (count(matrix.adapters.len() as u64, "adapter")) ", up to " (count(u64::from(h.rounds), "round")) " each"
                }
                (limits(&h.settings))
                dt { "Below resolution" } dd { (below) " of " (entries().count()) }
                @if let Some(clock) = clock(matrix) { dt { "Clock" } dd { (clock) } }
                dt { "Limits" } dd { (roofline::in_words(&h.limits)) }
            }
            nav {
                @for (i, adapter) in matrix.adapters.iter().enumerate() { a href={ "#adapter-" (i) } { (adapter) } }
                @if !h.limits.is_empty() { a href="#roofline" { "Roofline" } }
                a href="#samples" { "Samples" }
                a href="index.html" { "Frame times" }
                a href="matrix.csv" { "CSV" }
            }
        }
    }
}

/// Returns the range of the processors' clock around the rounds.
fn clock(matrix: &Matrix<'_>) -> Option<String> {
    let rounds = matrix.bench.records.iter().flat_map(|r| &r.rounds);
    let mut clocks: Vec<f64> = rounds.filter_map(|r| r.clock).flatten().collect();
    clocks.sort_by(f64::total_cmp);
    let megahertz = |q| Some(digits(quantile(&clocks, q)?.round(), 4));
    Some(format!(
        "{} to {} MHz around the rounds, median {} MHz",
        megahertz(0.0)?,
        megahertz(1.0)?,
        megahertz(0.5)?
    ))
}

fn explanation() -> Markup {
    html! {
        details {
            summary { "Reading this page" }
            p {
                "A cell is drawn with two numbers of layers. Its rate is the difference in work over the difference in "
                "time, so the fixed cost of a frame cancels. Each round gives one rate. The cell shows their "
                "median; its samples show an interval of order statistics with a confidence of at least "
                (RATE_CONFIDENCE * 100.0) " %."
            }
            p {
                b { "Gpix/s" } " counts texels that are covered by triangles, cleared, resolved or read back, once each "
                "regardless of samples and attachments. Texels that a test or the shader rejects count too. "
                b { "Mtri/s" } " counts triangles of 1,024 texels or fewer. "
                "The second number of a cell is its share of the base cell: rgba8unorm filled without blending and tests."
            }
            p {
                b { "Of memory" } " and " b { "of arithmetic" } " compare a software adapter's cell with two limits, measured before the "
                "rounds with as many threads: a copy larger than the caches, which counts the bytes that it reads and writes, and "
                "products and sums of 32-bit floats in the widest vectors, not fused. The cell's bytes and operations follow from "
                "its states: what each sample reads and writes of attachments and textures if it passes its tests and nothing is "
                "cached; conversions, products, sums and comparisons of each channel. Shaders, edges and vertices do not count. "
                "More than 100 % of memory means that caches keep the texels; more than 100 % of arithmetic, that fewer operations "
                "gave the same result."
            }
            p {
                b { "Below" } ": the additional work takes less time than the scatter of single times, or the interval contains no "
                "rate. Many hidden layers can cost nothing."
            }
        }
    }
}

fn id(adapter: usize, cell: usize) -> String {
    format!("s-{adapter}-{cell}")
}

fn of_adapter(matrix: &Matrix<'_>, number: usize, adapter: &str) -> Markup {
    let link = |cell: &MatrixCell| {
        let place = matrix.cells.iter().position(|c| c.name == cell.name);
        id(number, place.unwrap_or(0))
    };
    html! {
        section.adapter id={ "adapter-" (number) } data-adapter=(adapter) {
            h2 { (breakable(adapter)) }
            @for size in matrix.sizes() {
                @let cells: Vec<&MatrixCell> = matrix.cells.iter().filter(|c| c.size == size).collect();
                h3 { (size) }
                @for heat in Heat::all(&cells) { (map(&heat, adapter, &link)) }
                div.groups {
                    @for (group, cells) in Heat::rest(&cells) { (listed(group, &cells, adapter, &link)) }
                }
            }
        }
    }
}

fn map(heat: &Heat<'_>, adapter: &str, link: &dyn Fn(&MatrixCell) -> String) -> Markup {
    html! {
        div.wide { table.heat {
            caption { (heat.title) ", Gpix/s and share of the base cell" }
            thead {
                tr {
                    @for axis in heat.row_axes { th scope="col" rowspan="2" { (axis.replace('_', " ")) } }
                    @for (tests, width) in heat.heads() { th scope="colgroup" colspan=(width) { (tests) } }
                }
                tr { @for (_, samples) in &heat.columns { th scope="col" { (samples) "×" } } }
            }
            tbody { @for row in &heat.rows { tr {
                @for value in row { th scope="row" { (value) } }
                @for column in &heat.columns {
                    @match heat.cell(row, column) {
                        Some(cell) => (figure(cell, adapter, link)),
                        None => td.none { },
                    }
                }
            } } }
        } }
    }
}

/// Returns a cell of a heat map.
fn figure(cell: &MatrixCell, adapter: &str, link: &dyn Fn(&MatrixCell) -> String) -> Markup {
    let Some(entry) = cell.results.get(adapter) else {
        return html! { td.soft { "–" } };
    };
    html! {
        td.num style=[entry.of_base.map(shade)] data-rate=[entry.outcome.rate()] title=(words(cell, entry)) {
            a href={ "#" (link(cell)) } { (value(entry)) }
            @if let Some(share) = entry.of_base { br; small { (share_of(share)) } }
        }
    }
}

/// Returns the cell's name with the interval of its rate and its shares of the limits.
fn words(cell: &MatrixCell, entry: &MatrixEntry) -> String {
    let times = entry.outcome.times();
    let interval = times.and_then(|t| Some((unit(t.measure), t.slope.rate_interval()?)));
    let interval = interval.map(|((unit, divisor), ends)| {
        let [low, high] = ends.map(|end| digits(end / divisor, 3));
        format!("{low} to {high} {unit}")
    });
    let reached = entry.reached.as_ref().map(roofline::words);
    let facts: Vec<String> = interval.into_iter().chain(reached).collect();
    match facts.as_slice() {
        [] => cell.short(),
        facts => format!("{}: {}", cell.short(), facts.join("; ")),
    }
}

/// Returns the background for a rate relative to the base cell's: strongest from twice the rate up, none
/// below a thirty-second.
fn shade(share: f64) -> String {
    let place = ((share.log2() + 5.0) / 6.0).clamp(0.0, 1.0);
    format!("--h:{:.0}%", place * 60.0)
}

fn share_of(share: f64) -> String {
    format!("{} %", digits(share * 100.0, 3))
}

fn value(entry: &MatrixEntry) -> String {
    match (&entry.outcome, entry.outcome.rate()) {
        (CellOutcome::Rate(times), Some(rate)) => digits(rate / unit(times.measure).1, 3),
        (CellOutcome::Below(_), _) => "below".to_owned(),
        (outcome, _) => state(outcome).0,
    }
}

/// Returns the cells of a group without a heat map.
fn listed(
    group: &str,
    cells: &[&MatrixCell],
    adapter: &str,
    link: &dyn Fn(&MatrixCell) -> String,
) -> Markup {
    let measure = cells
        .iter()
        .find_map(|c| c.results.get(adapter)?.outcome.times());
    let unit = measure.map_or("rate", |t| unit(t.measure).0);
    let share = |share: Option<f64>| share.map(share_of);
    Table::new("list")
        .caption(group.replace('-', " "))
        .head("Cell", |cell: &&MatrixCell| {
            let axes = cell
                .axes
                .iter()
                .map(|(axis, value)| format!("{} {value}", axis.replace('_', " ")));
            axes.collect::<Vec<_>>().join(", ")
        })
        .number(as_is(unit), |cell| {
            cell.results.get(adapter).map(|entry| {
                let shown = html! { a href={ "#" (link(cell)) } { (value(entry)) } };
                let rate = entry.outcome.rate();
                table::Cell::from(shown).with("data-rate", rate.map(|rate| rate.to_string()))
            })
        })
        .number("±", |cell| half(cell.results.get(adapter)?))
        .number("of base", |cell| share(cell.results.get(adapter)?.of_base))
        .number("of clear", |cell| {
            share(cell.results.get(adapter)?.of_clear)
        })
        .number("of memory", |cell| {
            Some(roofline::of_limit(
                cell.results.get(adapter)?.reached?.of_memory(),
            ))
        })
        .number("of arithmetic", |cell| {
            let share = cell.results.get(adapter)?.reached?.of_arithmetic();
            (share > 0.0).then(|| roofline::of_limit(share))
        })
        .page(cells.iter().copied())
}

fn half(entry: &MatrixEntry) -> Option<String> {
    let times = entry.outcome.times()?;
    let share = half_width(times.slope.rate_interval(), times.slope.rate()?)?;
    Some(format!("{} %", digits(share * 100.0, 2)))
}

/// Returns the samples of a cell on an adapter, or the reason why it lacks them.
fn samples(cell: &MatrixCell, adapter: &str, id: &str) -> Markup {
    let Some(entry) = cell.results.get(adapter) else {
        return html! {};
    };
    let (state, message) = state(&entry.outcome);
    html! {
        details.samples {
            summary { (cell.short()) ", " (cell.size) ": " (value(entry)) }
            div.body id=(id) {
                @match entry.outcome.times() {
                    None => p { (state) @if !message.is_empty() { ": " (message) } },
                    Some(times) => (rounds(times, entry)),
                }
            }
        }
    }
}

fn rounds(times: &CellRate, entry: &MatrixEntry) -> Markup {
    let (unit, divisor) = unit(times.measure);
    let scaled = |rate: f64| digits(rate / divisor, 4);
    let each: Vec<String> = times.slope.rounds.iter().map(|s| scaled(1.0 / s)).collect();
    let list = |times: &[f64]| {
        times
            .iter()
            .map(|t| duration(*t))
            .collect::<Vec<_>>()
            .join(", ")
    };
    html! {
        dl.facts {
            dt { "Rate" } dd { @match times.slope.rate() {
                Some(rate) => { (scaled(rate)) " " (unit) },
                None => "below the resolution of the times",
            } }
            dt { "Interval" } dd { @match times.slope.rate_interval() {
                Some([low, high]) => { (scaled(low)) " to " (scaled(high)) " " (unit) },
                None => "none",
            } }
            @if let Some(share) = entry.of_base { dt { "Of base" } dd { (share_of(share)) } }
            @if let Some(share) = entry.of_clear { dt { "Of clear" } dd { (share_of(share)) } }
            @if let Some(reached) = &entry.reached { dt { "Of limits" } dd { (roofline::words(reached)) } }
            dt { "Work between" } dd { (times.work) " " (noun(times.measure)) }
            dt { "Rounds" } dd { (each.join(", ")) " " (unit) }
            dt { "Fewer layers" } dd { (list(&times.medians[0])) }
            dt { "More layers" } dd { (list(&times.medians[1])) }
            dt { "Time" } dd { (time(times.time)) }
        }
    }
}

fn noun(measure: Measure) -> &'static str {
    match measure {
        Measure::Triangles => "triangles",
        Measure::Texels => "texels covered",
        Measure::Cleared => "texels cleared",
        Measure::Resolved => "texels resolved",
        Measure::Read => "texels read back",
    }
}

fn time(time: Time) -> &'static str {
    match time {
        Time::Gpu => "between timestamps of the device",
        Time::ReadBack => "of reading back",
        _ => "until the device was done",
    }
}
