//! Files of expectations: lists of entries, and findings with one bug per file.

use crate::date::check_date;
use crate::error::RecordError;
use crate::expectations::{EntryGlobs, Expectations};
use crate::findings::{self, Finding};
use crate::json::without_position;
use crate::known::{Entry, Known};
use crate::verdict::Verdict;
use etalon_frame::{shortened, without_mark};
use etalon_glob::Glob;
use semver::VersionReq;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

/// The file form of a list.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenList {
    entries: Vec<Entry>,
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
            expectations.push_finding(&text_of(&file)?, &file)?;
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
            expectations.push_finding(text, Path::new(path))?;
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
                expectations.push_finding(text, path)?;
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
        let (shared_path, mut globs) = (Arc::from(path), ParsedGlobs::default());
        for (i, entry) in entries.into_iter().enumerate() {
            if entry.reason.trim().is_empty() || entry.evidence.trim().is_empty() {
                return Err(RecordError::Parse {
                    path: path.to_owned(),
                    line: line_of(text, &entry.case),
                    message: format!("entry {}: reason and evidence must not be empty", i + 1),
                    remedy: REMEDY,
                });
            }
            let known = Known::of_entry(entry, i + 1, &shared_path);
            let globs = globs_of(&known, text, &mut globs)?;
            expectations.push(known, globs);
        }
        Ok(expectations)
    }

    fn push_finding(&mut self, text: &str, path: &Path) -> Result<(), RecordError> {
        let mut parsed = ParsedGlobs::default();
        for known in Known::of_finding(&Finding::parse(text, path)?, path) {
            let globs = globs_of(&known, text, &mut parsed)?;
            self.push(known, globs);
        }
        Ok(())
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
}

/// Globs that were parsed so far, by their text. Entries of a list share most of them.
type ParsedGlobs = HashMap<String, Glob>;

/// Returns the compiled globs of an expectation from a file with this text.
///
/// # Errors
/// If a glob, range, date, symptom or label is invalid.
fn globs_of(
    known: &Known,
    text: &str,
    parsed: &mut ParsedGlobs,
) -> Result<EntryGlobs, RecordError> {
    let (keys, remedy) = match known.number {
        Some(_) => (["adapter", "case", "version"], REMEDY),
        None => (["adapters", "cases", "versions"], findings::REMEDY),
    };
    let fail = |value: &str, message: String| {
        let number = known.number.map(|n| format!("entry {n}: "));
        RecordError::Parse {
            path: known.path.to_path_buf(),
            line: line_of(text, value),
            message: format!("{}{message}", number.unwrap_or_default()),
            remedy,
        }
    };
    let glob = |key: &str, glob: &String| {
        Glob::new(glob).map_err(|e| {
            let e = shortened(&e.to_string());
            fail(glob, format!("\"{key}\": {e}"))
        })
    };
    let mut shared = |key: &str, text: &String| {
        if let Some(known) = parsed.get(text) {
            return Ok(known.clone());
        }
        let new = glob(key, text)?;
        parsed.insert(text.clone(), new.clone());
        Ok(new)
    };
    let range = |range: &String| {
        VersionReq::parse(range).map_err(|e| {
            let (key, e) = (keys[2], shortened(&e.to_string()));
            let remedy = "ranges are written as \">=22.3, <25.1\"";
            fail(range, format!("\"{key}\": {e}; {remedy}"))
        })
    };
    if let Some(date) = &known.expires {
        check_date("expires", date).map_err(|message| fail(date, message))?;
    }
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
    let is_label = |label: &&String| {
        label
            .split_once('=')
            .is_some_and(|(key, _)| !key.is_empty())
    };
    if let Some(label) = known.labels.iter().find(|label| !is_label(label)) {
        let message = "\"labels\" are written as \"key=value\"";
        return Err(fail(label, message.to_owned()));
    }
    Ok(EntryGlobs {
        version: known.version.as_ref().map(range).transpose()?,
        processor: (known.processor.as_ref())
            .map(|glob| shared("processor", glob))
            .transpose()?,
        device: (known.device.as_ref())
            .map(|glob| shared("device", glob))
            .transpose()?,
        applies: true,
        adapters: compiled(&known.adapters, |glob| shared(keys[0], glob))?,
        driver: shared("driver", &known.driver)?,
        cases: compiled(&known.cases, |case| glob(keys[1], case))?,
        needs: compiled(&known.needs, |need| glob("needs", need))?,
    })
}

/// Returns the compiled globs of a list. Collecting results would leave room for more.
fn compiled(
    list: &[String],
    mut compile: impl FnMut(&String) -> Result<Glob, RecordError>,
) -> Result<Vec<Glob>, RecordError> {
    let mut globs = Vec::with_capacity(list.len());
    for glob in list {
        globs.push(compile(glob)?);
    }
    Ok(globs)
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

    const TEXT: &str = r#"{ "entries": [
        { "adapter": "gl:*", "driver": "Mesa 25.*", "case": "blend/*",
          "verdict": "fail", "reason": "saturate is wrong", "evidence": "mesa#1" },
        { "adapter": "*", "driver": "*", "case": "depth/*",
          "verdict": "timeout", "reason": "slow", "evidence": "log" }
    ] }"#;

    #[test]
    fn errors_name_file_and_line() {
        let parse = |text: &str| {
            Expectations::parse(text, Path::new("ci/e.json"))
                .unwrap_err()
                .to_string()
        };
        let unknown = parse(&TEXT.replace("\"evidence\": \"log\"", "\"evidnce\": \"log\""));
        let start = "ci/e.json:5: unknown field `evidnce`";
        assert!(unknown.starts_with(start), "{unknown}");
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
        assert_eq!(
            empty,
            format!("ci/e.json:4: entry 2: reason and evidence must not be empty; {REMEDY}")
        );
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
        match Expectations::read(folder).unwrap_err() {
            RecordError::Parse {
                path,
                line,
                message,
                ..
            } => {
                assert_eq!((path, line), (folder.join("c.json"), 1));
                assert!(message.starts_with("\"cases\": "), "{message}");
            }
            other => panic!("{other}"),
        }
    }
}
