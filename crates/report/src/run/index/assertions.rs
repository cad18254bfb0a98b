//! The percentage of channels that the legal sets and the yardstick asserted.

use crate::lists::grouped;
use crate::numbers::{percent, percent_of, thousands};
use crate::run::grid::{AreaFiles, RunGrid};
use crate::table::{Cell, Table};
use etalon_frame::{Aspect, CounterKind};
use etalon_record::Assertion;
use maud::{Markup, html};
use std::collections::BTreeMap;

pub(crate) fn section(grid: &RunGrid<'_>) -> Markup {
    let rows: Vec<SharedFigures<'_>> = grid.areas.iter().flat_map(|a| figures(grid, a)).collect();
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
                (asserted(grid).page(rows))
                (counters(grid))
            }
        }
    }
}

/// Returns the counters that were read back, that were asserted, and that had exactly one legal value: per area
/// and kind, over all adapters.
fn counters(grid: &RunGrid<'_>) -> Markup {
    let mut rows: BTreeMap<(usize, CounterKind), [u64; 3]> = BTreeMap::new();
    for (number, area) in grid.areas.iter().enumerate() {
        let records = (0..grid.adapters.len()).flat_map(|column| area.on(column));
        for counter in records.flat_map(|index| &grid.record(index).counters) {
            let row = rows.entry((number, counter.kind)).or_default();
            row[0] += 1;
            row[1] += u64::from(counter.is_asserted());
            row[2] += u64::from(counter.range().is_exact());
        }
    }
    let table = Table::new("figures")
        .caption("Counters, over all adapters")
        .head(
            "Area",
            |((area, _), _): &((usize, CounterKind), [u64; 3])| grid.areas[*area].name,
        )
        .text("Counts", |((_, kind), _)| kind.name())
        .number("Read back", |(_, [channels, ..])| thousands(*channels))
        .number("Asserted", |(_, [channels, asserted, _])| {
            percent_of(*asserted, *channels)
        })
        .number("Exact", |(_, [channels, _, exact])| {
            percent_of(*exact, *channels)
        });
    html! { @if !rows.is_empty() { (table.page(rows)) } }
}

/// Adapters with the same figures of an area and aspect.
struct SharedFigures<'a> {
    area: &'a str,
    aspect: Aspect,
    adapters: Vec<&'a str>,
    /// The smallest and the largest number of channels that were judged on one of them.
    channels: [u64; 2],
    shown: [String; 6],
}

/// Returns the figures of an area. Adapters are grouped by rounded figures, so a missing case does not split a
/// group.
fn figures<'a>(grid: &RunGrid<'a>, area: &AreaFiles<'a>) -> Vec<SharedFigures<'a>> {
    let mut sums: BTreeMap<(Aspect, usize), Assertion> = BTreeMap::new();
    for column in 0..grid.adapters.len() {
        for assertion in area.on(column).flat_map(|i| &grid.record(i).assertions) {
            sums.entry((assertion.aspect, column))
                .and_modify(|sum| sum.add(assertion))
                .or_insert(*assertion);
        }
    }
    let shown = sums.into_iter().map(|((aspect, column), sum)| {
        let adapter = (grid.adapters[column], sum.channels);
        ((aspect, shown(&sum)), adapter)
    });
    let groups = grouped(shown).into_iter();
    let figures = groups.map(|((aspect, shown), adapters)| {
        let channels = || adapters.iter().map(|(_, channels)| *channels);
        SharedFigures {
            area: area.name,
            aspect,
            channels: [channels().min(), channels().max()].map(Option::unwrap_or_default),
            adapters: adapters.iter().map(|(name, _)| *name).collect(),
            shown,
        }
    });
    figures.collect()
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

fn asserted<'a>(grid: &'a RunGrid<'a>) -> Table<'a, SharedFigures<'a>> {
    let mut table = Table::<SharedFigures<'_>>::new("figures")
        .spoken("What was asserted of channels, by area and aspect")
        .head("Area", |f| f.area)
        .text("Aspect", |f| f.aspect.name())
        .text("Adapters", |f| {
            let everywhere = f.adapters.len() == grid.adapters.len() && f.adapters.len() > 1;
            let names = f.adapters.join(", ");
            Cell::from(if everywhere { "all".to_owned() } else { names }).class("names")
        })
        .number("Channels", |f| {
            let [least, most] = f.channels;
            html! { (thousands(most)) @if least < most { small { " (" (thousands(least)) " at least)" } } }
        });
    let names = ["asserted", "exact", "sharpness"];
    let bands = ["Legal", "Yardstick"]
        .into_iter()
        .flat_map(|band| names.map(|name| (band, name)));
    for (i, (band, name)) in bands.enumerate() {
        let class = if i % 3 == 0 { "band" } else { "" };
        let head = html! { (band) ": " br; (name) };
        table = table.number(head, move |f| Cell::from(&f.shown[i]).class(class));
    }
    table
}

fn sharpness(value: Option<f64>) -> String {
    match value {
        None => "–".to_owned(),
        Some(v) if v < 1000.0 => format!("{v:.2}"),
        Some(v) if v < 1e6 => thousands(v.round() as u64),
        Some(v) => format!("{v:.1e}"),
    }
}
