//! Query objects.

/// A query around one draw. A query object keeps the target it was first used with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub(crate) target: u32,
    pub(crate) object: glow::Query,
}
