//! Verdicts as marks: a sign, a word and a colour.

use crate::words::{self, Tone};
use etalon_record::Verdict;
use maud::{Markup, html};

/// Returns a verdict as symbol and word.
pub(crate) fn mark(verdict: Verdict, tone: Tone) -> Markup {
    html! { span.m { i { (words::symbol(verdict)) } " " (words::name(verdict)) (tone.suffix()) } }
}

/// Returns the class that colours a verdict, a fixed letter that never comes from a record.
pub(crate) fn class(verdict: Verdict, tone: Tone) -> &'static str {
    let (_, [plain, excused]) = words::signs(verdict);
    match tone {
        Tone::Missed => "f",
        Tone::Excused | Tone::Due => excused,
        Tone::Plain => plain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn grades_of_evidence_and_what_was_not_drawn_differ_in_colour() {
        let style = include_str!("page/style.css");
        let mut seen = BTreeMap::new();
        for verdict in [
            Verdict::Pass,
            Verdict::Fail,
            Verdict::RequiredByCts,
            Verdict::Disputed,
            Verdict::Blocked,
            Verdict::Open,
            Verdict::Crash,
            Verdict::NotSupported,
        ] {
            let letter = class(verdict, Tone::Plain);
            assert!(style.contains(&format!(".{letter} {{ --c: var(--{letter}); }}")));
            assert_eq!(seen.insert(letter, verdict), None, "{verdict}");
            if verdict.is_bad() {
                assert!(class(verdict, Tone::Excused).ends_with(" x"));
            }
        }
    }
}
