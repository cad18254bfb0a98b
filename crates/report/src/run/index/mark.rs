//! Verdicts as marks: a sign, a word and a colour.

use crate::words::{self, Tone};
use etalon_record::Verdict;
use maud::{Markup, html};

/// A verdict as symbol and word.
pub(super) fn mark(verdict: Verdict, tone: Tone) -> Markup {
    html! { span.m { i { (words::symbol(verdict)) } " " (words::name(verdict)) (tone.suffix()) } }
}

/// The class that colours a verdict: a fixed letter, never taken from a record.
pub(super) fn class(verdict: Verdict, tone: Tone) -> &'static str {
    match (verdict, tone) {
        (_, Tone::Missed) => "f",
        (Verdict::Fail, Tone::Excused) => "f x",
        (Verdict::Open, Tone::Excused) => "o x",
        (_, Tone::Excused) => "b x",
        (Verdict::Pass, Tone::Plain) => "p",
        (Verdict::Imprecise, Tone::Plain) => "i",
        (Verdict::Fail, Tone::Plain) => "f",
        (Verdict::RequiredByCts | Verdict::Disputed, Tone::Plain) => "d",
        (Verdict::Open, Tone::Plain) => "o",
        (Verdict::Measured, Tone::Plain) => "n",
        (Verdict::NotSupported | Verdict::Skipped, Tone::Plain) => "u",
        (_, Tone::Plain) => "b",
    }
}
