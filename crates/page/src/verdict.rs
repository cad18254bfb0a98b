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
    record: Record,
    frame: Option<&FrameFile>,
) -> Result<(Outcome, Vec<u8>), String> {
    let is_kept = record.verdict.is_violation() || record.verdict == Verdict::Flaky;
    let is_kept = is_kept || record.verdict == Verdict::Imprecise;
    let file = match frame.filter(|_| is_kept) {
        Some(frame) => Some(frame_file(frame).map_err(|error| error.to_string())?),
        None => None,
    };
    let line = |record: &Record| record_line(record).map_err(|error| error.to_string());
    let mut complete = record.clone();
    shorten(&mut complete, Shown::Whole, file.is_some());
    complete.frame = file.as_ref().map(|(path, _)| path.clone());
    let mut bytes = line(&complete)?;
    let length = bytes.len();
    if record.verdict == Verdict::Imprecise && file.is_some() {
        let mut short = record;
        shorten(&mut short, Shown::Whole, false);
        bytes.extend(line(&short)?);
    }
    let short = bytes.len() - length;
    let (frame, packed) = file.unzip();
    bytes.extend(packed.unwrap_or_default());
    let outcome = Outcome {
        number,
        verdict: complete.verdict,
        unexpected: complete.unexpected(),
        bad: complete.verdict.is_bad(),
        due: complete.due_fail,
        expected: complete.expected.as_ref().map(|e| e.reason.clone()),
        line: RecordLine::new(&complete),
        length,
        short,
        frame,
    };
    Ok((outcome, bytes))
}
