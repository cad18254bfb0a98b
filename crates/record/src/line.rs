//! The lines and files of a run as bytes, for writers that keep no folder.

use crate::error::RecordError;
use crate::frame_file::FrameFile;
use crate::header::Header;
use crate::json::json_line;
use crate::paths::{frame_path, picture_path};
use crate::png_file::png_file;
use crate::record::Record;
use crate::shorten::fit;
use flate2::Compression;
use flate2::write::GzEncoder;
use png::{ColorType, Compression as PngCompression};
use std::io::{self, Write};

/// Returns the first line of `run.jsonl`.
///
/// # Errors
/// If the header cannot be written as JSON.
pub fn header_line(header: &Header) -> Result<Vec<u8>, RecordError> {
    json_line("the header", header)
}

/// Returns a record's line of `run.jsonl`, shortened to at most [`MAX_LINE`](crate::MAX_LINE) bytes: first its wrong
/// texels, then the story, then the message.
///
/// # Errors
/// If the record cannot be shortened enough.
pub fn record_line(record: &Record) -> Result<Vec<u8>, RecordError> {
    fit(record)
}

/// Returns a frame's path below its run folder, and the compressed file.
///
/// # Errors
/// If the frame cannot be written as JSON.
pub fn frame_file(frame: &FrameFile) -> Result<(String, Vec<u8>), RecordError> {
    let path = frame_path(&frame.adapter, &frame.case);
    let bytes = packed(&json_line("a frame", frame)?);
    let bytes = bytes.map_err(RecordError::io("write", path.as_ref()))?;
    Ok((path, bytes))
}

/// Returns a picture's path below its run folder, and the PNG file. `rgb` holds red, green and blue of each texel, row
/// by row from the top.
///
/// # Errors
/// If the number of values does not match the size.
pub fn picture_file(
    case: &str,
    size: [u32; 2],
    rgb: &[u8],
) -> Result<(String, Vec<u8>), RecordError> {
    let path = picture_path(case);
    let bytes = png_file(size, ColorType::Rgb, PngCompression::Fast, rgb);
    let bytes = bytes.map_err(RecordError::io("write", path.as_ref()))?;
    Ok((path, bytes))
}

/// Compresses bytes with gzip.
fn packed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(bytes)?;
    packed.finish()
}
