//! The version number of a driver: from the adapter's description, or from the text that the driver
//! reports.

use crate::adapter::AdapterRecord;
use semver::Version;

/// Returns the version of an adapter's driver: from its description, otherwise as the driver reports it.
pub fn version_of(adapter: &AdapterRecord) -> Option<Version> {
    match &adapter.release {
        Some(release) => release_version(&release.version),
        None => driver_version(&adapter.info.driver_version),
    }
}

/// Parses a version of numbers separated by dots, and keeps the first three. A single number such as `118`
/// is a version too. Returns `None` for anything else.
pub(crate) fn release_version(text: &str) -> Option<Version> {
    let parts: Option<Vec<u64>> = text.split('.').map(|part| part.parse().ok()).collect();
    let part = |n: usize| {
        parts
            .as_ref()
            .map(|numbers| numbers.get(n).copied().unwrap_or(0))
    };
    Some(Version::new(part(0)?, part(1)?, part(2)?))
}

/// Returns the version in a text such as `4.5 (Core Profile) Mesa 22.3.6`: the number after `Mesa` or
/// `NVIDIA`, otherwise the first number with a dot. Missing parts are 0, and parts after the third are
/// dropped.
fn driver_version(text: &str) -> Option<Version> {
    let makers = ["Mesa ", "NVIDIA "];
    let behind = makers.iter().find_map(|maker| text.split_once(maker));
    behind
        .and_then(|(_, behind)| number(behind.split_whitespace().next()?))
        .or_else(|| text.split([' ', ',', '(', ')']).find_map(number))
}

fn number(word: &str) -> Option<Version> {
    let end = word.find(|c: char| !c.is_ascii_digit() && c != '.');
    let digits = &word[..end.unwrap_or(word.len())];
    let mut parts = digits.trim_end_matches('.').split('.');
    let mut next = || parts.next().map(|p| p.parse::<u64>().ok());
    let major = next()??;
    let minor = next()??;
    let patch = match next() {
        None => 0,
        Some(patch) => patch?,
    };
    Some(Version::new(major, minor, patch))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn releases_are_numbers_with_dots() {
        let version = |text: &str| release_version(text).map(|v| v.to_string());
        for (text, expected) in [
            ("118", Some("118.0.0")),
            ("26.2", Some("26.2.0")),
            ("149.0.7827.2", Some("149.0.7827")),
            ("", None),
            ("v118", None),
            ("1..2", None),
        ] {
            assert_eq!(version(text).as_deref(), expected, "{text}");
        }
    }

    #[test]
    fn versions_are_found_in_the_forms_that_drivers_use() {
        let version = |text: &str| driver_version(text).map(|v| v.to_string());
        for (text, expected) in [
            ("Mesa 22.3.6 (LLVM 15.0.6)", Some("22.3.6")),
            ("4.5 (Core Profile) Mesa 25.0.7-2~bpo12+1", Some("25.0.7")),
            ("550.54.14", Some("550.54.14")),
            ("3.3.0 NVIDIA 580.159.04", Some("580.159.4")),
            ("535.183.01.02", Some("535.183.1")),
            ("25.1", Some("25.1.0")),
            ("0x1400000", None),
            ("", None),
            ("7", None),
            ("1.99999999999999999999", None),
        ] {
            assert_eq!(version(text).as_deref(), expected, "{text}");
        }
    }
}
