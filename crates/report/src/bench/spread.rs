//! The spread of one adapter's frame times as a strip in a table.

use super::figures::Timed;
use crate::chart::{Scale, n};
use crate::numbers::duration;
use maud::{Markup, html};

const WIDTH: f64 = 180.0;
const HEIGHT: f64 = 22.0;

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
        Scale::log_between(self.low, self.high).at(time) * WIDTH
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
    let middle = HEIGHT / 2.0;
    html! {
        svg.strip viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } width=(WIDTH) height=(HEIGHT) role="img" {
            title {
                (timed.adapter()) ": smallest " (duration(s.min)) ", median " (duration(s.median))
                ", 95th percentile " (duration(s.p95))
            }
            @if let Some([low, high]) = s.interval {
                rect.interval x=(n(times.x(low))) y="4" width=(n(times.x(high) - times.x(low))) height=(HEIGHT - 8.0) {}
            }
            path.spread d={ "M" (n(times.x(s.min))) " " (middle) "H" (n(times.x(s.p95))) } {}
            @for round in timed.medians() {
                circle.round cx=(n(times.x(round))) cy=(middle) r="2.5" {}
            }
            path.median d={ "M" (n(times.x(s.median))) " 2V" (HEIGHT - 2.0) } {}
        }
    }
}
