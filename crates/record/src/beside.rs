//! Records of a run beside those of its selected cases: what an adapter denies although its API's version requires
//! it, and workers that fail after their last case.
//!
//! Expectations apply to them as to all records, and unexpected ones count against the run.

use crate::error::RecordError;
use crate::folder::BESIDE_FILE;
use crate::json_file::read_json;
use crate::output_folder::OutputFolder;
use crate::record::Record;
use std::path::Path;

/// The id that stands for the end of an adapter's workers, after their last cases: in the destruction of a device, or
/// in what a driver does at exit.
pub const WORKER_END: &str = "worker/end";

/// Adds records to a list. If several records state the same about an adapter, keeps an unexpected one, or else
/// the first.
pub fn add(list: &mut Vec<Record>, more: impl IntoIterator<Item = Record>) {
    let ending = |record: &Record| record.process.as_ref().map(|p| (p.signal, p.exit));
    for record in more {
        let same = |other: &&mut Record| {
            other.adapter == record.adapter
                && other.case == record.case
                && other.verdict == record.verdict
                && ending(other) == ending(&record)
        };
        match list.iter_mut().find(same) {
            Some(other) if record.unexpected() && !other.unexpected() => *other = record,
            Some(_) => {}
            None => list.push(record),
        }
    }
}

/// Writes a list into a run folder; without records, removes the list of an earlier run.
///
/// # Errors
/// If the file cannot be written or removed.
pub fn write(folder: &Path, list: &[Record]) -> Result<(), RecordError> {
    let what = "the records beside the selected cases";
    OutputFolder::open(folder)?.write_json(BESIDE_FILE, what, list)
}

/// Reads the list in a run folder; returns none if the folder has no list.
///
/// # Errors
/// If the list cannot be read or does not parse.
pub fn read(folder: &Path) -> Result<Vec<Record>, RecordError> {
    read_json(folder, BESIDE_FILE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Expected;
    use crate::verdict::Verdict;

    #[test]
    fn an_unexpected_record_beside_the_cases_is_not_hidden_by_an_expected_one() {
        let unexpected = Record::new(WORKER_END, "cpu", Verdict::Crash);
        let mut expected = unexpected.clone();
        expected.expected = Some(Expected {
            reason: "known".to_owned(),
        });
        let other = Record::new(WORKER_END, "gpu", Verdict::Crash);
        let mut list = Vec::new();
        add(
            &mut list,
            [
                expected.clone(),
                other.clone(),
                unexpected.clone(),
                expected,
            ],
        );
        assert_eq!(list, [unexpected, other]);
    }
}
