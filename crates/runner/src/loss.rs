//! The ways in which a request to a worker fails, and the verdict that follows from each.

use etalon_backend::BackendError;
use etalon_frame::ErrorKind;
use etalon_record::Verdict;
use std::time::Duration;

/// Why a request to a worker brought no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Failure {
    /// The backend's error; the worker still answers.
    Backend(BackendError),
    /// The worker was lost.
    Lost(Loss),
}

/// The way in which a worker was lost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Loss {
    /// It did not answer within this time.
    Timeout(Duration),
    /// It held `held` MiB of memory, more than its limit.
    Memory { held: u64, limit: u64 },
    /// Its output is no message, or no answer to the request.
    Garbage(String),
    /// Its end of the pipe is closed.
    Died,
    /// It could not be started; the message says why.
    NotStarted(String),
    /// The run is being stopped, and the answer is no longer needed.
    Cancelled,
}

impl Failure {
    /// The verdict of the case that was being drawn.
    pub(crate) fn verdict(&self) -> Verdict {
        match self {
            Self::Backend(error) => match error {
                BackendError::NotSupported(_) => Verdict::NotSupported,
                BackendError::Failed { kind, .. } => match kind {
                    ErrorKind::DeviceLost => Verdict::DeviceLost,
                    ErrorKind::Resource { .. } => Verdict::ResourceError,
                    ErrorKind::Shader(_) | ErrorKind::Internal { .. } => Verdict::InternalError,
                },
            },
            Self::Lost(loss) => match loss {
                Loss::Timeout(_) => Verdict::Timeout,
                Loss::Memory { .. } => Verdict::ResourceError,
                Loss::Garbage(_) | Loss::Died | Loss::NotStarted(_) | Loss::Cancelled => {
                    Verdict::Crash
                }
            },
        }
    }

    /// True if the worker must not be used again. After a panic, too, its state is unknown.
    pub(crate) fn ends_worker(&self) -> bool {
        match self {
            Self::Backend(error) => matches!(
                error,
                BackendError::Failed {
                    kind: ErrorKind::DeviceLost | ErrorKind::Internal { .. },
                    ..
                }
            ),
            Self::Lost(_) => true,
        }
    }
}

impl From<Loss> for Failure {
    fn from(loss: Loss) -> Self {
        Self::Lost(loss)
    }
}
