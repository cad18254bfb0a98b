//! Expectations: bad verdicts that are known and explained.

use crate::adapter::AdapterRecord;
use crate::driver_version::driver_version;
use crate::error::RecordError;
use crate::json::without_position;
use crate::verdict::Verdict;
use etalon_frame::shortened;
use globset::{GlobBuilder, GlobMatcher};
use semver::VersionReq;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// One known verdict.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// A glob over adapter names.
    pub adapter: String,
    /// A glob over [`AdapterRecord::driver_text`], driver and version; `*` for any.
    pub driver: String,
    /// The driver versions that it applies to, as comparisons of which all must hold: `>=22.3, <25.1`; all
    /// where there is none. A driver that reports no version with a dot is in no range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// A glob over case ids; `*` also matches `/`.
    pub case: String,
    /// The expected verdict. `flaky` excuses every bad verdict, `skipped` keeps the case from being drawn.
    pub verdict: Verdict,
    /// The reason why the verdict is accepted.
    pub reason: String,
    /// The evidence: a bug report, a section of a specification.
    pub evidence: String,
    /// The bug report's address.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<String>,
    /// The last day on which the entry counts, as `2027-01-31`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expires: Option<String>,
}

/// The file as it is written.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    entries: Vec<Entry>,
}

/// The entries of an expectations file, with compiled globs.
#[derive(Clone, Debug, Default)]
pub struct Expectations {
    entries: Vec<Entry>,
    globs: Vec<Globs>,
    /// The day that entries expire before, as `2027-01-31`; none do where it is not set.
    today: Option<String>,
}

#[derive(Clone, Debug)]
struct Globs {
    adapter: GlobMatcher,
    driver: GlobMatcher,
    version: Option<VersionReq>,
    case: GlobMatcher,
}

impl Globs {
    fn match_adapter(&self, adapter: &AdapterRecord) -> bool {
        self.adapter.is_match(&adapter.name)
            && self.driver.is_match(adapter.driver_text())
            && self.version.as_ref().is_none_or(|range| {
                driver_version(&adapter.driver_version).is_some_and(|v| range.matches(&v))
            })
    }
}

