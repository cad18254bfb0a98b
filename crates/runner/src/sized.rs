//! Timing a method's scene at the sizes of frames that people draw.

use crate::drawing::DueAnswers;
use crate::loss::{Loss, RequestError};
use crate::measure::seconds;
use crate::process::{Wait, WorkerProcess};
use crate::protocol::Request;
use etalon_frame::{Limits, SizedDistance};
use etalon_judge::{FrameSeconds, SizedScene, medians};
use etalon_record::{Clock, Cost, Reason, SizedFrame};
use etalon_scene::Scene;
use etalon_stats::{CostLine, TimedWork};
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// The minimum and the maximum number of rounds. Fewer than six have no interval with 95 % confidence.
const ROUNDS: [usize; 2] = [6, 15];
/// The minimum number of rounds with a long frame.
const ROUNDS_OF_LONG: usize = 2;
/// The time in seconds from which a frame is long: a run would take too much time for an interval.
const LONG: f64 = 0.25;
/// The time in seconds after which no round begins that is not needed.
const BUDGET: f64 = 0.5;
/// The least time of a size in a round, in seconds: shorter frames are drawn several times.
const ROUND: f64 = 0.002;
/// The maximum number of frames of a size in a round.
const FRAMES: f64 = 16.0;
/// The longest frame in seconds after which a larger size is tried.
const LONGEST: f64 = 2.0;

/// The facts about an adapter that decide what is drawn and which clock counts.
pub(crate) struct SizingAdapter<'a> {
    pub(crate) limits: &'a Limits,
    pub(crate) is_software: bool,
    /// The most memory of a worker in MiB, if it is limited.
    pub(crate) memory: Option<u64>,
}

/// One size while it is being timed.
struct TimedSize<'s> {
    /// The index of its frame.
    index: usize,
    slot: u32,
    scene: &'s SizedScene,
    /// The frames drawn in each round, which take at least [`ROUND`] seconds together.
    frames: u32,
    /// The times of each round's frames.
    rounds: Vec<Vec<FrameSeconds>>,
}

impl WorkerProcess {
    /// Times frames of all sizes, smallest first, in rounds in which they take turns, and reads the last frame of each
    /// back. No other request may be in flight, and slots from `first_slot` on must be free.
    pub(crate) fn measure_sizes(
        &mut self,
        first_slot: u32,
        scenes: &[SizedScene],
        adapter: &SizingAdapter<'_>,
        timeout: Duration,
    ) -> Result<(Vec<SizedFrame>, Option<Cost>), Loss> {
        let mut frames: Vec<SizedFrame> = Vec::new();
        let mut timed: Vec<TimedSize<'_>> = Vec::new();
        let mut longest = 0.0_f64;
        for (index, scene) in scenes.iter().enumerate() {
            let began = match obstacle(scene, adapter, longest) {
                Some(reason) => Err(reason),
                None => self.begin(first_slot, index, scene, timeout)?,
            };
            let reason = match began {
                Ok((first, size)) => {
                    longest = longest.max(first);
                    timed.push(size);
                    None
                }
                Err(reason) => Some(reason),
            };
            frames.push(SizedFrame {
                size: scene.size,
                time: None,
                distance: None,
                reason,
            });
        }
        let began = Instant::now();
        for round in 0..ROUNDS[1] {
            let elapsed = began.elapsed().as_secs_f64();
            let fewest = if longest > LONG {
                ROUNDS_OF_LONG
            } else {
                ROUNDS[0]
            };
            if round >= fewest && elapsed > BUDGET {
                break;
            }
            for size in &mut timed {
                match self.submit(size.slot, size.frames, timeout) {
                    Ok(times) => size.rounds.push(times.iter().map(seconds).collect()),
                    Err(RequestError::Lost(loss)) => return Err(loss),
                    Err(RequestError::Backend(error)) => {
                        frames[size.index].reason = Some(Reason::Text(error.to_string()));
                        self.forget(size.slot, timeout)?;
                    }
                }
            }
            timed.retain(|size| frames[size.index].reason.is_none());
        }
        for size in &timed {
            let all: Vec<FrameSeconds> = size.rounds.iter().flatten().copied().collect();
            let frame = &mut frames[size.index];
            frame.time = medians(&all, 0.0);
            frame.distance = self.distance(size, timeout)?;
            self.forget(size.slot, timeout)?;
        }
        let cost = cost(&timed, adapter.is_software);
        // The picture has its times and its distance elsewhere.
        let sized = frames.into_iter().zip(scenes);
        let sized = sized.filter(|(_, scene)| scene.truth.is_some());
        Ok((sized.map(|(frame, _)| frame).collect(), cost))
    }

