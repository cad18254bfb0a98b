//! An adapter's identity in the history.

use etalon_frame::AdapterInfo;
use etalon_record::{AdapterRecord, Release};

/// An adapter as one run found it, without its limits.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Adapter {
    /// The adapter's identity in the run, without its offer.
    pub info: AdapterInfo,
    /// The line: one driver over its releases, such as `swiftshader`; empty if unknown.
    pub line: String,
    /// The version within the line, or empty.
    pub version: String,
}

impl Adapter {
    /// Returns the version that distinguishes releases of the driver: the version within the line, or else
    /// the version that the driver reports.
    pub fn shown_version(&self) -> &str {
        match self.version.as_str() {
            "" => &self.info.driver_version,
            version => version,
        }
    }
}

impl From<&AdapterRecord> for Adapter {
    fn from(adapter: &AdapterRecord) -> Self {
        let text = |get: fn(&Release) -> &String| {
            adapter
                .release
                .as_ref()
                .map(|r| get(r).clone())
                .unwrap_or_default()
        };
        Self {
            info: AdapterInfo {
                offer: None,
                ..adapter.info.clone()
            },
            line: text(|r| &r.line),
            version: text(|r| &r.version),
        }
    }
}
