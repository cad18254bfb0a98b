//! The accuracy of drivers, which is the distance of their codes from the ideal codes, and their speed.

use crate::chart::{LEFT, RIGHT, Scale, TOP, chart, key, marker, n};
use crate::numbers::{digits, duration, median, share};
use crate::page::adapter::breakable;
use crate::run::grid::{RunGrid, rate};
use crate::table::{Cell, Table};
use crate::words::plain;
use etalon_frame::{Accuracy, Aspect, ChannelEncoding};
use etalon_record::{Record, Verdict};
use maud::{Markup, html};
use std::collections::BTreeMap;

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

fn rows<'a>(grid: &RunGrid<'a>) -> DriverRows<'a> {
    let mut rows: DriverRows<'a> = BTreeMap::new();
    for area in &grid.areas {
        for column in 0..grid.adapters.len() {
            for index in area.on(column) {
                let record = grid.record(index);
                // A selftest's frame is compared with a wrong expectation on purpose.
                if record.due_fail {
                    continue;
                }
                let legal = match record.verdict {
                    Verdict::Pass | Verdict::Imprecise | Verdict::Measured => true,
                    Verdict::Fail => false,
                    _ => continue,
                };
                for accuracy in record.accuracy.iter().filter(|a| drawable(a)) {
                    let row = rows
                        .entry((area.name, accuracy.aspect, accuracy.encoding))
                        .or_insert_with(|| vec![DriverFigures::default(); grid.adapters.len()]);
                    row[column].add(&record.case, accuracy, legal);
                }
            }
        }
    }
    rows
}

/// Returns true if a chart can show the numbers of a record. A run folder can contain any number.
fn drawable(a: &Accuracy) -> bool {
    let fine = |v: f64| v.is_finite() && (0.0..=1e12).contains(&v);
    a.channels > 0 && fine(a.mean) && fine(a.max)
}

/// The speed of an adapter in the run.
struct Speed {
    cases_per_second: Option<f64>,
    /// The median time of drawing and reading back, in seconds, over all judged cases.
    draw: Option<f64>,
    /// The median frame time of method cases, in seconds.
    frame: Option<f64>,
}

fn speed(grid: &RunGrid<'_>, adapter: &str) -> Speed {
    let records = grid.run.records.iter();
    let records: Vec<&Record> = records.filter(|r| r.adapter == adapter).collect();
    let judged = records.iter().filter(|r| r.verdict.is_judged());
    let times = records
        .iter()
        .filter_map(|r| Some(r.measured.as_ref()?.time?.wall));
    Speed {
        cases_per_second: rate(&records),
        draw: median(judged.map(|r| r.seconds.draw)),
        frame: median(times),
    }
}

/// Returns the section of `index.html`; `None` if no record has a distance.
pub(crate) fn section(grid: &RunGrid<'_>) -> Option<Markup> {
    let rows = rows(grid);
    if rows.is_empty() {
        return None;
    }
    let aspects: Vec<Aspect> = [Aspect::Color, Aspect::Depth, Aspect::Stencil]
        .into_iter()
        .filter(|a| rows.keys().any(|(_, aspect, _)| aspect == a))
        .collect();
    let section = html! {
        section id="accuracy" {
            h2 { "Accuracy and speed of drivers" }
            p {
                "How far the codes of legal frames lie from the ideal ones, the middle of the yardstick's "
                "interval. Codes of different encodings are steps of different sizes: the charts show shares of the range, from the least "
                "to the largest value of an encoding, and the table codes too. A float's range is that from a power of two to the next. "
                "Each mark is an adapter's mean over an area."
            }
            p.legend {
                @for (i, adapter) in grid.adapters.iter().enumerate() {
                    span.key { (key(i)) " " (breakable(adapter)) }
                }
            }
            div.charts {
                @for aspect in aspects.iter().filter(|a| **a != Aspect::Stencil) { (panel(grid, &rows, *aspect)) }
            }
            details open[rows.len() <= 12] {
                summary { "Table and command" }
                p.again { "Drawn by " code { (grid.run.header.provenance.command.join(" ")) } }
                p.note {
                    "The mean / the largest distance of legal frames in codes, and below as shares of the range. An ideal value "
                    "halfway between two codes is half a code away from both. In brackets, if there "
                    "are any: the largest distance of frames that failed. A draw time covers drawing and reading "
                    "back one case with new pipelines. A frame time is that of a method case that was drawn many times. Hover "
                    "over a cell for the case that is farthest off: a depth bias counts in steps that a driver may double, which "
                    "is legal and millions of codes away."
                }
                (table(grid, &rows))
            }
        }
    };
    Some(section)
}

