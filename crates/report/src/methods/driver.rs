//! The accuracy of drivers, which is the distance of their codes from the ideal codes. A run draws each case
//! once with new pipelines, so it has no speed; only method cases can be timed.

use crate::chart::{LEFT, RIGHT, Scale, TOP, chart, key, marker, n, tick_labels, tick_width};
use crate::lists::distinct;
use crate::numbers::{count, digits, duration, median};
use crate::page::adapter::breakable;
use crate::run::grid::RunGrid;
use crate::table::{Cell, Table};
use crate::words::plain;
use etalon_frame::{Accuracy, Aspect, ChannelEncoding};
use etalon_record::{Record, Verdict};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// The share of channel values that the table states a bound for.
const SHARE: f64 = 0.99;

/// The accuracy of one adapter's frames of one area and aspect.
#[derive(Clone, Copy, Default)]
struct DriverFigures<'a> {
    /// The accuracy of legal frames.
    legal: Option<Accuracy>,
    /// The case with the largest distance.
    farthest: &'a str,
    /// The accuracy of wrong frames. They are kept apart, because their large distances would hide all
    /// others.
    wrong: Option<Accuracy>,
}

impl<'a> DriverFigures<'a> {
    fn add(&mut self, case: &'a str, accuracy: &Accuracy, legal: bool) {
        if legal && self.legal.is_none_or(|sum| accuracy.max > sum.max) {
            self.farthest = case;
        }
        let sum = if legal {
            &mut self.legal
        } else {
            &mut self.wrong
        };
        match sum {
            Some(sum) => sum.add(accuracy),
            None => *sum = Some(*accuracy),
        }
    }
}

/// The rows of the table: for each area, aspect and encoding, the figures of each adapter. Codes of different
/// encodings are never added.
type DriverRows<'a> = BTreeMap<(&'a str, Aspect, Option<ChannelEncoding>), Vec<DriverFigures<'a>>>;

/// The judged records of one case, each with its adapter's column.
type CaseRecords<'a> = Vec<(usize, &'a Record)>;

fn rows<'a>(grid: &RunGrid<'a>) -> DriverRows<'a> {
    let mut rows: DriverRows<'a> = BTreeMap::new();
    for area in &grid.areas {
        let mut cases: BTreeMap<&str, CaseRecords<'_>> = BTreeMap::new();
        for column in 0..grid.adapters.len() {
            for index in area.on(column) {
                let record = grid.record(index);
                // A selftest's frame is compared with a wrong expectation on purpose.
                if !record.due_fail && is_legal(record).is_some() {
                    let of_case = cases.entry(&record.case).or_default();
                    of_case.push((column, record));
                }
            }
        }
        for (case, records) in &cases {
            add_case(grid, &mut rows, (area.name, case), records);
        }
    }
    rows
}

/// Returns true if a record's frame is legal, and false if it failed; `None` if it was not judged.
fn is_legal(record: &Record) -> Option<bool> {
    match record.verdict {
        Verdict::Pass | Verdict::Imprecise | Verdict::Measured => Some(true),
        Verdict::Fail => Some(false),
        _ => None,
    }
}

/// Adds the figures of a case on all adapters. Records leave out what is exact. If some adapter is off in a
/// case, the others count there as exact with the same number of channel values, so that all means are over
/// the same cases.
fn add_case<'a>(
    grid: &RunGrid<'a>,
    rows: &mut DriverRows<'a>,
    (area, case): (&'a str, &'a str),
    records: &CaseRecords<'a>,
) {
    let entries = records.iter().flat_map(|(_, record)| &record.accuracy);
    let entries: Vec<&Accuracy> = entries.filter(|a| drawable(a)).collect();
    let keys = distinct(entries.iter().map(|a| (a.aspect, a.encoding)));
    for (aspect, encoding) in keys {
        let alike = |a: &&Accuracy| (a.aspect, a.encoding) == (aspect, encoding);
        let sizes = entries.iter().copied().filter(alike);
        let channels = sizes.map(|a| a.channels.saturating_add(a.overflow)).max();
        let exact = Accuracy {
            channels: channels.unwrap_or(0),
            ..Accuracy::none(aspect, encoding)
        };
        for (column, record) in records {
            let mut of_record = record.accuracy.iter().filter(|a| a.aspect == aspect);
            let figures = match of_record.clone().find(alike) {
                Some(found) if drawable(found) => *found,
                Some(_) => continue,
                None if of_record.next().is_none()
                    && asserts(record, aspect)
                    && has_encoding(grid, *column, aspect, encoding) =>
                {
                    exact
                }
                None => continue,
            };
            let row = rows
                .entry((area, aspect, encoding))
                .or_insert_with(|| vec![DriverFigures::default(); grid.adapters.len()]);
            let legal = is_legal(record) == Some(true);
            if legal || !figures.is_exact() {
                row[*column].add(case, &figures, legal);
            }
        }
    }
}

