//! Drawing in a worker: requesting frames, and receiving the answers.

use crate::loss::{Loss, RequestError};
use crate::process::{Wait, WorkerProcess};
use crate::protocol::{Payload, Request, Response};
use etalon_backend::{Backend, BackendError, FrameTime};
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_scene::Scene;
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// The default time that a case may take.
pub(crate) const DRAW_TIMEOUT: Duration = Duration::from_secs(60);

/// The result of drawing scenes.
pub(crate) struct Drawing {
    /// One frame per scene.
    pub(crate) frames: Result<Vec<Frame>, RequestError>,
    /// The time that the worker spent, by its own clock.
    pub(crate) working: Duration,
    /// The time from when the worker could begin until the last answer.
    pub(crate) since: Duration,
    /// Messages of validation layers and debug output.
    pub(crate) messages: Vec<String>,
}

/// The number of expected answers to the requests for some frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DueAnswers {
    answers: usize,
    frames: usize,
}

impl DueAnswers {
    /// A single frame of a single scene.
    pub(crate) const ONE: Self = Self {
        answers: 4,
        frames: 1,
    };

    /// The frame of a scene that was drawn already.
    pub(crate) const READ_BACK: Self = Self {
        answers: 1,
        frames: 1,
    };

    /// Returns the answers for the frames of a case.
    pub(crate) fn of(case: &Case) -> Self {
        let mut drawing = Self {
            answers: 0,
            frames: 0,
        };
        for (_, readings) in case.preparations() {
            drawing.answers += 2 + 2 * readings.len();
            drawing.frames += readings.len();
        }
        drawing
    }
}

/// Returns the frames of a case, drawn by a backend in this process.
///
/// # Errors
/// If the backend fails.
pub fn draw_frames(backend: &dyn Backend, case: &Case) -> Result<Vec<Frame>, BackendError> {
    let mut frames = Vec::new();
    for (scene, readings) in case.preparations() {
        let mut prepared = backend.prepare(scene)?;
        for times in readings {
            for _ in 0..times {
                prepared.submit()?;
            }
            frames.push(prepared.read_back()?);
        }
    }
    Ok(frames)
}

impl Drawing {
    /// Returns the result of a case if no request could be sent to its worker.
    pub(crate) fn failed(failure: RequestError) -> Self {
        Self {
            frames: Err(failure),
            working: Duration::ZERO,
            since: Duration::ZERO,
            messages: Vec::new(),
        }
    }
}

impl WorkerProcess {
    /// Sends a request and waits for the answer, while no other request is in flight. Returns the answer
    /// and the time that the worker spent.
    pub(crate) fn ask(
        &mut self,
        request: Request<'_>,
        timeout: Duration,
    ) -> Result<(Payload, Duration), RequestError> {
        self.request([request]);
        match self.response(timeout)? {
            Response::Done {
                outcome: Ok(payload),
                elapsed,
                ..
            } => Ok((payload, elapsed)),
            Response::Done {
                outcome: Err(error),
                ..
            } => Err(RequestError::Backend(error)),
            Response::Hello(_) => Err(second_greeting().into()),
        }
    }

    /// Draws frames of a prepared scene, while no other request is in flight.
    pub(crate) fn submit(
        &mut self,
        slot: u32,
        times: u32,
        timeout: Duration,
    ) -> Result<Vec<FrameTime>, RequestError> {
        match self.ask(Request::Submit { slot, times }, timeout)? {
            (Payload::Submitted(frame_times), _) if frame_times.len() == times as usize => {
                Ok(frame_times)
            }
            _ => Err(wrong_answer().into()),
        }
    }

    /// Draws the frames of a case.
    pub(crate) fn draw_case(&mut self, slot: u32, case: &Case, wait: Wait<'_>) -> Drawing {
        let asked = Instant::now();
        self.request_case(slot, case);
        self.receive_frames(slot, DueAnswers::of(case), asked, wait)
    }

    /// Requests the frames of a case.
    pub(crate) fn request_case(&mut self, slot: u32, case: &Case) {
        let preparations = case.preparations();
        let requests = preparations.flat_map(|(scene, readings)| requests(slot, scene, readings));
        self.request(requests);
    }

    /// Requests frames of one prepared scene; each entry of `readings` is the number of submissions before
    /// a frame is read back.
    pub(crate) fn request_frames(&mut self, slot: u32, scene: &Scene, readings: Vec<u32>) {
        self.request(requests(slot, scene, readings));
    }

    /// Receives the frames of a slot that were requested at `asked`.
    pub(crate) fn receive_frames(
        &mut self,
        slot: u32,
        requests: DueAnswers,
        asked: Instant,
        wait: Wait<'_>,
    ) -> Drawing {
        // The worker began this request when it had finished the previous one.
        let begun = asked.max(self.answered());
        let until = begun + wait.timeout;
        let mut drawing = Drawing::failed(RequestError::Lost(Loss::Died));
        let mut frames = Vec::new();
        let mut error = None;
        for _ in 0..requests.answers {
            let loss = match self.response_until(until, wait) {
                Ok(Response::Done {
                    slot: answered,
                    outcome,
                    elapsed,
                    messages,
                }) if answered == slot => {
                    drawing.working += elapsed;
                    drawing.messages.extend(messages);
                    match outcome {
                        Ok(Payload::Frame(frame)) => frames.push(*frame),
                        Ok(_) => {}
                        Err(e) => {
                            error.get_or_insert(e);
                        }
                    }
                    continue;
                }
                Ok(Response::Done { .. }) => wrong_answer(),
                Ok(Response::Hello(_)) => second_greeting(),
                Err(loss) => loss,
            };
            drawing.frames = Err(RequestError::Lost(loss));
            drawing.since = begun.elapsed();
            return drawing;
        }
        drawing.frames = match error {
            Some(error) => Err(RequestError::Backend(error)),
            None if frames.len() == requests.frames => Ok(frames),
            None => {
                let error = BackendError::internal("no frame came back");
                Err(RequestError::Backend(error))
            }
        };
        drawing.since = begun.elapsed();
        drawing
    }
}

/// Returns the requests for frames of one prepared scene; each entry of `readings` is the number of
/// submissions before a read-back.
fn requests(slot: u32, scene: &Scene, readings: Vec<u32>) -> impl Iterator<Item = Request<'_>> {
    let scene = Cow::Borrowed(scene);
    let frame = move |times| [Request::Submit { slot, times }, Request::ReadBack { slot }];
    [Request::Prepare { slot, scene }]
        .into_iter()
        .chain(readings.into_iter().flat_map(frame))
        .chain([Request::Drop { slot }])
}

/// Returns the loss of a worker whose answer does not fit the request.
pub(crate) fn wrong_answer() -> Loss {
    Loss::Garbage("an answer to another request".to_owned())
}

fn second_greeting() -> Loss {
    Loss::Garbage("a second greeting".to_owned())
}
