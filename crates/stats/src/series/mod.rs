//! Change points of one series of times over runs.
//!
//! E-divisive means with Student's test in place of permutations, as in Hunter (Fleming et al. 2023), so
//! that the same series gives the same changes. Beyond it: single runs that stand out have no weight, a
//! slow drift is told from a staircase, the level allows for the choice of the place and for neighbours
//! that resemble each other, and the ruler tells the machine's steps from the others.

mod analysis;
mod change;
mod clean;
mod divergence;
mod point;
mod segmentation;
mod stretch;

pub use analysis::{Changes, change_points};
pub use change::{Cause, ChangePoint, Drift};
pub use point::{Point, PointError};
pub use stretch::{MIN_RUNS, STEP};
