//! Statistics of frame times: medians with intervals, and comparisons of two benches.
//!
//! Consecutive frames are not independent samples: they share the state of the machine, the addresses that
//! the process got, and the clock that the processor chose. The unit of everything here is therefore the
//! **round**, one fresh preparation with a few frames, represented by its median. More frames make a round's
//! median steadier; only more rounds say more about the next bench.
//!
//! [`summarize`] describes one bench. [`compare()`] compares two, with the interval that inverts the
//! Wilcoxon–Mann–Whitney test (Hodges and Lehmann 1963): it assumes nothing about the shape of the noise, its
//! level is exact for any number of rounds, and single disturbed rounds hardly move it. [`smallest_visible`]
//! returns the change that this comparison would find. [`Slope`] is the rate of work, from the times of two
//! amounts of it.
//!
//! Over many benches, [`change_points`] finds when the times of a case changed, and [`happenings`] when its
//! verdict did.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod compare;
mod cost;
mod rank;
mod rate;
mod samples;
mod series;
mod student;
mod summary;
mod verdicts;
mod visible;

pub use compare::{BEYOND_RULER, BenchComparison, Conclusion, LEVEL, MINIMUM, Ratio, Why, compare};
pub use cost::{CostLine, Estimate, TimedWork};
pub use rank::MIN_ROUNDS;
pub use rate::{RATE_CONFIDENCE, Slope, WorkTimes, is_within, median_interval};
pub use samples::{SampleError, Samples, quantile};
pub use series::{
    Cause, ChangePoint, Changes, Drift, MIN_RUNS, PointError, STEP, TimedRun, change_points,
};
pub use summary::{CONFIDENCE, Summary, summarize};
pub use verdicts::{Happening, RunScore, Score, Standing, VerdictEvent, happenings, scores};
pub use visible::{POWER, smallest_visible};
