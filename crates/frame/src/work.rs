//! The work of a frame.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The work of one submission of a scene and of reading its frame back, counted from the scene alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Work {
    /// Triangles that are drawn, those that are culled or clipped among them.
    pub triangles: u64,
    /// Texels whose centres a triangle covers, once for each triangle that is neither culled nor clipped.
    /// Samples and attachments do not multiply them, and tests take none away.
    pub texels: u64,
    /// Texels that load operations and clear commands of passes clear, once for each attachment.
    pub cleared: u64,
    /// Texels that resolves write.
    pub resolved: u64,
    /// Texels that are read back, all attachments together.
    pub read: u64,
}
