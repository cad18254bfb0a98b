//! Rates of work, from the times of two amounts of it.
//!
//! The time of a frame includes the cost of beginning and ending it. Two amounts of the same work share that
//! cost, so the difference of their times is the time of the work between them: the slope. Each round gives
//! one slope, and the median of the slopes gives the rate, with an interval of order statistics, which
//! assumes nothing about the shape of the noise (David and Nagaraja, Order Statistics, 7.1).

use crate::samples::quantile;

/// The minimum confidence of [`Slope::interval`] and [`median_interval`].
pub const RATE_CONFIDENCE: f64 = 0.95;

/// The times of two amounts of work in one round, in seconds.
#[derive(Clone, Copy, Debug)]
pub struct WorkTimes<'a> {
    /// The times of the smaller amount of work, in seconds.
    pub less: &'a [f64],
    /// The times of the larger amount of work, in seconds.
    pub more: &'a [f64],
}

/// The time of one unit of work, and its inverse.
#[derive(Clone, Debug, PartialEq)]
pub struct Slope {
    /// The seconds for one unit in each round, in order. Noise can make them 0 or negative.
    pub rounds: Vec<f64>,
    /// The median of `rounds`, in seconds for one unit.
    pub median: f64,
    /// The interval of the median over all possible rounds, with confidence [`RATE_CONFIDENCE`]; `None` with
    /// fewer than 6 rounds, whose whole range is not that certain.
    pub interval: Option<[f64; 2]>,
    /// True if the work between the two amounts takes less time than single times scatter, or possibly none.
    pub below_resolution: bool,
}

