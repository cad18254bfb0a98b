//! The messages of the page to the suite, and the answers.

use etalon_record::{Machine, Verdict};
use etalon_report::RecordLine;
use etalon_webgpu::message::Hello;
use serde::{Deserialize, Serialize};

/// The header of a message.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Ask {
    /// Asks what a run would draw. The answer is a [`Choice`].
    Choose(Box<Choosing>),
    /// Begins a run on a device. The answer is [`Opened`].
    Open(Box<Opening>),
    /// Reports the result of a round trip. The bytes are its record's line.
    Trip { number: usize },
    /// Asks for the requests of a case. The answer is a [`NextStep`].
    Draw { number: usize },
    /// Reports what the device answered to the requests. The bytes are its answers. The answer is a [`NextStep`].
    Judge(DeviceAnswers),
    /// Asks for the record of a case that is judged, which took this many seconds. The answer is a [`NextStep`].
    Record { number: usize, seconds: f64 },
    /// Asks for a record as HTML, the answer's bytes. The bytes are its line, and its compressed frame if it has one.
    View { line: usize },
    /// Asks for the charts of a run's methods. The bytes are its `run.jsonl`, of this length, and its pictures: each
    /// has a path and a length. The answer is a [`Charts`].
    Methods {
        lines: usize,
        pictures: Vec<(String, usize)>,
    },
}

/// A selection, and what the browser tells about its device before anything is drawn.
#[derive(Debug, Deserialize)]
pub(crate) struct Choosing {
    pub(crate) globs: Vec<String>,
    /// `quick` or `full`.
    pub(crate) profile: String,
    /// `None` if the browser has no device.
    pub(crate) hello: Option<Hello>,
}

/// What a run would draw.
#[derive(Debug, Serialize)]
pub(crate) struct Choice {
    /// The number of selected cases.
    pub(crate) cases: usize,
    pub(crate) device: Option<PageDevice>,
}

/// The device that draws, and its adapter's name.
#[derive(Debug, Serialize)]
pub(crate) struct PageDevice {
    pub(crate) adapter: String,
    pub(crate) device: String,
    pub(crate) driver: String,
    pub(crate) software: bool,
}

/// The selection and the device of a run.
#[derive(Debug, Deserialize)]
pub(crate) struct Opening {
    pub(crate) globs: Vec<String>,
    /// `quick` or `full`.
    pub(crate) profile: String,
    pub(crate) hello: Hello,
    /// A planted fault as at the end of an adapter's name, such as `read-fault=off-by-one`; empty for none.
    #[serde(default)]
    pub(crate) fault: String,
    pub(crate) machine: Machine,
    /// The start of the run, RFC 3339 in UTC.
    pub(crate) started: String,
    pub(crate) command: Vec<String>,
    /// The round trips that the cases depend on, from the answer to the first opening.
    #[serde(default)]
    pub(crate) trips: Option<Vec<String>>,
}

/// A run that has begun.
#[derive(Debug, Serialize)]
pub(crate) struct Opened {
    /// The ids of the selected cases.
    pub(crate) cases: Vec<String>,
    /// The round trips that the cases depend on.
    pub(crate) trips: Vec<String>,
    /// The number of each round trip. Numbers after the selected cases are not recorded.
    pub(crate) first: Vec<usize>,
    /// The number of matching cases that are left out because they are measured.
    pub(crate) measured: usize,
    /// True if frames are timed, so that nothing else is drawn or judged meanwhile.
    pub(crate) timed: bool,
    /// The first line of `run.jsonl`.
    pub(crate) header: String,
    #[serde(flatten)]
    pub(crate) device: PageDevice,
}

/// The next step of a case.
#[derive(Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum NextStep {
    /// The device must answer the requests, which are the bytes.
    Requests {
        lengths: Vec<usize>,
        /// True if a fresh device must answer.
        renew: bool,
    },
    /// The case is judged, and [`Ask::Record`] gives the record.
    Judged {
        /// True if this device must not draw anything else.
        renew: bool,
    },
    /// The record.
    Outcome(PageRecord),
}

/// The answers of a device.
#[derive(Debug, Deserialize)]
pub(crate) struct DeviceAnswers {
    pub(crate) number: usize,
    /// The time that drawing took.
    pub(crate) seconds: f64,
    /// The lengths of the answers to the requests, up to the first failure.
    pub(crate) answers: Vec<usize>,
    /// True if the device did not answer in time.
    #[serde(default)]
    pub(crate) timeout: bool,
    /// The steps of the browser's clock, in seconds.
    #[serde(default)]
    pub(crate) clock: f64,
}

/// The charts of methods. The bytes are their HTML.
#[derive(Debug, Serialize)]
pub(crate) struct Charts {
    /// Their style sheet.
    pub(crate) style: String,
}

/// A record.
#[derive(Debug, Serialize)]
pub(crate) struct PageRecord {
    pub(crate) number: usize,
    pub(crate) verdict: Verdict,
    /// True if the record counts against the run.
    pub(crate) unexpected: bool,
    /// True if the verdict is bad.
    pub(crate) bad: bool,
    /// True if the case is a selftest that must fail.
    pub(crate) due: bool,
    /// The reason why the verdict is expected.
    pub(crate) expected: Option<String>,
    #[serde(flatten)]
    pub(crate) line: RecordLine,
    /// The length of the record's line, which comes first in the bytes.
    pub(crate) length: usize,
    /// The length of the line if the frame is not kept, which comes next; 0 if the frame must be kept.
    pub(crate) short: usize,
    /// The length of the tile, which comes next: red, green and blue of 16×16 texels; 0 if nothing was drawn.
    pub(crate) tile: usize,
    /// The paths and lengths of pictures, which come next.
    pub(crate) pictures: Vec<(String, usize)>,
    /// The path of the frame, whose file is the rest of the bytes.
    pub(crate) frame: Option<String>,
}

/// Returns the parts of a message that have these lengths.
///
/// # Errors
/// If the message is too short.
pub(crate) fn split<'b>(mut bytes: &'b [u8], lengths: &[usize]) -> Result<Vec<&'b [u8]>, String> {
    let mut parts = Vec::new();
    for length in lengths {
        let split = bytes.split_at_checked(*length);
        let (part, rest) = split.ok_or_else(|| "a message is too short".to_owned())?;
        parts.push(part);
        bytes = rest;
    }
    Ok(parts)
}
