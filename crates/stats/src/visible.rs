//! The smallest difference that a comparison could have seen.

use crate::compare::{LEVEL, MINIMUM};
use crate::rank::{lower_bound, rank_of_bound};
use crate::samples::{Samples, quantile};
use oorandom::Rand64;

/// The probability with which a change of [`smallest_visible`]'s size is found.
pub const POWER: f64 = 0.9;

const RESAMPLES: usize = 400;
const SEED: u128 = 0x0076_6973_6962_6c65;

/// Returns the smallest change, as a ratio above 1, that [`crate::compare()`] would find with probability
/// [`POWER`] between two benches with the noise and the number of rounds of these. Returns `None` if there
/// are too few rounds to find any change.
///
/// The rounds of each bench, minus their own median, are drawn with replacement. A planted change moves the
/// interval as a whole, so each drawing shows how large a change would have had to be, and the result is the
/// quantile [`POWER`] of these sizes. Drawing from a few rounds understates their spread, so residuals are
/// stretched; see `stretch`.
pub fn smallest_visible(before: &Samples, after: &Samples) -> Option<f64> {
    let rank = rank_of_bound(before.rounds(), after.rounds(), LEVEL);
    if rank == 0 {
        return None;
    }
    let before = Residuals::new(before);
    let after = Residuals::new(after);
    let mut random = Rand64::new(SEED);
    let (mut b, mut a) = (Resampled::default(), Resampled::default());
    let mut room = Vec::new();
    let mut needed = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        before.draw(&mut random, &mut b);
        after.draw(&mut random, &mut a);
        let mut low = lower_bound(&b.raw, &a.raw, rank, &mut room);
        if !b.ruled.is_empty() && !a.ruled.is_empty() {
            low = low.min(lower_bound(&b.ruled, &a.ruled, rank, &mut room));
        }
        needed.push(MINIMUM.ln() - low);
    }
    needed.sort_unstable_by(f64::total_cmp);
    quantile(&needed, POWER).map(f64::exp)
}

/// Rounds minus their median, in logarithms: as measured and in units of the ruler.
struct Residuals {
    raw: Vec<f64>,
    ruled: Vec<f64>,
}

/// Drawn residuals; the two of a round stay together.
#[derive(Default)]
struct Resampled {
    raw: Vec<f64>,
    ruled: Vec<f64>,
}

impl Residuals {
    fn new(samples: &Samples) -> Self {
        Self {
            raw: residuals(samples.logs()),
            ruled: residuals(samples.ruled().unwrap_or_default()),
        }
    }

    fn draw(&self, random: &mut Rand64, into: &mut Resampled) {
        into.raw.clear();
        into.ruled.clear();
        for _ in 0..self.raw.len() {
            let index = random.rand_range(0..self.raw.len() as u64) as usize;
            into.raw.push(self.raw[index]);
            into.ruled.extend(self.ruled.get(index));
        }
    }
}

fn residuals(logs: &[f64]) -> Vec<f64> {
    let mut sorted = logs.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = quantile(&sorted, 0.5).unwrap_or(0.0);
    let stretch = stretch(logs.len());
    logs.iter().map(|v| (v - middle) * stretch).collect()
}

/// Returns the factor by which residuals of a few rounds are stretched. The deviation of values drawn with
/// replacement is smaller by sqrt((n - 1) / n) than that of their rounds, and the rounds' own deviation is
/// known only to about one part in sqrt(2 (n - 1)); the factor adds that much to be safe.
fn stretch(rounds: usize) -> f64 {
    let n = rounds.max(2) as f64;
    (n / (n - 1.0)).sqrt() * (1.0 + 1.0 / (2.0 * (n - 1.0)).sqrt())
}
