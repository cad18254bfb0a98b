//! Reading of `run.jsonl` and `bench.jsonl`: a header with a format number, then one value per line.
//!
//! A process that is killed leaves a prefix, so a last line that is not whole JSON is dropped and noted.
//! Any other line must parse: being killed does not damage lines in the middle.

use crate::error::RecordError;
use crate::json::without_position;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::error::Category;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// The limits and messages of one kind of file.
pub(crate) struct JsonLines<'a> {
    pub(crate) path: &'a Path,
    /// The newest format that is read; earlier ones are read too.
    pub(crate) format: u32,
    /// The maximum number of bytes of a header that are read; a longer one does not parse.
    pub(crate) max_header: u64,
    /// The maximum number of bytes of any other line that are read.
    pub(crate) max_line: u64,
    /// The remedy for a damaged line.
    pub(crate) remedy: &'static str,
}

/// The remedy for a damaged header: without it, no line can be read.
const HEADER_REMEDY: &str = "the file cannot be read without its header; take it from a copy, or record again into another folder";

/// The end of the readable part of a file.
pub(crate) struct ReadableEnd {
    /// The length of the header and the whole lines, in bytes.
    pub(crate) bytes: u64,
    /// True if the last line was cut off.
    pub(crate) truncated: bool,
}

#[derive(Deserialize)]
struct HeaderFormat {
    format: u32,
}

impl JsonLines<'_> {
    /// Reads the lines of a file. `begin` makes the result from the header. `take` adds a line to it, or
    /// returns why the line cannot follow the lines before it.
    pub(crate) fn read<H: DeserializeOwned, L: DeserializeOwned, T>(
        &self,
        file: impl Read,
        begin: impl FnOnce(H) -> T,
        take: impl Fn(&mut T, L) -> Result<(), String>,
    ) -> Result<(T, ReadableEnd), RecordError> {
        let mut lines = BufReader::new(file);
        let mut line = Vec::new();
        // A file that is one endless line must not exhaust memory.
        let mut next = |line: &mut Vec<u8>, most: u64| {
            line.clear();
            (&mut lines)
                .take(most.saturating_add(1))
                .read_until(b'\n', line)
                .map_err(RecordError::io("read", self.path))
        };

        next(&mut line, self.max_header)?;
        let mut result = begin(self.header(&line)?);
        let mut number = 2;
        let mut bytes = line.len() as u64;
        // Blank lines at the end, which some editors leave, are ignored and cut off before appending.
        let mut blank: Option<usize> = None;
        // A damaged line is an error as soon as another line follows it.
        let mut damaged: Option<RecordError> = None;
        while next(&mut line, self.max_line)? > 0 {
            if line.trim_ascii().is_empty() {
                blank.get_or_insert(number);
                number += 1;
                continue;
            }
            if let Some(blank) = blank {
                return Err(self.error(blank, "the line is empty".to_owned()));
            }
            if let Some(error) = damaged {
                return Err(error);
            }
            if line.len() as u64 > self.max_line {
                let message = format!("the line is longer than {} bytes", self.max_line);
                return Err(self.error(number, message));
            }
            match serde_json::from_slice::<L>(&line) {
                Ok(value) => {
                    take(&mut result, value).map_err(|message| self.error(number, message))?;
                    bytes += line.len() as u64;
                }
                Err(e) => {
                    let error = self.error(number, without_position(&e));
                    // Whole JSON of the wrong shape was not cut off: another program wrote it.
                    if e.classify() == Category::Data {
                        return Err(error);
                    }
                    damaged = Some(error);
                }
            }
            number += 1;
        }
        let truncated = damaged.is_some();
        Ok((result, ReadableEnd { bytes, truncated }))
    }

    fn header<H: DeserializeOwned>(&self, line: &[u8]) -> Result<H, RecordError> {
        let wrong = |e: serde_json::Error| RecordError::Parse {
            path: self.path.to_owned(),
            line: 1,
            message: without_position(&e),
            remedy: HEADER_REMEDY,
        };
        let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
        // The format is read first, since other formats can have other fields.
        let HeaderFormat { format } = serde_json::from_slice(line).map_err(wrong)?;
        if format == 0 || format > self.format {
            return Err(RecordError::Format {
                path: self.path.to_owned(),
                found: format,
                expected: self.format,
            });
        }
        serde_json::from_slice(line).map_err(wrong)
    }

    fn error(&self, line: usize, message: String) -> RecordError {
        RecordError::Parse {
            path: self.path.to_owned(),
            line,
            message,
            remedy: self.remedy,
        }
    }
}
