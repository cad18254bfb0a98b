//! The storage in which fragment shaders leave fragments for later passes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The words of a node: red, green, blue, alpha, depth, and the index of the next node or a mark.
const NODE_WORDS: u64 = 6;

/// A pool of fragments, in a list for each texel or in layers. It is empty when a submission starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pool {
    /// Width and height in texels of the passes that use it.
    pub size: [u32; 2],
    /// The maximum number of fragments.
    pub nodes: u32,
    /// The number of nodes that belong to each texel, for its nearest layers; 0 if the texels share the nodes in
    /// lists.
    #[serde(default)]
    pub layers: u32,
}

impl Pool {
    /// The maximum size in bytes of a pool in a case file: every API supports storage buffers of this size (OpenGL
    /// 4.3, table 23.64).
    pub const MOST_BYTES: u64 = 1 << 24;

    /// Returns the number of texels, and of lists.
    pub fn texels(self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Returns the size in bytes of the part that is zeroed before a submission: the count and the heads of
    /// lists, or everything if the pool has layers.
    pub fn cleared_bytes(self) -> u64 {
        if self.layers > 0 {
            return self.bytes();
        }
        self.head_bytes()
    }

    /// Returns the size in bytes of the count and the heads.
    fn head_bytes(self) -> u64 {
        4 * (1 + self.texels())
    }

    /// Returns the size in bytes: a count, a head for each texel, and the nodes.
    pub fn bytes(self) -> u64 {
        self.head_bytes() + 4 * NODE_WORDS * u64::from(self.nodes)
    }
}
