//! Seeded random numbers.

use etalon_frame::SplitMix64;

/// Pseudo-random numbers, the same in every run.
#[derive(Clone, Debug)]
pub(crate) struct Noise(SplitMix64);

impl Noise {
    /// Creates the generator with a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix64(seed))
    }

    /// Returns the next number, at least 0 and below 1.
    pub(crate) fn next(&mut self) -> f64 {
        (self.0.roll() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns the next number between two bounds.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.next() * (high - low)
    }
}
