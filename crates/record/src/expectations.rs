//! Expectations: known bad verdicts with their explanation.
//!
//! They come from two kinds of files: lists of entries, and findings with one bug per file. [`Known`] is
//! the common form in which they are looked up.

use crate::adapter::AdapterRecord;
use crate::date::check_date;
use crate::driver_version::version_of;
use crate::error::RecordError;
use crate::expected_symptom::{ExpectedSymptom, Shown};
use crate::findings::{self, Finding};
use crate::grade::Grade;
use crate::json::without_position;
use crate::verdict::Verdict;
use etalon_frame::{shortened, without_mark};
use etalon_glob::{Glob, GlobIndex};
use semver::VersionReq;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// One entry of a list of expectations: a known verdict.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// A glob over adapter names.
    pub adapter: String,
    /// A glob over [`AdapterRecord::driver_text`], driver and version; `*` for any.
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

/// The file form of a list.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenList {
    entries: Vec<Entry>,
}

/// The file form of an expectation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// An entry of a list.
    Entry(Entry),
    /// A finding, the only one of its file.
    Finding(Finding),
}

/// One expectation: known verdicts of cases on adapters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// Globs over adapter names.
    pub adapters: Vec<String>,
    /// A glob over driver and version.
    pub driver: String,
    /// A glob over the device's name.
    pub device: Option<String>,
    /// A range of driver versions.
    pub version: Option<String>,
    /// Globs over case ids.
    pub cases: Vec<String>,
    /// The expected verdict.
    pub verdict: Verdict,
    /// The reason why the verdict is accepted; for a finding, its title.
    pub reason: String,
    /// The last day on which the expectation applies.
    pub expires: Option<String>,
    /// The symptom of the failure.
    pub symptom: Option<ExpectedSymptom>,
    /// A glob over the processor of the machine.
    pub processor: Option<String>,
    /// Labels that the run must have.
    pub labels: Vec<String>,
    /// The file.
    pub path: PathBuf,
    /// The number in a list, from 1; `None` for a finding.
    pub number: Option<usize>,
    /// The file form.
    pub source: Source,
}

impl Known {
    fn of_entry(entry: Entry, number: usize, path: &Path) -> Self {
        Self {
            adapters: vec![entry.adapter.clone()],
            driver: entry.driver.clone(),
            device: entry.device.clone(),
            version: entry.version.clone(),
            cases: vec![entry.case.clone()],
            verdict: entry.verdict,
            reason: entry.reason.clone(),
            expires: entry.expires.clone(),
            symptom: entry.symptom.clone(),
            processor: entry.processor.clone(),
            labels: entry.labels.clone(),
            path: path.to_owned(),
            number: Some(number),
            source: Source::Entry(entry),
        }
    }

    fn of_finding(finding: Finding, path: &Path) -> Self {
        Self {
            adapters: finding.adapters.clone(),
            driver: finding.driver.clone(),
            device: finding.device.clone(),
            version: finding.versions.clone(),
            cases: finding.cases.clone(),
            verdict: finding.expected(),
            reason: finding.title.clone(),
            expires: finding.expires.clone(),
            symptom: finding.symptom.clone(),
            processor: finding.processor.clone(),
            labels: finding.labels.clone(),
            path: path.to_owned(),
            number: None,
            source: Source::Finding(finding),
        }
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
        let finding = matches!(self.source, Source::Finding(_));
        self.verdict == verdict
            || self.verdict == Verdict::Flaky && verdict.is_bad()
            || finding
                && self.verdict.is_violation()
                && verdict.is_violation()
                && verdict.severity() < self.verdict.severity()
    }

    /// Returns true if the expectation excuses a record: its verdict, and for a violation also its symptom.
    pub fn excuses_record(&self, record: Shown<'_>) -> bool {
        let shown = |symptom: &ExpectedSymptom| {
            !record.verdict.is_violation() || symptom.is_shown_by(record)
        };
        self.excuses(record.verdict) && self.symptom.as_ref().is_none_or(shown)
    }
}