fn table(grid: &RunGrid<'_>, rows: &DriverRows<'_>) -> Markup {
    // The names of a row, its class, and a cell per adapter.
    type Row = ([String; 3], &'static str, Vec<Cell>);
    let speeds: Vec<Speed> = grid.adapters.iter().map(|a| speed(grid, a)).collect();
    let speed = |name: &str, class, figure: &dyn Fn(&Speed) -> Option<String>| -> Row {
        let cells = speeds.iter().map(|s| Cell::from(figure(s))).collect();
        (
            [name.to_owned(), String::new(), String::new()],
            class,
            cells,
        )
    };
    let mut lines: Vec<Row> = rows
        .iter()
        .map(|((area, aspect, encoding), figures)| {
            let encoded = encoding.map_or_else(|| "several".to_owned(), |e| e.to_string());
            let names = [(*area).to_owned(), aspect.name().to_owned(), encoded];
            (
                names,
                "",
                figures.iter().map(|f| cell(f, *encoding)).collect(),
            )
        })
        .collect();
    lines.push(speed("cases per second", "sum", &|s| {
        s.cases_per_second.map(|rate| digits(rate, 3))
    }));
    lines.push(speed("median draw time", "", &|s| s.draw.map(duration)));
    if speeds.iter().any(|s| s.frame.is_some()) {
        lines.push(speed("median frame time of methods", "", &|s| {
            s.frame.map(duration)
        }));
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

/// Returns a distance in codes as a fraction of the encoding's range; `None` if the encoding is not known.
fn of_range(codes: f64, encoding: Option<ChannelEncoding>) -> Option<f64> {
    let part = codes / encoding?.range();
    part.is_finite().then_some(part)
}

/// Returns the text of a fraction of a range; `over 100 %` above 1.
fn part(value: f64) -> String {
    if value > 1.0 {
        "over 100\u{a0}%".to_owned()
    } else {
        share(value)
    }
}

fn cell(figures: &DriverFigures<'_>, encoding: Option<ChannelEncoding>) -> Cell {
    let shown = html! {
        @if let Some(legal) = &figures.legal {
            (digits(legal.mean, 2)) " / " (digits(legal.max, 3))
            @if let (Some(mean), Some(max)) = (of_range(legal.mean, encoding), of_range(legal.max, encoding)) {
                br; small { (part(mean)) " / " (part(max)) }
            }
        } @else { "–" }
        @if let Some(wrong) = &figures.wrong {
            " (" (digits(wrong.max, 3)) ")"
        }
    };
    let title = figures
        .legal
        .map(|_| format!("The largest: {}", figures.farthest));
    Cell::from(shown).with("title", title)
}

/// The mean and the largest distance over all encodings, as fractions of their ranges.
#[derive(Clone, Copy, Default)]
struct Shares {
    channels: f64,
    mean: f64,
    max: f64,
}

/// Returns the fractions of each area and adapter; none for areas without a known encoding.
fn shares<'a>(
    rows: &DriverRows<'a>,
    aspect: Aspect,
    adapters: usize,
) -> BTreeMap<&'a str, Vec<Option<Shares>>> {
    let mut result: BTreeMap<&str, Vec<Option<Shares>>> = BTreeMap::new();
    for ((area, _, encoding), figures) in rows.iter().filter(|((_, a, _), _)| *a == aspect) {
        for (adapter, f) in figures.iter().enumerate() {
            let Some(legal) = f.legal else { continue };
            let (Some(mean), Some(max)) = (
                of_range(legal.mean, *encoding),
                of_range(legal.max, *encoding),
            ) else {
                continue;
            };
            let measured = result.entry(area).or_insert_with(|| vec![None; adapters]);
            let sum = measured[adapter].get_or_insert_default();
            let channels = legal.channels as f64;
            sum.channels += channels;
            sum.mean += (mean - sum.mean) * channels / sum.channels;
            sum.max = sum.max.max(max);
        }
    }
    result
}

/// Returns a chart with a row per area and a mark per adapter at its mean distance.
fn panel(grid: &RunGrid<'_>, rows: &DriverRows<'_>, aspect: Aspect) -> Markup {
    const ROW: f64 = 24.0;
    const NAMES: f64 = 96.0;
    const ZERO: f64 = 30.0;
    let of_aspect = shares(rows, aspect, grid.adapters.len());
    if of_aspect.is_empty() {
        return html! {};
    }
    let means = of_aspect.values().flat_map(|f| f.iter().flatten());
    let scale = Scale::log(
        means
            .map(|s| s.mean)
            .filter(|m| *m > 0.0)
            .chain([0.0005, 0.002]),
    );
    let start = LEFT + NAMES - 40.0;
    let x = |mean: f64| {
        if mean > 0.0 {
            start + ZERO + scale.at(mean) * (RIGHT - start - ZERO)
        } else {
            start + ZERO / 2.0
        }
    };
    let bottom = TOP + ROW * of_aspect.len() as f64;
    let body = html! {
        rect.zero x=(n(start)) y=(n(TOP)) width=(n(ZERO)) height=(n(bottom - TOP)) {}
        text.tick x=(n(start + ZERO / 2.0)) y=(n(bottom + 14.0)) text-anchor="middle" { "exact" }
        @for tick in scale.ticks(5) {
            path.grid d={ "M" (n(x(tick))) " " (n(TOP)) "V" (n(bottom)) } {}
            @if x(tick) > start + ZERO + 14.0 {
                text.tick x=(n(x(tick))) y=(n(bottom + 14.0)) text-anchor="middle" { (share(tick)) }
            }
        }
        rect.box x=(n(start)) y=(n(TOP)) width=(n(RIGHT - start)) height=(n(bottom - TOP)) {}
        text.axis x=(n(f64::midpoint(start, RIGHT))) y=(n(bottom + 32.0)) text-anchor="middle" { "← more accurate: mean distance, share of the range" }
        @for (i, (area, figures)) in of_aspect.iter().enumerate() {
            @let y = TOP + ROW * (i as f64 + 0.5);
            text.tick x=(n(start - 5.0)) y=(n(y + 3.5)) text-anchor="end" { (plain(area, 18)) }
            @if i > 0 { path.grid d={ "M" (n(start)) " " (n(y - ROW / 2.0)) "H" (n(RIGHT)) } {} }
            @for (adapter, f) in figures.iter().enumerate() {
                @if let Some(legal) = f {
                    // Marks of equal means are shifted apart vertically.
                    @let shift = (adapter as f64 + 0.5) / figures.len() as f64 - 0.5;
                    @let text = format!("{}, {area}: mean {}, largest {} of the range", grid.adapters[adapter], part(legal.mean), part(legal.max));
                    (marker(adapter, (x(legal.mean), y + shift * (ROW - 10.0)), true, &text))
                }
            }
        }
    };
    let title = format!(
        "{}: distance from the ideal",
        super::name::title(aspect.name())
    );
    let about = "A row per area, a mark per adapter at its mean distance as a share of the range.";
    chart(bottom + 42.0, &title, about, &body)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_floats_and_of_8_bits_are_compared_only_as_shares() {
        let row = |encoding, mean, max| {
            let legal = Accuracy {
                aspect: Aspect::Color,
                encoding,
                channels: 100,
                mean,
                max,
            };
            let figures = vec![DriverFigures {
                legal: Some(legal),
                ..DriverFigures::default()
            }];
            (("blend", Aspect::Color, encoding), figures)
        };
        let [eight, float] = [ChannelEncoding::Unorm(8), ChannelEncoding::Float32];
        let rows: DriverRows<'_> = [
            row(Some(eight), 0.51, 1.0),
            row(Some(float), 83_886.08, 4_294_967_296.0),
            row(None, 1.0, 7.0),
        ]
        .into();
        let texts = shares(&rows, Aspect::Color, 1);
        let mean = texts["blend"][0].unwrap().mean;
        assert!((mean - (0.002 + 0.01) / 2.0).abs() < 1e-9, "{mean}");
        let text = |encoding, i: usize| {
            let figures = rows.values().nth(i).unwrap();
            cell(&figures[0], encoding).element("td").into_string()
        };
        assert!(text(None, 0).contains("1 / 7<"), "{}", text(None, 0));
        assert!(
            text(Some(eight), 1).contains("<small>0.2\u{a0}% / 0.392\u{a0}%"),
            "{}",
            text(Some(eight), 1)
        );
        assert!(
            text(Some(float), 2).contains("<small>1\u{a0}% / over 100\u{a0}%"),
            "{}",
            text(Some(float), 2)
        );
    }
}
