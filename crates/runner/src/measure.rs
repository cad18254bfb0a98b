//! Timing the frames of a method case.

use crate::drawing::DueAnswers;
use crate::loss::{Loss, RequestError};
use crate::process::{Wait, WorkerProcess};
use crate::protocol::Request;
use etalon_backend::FrameTime;
use etalon_frame::{CounterKind, Feature, Limits};
use etalon_judge::{FrameSeconds, Timing, medians};
use etalon_record::Times;
use etalon_scene::Scene;
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// The steps of the clock that times frames, in seconds: too fine to matter.
const EXACT_CLOCK: f64 = 0.0;

/// What a frame of a scene costs.
pub(crate) struct FrameCost {
    /// The frame times; `None` if the backend reports an error.
    pub(crate) times: Option<Times>,
    /// The number of fragments, if the adapter has statistics.
    pub(crate) fragments: Option<u64>,
}

impl WorkerProcess {
    /// Times frames of a scene, and counts its fragments if the adapter has statistics. Fragments are
    /// counted in a separate frame, since counting costs time. No other request may be in flight.
    pub(crate) fn measure(
        &mut self,
        slot: u32,
        scene: &Scene,
        limits: &Limits,
        timeout: Duration,
    ) -> Result<FrameCost, Loss> {
        let times = self.time_frames(slot, scene, timeout)?;
        if !limits.features.contains(&Feature::FragmentInvocations) {
            let fragments = None;
            return Ok(FrameCost { times, fragments });
        }
        let requested_at = Instant::now();
        let counting = scene.counting(CounterKind::FragmentInvocations);
        self.request_frames(slot, &counting, vec![1]);
        let fragments = match self
            .receive_frames(slot, DueAnswers::ONE, requested_at, Wait::of(timeout))
            .frames
        {
            Ok(frames) => frames.first().and_then(|f| f.counters.first().copied()),
            // The picture was drawn and timed, so a failed count does not matter.
            Err(RequestError::Backend(_)) => None,
            Err(RequestError::Lost(loss)) => return Err(loss),
        };
        Ok(FrameCost { times, fragments })
    }

    /// Times frames of a scene; `None` if the backend reports an error.
    fn time_frames(
        &mut self,
        slot: u32,
        scene: &Scene,
        timeout: Duration,
    ) -> Result<Option<Times>, Loss> {
        let timed = self.prepare_and_time(slot, scene, timeout);
        if let Err(RequestError::Lost(loss)) = timed {
            return Err(loss);
        }
        self.forget(slot, timeout)?;
        Ok(timed.ok().and_then(|times| medians(&times, EXACT_CLOCK)))
    }

    /// Forgets a prepared scene. A failed drop does not matter unless the worker is lost.
    pub(crate) fn forget(&mut self, slot: u32, timeout: Duration) -> Result<(), Loss> {
        match self.ask(Request::Drop { slot }, timeout) {
            Err(RequestError::Lost(loss)) => Err(loss),
            Ok(_) | Err(RequestError::Backend(_)) => Ok(()),
        }
    }

    fn prepare_and_time(
        &mut self,
        slot: u32,
        scene: &Scene,
        timeout: Duration,
    ) -> Result<Vec<FrameSeconds>, RequestError> {
        let scene = Cow::Borrowed(scene);
        self.ask(Request::Prepare { slot, scene }, timeout)?;
        let mut timing = Timing::default();
        loop {
            let times = self.submit(slot, timing.frames(), timeout)?;
            let times: Vec<FrameSeconds> = times.iter().map(seconds).collect();
            match timing.next(&times) {
                Some(next) => timing = next,
                None => return Ok(times),
            }
        }
    }
}

pub(crate) fn seconds(time: &FrameTime) -> FrameSeconds {
    FrameSeconds {
        wall: time.wall.as_secs_f64(),
        cpu: time.cpu.as_secs_f64(),
        gpu: time.gpu.map(|gpu| gpu.as_secs_f64()),
    }
}
