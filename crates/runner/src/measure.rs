//! The measurements of a method case: the distance of its picture from the truth, and its cost.

use crate::drawing::Due;
use crate::loss::{Failure, Loss};
use crate::process::{Wait, WorkerProcess};
use crate::protocol::Request;
use etalon_backend::FrameTime;
use etalon_case::Case;
use etalon_case::Method;
use etalon_frame::{CounterKind, Feature, Frame, Limits};
use etalon_record::{Measured, Parameter, Times};
use etalon_scene::Scene;
use etalon_truth::{Truth, TruthPicture, distance, truth};
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Frames that are drawn after the first and before the first timed one. Drivers compile and allocate at
/// the first frame, and some again at the second. A frame as long as the budget needs no warm-up.
const WARM_UP: u32 = 2;
/// The total time of a case's timed frames, within the limits on their number.
const BUDGET: Duration = Duration::from_millis(40);
/// The minimum and the maximum number of frames that are timed.
const FRAMES: [u32; 2] = [3, 31];

/// The truths of a run's method cases, each computed once for all methods and adapters.
#[derive(Debug, Default)]
pub(crate) struct Truths {
    /// The truths, by question and scene.
    scenes: Mutex<HashMap<(String, String), Vec<Known>>>,
}

/// A truth, and its picture once it has been computed.
type Known = (Truth, Arc<OnceLock<Arc<TruthPicture>>>);

impl Truths {
    /// Returns the exact picture of a method. Methods that should show the same picture share it.
    pub(crate) fn get(&self, method: &Method) -> Arc<TruthPicture> {
        let entry = {
            let mut scenes = self.scenes.lock().unwrap_or_else(PoisonError::into_inner);
            let key = (method.question.clone(), method.scene.clone());
            let known = scenes.entry(key).or_default();
            match known.iter().find(|(truth, _)| *truth == method.truth) {
                Some((_, entry)) => Arc::clone(entry),
                None => {
                    let entry = Arc::default();
                    known.push((method.truth.clone(), Arc::clone(&entry)));
                    entry
                }
            }
        };
        let picture = entry.get_or_init(|| Arc::new(truth(&method.truth)));
        Arc::clone(picture)
    }
}

/// Returns the distance of a case's picture from the truth, and the costs that need no device. `None` if
/// the frame has no picture to compare.
pub(crate) fn measured(case: &Case, truth: &TruthPicture, frame: &Frame) -> Option<Measured> {
    let method = case.method.as_ref()?;
    let distance = distance(truth, frame.images.first()?)?;
    let draws: usize = case.scene.passes.iter().map(|p| p.draws.len()).sum();
    Some(Measured {
        question: method.question.clone(),
        scene: method.scene.clone(),
        method: method.name.clone(),
        parameter: method.parameter.as_ref().map(|p| Parameter {
            name: p.name.clone(),
            value: p.value,
        }),
        distance,
        time: None,
        passes: case.scene.passes.len() as u32,
        draws: draws as u32,
        fragments: None,
        bytes: case.scene.bytes(),
        picture: None,
        truth: None,
    })
}

impl WorkerProcess {
    /// Times frames of a scene, and counts its fragments if the adapter has statistics. Fragments are
    /// counted in a separate frame, since counting costs time. No other request may be in flight.
    pub(crate) fn time(
        &mut self,
        slot: u32,
        scene: &Scene,
        limits: &Limits,
        timeout: Duration,
    ) -> Result<(Option<Times>, Option<u64>), Loss> {
        let times = self.time_frames(slot, scene, timeout)?;
        if !limits.features.contains(&Feature::FragmentInvocations) {
            return Ok((times, None));
        }
        let asked = Instant::now();
        let counting = scene.counting(CounterKind::FragmentInvocations);
        self.request_frames(slot, &counting, vec![1]);
        match self
            .receive_frames(slot, Due::ONE, asked, Wait::of(timeout))
            .frames
        {
            Ok(frames) => {
                let count = frames.first().and_then(|f| f.counters.first().copied());
                Ok((times, count))
            }
            // The picture was drawn and timed, so a failed count does not matter.
            Err(Failure::Backend(_)) => Ok((times, None)),
            Err(Failure::Lost(loss)) => Err(loss),
        }
    }

