//! Cases that were not drawn, by reason: what is green says nothing about them.

use crate::words::{headline, name};
use etalon_record::{Run, Verdict};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// The verdicts of cases that were not drawn, the most serious first.
const VERDICTS: [Verdict; 3] = [Verdict::Blocked, Verdict::NotSupported, Verdict::Skipped];

/// Records of cases that were not drawn for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Undrawn {
    /// The verdict.
    pub(crate) verdict: Verdict,
    /// The reason: what is missing, what failed, or what skips them.
    pub(crate) reason: String,
    /// How many there are on each adapter that has any, in the order of the run's adapters.
    pub(crate) adapters: Vec<(String, u64)>,
}

impl Undrawn {
    /// The number of records.
    pub(crate) fn records(&self) -> u64 {
        self.adapters.iter().map(|(_, n)| n).sum()
    }

    /// The number of records on an adapter.
    pub(crate) fn on(&self, adapter: &str) -> u64 {
        let mut adapters = self.adapters.iter();
        adapters
            .find(|(name, _)| name == adapter)
            .map_or(0, |(_, n)| *n)
    }

    /// `blocked: texture format r8unorm does not survive`; what is not supported needs no word before it.
    pub(crate) fn text(&self) -> String {
        match self.verdict {
            Verdict::NotSupported => self.reason.clone(),
            verdict => format!("{}: {}", name(verdict), self.reason),
        }
    }
}

/// The reasons of a run, by verdict, the most frequent first.
pub(crate) fn undrawn(run: &Run) -> Vec<Undrawn> {
    let mut found: BTreeMap<(usize, String), BTreeMap<usize, u64>> = BTreeMap::new();
    let place = |name: &str| {
        let mut adapters = run.header.adapters.iter();
        adapters.position(|a| a.name == name).unwrap_or(usize::MAX)
    };
    for record in &run.records {
        let Some(verdict) = VERDICTS.iter().position(|v| *v == record.verdict) else {
            continue;
        };
        let counts = found.entry((verdict, headline(record))).or_default();
        *counts.entry(place(&record.adapter)).or_default() += 1;
    }
    let adapter = |(column, n): (usize, u64)| {
        let adapter = run.header.adapters.get(column);
        (
            adapter.map_or_else(|| "?".to_owned(), |a| a.name.clone()),
            n,
        )
    };
    let mut reasons: Vec<Undrawn> = found
        .into_iter()
        .map(|((verdict, reason), adapters)| Undrawn {
            verdict: VERDICTS[verdict],
            reason,
            adapters: adapters.into_iter().map(adapter).collect(),
        })
        .collect();
    let place = |u: &Undrawn| VERDICTS.iter().position(|v| *v == u.verdict);
    reasons.sort_by_key(|u| (place(u), Reverse(u.records())));
    reasons
}
