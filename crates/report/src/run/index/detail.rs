//! All facts of one record.

use super::facts;
use crate::command;
use crate::numbers::count;
use crate::picture::{self, Strip};
use crate::table::Table;
use crate::words::{
    allowed, channel_of, clause, code_and_value, code_text, headline, judged_by, multisampled,
    operations, place, value_text,
};
use etalon_frame::{Band, ChannelMismatch, Story, WrongTexel};
use etalon_record::{FrameFile, Record, RecordError, Run};
use maud::{Markup, html};
use std::path::Path;

/// The maximum number of wrong texels in a table.
const TEXELS: usize = 6;
/// The maximum number of bytes that all pictures of a file take together.
const PICTURE_BYTES: usize = 2 << 20;

/// The room that pictures take.
#[derive(Default)]
pub(crate) struct DetailBudget {
    bytes: usize,
    /// The number of frames without room.
    pub(crate) cut: u64,
}

/// The frame of a record with its pictures.
pub(crate) struct DrawnFrame {
    /// The frame without its images.
    frame: Result<FrameFile, RecordError>,
    /// The pictures of each image; `None` if its codes do not fit its size.
    strips: Vec<Option<Strip>>,
}

impl DrawnFrame {
    /// Reads and draws a record's frame, or returns `None` if the record names none.
    pub(crate) fn of(folder: &Path, record: &Record) -> Option<Self> {
        Some(Self::new(Run::read_frame(folder, record.frame.as_deref()?)))
    }

    /// Draws a frame.
    pub(crate) fn new(mut frame: Result<FrameFile, RecordError>) -> Self {
        let images = frame
            .as_mut()
            .map(|frame| std::mem::take(&mut frame.images));
        Self {
            strips: images.iter().flatten().map(picture::strip).collect(),
            frame,
        }
    }
}

/// Returns a record from its picture to its commands: the subject of the case, the violation, pictures, operations, tables.
pub(crate) fn body(
    record: &Record,
    drawn: Option<&DrawnFrame>,
    budget: &mut DetailBudget,
) -> Markup {
    let path = record.frame.as_deref();
    let frame = path.zip(drawn.map(|drawn| &drawn.frame));
    html! {
        @if let Some((_, Ok(frame))) = &frame { p.about { (frame.about) } }
        (violation(record))
        @if let Some(expected) = &record.expected { p.known { b { "Known: " } (expected.reason) } }
        @match &frame {
            Some((_, Ok(_))) => (pictures(drawn.map_or(&[], |drawn| &drawn.strips), budget)),
            Some((path, Err(error))) => p.note { "No pictures: " (path) ": " (error) },
            None => {},
        }
        @if let Some(story) = &record.story { (story_section(story, record)) }
        @if !record.wrong.is_empty() { (texels(record)) }
        (facts::list(record))
        @if let Some((_, Ok(frame))) = &frame {
            @if !frame.spec.is_empty() { p.spec { "Specifications: " (frame.spec.join("; ")) } }
        }
        (commands(record))
    }
}

/// Returns what is wrong in one sentence, with its clause and the strength of the evidence.
fn violation(record: &Record) -> Markup {
    let story = record.story.as_ref();
    html! {
        @if record.verdict.is_bad() || record.unexpected() || !record.wrong.is_empty() {
            p.violation {
                b { (headline(record)) }
                @if let Some(clause) = story.and_then(clause) { " " cite { "[" (clause) "]" } }
            }
        }
        @if let Some(judged_by) = story.and_then(judged_by) { p.note { (judged_by) } }
    }
}

fn commands(record: &Record) -> Markup {
    html! {
        details.again {
            summary { "Commands" }
            @if !record.wrong.is_empty() {
                p { "Explain it: " code { (command::explain(record)) } }
                @if record.adapter != "cpu" {
                    @for (gives, line) in command::onward(record) { p { (gives) ": " code { (line) } } }
                }
            }
            p { "Draw it again: " code { (command::run(&record.case, &record.adapter)) } }
        }
    }
}

