//! Failures of requests to a worker, and the resulting verdicts.

use etalon_backend::BackendError;
use etalon_record::Verdict;
use std::time::Duration;

/// An error from a request to a worker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum RequestError {
    /// The backend's error; the worker still answers.
    Backend(BackendError),
    /// The worker was lost.
    Lost(Loss),
}

/// The way in which a worker was lost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Loss {
    /// The worker did not answer within this time.
    Timeout(Duration),
    /// The worker used `held` MiB of memory, more than its limit.
    Memory { held: u64, limit: u64 },
    /// The worker's output is not a message, or does not answer the request.
    Garbage(String),
    /// The worker's end of the pipe is closed.
    Died,
    /// The worker could not be started; the message states the reason.
    NotStarted(String),
    /// The run is being stopped, so the answer is no longer needed.
    Cancelled,
}

impl RequestError {
    /// Returns the verdict of the case that was being drawn.
    pub(crate) fn verdict(&self) -> Verdict {
        match self {
            Self::Backend(error) => error
                .kind()
                .map_or(Verdict::NotSupported, Verdict::of_error),
            Self::Lost(loss) => match loss {
                Loss::Timeout(_) => Verdict::Timeout,
                Loss::Memory { .. } => Verdict::ResourceError,
                Loss::Garbage(_) | Loss::Died | Loss::NotStarted(_) | Loss::Cancelled => {
                    Verdict::Crash
                }
            },
        }
    }

    /// Returns true if the worker must not be used again.
    pub(crate) fn ends_worker(&self) -> bool {
        match self {
            Self::Backend(error) => error.ends_drawing(),
            Self::Lost(_) => true,
        }
    }
}

impl From<Loss> for RequestError {
    fn from(loss: Loss) -> Self {
        Self::Lost(loss)
    }
}