    /// Times frames of a scene; `None` if the backend reports an error.
    fn time_frames(
        &mut self,
        slot: u32,
        scene: &Scene,
        timeout: Duration,
    ) -> Result<Option<Times>, Loss> {
        let timed = self.prepare_and_time(slot, scene, timeout);
        let dropped = match timed {
            Err(Failure::Lost(loss)) => return Err(loss),
            _ => self.ask(Request::Drop { slot }, timeout),
        };
        match (timed, dropped) {
            (_, Err(Failure::Lost(loss))) => Err(loss),
            (Ok(times), _) => Ok(medians(&times)),
            (Err(_), _) => Ok(None),
        }
    }

    fn prepare_and_time(
        &mut self,
        slot: u32,
        scene: &Scene,
        timeout: Duration,
    ) -> Result<Vec<FrameTime>, Failure> {
        let scene = Cow::Borrowed(scene);
        self.ask(Request::Prepare { slot, scene }, timeout)?;
        let mut warm = self.submit(slot, 1, timeout)?;
        if warm.first().is_some_and(|first| first.wall < BUDGET) {
            warm = self.submit(slot, WARM_UP, timeout)?;
        }
        let Some(last) = warm.last() else {
            return Ok(Vec::new());
        };
        let frame = last.wall.as_secs_f64().max(1e-6);
        let [fewest, most] = FRAMES;
        let fit = (BUDGET.as_secs_f64() / frame) as u32;
        self.submit(slot, fit.clamp(fewest, most), timeout)
    }
}

/// Returns the medians of some frame times.
fn medians(times: &[FrameTime]) -> Option<Times> {
    let median = |mut values: Vec<Duration>| -> Option<f64> {
        values.sort_unstable();
        values.get(values.len() / 2).map(Duration::as_secs_f64)
    };
    Some(Times {
        samples: times.len() as u32,
        wall: median(times.iter().map(|t| t.wall).collect())?,
        cpu: median(times.iter().map(|t| t.cpu).collect())?,
        gpu: median(times.iter().filter_map(|t| t.gpu).collect()),
        interval: interval(times.iter().map(|t| t.wall).collect()),
    })
}

/// Returns the two closest order statistics between which the median is with 95 % confidence, whatever the
/// distribution (the binomial sign test). Fewer than six times cannot reach that confidence; for these,
/// returns the ends.
fn interval(mut times: Vec<Duration>) -> Option<[f64; 2]> {
    times.sort_unstable();
    let last = times.len().checked_sub(1)?;
    // The probability that at most `low` of the times are below the median.
    let (mut low, mut tail, mut term) = (0, 0.0, 0.5_f64.powi(times.len() as i32));
    while low < last / 2 {
        tail += term;
        term *= (times.len() - low) as f64 / (low + 1) as f64;
        if tail + term > 0.025 {
            break;
        }
        low += 1;
    }
    Some([times[low], times[last - low]].map(|t| t.as_secs_f64()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_stand_in_the_middle_and_nothing_has_none() {
        assert_eq!(medians(&[]), None);
        let time = |wall: u64, gpu: Option<u64>| FrameTime {
            cpu: Duration::from_millis(1),
            gpu: gpu.map(Duration::from_millis),
            wall: Duration::from_millis(wall),
        };
        let found = medians(&[time(9, None), time(2, Some(3)), time(4, None)]);
        let expected = Times {
            samples: 3,
            wall: 0.004,
            cpu: 0.001,
            gpu: Some(0.003),
            interval: Some([0.002, 0.009]),
        };
        assert_eq!(found, Some(expected));
    }

    #[test]
    fn the_interval_holds_the_median_with_the_level_that_is_stated() {
        let measured = |count: u64| {
            let times = (1..=count).map(Duration::from_secs).collect();
            interval(times).map(|ends| ends.map(|e| e as u64))
        };
        assert_eq!(measured(0), None);
        assert_eq!(measured(1), Some([1, 1]));
        assert_eq!(measured(5), Some([1, 5]), "93.75 % at most");
        // From tables of the sign test: with 6 to 8 times, none is dropped at either end; with 9 to 11, one;
        // with 12 to 14, two; with 31, nine.
        assert_eq!(measured(6), Some([1, 6]));
        assert_eq!(measured(8), Some([1, 8]));
        assert_eq!(measured(9), Some([2, 8]));
        assert_eq!(measured(12), Some([3, 10]));
        assert_eq!(measured(31), Some([10, 22]));
    }
}
