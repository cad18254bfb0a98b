//! The charts of a bench: the ruler over its time, and the spread of one adapter's frame times as a strip in a table.

use super::figures::Timed;
use crate::chart::{Scale, n};
use crate::numbers::{change, duration};
use etalon_record::Bench;
use etalon_stats::quantile;
use maud::{Markup, html};

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 180.0;
const LEFT: f64 = 60.0;
const RIGHT: f64 = WIDTH - 10.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = HEIGHT - 30.0;
/// Places along the time axis at which the ruler is shown.
const PLACES: usize = 300;

/// The ruler's time over the bench, relative to its median: the middle of what was measured at each
/// place as a line, the smallest and largest as a band. Nothing without a round.
pub(super) fn drift(bench: &Bench) -> Option<Markup> {
    let rounds = bench.records.iter().flat_map(|r| &r.rounds);
    let mut points: Vec<(f64, f64)> = rounds.map(|r| (r.at, r.ruler_time())).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut times: Vec<f64> = points.iter().map(|p| p.1).collect();
    times.sort_by(f64::total_cmp);
    let median = quantile(&times, 0.5)?;
    // The scale leaves single disturbed rounds outside, so that they do not flatten the rest.
    let low = quantile(&times, 0.02)? / median;
    let high = quantile(&times, 0.98)? / median;
    let (low, high) = (low.min(0.99) - 0.005, high.max(1.01) + 0.005);
    let end = points.last()?.0.max(1e-9);
    let scale = Scale::Linear { low, high };
    let y = |ratio: f64| BOTTOM - scale.at(ratio) * (BOTTOM - TOP);
    let mut places: Vec<Vec<f64>> = vec![Vec::new(); PLACES];
    for (at, time) in &points {
        let place = (at / end * (PLACES - 1) as f64) as usize;
        if let Some(values) = places.get_mut(place.min(PLACES - 1)) {
            values.push(time / median);
        }
    }
    let (mut line, mut upper, mut lower) = (String::new(), String::new(), Vec::new());
    for (i, values) in places.iter_mut().enumerate() {
        values.sort_by(f64::total_cmp);
        let x = LEFT + (RIGHT - LEFT) * i as f64 / (PLACES - 1) as f64;
        if let (Some(middle), Some(least), Some(most)) =
            (quantile(values, 0.5), values.first(), values.last())
        {
            let pen = if line.is_empty() { 'M' } else { 'L' };
            line.push_str(&format!("{pen}{} {}", n(x), n(y(middle))));
            upper.push_str(&format!("{pen}{} {}", n(x), n(y(*most))));
            lower.push(format!("L{} {}", n(x), n(y(*least))));
        }
    }
    lower.reverse();
    let band = format!("{upper}{}Z", lower.concat());
    Some(html! {
        svg.drift viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" {
            title { "The ruler's time over the bench, relative to its median of " (duration(median)) }
            path.band d=(band) {}
            @for ratio in [low, 1.0, high] {
                path.grid d={ "M" (n(LEFT)) " " (n(y(ratio))) "H" (n(RIGHT)) } {}
                text x=(LEFT - 6.0) y=(n(y(ratio) + 4.0)) text-anchor="end" {
                    (change(ratio))
                }
            }
            path.line d=(line) {}
            text x=(LEFT) y=(HEIGHT - 8.0) { "0 s" }
            text x=(RIGHT) y=(HEIGHT - 8.0) text-anchor="end" { (format!("{end:.0} s")) }
        }
    })
}

const STRIP_WIDTH: f64 = 180.0;
const STRIP_HEIGHT: f64 = 22.0;

/// The range of times that the strips of one table share; their scale is logarithmic.
#[derive(Clone, Copy)]
pub(super) struct Times {
    low: f64,
    high: f64,
}

impl Times {
    /// From the smallest sample to the largest 95th percentile.
    pub(super) fn of(rows: &[Timed<'_>]) -> Self {
        let low = rows
            .iter()
            .map(|t| t.wall.min)
            .fold(f64::INFINITY, f64::min);
        let high = rows.iter().map(|t| t.wall.p95).fold(low, f64::max);
        // A tenth more at each end, so that equal times have a scale too.
        Self {
            low: low / 1.1,
            high: high * 1.1,
        }
    }

    fn x(self, time: f64) -> f64 {
        Scale::log_between(self.low, self.high).at(time) * STRIP_WIDTH
    }

    /// Both ends in words.
    pub(super) fn caption(self) -> String {
        format!(
            "{} to {}, logarithmic",
            duration(self.low),
            duration(self.high)
        )
    }
}

/// The spread of a row: a dot for the median of each round, a line from the smallest sample to the 95th
/// percentile, the interval as a bar, the median as a stroke.
pub(super) fn strip(timed: &Timed<'_>, times: Times) -> Markup {
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
