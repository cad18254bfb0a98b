//! The findings of `ci/findings`, compiled in.

use etalon_record::{Expectations, RecordError};
use std::collections::HashSet;
use std::sync::LazyLock;

/// The files: paths and contents.
const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/findings.rs"));

/// Returns the built-in findings.
///
/// # Errors
/// If one of them is broken; a test ensures that all parse.
pub fn findings() -> Result<Expectations, RecordError> {
    Expectations::of_findings(FILES)
}

/// Returns true if a place is that of a built-in finding.
pub fn is_built_in(place: &str) -> bool {
    static PLACES: LazyLock<HashSet<&str>> =
        LazyLock::new(|| FILES.iter().map(|(path, _)| *path).collect());
    PLACES.contains(place)
}

#[cfg(test)]
mod tests {
    #[test]
    fn all_findings_parse() {
        assert!(super::FILES.len() > 100);
        super::findings().expect("all parse");
        assert!(super::is_built_in(super::FILES[0].0));
    }
}
