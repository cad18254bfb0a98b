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
            .receive_frames(slot, DueAnswers::ONE, asked, Wait::of(timeout))
            .frames
        {
            Ok(frames) => {
                let count = frames.first().and_then(|f| f.counters.first().copied());
                Ok((times, count))
            }
            // The picture was drawn and timed, so a failed count does not matter.
            Err(RequestError::Backend(_)) => Ok((times, None)),
            Err(RequestError::Lost(loss)) => Err(loss),
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
            Err(RequestError::Lost(loss)) => return Err(loss),
            _ => self.ask(Request::Drop { slot }, timeout),
        };
        match (timed, dropped) {
            (_, Err(RequestError::Lost(loss))) => Err(loss),
            (Ok(times), _) => Ok(medians(&times, 0.0)),
            (Err(_), _) => Ok(None),
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

fn seconds(time: &FrameTime) -> FrameSeconds {
    FrameSeconds {
        wall: time.wall.as_secs_f64(),
        cpu: time.cpu.as_secs_f64(),
        gpu: time.gpu.map(|gpu| gpu.as_secs_f64()),
    }
}
