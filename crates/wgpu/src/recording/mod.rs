//! The calls of a scene, from the trace that wgpu writes of a device: what its core was asked, whoever asked.
//!
//! Mapping a buffer is no part of a trace, so the places of texels and counts come from the read-back.

mod ron;

use etalon_backend::{
    Argument, Call, Phase, Plane, RecordedContext, RecordedCounter, RecordedImage, Recording, Tree,
};
use std::cell::RefCell;
use std::path::Path;
use tempfile::TempDir;

/// The folder of a trace, and what was read.
pub(crate) struct Recorder {
    folder: TempDir,
    read: RefCell<Read>,
}

/// The copies out of the mapped buffer.
#[derive(Default)]
struct Read {
    calls: Vec<Call>,
    images: Vec<RecordedImage>,
    counters: Vec<RecordedCounter>,
}

/// Texels in the mapped buffer.
#[derive(Clone, Copy)]
pub(crate) struct Rows {
    /// The first byte.
    pub(crate) offset: u64,
    /// The distance between rows.
    pub(crate) pitch: u32,
    /// The bytes of a row that are texels.
    pub(crate) row: u32,
    /// The number of rows.
    pub(crate) rows: u32,
}

impl Recorder {
    pub(crate) fn new() -> std::io::Result<Self> {
        Ok(Self {
            folder: tempfile::tempdir()?,
            read: RefCell::default(),
        })
    }

    pub(crate) fn trace(&self) -> wgpu::Trace {
        wgpu::Trace::Directory(self.folder.path().to_owned())
    }

    /// Forgets an earlier read-back.
    pub(crate) fn begin(&self) {
        self.read.take();
    }

    /// Notes rows that are copied from the mapped buffer. Returns the number of the memory.
    pub(crate) fn rows(&self, rows: Rows) -> u32 {
        self.output(
            "read_rows",
            &[rows],
            u64::from(rows.row) * u64::from(rows.rows),
        )
    }

    /// Notes bytes whose bits are 8 bytes of the mapped buffer: four to a texel, in two images. Returns the number of
    /// the memory.
    pub(crate) fn bits(&self, halves: [Rows; 2]) -> u32 {
        let [first, _] = halves;
        self.output(
            "read_bits",
            &halves,
            u64::from(first.row / 4) * u64::from(first.rows),
        )
    }

    fn output(&self, function: &str, rows: &[Rows], bytes: u64) -> u32 {
        let mut read = self.read.borrow_mut();
        let number = read.calls.len() as u32;
        let arguments = |rows: &Rows| {
            [
                Argument::Offset(rows.offset),
                Argument::Unsigned(rows.pitch),
                Argument::Unsigned(rows.row),
                Argument::Unsigned(rows.rows),
            ]
        };
        read.calls.push(Call {
            phase: Phase::Read,
            function: function.to_owned(),
            arguments: rows.iter().flat_map(arguments).collect(),
            result: Some(Argument::Output(number, bytes)),
        });
        number
    }

    pub(crate) fn image(&self, image: &etalon_frame::Image, planes: Vec<Plane>) {
        self.read.borrow_mut().images.push(RecordedImage {
            attachment: image.attachment.clone(),
            aspect: image.aspect,
            channels: image.channels.clone(),
            size: image.size,
            planes,
        });
    }

    pub(crate) fn counters(&self, counters: Vec<RecordedCounter>) {
        self.read.borrow_mut().counters = counters;
    }

    /// Returns what was recorded, or why the trace cannot be read.
    pub(crate) fn recording(&self, api: &str, device: &str) -> Result<Recording, String> {
        let path = self.folder.path().join("trace.ron");
        let text = std::fs::read_to_string(path).map_err(|e| e.to_string())?;
        let mut actions = ron::values(&text)?;
        for action in &mut actions {
            fill(action, self.folder.path())?;
        }
        let is_submit = |action: &Tree| action.name() == "Submit";
        let last = actions.iter().rposition(is_submit);
        let mut drawn = false;
        let mut calls = Vec::new();
        for (place, action) in actions.into_iter().enumerate() {
            let submits = is_submit(&action);
            let phase = match (submits, drawn) {
                (true, _) if Some(place) != last => Phase::Submit,
                (false, false) => Phase::Prepare,
                _ => Phase::Read,
            };
            drawn |= submits;
            calls.push(Call {
                phase,
                function: action.name().to_owned(),
                arguments: vec![Argument::Tree(action)],
                result: None,
            });
        }
        let read = self.read.borrow();
        calls.extend(read.calls.iter().cloned());
        Ok(Recording {
            context: RecordedContext::Wgpu {
                api: api.to_owned(),
                device: device.to_owned(),
            },
            calls,
            images: read.images.clone(),
            counters: read.counters.clone(),
        })
    }
}

/// Puts the content of a file in the trace's folder in the place of its name.
fn fill(value: &mut Tree, folder: &Path) -> Result<(), String> {
    match value {
        Tree::Tuple(name, parts) if name == "File" => {
            let [Tree::Text(file)] = parts.as_slice() else {
                return Err("a file of a trace has no name".to_owned());
            };
            let content = std::fs::read(folder.join(file)).map_err(|e| e.to_string())?;
            *value = if file.ends_with(".wgsl") {
                Tree::Text(String::from_utf8(content).map_err(|e| e.to_string())?)
            } else {
                Tree::Bytes(content)
            };
            Ok(())
        }
        Tree::Tuple(_, parts) | Tree::List(parts) => {
            parts.iter_mut().try_for_each(|part| fill(part, folder))
        }
        Tree::Structure(_, fields) => {
            let mut values = fields.iter_mut().map(|(_, value)| value);
            values.try_for_each(|value| fill(value, folder))
        }
        _ => Ok(()),
    }
}
