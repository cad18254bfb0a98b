//! A run in one line.

use super::record::headline;
use super::verdict::{Tone, name};
use crate::command;
use crate::numbers::thousands;
use etalon_record::{Record, Run};
use std::cmp::Reverse;
use std::collections::HashSet;

/// Returns the conclusion of a run: `✓ 2,723 cases on 4 adapters: nothing unexpected; 12 known bugs; 90 selftests
/// failed as due`, or `✗ 3 new failures: first …; etalon explain …`.
pub fn conclusion(run: &Run) -> String {
    match new_failures(run) {
        Some((failures, first)) => {
            let (case, adapter) = (&first.case, &first.adapter);
            let (why, command) = (why(first), command::explain(first));
            format!("✗ {failures}: first {case} on {adapter}, {why}; {command}")
        }
        None => nothing_unexpected(run),
    }
}

/// Returns the number of unexpected records in words, and the gravest of them; `None` if nothing is unexpected.
pub(crate) fn new_failures(run: &Run) -> Option<(String, &Record)> {
    let bad = run.all_records().filter(|record| record.unexpected());
    let selected = run.records.iter().filter(|record| record.unexpected());
    let gravest = |r: &&Record| {
        (
            Reverse(r.verdict.severity()),
            r.case.clone(),
            r.adapter.clone(),
        )
    };
    let first = selected.min_by_key(gravest);
    let first = first.or_else(|| {
        run.beside
            .iter()
            .filter(|r| r.unexpected())
            .min_by_key(gravest)
    })?;
    Some((counted(bad.count() as u64, "new failure"), first))
}

/// Returns the conclusion of a run without new failures.
pub(crate) fn nothing_unexpected(run: &Run) -> String {
    let mut reasons = HashSet::new();
    let mut selftests = HashSet::new();
    for record in run.all_records() {
        match (Tone::of(record), &record.expected) {
            (Tone::Excused, Some(expected)) => _ = reasons.insert(&*expected.reason),
            (Tone::Due, _) => _ = selftests.insert(&*record.case),
            _ => {}
        }
    }
    let (cases, adapters) = (run.header.cases, run.header.adapters.len() as u64);
    let scope = format!(
        "{} on {}",
        counted(cases, "case"),
        counted(adapters, "adapter")
    );
    let mut text = if run.missing() > 0 {
        format!(
            "! {scope}: {} missing, nothing unexpected among the others",
            counted(run.missing(), "record")
        )
    } else if run.records.iter().any(Record::is_drawn) {
        format!("✓ {scope}: nothing unexpected")
    } else {
        format!("! {scope}: nothing was drawn")
    };
    let improvements = run.records.iter().filter(|r| r.improvement()).count() as u64;
    for (n, what, outcome) in [
        (reasons.len() as u64, "known bug", ""),
        (selftests.len() as u64, "selftest", " failed as due"),
        (improvements, "improvement", ""),
    ] {
        if n > 0 {
            text += &format!("; {}{outcome}", counted(n, what));
        }
    }
    text
}

/// Returns the verdict and the reason of a record.
pub(crate) fn why(record: &Record) -> String {
    let text = format!("{}: {}", name(record.verdict), headline(record));
    super::plain(&text, 160)
}

/// Returns a count with separators: `2,723 cases`.
pub(crate) fn counted(n: u64, noun: &str) -> String {
    let digits = thousands(n).replace('\u{202f}', ",");
    format!("{digits} {noun}{}", if n == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::{Expected, Header, Verdict};

    fn run(records: Vec<Record>, cases: u64) -> Run {
        let mut header = Header::new(Vec::new(), cases);
        header.adapters = Vec::new();
        Run {
            header,
            records,
            beside: Vec::new(),
            truncated: false,
        }
    }

    #[test]
    fn a_run_ends_with_what_is_wrong_or_with_what_is_known() {
        let pass = Record::new("a/b", "x", Verdict::Pass);
        let mut known = Record::new("a/c", "x", Verdict::Fail);
        known.expected = Some(Expected {
            reason: "a bug".to_owned(),
        });
        let mut due = Record::new("selftest/d", "x", Verdict::Fail);
        due.due_fail = true;
        let mut records = vec![
            pass,
            known.clone(),
            Record {
                case: "a/e".to_owned(),
                ..known
            },
            due,
        ];
        let text = "✓ 2,736 cases on 0 adapters: nothing unexpected; 1 known bug; 1 selftest failed as due";
        assert_eq!(conclusion(&run(records.clone(), 2736)), text);
        records.push(Record::new("a/f", "gl:x", Verdict::Fail));
        let text = "✗ 1 new failure: first a/f on gl:x, fail: A texel lies outside what the API's text allows.; etalon run a/f --adapter gl:x";
        assert_eq!(conclusion(&run(records, 1)), text);
        let undrawn = Record::new("a/b", "x", Verdict::NotSupported);
        let text = "! 1 case on 0 adapters: nothing was drawn";
        assert_eq!(conclusion(&run(vec![undrawn], 1)), text);
    }
}
