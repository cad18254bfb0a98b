//! One known verdict: the common form of an entry of a list and of a finding.

use crate::expected_symptom::{ExpectedSymptom, SymptomParts};
use crate::findings::Finding;
use crate::grade::Grade;
use crate::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// One entry of a list of expectations: a known verdict.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// A glob over adapter names.
    pub adapter: String,
    /// A glob over [`driver_text`](crate::AdapterRecord::driver_text), driver and version; `*` for any.
    pub driver: String,
    /// A glob over the device's name; any device if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// The driver versions to which the entry applies, as comparisons that must all be true: `>=22.3, <25.1`;
    /// every version if absent. A driver that reports no version with a dot is in no range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// A glob over case ids; `*` also matches `/`.
    pub case: String,
    /// The expected verdict, which alone is excused. `flaky` excuses every bad verdict, and `skipped`
    /// prevents the case from being drawn.
    pub verdict: Verdict,
    /// The symptom of the failure; other wrong values of the same case are not excused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symptom: Option<ExpectedSymptom>,
    /// A glob over the machine's processor; any processor if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub processor: Option<String>,
    /// Labels that the run must have, as `key=value`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<String>,
    /// The reason why the verdict is accepted.
    pub reason: String,
    /// The evidence: a bug report, a section of a specification.
    pub evidence: String,
    /// The grade of the evidence, if stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grade: Option<Grade>,
    /// The bug report's address.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<String>,
    /// The last day on which the entry applies, as `2027-01-31`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expires: Option<String>,
}

/// The parts of an expectation's file that matching does not use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KnownSource {
    /// An entry of a list.
    Entry {
        /// The entry's evidence.
        evidence: String,
        /// The grade of the evidence, if stated.
        grade: Option<Grade>,
        /// The bug report's address.
        link: Option<String>,
    },
    /// A finding, the only one of its file.
    Finding(Box<Finding>),
}

/// One expectation: known verdicts of cases on adapters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// Globs over adapter names.
    pub adapters: Vec<String>,
    /// A glob over driver and version.
    pub driver: String,
    /// A glob over the device's name; any device if `None`.
    pub device: Option<String>,
    /// A range of driver versions, such as `>=22.3, <25.1`; every version if `None`.
    pub version: Option<String>,
    /// Globs over case ids.
    pub cases: Vec<String>,
    /// Globs over facts of draws: without one draw that has them all, a failure is another bug.
    pub needs: Vec<String>,
    /// The verdict that is expected of every case that the expectation names.
    pub verdict: Verdict,
    /// The reason why the verdict is accepted; for a finding, its title.
    pub reason: String,
    /// The last day on which the expectation applies, as `2027-01-31`; it has no end if `None`.
    pub expires: Option<String>,
    /// What the wrong values have in common; any wrong values if `None`.
    pub symptom: Option<ExpectedSymptom>,
    /// A glob over the processor of the machine; any processor if `None`.
    pub processor: Option<String>,
    /// Labels that the run must have, as `key=value`.
    pub labels: Vec<String>,
    /// The expectation file, as errors and reports name it.
    pub path: Arc<Path>,
    /// The number in a list, from 1; `None` for a finding.
    pub number: Option<usize>,
    /// The form of the file, with what only this form has.
    pub source: KnownSource,
}

impl Known {
    pub(crate) fn of_entry(entry: Entry, number: usize, path: &Arc<Path>) -> Self {
        Self {
            adapters: vec![entry.adapter],
            driver: entry.driver,
            device: entry.device,
            version: entry.version,
            cases: vec![entry.case],
            needs: Vec::new(),
            verdict: entry.verdict,
            reason: entry.reason,
            expires: entry.expires,
            symptom: entry.symptom,
            processor: entry.processor,
            labels: entry.labels,
            path: Arc::clone(path),
            number: Some(number),
            source: KnownSource::Entry {
                evidence: entry.evidence,
                grade: entry.grade,
                link: entry.link,
            },
        }
    }

    /// Returns what a finding says of its adapters, and of each one that draws further cases wrong.
    pub(crate) fn of_finding(finding: &Finding, path: &Path) -> Vec<Self> {
        let own = (finding.adapters.clone(), finding.cases.clone());
        let beside = finding.beside.iter();
        let beside = beside.map(|(adapter, cases)| (vec![adapter.clone()], cases.clone()));
        std::iter::once(own)
            .chain(beside)
            .map(|named| Self::of_part(finding, named, path))
            .collect()
    }

    /// Returns what a finding says of adapters and cases.
    fn of_part(
        finding: &Finding,
        (adapters, cases): (Vec<String>, Vec<String>),
        path: &Path,
    ) -> Self {
        Self {
            adapters,
            driver: finding.driver.clone(),
            device: finding.device.clone(),
            version: finding.versions.clone(),
            cases,
            needs: finding.needs.clone(),
            verdict: finding.expected(),
            reason: finding.title.clone(),
            expires: finding.expires.clone(),
            symptom: finding.symptom.clone(),
            processor: finding.processor.clone(),
            labels: finding.labels.clone(),
            path: path.into(),
            number: None,
            source: KnownSource::Finding(Box::new(finding.clone())),
        }
    }

    /// Returns the entry that this expectation was read from; `None` for a finding.
    pub fn entry(&self) -> Option<Entry> {
        let KnownSource::Entry {
            evidence,
            grade,
            link,
        } = &self.source
        else {
            return None;
        };
        Some(Entry {
            adapter: self.adapters.first()?.clone(),
            driver: self.driver.clone(),
            device: self.device.clone(),
            version: self.version.clone(),
            case: self.cases.first()?.clone(),
            verdict: self.verdict,
            symptom: self.symptom.clone(),
            processor: self.processor.clone(),
            labels: self.labels.clone(),
            reason: self.reason.clone(),
            evidence: evidence.clone(),
            grade: *grade,
            link: link.clone(),
            expires: self.expires.clone(),
        })
    }

    /// Returns the file and the entry's number, for messages.
    pub fn place(&self) -> String {
        let path = self.path.display();
        match self.number {
            None => path.to_string(),
            Some(number) => format!("{path}: entry {number}"),
        }
    }

    /// Returns the name of a finding, which is its file's; for an entry, its file and number.
    pub fn name(&self) -> String {
        match (self.number, self.path.file_stem()) {
            (None, Some(stem)) => stem.to_string_lossy().into_owned(),
            _ => self.place(),
        }
    }

    /// Returns true if the expectation excuses a verdict. An entry excuses only its own verdict. A finding
    /// also excuses violations on weaker evidence, because its bug can show as a weaker violation in some
    /// cases. `flaky` excuses every bad verdict.
    pub fn excuses(&self, verdict: Verdict) -> bool {
        let finding = matches!(self.source, KnownSource::Finding(_));
        self.verdict == verdict
            || self.verdict == Verdict::Flaky && verdict.is_bad()
            || finding
                && self.verdict.is_violation()
                && verdict.is_violation()
                && verdict.severity() < self.verdict.severity()
    }

    /// Returns true if the expectation excuses a record: its verdict, and for a violation also its symptom.
    pub fn excuses_record(&self, record: SymptomParts<'_>) -> bool {
        let shown = |symptom: &ExpectedSymptom| {
            !record.verdict.is_violation() || symptom.is_shown_by(record)
        };
        self.excuses(record.verdict) && self.symptom.as_ref().is_none_or(shown)
    }
}