/// Returns true if the yardstick asserts something about an aspect of a frame.
fn asserts(record: &Record, aspect: Aspect) -> bool {
    let mut assertions = record.assertions.iter();
    assertions.any(|a| a.aspect == aspect && a.yardstick_asserted > 0)
}

/// Returns true if an adapter can have read this encoding: one format can have several depth encodings.
fn has_encoding(
    grid: &RunGrid<'_>,
    column: usize,
    aspect: Aspect,
    encoding: Option<ChannelEncoding>,
) -> bool {
    let (Aspect::Depth, Some(encoding)) = (aspect, encoding) else {
        return encoding.is_some();
    };
    let adapter = grid.run.header.adapter(grid.adapters[column]);
    let mut formats = adapter.into_iter().flat_map(|a| a.limits.formats.values());
    formats.any(|format| format.depth.contains(&encoding))
}

/// Returns true if a chart can show the numbers of a record. A run folder can contain any number.
fn drawable(a: &Accuracy) -> bool {
    let fine = |v: f64| v.is_finite() && (0.0..=1e12).contains(&v);
    (a.channels > 0 || a.overflow > 0) && fine(a.mean) && fine(a.max)
}

/// Returns the median frame time of an adapter's timed cases, in seconds; `None` if the run timed none.
fn frame_time(grid: &RunGrid<'_>, adapter: &str) -> Option<f64> {
    let records = grid.run.records.iter().filter(|r| r.adapter == adapter);
    median(records.filter_map(|r| Some(r.measured.as_ref()?.time?.wall)))
}

/// Returns the section of `index.html`; `None` if no record has a distance.
pub(crate) fn section(grid: &RunGrid<'_>) -> Option<Markup> {
    let rows = rows(grid);
    if rows.is_empty() {
        return None;
    }
    let panels = [Aspect::Color, Aspect::Depth].into_iter();
    let panels = panels.flat_map(|aspect| [(aspect, StepUnit::Code), (aspect, StepUnit::Ulp)]);
    let section = html! {
        section id="accuracy" {
            h2 { "Accuracy of drivers" }
            p {
                "The distance of legal frames from the ideal: the middle of the yardstick's interval. Values without an ideal are not measured: "
                "undefined contents, values beyond the range of their encoding, and outcomes of a choice that the rules leave to the driver. "
                "Each mark is an adapter's mean over the cases of an area in which any adapter is not exact."
            }
            p.legend {
                @for (i, adapter) in grid.adapters.iter().enumerate() {
                    span.key { (key(i)) " " (breakable(adapter)) }
                }
            }
            div.charts {
                @for (aspect, unit) in panels { (panel(grid, &rows, aspect, unit)) }
            }
            p.note {
                b { "½ code is rounding:" } " if the ideal is halfway between two codes, both are half a code away. After several roundings in a row, "
                "and in floats or depths of 24 and more bits, the yardstick knows the ideal to a few steps only. " code { "cpu" } ", which computes in 32-bit floats, "
                "differs from its middle by as much."
            }
            (speed(grid))
            details open[rows.len() <= 12] {
                summary { "Table and command" }
                p.again { "Drawn by " code { (grid.run.header.provenance.command.join(" ")) } }
                p.note {
                    "The mean / a bound for 99 % of the values / the largest distance of legal frames, in codes of fixed point or ulp of floats. The bound is known to a factor of two, "
                    "and older runs lack it. Overflows are values of which only the code or the ideal is finite. In brackets, if there "
                    "are any: the largest distance of frames that failed. Hover over a cell for the case that is farthest off."
                }
                (table(grid, &rows))
            }
        }
    };
    Some(section)
}

/// Returns what the run says about speed: the frame times of its methods, or the command that times frames.
fn speed(grid: &RunGrid<'_>) -> Markup {
    let is_timed = grid.adapters.iter().any(|a| frame_time(grid, a).is_some());
    let adapters = grid.adapters.iter().map(|a| format!(" --adapter {a}"));
    let command = adapters.fold("etalon bench 'perf/*'".to_owned(), |text, a| text + &a);
    html! {
        p {
            b { "Speed: " }
            @if is_timed {
                "this run timed the frames of method cases only, and the table has their median. "
            } @else {
                "no frame of this run was timed. "
            }
            "To time drivers and see their errors beside it: " code { (command) }
        }
    }
}

