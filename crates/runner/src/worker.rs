//! A worker process whose adapter is open.

use crate::drawing::{DRAW_TIMEOUT, DueAnswers};
use crate::launch::{Launch, StartError};
use crate::loss::RequestError;
use crate::outcome::outcome;
use crate::process::{Wait, WorkerProcess};
use crate::protocol::{Hello, Payload, Request, Response};
use etalon_backend::{BackendError, Recording, Unavailable};
use etalon_case::Case;
use etalon_frame::{Frame, printable};
use etalon_record::{Record, Release};
use etalon_scene::Scene;
use std::time::{Duration, Instant};
use thiserror::Error;

/// A running worker whose adapter is open.
pub struct Worker {
    /// The adapter as the worker describes it.
    pub hello: Hello,
    /// The release of its driver, if the adapter's description states it.
    pub release: Option<Release>,
    /// The time from its start until its adapter was open.
    pub(crate) opening: Duration,
    pub(crate) process: WorkerProcess,
}

/// The most characters of a name that a driver gives.
const MOST_OF_A_NAME: usize = 400;
/// The most characters of the reason why an adapter is unavailable.
const MOST_OF_A_REASON: usize = 2000;

/// Returns what a worker says about its adapter, with names that can be shown anywhere.
fn printable_hello(mut hello: Hello) -> Hello {
    let info = &mut hello.info;
    for name in [
        &mut info.name,
        &mut info.device,
        &mut info.driver,
        &mut info.driver_version,
        &mut info.api_version,
    ] {
        *name = printable(name, MOST_OF_A_NAME);
    }
    hello
}

impl Worker {
    /// Starts a worker and waits until its adapter is open.
    ///
    /// # Errors
    /// If the program cannot be started, reports that its adapter is unavailable, or does not answer.
    pub fn start(launch: &Launch) -> Result<Self, StartError> {
        let begun = Instant::now();
        let mut process = WorkerProcess::spawn(launch)?;
        match process.response(launch.patience) {
            Ok(Response::Hello(Ok(hello))) => Ok(Self {
                hello: checked(printable_hello(*hello))?,
                release: launch.release.clone(),
                opening: begun.elapsed(),
                process,
            }),
            Ok(Response::Hello(Err(unavailable))) => Err(StartError::Unavailable(Unavailable {
                reason: printable(&unavailable.reason, MOST_OF_A_REASON),
                remedy: printable(&unavailable.remedy, MOST_OF_A_REASON),
            })),
            Ok(Response::Done { .. }) => Err(StartError::Broken(
                "the worker's first message is not a greeting".to_owned(),
            )),
            Err(loss) => {
                // The driver is opened after the greeting.
                let of_launcher = launch.launcher.is_some() && !process.has_greeted();
                let message = process.end_of(loss).to_string();
                Err(if of_launcher {
                    StartError::Launcher(format!(
                        "no worker answers behind the launcher: {message}"
                    ))
                } else {
                    StartError::Broken(format!("the driver did not start: {message}"))
                })
            }
        }
    }

    /// Draws and judges a case, which may take as long as `timeout`. Returns its record, and whether the
    /// worker must not be used again.
    pub fn record(&mut self, case: &Case, timeout: Duration) -> (Record, bool) {
        let drawing = self.process.draw_case(0, case, Wait::of(timeout));
        outcome(&mut self.process, case, &self.hello.limits, drawing.frames)
    }

    /// Draws the scenes of a case and reads each back.
    ///
    /// # Errors
    /// The backend's error, or how the worker was lost.
    pub fn draw(&mut self, case: &Case) -> Result<Vec<Frame>, DrawError> {
        let drawing = self.process.draw_case(0, case, Wait::of(DRAW_TIMEOUT));
        drawing.frames.map_err(|failure| self.lost(failure))
    }
}

impl Worker {
    /// Draws one scene that this worker has not drawn before, with an adapter that was opened to record.
    /// Returns the frame, the messages of validation layers and debug output, and the calls, which are
    /// `None` if the backend does not record.
    ///
    /// # Errors
    /// As [`Worker::draw`].
    pub fn recorded(&mut self, scene: &Scene) -> Result<Recorded, DrawError> {
        let asked = Instant::now();
        self.process.request_frames(0, scene, vec![1]);
        let drawing =
            self.process
                .receive_frames(0, DueAnswers::ONE, asked, Wait::of(DRAW_TIMEOUT));
        let frames = drawing.frames.map_err(|failure| self.lost(failure))?;
        let answer = self
            .process
            .ask(Request::Recording { slot: 0 }, DRAW_TIMEOUT);
        let (payload, _) = answer.map_err(|failure| self.lost(failure))?;
        let (Some(frame), Payload::Recording(recording)) = (frames.into_iter().next(), payload)
        else {
            return Err(DrawError::Lost("the worker gave a wrong answer".to_owned()));
        };
        Ok(Recorded {
            frame,
            messages: drawing.messages,
            recording: recording.map(|r| *r),
        })
    }

    fn lost(&mut self, failure: RequestError) -> DrawError {
        match failure {
            RequestError::Backend(error) => DrawError::Backend(error),
            RequestError::Lost(loss) => DrawError::Lost(self.process.end_of(loss).to_string()),
        }
    }
}

/// Returns an adapter whose limits can be judged by.
fn checked(hello: Hello) -> Result<Hello, StartError> {
    let Hello { info, limits } = hello;
    let limits = limits.checked().map_err(|error| {
        let reason = format!("{} {} reports {error}", info.driver, info.driver_version);
        let remedy = "nothing that it draws could be judged: use another version of the driver";
        StartError::Unavailable(Unavailable::new(reason, remedy))
    })?;
    Ok(Hello { info, limits })
}

/// A scene that was drawn once.
pub struct Recorded {
    /// The frame that came back.
    pub frame: Frame,
    /// Messages of validation layers and debug output.
    pub messages: Vec<String>,
    /// The calls that the backend made; `None` if it records none.
    pub recording: Option<Recording>,
}

/// The reason why a case could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DrawError {
    /// The backend's error.
    #[error(transparent)]
    Backend(BackendError),
    /// The worker died, hung or broke the protocol.
    #[error("{0}")]
    Lost(String),
}
