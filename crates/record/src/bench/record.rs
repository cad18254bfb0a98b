//! The part of a bench about one case on one adapter.

use super::line::{Ended, Enough, Picture, Round};
use super::time::Time;

/// The picture and the rounds of one case on one adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchRecord {
    /// Its picture with the verdict.
    pub picture: Picture,
    /// Its rounds, by number; empty where the picture may not be timed.
    pub rounds: Vec<Round>,
    /// The reason for having fewer rounds than others.
    pub ended: Option<Ended>,
    /// The reason for needing no more rounds than it has.
    pub enough: Option<Enough>,
}

impl BenchRecord {
    /// True if further rounds are due until it has all: its picture is right, and neither did they end nor are
    /// they enough.
    pub fn is_open(&self) -> bool {
        self.picture.may_be_timed() && self.ended.is_none() && self.enough.is_none()
    }

    /// The samples of one time, round by round; rounds without any are left out.
    pub fn samples(&self, time: Time) -> Vec<&[f64]> {
        let samples = self.rounds.iter().map(|r| r.samples(time));
        samples.filter(|s| !s.is_empty()).collect()
    }

    /// The ruler's time of each round that has samples of this time, as [`BenchRecord::samples`].
    pub fn rulers(&self, time: Time) -> Vec<f64> {
        let timed = |r: &&Round| !r.samples(time).is_empty();
        self.rounds
            .iter()
            .filter(timed)
            .map(Round::ruler_time)
            .collect()
    }

    /// The number of frames drawn and discarded as warm-up.
    pub fn discarded(&self) -> u64 {
        self.rounds.iter().map(|r| u64::from(r.warm_up)).sum()
    }
}
