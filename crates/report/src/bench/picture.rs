//! Inline drawings: how times spread, and how the ruler drifted.

use super::data::Timed;
use super::{change, duration};
use etalon_record::Bench;
use maud::{Markup, html};

/// Width and height of a strip.
const STRIP: (f64, f64) = (180.0, 22.0);

/// The scale that strips of one table share, logarithmic.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    /// From the smallest sample to the largest 95th percentile.
    pub(super) fn of(rows: &[Timed<'_>]) -> Self {
        let low = rows
            .iter()
            .map(|t| t.wall.min)
            .fold(f64::INFINITY, f64::min);
        let high = rows.iter().map(|t| t.wall.p95).fold(low, f64::max);
        // A tenth more at each end, and something to divide by.
        Self {
            low: low / 1.1,
            high: high * 1.1,
        }
    }

    fn x(self, time: f64) -> f64 {
        let share = (time / self.low).ln() / (self.high / self.low).ln();
        share.clamp(0.0, 1.0) * STRIP.0
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

/// How one row's times spread: a dot per round's median, a line from the smallest sample to the 95th
/// percentile, the interval as a bar, the median as a stroke.
pub(super) fn strip(timed: &Timed<'_>, scale: Scale) -> Markup {
    let s = &timed.wall;
    let (width, height) = STRIP;
    let middle = height / 2.0;
    let spread = format!("M{:.1} {middle}H{:.1}", scale.x(s.min), scale.x(s.p95));
    let median = format!("M{:.1} 2V{:.1}", scale.x(s.median), height - 2.0);
    html! {
        svg.strip viewBox={ "0 0 " (width) " " (height) } width=(width) height=(height) role="img" {
            title {
                (timed.adapter()) ": smallest " (duration(s.min)) ", median " (duration(s.median))
                ", 95th percentile " (duration(s.p95))
            }
            @if let Some([low, high]) = s.interval {
                rect.interval x=(format!("{:.1}", scale.x(low))) y="4"
                    width=(format!("{:.1}", scale.x(high) - scale.x(low))) height=(height - 8.0) {}
            }
            path.spread d=(spread) {}
            @for round in timed.medians() {
                circle.round cx=(format!("{:.1}", scale.x(round))) cy=(middle) r="2.5" {}
            }
            path.median d=(median) {}
        }
    }
}

const CHART: (f64, f64) = (900.0, 180.0);
const LEFT: f64 = 60.0;
const BOTTOM: f64 = 30.0;
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
    let median = etalon_stats::quantile(&times, 0.5)?;
    // The scale leaves single disturbed rounds outside, so that they do not flatten the rest.
    let low = etalon_stats::quantile(&times, 0.02)? / median;
    let high = etalon_stats::quantile(&times, 0.98)? / median;
    let (low, high) = (low.min(0.99) - 0.005, high.max(1.01) + 0.005);
    let end = points.last()?.0.max(1e-9);
    let (width, height) = CHART;
    let plot = (width - LEFT - 10.0, height - BOTTOM - 10.0);
    let y = |ratio: f64| {
        let share = ((ratio - low) / (high - low)).clamp(0.0, 1.0);
        10.0 + plot.1 * (1.0 - share)
    };
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
        let x = LEFT + plot.0 * i as f64 / (PLACES - 1) as f64;
        if let (Some(middle), Some(least), Some(most)) = (
            etalon_stats::quantile(values, 0.5),
            values.first(),
            values.last(),
        ) {
            let pen = if line.is_empty() { 'M' } else { 'L' };
            line.push_str(&format!("{pen}{x:.1} {:.1}", y(middle)));
            upper.push_str(&format!("{pen}{x:.1} {:.1}", y(*most)));
            lower.push(format!("L{x:.1} {:.1}", y(*least)));
        }
    }
    lower.reverse();
    let band = format!("{upper}{}Z", lower.concat());
    Some(html! {
        svg.drift viewBox={ "0 0 " (width) " " (height) } role="img" {
            title { "The ruler's time over the bench, relative to its median of " (duration(median)) }
            path.band d=(band) {}
            @for ratio in [low, 1.0, high] {
                path.grid d=(format!("M{LEFT} {:.1}H{:.1}", y(ratio), width - 10.0)) {}
                text x=(LEFT - 6.0) y=(format!("{:.1}", y(ratio) + 4.0)) text-anchor="end" {
                    (change(ratio))
                }
            }
            path.line d=(line) {}
            text x=(LEFT) y=(height - 8.0) { "0 s" }
            text x=(width - 10.0) y=(height - 8.0) text-anchor="end" { (format!("{end:.0} s")) }
        }
    })
}
