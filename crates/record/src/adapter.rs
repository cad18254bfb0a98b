//! The adapters of a run or bench, and the adapters that it could not use.

use etalon_frame::{AdapterInfo, AdapterName, Limits};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

/// An adapter of a run or bench.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdapterRecord {
    /// The adapter's name, and the device, driver and API that the driver reports.
    #[serde(flatten)]
    pub info: AdapterInfo,
    /// The release of the driver, if the adapter's description states it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release: Option<Release>,
    /// The limits and features that decide which cases are drawn and how they are judged.
    #[serde(deserialize_with = "checked_limits")]
    pub limits: Limits,
}

/// Reads limits that can be judged by.
fn checked_limits<'de, D: Deserializer<'de>>(from: D) -> Result<Limits, D::Error> {
    let limits = Limits::deserialize(from)?;
    limits
        .checked()
        .map_err(|error| D::Error::custom(format!("an adapter with {error}")))
}

/// A release of a driver.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Release {
    /// The line: one driver over its releases, such as `swiftshader`.
    pub line: String,
    /// The version within the line, numbers with dots.
    pub version: String,
}

impl AdapterRecord {
    /// Returns the name up to an `@`. What follows the `@` names one release of the driver, and
    /// expectations apply to all releases.
    pub fn without_release(&self) -> &str {
        AdapterName::new(&self.info.name).without_release()
    }

    /// Returns driver and version in one text, which the `driver` globs of expectations match.
    pub fn driver_text(&self) -> String {
        format!("{} {}", self.info.driver, self.info.driver_version)
            .trim()
            .to_owned()
    }
}

/// An adapter that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AbsentAdapter {
    /// The adapter's name, by which it would have run.
    pub name: String,
    /// The reason why it cannot be used, in one sentence.
    pub reason: String,
    /// Instructions to make it usable.
    pub remedy: String,
}