fn table(grid: &RunGrid<'_>, rows: &DriverRows<'_>) -> Markup {
    // The names of a row, its class, and a cell per adapter.
    type Row = ([String; 3], &'static str, Vec<Cell>);
    let mut lines: Vec<Row> = rows
        .iter()
        .map(|((area, aspect, encoding), figures)| {
            let encoded = encoding.map_or_else(|| "several".to_owned(), |e| e.to_string());
            let names = [(*area).to_owned(), aspect.name().to_owned(), encoded];
            (names, "", figures.iter().map(cell).collect())
        })
        .collect();
    let times: Vec<Option<f64>> = grid.adapters.iter().map(|a| frame_time(grid, a)).collect();
    if times.iter().any(Option::is_some) {
        let name = "median frame time of methods".to_owned();
        let cells = times.into_iter().map(|t| Cell::from(t.map(duration)));
        lines.push(([name, String::new(), String::new()], "sum", cells.collect()));
    }
    let mut table = Table::<Row>::new("numbers")
        .row_class(|(_, class, _)| *class)
        .head("Area", |(names, ..)| names[0].clone())
        .text("Aspect", |(names, ..)| names[1].clone())
        .text("Encoding", |(names, ..)| names[2].clone());
    for (i, adapter) in grid.adapters.iter().enumerate() {
        table = table.text(breakable(adapter), move |(.., cells)| cells[i].clone());
    }
    table.page(lines)
}

fn cell(figures: &DriverFigures<'_>) -> Cell {
    let shown = html! {
        @match &figures.legal {
            None => "–",
            Some(legal) if legal.is_exact() => "exact",
            Some(legal) => {
                @if legal.max > 0.0 {
                    (digits(legal.mean, 2)) " / "
                    @match legal.percentile(SHARE) { Some(bound) => (digits(bound, 3)), None => "–" }
                    " / " (digits(legal.max, 3))
                } @else { "exact" }
                @if legal.overflow > 0 { br; small { (count(legal.overflow, "overflow")) } }
            }
        }
        @if let Some(wrong) = &figures.wrong {
            " (" (digits(wrong.max, 3))
            @if wrong.overflow > 0 { ", " (count(wrong.overflow, "overflow")) }
            ")"
        }
    };
    let title = figures
        .legal
        .filter(|legal| !legal.is_exact())
        .map(|_| format!("The largest: {}", figures.farthest));
    Cell::from(shown).with("title", title)
}

/// The step that a distance counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum StepUnit {
    /// A code of a fixed-point or integer encoding.
    Code,
    /// The step of a float.
    Ulp,
}

impl StepUnit {
    fn of(encoding: ChannelEncoding) -> Self {
        if encoding.is_float() {
            Self::Ulp
        } else {
            Self::Code
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Code => "codes",
            Self::Ulp => "ulp",
        }
    }

    fn numbers(self) -> &'static str {
        match self {
            Self::Code => "fixed point",
            Self::Ulp => "floats",
        }
    }
}

/// The figures of an area's frames on each adapter, over all encodings with the same unit.
type AreaFigures<'a> = BTreeMap<&'a str, Vec<Option<Accuracy>>>;

/// Returns the figures of each area and adapter; none for areas without a known encoding.
fn of_areas<'a>(
    rows: &DriverRows<'a>,
    (aspect, unit): (Aspect, StepUnit),
    adapters: usize,
) -> AreaFigures<'a> {
    let mut result = AreaFigures::new();
    for ((area, _, encoding), figures) in rows.iter().filter(|((_, a, _), _)| *a == aspect) {
        if encoding.map(StepUnit::of) != Some(unit) {
            continue;
        }
        for (adapter, f) in figures.iter().enumerate() {
            let Some(legal) = f.legal.filter(|legal| legal.channels > 0) else {
                continue;
            };
            let area = result.entry(area).or_insert_with(|| vec![None; adapters]);
            area[adapter]
                .get_or_insert(Accuracy::none(aspect, None))
                .add(&legal);
        }
    }
    result
}

