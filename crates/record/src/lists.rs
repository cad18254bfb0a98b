//! The lists of deqp-runner: failures by exact name, and flaky and skipped cases by regular expressions.
//!
//! A list of failures has a line `name,status`, or just a name, per case. The other two have a regular
//! expression per line, which can match anywhere in a name. deqp-runner also writes `results.csv`, from
//! which people make their lists, with lines `name,status,seconds`. In all of them `#` begins a comment.

use crate::adapter::AdapterRecord;
use crate::expectations::Expectations;
use crate::known::Entry;
use crate::parts::Parts;
use crate::verdict::Verdict;
use etalon_frame::without_mark;
use regex::bytes::{Regex, RegexBuilder};
use regex_syntax::hir::{Hir, HirKind, Look};
use std::cell::LazyCell;
use std::collections::HashSet;
use thiserror::Error;

/// The maximum number of bytes that one regular expression may take compiled.
const REGEX_BYTES: usize = 1 << 20;

/// The maximum number of entries that lists are read into: each of some adapters has every case.
const MOST_ENTRIES: usize = 500_000;

/// The three lists of one driver.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lists {
    /// Known bad verdicts: `name,status`.
    pub fails: String,
    /// Flaky cases, as regular expressions.
    pub flakes: String,
    /// Cases that are not drawn, as regular expressions.
    pub skips: String,
}

/// An error in a line of a list.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{list}:{line}: {message}")]
pub struct ListError {
    /// The list's name, as the caller gave it.
    pub list: String,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong in the line, and how to correct it.
    pub message: String,
}

/// Entries made of lists.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Imported {
    /// One entry per case.
    pub entries: Vec<Entry>,
    /// Lines that match no existing case: list and line.
    pub unmatched: Vec<(String, String)>,
    /// The entries again, to find an entry that was made before.
    known: HashSet<Entry>,
}

/// The fields of every imported entry except case and verdict.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct About {
    /// A glob over adapter names.
    pub adapter: String,
    /// A glob over driver and version.
    pub driver: String,
    /// A range of driver versions; every version if `None`.
    pub version: Option<String>,
    /// The reason why the verdict is accepted.
    pub reason: String,
    /// The evidence of the verdicts, as a text.
    pub evidence: String,
    /// The bug report's address.
    pub link: Option<String>,
    /// The last day on which the entries apply; they have no end if `None`.
    pub expires: Option<String>,
}

/// The kind of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ListKind {
    /// Failures, or all results: exact names with a status.
    Fails,
    /// Flaky cases, by regular expressions.
    Flakes,
    /// Cases not to be drawn, by regular expressions.
    Skips,
}

impl Imported {
    /// Adds a list. Only messages use `name`. `ids` are all existing cases.
    ///
    /// # Errors
    /// If a status or a regular expression cannot be read.
    pub fn add(
        &mut self,
        kind: ListKind,
        name: &str,
        text: &str,
        ids: &[String],
        about: &About,
    ) -> Result<(), ListError> {
        let known: HashSet<&str> = ids.iter().map(String::as_str).collect();
        let parts = LazyCell::new(|| Parts::new(ids));
        for (number, line) in without_mark(text).lines().enumerate() {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let fail = |message: String| ListError {
                list: name.to_owned(),
                line: number + 1,
                message,
            };
            let matched: Vec<(&str, Verdict)> = match kind {
                ListKind::Fails => {
                    let mut fields = line.split(',');
                    let case = fields.next().unwrap_or_default().trim();
                    let status = fields.next().unwrap_or("Fail");
                    let Some(verdict) = known_status(status).map_err(fail)? else {
                        continue;
                    };
                    known
                        .get(case)
                        .map(|id| (*id, verdict))
                        .into_iter()
                        .collect()
                }
                ListKind::Flakes | ListKind::Skips => {
                    let verdict = match kind {
                        ListKind::Skips => Verdict::Skipped,
                        _ => Verdict::Flaky,
                    };
                    let pattern = Pattern::new(line);
                    let matching = pattern.and_then(|p| p.matching(&known, ids, &parts));
                    let matching = matching.map_err(|e| fail(e.to_string()))?;
                    matching.into_iter().map(|id| (id, verdict)).collect()
                }
            };
            if self.entries.len() + matched.len() > MOST_ENTRIES {
                return Err(fail(format!(
                    "the lists have more than {MOST_ENTRIES} entries; write globs in an expectations file instead"
                )));
            }
            if matched.is_empty() {
                self.unmatched.push((name.to_owned(), line.to_owned()));
            }
            let new = matched
                .into_iter()
                .map(|(id, verdict)| entry(id, verdict, about));
            for entry in new {
                if self.known.insert(entry.clone()) {
                    self.entries.push(entry);
                }
            }
        }
        Ok(())
    }
}

/// A regular expression of a list.
enum Pattern<'t> {
    /// Only this text matches: so are the lists that this suite writes.
    Text(String),
    /// The expression, and texts that everything has that it matches.
    Regex(&'t str, Vec<Vec<u8>>),
}

