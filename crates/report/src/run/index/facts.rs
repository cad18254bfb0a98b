//! The facts of one record in a case's view, as labels and texts.

use crate::numbers::{count, duration, percent};
use crate::page::link;
use crate::words;
use etalon_frame::{Band, CounterOutcome};
use etalon_record::{Assertion, Record};
use maud::{Markup, html};

/// The maximum number of characters of a message that the page keeps: those at its end, which usually has the
/// reason.
const LONGEST: usize = 4000;

/// The words, the form, and true if the record's page shows the same fact with its pictures. Forms: `text`; `lead`
/// and `known`, what is wrong and the expectation, which come before the pictures; `pre` for text from a driver; `case`
/// and `example` for ids that become links; `code`.
pub(crate) type Label = (&'static str, &'static str, bool);

/// Returns the note that replaces the facts of a record if there is no room for them.
pub(crate) fn no_room() -> (Label, String) {
    let text = "The facts of this record were left out to keep the page small; run.jsonl has them.";
    (("Note", "text", false), text.to_owned())
}

/// Returns all facts of a record that its cell does not show.
pub(crate) fn of(record: &Record) -> Vec<(Label, String)> {
    let mut facts = Vec::new();
    let mut add = |name, form, in_body, text: String| facts.push(((name, form, in_body), text));
    let headline = words::headline(record);
    if headline != words::meaning(record.verdict) {
        add("In short", "lead", true, headline.clone());
    }
    let reasons = words::reasons_text(&record.reasons);
    if !reasons.is_empty() && reasons != headline {
        add("Message", "pre", true, end(&reasons));
    }
    if let Some(expected) = &record.expected {
        add("Known", "known", true, end(&expected.reason));
    }
    if let Some(case) = &record.look {
        let text =
            format!("The finding names {case}: both leave the same states and violation, reduced.");
        add("Known by its look", "text", true, text);
    }
    if let Some(verdict) = record.improves {
        let text = format!("The expectations still name {}.", words::name(verdict));
        add("Improvement", "text", false, text);
    }
    if record.due_fail {
        let text = "The judge sees another scene than the driver, so this is due to fail.";
        add("Selftest", "text", true, text.to_owned());
    }
    if let Some(process) = &record.process {
        add("Process", "text", true, words::process_end(process));
        if !process.stderr.is_empty() {
            add("Standard error", "pre", true, end(&process.stderr));
        }
    }
    for message in &record.validation {
        add("Validation", "pre", true, end(message));
    }
    if !record.repeats.is_empty() {
        add(
            "Repeated",
            "text",
            true,
            words::repetitions(&record.repeats),
        );
    }
    for case in &record.after {
        add("Drawn after", "case", true, case.clone());
    }
    for case in &record.blocked_by {
        add("Blocked by", "case", true, case.clone());
    }
    if record.texels.wrong + record.texels.imprecise + record.texels.open > 0 {
        add("Samples", "text", true, counts(record));
    }
    for assertion in &record.assertions {
        add("Asserted", "text", false, asserted(assertion));
    }
    for counter in &record.counters {
        add("Counter", "text", true, counted(counter));
    }
    if let Some(m) = &record.measured {
        let rmse = percent(m.distance.rmse, 1);
        let mut text = format!("{} of {}: RMSE {rmse}", m.method, m.scene);
        if let Some(time) = &m.time {
            text += &format!(", {} per frame", duration(time.wall));
        }
        add("Measured", "text", false, text);
    }
    // Selftests of a file that fail as due differ in nothing that matters.
    let example = record.example.as_ref().filter(|_| !record.due_fail);
    if let Some(case) = example {
        add("Shown in full by", "example", true, case.clone());
    }
    if let Some(frame) = &record.frame {
        add("Frame", "code", true, frame.clone());
    }
    facts
}

/// Returns the facts that belong to a record's pictures, as a list.
pub(crate) fn list(record: &Record) -> Markup {
    let facts = of(record).into_iter();
    let listed = |(_, form, in_body): Label| in_body && !["lead", "known"].contains(&form);
    let facts: Vec<_> = facts.filter(|(label, _)| listed(*label)).collect();
    html! {
        @if !facts.is_empty() {
            dl.facts { @for ((name, form, _), text) in &facts {
                dt { (name) }
                dd { @match *form {
                    "pre" => pre { (text) },
                    "code" => code { (text) },
                    "case" | "example" => a href=(link::case(text)) { code { (text) } },
                    _ => (text),
                } }
            } }
        }
    }
}

/// Returns the counts of samples by outcome.
fn counts(record: &Record) -> String {
    let t = &record.texels;
    format!(
        "Of {}, {} outside the legal set, {} legal and outside the yardstick, {} open.",
        count(t.total, "sample"),
        t.wrong,
        t.imprecise,
        t.open
    )
}

fn asserted(a: &Assertion) -> String {
    let mut text = format!(
        "{}: {} of {}, {} of them exactly",
        a.aspect.name(),
        a.asserted,
        count(a.channels, "channel"),
        a.exact
    );
    if let Some(sharpness) = a.sharpness() {
        text += &format!(", sharpness {sharpness:.2}");
    }
    text
}

fn counted(c: &CounterOutcome) -> String {
    let outcome = match c.band {
        Some(Band::Fail) => "✗ illegal: ",
        Some(Band::RequiredByCts) => "⊠ forbidden by the Khronos CTS: ",
        Some(Band::Disputed) => "? forbidden by a disputed reading: ",
        Some(Band::Imprecise) => "• outside the yardstick: ",
        None => "",
    };
    let legal = if c.is_asserted() {
        format!("legal {}", c.range())
    } else {
        "nothing is asserted".to_owned()
    };
    format!(
        "{outcome}{} ({}): {}, {legal}",
        c.name,
        c.kind.name(),
        c.actual
    )
}

/// Returns a text, or only its end if it is too long for the page.
fn end(text: &str) -> String {
    match text.char_indices().rev().nth(LONGEST) {
        None => text.to_owned(),
        Some((start, c)) => format!("… {}", &text[start + c.len_utf8()..]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::{ProcessEnd, Verdict};

    #[test]
    fn a_long_message_keeps_its_end() {
        let text = format!("ä{}z", "x".repeat(LONGEST));
        let cut = end(&text);
        assert!(cut.starts_with("… x") && cut.ends_with("xz"));
        assert_eq!(cut.chars().count(), LONGEST + 2);
        assert_eq!(end("short"), "short");
    }

    #[test]
    fn a_record_lists_only_the_facts_that_it_holds() {
        let mut record = Record::new("a/b", "cpu", Verdict::Pass);
        assert_eq!(of(&record), []);
        record.verdict = Verdict::Crash;
        record.repeats = vec![Verdict::Pass, Verdict::Crash];
        record.after = vec!["a/a".to_owned()];
        record.validation = vec!["VUID-1".to_owned(), "VUID-2".to_owned()];
        record.process = Some(ProcessEnd {
            signal: Some(11),
            stderr: "last words".to_owned(),
            ..ProcessEnd::default()
        });
        let facts = of(&record);
        let labels: Vec<&str> = facts.iter().map(|((label, ..), _)| *label).collect();
        let expected = [
            "In short",
            "Process",
            "Standard error",
            "Validation",
            "Validation",
            "Repeated",
            "Drawn after",
        ];
        assert_eq!(labels, expected);
    }
}