/// Expectations with their compiled globs.
#[derive(Clone, Debug, Default)]
pub struct Expectations {
    all: Vec<Arc<Known>>,
    globs: Vec<Arc<EntryGlobs>>,
    /// The globs over case ids, made when the first case is looked up. Expectations that are all about one adapter share
    /// it with those they were chosen from.
    index: Arc<OnceLock<GlobIndex>>,
    /// The name of the only adapter that the expectations are about, if they were chosen for it.
    only: Option<String>,
    /// Expectations whose last day is before this day, as `2027-01-31`, have expired; if not set, none
    /// have.
    today: Option<String>,
}

#[derive(Clone, Debug)]
struct EntryGlobs {
    adapters: Vec<Glob>,
    driver: Glob,
    device: Option<Glob>,
    version: Option<VersionReq>,
    processor: Option<Glob>,
    /// False if the machine has another processor, or if the run lacks a label.
    applies: bool,
    cases: Vec<Glob>,
}

/// Returns true if a glob matches or is absent.
fn matches_if_given(glob: Option<&Glob>, text: &str) -> bool {
    glob.is_none_or(|glob| glob.is_match(text))
}

impl EntryGlobs {
    fn match_adapter(&self, adapter: &AdapterRecord) -> bool {
        let named = |name: &str| self.adapters.iter().any(|g| g.is_match(name));
        self.applies
            && (named(&adapter.name) || named(adapter.without_release()))
            && self.driver.is_match(&adapter.driver_text())
            && matches_if_given(self.device.as_ref(), &adapter.device)
            && self.version.as_ref().is_none_or(|range| {
                version_of(adapter).is_some_and(|version| range.matches(&version))
            })
    }

    fn match_case(&self, case: &str) -> bool {
        self.cases.iter().any(|glob| glob.is_match(case))
    }
}

