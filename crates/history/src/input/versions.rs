//! Reading a `versions.jsonl`: one run per release of the line.
//!
//! `etalon bisect` does not draw every case with every release: a release between two with the same
//! standing is assumed to have that standing too. The history stores these outcomes and marks them as
//! inferred, so that all releases have the same cases.

use super::started::started;
use crate::adapter::Adapter;
use crate::dates::ReleaseDates;
use crate::digest::{Digesting, of_parts};
use crate::error::HistoryError;
use crate::kind::Kind;
use crate::new_run::{NewAdapter, NewRun};
use crate::outcome::Outcome;
use etalon_frame::{AdapterInfo, AdapterName};
use etalon_record::{CaseVersions, Labels, ReleaseRecord, Verdict, Versions};
use std::io::Read;
use std::path::Path;

pub(super) fn read(
    path: &Path,
    mut text: Digesting<impl Read>,
    dates: &ReleaseDates,
) -> Result<Vec<NewRun>, HistoryError> {
    let Versions { header, cases } = Versions::parse(path, &mut text)?;
    let (digest, header_digest) = text.digests();
    let started = started(path, &header.provenance.started)?;
    let mut runs = Vec::with_capacity(header.releases.len());
    for release in &header.releases {
        let version = &release.version;
        runs.push(NewRun {
            digest: of_parts(&[&digest, version.as_bytes()]),
            header: of_parts(&[&header_digest, version.as_bytes()]),
            kind: Kind::Release,
            etalon: header.provenance.etalon.clone(),
            commit: header.provenance.commit.clone(),
            machine: header.provenance.machine.clone(),
            started,
            released: dates.of(&header.line, version),
            profile: None,
            ruler: None,
            missing: 0,
            labels: Labels::new(),
            adapters: vec![adapter(&header.line, release)],
        });
    }
    for case in &cases {
        for (run, outcome) in runs.iter_mut().zip(outcomes(case)) {
            if let (Some(adapter), Some(outcome)) = (run.adapters.first_mut(), outcome) {
                adapter.take(case.case.clone(), outcome);
            }
        }
    }
    Ok(runs)
}

fn adapter(line: &str, release: &ReleaseRecord) -> NewAdapter {
    let name = &release.adapter;
    let parts = AdapterName::new(name);
    let adapter = Adapter {
        info: AdapterInfo {
            name: name.clone(),
            backend: parts.backend().to_owned(),
            driver: release.driver.clone(),
            driver_version: release.version.clone(),
            ..AdapterInfo::default()
        },
        line: line.to_owned(),
        version: release.version.clone(),
    };
    NewAdapter {
        timeline: parts.without_release().to_owned(),
        ..NewAdapter::new(adapter)
    }
}

/// Returns the outcome of a case by release; `None` if it is unknown.
fn outcomes(case: &CaseVersions) -> impl Iterator<Item = Option<Outcome>> + '_ {
    let mut before: Option<Verdict> = None;
    let each = case.verdicts.iter().zip(case.standings());
    each.map(move |(drawn, standing)| {
        let outcome = |verdict: Verdict| Outcome {
            expected: case.finding.clone().filter(|_| verdict.is_bad()),
            inferred: drawn.is_none(),
            ..Outcome::new(verdict)
        };
        before = drawn.or(before);
        match drawn {
            Some(verdict) => Some(outcome(*verdict)),
            // A release with an inferred standing follows one that was drawn.
            None => standing.and(before).map(outcome),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_undrawn_release_between_equal_verdicts_is_inferred() {
        let case = CaseVersions {
            case: "a/b".to_owned(),
            finding: Some("a-finding".to_owned()),
            verdicts: vec![
                Some(Verdict::Fail),
                None,
                Some(Verdict::Fail),
                None,
                Some(Verdict::Pass),
                None,
            ],
        };
        let found: Vec<_> = outcomes(&case)
            .map(|o| o.map(|o| (o.verdict, o.inferred, o.expected.is_some())))
            .collect();
        assert_eq!(
            found,
            [
                Some((Verdict::Fail, false, true)),
                Some((Verdict::Fail, true, true)),
                Some((Verdict::Fail, false, true)),
                None,
                Some((Verdict::Pass, false, false)),
                None,
            ]
        );
    }
}
