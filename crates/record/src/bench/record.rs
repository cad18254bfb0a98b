//! The part of a bench about one case on one adapter.

use super::counted::CountedInstructions;
use super::line::{Ended, Enough, Picture, Round};
use super::time::Time;

/// The picture and the rounds of one case on one adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchRecord {
    /// The case's picture on the adapter, with the verdict.
    pub picture: Picture,
    /// The instructions of a frame, if they were counted.
    pub counted: Option<CountedInstructions>,
    /// The rounds, by number; empty if the picture may not be timed.
    pub rounds: Vec<Round>,
    /// The error that ended the case's rounds before those of others, if any.
    pub ended: Option<Ended>,
    /// The reason why the case needs no more rounds, if there is one.
    pub enough: Option<Enough>,
}

impl BenchRecord {
    /// Returns true if the case needs further rounds: its picture is right, and its rounds have not ended.
    pub fn is_open(&self) -> bool {
        self.picture.may_be_timed() && self.ended.is_none() && self.enough.is_none()
    }

    /// Returns the samples of one kind of time, round by round. Rounds without such samples are skipped.
    pub fn samples(&self, time: Time) -> Vec<&[f64]> {
        let samples = self.rounds.iter().map(|r| r.samples(time));
        samples.filter(|s| !s.is_empty()).collect()
    }

    /// Returns the ruler's time of each round that has samples of this time, in the order of
    /// [`BenchRecord::samples`].
    pub fn rulers(&self, time: Time) -> Vec<f64> {
        let timed = |r: &&Round| !r.samples(time).is_empty();
        self.rounds
            .iter()
            .filter(timed)
            .map(Round::ruler_time)
            .collect()
    }

    /// Returns the number of frames drawn and discarded as warm-up.
    pub fn discarded(&self) -> u64 {
        self.rounds.iter().map(|r| u64::from(r.warm_up)).sum()
    }
}
