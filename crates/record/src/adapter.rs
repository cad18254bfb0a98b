//! The adapters of a run or bench, and the adapters that it could not use.

use etalon_frame::{AdapterName, DeviceOffer, Limits};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

/// An adapter of a run or bench.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdapterRecord {
    /// The adapter's name: `vulkan:lavapipe`.
    pub name: String,
    /// The backend: `cpu`, `vulkan`, `gl`, `wgpu`.
    pub backend: String,
    /// The device as the driver names it.
    pub device: String,
    /// The driver as it names itself.
    pub driver: String,
    /// The driver's version as the driver reports it; empty if it reports none.
    pub driver_version: String,
    /// The driver's identifier for programs: `VkDriverId` and PCI ids in Vulkan; empty if the API has none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub driver_id: String,
    /// The API's version.
    pub api_version: String,
    /// True if the device is the processor.
    pub software: bool,
    /// The release of the driver, if the adapter's description states it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release: Option<Release>,
    /// What the device offers, in backend `webgpu`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offer: Option<DeviceOffer>,
    /// The adapter's limits and features.
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
        AdapterName::new(&self.name).without_release()
    }

    /// Returns driver and version in one text, which the `driver` globs of expectations match.
    pub fn driver_text(&self) -> String {
        format!("{} {}", self.driver, self.driver_version)
            .trim()
            .to_owned()
    }
}

/// An adapter that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AbsentAdapter {
    /// The adapter's name.
    pub name: String,
    /// The cause.
    pub reason: String,
    /// The remedy.
    pub remedy: String,
}
