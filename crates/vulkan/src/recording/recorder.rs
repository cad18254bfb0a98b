//! The recorder of the calls of a thread.

use super::needed::Needed;
use ash::vk;
use etalon_backend::{
    Argument, CounterPart, Phase, RecordedCall, RecordedContext, RecordedCounter, RecordedImage,
    RecordedPlane, Recording,
};
use etalon_frame::Image;
use std::cell::RefCell;
use std::collections::HashMap;

thread_local! {
    static RECORDER: RefCell<Option<Recorder>> = const { RefCell::new(None) };
}

/// The calls so far.
struct Recorder {
    /// The driver's functions, by name.
    driver: HashMap<&'static str, usize>,
    phase: Phase,
    calls: Vec<RecordedCall>,
    /// The number of memory regions that calls have written to.
    outputs: u32,
    memory: vk::PhysicalDeviceMemoryProperties,
    images: Vec<RecordedImage>,
    counters: Vec<RecordedCounter>,
    needed: Needed,
    /// The first thing that could not be represented.
    failed: Option<String>,
}

/// Starts recording the calls of the device that this thread opens, or no recording if `record` is false.
pub(crate) fn install(record: bool) {
    RECORDER.set(record.then(|| Recorder {
        driver: HashMap::new(),
        phase: Phase::Prepare,
        calls: Vec::new(),
        outputs: 0,
        memory: vk::PhysicalDeviceMemoryProperties::default(),
        images: Vec::new(),
        counters: Vec::new(),
        needed: Needed::default(),
        failed: None,
    }));
}

/// Calls a function with the recorder of this thread, if there is one, and returns its result.
fn with<R>(call: impl FnOnce(&mut Recorder) -> R) -> Option<R> {
    RECORDER.with_borrow_mut(|recorder| recorder.as_mut().map(call))
}

/// Returns true if the device of this thread is recorded.
pub(crate) fn is_installed() -> bool {
    with(|_| ()).is_some()
}

/// Assigns the calls from now on to a phase.
pub(crate) fn phase(phase: Phase) {
    with(|r| r.phase = phase);
}

/// Sets the memory types of the device.
pub(crate) fn memory_types(properties: &vk::PhysicalDeviceMemoryProperties) {
    with(|r| r.memory = *properties);
}

/// Sets what the scene needs.
pub(crate) fn needs(needed: Needed) {
    with(|r| r.needed = needed);
}

/// Returns the properties of a memory type as bits.
pub(super) fn flags_of(memory_type: u32) -> u32 {
    let flags = |r: &mut Recorder| {
        let types = r.memory.memory_types_as_slice();
        types
            .get(memory_type as usize)
            .map(|t| t.property_flags.as_raw())
    };
    with(flags).flatten().unwrap_or_default()
}

/// Records the bytes that the host wrote to mapped memory.
pub(crate) fn written(mapped: *const u8, offset: u64, bytes: &[u8]) {
    keep("write", || {
        vec![
            memory(mapped),
            Argument::Size(offset.cast_signed()),
            Argument::Bytes(bytes.to_vec()),
        ]
    });
}

/// Records that the host read mapped memory. The bytes go to a new memory.
pub(crate) fn read(mapped: *const u8, offset: u64, length: usize) {
    let output = new_output(length as u64);
    keep("read", || {
        vec![output, memory(mapped), Argument::Size(offset.cast_signed())]
    });
}

fn memory(mapped: *const u8) -> Argument {
    Argument::Object("mapped".to_owned(), mapped.addr() as u64)
}

/// Records the image whose texels are in the memory that was read last.
pub(crate) fn image(image: &Image, planes: impl Iterator<Item = RecordedPlane>) {
    with(|r| {
        let output = r.outputs.saturating_sub(1);
        r.images.push(RecordedImage {
            attachment: image.attachment.clone(),
            aspect: image.aspect,
            channels: image.channels.clone(),
            size: image.size,
            planes: planes
                .map(|plane| RecordedPlane { output, ..plane })
                .collect(),
        });
    });
}

/// Adds the counters, before their parts are known.
pub(crate) fn counters(any: impl Iterator<Item = bool>) {
    let counter = |any| RecordedCounter {
        parts: Vec::new(),
        any,
    };
    with(|r| r.counters = any.map(counter).collect());
}

/// Adds bytes of the memory that was read last to a counter.
pub(crate) fn counter_part(index: usize, offset: u32, bytes: u32) {
    with(|r| {
        let output = r.outputs.saturating_sub(1);
        if let Some(counter) = r.counters.get_mut(index) {
            counter.parts.push(CounterPart {
                output,
                offset,
                bytes,
            });
        }
    });
}

/// Returns the recording, or `None` if something could not be represented.
pub(crate) fn recorded(device: &str, version: u32) -> Option<Recording> {
    with(|r| match r.failed {
        Some(_) => None,
        None => Some(Recording {
            context: RecordedContext::Vulkan {
                device: device.to_owned(),
                version,
                needs: r.needed.further.clone(),
            },
            calls: {
                let mut calls = r.calls.clone();
                calls.iter_mut().for_each(|call| r.needed.narrow(call));
                calls
            },
            images: r.images.clone(),
            counters: r.counters.clone(),
        }),
    })
    .flatten()
}

/// Records that something could not be represented.
pub(super) fn fail(what: &str) {
    with(|r| r.failed.get_or_insert_with(|| what.to_owned()).clone());
}

/// Returns the address of the driver's function that a function of this module replaces.
pub(super) fn driver(name: &'static str) -> usize {
    with(|r| r.driver.get(name).copied())
        .flatten()
        .unwrap_or_default()
}

/// Keeps the address of the driver's function that a function of this module replaces.
pub(super) fn stands_before(name: &'static str, address: usize) {
    with(|r| r.driver.insert(name, address));
}

/// Records a call.
pub(super) fn keep(function: &str, arguments: impl FnOnce() -> Vec<Argument>) {
    if !is_installed() {
        return;
    }
    let arguments = arguments();
    with(|r| {
        r.calls.push(RecordedCall {
            phase: r.phase,
            function: function.to_owned(),
            arguments,
            result: None,
        });
    });
}

/// Returns a new memory that the current call writes.
pub(super) fn new_output(bytes: u64) -> Argument {
    let number = with(|r| {
        r.outputs += 1;
        r.outputs - 1
    });
    Argument::Output(number.unwrap_or_default(), bytes)
}
