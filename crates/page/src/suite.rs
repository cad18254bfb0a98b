//! Answering messages.

use crate::message::{Ask, Charts, split};
use crate::opening::{choice, open};
use crate::session::Session;
use etalon_record::{FrameFile, Record, Run};
use etalon_report::{methods_html, record_html};
use etalon_webgpu::message::{packed, unpacked};
use flate2::read::GzDecoder;
use serde::Serialize;
use serde_json::json;
use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

/// The maximum number of bytes of a frame that is shown.
const MAX_FRAME: u64 = 256 << 20;

/// The state of a worker of the page: empty before a run begins.
#[derive(Default)]
pub struct Suite {
    session: Option<Session>,
}

impl Suite {
    /// Returns the answer to a message. If the message cannot be answered, the answer's header has the key `error`.
    pub fn answer(&mut self, message: &[u8]) -> Vec<u8> {
        let answered = self.answered(message);
        answered.unwrap_or_else(|error| {
            // A text can always be written as JSON.
            reply(&json!({ "error": error }), &[]).unwrap_or_default()
        })
    }

    fn answered(&mut self, message: &[u8]) -> Result<Vec<u8>, String> {
        let (ask, bytes) = unpacked::<Ask>(message)?;
        match ask {
            Ask::Choose(choosing) => reply(&choice(&choosing)?, &[]),
            Ask::Open(opening) => {
                let (session, opened) = open(*opening)?;
                self.session = Some(session);
                reply(&opened, &[])
            }
            Ask::Trip { number } => {
                let record = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
                self.session()?.take_trip(number, &record)?;
                reply(&json!({}), &[])
            }
            Ask::Draw { number } => {
                let (step, bytes) = self.session()?.draw(number)?;
                reply(&step, &bytes)
            }
            Ask::Judge(drawn) => {
                let (step, bytes) = self.session()?.judge(&drawn, bytes)?;
                reply(&step, &bytes)
            }
            Ask::Record { number, seconds } => {
                let (step, bytes) = self.session()?.record(number, seconds)?;
                reply(&step, &bytes)
            }
            Ask::View { line } => {
                let short = || "a message ends in its line".to_owned();
                let (line, frame) = bytes.split_at_checked(line).ok_or_else(short)?;
                let record: Record =
                    serde_json::from_slice(line).map_err(|error| error.to_string())?;
                let html = record_html(&record, frame_of(frame));
                reply(&json!({}), html.as_bytes())
            }
            Ask::Methods { lines, pictures } => {
                let lengths = pictures.iter().map(|(_, length)| *length);
                let lengths: Vec<usize> = std::iter::once(lines).chain(lengths).collect();
                let parts = split(bytes, &lengths)?;
                let files = pictures.iter().zip(&parts[1..]);
                let files: HashMap<&str, &[u8]> = files
                    .map(|((path, _), file)| (path.as_str(), *file))
                    .collect();
                let run = run_of(parts[0])?;
                let charts = methods_html(&run, |path| files.get(path).map(|file| file.to_vec()));
                let (html, style) = charts.unwrap_or_default();
                reply(&Charts { style }, html.as_bytes())
            }
        }
    }

    fn session(&mut self) -> Result<&mut Session, String> {
        let none = || "no run has begun".to_owned();
        self.session.as_mut().ok_or_else(none)
    }
}

/// Returns the frame in a compressed file; `None` if the record keeps no frame.
fn frame_of(file: &[u8]) -> Option<FrameFile> {
    let mut text = Vec::new();
    let read = GzDecoder::new(file).take(MAX_FRAME).read_to_end(&mut text);
    read.ok()?;
    serde_json::from_slice(&text).ok()
}

/// Returns the run in a `run.jsonl`.
fn run_of(lines: &[u8]) -> Result<Run, String> {
    let begin = |header| Run {
        header,
        records: Vec::new(),
        beside: Vec::new(),
        truncated: false,
    };
    let take = |run: &mut Run, record| {
        run.records.push(record);
        Ok(())
    };
    let (run, _) =
        Run::fold(Path::new("run.jsonl"), lines, begin, take).map_err(|error| error.to_string())?;
    Ok(run)
}

fn reply(header: &impl Serialize, bytes: &[u8]) -> Result<Vec<u8>, String> {
    packed(header, [bytes].into_iter())
}
