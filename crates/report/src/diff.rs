//! Comparisons of two runs and of two benches.

pub(crate) mod benches;
pub mod runs;
