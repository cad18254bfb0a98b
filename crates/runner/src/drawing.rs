//! Drawing scenes in a worker: the requests for one frame, and their answers.

use crate::loss::{Failure, Loss};
use crate::process::{Wait, WorkerProcess};
use crate::protocol::{Payload, Request, Response};
use etalon_backend::BackendError;
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_scene::Scene;
use std::time::{Duration, Instant};

/// The default time that a case may take.
pub(crate) const DRAW_TIMEOUT: Duration = Duration::from_secs(60);

/// The result of drawing scenes.
pub(crate) struct Drawing {
    /// One frame per scene.
    pub(crate) frames: Result<Vec<Frame>, Failure>,
    /// The time that the worker spent, by its own clock.
    pub(crate) working: Duration,
    /// The time since the worker could begin.
    pub(crate) since: Duration,
    /// Messages of validation layers and debug output.
    pub(crate) messages: Vec<String>,
}

impl Drawing {
    /// The drawing of a case whose worker could not be asked.
    pub(crate) fn failed(failure: Failure) -> Self {
        Self {
            frames: Err(failure),
            working: Duration::ZERO,
            since: Duration::ZERO,
            messages: Vec::new(),
        }
    }
}

impl WorkerProcess {
    /// Requests one frame of each of a case's scenes.
    pub(crate) fn request_case(&mut self, slot: u32, case: &Case) {
        for scene in case.scenes() {
            self.request_frame(slot, scene);
        }
    }

    /// Requests one frame of a scene.
    pub(crate) fn request_frame(&mut self, slot: u32, scene: &Scene) {
        self.request(&Request::Prepare {
            slot,
            scene: Box::new(scene.clone()),
        });
        self.request(&Request::Submit { slot, times: 1 });
        self.request(&Request::ReadBack { slot });
        self.request(&Request::Drop { slot });
    }

    /// Receives `count` frames that were requested of a slot at the time `asked`.
    pub(crate) fn receive_frames(
        &mut self,
        slot: u32,
        count: usize,
        asked: Instant,
        wait: Wait<'_>,
    ) -> Drawing {
        // The worker came to this request when it was done with the one before.
        let begun = asked.max(self.answered());
        let until = begun + wait.timeout;
        let mut drawing = Drawing::failed(Failure::Lost(Loss::Died));
        let mut frames = Vec::new();
        let mut error = None;
        for _ in 0..4 * count {
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
                Ok(Response::Done { .. }) => {
                    Loss::Garbage("an answer to another request".to_owned())
                }
                Ok(Response::Hello(_)) => Loss::Garbage("a second greeting".to_owned()),
                Err(loss) => loss,
            };
            drawing.frames = Err(Failure::Lost(loss));
            drawing.since = begun.elapsed();
            return drawing;
        }
        drawing.frames = match error {
            Some(error) => Err(Failure::Backend(error)),
            None if frames.len() == count => Ok(frames),
            None => {
                let error = BackendError::Internal("no frame came back".to_owned());
                Err(Failure::Backend(error))
            }
        };
        drawing.since = begun.elapsed();
        drawing
    }
}
