//! Findings: one bug of one driver in a file of its own.
//!
//! A finding says more than an expectation: the clause that the driver breaks, values that it was seen to
//! write, and the grade of the evidence. It excuses its verdict and, since the same bug shows on weaker
//! evidence in some cases, every violation of a weaker grade.

use crate::date::check_date;
use crate::error::RecordError;
use crate::expected_symptom::ExpectedSymptom;
use crate::grade::Grade;
use crate::json::without_position;
use crate::verdict::Verdict;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

/// One bug of one driver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// The bug in one sentence.
    pub title: String,
    /// Globs over adapter names.
    pub adapters: Vec<String>,
    /// A glob over driver and version; `*` for any.
    pub driver: String,
    /// A glob over the device's name, if the bug depends on the device, or if the driver does not name what it
    /// draws over, such as a browser; any device if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// The driver versions that have the bug, such as `>=22.3, <25.1`; every version if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub versions: Option<String>,
    /// Globs over the ids of the cases that show the bug; `*` also matches `/`.
    pub cases: Vec<String>,
    /// Globs over further cases in which the bug shows beside others, by the adapter that draws them wrong.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub beside: BTreeMap<String, Vec<String>>,
    /// Globs over facts of draws, such as `scissor` and `samples={2,4,8,16}`: without one draw that has them all, a
    /// failure is another bug.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub needs: Vec<String>,
    /// The expected verdict, if it differs from the grade's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<Verdict>,
    /// The symptom of the failure; other wrong values of the same case are not excused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symptom: Option<ExpectedSymptom>,
    /// A glob over the machine's processor; any processor if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub processor: Option<String>,
    /// Labels that the run must have, as `key=value`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<String>,
    /// The strength of the evidence, which decides the verdict that is expected.
    pub grade: Grade,
    /// The document, version and section that the driver breaks; empty only while the grade is `unread`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub clause: String,
    /// The evidence: observed texels, or a text.
    pub evidence: Evidence,
    /// The audit of the finding; absent until somebody other than its author has read it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub read: Option<Reading>,
    /// The bug report's address.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<String>,
    /// The last day on which the finding excuses anything, as `2027-01-31`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expires: Option<String>,
}

/// The audit of a finding by somebody who did not write it. The auditor compares the finding with the
/// specification that binds the adapter, and with the permissions in that specification.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reading {
    /// The day, as `2027-01-31`.
    pub date: String,
    /// The sections that were read, by document, version and number.
    pub clause: String,
    /// The auditor's opinion of the grade.
    pub verdict: ReadingVerdict,
    /// The requirement in the text, and the permissions that were considered and do not excuse the driver.
    pub reason: String,
}

state_enum! {
    /// The result of an audit. The finding has the grade that the audit gave it.
    ReadingVerdict: array {
        /// The grade is right.
        Upheld = "upheld",
        /// The grade was too strong.
        Lowered = "lowered",
        /// The grade was too weak.
        Raised = "raised",
    }
}

/// The evidence of a finding: an array of observed values, or a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// Observed values.
    Values(Vec<Seen>),
    /// A text.
    Text(String),
}

/// A value that a driver wrote, and the legal values.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seen {
    /// The case's id.
    pub case: String,
    /// Column and row.
    pub texel: [u32; 2],
    /// The sample; 0 if there is only one.
    #[serde(default)]
    pub sample: u32,
    /// The code or the value that came back, as text: `255`.
    pub value: String,
    /// The legal codes or values, as text: `0`, or `0 to 3`.
    pub set: String,
}

impl Serialize for Evidence {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Values(values) => values.serialize(serializer),
            Self::Text(text) => text.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Evidence {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Evidence;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a text, or an array of objects with case, texel, value and set")
            }

            fn visit_str<E>(self, text: &str) -> Result<Evidence, E> {
                Ok(Evidence::Text(text.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Evidence, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Evidence::Values)
            }
        }
        deserializer.deserialize_any(Either)
    }
}

impl Evidence {
    fn is_empty(&self) -> bool {
        match self {
            Self::Values(values) => values.is_empty(),
            Self::Text(text) => text.trim().is_empty(),
        }
    }
}

/// The remedy for a finding that does not parse.
pub(crate) const REMEDY: &str =
    "a finding needs title, adapters, driver, cases, grade, clause and evidence; see ci/README.md";

impl Finding {
    /// Returns the expected verdict: the finding's own, or else the verdict of its grade.
    pub fn expected(&self) -> Verdict {
        self.verdict.unwrap_or_else(|| self.grade.verdict())
    }

