//! Shortening of a record to one line of limited length.

use crate::error::RecordError;
use crate::json::json_line;
use crate::reason::Reason;
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
    while line.len() > MAX_LINE
        && let Some(text) = longest_text(&mut short)
    {
        cut(text);
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

/// The beginning of a text that was cut.
const MARK: &str = "[cut] ";

/// Returns the longest text from outside in a record; `None` if all are empty.
fn longest_text(record: &mut Record) -> Option<&mut String> {
    let stderr = record.process.as_mut().map(|end| &mut end.stderr);
    let texts = record.reasons.iter_mut().filter_map(Reason::text_mut);
    let longest = texts.chain(stderr).max_by_key(|text| text.len());
    longest.filter(|text| !text.is_empty())
}

/// Removes the first quarter of a text: the cause of a crash is usually at the end.
fn cut(text: &mut String) {
    let begin = if text.starts_with(MARK) {
        MARK.len()
    } else {
        0
    };
    let mut from = begin + (text.len() - begin) / 4 + 1;
    while from < text.len() && !text.is_char_boundary(from) {
        from += 1;
    }
    text.drain(..from.min(text.len()));
    if !text.is_empty() {
        text.insert_str(0, MARK);
    }
}
