//! Shortening of a record to one line of limited length.

use crate::error::RecordError;
use crate::json::json_line;
use crate::record::{MAX_LINE, MAX_WRONG_TEXELS, Record};

/// Returns the record's line, shortened to at most [`MAX_LINE`] bytes.
pub(crate) fn fit(record: &Record) -> Result<Vec<u8>, RecordError> {
    let write = |record: &Record| json_line("a record", record);
    let mut line = write(record)?;
    if line.len() <= MAX_LINE && record.wrong.len() <= MAX_WRONG_TEXELS {
        return Ok(line);
    }
    let mut short = record.clone();
    short.wrong.truncate(MAX_WRONG_TEXELS);
    line = write(&short)?;
    while line.len() > MAX_LINE && short.wrong.len() > 1 {
        short.wrong.truncate(short.wrong.len() * 3 / 4);
        line = write(&short)?;
    }
    while line.len() > MAX_LINE
        && let Some(story) = &mut short.story
    {
        let kept = story.events.len().max(story.told.len()) / 2;
        if kept < 2 {
            short.story = None;
        } else {
            story.events.truncate(kept);
            story.told.truncate(kept);
            story.cut = true;
        }
        line = write(&short)?;
    }
    let mut message = short.message.clone();
    while line.len() > MAX_LINE && !message.is_empty() {
        cut(&mut message);
        short.message = if message.is_empty() {
            String::new()
        } else {
            format!("[cut] {message}")
        };
        line = write(&short)?;
    }
    if line.len() > MAX_LINE {
        return Err(RecordError::TooLong {
            case: record.case.chars().take(200).collect(),
            adapter: record.adapter.chars().take(200).collect(),
            limit: MAX_LINE,
        });
    }
    Ok(line)
}

/// Removes the first quarter of a message: the cause of a crash is usually at the end.
fn cut(message: &mut String) {
    let mut from = message.len() / 4 + 1;
    while from < message.len() && !message.is_char_boundary(from) {
        from += 1;
    }
    message.drain(..from.min(message.len()));
}
