//! Verdicts, records and texels in words; shared by all reports.

mod event;
mod glossary;
mod header;
mod plain;
mod reason;
mod record;
mod reduced;
mod run;
mod story;
mod subject;
mod texel;
mod value;
mod verdict;

pub(crate) use glossary::glossary;
pub use header::api_name;
pub(crate) use header::{machine, settings};
pub use plain::plain;
pub use reason::{message, reasons_text};
pub(crate) use record::{headline, process_end};
pub use reduced::ReducedCase;
pub use run::conclusion;
pub(crate) use run::{counted, new_failures, nothing_unexpected, why};
pub(crate) use story::{clause, operations};
pub use story::{judged_by, operations_text, sentence, story_text};
pub(crate) use texel::{
    allowed, channel_of, code_and_value, code_text, multisampled, place, texel_values, value_text,
};
pub(crate) use verdict::{Tone, meaning, name, repetitions, signs, symbol};
