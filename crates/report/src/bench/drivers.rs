//! The chart at the top of the page of a bench: for each kind of work, the error of each adapter's pictures
//! against the time that they take.

use super::figures::{CaseFigures, KINDS, TimedCase, software};
use super::kind::CaseKind;
use crate::chart::{
    LEFT, LabelPlaces, RIGHT, Scale, TOP, chart, color, key, marker, n, tick_labels,
};
use crate::lists::distinct;
use crate::numbers::{capital, count, digits, duration, round_duration};
use crate::page::adapter::breakable;
use crate::table::{Cell, Table};
use crate::words::plain;
use etalon_frame::{Accuracy, Aspect};
use etalon_record::{Bench, Measure, Time};
use maud::{Markup, html};
use std::collections::BTreeMap;

/// The share of channel values that the tables state a bound for.
const SHARE: f64 = 0.99;

/// The work that a time is for: a million units.
const UNITS: f64 = 1e6;

/// The kind of work of a panel, with one mark for each adapter that has a time.
struct Panel<'a> {
    kind: CaseKind<'a>,
    marks: Vec<AdapterMark>,
    /// The number of cases that each mark is a mean of; `None` if the adapters have no case in common, so that
    /// each has its own cases.
    cases: Option<usize>,
    unit: &'static str,
}

/// The time and the error of an adapter.
struct AdapterMark {
    /// The adapter's index in the header.
    adapter: usize,
    /// Seconds for a million units of work: the geometric mean over the cases.
    time: f64,
    /// The figures over the cases; `None` if no channel has an ideal.
    error: Option<Accuracy>,
}

impl AdapterMark {
    fn mean(&self) -> Option<f64> {
        self.error.filter(|e| e.channels > 0).map(|e| e.mean)
    }

    fn new(adapter: usize, pictures: &[&TimedPicture<'_>]) -> Self {
        let logs = pictures.iter().map(|p| p.time.ln()).sum::<f64>();
        let entries = pictures.iter().flat_map(|p| p.accuracy());
        let sum = entries.fold(Accuracy::none(Aspect::Color, None), |mut sum, entry| {
            sum.add(entry);
            sum
        });
        Self {
            adapter,
            time: (logs / pictures.len() as f64).exp(),
            error: (sum.channels > 0 || sum.overflow > 0).then_some(sum),
        }
    }
}

/// A timed case on an adapter.
struct TimedPicture<'a> {
    case: &'a str,
    adapter: usize,
    /// Seconds for a million units of work.
    time: f64,
    figures: &'a [Accuracy],
}

impl<'a> TimedPicture<'a> {
    /// Returns the picture of a timed case; `None` if its work was not recorded or has none of the kind's unit.
    fn new(
        bench: &Bench,
        kind: &CaseKind<'_>,
        case: &'a str,
        timed: &'a TimedCase<'_>,
    ) -> Option<Self> {
        let picture = &timed.record.picture;
        let names = bench.header.adapters.iter().map(|a| &a.info.name);
        let adapter = names
            .into_iter()
            .position(|name| *name == picture.adapter)?;
        let amount = kind.amount(picture.work.as_ref()?);
        let seconds = match kind.measure() {
            Measure::Read => timed.others.get(&Time::ReadBack)?.median,
            _ => device_time(timed, software(bench.header.adapters.get(adapter))),
        };
        let time = seconds / amount as f64 * UNITS;
        (time.is_finite() && time > 0.0).then_some(Self {
            case,
            adapter,
            time,
            figures: &picture.accuracy,
        })
    }

    /// Returns the figures of the aspects that can be inexact. A bench folder can contain any number.
    fn accuracy(&self) -> impl Iterator<Item = &'a Accuracy> + use<'a> {
        let fine = |v: f64| v.is_finite() && v >= 0.0;
        let figures = self.figures.iter();
        figures.filter(move |a| a.aspect != Aspect::Stencil && fine(a.mean) && fine(a.max))
    }
}

/// Returns the median time of a frame: between timestamps of the device if it is hardware and every round has
/// them, and otherwise until the device was done.
fn device_time(timed: &TimedCase<'_>, software: bool) -> f64 {
    let stamps = timed.others.get(&Time::Gpu);
    let stamps = stamps.filter(|gpu| !software && gpu.rounds == timed.wall.rounds);
    stamps.unwrap_or(&timed.wall).median
}

