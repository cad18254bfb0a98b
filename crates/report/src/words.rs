//! Verdicts, records and texels in words; shared by all reports.

mod header;
mod plain;
mod record;
mod texel;
mod verdict;

pub(crate) use header::{machine, settings};
pub use plain::plain;
pub(crate) use record::{headline, process_end};
pub(crate) use texel::{
    allowed, channel_of, code_and_value, code_text, multisampled, place, value_text,
};
pub(crate) use verdict::{Tone, meaning, name, repetitions, symbol};
