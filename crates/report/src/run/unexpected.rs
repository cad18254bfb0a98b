//! The unexpected records of a run, in the order of lists that show only the first of them.

use etalon_record::{Record, Run, Verdict};
use std::cmp::Reverse;
use std::collections::HashMap;

/// Unexpected records, the gravest first. One of each case file, adapter and verdict stands before the
/// second of any: a list of one driver's one bug says little.
pub(crate) fn unexpected_records(run: &Run) -> Vec<&Record> {
    let mut bad: Vec<&Record> = run.records.iter().filter(|r| r.unexpected()).collect();
    bad.sort_by_key(|r| (Reverse(r.verdict.severity()), &r.case, &r.adapter));
    let mut seen: HashMap<(&str, &str, Verdict), usize> = HashMap::new();
    bad.sort_by_cached_key(|r| {
        let rank = seen
            .entry((r.case_file(), &r.adapter, r.verdict))
            .or_default();
        *rank += 1;
        *rank
    });
    bad
}
