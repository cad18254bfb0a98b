//! The recorder of the calls of a thread.

use etalon_backend::{
    Argument, CounterPart, NumberForm, Phase, RecordedCall, RecordedContext, RecordedCounter,
    RecordedImage, RecordedPlane, Recording,
};
use etalon_frame::{Aspect, Image};
use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::c_void;

pub(crate) type CallPointer = *const c_void;

thread_local! {
    static RECORDER: RefCell<Option<Recorder>> = const { RefCell::new(None) };
}

/// The number of bytes that stands for all bytes of a memory.
pub(crate) const WHOLE: u32 = u32::MAX;

/// The calls so far.
#[derive(Default)]
struct Recorder {
    /// The driver's functions, by name.
    driver: HashMap<&'static str, usize>,
    /// The phase of the calls; `None` while they are not recorded.
    phase: Option<Phase>,
    calls: Vec<RecordedCall>,
    /// The number of memories that calls have written.
    outputs: u32,
    /// The size of the last memory in bytes.
    last_size: u32,
    /// The memory that the next reads write: its address, number and size.
    open: Option<(usize, u32, u64)>,
    /// The planes that no image has yet.
    planes: Vec<(Aspect, RecordedPlane)>,
    images: Vec<RecordedImage>,
    counters: Vec<RecordedCounter>,
}

/// Starts recording the calls of the context that this thread opens, or no recording if `record` is false.
pub(crate) fn install(record: bool) {
    RECORDER.set(record.then(Recorder::default));
}

/// Returns true if the context of this thread is recorded.
pub(crate) fn is_installed() -> bool {
    with(|_| ()).is_some()
}

/// Records the calls from now on, in a phase.
pub(crate) fn begin(phase: Phase) {
    with(|r| r.phase = Some(phase));
}

/// Stops recording calls.
pub(crate) fn end() {
    with(|r| r.phase = None);
}

/// Announces the memory that the next calls of `glReadPixels` write.
pub(crate) fn memory(bytes: &[u8]) {
    with(|r| {
        let number = r.output(bytes.len() as u64);
        r.open = Some((bytes.as_ptr() as usize, number, bytes.len() as u64));
    });
}

/// Adds a plane of texels in the memory that was announced last.
pub(crate) fn plane(aspect: Aspect, texel: u32, channels: Vec<[u32; 2]>, form: NumberForm) {
    with(|r| {
        if let Some((_, output, _)) = r.open {
            let plane = RecordedPlane {
                output,
                texel,
                channels,
                form,
            };
            r.planes.push((aspect, plane));
        }
    });
}

/// Adds images, each with the planes of its aspect that were added since the last images.
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

/// Adds the counters, before their parts are known.
pub(crate) fn counters(any: impl Iterator<Item = bool>) {
    with(|r| {
        let counter = |any| RecordedCounter {
            parts: Vec::new(),
            any,
        };
        r.counters = any.map(counter).collect();
    });
}

/// Adds a part of the memory that was written last to a counter: `bytes` bytes, or the [`WHOLE`] memory.
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

/// Returns the recording, if calls are recorded.
pub(crate) fn recorded(context: RecordedContext) -> Option<Recording> {
    with(|r| Recording {
        context,
        calls: r.calls.clone(),
        images: r.images.clone(),
        counters: r.counters.clone(),
    })
}

/// Calls a function with the recorder of this thread, if there is one, and returns its result.
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

/// Returns the address of the driver's function that a function of this module replaces.
pub(super) fn driver(name: &'static str) -> usize {
    with(|r| r.driver.get(name).copied())
        .flatten()
        .unwrap_or_default()
}

/// Returns true if calls are recorded at the moment.
pub(super) fn keeps() -> bool {
    with(|r| r.phase.is_some()).unwrap_or(false)
}

/// Records a call, if calls are recorded at the moment.
pub(super) fn keep(function: &str, arguments: Vec<Argument>, result: Option<Argument>) {
    with(|r| {
        if let Some(phase) = r.phase {
            r.calls.push(RecordedCall {
                phase,
                function: function.to_owned(),
                arguments,
                result,
            });
        }
    });
}

/// Returns a new memory that the current call writes.
pub(super) fn new_output(bytes: u64) -> Argument {
    Argument::Output(with(|r| r.output(bytes)).unwrap_or_default(), bytes)
}

/// Returns the memory that was announced at this address, or the null argument.
pub(super) fn announced(address: usize) -> Argument {
    let open = with(|r| r.open).flatten();
    match open.filter(|(start, ..)| *start == address) {
        Some((_, number, size)) => Argument::Output(number, size),
        None => Argument::Null,
    }
}

/// Keeps the address of the driver's function that a function of this module replaces.
pub(super) fn stands_before(name: &'static str, address: CallPointer) {
    with(|r| r.driver.insert(name, address as usize));
}
