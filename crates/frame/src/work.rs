//! The work of a frame.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The work of one submission of a scene and of reading its frame back, computed from the scene alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Work {
    /// The number of drawn triangles, including culled and clipped ones.
    pub triangles: u64,
    /// The number of texels whose centre a triangle covers, counted once per triangle that is neither culled
    /// nor clipped. Multiple samples or attachments do not multiply it, and tests do not reduce it.
    pub texels: u64,
    /// The number of texels that load operations and clear commands of passes clear, once per attachment.
    pub cleared: u64,
    /// The number of texels that resolves write.
    pub resolved: u64,
    /// The number of texels that are read back, over all attachments.
    pub read: u64,
    /// The number of bytes that clears, fragments and resolves move, if every fragment passes its tests and no
    /// cache keeps anything. 0 if it was not counted.
    #[serde(default)]
    pub bytes: u64,
    /// The number of arithmetic operations on stored channels and in tests, under the same condition. Those of
    /// shaders do not count.
    #[serde(default)]
    pub operations: u64,
    /// The number of bytes that reading back moves. 0 if it was not counted.
    #[serde(default)]
    pub read_bytes: u64,
}