fn pictures(strips: &[Option<Strip>], budget: &mut DetailBudget) -> Markup {
    if budget.bytes > PICTURE_BYTES {
        budget.cut += 1;
        return html! { p.note { "These pictures were left out to keep the page small." } };
    }
    budget.bytes += strips.iter().flatten().map(|s| s.bytes()).sum::<usize>();
    let readable = strips.iter().flatten();
    let (wrong, right): (Vec<&Strip>, Vec<&Strip>) = readable.partition(|s| s.has_wrong());
    let (first, others) = if wrong.is_empty() {
        (right, wrong)
    } else {
        (wrong, right)
    };
    html! {
        @for strip in first { (strip) }
        @if !others.is_empty() {
            details {
                summary { (count(others.len() as u64, "image")) " without a wrong texel" }
                @for strip in others { (strip) }
            }
        }
        @if strips.iter().any(Option::is_none) {
            p.note { "An image of this frame has more or fewer codes than its size needs." }
        }
        p.cap {
            "Difference: " span.cross { "✗" } " outside the legal set, " span.dot { "•" }
            " legal but outside the yardstick; the brighter, the farther outside the allowed range, "
            "in codes (for floats units in the last place) on a logarithmic scale. The allowed picture has the "
            "allowed codes that are nearest to the drawn ones, and stripes if they span a wide range. Allowed low "
            "and high enclose all allowed outcomes, so a wrong texel may lie between them."
        }
    }
}

fn texels(record: &Record) -> Markup {
    let shown = record.wrong.len().min(TEXELS);
    let outside = record.texels.wrong + record.texels.imprecise;
    // An imprecise texel is outside the yardstick, so its row shows the yardstick's bounds.
    let imprecise = |t: &WrongTexel| t.band == Band::Imprecise;
    let bound = match record.wrong[..shown]
        .iter()
        .filter(|t| imprecise(t))
        .count()
    {
        0 => "Allowed",
        n if n == shown => "Yardstick",
        _ => "Allowed (≈: yardstick)",
    };
    let rows = record.wrong[..shown].iter();
    let rows = rows.flat_map(|texel| texel.channels.iter().map(move |m| (texel, m)));
    let table = Table::<(&WrongTexel, &ChannelMismatch)>::new("text codes stacked")
        .caption("Wrong texels")
        .head("Place", |(texel, _)| place(texel, multisampled(record)))
        .text("Band", |(texel, _)| match texel.band {
            Band::Fail => "✗ fail",
            Band::RequiredByCts => "⊠ required by CTS",
            Band::Disputed => "? disputed",
            Band::Imprecise => "≈ imprecise",
        })
        .text("Channel", |(_, m)| channel_of(m))
        .text("Encoding", |(_, m)| m.encoding.to_string())
        .text(format!("{bound} code"), |(_, m)| allowed(m, code_text))
        .text(format!("{bound} value"), |(_, m)| allowed(m, value_text))
        .text(
            "Actual",
            |(_, m)| html! { b { (code_and_value(m.encoding, m.actual)) } },
        )
        .text("Off by", |(_, m)| off(m));
    html! {
        (table.page(rows))
        @if outside > shown as u64 { p.note { "and " (outside - shown as u64) " more" } }
    }
}

/// Returns the distance of a code from the allowed ones.
fn off(m: &ChannelMismatch) -> String {
    if m.encoding.is_nan(m.actual) {
        return "not a number".to_owned();
    }
    let order = |code| m.encoding.order_of_code(code);
    let codes = (order(m.low) - order(m.actual)).max(order(m.actual) - order(m.high));
    count(codes.max(0).unsigned_abs(), "code")
}

/// Returns the operations at the first wrong texel.
fn story_section(story: &Story, record: &Record) -> Markup {
    let lines = operations(story);
    html! {
        h4 {
            "Operations"
            @if let Some(texel) = record.wrong.first() { " at " (place(texel, multisampled(record))) }
        }
        ol.story {
            @for group in lines.chunk_by(|a, b| a.at == b.at) {
                li.at { (group[0].at) }
                @for line in group {
                    li {
                        b { (line.operation) } ": " (line.detail)
                        @if let Some(citation) = &line.citation { " " cite { "[" (citation) "]" } }
                    }
                }
            }
        }
    }
}
