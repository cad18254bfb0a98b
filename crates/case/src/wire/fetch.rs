//! The keys for how a draw's vertices are fetched: indices, offsets and instances.

use etalon_scene::{IndexFormat, Splat};
use schemars::JsonSchema;
use serde::Deserialize;

/// The numbers that a draw call takes in addition to its mesh. The same mesh is drawn whatever their values.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FetchWire {
    /// The size of an index.
    #[serde(default = "uint32")]
    pub(crate) index: IndexFormat,
    /// The number added to every index. To keep the mesh the same, that many unused vertices come first or,
    /// if the number is negative, all indices are increased.
    #[serde(default)]
    pub(crate) base_vertex: i32,
    /// The number of unused indices before the used ones.
    #[serde(default)]
    pub(crate) first_index: u32,
    /// The number of unused vertices before the used ones in a draw without indices.
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

/// Instances: the mesh is drawn once for each, in the instance's colour instead of its vertices' colours.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct InstancesWire {
    /// The colour of each instance, repeated as needed.
    pub(crate) colors: Vec<Splat>,
    /// The number of instances; by default, as many as there are colours.
    pub(crate) count: Option<u32>,
    /// The number of unused instances before the used ones.
    #[serde(default)]
    pub(crate) first: u32,
}

fn uint32() -> IndexFormat {
    IndexFormat::Uint32
}