/// Returns a chart with a row per area and a mark per adapter at its mean distance.
fn panel(grid: &RunGrid<'_>, rows: &DriverRows<'_>, aspect: Aspect, unit: StepUnit) -> Markup {
    const ROW: f64 = 24.0;
    const NAMES: f64 = 96.0;
    const ZERO: f64 = 30.0;
    let areas = of_areas(rows, (aspect, unit), grid.adapters.len());
    if areas.is_empty() {
        return html! {};
    }
    let means = areas.values().flat_map(|f| f.iter().flatten());
    let scale = Scale::log(means.map(|s| s.mean).filter(|m| *m > 0.0).chain([0.1, 0.5]));
    let start = LEFT + NAMES - 40.0;
    let x = |mean: f64| {
        if mean > 0.0 {
            start + ZERO + scale.at(mean) * (RIGHT - start - ZERO)
        } else {
            start + ZERO / 2.0
        }
    };
    let bottom = TOP + ROW * areas.len() as f64;
    let rounding = x(0.5);
    let exact_end = start + (ZERO + tick_width("exact")) / 2.0;
    let body = html! {
        rect.zero x=(n(start)) y=(n(TOP)) width=(n(ZERO)) height=(n(bottom - TOP)) {}
        text.tick x=(n(start + ZERO / 2.0)) y=(n(bottom + 14.0)) text-anchor="middle" { "exact" }
        @for tick in scale.ticks(5) { path.grid d={ "M" (n(x(tick))) " " (n(TOP)) "V" (n(bottom)) } {} }
        @for (x, label) in tick_labels(exact_end, scale.ticks(5).into_iter().map(|tick| (x(tick), digits(tick, 2)))) {
            text.tick x=(n(x)) y=(n(bottom + 14.0)) text-anchor="middle" { (label) }
        }
        path.level.one d={ "M" (n(rounding)) " " (n(TOP)) "V" (n(bottom)) } {}
        rect.box x=(n(start)) y=(n(TOP)) width=(n(RIGHT - start)) height=(n(bottom - TOP)) {}
        text.axis x=(n(RIGHT)) y=(n(bottom + 32.0)) text-anchor="end" { "← more accurate: mean distance in " (unit.name()) }
        @for (i, (area, figures)) in areas.iter().enumerate() {
            @let y = TOP + ROW * (i as f64 + 0.5);
            text.tick x=(n(start - 5.0)) y=(n(y + 3.5)) text-anchor="end" { (plain(area, 18)) }
            @if i > 0 { path.grid d={ "M" (n(start)) " " (n(y - ROW / 2.0)) "H" (n(RIGHT)) } {} }
            @for (adapter, f) in figures.iter().enumerate() {
                @if let Some(legal) = f {
                    // Marks of equal means are shifted apart vertically.
                    @let shift = (adapter as f64 + 0.5) / figures.len() as f64 - 0.5;
                    @let text = format!("{}, {area}: mean {}, largest {} {}", grid.adapters[adapter], digits(legal.mean, 2), digits(legal.max, 3), unit.name());
                    (marker(adapter, (x(legal.mean), y + shift * (ROW - 10.0)), true, &text))
                }
            }
        }
    };
    let title = format!(
        "{} in {}: distance from the ideal",
        super::name::title(aspect.name()),
        unit.numbers()
    );
    let about =
        "A row per area, a mark per adapter at its mean distance. The dotted line is half a step.";
    chart(bottom + 42.0, &title, about, &body)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accuracy(encoding: Option<ChannelEncoding>, mean: f64, max: f64) -> Accuracy {
        Accuracy {
            channels: 100,
            mean,
            max,
            ..Accuracy::none(Aspect::Color, encoding)
        }
    }

    #[test]
    fn codes_of_fixed_point_and_steps_of_floats_are_never_added() {
        let row = |encoding, mean, max| {
            let figures = vec![DriverFigures {
                legal: Some(accuracy(encoding, mean, max)),
                ..DriverFigures::default()
            }];
            (("blend", Aspect::Color, encoding), figures)
        };
        let rows: DriverRows<'_> = [
            row(Some(ChannelEncoding::Unorm(8)), 0.5, 1.0),
            row(Some(ChannelEncoding::Srgb8), 0.25, 2.0),
            row(Some(ChannelEncoding::Float32), 8.0, 64.0),
            row(None, 1.0, 7.0),
        ]
        .into();
        let figures = |unit| {
            let of_unit = of_areas(&rows, (Aspect::Color, unit), 1);
            let sum = of_unit["blend"][0].unwrap();
            (sum.channels, sum.mean, sum.max)
        };
        assert_eq!(figures(StepUnit::Code), (200, 0.375, 2.0));
        assert_eq!(figures(StepUnit::Ulp), (100, 8.0, 64.0));
    }

    #[test]
    fn a_cell_has_mean_bound_largest_and_overflows() {
        let encoding = Some(ChannelEncoding::Float16);
        let text = |legal: Accuracy| {
            let figures = DriverFigures {
                legal: Some(legal),
                ..DriverFigures::default()
            };
            cell(&figures).element("td").into_string()
        };
        // A record of an older version has no spread, so nothing bounds 99 % of its values.
        let old = accuracy(encoding, 0.5, 3.0);
        assert!(text(old).contains(">0.5 / – / 3<"), "{}", text(old));
        let mut new = Accuracy { overflow: 2, ..old };
        new.spread.count(3.0);
        assert!(
            text(new).contains(">0.5 / 0 / 3<br><small>2 overflows<"),
            "{}",
            text(new)
        );
        let exact = accuracy(encoding, 0.0, 0.0);
        assert!(text(exact).contains(">exact<"));
    }
}
