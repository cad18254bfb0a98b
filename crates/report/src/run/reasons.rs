//! Records by the reason for which they count for nothing: cases that were not drawn, and failures that are known.

use crate::words::{Tone, headline, name};
use etalon_record::{Record, Run, Verdict};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// The verdicts of cases that were not drawn, the gravest first.
const UNDRAWN: [Verdict; 3] = [Verdict::Blocked, Verdict::Skipped, Verdict::NotSupported];

/// Records of one verdict and one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ReasonRecords {
    pub(crate) verdict: Verdict,
    /// The missing requirement, the failed round trip, the skip rule, or the expectation.
    pub(crate) text: String,
    /// The number of records on each adapter that has any, in the order of the run's adapters.
    pub(crate) adapters: Vec<(String, u64)>,
}

impl ReasonRecords {
    /// Returns the number of records.
    pub(crate) fn records(&self) -> u64 {
        self.adapters.iter().map(|(_, n)| n).sum()
    }

    /// Returns the adapters with their numbers of records: `gl:softpipe 12`.
    pub(crate) fn each(&self) -> Vec<String> {
        let adapters = self.adapters.iter();
        adapters.map(|(name, n)| format!("{name} {n}")).collect()
    }

    /// Returns the verdict and the reason: `blocked: texture format r8unorm does not survive`. The reason alone
    /// if the verdict is NotSupported.
    pub(crate) fn sentence(&self) -> String {
        match self.verdict {
            Verdict::NotSupported => self.text.clone(),
            verdict => format!("{}: {}", name(verdict), self.text),
        }
    }
}

/// Returns the number of records of several reasons.
pub(crate) fn total(reasons: &[ReasonRecords]) -> u64 {
    reasons.iter().map(ReasonRecords::records).sum()
}

/// Returns the reasons why cases of a run were not drawn, by verdict, the most frequent first.
pub(crate) fn undrawn(run: &Run) -> Vec<ReasonRecords> {
    let place = |verdict| UNDRAWN.iter().position(|v| *v == verdict);
    let mut reasons = reasons(run, |record| {
        place(record.verdict).map(|_| headline(record))
    });
    reasons.sort_by_key(|reason| (place(reason.verdict), Reverse(reason.records())));
    reasons
}

/// Returns the expectations that failures of a run met, the most frequent first. Selftests that are due to fail
/// are not among them.
pub(crate) fn known(run: &Run) -> Vec<ReasonRecords> {
    let mut reasons = reasons(run, |record| {
        let expected = record.expected.as_ref();
        let expected = expected.filter(|_| Tone::of(record) == Tone::Excused);
        expected.map(|expected| expected.reason.clone())
    });
    reasons.sort_by_key(|reason| Reverse(reason.records()));
    reasons
}

/// Returns the records that have a reason, by verdict and reason.
fn reasons(run: &Run, reason: impl Fn(&Record) -> Option<String>) -> Vec<ReasonRecords> {
    let mut found: BTreeMap<(Verdict, String), BTreeMap<usize, u64>> = BTreeMap::new();
    let adapters = &run.header.adapters;
    for record in run.all_records() {
        let Some(reason) = reason(record) else {
            continue;
        };
        let place = adapters.iter().position(|a| a.info.name == record.adapter);
        let counts = found.entry((record.verdict, reason)).or_default();
        *counts.entry(place.unwrap_or(usize::MAX)).or_default() += 1;
    }
    let named = |(place, n): (usize, u64)| {
        let name = adapters.get(place).map_or("?", |a| &a.info.name);
        (name.to_owned(), n)
    };
    let found = found.into_iter();
    found
        .map(|((verdict, text), counts)| ReasonRecords {
            verdict,
            text,
            adapters: counts.into_iter().map(named).collect(),
        })
        .collect()
}
