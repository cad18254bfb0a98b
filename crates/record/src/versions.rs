//! `versions.jsonl`: the verdicts of cases across the releases of one driver.
//!
//! Not every case is drawn with every release. A release that was not drawn takes the standing of its
//! neighbours if both have the same, and a release in the middle of each such span is drawn to check this.

use crate::error::RecordError;
use crate::folder::VERSIONS_FILE;
use crate::json::json_line;
use crate::json_lines::JsonLines;
use crate::output_folder::OutputFolder;
use crate::paths::open_below;
use crate::provenance::Provenance;
use crate::verdict::Verdict;
use etalon_stats::Standing;
use serde::{Deserialize, Serialize};
use std::io::Read;
use std::path::{Path, PathBuf};

/// The format that this crate writes.
pub const VERSIONS_FORMAT: u32 = 1;
/// The longest line that is read, in bytes.
const MAX_LINE: u64 = 1 << 20;

/// The first line: the releases.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VersionsHeader {
    /// The format of the file; the only one so far is [`VERSIONS_FORMAT`].
    pub format: u32,
    /// The suite, machine, time and command.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The line of releases: `swiftshader`.
    pub line: String,
    /// The line's releases, oldest first.
    pub releases: Vec<ReleaseRecord>,
}

/// A release of the line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReleaseRecord {
    /// The version within the line.
    pub version: String,
    /// The name of the adapter that drew the release's cases.
    pub adapter: String,
    /// Driver and version as the driver reports them.
    pub driver: String,
}

/// The verdicts of one case across the releases.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseVersions {
    /// The case's id.
    pub case: String,
    /// The finding that names the case on some release.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finding: Option<String>,
    /// The verdict by release; `None` if the case was not drawn.
    pub verdicts: Vec<Option<Verdict>>,
}

impl CaseVersions {
    /// Returns the standing by release. A release that was not drawn has that of its neighbours if both
    /// agree, and otherwise `None`.
    pub fn standings(&self) -> Vec<Option<Standing>> {
        let drawn: Vec<Option<Standing>> =
            self.verdicts.iter().map(|v| v.map(Into::into)).collect();
        let before = |i: usize| drawn[..i].iter().rev().find_map(|s| *s);
        let behind = |i: usize| drawn[i..].iter().find_map(|s| *s);
        let each = drawn
            .iter()
            .enumerate()
            .map(|(i, standing)| standing.or_else(|| before(i).filter(|s| behind(i) == Some(*s))));
        each.collect()
    }

    /// Returns the spans of releases, as first and last index, in which the case is bad.
    pub fn bad(&self) -> Vec<[usize; 2]> {
        let mut spans: Vec<[usize; 2]> = Vec::new();
        for (i, standing) in self.standings().into_iter().enumerate() {
            if standing != Some(Standing::Bad) {
                continue;
            }
            match spans.last_mut() {
                Some(span) if span[1] + 1 == i => span[1] = i,
                _ => spans.push([i, i]),
            }
        }
        spans
    }

    /// Returns the affected releases as a finding's `versions` states them: from the first bad release up
    /// to the good one after the last. `None` if the case is bad in none or in all, or is good again in
    /// between.
    pub fn range(&self, releases: &[ReleaseRecord]) -> Option<String> {
        let bad = self.bad();
        let [[first, last]] = bad[..] else {
            return None;
        };
        let version = |i: usize| &releases[i].version;
        let from = (first > 0).then(|| format!(">={}", version(first)));
        let standings = self.standings();
        let good = (last + 1..releases.len()).find(|i| standings[*i] == Some(Standing::Good));
        let to = good.map(|i| format!("<{}", version(i)));
        let both: Vec<String> = from.into_iter().chain(to).collect();
        (!both.is_empty()).then(|| both.join(", "))
    }
}

/// The verdicts of cases across the releases of one driver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Versions {
    /// The releases, and the origin of their verdicts.
    pub header: VersionsHeader,
    /// The cases, in the order of their files.
    pub cases: Vec<CaseVersions>,
}

