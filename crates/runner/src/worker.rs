//! A worker process whose adapter is open.

use crate::drawing::DRAW_TIMEOUT;
use crate::launch::{Launch, StartError};
use crate::loss::Failure;
use crate::outcome::outcome;
use crate::process::{Wait, WorkerProcess};
use crate::protocol::{Hello, Response};
use etalon_backend::BackendError;
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_record::{Record, Release};
use std::time::Duration;
use thiserror::Error;

/// The time that a driver may take to start.
const START_TIMEOUT: Duration = Duration::from_secs(60);

/// A running worker whose adapter is open.
pub struct Worker {
    /// The adapter as the worker describes it.
    pub hello: Hello,
    /// The release of its driver, where its description says it.
    pub release: Option<Release>,
    pub(crate) process: WorkerProcess,
}

impl Worker {
    /// Starts a worker and waits until its adapter is open.
    ///
    /// # Errors
    /// When the program cannot be started, says that its adapter is unavailable, or does not answer.
    pub fn start(launch: &Launch) -> Result<Self, StartError> {
        let mut process = WorkerProcess::spawn(launch)?;
        match process.response(START_TIMEOUT) {
            Ok(Response::Hello(Ok(hello))) => Ok(Self {
                hello: *hello,
                release: launch.release.clone(),
                process,
            }),
            Ok(Response::Hello(Err(unavailable))) => Err(StartError::Unavailable(unavailable)),
            Ok(Response::Done { .. }) => Err(StartError::Broken(
                "the worker's first message is not a greeting".to_owned(),
            )),
            Err(loss) => {
                // The driver is opened behind the greeting.
                let of_launcher = launch.launcher.is_some() && !process.has_greeted();
                let message = process.exit_report(loss).message;
                Err(match of_launcher {
                    true => StartError::Launcher(format!(
                        "no worker answers behind the launcher: {message}"
                    )),
                    false => StartError::Broken(format!("the driver did not start: {message}")),
                })
            }
        }
    }

    /// Draws and judges a case, which may take as long as `timeout`. Returns its record, and whether the worker must
    /// not be used again.
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
        drawing.frames.map_err(|failure| match failure {
            Failure::Backend(error) => DrawError::Backend(error),
            Failure::Lost(loss) => DrawError::Lost(self.process.exit_report(loss).message),
        })
    }
}

/// Why a case could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DrawError {
    /// The backend's error.
    #[error(transparent)]
    Backend(BackendError),
    /// The worker died, hung or broke the protocol.
    #[error("{0}")]
    Lost(String),
}
