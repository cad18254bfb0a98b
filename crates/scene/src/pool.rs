//! Storage in which fragment shaders leave fragments for later passes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The words of a node: red, green, blue, alpha, depth, and the number of the node behind.
const NODE_WORDS: u64 = 6;

/// A pool of fragments, in a list for each texel. It is empty when a submission starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pool {
    /// Width and height in texels of the passes that use it.
    pub size: [u32; 2],
    /// The most fragments that it holds.
    pub nodes: u32,
}

impl Pool {
    /// The most bytes of a pool: a storage buffer may have as many in every API (OpenGL 4.3, table 23.64).
    pub const MOST_BYTES: u64 = 1 << 24;

    /// Returns the number of texels, and of lists.
    pub fn texels(self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    /// Returns the size in bytes of what is zeroed before a submission: the count and the heads.
    pub fn cleared_bytes(self) -> u64 {
        4 * (1 + self.texels())
    }

    /// Returns its size in bytes: a count, a head for each texel, and the nodes.
    pub fn bytes(self) -> u64 {
        self.cleared_bytes() + 4 * NODE_WORDS * u64::from(self.nodes)
    }
}