    /// Prepares a size and draws its first frames. Returns the time of a warm frame, or the reason why the size is
    /// not timed.
    fn begin<'s>(
        &mut self,
        first_slot: u32,
        index: usize,
        scene: &'s SizedScene,
        timeout: Duration,
    ) -> Result<Result<(f64, TimedSize<'s>), Reason>, Loss> {
        let slot = first_slot + index as u32;
        let prepared = Cow::Borrowed(&scene.scene);
        let times = self
            .ask(
                Request::Prepare {
                    slot,
                    scene: prepared,
                },
                timeout,
            )
            .and_then(|_| self.submit(slot, 1, timeout))
            .and_then(|first| match first.first() {
                Some(time) if seconds(time).wall < LONG => self.submit(slot, 2, timeout),
                _ => Ok(first),
            });
        let times = match times {
            Ok(times) => times,
            Err(RequestError::Lost(loss)) => return Err(loss),
            Err(RequestError::Backend(error)) => {
                self.forget(slot, timeout)?;
                return Ok(Err(Reason::Text(error.to_string())));
            }
        };
        let last = times.last().map_or(LONGEST, |time| seconds(time).wall);
        let frames = (ROUND / last.max(ROUND / FRAMES)).ceil() as u32;
        let size = TimedSize {
            index,
            slot,
            scene,
            frames: frames.max(1),
            rounds: Vec::new(),
        };
        Ok(Ok((last, size)))
    }

    /// Reads the last frame of a size back and compares it with the truth.
    fn distance(
        &mut self,
        size: &TimedSize<'_>,
        timeout: Duration,
    ) -> Result<Option<SizedDistance>, Loss> {
        if size.scene.truth.is_none() {
            return Ok(None);
        }
        let asked = Instant::now();
        self.request([Request::ReadBack { slot: size.slot }]);
        let answer =
            self.receive_frames(size.slot, DueAnswers::READ_BACK, asked, Wait::of(timeout));
        match answer.frames {
            Ok(frames) => Ok(frames.first().and_then(|frame| size.scene.distance(frame))),
            Err(RequestError::Lost(loss)) => Err(loss),
            Err(RequestError::Backend(_)) => Ok(None),
        }
    }
}

/// Returns the reason why a size is not drawn, if there is one. The size of the picture was drawn already.
fn obstacle(scene: &SizedScene, adapter: &SizingAdapter<'_>, longest: f64) -> Option<Reason> {
    let content = scene.scene.content_bytes();
    let bytes = scene.scene.bytes() + content;
    let most = adapter.memory.map(|mebibytes| mebibytes << 20);
    let missing = adapter.limits.missing(&scene.scene.requirements());
    if let Some(missing) = missing {
        Some(Reason::Missing(missing))
    } else if content > Scene::MOST_CONTENT || most.is_some_and(|most| bytes > most / 2) {
        Some(Reason::LargeFrames(bytes))
    } else if longest > LONGEST {
        Some(Reason::LongFrames(longest))
    } else {
        None
    }
}

/// Returns the cost of a frame. The device's clock counts on hardware that has one: it does not see how long a
/// submission takes.
fn cost(timed: &[TimedSize<'_>], is_software: bool) -> Option<Cost> {
    let every_frame = || timed.iter().flat_map(|size| size.rounds.iter().flatten());
    let has_device_clock = !is_software && every_frame().all(|frame| frame.gpu.is_some());
    let clock = if has_device_clock {
        Clock::Device
    } else {
        Clock::Wall
    };
    let time = |frame: &FrameSeconds| match clock {
        Clock::Device => frame.gpu.unwrap_or(frame.wall),
        Clock::Wall => frame.wall,
    };
    let work = timed.iter().map(|size| {
        let [width, height] = size.scene.size.map(f64::from);
        let mean = |frames: &Vec<FrameSeconds>| {
            frames.iter().map(time).sum::<f64>() / frames.len().max(1) as f64
        };
        TimedWork {
            work: width * height / 1e6,
            rounds: size.rounds.iter().map(mean).collect(),
        }
    });
    let line = CostLine::fit(&work.collect::<Vec<_>>())?;
    Some(Cost {
        clock,
        fixed: line.fixed.into(),
        per_megapixel: line.per_unit.into(),
        deviation: line.deviation,
    })
}
