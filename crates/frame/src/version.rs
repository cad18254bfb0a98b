//! Versions of an API's specification.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A version of an API's specification, such as OpenGL 4.6; 0.0 if the API has no versions, or if a record
/// does not state one.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(try_from = "String", into = "String")]
pub struct ApiVersion {
    /// The part before the point.
    pub major: u8,
    /// The part after the point.
    pub minor: u8,
}

impl ApiVersion {
    /// No version, or an unknown one.
    pub const UNKNOWN: Self = Self::new(0, 0);

    /// Returns a version.
    pub const fn new(major: u8, minor: u8) -> Self {
        Self { major, minor }
    }
}

impl fmt::Display for ApiVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

impl FromStr for ApiVersion {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text
            .split_once('.')
            .and_then(|(major, minor)| Some(Self::new(major.parse().ok()?, minor.parse().ok()?)));
        parts.ok_or_else(|| format!("{text:?} is not a version such as \"4.6\""))
    }
}

impl TryFrom<String> for ApiVersion {
    type Error = String;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse()
    }
}

impl From<ApiVersion> for String {
    fn from(version: ApiVersion) -> Self {
        version.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_written_as_texts_and_sorted_by_number() {
        let version = ApiVersion::try_from("3.10".to_owned()).expect("a version");
        assert_eq!(version, ApiVersion::new(3, 10));
        assert_eq!(String::from(version), "3.10");
        assert!(ApiVersion::new(3, 3) < version);
        for wrong in ["", "3", "3.x", "300.1", "3.1.2"] {
            assert!(wrong.parse::<ApiVersion>().is_err(), "{wrong}");
        }
    }
}
