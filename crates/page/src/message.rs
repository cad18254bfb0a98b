//! The messages of the page to the suite, and the answers.

use etalon_record::{Machine, Verdict};
use etalon_report::RecordLine;
use etalon_webgpu::message::Hello;
use serde::{Deserialize, Serialize};

/// The header of a message.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Ask {
    /// Begins a run on a device. The answer is [`Opened`].
    Open(Box<Opening>),
    /// Reports the result of a round trip. The bytes are its record's line.
    Trip { number: usize },
    /// Asks for the requests of a case. The answer is [`Drawing`].
    Draw { number: usize },
    /// Asks for the record of a case that was drawn. The bytes are the device's answers. The answer is [`Judging`].
    Judge(Drawn),
    /// Asks for a record as HTML, the answer's bytes. The bytes are its line, and its compressed frame if it has one.
    View { line: usize },
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
    /// The first line of `run.jsonl`.
    pub(crate) header: String,
    /// The name of the adapter.
    pub(crate) adapter: String,
    pub(crate) device: String,
    pub(crate) driver: String,
    pub(crate) software: bool,
}

/// A case to draw.
#[derive(Debug, Serialize)]
pub(crate) enum Drawing {
    /// The lengths of the requests, which are the bytes.
    #[serde(rename = "requests")]
    Requests(Vec<usize>),
    /// The case is not drawn.
    #[serde(rename = "outcome")]
    Undrawn(Outcome),
}

/// A case that was drawn.
#[derive(Debug, Deserialize)]
pub(crate) struct Drawn {
    pub(crate) number: usize,
    /// The time that drawing took.
    pub(crate) seconds: f64,
    /// The lengths of the answers to the requests, up to the first failure.
    pub(crate) answers: Vec<usize>,
    /// True if the device did not answer in time.
    #[serde(default)]
    pub(crate) timeout: bool,
}

/// The judgement of a drawing.
#[derive(Debug, Serialize)]
pub(crate) struct Judging {
    /// The record, unless the case must be drawn again.
    pub(crate) outcome: Option<Outcome>,
    /// True if this device must not draw anything else. If there is no outcome, the case is drawn again on a fresh
    /// one.
    pub(crate) renew: bool,
}

/// A record.
#[derive(Debug, Serialize)]
pub(crate) struct Outcome {
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
    /// The path of the frame, whose file is the rest of the bytes.
    pub(crate) frame: Option<String>,
}
