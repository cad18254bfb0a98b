//! A judged drawing, and its record as lines and a file.

use crate::message::PageRecord;
use etalon_judge::{ShownDetail, shorten};
use etalon_record::{FrameFile, Record, Verdict, frame_file, record_line};
use etalon_report::RecordLine;

/// A judged drawing.
pub(crate) struct PageObservation {
    pub(crate) record: Record,
    pub(crate) frame: Option<FrameFile>,
    /// The picture in the mosaic; empty if nothing was drawn.
    pub(crate) tile: Vec<u8>,
    /// The paths and files of pictures.
    pub(crate) pictures: Vec<(String, Vec<u8>)>,
    /// True if the device must not draw anything else.
    pub(crate) ends_device: bool,
}

impl PageObservation {
    /// Returns a record without a frame.
    pub(crate) fn of(record: Record) -> Self {
        Self {
            record,
            frame: None,
            tile: Vec::new(),
            pictures: Vec::new(),
            ends_device: false,
        }
    }
}

/// Returns a judged drawing as an outcome, and its lines, tile, pictures and frame file as bytes.
///
/// # Errors
/// If the record cannot be shortened enough.
pub(crate) fn outcome(
    number: usize,
    observed: PageObservation,
) -> Result<(PageRecord, Vec<u8>), String> {
    let PageObservation {
        mut record,
        frame,
        tile,
        pictures,
        ..
    } = observed;
    let is_kept = record.verdict.is_violation() || record.verdict == Verdict::Flaky;
    let is_kept = is_kept || record.verdict == Verdict::Imprecise;
    let file = match frame.filter(|_| is_kept) {
        Some(frame) => Some(frame_file(&frame).map_err(|error| error.to_string())?),
        None => None,
    };
    let line = |record: &Record| record_line(record).map_err(|error| error.to_string());
    let short_line = if record.verdict == Verdict::Imprecise && file.is_some() {
        let mut short = record.clone();
        shorten(&mut short, ShownDetail::Whole, false);
        line(&short)?
    } else {
        Vec::new()
    };
    shorten(&mut record, ShownDetail::Whole, file.is_some());
    record.frame = file.as_ref().map(|(path, _)| path.clone());
    let mut bytes = line(&record)?;
    let (length, short) = (bytes.len(), short_line.len());
    bytes.extend(short_line);
    bytes.extend(&tile);
    let pictures = pictures.into_iter().map(|(path, file)| {
        bytes.extend(&file);
        (path, file.len())
    });
    let pictures = pictures.collect();
    let (frame, packed) = file.unzip();
    bytes.extend(packed.unwrap_or_default());
    let outcome = PageRecord {
        number,
        verdict: record.verdict,
        unexpected: record.unexpected(),
        bad: record.verdict.is_bad(),
        due: record.due_fail,
        expected: record.expected.as_ref().map(|e| e.reason.clone()),
        line: RecordLine::new(&record),
        length,
        short,
        tile: tile.len(),
        pictures,
        frame,
    };
    Ok((outcome, bytes))
}
