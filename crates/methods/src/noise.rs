//! Seeded random numbers.

use etalon_frame::SplitMix64;

/// Pseudo-random numbers, the same in every run.
#[derive(Clone, Debug)]
pub(crate) struct Noise(SplitMix64);

impl Noise {
    /// The numbers of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix64(seed))
    }

    /// The next number from 0 to just below 1.
    pub(crate) fn next(&mut self) -> f64 {
        (self.0.roll() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The next number between two others.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.next() * (high - low)
    }
}
