//! The dates on which versions of drivers were released.

use crate::error::HistoryError;
use crate::time::parse_time;
use etalon_frame::{shortened, without_mark};
use std::collections::BTreeMap;
use std::path::Path;

/// Release dates: line, version, date.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReleaseDates(BTreeMap<String, BTreeMap<String, i64>>);

impl ReleaseDates {
    /// Reads a JSON object of lines, each an object of versions with their dates:
    /// `{"swiftshader": {"118.0.0": "2023-10-10"}}`. Errors name `path`.
    ///
    /// # Errors
    /// If the text is anything else, or a date is invalid.
    pub fn parse(path: &Path, text: &str) -> Result<Self, HistoryError> {
        let wrong = |message: String| HistoryError::Dates {
            path: path.to_owned(),
            message,
        };
        let lines: BTreeMap<String, BTreeMap<String, String>> =
            serde_json::from_str(without_mark(text))
                .map_err(|e| wrong(shortened(&e.to_string())))?;
        let mut dates = BTreeMap::new();
        for (line, versions) in lines {
            let releases: &mut BTreeMap<String, i64> = dates.entry(line.clone()).or_default();
            for (version, date) in versions {
                let time = parse_time(&date).ok_or_else(|| {
                    let date = shortened(&date);
                    wrong(format!(
                        "{line} {version}: {date:?} is no date; write 2023-10-10"
                    ))
                })?;
                releases.insert(version, time);
            }
        }
        Ok(Self(dates))
    }

    /// Returns the date of a version, in seconds since 1970.
    pub fn of(&self, line: &str, version: &str) -> Option<i64> {
        self.0.get(line)?.get(version).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_found_by_line_and_version() {
        let parse = |text| ReleaseDates::parse(Path::new("releases.json"), text);
        let dates = parse(r#"{"mesa": {"25.0.7": "2025-05-28"}}"#).unwrap();
        assert_eq!(dates.of("mesa", "25.0.7"), parse_time("2025-05-28"));
        assert_eq!(dates.of("mesa", "25.0.8"), None);
        assert_eq!(dates.of("angle", "25.0.7"), None);
        for text in ["", "[]", r#"{"a": 1}"#, r#"{"a": {"1": "soon"}}"#] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with("releases.json: "), "{error}");
        }
    }
}
