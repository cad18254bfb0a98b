//! The share that the legal sets and the yardstick asserted.

use crate::numbers::{percent, percent_of, thousands};
use crate::run::grid::Grid;
use etalon_frame::{Aspect, CounterKind};
use etalon_record::Assertion;
use maud::{Markup, html};
use std::collections::BTreeMap;

pub(crate) fn section(grid: &Grid<'_>) -> Markup {
    let rows: Vec<(usize, Aspect, Vec<Figures<'_>>)> = grid
        .areas
        .iter()
        .enumerate()
        .flat_map(|(a, _)| {
            figures(grid, a)
                .into_iter()
                .map(move |(aspect, figures)| (a, aspect, figures))
        })
        .collect();
    html! {
        section id="asserted" {
            h2 { "What was asserted" }
            p {
                "A channel is one channel of one sample. It is asserted when the rules forbid some of "
                "its codes. Sharpness is the mean number of codes left to an asserted channel: 1 is "
                "the sharpest. Fail means outside the legal band, Imprecise outside the yardstick. "
                "Adapters have rows of their own where their figures differ."
            }
            @if rows.is_empty() {
                p { "No frame was judged." }
            } @else {
                div.wide { table.figures {
                    caption.vh { "What was asserted of channels, by area and aspect" }
                    thead {
                        tr {
                            th scope="col" rowspan="2" { "Area" } th scope="col" rowspan="2" { "Aspect" }
                            th scope="col" rowspan="2" { "Adapters" } th scope="col" rowspan="2" { "Channels" }
                            th.band scope="colgroup" colspan="3" { "Legal band" } th.band scope="colgroup" colspan="3" { "Yardstick" }
                        }
                        tr {
                            th.band scope="col" { "asserted" } th scope="col" { "exact" } th scope="col" { "sharpness" }
                            th.band scope="col" { "asserted" } th scope="col" { "exact" } th scope="col" { "sharpness" }
                        }
                    }
                    tbody {
                        @for (area, aspect, figures) in &rows {
                            @for f in figures { (row(grid, *area, *aspect, f)) }
                        }
                    }
                } }
                (counters(grid))
            }
        }
    }
}

/// The counters that were read back, that were asserted, and that had exactly one legal value: per area and
/// kind, over all adapters.
fn counters(grid: &Grid<'_>) -> Markup {
    let mut rows: BTreeMap<(usize, CounterKind), [u64; 3]> = BTreeMap::new();
    for area in 0..grid.areas.len() {
        for column in 0..grid.adapters.len() {
            for index in grid.areas[area].on(column) {
                for counter in &grid.record(index).counters {
                    let row = rows.entry((area, counter.kind)).or_default();
                    row[0] += 1;
                    row[1] += u64::from(counter.is_asserted());
                    row[2] += u64::from(counter.range().is_exact());
                }
            }
        }
    }
    html! {
        @if !rows.is_empty() {
            div.wide { table.figures {
                caption { "Counters, over all adapters" }
                thead { tr { th scope="col" { "Area" } th scope="col" { "Counts" } th scope="col" { "Read back" } th scope="col" { "Asserted" } th scope="col" { "Exact" } } }
                tbody {
                    @for ((area, kind), [all, asserted, exact]) in &rows {
                        tr {
                            th scope="row" { (grid.areas[*area].name) }
                            td { (kind.name()) }
                            td.num { (thousands(*all)) }
                            td.num { (percent_of(*asserted, *all)) }
                            td.num { (percent_of(*exact, *all)) }
                        }
                    }
                }
            } }
        }
    }
}

/// Adapters with the same figures.
struct Figures<'a> {
    adapters: Vec<&'a str>,
    /// The fewest and the most channels that were judged on one of them.
    channels: [u64; 2],
    shown: [String; 6],
}

/// Grouped by the figures as they are shown: an adapter that lacks a case or two does not stand
/// apart for that.
fn figures<'a>(grid: &Grid<'a>, area: usize) -> Vec<(Aspect, Vec<Figures<'a>>)> {
    let mut sums: BTreeMap<Aspect, BTreeMap<usize, Assertion>> = BTreeMap::new();
    for column in 0..grid.adapters.len() {
        for index in grid.areas[area].on(column) {
            for assertion in &grid.record(index).assertions {
                let of_aspect = sums.entry(assertion.aspect).or_default();
                of_aspect
                    .entry(column)
                    .and_modify(|sum| sum.add(assertion))
                    .or_insert(*assertion);
            }
        }
    }
    let group = |of_aspect: BTreeMap<usize, Assertion>| {
        let mut groups: Vec<Figures<'a>> = Vec::new();
        for (column, sum) in of_aspect {
            let (adapter, shown) = (grid.adapters[column], shown(&sum));
            match groups.iter_mut().find(|g| g.shown == shown) {
                Some(group) => {
                    group.adapters.push(adapter);
                    let [least, most] = group.channels;
                    group.channels = [least.min(sum.channels), most.max(sum.channels)];
                }
                None => groups.push(Figures {
                    adapters: vec![adapter],
                    channels: [sum.channels; 2],
                    shown,
                }),
            }
        }
        groups
    };
    sums.into_iter()
        .map(|(aspect, of_aspect)| (aspect, group(of_aspect)))
        .collect()
}

fn shown(sum: &Assertion) -> [String; 6] {
    let exact = |n: u64| percent_of(n, sum.channels);
    [
        percent(sum.share(), 1),
        exact(sum.exact),
        sharpness(sum.sharpness()),
        percent(sum.yardstick_share(), 1),
        exact(sum.yardstick_exact),
        sharpness(sum.yardstick_sharpness()),
    ]
}

fn row(grid: &Grid<'_>, area: usize, aspect: Aspect, figures: &Figures<'_>) -> Markup {
    let [least, most] = figures.channels;
    html! {
        tr {
            th scope="row" { (grid.areas[area].name) }
            td { (aspect.name()) }
            td.names {
                @if figures.adapters.len() == grid.adapters.len() && grid.adapters.len() > 1 {
                    "all"
                } @else {
                    (figures.adapters.join(", "))
                }
            }
            td.num {
                (thousands(most))
                @if least < most { small { " (" (thousands(least)) " at least)" } }
            }
            @for (i, text) in figures.shown.iter().enumerate() {
                td.num.band[i % 3 == 0] { (text) }
            }
        }
    }
}

fn sharpness(value: Option<f64>) -> String {
    match value {
        None => "–".to_owned(),
        Some(v) if v < 1000.0 => format!("{v:.2}"),
        Some(v) if v < 1e6 => thousands(v.round() as u64),
        Some(v) => format!("{v:.1e}"),
    }
}
