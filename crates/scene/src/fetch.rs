//! The fetch of a draw's vertices: the numbers that a draw call takes beside its mesh.
//!
//! A [`Mesh`](crate::Mesh) is what is drawn, and all that judges and rasterizers look at. A [`Fetch`] is the
//! path on which a driver gets there: it changes buffers and arguments, never the picture.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The size of an index.
    IndexFormat {
        /// 16 bits; [`RESTART_16`] ends a strip.
        Uint16 = "uint16",
        /// 32 bits; [`RESTART`](crate::RESTART) ends a strip.
        Uint32 = "uint32",
    }
}

/// The 16-bit index that ends a strip.
pub const RESTART_16: u16 = u16::MAX;

/// The path of vertices to the pipeline. The default is that of most draws: 32-bit indices, everything
/// from the first on, no instances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fetch {
    /// The size of an index.
    pub index: IndexFormat,
    /// The number added to every index. The vertices are moved, or the indices are if it is negative, so
    /// that the sum names the mesh's vertex.
    pub base_vertex: i32,
    /// The number of unused indices in front.
    pub first_index: u32,
    /// The number of unused vertices in front of a draw without indices.
    pub first_vertex: u32,
    /// The number of instances; 0 draws none of them and takes colours from vertices. The mesh is then so
    /// many equal parts, each of one colour, which comes from a buffer that advances once an instance.
    pub instances: u32,
    /// The number of unused instances in front.
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