impl Slope {
    /// Computes the slope over rounds; `None` if there is no round, an empty round, or no work.
    pub fn new(rounds: &[WorkTimes<'_>], work: u64) -> Option<Self> {
        if work == 0 {
            return None;
        }
        let mut differences = Vec::with_capacity(rounds.len());
        let mut scatters = Vec::with_capacity(rounds.len());
        for pair in rounds {
            let (less, more) = (sorted(pair.less), sorted(pair.more));
            differences.push(quantile(&more, 0.5)? - quantile(&less, 0.5)?);
            scatters.push((between_quartiles(&less)? + between_quartiles(&more)?) / 2.0);
        }
        let scatter = quantile(&sorted(&scatters), 0.5)?;
        let ordered = sorted(&differences);
        let median = quantile(&ordered, 0.5)?;
        let interval = median_interval(&ordered);
        let least = interval.map_or(ordered.first().copied()?, |[low, _]| low);
        let unit = |time: f64| time / work as f64;
        Some(Self {
            rounds: differences.into_iter().map(unit).collect(),
            median: unit(median),
            interval: interval.map(|both| both.map(unit)),
            below_resolution: least <= 0.0 || median <= scatter,
        })
    }

    /// Returns the units of work per second; `None` below the resolution.
    pub fn rate(&self) -> Option<f64> {
        (!self.below_resolution).then(|| 1.0 / self.median)
    }

    /// Returns the interval of [`Slope::rate`].
    pub fn rate_interval(&self) -> Option<[f64; 2]> {
        let [low, high] = self.interval.filter(|_| !self.below_resolution)?;
        Some([1.0 / high, 1.0 / low])
    }

    /// Returns true if the interval of the rate is within a given fraction of the rate.
    pub fn is_within(&self, share: f64) -> bool {
        match (self.rate(), self.rate_interval()) {
            (Some(rate), Some(interval)) => is_within(rate, interval, share),
            _ => false,
        }
    }
}

/// Returns true if an interval is within a share of its middle.
pub fn is_within(middle: f64, interval: [f64; 2], share: f64) -> bool {
    interval
        .into_iter()
        .all(|end| (end / middle - 1.0).abs() <= share)
}

/// Returns the interval between two of some ascending values that contains the median of their distribution
/// with a confidence of at least [`RATE_CONFIDENCE`]; `None` with fewer than 6 values.
pub fn median_interval(sorted: &[f64]) -> Option<[f64; 2]> {
    let n = sorted.len();
    // The number of values below the median is binomial. The largest number of values that can be left out at
    // each end is the largest k with P(X < k) <= (1 - confidence) / 2.
    let tail = (1.0 - RATE_CONFIDENCE) / 2.0;
    let mut logarithm = -(n as f64) * std::f64::consts::LN_2;
    let mut below = 0.0;
    let mut outside = 0;
    for k in 0..n {
        below += logarithm.exp();
        if below > tail {
            break;
        }
        outside = k + 1;
        logarithm += ((n - k) as f64 / (k + 1) as f64).ln();
    }
    let low = sorted.get(outside.checked_sub(1)?)?;
    let high = sorted.get(n - outside)?;
    Some([*low, *high])
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted
}

fn between_quartiles(sorted: &[f64]) -> Option<f64> {
    Some(quantile(sorted, 0.75)? - quantile(sorted, 0.25)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use oorandom::Rand64;

    /// Returns the slope of simulated rounds. A frame takes a fixed time, `unit` seconds for each unit of work,
    /// and noise of the size `noise`.
    fn planted(seed: u128, rounds: usize, unit: f64, noise: f64) -> Slope {
        let mut random = Rand64::new(seed);
        let mut frames = |work: f64| -> Vec<f64> {
            let mut sample = || 2e-3 + work * unit + noise * (random.rand_float() - 0.3);
            (0..9).map(|_| sample()).collect()
        };
        let times: Vec<[Vec<f64>; 2]> = (0..rounds).map(|_| [frames(4e6), frames(12e6)]).collect();
        let pairs: Vec<WorkTimes<'_>> = times
            .iter()
            .map(|[less, more]| WorkTimes { less, more })
            .collect();
        Slope::new(&pairs, 8_000_000).unwrap()
    }

    #[test]
    fn costs_of_a_frame_that_do_not_depend_on_work_cancel() {
        let slope = planted(1, 9, 1e-9, 1e-5);
        let rate = slope.rate().unwrap();
        assert!((rate / 1e9 - 1.0).abs() < 0.01, "{rate}");
        let [low, high] = slope.rate_interval().unwrap();
        assert!(low <= rate && rate <= high && low < high);
        assert!(slope.is_within(0.03));
        assert!(!slope.is_within(1e-6));
        assert_eq!(slope.rounds.len(), 9);
    }

    #[test]
    fn intervals_hold_the_planted_rate_as_often_as_they_promise() {
        let holds = |seed: u128| {
            let interval = planted(seed, 9, 1e-9, 2e-3).interval.unwrap();
            interval[0] <= 1e-9 && 1e-9 <= interval[1]
        };
        let held = (0..1000).filter(|seed| holds(*seed)).count();
        assert!(held >= 940, "{held}");
    }

    #[test]
    fn work_that_takes_no_time_is_below_the_resolution() {
        for seed in 0..200 {
            let none = planted(seed, 7, 0.0, 1e-5);
            assert!(none.below_resolution, "{none:?}");
            assert_eq!((none.rate(), none.rate_interval()), (None, None));
            assert!(!none.is_within(1.0));
        }
        // Above zero in every round, but smaller than the scatter of frames.
        let little = planted(1, 40, 2e-13, 1e-5);
        assert!(little.median > 0.0 && little.below_resolution);
    }

    #[test]
    fn intervals_of_medians_are_those_of_published_tables() {
        // Ranks of the ends at 95 % for these numbers of values (Conover, Practical Nonparametric Statistics,
        // table A3 inverted): 6 to 8 give the first and the last, 9 to 11 the second, 12 to 14 the third.
        for (n, rank) in [
            (6, 1),
            (8, 1),
            (9, 2),
            (11, 2),
            (12, 3),
            (14, 3),
            (15, 4),
            (20, 6),
            (25, 8),
        ] {
            let values: Vec<f64> = (1..=n).map(f64::from).collect();
            let expected = [f64::from(rank), f64::from(n + 1 - rank)];
            assert_eq!(median_interval(&values), Some(expected), "{n}");
        }
        for n in 0..6 {
            assert_eq!(median_interval(&vec![1.0; n]), None);
        }
        let many: Vec<f64> = (0..10_000).map(f64::from).collect();
        let [low, high] = median_interval(&many).unwrap();
        assert!((4899.0..4905.0).contains(&low), "{low}");
        assert_eq!(low + high, 9999.0);
    }

    #[test]
    fn without_samples_or_work_there_is_no_slope() {
        let single = [1.0];
        let pair = WorkTimes {
            less: &single,
            more: &single,
        };
        assert_eq!(Slope::new(&[], 1), None);
        assert_eq!(Slope::new(&[pair], 0), None);
        assert_eq!(
            Slope::new(
                &[WorkTimes {
                    less: &[],
                    more: &single
                }],
                1
            ),
            None
        );
        let same = Slope::new(&[pair], 1).unwrap();
        assert!(same.below_resolution && same.interval.is_none());
    }
}
