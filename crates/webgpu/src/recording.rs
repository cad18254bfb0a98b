//! A list as a recording, from which programs are printed.

use crate::calls::CallList;
use crate::reading::{ImageReading, MappedReading, Place, ReadMethod};
use etalon_backend::{
    Argument, CounterPart, NumberForm, Phase, RecordedCall, RecordedContext, RecordedCounter,
    RecordedImage, RecordedPlane, Recording,
};
use etalon_frame::ChannelEncoding;

/// Returns the recording of a list that was executed on a device. `api` is wgpu's backend, and `features` are
/// the device's, by wgpu's names.
///
/// # Errors
/// If a number in the list is not finite, which JSON cannot represent.
pub fn recording(
    list: &CallList,
    api: &str,
    device: &str,
    features: Vec<String>,
) -> Result<Recording, serde_json::Error> {
    let mut memories = Memories::default();
    let images = list.reading.images.iter().map(|image| RecordedImage {
        attachment: image.attachment.clone(),
        aspect: image.aspect,
        channels: image.channels.clone(),
        size: image.size,
        planes: planes(&mut memories, image),
    });
    let images = images.collect();
    let counters = counters(&mut memories, &list.reading);
    Ok(Recording {
        context: RecordedContext::Wgpu {
            api: api.to_owned(),
            device: device.to_owned(),
            features,
            list: serde_json::to_string(list)?,
        },
        calls: memories.0,
        images,
        counters,
    })
}

/// Texels in the mapped buffer.
#[derive(Clone, Copy)]
struct MappedRows {
    /// The first byte.
    offset: u64,
    /// The distance between rows.
    pitch: u32,
    /// The number of bytes of texels in a row.
    row: u32,
    /// The number of rows.
    rows: u32,
}

/// The copies out of the mapped buffer, each to a memory of its own.
#[derive(Default)]
struct Memories(Vec<RecordedCall>);

impl Memories {
    /// Adds a copy of rows, and returns the number of the memory.
    fn rows(&mut self, rows: MappedRows) -> u32 {
        let bytes = u64::from(rows.row) * u64::from(rows.rows);
        self.add("read_rows", &[rows], bytes)
    }

    /// Adds a copy that gathers bits into bytes. The bits of a byte are 8 bytes of the mapped buffer: four
    /// bytes of a texel in each of two images. Returns the number of the memory.
    fn bits(&mut self, halves: [MappedRows; 2]) -> u32 {
        let [first, _] = halves;
        let bytes = u64::from(first.row / 4) * u64::from(first.rows);
        self.add("read_bits", &halves, bytes)
    }

    fn add(&mut self, function: &str, rows: &[MappedRows], bytes: u64) -> u32 {
        let number = self.0.len() as u32;
        let arguments = |rows: &MappedRows| {
            [
                Argument::Offset(rows.offset),
                Argument::Unsigned(rows.pitch),
                Argument::Unsigned(rows.row),
                Argument::Unsigned(rows.rows),
            ]
        };
        self.0.push(RecordedCall {
            phase: Phase::Read,
            function: function.to_owned(),
            arguments: rows.iter().flat_map(arguments).collect(),
            result: Some(Argument::Output(number, bytes)),
        });
        number
    }
}

/// Returns the places of an image's codes.
fn planes(memories: &mut Memories, image: &ImageReading) -> Vec<RecordedPlane> {
    let texel = image.texel_bytes() as u32;
    let rows = |number: u64| MappedRows {
        offset: image.offset + number * image.image_bytes(),
        pitch: image.pitch,
        row: image.size[0] * texel,
        rows: image.size[1],
    };
    let floats = match image.channels.first() {
        Some(ChannelEncoding::Uint(_)) => NumberForm::Code,
        _ => NumberForm::Float,
    };
    let (texel, channels, form) = match image.method {
        ReadMethod::FetchSamples | ReadMethod::FetchTexel => {
            let each = (0..image.channels.len() as u32).map(|channel| [32 * channel, 32]);
            (texel, each.collect(), floats)
        }
        ReadMethod::FetchDepth => (texel, vec![[0, 32]], NumberForm::Code),
        ReadMethod::StencilBits => (1, vec![[0, 8]], NumberForm::Code),
        ReadMethod::Copy => (texel, image.copied_channels(), NumberForm::Code),
    };
    let outputs: Vec<u32> = match image.method {
        ReadMethod::StencilBits => vec![memories.bits([rows(0), rows(1)])],
        _ => (0..image.samples.into())
            .map(|sample| memories.rows(rows(sample)))
            .collect(),
    };
    let plane = |output| RecordedPlane {
        output,
        texel,
        channels: channels.clone(),
        form,
    };
    outputs.into_iter().map(plane).collect()
}

/// Returns the places of the counters, which share one memory.
fn counters(memories: &mut Memories, reading: &MappedReading) -> Vec<RecordedCounter> {
    let mut counters = Vec::new();
    let mut memory = None;
    for counter in &reading.counters {
        let part = |place: &Place| {
            let bytes = reading.bytes as u32;
            let output = *memory.get_or_insert_with(|| {
                memories.rows(MappedRows {
                    offset: 0,
                    pitch: bytes,
                    row: bytes,
                    rows: 1,
                })
            });
            CounterPart {
                output,
                offset: place.offset as u32,
                bytes: place.bytes as u32,
            }
        };
        counters.push(RecordedCounter {
            parts: counter.parts.iter().map(part).collect(),
            any: counter.any,
        });
    }
    counters
}
