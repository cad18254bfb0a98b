//! A round of frame times of a case on one worker.

use crate::drawing::wrong_answer;
use crate::loss::RequestError;
use crate::process::WorkerProcess;
use crate::protocol::{Payload, Request};
use etalon_backend::FrameTime;
use etalon_frame::Frame;
use etalon_scene::Scene;
use std::borrow::Cow;
use std::hash::{DefaultHasher, Hasher};
use std::time::{Duration, Instant};

/// The slot in which a round's scene is prepared. Scenes are prepared one at a time, so that big frames do
/// not add up.
pub(super) const SLOT: u32 = 0;
/// Frames in each of the two stretches that are compared to detect the end of the warm-up.
const STRETCH: usize = 5;
/// The largest relative difference of the medians of the two stretches after the warm-up.
const STEADY: f64 = 0.05;
/// The maximum number of frames of a warm-up.
const MOST_WARM_UP: usize = 60;
/// The minimum and the maximum number of timed frames of a round. More rounds give more information than more
/// frames per round.
const FRAMES: [u32; 2] = [3, 25];
/// The maximum number of times that reading a frame back is timed in a round.
const MOST_READ_BACKS: usize = 3;

/// The measurements of one round.
pub(crate) struct RoundTimes {
    pub(crate) prepare: f64,
    pub(crate) first: f64,
    pub(crate) warm_up: u32,
    pub(crate) frames: Vec<FrameTime>,
    pub(crate) read_back: Vec<f64>,
    /// The fingerprint of the picture after the round.
    pub(crate) picture: u64,
}

impl WorkerProcess {
    /// Prepares a scene, warms up, times frames for about `budget`, and reads back. `timeout` limits each
    /// answer.
    ///
    /// The warm-up ends when the median of the last five frames is within 5 % of the median of the five
    /// before, after 60 frames, or when it has taken as long as the timed frames are allowed to take. Drivers
    /// compile at the first frame, and some compile again at the second, so two frames are never timed.
    pub(crate) fn round(
        &mut self,
        scene: &Scene,
        budget: Duration,
        timeout: Duration,
    ) -> Result<RoundTimes, RequestError> {
        let request = Request::Prepare {
            slot: SLOT,
            scene: Cow::Borrowed(scene),
        };
        let (_, prepare) = self.ask(request, timeout)?;
        let outcome = self.prepared_round(prepare, budget, timeout);
        if !matches!(outcome, Err(RequestError::Lost(_))) {
            self.ask(Request::Drop { slot: SLOT }, timeout)?;
        }
        outcome
    }

    fn prepared_round(
        &mut self,
        prepare: Duration,
        budget: Duration,
        timeout: Duration,
    ) -> Result<RoundTimes, RequestError> {
        let warming = Instant::now();
        let mut warm: Vec<Duration> = Vec::new();
        while warm.len() < MOST_WARM_UP && !steady(&warm) {
            let number = if warm.len() < 2 { 1 } else { 2 };
            warm.extend(self.submit(SLOT, number, timeout)?.iter().map(|t| t.wall));
            if warm.len() >= 2 && warming.elapsed() > budget {
                break;
            }
        }
        let recent = median(warm.get(warm.len().saturating_sub(3)..).unwrap_or_default());
        let [fewest, most] = FRAMES;
        let fit = (budget.as_secs_f64() / seconds(recent)) as u32;
        let frames = self.submit(SLOT, fit.clamp(fewest, most), timeout)?;
        // The first time is mostly that of the system, which maps new memory for the frame.
        let (mut picture, _) = self.read_back(timeout)?;
        let mut read_back = Vec::new();
        let reading = Instant::now();
        while read_back.is_empty()
            || (read_back.len() < MOST_READ_BACKS && reading.elapsed() < budget / 4)
        {
            let (again, took) = self.read_back(timeout)?;
            read_back.push(seconds(took));
            picture = again;
        }
        Ok(RoundTimes {
            prepare: seconds(prepare),
            first: warm.first().copied().map_or(0.0, seconds),
            warm_up: warm.len() as u32,
            frames,
            read_back,
            picture,
        })
    }

    /// Reads the frame back. Returns its fingerprint, and the time that the worker took.
    fn read_back(&mut self, timeout: Duration) -> Result<(u64, Duration), RequestError> {
        let (payload, took) = self.ask(Request::ReadBack { slot: SLOT }, timeout)?;
        let Payload::Frame(frame) = payload else {
            return Err(wrong_answer().into());
        };
        Ok((fingerprint(&frame), took))
    }
}

/// Returns a duration in seconds, at least the nanosecond that is a clock's finest step.
pub(crate) fn seconds(time: Duration) -> f64 {
    time.as_secs_f64().max(1e-9)
}

fn median(times: &[Duration]) -> Duration {
    let mut sorted = times.to_vec();
    sorted.sort_unstable();
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// Returns true if the last frames take as long as the frames before them.
fn steady(warm: &[Duration]) -> bool {
    let Some(from) = warm.len().checked_sub(2 * STRETCH) else {
        return false;
    };
    let (before, last) = warm[from..].split_at(STRETCH);
    let (before, last) = (seconds(median(before)), seconds(median(last)));
    (last - before).abs() <= STEADY * before
}

/// Returns a hash of a frame's images. The frames of a whole bench would not fit into memory.
pub(crate) fn fingerprint(frame: &Frame) -> u64 {
    let mut hasher = DefaultHasher::new();
    for image in &frame.images {
        for side in image.size {
            hasher.write_u32(side);
        }
        for code in &image.codes {
            hasher.write_u32(*code);
        }
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_driver_is_warm_when_it_gets_no_faster() {
        let frames = |millis: &[u64]| -> Vec<Duration> {
            millis.iter().map(|m| Duration::from_millis(*m)).collect()
        };
        assert!(!steady(&frames(&[100; 9])));
        assert!(steady(&frames(&[100; 10])));
        assert!(steady(&frames(&[
            900, 100, 100, 104, 100, 99, 100, 300, 100, 100, 101
        ])));
        assert!(!steady(&frames(&[
            150, 150, 150, 150, 150, 100, 100, 100, 100, 100
        ])));
    }
}
