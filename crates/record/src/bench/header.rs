//! The first line of a bench.

use crate::adapter::{AbsentAdapter, AdapterRecord};
use crate::header::Shard;
use crate::provenance::Provenance;
use crate::shader_cache::ShaderCache;
use serde::{Deserialize, Serialize};

/// The format of `bench.jsonl` that this crate writes. It reads format 1 too, which has no counted
/// instructions, format 2, which has no limits of the machine, and format 3, which has messages instead of reasons.
pub const BENCH_FORMAT: u32 = 4;

/// The cases, adapters, machine and time of a bench.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BenchHeader {
    /// The format of the bench folder; lower than [`BENCH_FORMAT`] if an earlier version wrote it.
    pub format: u32,
    /// The suite, machine, time and command.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The profile of the cases: `quick` or `full`.
    pub profile: String,
    /// The number of selected cases; a complete bench has a picture of each on every adapter.
    pub cases: u64,
    /// The number of rounds that each case has on each adapter in a complete bench.
    pub rounds: u32,
    /// The contents of the drivers' shader caches on disk.
    pub shader_cache: ShaderCache,
    /// A description of the fixed work on the processor that is timed around each round. It changes when
    /// the work does. Benches with different rulers cannot be corrected by them.
    pub ruler: String,
    /// The limits of the processor, by number of threads; empty if they were not measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limits: Vec<ProcessorLimits>,
    /// The settings; a bench is resumed only with the same ones.
    #[serde(default)]
    pub settings: BenchSettings,
    /// The adapters that were timed.
    pub adapters: Vec<AdapterRecord>,
    /// The adapters that were looked for and could not be used.
    pub absent: Vec<AbsentAdapter>,
}

/// The highest rates that the processor reaches with a number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProcessorLimits {
    /// The number of threads that worked at the same time.
    pub threads: u32,
    /// The bytes that a copy larger than the caches reads and writes in a second.
    pub bytes: f64,
    /// The products and sums of 32-bit floats in a second, not fused, in the widest vectors.
    pub operations: f64,
}

/// The settings of a bench. A bench can be resumed only with the same settings, except for the time limits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BenchSettings {
    /// The digest of the ids that were selected before sharding, computed as for a run.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub selection: String,
    /// The part of the selection that is measured; all of it if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
    /// Seconds that the timed frames of a case take in a round, approximately.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Seconds that one answer of a worker may take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timeout: Option<f64>,
    /// The relative width at which an interval is narrow enough that the case takes no further rounds; if
    /// absent, all rounds are taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// The total number of seconds that the rounds of an adapter may take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
}

impl BenchHeader {
    /// Returns the adapter with this name.
    pub fn adapter(&self, name: &str) -> Option<&AdapterRecord> {
        self.adapters.iter().find(|a| a.info.name == name)
    }
}