/// Compiles an expression for ids of ASCII or for any ids.
///
/// Without Unicode, an expression is compiled ten times as fast, and matches the same texts of ASCII.
fn compile(text: &str, ascii: bool) -> Result<Regex, regex::Error> {
    let build = |unicode| {
        let mut builder = RegexBuilder::new(text);
        builder.size_limit(REGEX_BYTES).unicode(unicode).build()
    };
    // Some expressions have a meaning in Unicode only.
    let ascii = ascii && text.is_ascii();
    let without = if ascii { build(false).ok() } else { None };
    without.map_or_else(|| build(true), Ok)
}

impl<'t> Pattern<'t> {
    fn new(text: &'t str) -> Result<Self, regex::Error> {
        let Ok(parsed) = regex_syntax::parse(text) else {
            // Explains what is wrong.
            compile(text, false)?;
            return Ok(Self::Regex(text, Vec::new()));
        };
        if let Some(text) = only_match(&parsed) {
            return Ok(Self::Text(text));
        }
        let mut texts = Vec::new();
        add_literals(&parsed, &mut texts);
        Ok(Self::Regex(text, texts))
    }

    /// Returns the ids that match. `parts` are those of the ids.
    fn matching<'i>(
        &self,
        known: &HashSet<&'i str>,
        ids: &'i [String],
        parts: &LazyCell<Parts, impl FnOnce() -> Parts>,
    ) -> Result<Vec<&'i str>, regex::Error> {
        let (text, texts) = match self {
            Self::Text(text) => return Ok(known.get(text.as_str()).copied().into_iter().collect()),
            Self::Regex(text, texts) => (text, texts),
        };
        let few = match texts.as_slice() {
            [] => None,
            texts => parts.rarest(texts.iter().map(Vec::as_slice)),
        };
        let candidates: Vec<&str> = match few {
            Some([]) => return Ok(Vec::new()),
            Some(few) => few.iter().map(|index| ids[*index].as_str()).collect(),
            None => ids.iter().map(String::as_str).collect(),
        };
        let regex = compile(text, candidates.iter().all(|id| id.is_ascii()))?;
        let is_match = |id: &&str| regex.is_match(id.as_bytes());
        Ok(candidates.into_iter().filter(is_match).collect())
    }
}

/// Returns the only text that an expression of the form `^text$` matches.
fn only_match(parsed: &Hir) -> Option<String> {
    let HirKind::Concat(parts) = parsed.kind() else {
        return None;
    };
    let [start, text, end] = parts.as_slice() else {
        return None;
    };
    match (start.kind(), text.kind(), end.kind()) {
        (HirKind::Look(Look::Start), HirKind::Literal(text), HirKind::Look(Look::End)) => {
            String::from_utf8(text.0.to_vec()).ok()
        }
        _ => None,
    }
}

/// Adds texts that are in everything that an expression matches.
fn add_literals(parsed: &Hir, texts: &mut Vec<Vec<u8>>) {
    match parsed.kind() {
        HirKind::Literal(text) => texts.push(text.0.to_vec()),
        HirKind::Concat(parts) => parts.iter().for_each(|part| add_literals(part, texts)),
        HirKind::Capture(group) => add_literals(&group.sub, texts),
        HirKind::Repetition(repeated) if repeated.min > 0 => add_literals(&repeated.sub, texts),
        _ => {}
    }
}

/// Returns the verdict that a status of deqp-runner expects; `None` if it expects nothing bad.
fn known_status(status: &str) -> Result<Option<Verdict>, String> {
    Ok(Some(match status.trim() {
        "Fail" | "ExpectedFail" => Verdict::Fail,
        "Crash" => Verdict::Crash,
        "Timeout" => Verdict::Timeout,
        "Flake" | "KnownFlake" => Verdict::Flaky,
        "Pass" | "Skip" | "Warn" | "Missing" | "UnexpectedPass" | "UnexpectedImprovement" => {
            return Ok(None);
        }
        // The result, in parentheses, is better than the list says, but can still be bad.
        other if other.starts_with("UnexpectedImprovement(") => {
            let result = other.trim_start_matches("UnexpectedImprovement(");
            return known_status(result.trim_end_matches(')'));
        }
        other => {
            return Err(format!(
                "`{other}` is not a status of deqp-runner; these have a verdict: Fail, Crash, Timeout, \
                 Flake, ExpectedFail and KnownFlake"
            ));
        }
    }))
}

fn entry(id: &str, verdict: Verdict, about: &About) -> Entry {
    Entry {
        adapter: about.adapter.clone(),
        driver: about.driver.clone(),
        device: None,
        version: about.version.clone(),
        case: etalon_glob::escape(id),
        verdict,
        reason: about.reason.clone(),
        evidence: about.evidence.clone(),
        grade: None,
        link: about.link.clone(),
        expires: about.expires.clone(),
        symptom: None,
        processor: None,
        labels: Vec::new(),
    }
}

