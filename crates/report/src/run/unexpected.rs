//! The unexpected records of a run, for lists that show only the first of them.

use crate::lists;
use etalon_record::{Record, Run};
use std::cmp::Reverse;

/// Returns the unexpected records, the most serious first. The first record of every case file, adapter and
/// verdict comes before any second one, so that a short list shows more than one driver bug.
pub(crate) fn unexpected_records(run: &Run) -> Vec<&Record> {
    let mut bad: Vec<&Record> = run.all_records().filter(|r| r.unexpected()).collect();
    bad.sort_by_key(|r| (Reverse(r.verdict.severity()), &r.case, &r.adapter));
    lists::spread(&mut bad, |r| (r.parts().file(), &*r.adapter, r.verdict));
    bad
}
