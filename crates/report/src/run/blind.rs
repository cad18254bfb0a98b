//! Where known bugs leave no case that could show another one.

use crate::run::reasons::ReasonRecords;
use crate::words::Tone;
use etalon_frame::CaseId;
use etalon_record::{Record, Verdict};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// The least number of drawn cases: fewer are too few to speak of a kind.
const LEAST: u64 = 4;

/// The number of cases that an adapter drew, and the number that it drew wrong as expected.
#[derive(Clone, Copy, Default)]
struct Drawn {
    all: u64,
    known: u64,
}

impl Drawn {
    fn is_blind(self) -> bool {
        self.all >= LEAST && self.known == self.all
    }
}

/// Returns the families of cases, and the values of their axes (`sequence/layers/layers=multiview`), in which an adapter
/// draws each case wrong as expected, the ones with most cases first. A value is named only if its family is not.
pub(crate) fn blind_spots<'r>(records: impl Iterator<Item = &'r Record>) -> Vec<ReasonRecords> {
    // By adapter, family, and a value of an axis; without a value, the whole family.
    let mut kinds: BTreeMap<_, Drawn> = BTreeMap::new();
    for record in records.filter(|record| record.is_drawn() && !record.due_fail) {
        let known = u64::from(Tone::of(record) == Tone::Excused);
        let case = CaseId::new(&record.case);
        for value in std::iter::once(None).chain(case.axes().map(Some)) {
            let kind = (record.adapter.as_str(), case.file(), value);
            let drawn = kinds.entry(kind).or_default();
            drawn.all += 1;
            drawn.known += known;
        }
    }
    let mut spots: BTreeMap<String, Vec<(String, u64)>> = BTreeMap::new();
    for ((adapter, family, value), drawn) in kinds.iter().filter(|(_, drawn)| drawn.is_blind()) {
        let cases = match value {
            None => (*family).to_owned(),
            Some(_) if kinds[&(*adapter, *family, None)].is_blind() => continue,
            Some((axis, value)) => format!("{family}/{axis}={value}"),
        };
        let adapters = spots.entry(cases).or_default();
        adapters.push(((*adapter).to_owned(), drawn.all));
    }
    let mut spots: Vec<ReasonRecords> = spots
        .into_iter()
        .map(|(text, adapters)| ReasonRecords {
            verdict: Verdict::Fail,
            text,
            adapters,
        })
        .collect();
    spots.sort_by_key(|spot| Reverse(spot.records()));
    spots
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::Expected;

    #[test]
    fn cases_of_which_each_is_a_known_failure_are_named_by_the_value_that_they_share() {
        let record = |case: &str, adapter: &str, verdict: Verdict| {
            let known = verdict == Verdict::Fail;
            let reason = "a bug".to_owned();
            Record {
                expected: known.then_some(Expected { reason }),
                ..Record::new(case, adapter, verdict)
            }
        };
        let mut records = Vec::new();
        for number in 0..4 {
            let case = |rest: &str| format!("a/b/n={number}/{rest}");
            records.push(record(&case("layers=many"), "one", Verdict::Fail));
            records.push(record(&case("layers=many"), "two", Verdict::Pass));
            records.push(record(&case("layers=one"), "one", Verdict::Pass));
            records.push(record(&case("layers=none"), "one", Verdict::NotSupported));
            records.push(record(&format!("a/c/n={number}"), "two", Verdict::Fail));
        }
        let spots = |records: &[Record]| -> Vec<(String, Vec<String>)> {
            let spots = blind_spots(records.iter());
            spots.iter().map(|s| (s.text.clone(), s.each())).collect()
        };
        let expected = [
            ("a/b/layers=many".to_owned(), vec!["one 4".to_owned()]),
            ("a/c".to_owned(), vec!["two 4".to_owned()]),
        ];
        assert_eq!(spots(&records), expected);
        // An unexpected failure can be seen.
        records[0].expected = None;
        assert_eq!(spots(&records), expected[1..]);
        // Three cases are no kind.
        assert_eq!(spots(&records[..15]), []);
    }
}
