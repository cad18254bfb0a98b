//! Times as a fixed cost and a cost per unit of work.
//!
//! Amounts of work are timed in rounds, each amount once a round, so that drift affects all alike. Each round gives a
//! line through its times, and the medians over rounds give the costs, with intervals of order statistics as in
//! [`median_interval`].

use crate::rate::median_interval;
use crate::samples::quantile;

/// A median over rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The median.
    pub median: f64,
    /// The interval of the median over all possible rounds, with confidence
    /// [`RATE_CONFIDENCE`](crate::RATE_CONFIDENCE); `None` with fewer than 6 rounds.
    pub interval: Option<[f64; 2]>,
}

impl Estimate {
    /// Returns the median of some values; `None` for no values.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        Some(Self {
            median: quantile(&sorted, 0.5)?,
            interval: median_interval(&sorted),
        })
    }
}

/// The times of one amount of work.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedWork {
    /// The amount of work in some unit.
    pub work: f64,
    /// Its time in each round, in seconds.
    pub rounds: Vec<f64>,
}

/// A line through the times of several amounts of work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostLine {
    /// The seconds that no work takes. Noise can make them negative, and so can a cost that grows faster than the
    /// work.
    pub fixed: Estimate,
    /// The seconds of each unit of work.
    pub per_unit: Estimate,
    /// The largest distance of an amount's median time from the line, as a share of that time; `None` with two
    /// amounts, through which every line passes.
    pub deviation: Option<f64>,
}

impl CostLine {
    /// Fits the line; `None` without two different amounts of work, or without a round in which all were timed.
    ///
    /// The squares of relative differences are least: timing errors grow with the time.
    pub fn fit(times: &[TimedWork]) -> Option<Self> {
        // A mean of equal amounts is rounded, and its distance from them would look like a spread.
        if times.windows(2).all(|t| t[0].work == t[1].work) {
            return None;
        }
        let rounds = times.iter().map(|t| t.rounds.len()).min()?;
        let medians: Option<Vec<f64>> = times
            .iter()
            .map(|t| Some(Estimate::of(&t.rounds)?.median))
            .collect();
        let medians = medians?;
        let weights: Vec<f64> = medians.iter().map(|m| (m * m).recip()).collect();
        let points = |round: usize| times.iter().map(move |t| (t.work, t.rounds[round]));
        let lines: Option<Vec<(f64, f64)>> = (0..rounds)
            .map(|round| line(points(round), &weights))
            .collect();
        let (fixed, per_unit): (Vec<f64>, Vec<f64>) = lines?.into_iter().unzip();
        let (fixed, per_unit) = (Estimate::of(&fixed)?, Estimate::of(&per_unit)?);
        let deviations = times.iter().zip(&medians).map(|(timed, median)| {
            let expected = fixed.median + per_unit.median * timed.work;
            (expected / median - 1.0).abs()
        });
        Some(Self {
            fixed,
            per_unit,
            deviation: (times.len() > 2).then(|| deviations.fold(0.0, f64::max)),
        })
    }
}

/// Returns intercept and slope of the line with the least weighted squares.
fn line(points: impl Iterator<Item = (f64, f64)> + Clone, weights: &[f64]) -> Option<(f64, f64)> {
    let weighted = || points.clone().zip(weights);
    let total: f64 = weights.iter().sum();
    let mean =
        |value: fn((f64, f64)) -> f64| weighted().map(|(p, w)| value(p) * w).sum::<f64>() / total;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = weighted().map(|((a, _), w)| (a - x) * (a - x) * w).sum();
    let together: f64 = weighted().map(|((a, b), w)| (a - x) * (b - y) * w).sum();
    let slope = together / spread;
    slope.is_finite().then_some((y - slope * x, slope))
}

#[cfg(test)]
mod tests {
    use super::*;
    use oorandom::Rand64;

    fn timed(work: f64, rounds: &[f64]) -> TimedWork {
        TimedWork {
            work,
            rounds: rounds.to_vec(),
        }
    }

    /// Returns the times of some amounts of work at a fixed cost and a cost per unit, with relative noise.
    fn simulated(seed: u128, amounts: &[f64], noise: f64) -> Vec<TimedWork> {
        let mut random = Rand64::new(seed);
        amounts
            .iter()
            .map(|work| {
                let mut sample =
                    || (1e-3 + work * 2e-3) * (1.0 + noise * (random.rand_float() - 0.5));
                timed(*work, &(0..15).map(|_| sample()).collect::<Vec<_>>())
            })
            .collect()
    }

    #[test]
    fn a_line_has_its_fixed_cost_and_its_cost_per_unit() {
        let two = [timed(1.0, &[3.0, 3.2]), timed(3.0, &[7.0, 7.2])];
        let line = CostLine::fit(&two).unwrap();
        assert!((line.fixed.median - 1.1).abs() < 1e-12, "{line:?}");
        assert!((line.per_unit.median - 2.0).abs() < 1e-12, "{line:?}");
        assert_eq!((line.fixed.interval, line.deviation), (None, None));
        let crooked = [timed(1.0, &[1.0]), timed(2.0, &[4.0]), timed(3.0, &[9.0])];
        assert!(CostLine::fit(&crooked).unwrap().deviation.unwrap() > 0.1);
    }

    #[test]
    fn without_two_amounts_or_a_round_there_is_no_line() {
        for times in [
            vec![],
            vec![timed(1.0, &[1.0])],
            vec![timed(1.0, &[1.0]), timed(1.0, &[2.0])],
            vec![timed(1.0, &[1.0]), timed(2.0, &[])],
            vec![timed(1.0, &[0.0]), timed(2.0, &[0.0])],
        ] {
            assert_eq!(CostLine::fit(&times), None, "{times:?}");
        }
        // A frame of 128 by 128 texels in megatexels: its mean over some weights is another number.
        for n in 1..500 {
            let once = [timed(0.016_384, &[f64::from(n) * 1.1e-6, 1e-4])];
            assert_eq!(CostLine::fit(&once), None, "{n}");
        }
    }

    #[test]
    fn intervals_hold_the_costs_as_often_as_they_say() {
        let mut held = 0;
        for seed in 0..400 {
            let line = CostLine::fit(&simulated(seed, &[0.1, 1.0, 4.0], 0.2)).unwrap();
            let [low, high] = line.per_unit.interval.unwrap();
            held += u32::from((low..=high).contains(&2e-3));
            assert!(line.deviation.unwrap() < 0.1, "{line:?}");
        }
        // At least 95 %; fewer than 367 of 400 are a chance of one in a thousand.
        assert!(held >= 367, "{held}");
    }
}
