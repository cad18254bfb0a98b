//! Change points of one series of times over runs.
//!
//! E-divisive means with Student's test in place of permutations, as in Hunter (Fleming et al. 2023), so that
//! the same series always gives the same changes. In addition, outliers have no weight, a slow drift is
//! distinguished from a staircase, the level accounts for the choice of the place and for correlated
//! neighbours, and the ruler distinguishes the machine's steps from others.

mod analysis;
mod change;
mod clean;
mod divergence;
mod point;
mod segmentation;
mod stretch;

pub use analysis::{Changes, change_points};
pub use change::{Cause, ChangePoint, Drift};
pub use point::{PointError, TimedRun};
pub use stretch::{MIN_RUNS, STEP};
