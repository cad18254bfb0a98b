//! A worker process as the parent holds it.

use crate::link::{Link, Patience};
use crate::loss::Loss;
use crate::protocol::{Hello, Response};
use etalon_backend::{BackendError, Unavailable};
use etalon_case::Case;
use etalon_frame::Frame;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use thiserror::Error;

/// How long a driver may take to start.
const START_TIMEOUT: Duration = Duration::from_secs(60);
/// How long a case may take before its worker is given up, where nobody says otherwise.
pub(crate) const DRAW_TIMEOUT: Duration = Duration::from_secs(60);

/// How to start a worker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// The adapter's name.
    pub adapter: String,
    /// The program.
    pub program: PathBuf,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// Environment variables on top of the parent's; `None` removes one.
    pub environment: Vec<(String, Option<String>)>,
}

/// Why a worker did not start.
#[derive(Debug, Error)]
pub enum StartError {
    /// It says so itself.
    #[error("{0}")]
    Unavailable(Unavailable),
    /// It died, hung or talked nonsense.
    #[error("{0}")]
    Broken(String),
}

/// A running worker whose adapter is open.
pub struct Worker {
    /// Who it said it is.
    pub hello: Hello,
    pub(crate) link: Link,
}

impl Worker {
    /// Starts a worker and waits for its first words.
    ///
    /// # Errors
    /// When the program cannot be started, says that its adapter is unavailable, or does not answer.
    pub fn start(launch: &Launch) -> Result<Self, StartError> {
        let mut link = Link::start(launch)?;
        match link.response(START_TIMEOUT) {
            Ok(Response::Hello(Ok(hello))) => Ok(Self {
                hello: *hello,
                link,
            }),
            Ok(Response::Hello(Err(unavailable))) => Err(StartError::Unavailable(unavailable)),
            Ok(Response::Done { .. }) => Err(StartError::Broken(
                "the worker's first message is not a greeting".to_owned(),
            )),
            Err(loss) => Err(StartError::Broken(format!(
                "the driver did not start: {}",
                link.obituary(loss).message
            ))),
        }
    }
}

impl Worker {
    /// Draws the scenes of a case and reads each back.
    ///
    /// # Errors
    /// What the backend says, or how the worker was lost.
    pub fn draw(&mut self, case: &Case) -> Result<Vec<Frame>, DrawError> {
        let asked = Instant::now();
        for scene in case.scenes() {
            self.link.draw(0, scene);
        }
        let patience = Patience::of(DRAW_TIMEOUT);
        let drawing = self.link.drawn(0, case.scene_count(), asked, patience);
        match drawing.drawn {
            Drawn::Frames(frames) => Ok(frames),
            Drawn::Error(error) => Err(DrawError::Backend(error)),
            Drawn::Lost(loss) => Err(DrawError::Lost(self.link.obituary(loss).message)),
        }
    }
}

/// Why a scene could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DrawError {
    /// The backend's word.
    #[error(transparent)]
    Backend(BackendError),
    /// The worker died, hung or talked nonsense.
    #[error("{0}")]
    Lost(String),
}

/// What drawing a scene came to.
pub(crate) enum Drawn {
    Frames(Vec<Frame>),
    Error(BackendError),
    Lost(Loss),
}
