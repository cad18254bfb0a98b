//! Vertex fetching of a draw: the numbers that a draw call takes in addition to its mesh.
//!
//! A [`Mesh`](crate::Mesh) is what is drawn, and the judge and rasterizers look at nothing else. A [`Fetch`]
//! is the way a driver gets there: it changes buffers and arguments, but never the picture.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The size of an index.
    IndexFormat {
        /// 16 bits; [`RESTART_16`] restarts a strip.
        Uint16 = "uint16",
        /// 32 bits; [`RESTART`](crate::RESTART) restarts a strip.
        Uint32 = "uint32",
    }
}

/// The 16-bit index that restarts a strip.
pub const RESTART_16: u16 = u16::MAX;

/// The way in which vertices reach the pipeline. The default suits most draws: 32-bit indices, starting at the
/// first vertex and index, not instanced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fetch {
    /// The size of an index in the index buffer; unused by draws without indices.
    pub index: IndexFormat,
    /// The number added to every index. The vertices (or, if the number is negative, the indices) are moved
    /// to match, so that the sums refer to the mesh's vertices.
    pub base_vertex: i32,
    /// The number of unused indices before the used ones.
    pub first_index: u32,
    /// The number of unused vertices before the used ones in a draw without indices.
    pub first_vertex: u32,
    /// The number of instances. With 0, the draw is not instanced and colours come from vertices. Otherwise
    /// the mesh consists of this many equal parts of one colour each, which comes from a buffer that advances
    /// once per instance.
    pub instances: u32,
    /// The number of unused instances before the used ones.
    pub first_instance: u32,
}

impl Default for Fetch {
    fn default() -> Self {
        Self {
            index: IndexFormat::Uint32,
            base_vertex: 0,
            first_index: 0,
            first_vertex: 0,
            instances: 0,
            first_instance: 0,
        }
    }
}
