//! Frame times, by rounds.

use thiserror::Error;

/// Frame times of one case on one adapter, round by round, and the ruler's time around each round if there is
/// one. The ruler is fixed work whose time shows how fast the machine was.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    rounds: Vec<Vec<f64>>,
    /// Logarithm of each round's median.
    logs: Vec<f64>,
    /// For each round, the logarithm of the median minus the logarithm of the ruler's time.
    ruled: Option<Vec<f64>>,
}

/// The reason why times are not valid samples.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SampleError {
    /// There is no round.
    #[error("no round was measured")]
    None,
    /// A round has no sample.
    #[error("round {0} has no sample")]
    Empty(usize),
    /// A time is not above zero.
    #[error("round {round} has a time of {time} s")]
    Time {
        /// The round, from 0.
        round: usize,
        /// The time.
        time: f64,
    },
    /// The number of ruler times differs from the number of rounds.
    #[error("{rulers} ruler times for {rounds} rounds")]
    Rulers {
        /// Ruler times.
        rulers: usize,
        /// Rounds.
        rounds: usize,
    },
}

impl Samples {
    /// Returns samples of the given rounds, in seconds or any other unit.
    ///
    /// # Errors
    /// If there is no round, a round is empty, or a time is not finite and above zero.
    pub fn new<R: AsRef<[f64]>>(rounds: &[R]) -> Result<Self, SampleError> {
        if rounds.is_empty() {
            return Err(SampleError::None);
        }
        let mut samples = Vec::with_capacity(rounds.len());
        let mut logs = Vec::with_capacity(rounds.len());
        for (round, times) in rounds.iter().enumerate() {
            let mut times = times.as_ref().to_vec();
            check(round, &times)?;
            times.sort_unstable_by(f64::total_cmp);
            let median = quantile(&times, 0.5).ok_or(SampleError::Empty(round))?;
            logs.push(median.ln());
            samples.push(times);
        }
        Ok(Self {
            rounds: samples,
            logs,
            ruled: None,
        })
    }

    /// Returns the same samples with the ruler's time of each round.
    ///
    /// # Errors
    /// If the number of times differs from the number of rounds, or a time is not finite and above zero.
    pub fn with_ruler(mut self, rulers: &[f64]) -> Result<Self, SampleError> {
        if rulers.len() != self.rounds.len() {
            return Err(SampleError::Rulers {
                rulers: rulers.len(),
                rounds: self.rounds.len(),
            });
        }
        for (round, ruler) in rulers.iter().enumerate() {
            check(round, &[*ruler])?;
        }
        let ruled = self.logs.iter().zip(rulers).map(|(t, r)| t - r.ln());
        self.ruled = Some(ruled.collect());
        Ok(self)
    }

    /// Returns the number of rounds; at least one.
    pub fn rounds(&self) -> usize {
        self.rounds.len()
    }

    /// Returns the median of each round.
    pub fn medians(&self) -> Vec<f64> {
        self.logs.iter().map(|t| t.exp()).collect()
    }

    /// Returns all times, ascending.
    pub(crate) fn sorted(&self) -> Vec<f64> {
        let mut samples: Vec<f64> = self.rounds.iter().flatten().copied().collect();
        samples.sort_unstable_by(f64::total_cmp);
        samples
    }

    /// Returns the logarithms of the rounds' medians.
    pub(crate) fn logs(&self) -> &[f64] {
        &self.logs
    }

    /// Returns the logarithms of the ruler's times; empty without a ruler.
    pub(crate) fn rulers(&self) -> Vec<f64> {
        let ruled = self.ruled.iter().flatten();
        self.logs.iter().zip(ruled).map(|(t, r)| t - r).collect()
    }

    /// Returns the logarithms of the rounds' medians in units of the ruler.
    pub(crate) fn ruled(&self) -> Option<&[f64]> {
        self.ruled.as_deref()
    }
}

fn check(round: usize, times: &[f64]) -> Result<(), SampleError> {
    if times.is_empty() {
        return Err(SampleError::Empty(round));
    }
    match times.iter().find(|t| !(t.is_finite() && **t > 0.0)) {
        Some(time) => Err(SampleError::Time { round, time: *time }),
        None => Ok(()),
    }
}

/// Returns the quantile `q`, 0 to 1, of ascending values, interpolated between the two nearest (the seventh
/// definition of Hyndman and Fan 1996); `None` if there are no values.
pub fn quantile(sorted: &[f64], q: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = q.clamp(0.0, 1.0) * last as f64;
    let low = *sorted.get(place.floor() as usize)?;
    let high = *sorted.get((place.ceil() as usize).min(last))?;
    Some(low + (high - low) * place.fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_between_the_nearest_values() {
        let values = [1.0, 2.0, 4.0, 8.0];
        assert_eq!(quantile(&values, 0.0), Some(1.0));
        assert_eq!(quantile(&values, 0.5), Some(3.0));
        assert_eq!(quantile(&values, 1.0), Some(8.0));
        assert_eq!(quantile(&values, 0.9), Some(4.0 + 4.0 * (0.9 * 3.0 - 2.0)));
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn an_invalid_time_is_refused() {
        let none: [&[f64]; 0] = [];
        assert_eq!(Samples::new(&none), Err(SampleError::None));
        assert_eq!(
            Samples::new(&[vec![1.0], vec![]]),
            Err(SampleError::Empty(1))
        );
        for time in [0.0, -1.0, f64::INFINITY] {
            let wrong = Samples::new(&[[1.0, time]]);
            assert_eq!(wrong, Err(SampleError::Time { round: 0, time }));
        }
        assert!(Samples::new(&[[f64::NAN]]).is_err());
        let fine = Samples::new(&[[1.0]]).unwrap();
        assert!(fine.clone().with_ruler(&[]).is_err());
        assert!(fine.clone().with_ruler(&[0.0]).is_err());
        assert!(fine.with_ruler(&[2.0]).is_ok());
    }
}