/// The relation of a verdict to the expectations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation<'a> {
    /// No expectation names the case.
    None,
    /// The verdict is excused.
    Agrees(&'a Known),
    /// The verdict is better than expected, so the expectation can be removed.
    Better(&'a Known),
    /// The verdict was excused until the expectation expired.
    Expired(&'a Known),
    /// The verdict is the expected one, but the symptom is another.
    Differs(&'a Known),
}

/// The maximum number of bytes of a file.
const MAX_BYTES: u64 = 64 << 20;
const REMEDY: &str = "each entry needs adapter, driver, case, verdict, reason and evidence";

impl Expectations {
    /// Reads a list of entries, a finding, or a folder of findings in the order of their names.
    ///
    /// # Errors
    /// If a file cannot be read or does not parse, or if a glob in it does not parse; the error names file
    /// and line.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        if !path.is_dir() {
            return Self::parse(&text_of(path)?, path);
        }
        let mut files = Vec::new();
        let mut has_others = false;
        for entry in fs::read_dir(path).map_err(RecordError::io("read", path))? {
            let file = entry.map_err(RecordError::io("read", path))?.path();
            // Reading a pipe would block.
            if file.extension().is_some_and(|e| e == "json") && file.is_file() {
                files.push(file);
            } else {
                let name = entry_name(&file);
                has_others |= !name.starts_with('.') && !name.ends_with(".md");
            }
        }
        if files.is_empty() && has_others {
            return Err(RecordError::NoFinding {
                path: path.to_owned(),
            });
        }
        files.sort();
        let mut expectations = Self::default();
        for file in files {
            let finding = Finding::parse(&text_of(&file)?, &file)?;
            expectations.add(Known::of_finding(finding, &file), &text_of(&file)?)?;
        }
        Ok(expectations)
    }

    /// Parses findings from pairs of a path, which only messages use, and the file's text.
    ///
    /// # Errors
    /// If a text does not parse, or holds an invalid glob.
    pub fn of_findings(files: &[(&str, &str)]) -> Result<Self, RecordError> {
        let mut expectations = Self::default();
        for (path, text) in files {
            let path = Path::new(path);
            expectations.add(Known::of_finding(Finding::parse(text, path)?, path), text)?;
        }
        Ok(expectations)
    }

    /// Parses the text of a list of entries or of a finding. Only messages use `path`. An empty text and
    /// `[]` are empty lists.
    ///
    /// # Errors
    /// If the text does not parse, or holds an invalid glob.
    pub fn parse(text: &str, path: &Path) -> Result<Self, RecordError> {
        let mut expectations = Self::default();
        let text = without_mark(text);
        if text.trim().is_empty() {
            return Ok(expectations);
        }
        // A long list is parsed once.
        let parsed = if text.trim_start().starts_with('[') {
            serde_json::from_str(text)
        } else {
            // Errors in text that is not JSON are reported as errors of a list.
            let value: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
            if value.get("title").is_some() && value.get("entries").is_none() {
                expectations.add(Known::of_finding(Finding::parse(text, path)?, path), text)?;
                return Ok(expectations);
            }
            serde_json::from_str(text).map(|written: WrittenList| written.entries)
        };
        let entries: Vec<Entry> = parsed.map_err(|e| RecordError::Parse {
            path: path.to_owned(),
            line: e.line(),
            message: without_position(&e),
            remedy: REMEDY,
        })?;
        for (i, entry) in entries.into_iter().enumerate() {
            if entry.reason.trim().is_empty() || entry.evidence.trim().is_empty() {
                return Err(RecordError::Parse {
                    path: path.to_owned(),
                    line: line_of(text, &entry.case),
                    message: format!("entry {}: reason and evidence must not be empty", i + 1),
                    remedy: REMEDY,
                });
            }
            expectations.add(Known::of_entry(entry, i + 1, path), text)?;
        }
        Ok(expectations)
    }

    /// Adds an expectation from a file with this text.
    fn add(&mut self, known: Known, text: &str) -> Result<(), RecordError> {
        let (keys, remedy) = match known.number {
            Some(_) => (["adapter", "case", "version"], REMEDY),
            None => (["adapters", "cases", "versions"], findings::REMEDY),
        };
        let place = known
            .number
            .map_or(String::new(), |n| format!("entry {n}: "));
        let fail = |value: &str, message: String| RecordError::Parse {
            path: known.path.clone(),
            line: line_of(text, value),
            message: format!("{place}{message}"),
            remedy,
        };
        let build = |key: &str, glob: &String| {
            Glob::new(glob).map_err(|e| {
                let e = shortened(&e.to_string());
                fail(glob, format!("\"{key}\": {e}"))
            })
        };
        let version = match &known.version {
            None => None,
            Some(range) => Some(VersionReq::parse(range).map_err(|e| {
                let e = shortened(&e.to_string());
                let message = format!(
                    "\"{}\": {e}; ranges are written as \">=22.3, <25.1\"",
                    keys[2]
                );
                fail(range, message)
            })?),
        };
        if let Some(date) = &known.expires {
            check_date("expires", date).map_err(|message| fail(date, message))?;
        }
        let each = |key: &str, globs: &[String]| {
            let each = globs.iter().map(|glob| build(key, glob));
            each.collect::<Result<Vec<_>, _>>()
        };
        let build_if_given = |key: &str, glob: &Option<String>| {
            glob.as_ref().map(|glob| build(key, glob)).transpose()
        };
        if let Some(symptom) = &known.symptom {
            let wrong = if symptom.is_empty() {
                Some("is empty; its keys are attachment, aspect, codes, side and counter")
            } else if !known.verdict.is_violation() && known.verdict != Verdict::Flaky {
                Some("describes a wrong value, which this verdict does not have")
            } else {
                None
            };
            if let Some(wrong) = wrong {
                return Err(fail("symptom", format!("\"symptom\" {wrong}")));
            }
        }
        for label in &known.labels {
            if label.split_once('=').is_none_or(|(key, _)| key.is_empty()) {
                return Err(fail(
                    label,
                    "\"labels\" are written as \"key=value\"".to_owned(),
                ));
            }
        }
        let globs = EntryGlobs {
            version,
            processor: build_if_given("processor", &known.processor)?,
            device: build_if_given("device", &known.device)?,
            applies: true,
            adapters: each(keys[0], &known.adapters)?,
            driver: build("driver", &known.driver)?,
            cases: each(keys[1], &known.cases)?,
        };
        self.all.push(Arc::new(known));
        self.globs.push(Arc::new(globs));
        self.index = Arc::default();
        Ok(())
    }

    /// Returns the expectations that apply to an adapter.
    #[must_use]
    pub fn about(&self, adapter: &AdapterRecord) -> Self {
        let entries = self.all.iter().zip(&self.globs);
        let about = entries.filter(|(_, globs)| globs.match_adapter(adapter));
        let (all, globs): (Vec<_>, Vec<_>) = about.map(|(k, g)| (k.clone(), g.clone())).unzip();
        let index = if all.len() == self.all.len() {
            self.index.clone()
        } else {
            Arc::default()
        };
        Self {
            all,
            globs,
            index,
            only: Some(adapter.name.clone()),
            today: self.today.clone(),
        }
    }

    /// Sets the day, written as `2027-01-31`, on which expectations are checked for expiry.
    #[must_use]
    pub fn on(self, today: &str) -> Self {
        Self {
            today: Some(today.to_owned()),
            ..self
        }
    }

    /// Restricts the expectations to a run with these labels, as `key=value`, on a machine with this
    /// processor.
    #[must_use]
    pub fn of_run(mut self, processor: &str, labels: &[String]) -> Self {
        for (known, globs) in self.all.iter().zip(&mut self.globs) {
            let applies = matches_if_given(globs.processor.as_ref(), processor)
                && known.labels.iter().all(|label| labels.contains(label));
            if globs.applies != applies {
                Arc::make_mut(globs).applies = applies;
            }
        }
        self
    }

    /// Appends the expectations of `others`.
    #[must_use]
    pub fn and(mut self, others: Self) -> Self {
        self.all.extend(others.all);
        self.globs.extend(others.globs);
        self.index = Arc::default();
        self.only = None;
        self
    }

    /// Returns true if an expectation applies to this machine and run.
    pub(crate) fn applies(&self, number: usize) -> bool {
        self.globs.get(number).is_some_and(|globs| globs.applies)
    }

    /// Returns the expectation that prevents drawing a case on an adapter, if any.
    pub fn skips(&self, adapter: &AdapterRecord, case: &str) -> Option<&Known> {
        self.matching(adapter, case)
            .find(|known| known.verdict == Verdict::Skipped && !self.expired(known))
    }

    /// Returns true if an expectation has expired.
    pub fn expired(&self, known: &Known) -> bool {
        match (&self.today, &known.expires) {
            // Dates in this form sort chronologically.
            (Some(today), Some(last)) => today > last,
            _ => false,
        }
    }

    fn matching<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = &'e Known> + use<'e, 'a> {
        self.numbers(adapter, case).map(|number| &*self.all[number])
    }

    /// Returns the numbers of the expectations that name a case on an adapter.
    pub fn numbers<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = usize> + use<'e, 'a> {
        let is_only = self.only.as_ref() == Some(&adapter.name);
        let named = self.naming(case).into_iter();
        named.filter(move |number| is_only || self.globs[*number].match_adapter(adapter))
    }

    /// Returns the numbers of the expectations that name a case, on any adapter.
    pub(crate) fn naming(&self, case: &str) -> Vec<usize> {
        let index = self.index.get_or_init(|| {
            let mut index = GlobIndex::default();
            for (number, globs) in self.globs.iter().enumerate() {
                for glob in &globs.cases {
                    index.add(number, glob);
                }
            }
            index
        });
        index.matches(case)
    }

    /// Returns true if an expectation names a case, on any adapter.
    pub fn names(&self, number: usize, case: &str) -> bool {
        self.globs.get(number).is_some_and(|g| g.match_case(case))
    }

    /// Returns true if an expectation applies to an adapter.
    pub(crate) fn is_about(&self, number: usize, adapter: &AdapterRecord) -> bool {
        let globs = self.globs.get(number);
        globs.is_some_and(|g| g.match_adapter(adapter))
    }

    /// Returns true if an expectation excuses a record. Its cases and adapters are not checked.
    pub(crate) fn excuses(&self, number: usize, record: Shown<'_>) -> bool {
        self.all
            .get(number)
            .is_some_and(|k| k.excuses_record(record))
    }

    /// Returns the expectations that have not expired and name a bad verdict of a case on an adapter.
    pub fn bad<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = &'e Known> + use<'e, 'a> {
        self.matching(adapter, case)
            .filter(|known| known.verdict.is_bad() && !self.expired(known))
    }

    /// Returns the first expectation of [`Expectations::bad`].
    pub fn first_bad(&self, adapter: &AdapterRecord, case: &str) -> Option<&Known> {
        self.bad(adapter, case).next()
    }

    /// Returns the text of a list with these entries.
    ///
    /// # Errors
    /// If an entry cannot be written as JSON.
    pub fn to_text(entries: &[Entry]) -> Result<String, RecordError> {
        let written = WrittenList {
            entries: entries.to_vec(),
        };
        let mut text = serde_json::to_string_pretty(&written)
            .map_err(RecordError::serialize("the expectations"))?;
        text.push('\n');
        Ok(text)
    }

    /// Returns all expectations, in the order of their files.
    pub fn all(&self) -> &[Arc<Known>] {
        &self.all
    }

    /// Returns the entries that come from lists.
    pub fn entries(&self) -> Vec<&Entry> {
        let entries = self.all.iter().filter_map(|known| match &known.source {
            Source::Entry(entry) => Some(entry),
            Source::Finding(_) => None,
        });
        entries.collect()
    }

    /// Looks up a verdict, whatever its symptom. An expectation that agrees takes precedence over one that
    /// names another verdict; otherwise the first one counts.
    pub fn look_up(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        verdict: Verdict,
    ) -> Expectation<'_> {
        self.find(adapter, case, verdict, |known| known.excuses(verdict))
    }

    /// Looks up a record, like [`Expectations::look_up`], but also compares its symptom.
    pub fn look_up_record(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        record: Shown<'_>,
    ) -> Expectation<'_> {
        let agrees = |known: &Known| known.excuses_record(record);
        self.find(adapter, case, record.verdict, agrees)
    }

    fn find(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        verdict: Verdict,
        agrees: impl Fn(&Known) -> bool,
    ) -> Expectation<'_> {
        let matching: Vec<&Known> = self.matching(adapter, case).collect();
        let entries = || matching.iter().copied();
        if let Some(known) = entries().find(|k| agrees(k) && !self.expired(k)) {
            return Expectation::Agrees(known);
        }
        if let Some(known) = entries().find(|k| agrees(k)) {
            return Expectation::Expired(known);
        }
        if let Some(known) = entries().find(|k| k.excuses(verdict) && !self.expired(k)) {
            return Expectation::Differs(known);
        }
        // A case that is no longer supported has not become better, and a flaky case can pass.
        let good =
            !verdict.is_bad() && !matches!(verdict, Verdict::NotSupported | Verdict::Skipped);
        let bad = |k: &&Known| k.verdict.is_bad() && k.verdict != Verdict::Flaky;
        match entries().find(bad) {
            Some(known) if good => Expectation::Better(known),
            _ => Expectation::None,
        }
    }
}

