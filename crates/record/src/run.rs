//! Reading a run folder.

use crate::error::RecordError;
use crate::folder::{BESIDE_FILE, RUN_FILE};
use crate::frame_file::FrameFile;
use crate::header::{FORMAT, Header};
use crate::json::without_position;
use crate::json_file::read_json;
use crate::json_lines::JsonLines;
use crate::paths::{is_of_record, open_below};
use crate::record::{MAX_LINE, Record, count_unexpected};
use flate2::read::GzDecoder;
use std::collections::HashSet;
use std::io::Read;
use std::path::Path;

/// A recorded run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The first line.
    pub header: Header,
    /// The records, in the order in which they were written.
    pub records: Vec<Record>,
    /// The records beside those of the selected cases: see [`beside`](crate::beside).
    pub beside: Vec<Record>,
    /// True if the last line was cut off, as a killed runner leaves it; the line is dropped.
    pub truncated: bool,
}

/// The signature of a PNG file.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The maximum number of bytes of a header's line, which is enough for some thousand adapters.
const MAX_HEADER: u64 = 16 << 20;
/// The maximum number of bytes of a frame file that are read; a longer one does not parse.
const MAX_FRAME: u64 = 512 << 20;
/// The remedy for a damaged line.
const REMEDY: &str = "remove the line, or record the run again";
/// The remedy for a damaged frame: the run is readable without it.
const FRAME_REMEDY: &str = "copy the file anew, or draw the case again";

fn lines(path: &Path) -> JsonLines<'_> {
    JsonLines {
        path,
        format: FORMAT,
        max_header: MAX_HEADER,
        max_line: MAX_LINE as u64,
        remedy: REMEDY,
    }
}

/// Returns an error if a record names a file outside the run folder.
fn check_files(record: &Record) -> Result<(), String> {
    let outside = record.files().find(|file| !is_of_record(file));
    outside.map_or(Ok(()), |file| {
        Err(format!(
            "{file:?} is not the path of a frame or a picture below the run folder"
        ))
    })
}

impl Run {
    /// Reads `run.jsonl` in a run folder. A last line that is not whole JSON is dropped and noted;
    /// any other line must parse.
    ///
    /// # Errors
    /// If there is no run, if its format is unknown, or if a line is damaged.
    pub fn read(folder: &Path) -> Result<Self, RecordError> {
        Ok(Self::read_prefix(folder)?.0)
    }

    /// Like [`Run::read`], and also returns the length of the header and the whole records in bytes.
    pub(crate) fn read_prefix(folder: &Path) -> Result<(Self, u64), RecordError> {
        let path = folder.join(RUN_FILE);
        let file = open_below(folder, RUN_FILE).map_err(|e| match e {
            e if e.is_missing() => RecordError::NoRun {
                path: folder.to_owned(),
            },
            e => e,
        })?;
        let begin = |header| Self {
            header,
            records: Vec::new(),
            beside: Vec::new(),
            truncated: false,
        };
        let (mut run, extent) = lines(&path).read(file, begin, |run, record: Record| {
            check_files(&record)?;
            run.records.push(record);
            Ok(())
        })?;
        run.truncated = extent.truncated;
        run.beside = read_json(folder, BESIDE_FILE)?;
        Ok((run, extent.bytes))
    }

    /// Reads the lines of a `run.jsonl` from any source, and keeps at most one record in memory. `begin`
    /// makes the result from the header; `take` adds a record to it, or returns why the record is
    /// impossible. The second value is true if the last line was cut off; that line is dropped. Errors name
    /// `path`.
    ///
    /// # Errors
    /// As [`Run::read`], and if `take` refuses a record.
    pub fn fold<T>(
        path: &Path,
        text: impl Read,
        begin: impl FnOnce(Header) -> T,
        take: impl Fn(&mut T, Record) -> Result<(), String>,
    ) -> Result<(T, bool), RecordError> {
        let take = |result: &mut T, record: Record| {
            check_files(&record)?;
            take(result, record)
        };
        let (result, extent) = lines(path).read(text, begin, take)?;
        Ok((result, extent.truncated))
    }

    /// Returns every record, also those beside the selected cases.
    pub fn all_records(&self) -> impl Iterator<Item = &Record> {
        self.records.iter().chain(&self.beside)
    }

    /// Returns the number of records that count against the run.
    pub fn unexpected(&self) -> u64 {
        count_unexpected(self.all_records())
    }

    /// Returns the number of records beside the selected cases that count against the run.
    pub fn unexpected_beside(&self) -> u64 {
        count_unexpected(&self.beside)
    }

    /// Returns the number of records that this run lacks to be complete.
    pub fn missing(&self) -> u64 {
        self.header
            .expected_records()
            .saturating_sub(self.records.len() as u64)
    }

    /// Returns the adapters that drew no case, in the order of the header.
    pub fn idle_adapters(&self) -> Vec<&str> {
        let drawn: HashSet<&str> = self
            .records
            .iter()
            .filter(|record| record.is_drawn())
            .map(|record| record.adapter.as_str())
            .collect();
        let names = self.header.adapters.iter().map(|a| a.info.name.as_str());
        names.filter(|name| !drawn.contains(name)).collect()
    }

    /// Returns true if no adapter drew a case.
    pub fn is_idle(&self) -> bool {
        !self.records.iter().any(Record::is_drawn)
    }

    /// Reads a frame file by the path in a record. Earlier versions wrote frames uncompressed.
    ///
    /// # Errors
    /// If the path leaves the folder, or if the file cannot be read or does not parse.
    pub fn read_frame(folder: &Path, frame: &str) -> Result<FrameFile, RecordError> {
        let file = open_below(folder, frame)?;
        let path = folder.join(frame);
        let mut bytes = Vec::new();
        let packed = path.extension().is_some_and(|extension| extension == "gz");
        let contents: Box<dyn Read> = if packed {
            Box::new(GzDecoder::new(file))
        } else {
            Box::new(file)
        };
        contents
            .take(MAX_FRAME)
            .read_to_end(&mut bytes)
            .map_err(|source| RecordError::Frame {
                path: path.clone(),
                source,
            })?;
        serde_json::from_slice(&bytes).map_err(|e| RecordError::Parse {
            line: e.line(),
            message: without_position(&e),
            remedy: FRAME_REMEDY,
            path,
        })
    }

    /// Reads a picture by the path in a record; `None` if it is not a PNG file or is longer than `most`
    /// bytes.
    ///
    /// # Errors
    /// If the path leaves the folder, or the file cannot be read.
    pub fn read_picture(
        folder: &Path,
        picture: &str,
        most: u64,
    ) -> Result<Option<Vec<u8>>, RecordError> {
        let file = open_below(folder, picture)?;
        let mut bytes = Vec::new();
        file.take(most.saturating_add(1))
            .read_to_end(&mut bytes)
            .map_err(RecordError::io("read", &folder.join(picture)))?;
        let is_picture = bytes.len() as u64 <= most && bytes.starts_with(PNG);
        Ok(is_picture.then_some(bytes))
    }
}
