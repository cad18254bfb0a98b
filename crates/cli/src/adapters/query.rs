//! What discovery is asked for.

use std::path::Path;

/// What is looked for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Query<'a> {
    /// Only these; all where there are none.
    pub(crate) names: &'a [String],
    /// A user's own file of descriptions.
    pub(crate) file: Option<&'a Path>,
    /// Whether validation layers and debug output listen.
    pub(crate) validate: bool,
    /// Whether the drivers' shader caches on disk are switched off.
    pub(crate) cold: bool,
}