fn entry_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn text_of(path: &Path) -> Result<String, RecordError> {
    let mut text = String::new();
    let read = File::open(path).and_then(|file| {
        file.take(MAX_BYTES + 1).read_to_string(&mut text)?;
        if text.len() as u64 > MAX_BYTES {
            let message = format!("it is longer than {} MiB", MAX_BYTES >> 20);
            return Err(io::Error::other(message));
        }
        Ok(())
    });
    read.map_err(RecordError::io("read", path))?;
    Ok(without_mark(&text).to_owned())
}

/// Returns the first line that contains a string value, for messages; the first line of all if none does.
fn line_of(text: &str, value: &str) -> usize {
    let quoted = serde_json::to_string(value).unwrap_or_default();
    let start = text.find(&quoted).unwrap_or(0);
    text[..start].matches('\n').count() + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapter::Release;
    use etalon_frame::{Api, Limits};

    fn adapter(name: &str, driver: &str, version: &str) -> AdapterRecord {
        AdapterRecord {
            name: name.to_owned(),
            backend: "gl".to_owned(),
            device: String::new(),
            driver: driver.to_owned(),
            driver_version: version.to_owned(),
            driver_id: String::new(),
            api_version: String::new(),
            software: true,
            release: None,
            offer: None,
            limits: Limits {
                api: Api::OpenGl,
                version: etalon_frame::ApiVersion::UNKNOWN,
                properties: Default::default(),
                exempt: Default::default(),
                sub_pixel_bits: 4,
                max_size: 2048,
                max_color_attachments: 8,
                formats: Default::default(),
                features: Default::default(),
                paths: Default::default(),
                sample_positions: Default::default(),
            },
        }
    }

    const TEXT: &str = r#"{ "entries": [
        { "adapter": "gl:*", "driver": "Mesa 25.*", "case": "blend/*/format=rgba8unorm",
          "verdict": "fail", "reason": "saturate is wrong", "evidence": "mesa#1" },
        { "adapter": "*", "driver": "*", "case": "depth/*",
          "verdict": "timeout", "reason": "slow", "evidence": "log" }
    ] }"#;

    #[test]
    fn a_star_also_matches_slashes_and_all_globs_must_match() {
        let e = Expectations::parse(TEXT, Path::new("e.json")).unwrap();
        let soft = adapter("gl:softpipe", "Mesa", "25.0.7");
        let case = "blend/factors/dst=zero/format=rgba8unorm";
        let agrees = |a: &AdapterRecord, c: &str| {
            matches!(e.look_up(a, c, Verdict::Fail), Expectation::Agrees(_))
        };
        assert!(agrees(&soft, case));
        assert!(!agrees(&adapter("vulkan:x", "Mesa", "25.0.7"), case));
        assert!(!agrees(&adapter("gl:x", "Mesa", "24.1"), case));
        assert!(!agrees(&soft, "blend/factors/format=rgba16float"));
        assert_eq!(
            e.look_up(&soft, case, Verdict::Crash),
            Expectation::None,
            "another bad verdict is news"
        );
        assert!(matches!(
            e.look_up(&soft, case, Verdict::Pass),
            Expectation::Better(_)
        ));
        assert_eq!(
            e.look_up(&soft, case, Verdict::NotSupported),
            Expectation::None
        );
    }

    fn one(more: &str, verdict: &str) -> Expectations {
        let text = format!(
            r#"{{ "entries": [ {{ "adapter": "*", "driver": "*", "case": "a/*", "verdict": "{verdict}",
                "reason": "r", "evidence": "e"{more} }} ] }}"#
        );
        Expectations::parse(&text, Path::new("e.json")).unwrap()
    }

    #[test]
    fn a_range_of_versions_holds_the_driver_s() {
        let range = one(r#", "version": ">=22.3, <25.1""#, "fail");
        let found = |version: &str| {
            let adapter = adapter("gl:x", "Mesa", version);
            range.look_up(&adapter, "a/b", Verdict::Fail) != Expectation::None
        };
        assert!(found("Mesa 22.3.6"));
        assert!(found("4.5 (Core Profile) Mesa 25.0.7-2"));
        assert!(!found("Mesa 25.1.0"));
        assert!(!found("Mesa 22.2"));
        assert!(!found("unknown"));
        // The description's version counts, even if the driver reports none or another one.
        let described = |version: &str| {
            let mut adapter = adapter("vulkan:x", "SwiftShader", "Mesa 22.3.6");
            adapter.release = Some(Release {
                line: "swiftshader".to_owned(),
                version: version.to_owned(),
            });
            range.look_up(&adapter, "a/b", Verdict::Fail) != Expectation::None
        };
        let release = adapter("gl:x@25.0", "Mesa", "Mesa 25.0.7");
        let plain = Expectations::parse(
            &TEXT.replace("gl:*", "gl:x").replace("Mesa 25.*", "Mesa *"),
            Path::new("e.json"),
        )
        .unwrap();
        let case = "blend/factors/format=rgba8unorm";
        let agrees = plain.look_up(&release, case, Verdict::Fail);
        assert!(matches!(agrees, Expectation::Agrees(_)), "{agrees:?}");
        assert!(described("23") && described("22.3.0.1"));
        assert!(!described("26"));
    }

    #[test]
    fn a_device_is_a_condition() {
        let software = one(r#", "device": "a software rasterizer*""#, "fail");
        let found = |device: &str| {
            let mut adapter = adapter("webgpu:firefox", "Firefox", "153.0");
            device.clone_into(&mut adapter.device);
            software.look_up(&adapter, "a/b", Verdict::Fail) != Expectation::None
        };
        assert!(found("a software rasterizer without a name"));
        assert!(!found("a device without a name"));
    }

    #[test]
    fn an_entry_that_expired_excuses_nothing() {
        let adapter = adapter("gl:x", "Mesa", "25");
        let dated = one(
            r#", "expires": "2027-01-31", "link": "https://bug""#,
            "fail",
        );
        let on = |day: &str| {
            dated
                .clone()
                .on(day)
                .look_up(&adapter, "a/b", Verdict::Fail)
                == Expectation::Agrees(&dated.all()[0])
        };
        assert!(on("2027-01-31") && !on("2027-02-01"));
        let late = dated.clone().on("2028-01-01");
        assert!(matches!(
            late.look_up(&adapter, "a/b", Verdict::Fail),
            Expectation::Expired(_)
        ));
        let skip = one(r#", "expires": "2027-01-31""#, "skipped");
        assert!(skip.skips(&adapter, "a/b").is_some());
        assert!(skip.skips(&adapter, "b/b").is_none());
        assert!(skip.on("2027-02-01").skips(&adapter, "a/b").is_none());
    }

    #[test]
    fn those_about_an_adapter_have_names_and_are_found_by_case() {
        let finding = |adapter: &str, case: &str| {
            format!(
                r#"{{ "title": "t", "adapters": ["{adapter}"], "driver": "*", "cases": ["{case}"],
                    "grade": "proven", "clause": "c", "evidence": "e" }}"#
            )
        };
        let texts = [("gl:x", "a/*"), ("gl:y", "a/b"), ("gl:*", "a/b")].map(|(a, c)| finding(a, c));
        let files = ["f/one.json", "f/two.json", "f/three.json"];
        let files: Vec<(&str, &str)> = files.into_iter().zip(texts.iter().map(|t| &**t)).collect();
        let adapter = adapter("gl:x", "Mesa", "25");
        let about = Expectations::of_findings(&files).unwrap().about(&adapter);
        let names =
            |case: &str| -> Vec<String> { about.bad(&adapter, case).map(Known::name).collect() };
        assert_eq!(about.all().len(), 2);
        assert_eq!(names("a/b"), ["one", "three"]);
        assert_eq!(names("a/c"), ["one"]);
        assert_eq!(one("", "fail").all()[0].name(), "e.json: entry 1");
    }

    #[test]
    fn a_flake_may_do_anything_but_is_no_improvement() {
        let adapter = adapter("gl:x", "Mesa", "25");
        let flaky = one("", "flaky");
        for verdict in [Verdict::Flaky, Verdict::Fail, Verdict::Crash] {
            let found = flaky.look_up(&adapter, "a/b", verdict);
            assert!(matches!(found, Expectation::Agrees(_)), "{verdict}");
        }
        assert_eq!(
            flaky.look_up(&adapter, "a/b", Verdict::Pass),
            Expectation::None
        );
    }

    #[test]
    fn errors_name_file_and_line() {
        let parse = |text: &str| {
            Expectations::parse(text, Path::new("ci/e.json"))
                .unwrap_err()
                .to_string()
        };
        let unknown = parse(&TEXT.replace("\"evidence\": \"log\"", "\"evidnce\": \"log\""));
        assert!(unknown.starts_with("ci/e.json:5: "), "{unknown}");
        assert!(unknown.contains("evidnce"), "{unknown}");
        let glob = parse(&TEXT.replace("depth/*", "depth/["));
        assert!(glob.starts_with("ci/e.json:4: entry 2: \"case\""), "{glob}");
        let verdict = parse(&TEXT.replace("timeout", "slow"));
        assert!(verdict.starts_with("ci/e.json:5: "), "{verdict}");
        let slow = "\"slow\",";
        let range = parse(&TEXT.replace(slow, "\"slow\", \"version\": \"new\","));
        assert!(
            range.starts_with("ci/e.json:5: entry 2: \"version\""),
            "{range}"
        );
        let day = parse(&TEXT.replace(slow, "\"slow\", \"expires\": \"2027-13-01\","));
        assert!(
            day.starts_with("ci/e.json:5: entry 2: \"expires\""),
            "{day}"
        );
        let empty = parse(&TEXT.replace("\"slow\"", "\" \""));
        assert!(empty.contains("entry 2"), "{empty}");
    }

    #[test]
    fn an_empty_list_has_many_forms() {
        for text in ["", " \n", "[]", "{ \"entries\": [] }"] {
            let read = Expectations::parse(text, Path::new("e.json")).unwrap();
            assert!(read.all().is_empty(), "{text:?}");
        }
        for text in ["{}", "null", "[{}]", "[", "{ \"entry\": [] }"] {
            let error = Expectations::parse(text, Path::new("e.json")).unwrap_err();
            assert!(error.to_string().starts_with("e.json:1: "), "{error}");
        }
    }

    #[test]
    fn an_entry_excuses_its_verdict_and_a_finding_also_weaker_violations() {
        let adapter = adapter("gl:x", "Mesa", "25");
        let finding = |verdict: &str| {
            let text = format!(
                r#"{{ "title": "t", "adapters": ["gl:y", "gl:x"], "driver": "*", "cases": ["b", "a/*"],
                    "verdict": "{verdict}", "grade": "proven", "clause": "c", "evidence": "e" }}"#
            );
            Expectations::parse(&text, Path::new("f.json")).unwrap()
        };
        let agrees = |e: &Expectations, verdict| {
            matches!(e.look_up(&adapter, "a/b", verdict), Expectation::Agrees(_))
        };
        use Verdict::{Blocked, Crash, Disputed, Fail, RequiredByCts};
        let graded = [Fail, RequiredByCts, Disputed, Blocked, Crash];
        for (i, verdict) in graded.into_iter().enumerate() {
            let entry = one("", verdict.name());
            let finding = finding(verdict.name());
            for (j, other) in graded.into_iter().enumerate() {
                assert_eq!(agrees(&entry, other), i == j, "{verdict} {other}");
                let weaker = i <= j && j < 3;
                assert_eq!(
                    agrees(&finding, other),
                    i == j || weaker,
                    "{verdict} {other}"
                );
            }
        }
    }

    #[test]
    fn a_folder_holds_a_finding_per_file() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let finding = r#"{ "title": "t", "adapters": ["*"], "driver": "*", "cases": ["a/*"],
            "grade": "disputed", "clause": "c", "evidence": "e" }"#;
        for name in ["b.json", "a.json"] {
            fs::write(folder.join(name), finding).unwrap();
        }
        fs::write(folder.join("README.md"), "no finding").unwrap();
        let read = Expectations::read(folder).unwrap();
        let places: Vec<String> = read.all().iter().map(|known| known.place()).collect();
        let expected = ["a.json", "b.json"].map(|name| folder.join(name).display().to_string());
        assert_eq!(places, expected);
        assert_eq!(read.all()[0].verdict, Verdict::Disputed);
        fs::write(folder.join("c.json"), finding.replace("a/*", "a/[")).unwrap();
        let error = Expectations::read(folder).unwrap_err().to_string();
        assert!(error.contains("c.json:1: \"cases\": "), "{error}");
    }
}
