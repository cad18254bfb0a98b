//! A backend whose scenes a worker draws, for callers that need a [`Backend`] in this process.

use crate::launch::Launch;
use crate::loss::RequestError;
use crate::process::WorkerProcess;
use crate::protocol::{Hello, Payload, Request};
use crate::supervisor::MAX_FAILED_STARTS;
use crate::worker::Worker;
use etalon_backend::{Backend, BackendError, FrameTime, Prepared};
use etalon_frame::{AdapterInfo, Frame, Limits};
use etalon_scene::Scene;
use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::time::Duration;

/// An adapter in a worker, which is started again after a loss.
pub struct RemoteBackend {
    launch: Launch,
    hello: Hello,
    /// The time that a request may take.
    timeout: Duration,
    process: RefCell<Option<WorkerProcess>>,
    /// A number that changes with each loss, after which scenes must be prepared again.
    generation: Cell<u32>,
    failed_starts: Cell<u32>,
    next_slot: Cell<u32>,
}

/// A scene that the worker has prepared.
struct RemoteScene<'a> {
    backend: &'a RemoteBackend,
    slot: u32,
    generation: u32,
}

impl RemoteBackend {
    /// Returns the adapter of a running worker, which `launch` has started. A request may take as long as `timeout`.
    pub fn new(launch: Launch, worker: Worker, timeout: Duration) -> Self {
        Self {
            launch,
            hello: worker.hello,
            timeout,
            process: RefCell::new(Some(worker.process)),
            generation: Cell::new(0),
            failed_starts: Cell::new(0),
            next_slot: Cell::new(0),
        }
    }

    fn ask(&self, request: Request<'_>) -> Result<Payload, BackendError> {
        let mut process = self.process.borrow_mut();
        if process.is_none() {
            *process = Some(self.restarted()?);
        }
        let Some(worker) = process.as_mut() else {
            return Err(BackendError::internal("no worker is running"));
        };
        let reads = matches!(request, Request::ReadBack { .. });
        let failure = match worker.ask(request, self.timeout) {
            Ok((payload, _)) => return Ok(payload),
            Err(failure) => failure,
        };
        // A scene that was not drawn is an error to read back, and spoils nothing.
        let ends = match &failure {
            RequestError::Backend(error) => error.ends_drawing() && !reads,
            RequestError::Lost(_) => true,
        };
        let error = match failure {
            RequestError::Backend(error) => error,
            RequestError::Lost(loss) => {
                let end = worker.end_of(loss).to_string();
                BackendError::internal_of("the worker was lost", end)
            }
        };
        if ends {
            *process = None;
            self.generation.set(self.generation.get() + 1);
        }
        Err(error)
    }

    fn restarted(&self) -> Result<WorkerProcess, BackendError> {
        let refused = |why| BackendError::internal_of("no worker starts again", why);
        if self.failed_starts.get() >= MAX_FAILED_STARTS {
            return Err(refused("it failed several times".to_owned()));
        }
        match Worker::start(&self.launch) {
            Ok(worker) => {
                self.failed_starts.set(0);
                Ok(worker.process)
            }
            Err(error) => {
                self.failed_starts.set(self.failed_starts.get() + 1);
                Err(refused(error.to_string()))
            }
        }
    }
}

impl Backend for RemoteBackend {
    fn adapter(&self) -> &AdapterInfo {
        &self.hello.info
    }

    fn limits(&self) -> &Limits {
        &self.hello.limits
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        let slot = self.next_slot.replace(self.next_slot.get() + 1);
        let scene = Cow::Borrowed(scene);
        self.ask(Request::Prepare { slot, scene })?;
        Ok(Box::new(RemoteScene {
            backend: self,
            slot,
            generation: self.generation.get(),
        }))
    }
}

impl RemoteScene<'_> {
    fn ask(&self, request: Request<'_>) -> Result<Payload, BackendError> {
        if self.generation != self.backend.generation.get() {
            return Err(BackendError::internal("the worker was lost before"));
        }
        self.backend.ask(request)
    }
}

impl Prepared for RemoteScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let (slot, times) = (self.slot, 1);
        match self.ask(Request::Submit { slot, times })? {
            Payload::Submitted(times) if times.len() == 1 => Ok(times[0]),
            _ => Err(BackendError::internal("the worker gave a wrong answer")),
        }
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        match self.ask(Request::ReadBack { slot: self.slot })? {
            Payload::Frame(frame) => Ok(*frame),
            _ => Err(BackendError::internal("the worker gave a wrong answer")),
        }
    }
}

impl Drop for RemoteScene<'_> {
    fn drop(&mut self) {
        // A worker that was lost has forgotten the scene.
        let _ = self.ask(Request::Drop { slot: self.slot });
    }
}
