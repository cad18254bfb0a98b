//! A judged drawing, and its record as lines and a file.

use crate::message::Outcome;
use etalon_judge::{Shown, shorten};
use etalon_record::{FrameFile, Record, Verdict, frame_file, record_line};
use etalon_report::RecordLine;

/// A judged drawing.
pub(crate) struct Observation {
    pub(crate) record: Record,
    pub(crate) frame: Option<FrameFile>,
    /// True if the device must not draw anything else.
    pub(crate) ends_device: bool,
}

/// Returns a record as an outcome, and its lines and its frame file as bytes.
///
/// # Errors
/// If the record cannot be shortened enough.
pub(crate) fn outcome(
    number: usize,
    mut record: Record,
    frame: Option<&FrameFile>,
) -> Result<(Outcome, Vec<u8>), String> {
    let is_kept = record.verdict.is_violation() || record.verdict == Verdict::Flaky;
    let is_kept = is_kept || record.verdict == Verdict::Imprecise;
    let file = match frame.filter(|_| is_kept) {
        Some(frame) => Some(frame_file(frame).map_err(|error| error.to_string())?),
        None => None,
    };
    let line = |record: &Record| record_line(record).map_err(|error| error.to_string());
    let short_line = if record.verdict == Verdict::Imprecise && file.is_some() {
        let mut short = record.clone();
        shorten(&mut short, Shown::Whole, false);
        line(&short)?
    } else {
        Vec::new()
    };
    shorten(&mut record, Shown::Whole, file.is_some());
    record.frame = file.as_ref().map(|(path, _)| path.clone());
    let mut bytes = line(&record)?;
    let (length, short) = (bytes.len(), short_line.len());
    bytes.extend(short_line);
    let (frame, packed) = file.unzip();
    bytes.extend(packed.unwrap_or_default());
    let outcome = Outcome {
        number,
        verdict: record.verdict,
        unexpected: record.unexpected(),
        bad: record.verdict.is_bad(),
        due: record.due_fail,
        expected: record.expected.as_ref().map(|e| e.reason.clone()),
        line: RecordLine::new(&record),
        length,
        short,
        frame,
    };
    Ok((outcome, bytes))
}
