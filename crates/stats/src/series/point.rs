//! Points of a series, one per run.

use crate::samples::{Samples, quantile};
use crate::summary::summarize;
use thiserror::Error;

/// One run's time of one case on one adapter and machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedRun {
    /// The median of the run's rounds, in seconds or any other unit.
    pub median: f64,
    /// The interval of the time with a confidence of [`crate::CONFIDENCE`], if there were enough rounds.
    pub interval: Option<[f64; 2]>,
    /// The median of the ruler's times in that run. The ruler is fixed work that is timed along with the
    /// frames.
    pub ruler: Option<f64>,
}

impl From<&Samples> for TimedRun {
    fn from(samples: &Samples) -> Self {
        let summary = summarize(samples);
        let mut rulers = samples.rulers();
        rulers.sort_unstable_by(f64::total_cmp);
        Self {
            median: summary.median,
            interval: summary.interval,
            ruler: quantile(&rulers, 0.5).map(f64::exp),
        }
    }
}

/// The reason why points are not a valid series.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum PointError {
    /// A time is not above zero.
    #[error("run {index} of the series has a time of {time} s")]
    Time {
        /// The point, from 0.
        index: usize,
        /// The time.
        time: f64,
    },
    /// An interval does not contain its median.
    #[error(
        "run {index} of the series has an interval from {low} to {high} s, which does not contain its median"
    )]
    Interval {
        /// The point, from 0.
        index: usize,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
}

/// Checks all points.
pub(super) fn check(points: &[TimedRun]) -> Result<(), PointError> {
    let is_time = |t: &f64| t.is_finite() && *t > 0.0;
    for (index, point) in points.iter().enumerate() {
        let [low, high] = point.interval.unwrap_or([point.median; 2]);
        for time in [Some(point.median), Some(low), Some(high), point.ruler] {
            if let Some(time) = time.filter(|t| !is_time(t)) {
                return Err(PointError::Time { index, time });
            }
        }
        if !(low <= point.median && point.median <= high) {
            return Err(PointError::Interval { index, low, high });
        }
    }
    Ok(())
}
