//! Tests on simulated and recorded samples.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod nightly;
mod recorded;
mod series;
mod simulated;

use etalon_stats::{Conclusion, LEVEL};

fn is_different(outcome: Conclusion) -> bool {
    matches!(outcome, Conclusion::Faster | Conclusion::Slower)
}

/// Returns the count that `trials` events of a probability exceed only once in a million times.
fn most(trials: u32, probability: f64) -> u32 {
    let (n, p) = (f64::from(trials), probability);
    let mut mass = (n * (1.0 - p).ln()).exp();
    let mut above = 1.0 - mass;
    let mut count = 0_u32;
    while above > 1e-6 {
        count += 1;
        mass *= (n - f64::from(count) + 1.0) / f64::from(count) * p / (1.0 - p);
        above -= mass;
    }
    count
}

#[test]
fn the_bound_on_counts_is_binomial() {
    // Poisson's distribution with a mean of 20 has 0.999999 of its mass up to 45 or so.
    let bound = most(20_000, LEVEL);
    assert!((43..=47).contains(&bound), "{bound}");
    assert_eq!(most(1, 0.5), 1);
}
