//! Reading a run folder.

use crate::error::RecordError;
use crate::expectations::without_position;
use crate::frame_file::FrameFile;
use crate::header::{FORMAT, Header};
use crate::record::Record;
use crate::writer::MAX_LINE;
use serde::Deserialize;
use serde_json::error::Category;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// A recorded run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The first line.
    pub header: Header,
    /// The records, in the order in which they were written.
    pub records: Vec<Record>,
    /// Whether the last line was cut off, as a killed runner leaves it; the line is dropped.
    pub truncated: bool,
}

/// How every PNG file begins.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The most bytes of a header's line: some thousand adapters.
const MAX_HEADER: usize = 16 << 20;
/// The most bytes of a frame file that are read; what is longer does not parse.
const MAX_FRAME: u64 = 512 << 20;
const REMEDY: &str = "remove the line, or record the run again";

#[derive(Deserialize)]
struct Format {
    format: u32,
}

impl Run {
    /// Reads `run.jsonl` in a run folder. A last line that is not whole JSON is dropped and noted;
    /// any other line must parse.
    ///
    /// # Errors
    /// When there is no run, it is in another format, or a line is damaged.
    pub fn read(folder: &Path) -> Result<Self, RecordError> {
        Ok(Self::read_prefix(folder)?.0)
    }

    /// [`Run::read`], with the number of bytes that the header and the whole records take.
    pub(crate) fn read_prefix(folder: &Path) -> Result<(Self, u64), RecordError> {
        let path = folder.join("run.jsonl");
        let file = File::open(&path).map_err(|e| match e.kind() {
            ErrorKind::NotFound => RecordError::NoRun {
                path: folder.to_owned(),
            },
            _ => RecordError::io("read", &path)(e),
        })?;
        let mut lines = BufReader::new(file);
        let mut line = Vec::new();
        // A file of one endless line may not take the memory.
        let mut next = |line: &mut Vec<u8>, most: usize| {
            line.clear();
            (&mut lines)
                .take(most as u64 + 1)
                .read_until(b'\n', line)
                .map_err(RecordError::io("read", &path))
        };

        next(&mut line, MAX_HEADER)?;
        let header = parse_header(&line, &path)?;
        let mut run = Self {
            header,
            records: Vec::new(),
            truncated: false,
        };
        let mut number = 2;
        let mut whole = line.len() as u64;
        // A damaged line is an error as soon as another line follows it.
        let mut damaged: Option<RecordError> = None;
        while next(&mut line, MAX_LINE)? > 0 {
            if let Some(error) = damaged {
                return Err(error);
            }
            if line.len() > MAX_LINE {
                return Err(RecordError::Parse {
                    path,
                    line: number,
                    message: format!("the line is longer than {MAX_LINE} bytes"),
                    remedy: REMEDY,
                });
            }
            match serde_json::from_slice::<Record>(&line) {
                Ok(record) => {
                    run.records.push(record);
                    whole += line.len() as u64;
                }
                Err(e) => {
                    let error = parse_error(&path, number, &e);
                    // Whole JSON of the wrong shape was not cut off: another hand wrote it.
                    if e.classify() == Category::Data {
                        return Err(error);
                    }
                    damaged = Some(error);
                }
            }
            number += 1;
        }
        run.truncated = damaged.is_some();
        Ok((run, whole))
    }

    /// How many records are missing from a complete run.
    pub fn missing(&self) -> u64 {
        self.header
            .expected_records()
            .saturating_sub(self.records.len() as u64)
    }

    /// Reads a frame file by the path that a record names.
    ///
    /// # Errors
    /// When the path leaves the folder, or the file cannot be read or does not parse.
    pub fn read_frame(folder: &Path, frame: &str) -> Result<FrameFile, RecordError> {
        let path = folder.join(below(frame)?);
        let mut bytes = Vec::new();
        File::open(&path)
            .and_then(|file| file.take(MAX_FRAME).read_to_end(&mut bytes))
            .map_err(RecordError::io("read", &path))?;
        serde_json::from_slice(&bytes).map_err(|e| parse_error(&path, e.line(), &e))
    }

    /// Reads a picture by the path that a record names; `None` where it is no PNG file or longer than
    /// `most` bytes.
    ///
    /// # Errors
    /// When the path leaves the folder, or the file cannot be read.
    pub fn read_picture(
        folder: &Path,
        picture: &str,
        most: u64,
    ) -> Result<Option<Vec<u8>>, RecordError> {
        let path = folder.join(below(picture)?);
        let mut bytes = Vec::new();
        File::open(&path)
            .and_then(|file| file.take(most.saturating_add(1)).read_to_end(&mut bytes))
            .map_err(RecordError::io("read", &path))?;
        let whole = bytes.len() as u64 <= most && bytes.starts_with(PNG);
        Ok(whole.then_some(bytes))
    }
}

pub(crate) fn below(frame: &str) -> Result<PathBuf, RecordError> {
    let path = PathBuf::from(frame);
    let plain = |c: Component<'_>| matches!(c, Component::Normal(_));
    if !frame.is_empty() && path.components().all(plain) {
        Ok(path)
    } else {
        Err(RecordError::Outside {
            path: frame.to_owned(),
        })
    }
}

fn parse_header(line: &[u8], path: &Path) -> Result<Header, RecordError> {
    // The format goes first, since another one may have other fields.
    let format: Format = serde_json::from_slice(line).map_err(|e| parse_error(path, 1, &e))?;
    if format.format == 0 || format.format > FORMAT {
        return Err(RecordError::Format {
            path: path.to_owned(),
            found: format.format,
            expected: FORMAT,
        });
    }
    serde_json::from_slice(line).map_err(|e| parse_error(path, 1, &e))
}

fn parse_error(path: &Path, line: usize, error: &serde_json::Error) -> RecordError {
    RecordError::Parse {
        path: path.to_owned(),
        line,
        message: without_position(error),
        remedy: REMEDY,
    }
}