impl Expectations {
    /// Returns the expectations about these cases on one adapter, as lists of deqp-runner. Verdicts without a
    /// deqp-runner status become `Fail`.
    pub fn lists(&self, adapter: &AdapterRecord, ids: &[String]) -> Lists {
        let mut lists = Lists::default();
        for id in ids {
            if self.skips(adapter, id).is_some() {
                lists.skips.push_str(&format!("^{}$\n", regex::escape(id)));
                continue;
            }
            let Some(entry) = self.first_bad(adapter, id) else {
                continue;
            };
            match entry.verdict {
                Verdict::Flaky => lists.flakes.push_str(&format!("^{}$\n", regex::escape(id))),
                verdict => {
                    let status = match verdict {
                        Verdict::Crash | Verdict::DeviceLost => "Crash",
                        Verdict::Timeout => "Timeout",
                        _ => "Fail",
                    };
                    lists.fails.push_str(&format!("{id},{status}\n"));
                }
            }
        }
        lists
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about() -> About {
        About {
            adapter: "gl:soft".to_owned(),
            driver: "*".to_owned(),
            version: None,
            reason: "r".to_owned(),
            evidence: "e".to_owned(),
            link: None,
            expires: None,
        }
    }

    fn ids() -> Vec<String> {
        ["depth/a/x=1", "depth/a/x=2", "blend/b", "blend/b.c"]
            .map(str::to_owned)
            .to_vec()
    }

    fn adapter() -> AdapterRecord {
        serde_json::from_value(serde_json::json!({
            "name": "gl:soft", "backend": "gl", "device": "d", "driver": "Mesa",
            "driver_version": "1", "api_version": "1", "software": true,
            "limits": { "api": "open-gl", "sub_pixel_bits": 8, "max_size": 1,
                "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
        }))
        .unwrap()
    }

    #[test]
    fn imported_lists_are_exported_the_same() {
        let mut imported = Imported::default();
        let mut add = |kind, name: &str, text: &str| {
            imported.add(kind, name, text, &ids(), &about()).unwrap();
        };
        add(
            ListKind::Fails,
            "fails",
            "# known\n\ndepth/a/x=1,Crash\nblend/b\ngone,Fail\nblend/b.c,Pass\n",
        );
        add(ListKind::Skips, "skips", "b\\.c$\n");
        add(ListKind::Flakes, "flakes", "x=[2-9]\nnothing.*\n");
        assert_eq!(imported.entries.len(), 4);
        let unmatched: Vec<&str> = imported.unmatched.iter().map(|(_, l)| l.as_str()).collect();
        assert_eq!(unmatched, ["gone,Fail", "nothing.*"]);
        let text = Expectations::to_text(&imported.entries).unwrap();
        let read = Expectations::parse(&text, std::path::Path::new("e")).unwrap();
        let lists = read.lists(&adapter(), &ids());
        assert_eq!(lists.fails, "depth/a/x=1,Crash\nblend/b,Fail\n");
        assert_eq!(lists.flakes, "^depth/a/x=2$\n");
        assert_eq!(lists.skips, "^blend/b\\.c$\n");
        let mut again = Imported::default();
        for (kind, text) in [
            (ListKind::Fails, &lists.fails),
            (ListKind::Flakes, &lists.flakes),
            (ListKind::Skips, &lists.skips),
        ] {
            again.add(kind, "l", text, &ids(), &about()).unwrap();
        }
        let sorted = |mut entries: Vec<Entry>| {
            entries.sort_by(|a, b| a.case.cmp(&b.case));
            entries
        };
        assert_eq!(sorted(again.entries), sorted(imported.entries));
    }

    #[test]
    fn a_results_file_of_any_age_and_editor_is_read() {
        let mut imported = Imported::default();
        let text = "\u{feff}depth/a/x=1,UnexpectedImprovement(Fail),1.5\r\n\
                    depth/a/x=2,UnexpectedImprovement(Pass)\r\nblend/b , UnexpectedPass\r\n\
                    blend/b.c , Fail \r\n";
        let add = imported.add(ListKind::Fails, "results.csv", text, &ids(), &about());
        add.unwrap();
        let found: Vec<_> = imported
            .entries
            .iter()
            .map(|e| (e.case.as_str(), e.verdict))
            .collect();
        assert_eq!(
            found,
            [("depth/a/x=1", Verdict::Fail), ("blend/b.c", Verdict::Fail)]
        );
        assert_eq!(imported.unmatched, []);
    }

    #[test]
    fn an_unreadable_entry_names_its_list_and_line() {
        let error = |kind, text: &str| {
            let mut imported = Imported::default();
            let result = imported.add(kind, "list.txt", text, &ids(), &about());
            result.unwrap_err().to_string()
        };
        let status = error(ListKind::Fails, "blend/b,Fail\nblend/b,Broken\n");
        assert!(status.starts_with("list.txt:2: `Broken`"), "{status}");
        let regex = error(ListKind::Flakes, "a[\n");
        assert!(regex.starts_with("list.txt:1: "), "{regex}");
        let huge = error(ListKind::Skips, "(a{1000}){1000}\n");
        assert!(huge.starts_with("list.txt:1: "), "{huge}");
    }
}
