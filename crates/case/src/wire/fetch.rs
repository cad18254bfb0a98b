//! The keys of a draw's path to the pipeline: indices, offsets and instances.

use etalon_scene::{IndexFormat, Splat};
use schemars::JsonSchema;
use serde::Deserialize;

/// The numbers of a draw call beside its mesh. Whatever they are, the mesh is drawn.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FetchWire {
    /// The size of an index.
    #[serde(default = "uint32")]
    pub(crate) index: IndexFormat,
    /// The number added to every index; unused vertices stand in front, or indices are greater if it is
    /// negative.
    #[serde(default)]
    pub(crate) base_vertex: i32,
    /// The number of unused indices in front.
    #[serde(default)]
    pub(crate) first_index: u32,
    /// The number of unused vertices in front of a draw without indices.
    #[serde(default)]
    pub(crate) first_vertex: u32,
}

impl Default for FetchWire {
    fn default() -> Self {
        Self {
            index: IndexFormat::Uint32,
            base_vertex: 0,
            first_index: 0,
            first_vertex: 0,
        }
    }
}

/// Instances: the mesh again for each of them, in the instance's colour instead of its vertices'.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct InstancesWire {
    /// The colour of each instance, repeated as needed.
    pub(crate) colors: Vec<Splat>,
    /// The number of instances; without it, as many as there are colours.
    pub(crate) count: Option<u32>,
    /// The number of unused instances in front.
    #[serde(default)]
    pub(crate) first: u32,
}

fn uint32() -> IndexFormat {
    IndexFormat::Uint32
}
