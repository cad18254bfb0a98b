//! The frames that a run keeps, of cases that were not entirely right.

use crate::failure::Failure;
use etalon_frame::{Aspect, Frame, Image, ReadPath};
use etalon_record::{AdapterRecord, FrameImage, Machine, Record, Run};
use etalon_scene::Scene;
use std::path::Path;

/// A frame, and who drew it.
pub(crate) struct RecordedFrame {
    pub(crate) machine: Machine,
    pub(crate) adapter: AdapterRecord,
    pub(crate) frame: Frame,
}

/// Returns an adapter's frame of a case's own scene from a run folder. `adapter` can be `None` if the
/// case has one record.
///
/// # Errors
/// If the run keeps no such frame.
pub(crate) fn recorded_frame(
    folder: &Path,
    adapter: Option<&str>,
    case: &str,
    scene: &Scene,
) -> Result<RecordedFrame, Failure> {
    let recorded = Run::read(folder).map_err(Failure::usage)?;
    let refuse = |why: &str| Failure::usage(format!("{}: {why}", folder.display()));
    let named = |record: &&Record| adapter.is_none_or(|name| record.adapter == name);
    let mut records = recorded
        .records
        .iter()
        .filter(|r| r.case == case)
        .filter(named);
    let record = records
        .next()
        .ok_or_else(|| refuse("no such record of this case"))?;
    if records.next().is_some() {
        return Err(refuse(
            "several adapters drew this case; choose one with --adapter",
        ));
    }
    let variant = record
        .story
        .as_ref()
        .and_then(|story| story.ruling.as_ref());
    if variant.is_some_and(|ruling| ruling.variant.is_some()) {
        return Err(refuse("the kept frame is that of a variant of the case"));
    }
    let path = record.frame.as_deref();
    let path = path.ok_or_else(|| refuse("no frame of this case is kept"))?;
    let adapter = recorded.header.adapter(&record.adapter);
    let adapter = adapter.ok_or_else(|| refuse("the header lacks the adapter"))?;
    let file = Run::read_frame(folder, path).map_err(Failure::usage)?;
    if !file.images.iter().all(FrameImage::is_whole) {
        return Err(refuse("the kept frame is damaged"));
    }
    let read = |attachment: &str, aspect: Aspect| {
        // Stencil is exact on every path, so its images declare a copy.
        if aspect == Aspect::Stencil {
            return ReadPath::Copy;
        }
        let mut attachments = scene.attachments.iter();
        let found = attachments.find(|a| a.name == attachment);
        let support = found.and_then(|a| adapter.limits.formats.get(&a.format));
        support.map_or(ReadPath::Copy, |support| support.read)
    };
    let images = file.images.into_iter().map(|image| Image {
        read: read(&image.attachment, image.aspect),
        attachment: image.attachment,
        aspect: image.aspect,
        size: image.size,
        samples: image.samples,
        channels: image.channels,
        codes: image.actual,
    });
    let frame = Frame {
        images: images.collect(),
        counters: record.counters.iter().map(|c| c.actual).collect(),
    };
    Ok(RecordedFrame {
        machine: recorded.header.provenance.machine.clone(),
        adapter: adapter.clone(),
        frame,
    })
}
