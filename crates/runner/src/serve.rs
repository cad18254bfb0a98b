//! The worker's side of the protocol: it answers requests until the parent closes the pipe.

use crate::greeting;
use crate::protocol::{Hello, Payload, Request, Response, encode, receive, send};
use etalon_backend::{Backend, BackendError, Prepared, Unavailable};
use std::any::Any;
use std::collections::HashMap;
use std::io::{self, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

/// The time that a worker has to exit by itself after its parent has ended.
const GRACE: Duration = Duration::from_secs(5);
/// The same while the driver is being opened.
const GRACE_OPENING: Duration = Duration::from_secs(1);

/// Opens a backend and answers requests until `input` ends. A hanging driver does not outlive the parent:
/// some seconds after the end of `input`, the process and its group are killed in any case.
///
/// # Errors
/// If the pipe to the parent breaks.
pub fn serve(
    open: impl FnOnce() -> Result<Box<dyn Backend>, Unavailable>,
    input: impl Read + Send + 'static,
    output: &mut impl Write,
) -> io::Result<()> {
    greeting::send(output)?;
    let (sender, requests) = channel();
    let is_open = Arc::<AtomicBool>::default();
    let opened = Arc::clone(&is_open);
    thread::Builder::new().spawn(move || read(input, sender, &opened))?;
    let backend = open();
    is_open.store(true, Ordering::Relaxed);
    let backend = match backend {
        Ok(backend) => backend,
        Err(unavailable) => return send(output, &Response::Hello(Err(unavailable))),
    };
    let hello = Hello {
        info: backend.adapter().clone(),
        limits: backend.limits().clone(),
    };
    send(output, &Response::Hello(Ok(Box::new(hello))))?;
    let mut slots: HashMap<u32, Box<dyn Prepared + '_>> = HashMap::new();
    let mut next = requests.recv().ok();
    while let Some(request) = next {
        let request: Request<'_> = request?;
        let slot = request.slot();
        let is_last = matches!(request, Request::Drop { .. } | Request::Recording { .. });
        let start = Instant::now();
        // A panic is the suite's own bug, not a crash of the driver. The parent starts another worker after
        // it, so that no inconsistent state is used again.
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            answer(backend.as_ref(), &mut slots, request)
        }))
        .unwrap_or_else(|panic| Err(panicked(panic.as_ref())));
        let response = Response::Done {
            slot,
            outcome,
            elapsed: start.elapsed(),
            messages: backend.messages(),
        };
        // The answers of a scene are flushed together, because each flush wakes the parent. Answers that
        // the parent does not need at once wait for the last one.
        let tells = !matches!(&response, Response::Done { outcome: Ok(_), messages, .. } if messages.is_empty());
        output.write_all(&encode(&response)?)?;
        next = requests.try_recv().ok();
        if is_last || tells || next.is_none() {
            output.flush()?;
        }
        if next.is_none() {
            next = requests.recv().ok();
        }
    }
    Ok(())
}

/// Passes requests on until there are no more, then makes sure that the process ends.
fn read(
    mut input: impl Read,
    requests: Sender<io::Result<Request<'static>>>,
    is_open: &AtomicBool,
) {
    loop {
        let message = receive::<Request<'_>>(&mut input).transpose();
        let Some(message) = message else { break };
        let failed = message.is_err();
        if requests.send(message).is_err() || failed {
            break;
        }
    }
    drop(requests);
    let was_open = is_open.load(Ordering::Relaxed);
    thread::sleep(if was_open { GRACE } else { GRACE_OPENING });
    etalon_process::end_group()
}

/// Returns the error that reports a panic.
fn panicked(panic: &(dyn Any + Send)) -> BackendError {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    BackendError::internal_of("the backend panicked", text)
}

fn answer<'b>(
    backend: &'b dyn Backend,
    slots: &mut HashMap<u32, Box<dyn Prepared + 'b>>,
    request: Request<'_>,
) -> Result<Payload, BackendError> {
    let missing = || BackendError::internal("the scene is not prepared");
    match request {
        Request::Prepare { slot, scene } => {
            slots.insert(slot, backend.prepare(&scene)?);
            Ok(Payload::Prepared)
        }
        Request::Submit { slot, times } => {
            let prepared = slots.get_mut(&slot).ok_or_else(missing)?;
            (0..times)
                .map(|_| prepared.submit())
                .collect::<Result<_, _>>()
                .map(Payload::Submitted)
        }
        Request::ReadBack { slot } => {
            let prepared = slots.get_mut(&slot).ok_or_else(missing)?;
            prepared.read_back().map(Box::new).map(Payload::Frame)
        }
        Request::Drop { slot } => {
            slots.remove(&slot);
            Ok(Payload::Dropped)
        }
        Request::Recording { .. } => Ok(Payload::Recording(backend.recording().map(Box::new))),
    }
}