    /// Parses the text of a file. Only messages use `path`.
    ///
    /// # Errors
    /// If the text does not parse, or a required part of the finding is empty.
    pub fn parse(text: &str, path: &Path) -> Result<Self, RecordError> {
        let fail = |line, message| RecordError::Parse {
            path: path.to_owned(),
            line,
            message,
            remedy: REMEDY,
        };
        let finding: Self =
            serde_json::from_str(text).map_err(|e| fail(e.line(), without_position(&e)))?;
        let unread = finding.grade == Grade::Unread;
        let parts = [
            ("title", finding.title.trim().is_empty()),
            ("adapters", finding.adapters.is_empty()),
            ("cases", finding.cases.is_empty()),
            ("clause", finding.clause.trim().is_empty() && !unread),
            ("evidence", finding.evidence.is_empty()),
        ];
        let line_of = |key: &str| {
            let offset = text.find(&format!("\"{key}\"")).unwrap_or(0);
            text[..offset].matches('\n').count() + 1
        };
        for (key, empty) in parts {
            if empty {
                return Err(fail(line_of(key), format!("\"{key}\" must not be empty")));
            }
        }
        if let Some(reading) = &finding.read {
            check_date("date", &reading.date).map_err(|message| fail(line_of("date"), message))?;
            for (key, text) in [("clause", &reading.clause), ("reason", &reading.reason)] {
                if text.trim().is_empty() {
                    let message = format!("\"{key}\" of \"read\" must not be empty");
                    return Err(fail(line_of("read"), message));
                }
            }
        }
        Ok(finding)
    }

    /// Returns the finding as the text of a file.
    ///
    /// # Errors
    /// If it cannot be written as JSON.
    pub fn to_text(&self) -> Result<String, RecordError> {
        let mut text =
            serde_json::to_string_pretty(self).map_err(RecordError::serialize("a finding"))?;
        text.push('\n');
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"{
  "title": "The blend constant stays.",
  "adapters": ["gl:zink"],
  "driver": "*",
  "cases": ["blend/*"],
  "grade": "disputed",
  "clause": "OpenGL 4.6: 17.3.6.5",
  "evidence": [
    { "case": "blend/a", "texel": [1, 2], "value": "255", "set": "0" }
  ],
  "read": { "date": "2027-01-31", "clause": "OpenGL 4.6: 17.3.6.5 Blend Color", "verdict": "lowered",
    "reason": "No text says when it is read." }
}"#;

    #[test]
    fn a_finding_reads_back_as_it_was_written() {
        let finding = Finding::parse(TEXT, Path::new("f.json")).unwrap();
        assert_eq!(finding.expected(), Verdict::Disputed);
        let Evidence::Values(seen) = &finding.evidence else {
            panic!("{finding:?}");
        };
        assert_eq!((seen[0].texel, seen[0].sample), ([1, 2], 0));
        let again = Finding::parse(&finding.to_text().unwrap(), Path::new("f.json")).unwrap();
        assert_eq!(again, finding);
        let reading = finding.read.as_ref().unwrap();
        assert_eq!(reading.verdict, ReadingVerdict::Lowered);
        let text = TEXT.replace("[\n    {", "\"").replace("}\n  ]", "\"");
        let text = text.replace(
            r#"" "case": "blend/a", "texel": [1, 2], "value": "255", "set": "0" ""#,
            r#""seen""#,
        );
        let finding = Finding::parse(&text, Path::new("f.json")).unwrap();
        assert_eq!(finding.evidence, Evidence::Text("seen".to_owned()));
        let again = Finding::parse(&finding.to_text().unwrap(), Path::new("f.json")).unwrap();
        assert_eq!(again, finding);
    }

    #[test]
    fn errors_name_file_line_and_remedy() {
        let error = |from: &str, to: &str| {
            assert!(TEXT.contains(from), "{from}");
            let text = TEXT.replacen(from, to, 1);
            Finding::parse(&text, Path::new("ci/findings/f.json")).unwrap_err()
        };
        for (from, to, line, start) in [
            (
                "\"driver\"",
                "\"drivers\"",
                4,
                "unknown field `drivers`, expected one of `title`, ",
            ),
            ("disputed", "sure", 6, "unknown variant `sure`, expected "),
            ("[\"blend/*\"]", "[]", 5, "\"cases\" must not be empty"),
            (
                "OpenGL 4.6: 17.3.6.5",
                " ",
                7,
                "\"clause\" must not be empty",
            ),
            (
                "\"texel\": [1, 2]",
                "\"texels\": [1, 2]",
                9,
                "unknown field `texels`, expected one of `case`, ",
            ),
            (
                "The blend constant stays.",
                "",
                2,
                "\"title\" must not be empty",
            ),
            ("2027-01-31", "2027-13-01", 11, "\"date\": "),
            (
                "OpenGL 4.6: 17.3.6.5 Blend Color",
                "",
                11,
                "\"clause\" of \"read\" must not be empty",
            ),
            (
                "lowered",
                "fine",
                11,
                "unknown variant `fine`, expected one of `upheld`, ",
            ),
            (
                "No text says when it is read.",
                "",
                11,
                "\"reason\" of \"read\" must not be empty",
            ),
        ] {
            let error = error(from, to);
            let start = format!("ci/findings/f.json:{line}: {start}");
            let text = error.to_string();
            assert!(text.starts_with(&start), "{text}");
            assert!(text.ends_with(&format!("; {REMEDY}")), "{text}");
        }
    }
}
