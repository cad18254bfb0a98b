//! One record, for pages that show records as they are made.

use super::index::detail::{DetailBudget, DrawnFrame, body};
use crate::mark::class;
use crate::words::{self, Tone};
use etalon_record::{FrameFile, Record};
use serde::Serialize;

/// A record as a cell and a line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RecordLine {
    /// The sign of the verdict.
    pub symbol: &'static str,
    /// The verdict in words, and how it relates to expectations.
    pub word: String,
    /// The class that colours the verdict in the style of reports.
    pub class: &'static str,
    /// The most informative line about the record.
    pub headline: String,
}

impl RecordLine {
    /// Returns the line of a record.
    pub fn new(record: &Record) -> Self {
        let tone = Tone::of(record);
        Self {
            symbol: words::symbol(record.verdict),
            word: format!("{}{}", words::name(record.verdict), tone.suffix()),
            class: class(record.verdict, tone),
            headline: words::headline(record),
        }
    }
}

/// Returns everything about a record as HTML, as the page of its run shows it. All texts are escaped.
pub fn record_html(record: &Record, frame: Option<FrameFile>) -> String {
    let drawn = frame.map(|frame| DrawnFrame::new(Ok(frame)));
    body(record, drawn.as_ref(), &mut DetailBudget::default()).into_string()
}