impl Versions {
    /// Replaces the file in a folder, and creates the folder if it does not exist.
    ///
    /// # Errors
    /// If the folder cannot be written to.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, RecordError> {
        let mut bytes = json_line("the releases", &self.header)?;
        for case in &self.cases {
            bytes.append(&mut json_line("a case", case)?);
        }
        OutputFolder::open(folder)?.write(VERSIONS_FILE, &bytes)
    }

    /// Reads the file in a folder.
    ///
    /// # Errors
    /// If the file does not exist or is damaged.
    pub fn read(folder: &Path) -> Result<Self, RecordError> {
        let file = open_below(folder, VERSIONS_FILE)?;
        Self::parse(&folder.join(VERSIONS_FILE), file)
    }

    /// Reads the lines of such a file from any source. Errors name `path`.
    ///
    /// # Errors
    /// If it is damaged.
    pub fn parse(path: &Path, text: impl Read) -> Result<Self, RecordError> {
        let lines = JsonLines {
            path,
            format: VERSIONS_FORMAT,
            max_header: MAX_LINE,
            max_line: MAX_LINE,
            remedy: "bisect again",
        };
        let begin = |header| Self {
            header,
            cases: Vec::new(),
        };
        let (versions, _) =
            lines.read(text, begin, |versions: &mut Self, case: CaseVersions| {
                if case.verdicts.len() != versions.header.releases.len() {
                    return Err("the case has not one verdict per release".to_owned());
                }
                versions.cases.push(case);
                Ok(())
            })?;
        Ok(versions)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(verdicts: &str) -> CaseVersions {
        CaseVersions {
            case: "a/b".to_owned(),
            finding: None,
            verdicts: verdicts
                .chars()
                .map(|c| match c {
                    'p' => Some(Verdict::Pass),
                    'f' => Some(Verdict::Fail),
                    'n' => Some(Verdict::NotSupported),
                    'y' => Some(Verdict::Flaky),
                    _ => None,
                })
                .collect(),
        }
    }

    fn releases() -> Vec<ReleaseRecord> {
        let each = ["103", "106", "110", "118", "131"];
        let release = |version: &str| ReleaseRecord {
            version: version.to_owned(),
            adapter: format!("vulkan:swiftshader-{version}"),
            driver: "SwiftShader".to_owned(),
        };
        each.map(release).to_vec()
    }

    #[test]
    fn an_undrawn_release_is_bad_between_two_bad_ones() {
        for (verdicts, bad, range) in [
            ("p.p.p", vec![], None),
            ("f.f.f", vec![[0, 4]], None),
            ("f.fpp", vec![[0, 2]], Some("<118")),
            ("pf..f", vec![[1, 4]], Some(">=106")),
            ("pffpp", vec![[1, 2]], Some(">=106, <118")),
            ("fpffp", vec![[0, 0], [2, 3]], None),
            ("nffff", vec![[1, 4]], Some(">=106")),
            ("f...p", vec![[0, 0]], Some("<131")),
            ("fy.pp", vec![[0, 0]], Some("<118")),
        ] {
            let case = case(verdicts);
            assert_eq!(case.bad(), bad, "{verdicts}");
            assert_eq!(case.range(&releases()).as_deref(), range, "{verdicts}");
        }
    }

    #[test]
    fn a_file_of_versions_reads_back_and_a_damaged_one_names_its_line() {
        let versions = Versions {
            header: VersionsHeader {
                format: VERSIONS_FORMAT,
                provenance: Provenance {
                    etalon: "0".to_owned(),
                    started: "2027-01-31T12:00:00Z".to_owned(),
                    command: vec!["etalon".to_owned()],
                    ..Provenance::default()
                },
                line: "swiftshader".to_owned(),
                releases: releases(),
            },
            cases: vec![case("pffpp"), case("f...p")],
        };
        let folder = tempfile::tempdir().unwrap();
        versions.write(folder.path()).unwrap();
        assert_eq!(Versions::read(folder.path()).unwrap(), versions);
        let path = folder.path().join(VERSIONS_FILE);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("[\"pass\",", "[")).unwrap();
        match Versions::read(folder.path()).unwrap_err() {
            RecordError::Parse { line, message, .. } => {
                assert_eq!(line, 2);
                assert_eq!(message, "the case has not one verdict per release");
            }
            other => panic!("{other}"),
        }
        assert!(Versions::read(&folder.path().join("none")).is_err());
    }
}
