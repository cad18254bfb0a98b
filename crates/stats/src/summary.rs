//! Summaries of one bench.

use crate::rank::MIN_ROUNDS;
use crate::samples::{Samples, quantile};
use crate::visible::smallest_visible;
use oorandom::Rand64;

/// The confidence of [`Summary::interval`].
pub const CONFIDENCE: f64 = 0.99;

const RESAMPLES: usize = 2000;
/// An arbitrary constant, so that the same samples always give the same interval.
const SEED: u128 = 0x6574_616c_6f6e;

/// The summary of one bench of a case on an adapter. Times are in the unit of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// The number of rounds, each with at least one sample.
    pub rounds: usize,
    /// The number of samples in all rounds.
    pub samples: usize,
    /// The median of the rounds' medians, which comparisons use.
    pub median: f64,
    /// Its bootstrap interval with a confidence of [`CONFIDENCE`]: rounds are drawn with replacement, and the
    /// percentiles of their medians are taken. `None` below [`MIN_ROUNDS`], where not even the whole range of
    /// the rounds has that confidence.
    pub interval: Option<[f64; 2]>,
    /// The median of all samples.
    pub p50: f64,
    /// The 95th percentile of all samples.
    pub p95: f64,
    /// The smallest sample.
    pub min: f64,
    /// The smallest change, as a ratio above 1, that a comparison with another bench like this one would
    /// find; see [`smallest_visible`].
    pub visible: Option<f64>,
}

/// Describes one bench.
pub fn summarize(samples: &Samples) -> Summary {
    let sorted = samples.sorted();
    let mut medians = samples.medians();
    medians.sort_unstable_by(f64::total_cmp);
    // Samples have at least one round with at least one time.
    let quantile_of = |values: &[f64], q: f64| quantile(values, q).unwrap_or(f64::NAN);
    Summary {
        rounds: samples.rounds(),
        samples: sorted.len(),
        median: quantile_of(&medians, 0.5),
        interval: interval(&medians),
        p50: quantile_of(&sorted, 0.5),
        p95: quantile_of(&sorted, 0.95),
        min: quantile_of(&sorted, 0.0),
        visible: smallest_visible(samples, samples),
    }
}

fn interval(medians: &[f64]) -> Option<[f64; 2]> {
    if medians.len() < MIN_ROUNDS {
        return None;
    }
    let mut random = Rand64::new(SEED);
    let mut drawn = vec![0.0; medians.len()];
    let mut found = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        for value in &mut drawn {
            *value = medians[random.rand_range(0..medians.len() as u64) as usize];
        }
        drawn.sort_unstable_by(f64::total_cmp);
        found.push(quantile(&drawn, 0.5)?);
    }
    found.sort_unstable_by(f64::total_cmp);
    let tail = (1.0 - CONFIDENCE) / 2.0;
    Some([quantile(&found, tail)?, quantile(&found, 1.0 - tail)?])
}
