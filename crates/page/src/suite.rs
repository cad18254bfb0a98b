//! Answering messages.

use crate::message::{Ask, Judging};
use crate::opening::open;
use crate::session::Session;
use etalon_record::{FrameFile, Record};
use etalon_report::record_html;
use etalon_webgpu::message::{packed, unpacked};
use flate2::read::GzDecoder;
use serde::Serialize;
use serde_json::json;
use std::io::Read;

/// The maximum number of bytes of a frame that is shown.
const MAX_FRAME: u64 = 256 << 20;

/// What a worker of the page knows: nothing before a run begins.
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
                let (drawing, bytes) = self.session()?.draw(number)?;
                reply(&drawing, &bytes)
            }
            Ask::Judge(drawn) => {
                let (judging, bytes): (Judging, _) = self.session()?.judge(&drawn, bytes)?;
                reply(&judging, &bytes)
            }
            Ask::View { line } => {
                let short = || "a message ends in its line".to_owned();
                let (line, frame) = bytes.split_at_checked(line).ok_or_else(short)?;
                let record: Record =
                    serde_json::from_slice(line).map_err(|error| error.to_string())?;
                let html = record_html(&record, frame_of(frame));
                reply(&json!({}), html.as_bytes())
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

fn reply(header: &impl Serialize, bytes: &[u8]) -> Result<Vec<u8>, String> {
    packed(header, [bytes].into_iter())
}