/// The expectation about a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation<'a> {
    /// No entry names it.
    None,
    /// The verdict is the entry's.
    Agrees(&'a Entry),
    /// The verdict is better than the entry's: the entry may go.
    Better(&'a Entry),
    /// The verdict was the entry's until that expired.
    Expired(&'a Entry),
}

/// The most bytes of an expectations file; the rest of a longer one does not parse.
const MAX_BYTES: u64 = 64 << 20;
const REMEDY: &str = "each entry needs adapter, driver, case, verdict, reason and evidence";

impl Expectations {
    /// Reads an expectations file.
    ///
    /// # Errors
    /// When the file cannot be read, does not parse, or holds a glob that does not; the error
    /// names file and line.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        let mut text = String::new();
        File::open(path)
            .and_then(|file| file.take(MAX_BYTES).read_to_string(&mut text))
            .map_err(RecordError::io("read", path))?;
        Self::parse(&text, path)
    }

    /// Parses the text of an expectations file; `path` serves messages only.
    ///
    /// # Errors
    /// When the text does not parse or holds a glob that does not.
    pub fn parse(text: &str, path: &Path) -> Result<Self, RecordError> {
        let fail = |line, message| RecordError::Parse {
            path: path.to_owned(),
            line,
            message,
            remedy: REMEDY,
        };
        let file: Written =
            serde_json::from_str(text).map_err(|e| fail(e.line(), without_position(&e)))?;
        let mut globs = Vec::with_capacity(file.entries.len());
        for (i, entry) in file.entries.iter().enumerate() {
            let build = |key: &str, glob: &str| {
                GlobBuilder::new(glob)
                    .literal_separator(false)
                    .build()
                    .map(|g| g.compile_matcher())
                    .map_err(|e| {
                        let line = line_of(text, glob);
                        let e = shortened(&e.to_string());
                        fail(line, format!("entry {}: \"{key}\": {e}", i + 1))
                    })
            };
            if entry.reason.trim().is_empty() || entry.evidence.trim().is_empty() {
                let line = line_of(text, &entry.case);
                let message = format!("entry {}: reason and evidence must say something", i + 1);
                return Err(fail(line, message));
            }
            let version = match &entry.version {
                None => None,
                Some(text_) => Some(VersionReq::parse(text_).map_err(|e| {
                    let e = shortened(&e.to_string());
                    let message = format!(
                        "entry {}: \"version\": {e}; ranges are written as \">=22.3, <25.1\"",
                        i + 1
                    );
                    fail(line_of(text, text_), message)
                })?),
            };
            if let Some(date) = &entry.expires
                && !is_date(date)
            {
                let message = format!(
                    "entry {}: \"expires\": {:?} is no day; days are written as \"2027-01-31\"",
                    i + 1,
                    shortened(date)
                );
                return Err(fail(line_of(text, date), message));
            }
            globs.push(Globs {
                version,
                adapter: build("adapter", &entry.adapter)?,
                driver: build("driver", &entry.driver)?,
                case: build("case", &entry.case)?,
            });
        }
        Ok(Self {
            entries: file.entries,
            globs,
            today: None,
        })
    }

    /// The same, as they count on a day, written as `2027-01-31`.
    #[must_use]
    pub fn on(self, today: &str) -> Self {
        Self {
            today: Some(today.to_owned()),
            ..self
        }
    }

    /// The entry that keeps a case from being drawn on an adapter.
    pub fn skips(&self, adapter: &AdapterRecord, case: &str) -> Option<&Entry> {
        let mut skips = self.matching(adapter, case);
        skips.find(|entry| entry.verdict == Verdict::Skipped && !self.expired(entry))
    }

    fn expired(&self, entry: &Entry) -> bool {
        match (&self.today, &entry.expires) {
            // Days written this way sort as they follow each other.
            (Some(today), Some(last)) => today > last,
            _ => false,
        }
    }

    fn matching<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = &'e Entry> + use<'e, 'a> {
        self.numbers(adapter, case)
            .map(|number| &self.entries[number])
    }

    /// The numbers of the entries that name a case on an adapter.
    pub(crate) fn numbers<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = usize> + use<'e, 'a> {
        let all = self.globs.iter().enumerate();
        all.filter(move |(_, globs)| globs.case.is_match(case) && globs.match_adapter(adapter))
            .map(|(number, _)| number)
    }

    /// True if an entry names a case, on any adapter.
    pub(crate) fn names(&self, number: usize, case: &str) -> bool {
        self.globs
            .get(number)
            .is_some_and(|g| g.case.is_match(case))
    }

    /// The first entry that counts and expects a bad verdict of a case on an adapter.
    pub(crate) fn first_bad(&self, adapter: &AdapterRecord, case: &str) -> Option<&Entry> {
        self.numbers(adapter, case)
            .map(|number| &self.entries[number])
            .find(|entry| entry.verdict.is_bad() && !self.expired(entry))
    }

    /// The text of an expectations file with these entries.
    ///
    /// # Errors
    /// When an entry has no JSON form.
    pub fn to_text(entries: &[Entry]) -> Result<String, RecordError> {
        let written = Written {
            entries: entries.to_vec(),
        };
        let mut text = serde_json::to_string_pretty(&written)
            .map_err(RecordError::serialize("the expectations"))?;
        text.push('\n');
        Ok(text)
    }

    /// The entries, in file order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Looks up a verdict. An entry that agrees goes before one that
    /// names another verdict; otherwise the first in the file counts.
    pub fn look_up(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        verdict: Verdict,
    ) -> Expectation<'_> {
        let agrees = |entry: &&Entry| {
            entry.verdict == verdict || (entry.verdict == Verdict::Flaky && verdict.is_bad())
        };
        let all = || self.matching(adapter, case);
        if let Some(entry) = all().find(|e| agrees(e) && !self.expired(e)) {
            return Expectation::Agrees(entry);
        }
        if let Some(entry) = all().find(agrees) {
            return Expectation::Expired(entry);
        }
        // A case that is not supported any more has not become better, and one that is flaky may pass.
        let good =
            !verdict.is_bad() && !matches!(verdict, Verdict::NotSupported | Verdict::Skipped);
        let bad = |e: &&Entry| e.verdict.is_bad() && e.verdict != Verdict::Flaky;
        match all().find(bad) {
            Some(entry) if good => Expectation::Better(entry),
            _ => Expectation::None,
        }
    }
}

/// True if a text has the form of a day: `2027-01-31`.
fn is_date(text: &str) -> bool {
    let form = |(i, c): (usize, char)| match i {
        4 | 7 => c == '-',
        _ => c.is_ascii_digit(),
    };
    let number = |range| text.get(range).and_then(|t: &str| t.parse::<u32>().ok());
    text.len() == 10
        && text.char_indices().all(form)
        && number(5..7).is_some_and(|m| (1..=12).contains(&m))
        && number(8..10).is_some_and(|d| (1..=31).contains(&d))
}

/// The line that first holds a string value, as near as a message needs it.
fn line_of(text: &str, value: &str) -> usize {
    let quoted = serde_json::to_string(value).unwrap_or_default();
    let at = text.find(&quoted).unwrap_or(0);
    text[..at].matches('\n').count() + 1
}

#[cfg(test)]
mod tests {
    use super::*;
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
                == Expectation::Agrees(&dated.entries[0])
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
}
