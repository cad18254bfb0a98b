//! The first line of a run.

use crate::bench::ShaderCache;
use crate::record::is_false;
use etalon_frame::Limits;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The format of run folders that this crate writes. It reads this one and the ones before.
pub const FORMAT: u32 = 2;

/// What was run, where and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// The format of the run folder: [`FORMAT`].
    pub format: u32,
    /// The suite's version.
    pub etalon: String,
    /// The commit that the suite was built from, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// The machine.
    pub machine: Machine,
    /// When the run began, RFC 3339 in UTC.
    pub started: String,
    /// The command line, program first.
    pub command: Vec<String>,
    /// How many cases were selected; a complete run has one record per case and adapter.
    pub cases: u64,
    /// How they were drawn.
    #[serde(default)]
    pub settings: Settings,
    /// The adapters that the cases ran on.
    pub adapters: Vec<AdapterRecord>,
    /// The adapters that were looked for and cannot be used.
    pub absent: Vec<AbsentAdapter>,
}

impl Header {
    /// How many records a complete run has.
    pub fn expected_records(&self) -> u64 {
        self.cases.saturating_mul(self.adapters.len() as u64)
    }

    /// The adapter of this name.
    pub fn adapter(&self, name: &str) -> Option<&AdapterRecord> {
        self.adapters.iter().find(|a| a.name == name)
    }
}

/// How a run draws its cases: what must be the same when it is resumed or merged with others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The digest of [`CASES_FILE`](crate::CASES_FILE), the ids that were selected before sharding.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub selection: String,
    /// The part of the selection that this run draws; all of it where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
    /// The seed of the cases' order; the order of the case files where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shuffle: Option<u64>,
    /// How often each case is drawn, each time in another process; once where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeat: Option<u32>,
    /// What the drivers' shader caches on disk hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shader_cache: Option<ShaderCache>,
    /// Whether validation layers and debug output listened.
    #[serde(default, skip_serializing_if = "is_false")]
    pub validate: bool,
    /// Seconds that one case may take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timeout: Option<f64>,
    /// MiB of memory that one worker may hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<u64>,
}

/// One of several parts of a selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// Which one, from 1.
    pub index: u32,
    /// Of how many.
    pub count: u32,
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

/// The machine of a run, without anything that names its owner.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// The operating system and its version.
    pub os: String,
    /// The processor as it names itself.
    pub cpu: String,
    /// Logical processors that the run may use.
    pub cores: u32,
}

/// Who an adapter is and what it can do.
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
    /// The driver's version, as far as it tells.
    pub driver_version: String,
    /// What tells the driver from others for programs: `VkDriverId` and PCI ids in Vulkan; empty where
    /// the API tells none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub driver_id: String,
    /// The API's version.
    pub api_version: String,
    /// Whether the device is the processor.
    pub software: bool,
    /// What it can do.
    pub limits: Limits,
}

impl AdapterRecord {
    /// Driver and version in one text, which the `driver` globs of expectations are held against.
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
    /// What is missing or failed.
    pub reason: String,
    /// What to do about it.
    pub remedy: String,
}
