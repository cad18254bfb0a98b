//! The first line of a run.

use crate::adapter::{AbsentAdapter, AdapterRecord};
use crate::provenance::Provenance;
use crate::shader_cache::ShaderCache;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The format of run folders that this crate writes. It also reads earlier ones: format 6 has no methods at the
/// sizes of frames, and no percentiles of an accuracy; format 5 has messages
/// instead of reasons; format 4 states every number and keeps known failures in full; format 3 has stories as
/// sentences; format 2 lacks the verdicts `required-by-cts`, `disputed` and `blocked`, and its limits lack
/// version and properties; format 1 also lacks settings, ends of processes, validation messages and repeats.
pub const FORMAT: u32 = 7;

/// The cases, adapters, machine and time of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// The format of the run folder; lower than [`FORMAT`] if an earlier version wrote it.
    pub format: u32,
    /// The suite, machine, time and command.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The number of selected cases; a complete run has one record per case and adapter.
    pub cases: u64,
    /// The settings that the cases were drawn with.
    #[serde(default)]
    pub settings: Settings,
    /// The adapters that the cases ran on.
    pub adapters: Vec<AdapterRecord>,
    /// The adapters that were looked for and could not be used.
    pub absent: Vec<AbsentAdapter>,
}

impl Header {
    /// Returns a header with these adapters and this number of cases, and nothing else yet.
    pub fn new(adapters: Vec<AdapterRecord>, cases: u64) -> Self {
        Self {
            format: FORMAT,
            provenance: Provenance::default(),
            cases,
            settings: Settings::default(),
            adapters,
            absent: Vec::new(),
        }
    }

    /// Returns the number of records of a complete run.
    pub fn expected_records(&self) -> u64 {
        self.cases.saturating_mul(self.adapters.len() as u64)
    }

    /// Returns the adapter with this name.
    pub fn adapter(&self, name: &str) -> Option<&AdapterRecord> {
        self.adapters.iter().find(|a| a.info.name == name)
    }
}

/// The settings of a run. A run can be resumed, or merged with others, only if they have the same settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The digest of [`CASES_FILE`](crate::CASES_FILE), the ids that were selected before sharding.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub selection: String,
    /// The part of the selection that this run draws; all of it if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
    /// The profile: `quick` or `full`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<String>,
    /// The number of cases of the full profile that the selection leaves out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left_out: Option<u64>,
    /// The seed of the cases' order; if absent, the order of the case files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shuffle: Option<u64>,
    /// The number of times that each case is drawn, each time in another process; once if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeat: Option<u32>,
    /// The contents of the drivers' shader caches on disk.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shader_cache: Option<ShaderCache>,
    /// True if validation layers and debug output were enabled.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub validate: bool,
    /// Seconds that one case may take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timeout: Option<f64>,
    /// Memory that one worker may use, in MiB.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<u64>,
    /// The scene of one's own that methods drew in place of the built-in ones.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gltf: Option<ModelFile>,
    /// The sizes in texels at which methods were timed; empty if only at that of their pictures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes: Vec<[u32; 2]>,
}

/// A scene of one's own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    /// The scene's name, the value of `gltf` in ids.
    pub name: String,
    /// The SHA-256 of its file, in hexadecimal digits.
    pub sha256: String,
}

/// One of several parts of a selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// The shard's number, from 1.
    pub index: u32,
    /// The number of parts.
    pub count: u32,
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}
