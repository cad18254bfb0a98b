//! All facts of one record.

use super::facts;
use crate::command;
use crate::numbers::count;
use crate::page::link;
use crate::picture::{self, Strip};
use crate::table::Table;
use crate::words::{
    allowed, channel_of, code_and_value, code_text, judged_by, multisampled, operations, place,
    sentence, value_text,
};
use etalon_frame::{Band, ChannelMismatch, Story, WrongTexel};
use etalon_record::{FrameFile, Record, RecordError, Run};
use maud::{Markup, html};
use std::path::Path;

/// The maximum number of wrong texels in a table.
const TEXELS: usize = 6;
/// The maximum number of bytes that all pictures of a page take together.
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

pub(crate) fn body(
    record: &Record,
    drawn: Option<&DrawnFrame>,
    budget: &mut DetailBudget,
) -> Markup {
    let path = record.frame.as_deref();
    let frame = path.zip(drawn.map(|drawn| &drawn.frame));
    html! {
        @if let Some((_, Ok(frame))) = &frame { (about(frame)) }
        (facts::list(record))
        @match &frame {
            Some((_, Ok(_))) => (pictures(drawn.map_or(&[], |drawn| &drawn.strips), budget)),
            Some((path, Err(error))) => p.note { "No pictures: " (path) ": " (error) },
            None => {},
        }
        @if !record.wrong.is_empty() { (texels(record)) }
        @if let Some(story) = &record.story { (story_section(story, record)) }
        @if !record.wrong.is_empty() {
            p.again { "Explain it: " code { (command::explain(record)) } }
            @if record.adapter != "cpu" {
                @for (gives, line) in command::onward(record) { p.again { (gives) ": " code { (line) } } }
            }
        }
        p.again {
            "Draw it again: "
            code { (command::run(&record.case, &record.adapter)) }
            span.all { ". " a href=(link::case(&record.case)) { "This case on all adapters" } "." }
        }
    }
}

fn about(frame: &FrameFile) -> Markup {
    html! {
        p.about { (frame.about) }
        @if !frame.spec.is_empty() { p.spec { "Specifications: " (frame.spec.join("; ")) } }
    }
}

fn pictures(strips: &[Option<Strip>], budget: &mut DetailBudget) -> Markup {
    if budget.bytes > PICTURE_BYTES {
        budget.cut += 1;
        return html! { p.note { "These pictures were left out to keep the page small." } };
    }
    budget.bytes += strips.iter().flatten().map(|s| s.bytes()).sum::<usize>();
    html! {
        @for strip in strips {
            @if let Some(strip) = strip {
                (strip)
            } @else {
                p.note { "An image of this frame has more or fewer codes than its size needs." }
            }
        }
        p.cap {
            "Difference: " span.cross { "✗" } " outside the legal set, " span.dot { "•" }
            " legal but outside the yardstick; the brighter, the farther outside the allowed range, "
            "in codes (for floats units in the last place) on a logarithmic scale. Allowed low and "
            "high enclose all allowed outcomes, so a wrong texel may lie between them."
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

/// Returns the ruling as a heading, the rules behind it, and the operations.
fn story_section(story: &Story, record: &Record) -> Markup {
    let lines = operations(story);
    html! {
        @match (sentence(story), record.wrong.first()) {
            (Some(sentence), _) => h5 { (sentence) },
            (None, Some(texel)) => h5 { "Expected operations at " (place(texel, multisampled(record))) },
            (None, None) => h5 { "Expected operations" },
        }
        @if let Some(judged_by) = judged_by(story) {
            p.note { (judged_by) }
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