/// Returns the panels of a bench, in the order of their kinds.
fn panels<'a>(bench: &Bench, figures: &'a [CaseFigures<'a>]) -> Vec<Panel<'a>> {
    let mut pictures: BTreeMap<CaseKind<'a>, Vec<TimedPicture<'a>>> = BTreeMap::new();
    for case in figures {
        let kind = CaseKind::of(case.case);
        let timed = case.timed.iter().flatten();
        let of_case = timed.filter_map(|t| TimedPicture::new(bench, &kind, case.case, t));
        pictures.entry(kind.clone()).or_default().extend(of_case);
    }
    pictures.retain(|_, pictures| !pictures.is_empty());
    pictures
        .into_iter()
        .map(|(kind, p)| panel_of(kind, &p))
        .collect()
}

fn panel_of<'a>(kind: CaseKind<'a>, pictures: &[TimedPicture<'a>]) -> Panel<'a> {
    let mut adapters = distinct(pictures.iter().map(|p| p.adapter));
    adapters.sort_unstable();
    let cases = distinct(pictures.iter().map(|p| p.case));
    // Adapters that lack different cases are compared by the cases that all of them have.
    let is_common = |case: &&str| {
        let of_case = pictures.iter().filter(|p| p.case == *case);
        of_case.count() == adapters.len()
    };
    let common: Vec<&str> = cases.into_iter().filter(is_common).collect();
    let marks = adapters.iter().map(|adapter| {
        let own = pictures.iter().filter(|p| p.adapter == *adapter);
        let counted = own.filter(|p| common.is_empty() || common.contains(&p.case));
        AdapterMark::new(*adapter, &counted.collect::<Vec<_>>())
    });
    let mut floats = distinct(
        pictures
            .iter()
            .flat_map(TimedPicture::accuracy)
            .filter_map(|a| a.encoding)
            .map(|encoding| encoding.is_float()),
    );
    floats.sort_unstable();
    Panel {
        kind,
        marks: marks.collect(),
        cases: (!common.is_empty()).then_some(common.len()),
        unit: match floats[..] {
            [true] => "ulp",
            [false] | [] => "codes",
            _ => "codes or ulp",
        },
    }
}

/// Returns the section with the chart; `None` if no picture was timed.
pub(super) fn section(bench: &Bench, figures: &[CaseFigures<'_>]) -> Option<Markup> {
    let body = body(bench, figures)?;
    Some(html! { section id="drivers" { h2 { "Error against time" } (body) } })
}

/// Returns the section of a run with the chart of its frame times; `None` if no picture was timed.
pub(crate) fn of_run(bench: &Bench) -> Option<Markup> {
    let body = body(bench, &super::figures::figures(bench))?;
    Some(html! {
        section id="speed" {
            h2 { "Speed and accuracy of drivers" }
            (body)
            p.soft { "Intervals, percentiles and wrong pictures: " code { "timed/index.html" } " in the run's folder." }
        }
    })
}

fn body(bench: &Bench, figures: &[CaseFigures<'_>]) -> Option<Markup> {
    if figures.iter().all(|f| f.timed.iter().all(Vec::is_empty)) {
        return None;
    }
    let panels = panels(bench, figures);
    Some(html! {
        @if panels.is_empty() {
            p { "An older version recorded this bench, without the work and the errors of its pictures: there is no chart." }
        } @else {
            (legend(bench, &panels))
            div.charts { @for panel in &panels { (drawn(bench, panel)) } }
            (caption(&panels))
            details open="open" {
                summary { "The same as a table" }
                (table(bench, &panels))
                p.cap {
                    "Time for a million texels or triangles. Below: the mean error / what 99 % of the values do not exceed, to a factor of two / the largest, in "
                    "codes of fixed point or ulp of floats. Overflows, where only one of the two values is finite, are counted on their own."
                }
            }
        }
    })
}

/// Returns the scale of the errors of a panel that are above 0; `None` if all are 0.
fn errors(panel: &Panel<'_>) -> Option<Scale> {
    let means = panel.marks.iter().filter_map(AdapterMark::mean);
    let means: Vec<f64> = means.filter(|e| *e > 0.0).collect();
    // Equal errors have room for a tick below and above.
    let around = means.iter().flat_map(|e| [e / 3.0, e * 3.0]);
    (!means.is_empty()).then(|| Scale::log(around))
}

fn legend(bench: &Bench, panels: &[Panel<'_>]) -> Markup {
    let adapters = &bench.header.adapters;
    let has_mark = |index: usize| {
        let mut marks = panels.iter().flat_map(|p| &p.marks);
        marks.any(|m| m.adapter == index)
    };
    html! {
        @for (kind, title) in KINDS {
            @let of_kind = || adapters.iter().enumerate().filter(move |(_, a)| software(Some(a)) == kind);
            @if of_kind().next().is_some() {
                p.legend {
                    b.kind { (title) @if !kind { ", ringed" } }
                    @for (index, adapter) in of_kind() {
                        span.key {
                            (key(index)) " " (breakable(&adapter.info.name))
                            @if !has_mark(index) { small { " not timed" } }
                        }
                    }
                }
            }
        }
    }
}

fn caption(panels: &[Panel<'_>]) -> Markup {
    let marks = || panels.iter().flat_map(|p| &p.marks);
    html! {
        p {
            "A panel is a kind of work, a mark an adapter: the farther left the faster, the farther down the nearer to the ideal picture. A mark is the geometric mean of the "
            "times and the mean error of the cases that all adapters of the panel have. Only pictures that were judged right are timed."
        }
        p.note {
            "A time is the median of a frame, over the work that the scene asks for. Hardware is timed between its own timestamps if it has them. The error is over channel values "
            "that have an ideal, the middle of the yardstick's interval. Half a code is rounding, if the ideal is halfway between two codes."
            @if marks().all(|m| m.mean() == Some(0.0)) { " All pictures of this bench are exact." }
        }
    }
}

/// Returns the name of a unit of work.
fn unit_of(measure: Measure) -> &'static str {
    match measure {
        Measure::Triangles => "million triangles",
        Measure::Texels | Measure::Cleared | Measure::Resolved | Measure::Read => "megatexel",
    }
}

/// The heights of a panel's parts, from the top: marks without an ideal, the scale, and exact marks.
struct Parts {
    unknown: f64,
    scale: f64,
    exact: f64,
}

impl Parts {
    fn of(panel: &Panel<'_>) -> Self {
        let means = || panel.marks.iter().map(AdapterMark::mean);
        let has_scale = means().flatten().any(|e| e > 0.0);
        let has_exact = means().any(|e| e == Some(0.0));
        Self {
            unknown: if means().any(|e| e.is_none()) {
                34.0
            } else {
                0.0
            },
            scale: if has_scale { 150.0 } else { 0.0 },
            exact: match (has_exact, has_scale) {
                (true, true) => 34.0,
                // Nothing else is in the panel, so there is room for labels.
                (true, false) => 76.0,
                (false, _) => 0.0,
            },
        }
    }

    fn bottom(&self) -> f64 {
        TOP + self.unknown + self.scale + self.exact
    }

    fn y(&self, scale: Option<Scale>, mean: Option<f64>) -> f64 {
        match (mean, scale) {
            (None, _) => TOP + self.unknown / 2.0,
            (Some(mean), Some(scale)) if mean > 0.0 => {
                TOP + self.unknown + (1.0 - scale.at(mean)) * self.scale
            }
            _ => self.bottom() - self.exact / 2.0,
        }
    }
}

/// Returns the chart of one panel.
fn drawn(bench: &Bench, panel: &Panel<'_>) -> Markup {
    let scale = errors(panel);
    let parts = Parts::of(panel);
    let bottom = parts.bottom();
    let times = Scale::log(panel.marks.iter().map(|m| m.time));
    let x = |time: f64| LEFT + times.at(time) * (RIGHT - LEFT);
    let place = |m: &AdapterMark| (x(m.time), parts.y(scale, m.mean()));
    let mut labels = LabelPlaces::new(panel.marks.iter().map(place)).down_to(bottom);
    let named: Vec<(&AdapterMark, Option<(f64, f64)>)> = panel
        .marks
        .iter()
        .map(|m| (m, labels.place(name(bench, m), place(m))))
        .collect();
    let middle = f64::midpoint(TOP, bottom);
    let body = html! {
        @if parts.unknown > 0.0 {
            rect.zero x=(n(LEFT)) y=(n(TOP)) width=(n(RIGHT - LEFT)) height=(n(parts.unknown)) {}
            text.tick x=(n(LEFT - 5.0)) y=(n(TOP + parts.unknown / 2.0 + 3.5)) text-anchor="end" { "no ideal" }
        }
        @if parts.exact > 0.0 {
            rect.zero x=(n(LEFT)) y=(n(bottom - parts.exact)) width=(n(RIGHT - LEFT)) height=(n(parts.exact)) {}
            text.tick x=(n(LEFT - 5.0)) y=(n(bottom - parts.exact / 2.0 + 3.5)) text-anchor="end" { "exact" }
        }
        @for tick in times.ticks(4) { path.grid d={ "M" (n(x(tick))) " " (n(TOP)) "V" (n(bottom)) } {} }
        @for (x, label) in tick_labels(0.0, times.ticks(4).into_iter().map(|tick| (x(tick), round_duration(tick)))) {
            text.tick x=(n(x)) y=(n(bottom + 14.0)) text-anchor="middle" { (label) }
        }
        @if let (Some(scale), true) = (scale, parts.scale > 0.0) {
            @for tick in scale.ticks(4) {
                @let y = parts.y(Some(scale), Some(tick));
                path.grid d={ "M" (n(LEFT)) " " (n(y)) "H" (n(RIGHT)) } {}
                text.tick x=(n(LEFT - 5.0)) y=(n(y + 3.5)) text-anchor="end" { (digits(tick, 2)) }
            }
            text.axis transform={ "translate(13 " (n(middle)) ") rotate(-90)" } text-anchor="middle" { "← error, " (panel.unit) }
        }
        rect.box x=(n(LEFT)) y=(n(TOP)) width=(n(RIGHT - LEFT)) height=(n(bottom - TOP)) {}
        text.axis x=(n(f64::midpoint(LEFT, RIGHT))) y=(n(bottom + 32.0)) text-anchor="middle" { "← faster: time per " (unit_of(panel.kind.measure())) }
        @for (mark, label) in named.iter().rev() {
            @let (x, y) = place(mark);
            g class={ "of " (color(mark.adapter)) } {
                @if !software(bench.header.adapters.get(mark.adapter)) { circle.ring cx=(n(x)) cy=(n(y)) r="8" {} }
                (marker(mark.adapter, (x, y), false, &hover(bench, panel, mark)))
                @if let Some((x, y)) = label { text.label x=(n(*x)) y=(n(*y)) { (name(bench, mark)) } }
            }
        }
    };
    let title = plain(&panel.kind.name(), 40);
    let title = match panel.cases {
        Some(cases) => format!("{title}, {}", count(cases as u64, "case")),
        None => format!("{title}, no common case: each adapter by its own"),
    };
    let about = "A mark per adapter: its error against its time.";
    chart(bottom + 40.0, &capital(&title), about, &body)
}

fn name<'b>(bench: &'b Bench, mark: &AdapterMark) -> &'b str {
    let adapter = bench.header.adapters.get(mark.adapter);
    adapter.map_or("", |a| a.info.name.as_str())
}

fn hover(bench: &Bench, panel: &Panel<'_>, mark: &AdapterMark) -> String {
    let time = duration(mark.time);
    let unit = unit_of(panel.kind.measure());
    let error = error_text(panel, mark);
    format!("{}: {time} per {unit}; error {error}", name(bench, mark))
}

/// Returns the figures of an error: `exact`, `0.1 / 0.5 / 2 codes`, `no ideal`.
fn error_text(panel: &Panel<'_>, mark: &AdapterMark) -> String {
    let Some(error) = mark.error else {
        return "no ideal".to_owned();
    };
    let mut text = if error.max > 0.0 {
        let bound = error.percentile(SHARE);
        let bound = bound.map_or_else(|| "–".to_owned(), |b| digits(b, 3));
        let [mean, max] = [error.mean, error.max].map(|v| digits(v, 2));
        format!("{mean} / {bound} / {max} {}", panel.unit)
    } else {
        "exact".to_owned()
    };
    if error.overflow > 0 {
        text += &format!(", {}", count(error.overflow, "overflow"));
    }
    text
}

fn table(bench: &Bench, panels: &[Panel<'_>]) -> Markup {
    let mut adapters = distinct(panels.iter().flat_map(|p| &p.marks).map(|m| m.adapter));
    adapters.sort_unstable();
    let mut table =
        Table::<&Panel<'_>>::new("numbers").head("Work", |panel| plain(&panel.kind.name(), 40));
    for index in adapters {
        let named = breakable(
            bench
                .header
                .adapters
                .get(index)
                .map_or("", |a| &a.info.name),
        );
        table = table.text(named, move |panel| {
            let mark = panel.marks.iter().find(|m| m.adapter == index);
            mark.map(|m| {
                Cell::from(html! { (duration(m.time)) br; small { (error_text(panel, m)) } })
            })
        });
    }
    table.page(panels)
}
