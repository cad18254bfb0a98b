//! The worker's side: draws what it is asked to, until the parent closes the pipe.

use crate::protocol::{Hello, Payload, Request, Response, receive, send};
use etalon_backend::{Backend, BackendError, Prepared, Unavailable};
use std::any::Any;
use std::collections::HashMap;
use std::io::{self, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// Opens a backend and answers requests until `input` ends.
///
/// # Errors
/// When the pipe to the parent breaks.
pub fn serve(
    open: impl FnOnce() -> Result<Box<dyn Backend>, Unavailable>,
    input: &mut impl Read,
    output: &mut impl Write,
) -> io::Result<()> {
    let backend = match open() {
        Ok(backend) => backend,
        Err(unavailable) => return send(output, &Response::Hello(Err(unavailable))),
    };
    let hello = Hello {
        info: backend.adapter().clone(),
        limits: backend.limits().clone(),
    };
    send(output, &Response::Hello(Ok(Box::new(hello))))?;
    let mut slots: HashMap<u32, Box<dyn Prepared + '_>> = HashMap::new();
    while let Some(request) = receive::<Request>(input)? {
        let start = Instant::now();
        // A panic is the suite's own bug and no crash of the driver. The parent starts another
        // worker behind it, so that nothing half done is used again.
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            answer(backend.as_ref(), &mut slots, request)
        }))
        .unwrap_or_else(|panic| Err(BackendError::Internal(words(panic.as_ref()))));
        let response = Response::Done {
            outcome,
            elapsed: start.elapsed(),
            messages: backend.messages(),
        };
        send(output, &response)?;
    }
    Ok(())
}

/// What a panic said.
fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    format!("the backend panicked: {text}")
}

fn answer<'b>(
    backend: &'b dyn Backend,
    slots: &mut HashMap<u32, Box<dyn Prepared + 'b>>,
    request: Request,
) -> Result<Payload, BackendError> {
    let missing = || BackendError::Internal("the scene is not prepared".to_owned());
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
    }
}
