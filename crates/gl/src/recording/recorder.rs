//! The recorder of the calls of a thread.

use etalon_backend::{
    Argument, Call, CounterPart, Form, Phase, Plane, RecordedContext, RecordedCounter,
    RecordedImage, Recording,
};
use etalon_frame::{Aspect, Image};
use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::c_void;

pub(crate) type Pointer = *const c_void;

thread_local! {
    static RECORDER: RefCell<Option<Recorder>> = const { RefCell::new(None) };
}

/// The size of a memory, whatever it is.
pub(crate) const WHOLE: u32 = u32::MAX;

/// The calls so far.
#[derive(Default)]
struct Recorder {
    /// The driver's own functions.
    driver: HashMap<&'static str, usize>,
    /// The phase of the calls; `None` while they are not kept.
    phase: Option<Phase>,
    calls: Vec<Call>,
    /// The memories that calls wrote to.
    outputs: u32,
    /// The size of the last one in bytes.
    last_size: u32,
    /// The memory that is to be written to next: its address, number and size.
    open: Option<(usize, u32, u64)>,
    /// The planes that belong to no image yet.
    planes: Vec<(Aspect, Plane)>,
    images: Vec<RecordedImage>,
    counters: Vec<RecordedCounter>,
}

/// Prepares to record the context that is opened on this thread, or not to.
pub(crate) fn install(record: bool) {
    RECORDER.set(record.then(Recorder::default));
}

/// True if the context of this thread was opened to record.
pub(crate) fn is_installed() -> bool {
    with(|_| ()).is_some()
}

/// Keeps the calls from now on, as those of a phase.
pub(crate) fn begin(phase: Phase) {
    with(|r| r.phase = Some(phase));
}

/// Keeps no call any more.
pub(crate) fn end() {
    with(|r| r.phase = None);
}

/// Announces the memory that the next calls of `glReadPixels` write to.
pub(crate) fn memory(bytes: &[u8]) {
    with(|r| {
        let number = r.output(bytes.len() as u64);
        r.open = Some((bytes.as_ptr() as usize, number, bytes.len() as u64));
    });
}

/// Notes a plane of texels in the memory that was announced last.
pub(crate) fn plane(aspect: Aspect, texel: u32, channels: Vec<[u32; 2]>, form: Form) {
    with(|r| {
        if let Some((_, output, _)) = r.open {
            let plane = Plane {
                output,
                texel,
                channels,
                form,
            };
            r.planes.push((aspect, plane));
        }
    });
}

/// Names the images that the planes since the last images make up.
pub(crate) fn images(images: &[Image]) {
    with(|r| {
        let planes = std::mem::take(&mut r.planes);
        for image in images {
            let found = planes.iter().filter(|(aspect, _)| *aspect == image.aspect);
            r.images.push(RecordedImage {
                attachment: image.attachment.clone(),
                aspect: image.aspect,
                channels: image.channels.clone(),
                size: image.size,
                planes: found.map(|(_, plane)| plane.clone()).collect(),
            });
        }
    });
}

/// Notes the counters before their parts are known.
pub(crate) fn counters(any: impl Iterator<Item = bool>) {
    with(|r| {
        let counter = |any| RecordedCounter {
            parts: Vec::new(),
            any,
        };
        r.counters = any.map(counter).collect();
    });
}

/// Adds bytes of the memory that was written last to a counter, or the [`WHOLE`] of it.
pub(crate) fn counter_part(index: usize, offset: u32, bytes: u32) {
    with(|r| {
        let output = r.outputs.saturating_sub(1);
        let bytes = match bytes {
            WHOLE => r.last_size,
            bytes => bytes,
        };
        if let Some(counter) = r.counters.get_mut(index) {
            counter.parts.push(CounterPart {
                output,
                offset,
                bytes,
            });
        }
    });
}

/// Returns what was recorded.
pub(crate) fn recorded(context: RecordedContext) -> Option<Recording> {
    with(|r| Recording {
        context,
        calls: r.calls.clone(),
        images: r.images.clone(),
        counters: r.counters.clone(),
    })
}

/// Returns what a function makes of the recorder of this thread, if there is one.
fn with<R>(call: impl FnOnce(&mut Recorder) -> R) -> Option<R> {
    RECORDER.with_borrow_mut(|recorder| recorder.as_mut().map(call))
}

impl Recorder {
    /// Returns the number of a new memory.
    fn output(&mut self, bytes: u64) -> u32 {
        self.last_size = u32::try_from(bytes).unwrap_or(u32::MAX);
        self.outputs += 1;
        self.outputs - 1
    }
}

/// Returns the driver's own function behind one of this module's, which the backend found in its place.
pub(super) fn driver(name: &'static str) -> usize {
    with(|r| r.driver.get(name).copied())
        .flatten()
        .unwrap_or_default()
}

/// True if calls are kept.
pub(super) fn keeps() -> bool {
    with(|r| r.phase.is_some()).unwrap_or(false)
}

/// Keeps a call.
pub(super) fn keep(function: &str, arguments: Vec<Argument>, result: Option<Argument>) {
    with(|r| {
        if let Some(phase) = r.phase {
            r.calls.push(Call {
                phase,
                function: function.to_owned(),
                arguments,
                result,
            });
        }
    });
}

/// Returns a memory of the call that is made: a new one.
pub(super) fn new_output(bytes: u64) -> Argument {
    Argument::Output(with(|r| r.output(bytes)).unwrap_or_default(), bytes)
}

/// Returns the memory that was announced at an address.
pub(super) fn announced(address: usize) -> Argument {
    let open = with(|r| r.open).flatten();
    match open.filter(|(start, ..)| *start == address) {
        Some((_, number, size)) => Argument::Output(number, size),
        None => Argument::Null,
    }
}

/// Keeps the address of a driver's function behind one of this module's.
pub(super) fn stands_before(name: &'static str, address: Pointer) {
    with(|r| r.driver.insert(name, address as usize));
}
