//! Query objects.

/// A query around one draw. A query object stays with the target that it was first begun for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub(crate) target: u32,
    pub(crate) object: glow::Query,
}
