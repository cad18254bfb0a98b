//! The charts of a bench: the ruler over time, and the spread of one adapter's frame times as a strip in a
//! table.

use super::figures::TimedCase;
use crate::chart::{HEIGHT, Plot, Scale, chart, n, polyline};
use crate::numbers::{change, duration};
use etalon_record::Bench;
use etalon_stats::quantile;
use maud::{Markup, html};

/// The number of positions along the time axis at which the ruler is shown.
const PLACES: usize = 300;

/// Returns the chart of the ruler's time over the bench, relative to its median, or `None` without a round. A
/// line joins the medians at each position; a band joins the smallest and largest times.
pub(super) fn drift(bench: &Bench) -> Option<Markup> {
    let rounds = bench.records.iter().flat_map(|r| &r.rounds);
    let mut points: Vec<(f64, f64)> = rounds.map(|r| (r.at, r.ruler_time())).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut times: Vec<f64> = points.iter().map(|p| p.1).collect();
    times.sort_by(f64::total_cmp);
    let median = quantile(&times, 0.5)?;
    // The scale excludes the outermost 2 % at each end, so that single disturbed rounds do not flatten the
    // rest.
    let low = quantile(&times, 0.02)? / median;
    let high = quantile(&times, 0.98)? / median;
    let (low, high) = (low.min(0.99) - 0.005, high.max(1.01) + 0.005);
    let end = points.last()?.0.max(1e-9);
    let plot = Plot {
        x: Scale::Linear(0.0, end),
        y: Scale::Linear(low, high),
        zero: 0.0,
    };
    let mut places: Vec<Vec<f64>> = vec![Vec::new(); PLACES];
    for (moment, time) in &points {
        let place = (moment / end * (PLACES - 1) as f64) as usize;
        if let Some(values) = places.get_mut(place.min(PLACES - 1)) {
            values.push(time / median);
        }
    }
    let (mut line, mut upper, mut lower) = (Vec::new(), Vec::new(), Vec::new());
    for (i, values) in places.iter_mut().enumerate() {
        values.sort_by(f64::total_cmp);
        let x = plot.x(end * i as f64 / (PLACES - 1) as f64);
        if let (Some(middle), Some(least), Some(most)) =
            (quantile(values, 0.5), values.first(), values.last())
        {
            line.push((x, plot.y(middle)));
            upper.push((x, plot.y(*most)));
            lower.push((x, plot.y(*least)));
        }
    }
    lower.reverse();
    upper.extend(lower);
    let body = html! {
        (plot.frame(|time| format!("{time:.0} s"), change, "time", "change of the ruler's time"))
        path.band d={ (polyline(&upper)) "Z" } {}
        path.curve.k0 d=(polyline(&line)) {}
    };
    let about = format!("Relative to its median of {}.", duration(median));
    let title = format!("The ruler's time over the {end:.0} s of the bench");
    Some(chart(HEIGHT, &title, &about, &body))
}

const STRIP_WIDTH: f64 = 180.0;
const STRIP_HEIGHT: f64 = 22.0;

/// The range of times that all strips of a table share, on a logarithmic scale.
#[derive(Clone, Copy)]
pub(super) struct TimeRange {
    low: f64,
    high: f64,
}

impl TimeRange {
    /// Returns the range from the smallest sample to the largest 95th percentile.
    pub(super) fn of(rows: &[TimedCase<'_>]) -> Self {
        let low = rows
            .iter()
            .map(|t| t.wall.min)
            .fold(f64::INFINITY, f64::min);
        let high = rows.iter().map(|t| t.wall.p95).fold(low, f64::max);
        // Widens the range by a tenth at each end, so that it is not empty if all times are equal.
        Self {
            low: low / 1.1,
            high: high * 1.1,
        }
    }

    fn x(self, time: f64) -> f64 {
        Scale::log_between(self.low, self.high).at(time) * STRIP_WIDTH
    }

    /// Returns a text for both ends of the range.
    pub(super) fn caption(self) -> String {
        format!(
            "{} to {}, logarithmic",
            duration(self.low),
            duration(self.high)
        )
    }
}

/// Returns the spread of a row: a dot for the median of each round, a line from the smallest sample to the
/// 95th percentile, a bar for the interval and a stroke for the median.
pub(super) fn strip(timed: &TimedCase<'_>, times: TimeRange) -> Markup {
    let s = &timed.wall;
    let middle = STRIP_HEIGHT / 2.0;
    html! {
        svg.strip viewBox={ "0 0 " (STRIP_WIDTH) " " (STRIP_HEIGHT) } width=(STRIP_WIDTH) height=(STRIP_HEIGHT) role="img" {
            title {
                (timed.adapter()) ": smallest " (duration(s.min)) ", median " (duration(s.median))
                ", 95th percentile " (duration(s.p95))
            }
            @if let Some([low, high]) = s.interval {
                rect.interval x=(n(times.x(low))) y="4" width=(n(times.x(high) - times.x(low))) height=(STRIP_HEIGHT - 8.0) {}
            }
            path.spread d={ "M" (n(times.x(s.min))) " " (middle) "H" (n(times.x(s.p95))) } {}
            @for round in timed.medians() {
                circle.round cx=(n(times.x(round))) cy=(middle) r="2.5" {}
            }
            path.median d={ "M" (n(times.x(s.median))) " 2V" (STRIP_HEIGHT - 2.0) } {}
        }
    }
}
