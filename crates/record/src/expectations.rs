//! Verdicts that are known, explained and no news.

use crate::error::RecordError;
use crate::header::AdapterRecord;
use crate::verdict::Verdict;
use globset::{GlobBuilder, GlobMatcher};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// One known verdict.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// A glob over adapter names.
    pub adapter: String,
    /// A glob over [`AdapterRecord::driver_text`], driver and version; `*` for any.
    pub driver: String,
    /// A glob over case ids; `*` also matches `/`.
    pub case: String,
    /// The verdict that is no news.
    pub verdict: Verdict,
    /// Why the verdict is accepted.
    pub reason: String,
    /// Where that is shown: a bug report, a section of a specification.
    pub evidence: String,
}

/// The file as it is written.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    entries: Vec<Entry>,
}

/// The entries of an expectations file, ready to be looked up.
#[derive(Clone, Debug, Default)]
pub struct Expectations {
    entries: Vec<Entry>,
    globs: Vec<Globs>,
}

#[derive(Clone, Debug)]
struct Globs {
    adapter: GlobMatcher,
    driver: GlobMatcher,
    case: GlobMatcher,
}

/// What the expectations say of a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation<'a> {
    /// Nothing.
    None,
    /// The verdict is the entry's.
    Agrees(&'a Entry),
    /// The verdict is better than the entry's: the entry may go.
    Better(&'a Entry),
}

const REMEDY: &str = "each entry needs adapter, driver, case, verdict, reason and evidence";

impl Expectations {
    /// Reads an expectations file.
    ///
    /// # Errors
    /// When the file cannot be read, does not parse, or holds a glob that does not; the error
    /// names file and line.
    pub fn read(path: &Path) -> Result<Self, RecordError> {
        let text = fs::read_to_string(path).map_err(RecordError::io("read", path))?;
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
        let file: File =
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
                        fail(line, format!("entry {}: \"{key}\": {e}", i + 1))
                    })
            };
            if entry.reason.trim().is_empty() || entry.evidence.trim().is_empty() {
                let line = line_of(text, &entry.case);
                let message = format!("entry {}: reason and evidence must say something", i + 1);
                return Err(fail(line, message));
            }
            globs.push(Globs {
                adapter: build("adapter", &entry.adapter)?,
                driver: build("driver", &entry.driver)?,
                case: build("case", &entry.case)?,
            });
        }
        Ok(Self {
            entries: file.entries,
            globs,
        })
    }

    /// The entries, in file order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// What the expectations say of this verdict. An entry that agrees goes before one that
    /// names another verdict; otherwise the first in the file counts.
    pub fn look_up(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        verdict: Verdict,
    ) -> Expectation<'_> {
        let driver = adapter.driver_text();
        let matching = || {
            self.entries.iter().zip(&self.globs).filter(|(_, globs)| {
                globs.case.is_match(case)
                    && globs.adapter.is_match(&adapter.name)
                    && globs.driver.is_match(&driver)
            })
        };
        if let Some((entry, _)) = matching().find(|(entry, _)| entry.verdict == verdict) {
            return Expectation::Agrees(entry);
        }
        // A case that is not supported any more has not become better.
        let good =
            !verdict.is_bad() && !matches!(verdict, Verdict::NotSupported | Verdict::Skipped);
        match matching().find(|(entry, _)| entry.verdict.is_bad()) {
            Some((entry, _)) if good => Expectation::Better(entry),
            _ => Expectation::None,
        }
    }
}

/// The line that first holds a string value, as near as a message needs it.
fn line_of(text: &str, value: &str) -> usize {
    let quoted = serde_json::to_string(value).unwrap_or_default();
    let at = text.find(&quoted).unwrap_or(0);
    text[..at].matches('\n').count() + 1
}

/// serde_json's message without the position at its end, which the caller states itself.
pub(crate) fn without_position(error: &serde_json::Error) -> String {
    let text = error.to_string();
    match text.rfind(" at line ") {
        Some(at) => text[..at].to_owned(),
        None => text,
    }
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
        let empty = parse(&TEXT.replace("\"slow\"", "\" \""));
        assert!(empty.contains("entry 2"), "{empty}");
    }
}
