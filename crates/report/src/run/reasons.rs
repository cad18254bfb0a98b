//! Records by the reason for which they count for nothing: cases that were not drawn, and failures that are known.

use crate::words::{Tone, headline, name};
use etalon_record::{Record, Run, Verdict};
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};

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
    let mut reasons = reasons(run, why_undrawn);
    reasons.sort_by_key(|reason| (place(reason.verdict), Reverse(reason.records())));
    reasons
}

/// Returns the reason why a case was not drawn; `None` if it was.
pub(crate) fn why_undrawn(record: &Record) -> Option<String> {
    let undrawn = UNDRAWN.contains(&record.verdict);
    undrawn.then(|| headline(record))
}

/// Returns the expectations that failures of a run met, the most frequent first. Selftests that are due to fail
/// are not among them.
pub(crate) fn known(run: &Run) -> Vec<ReasonRecords> {
    let mut reasons = reasons(run, why_known);
    reasons.sort_by_key(|reason| Reverse(reason.records()));
    reasons
}

/// Returns the expectation that a failure met; `None` if it met none.
pub(crate) fn why_known(record: &Record) -> Option<String> {
    let expected = record.expected.as_ref();
    let expected = expected.filter(|_| Tone::of(record) == Tone::Excused);
    expected.map(|expected| expected.reason.clone())
}

/// The reasons on a run's page, each with a number: the known failures, then the cases that were not drawn.
pub(crate) struct PageReasons {
    pub(crate) known: Vec<ReasonRecords>,
    pub(crate) undrawn: Vec<ReasonRecords>,
    numbers: HashMap<(Verdict, String), usize>,
}

impl PageReasons {
    pub(crate) fn new(run: &Run) -> Self {
        let (known, undrawn) = (known(run), undrawn(run));
        let all = known.iter().chain(&undrawn).enumerate();
        let key = |reason: &ReasonRecords| (reason.verdict, reason.text.clone());
        Self {
            numbers: all.map(|(number, reason)| (key(reason), number)).collect(),
            known,
            undrawn,
        }
    }

    /// Returns the reasons by number.
    pub(crate) fn texts(&self) -> Vec<&str> {
        let all = self.known.iter().chain(&self.undrawn);
        all.map(|reason| reason.text.as_str()).collect()
    }

    /// Returns the numbers of a record's reasons.
    pub(crate) fn of(&self, record: &Record) -> impl Iterator<Item = usize> {
        let texts = [why_known(record), why_undrawn(record)];
        let numbers = texts.map(|text| self.numbers.get(&(record.verdict, text?)).copied());
        numbers.into_iter().flatten()
    }
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
