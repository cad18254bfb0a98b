//! Query objects and their targets.

use crate::context::Context;
use etalon_frame::CounterKind;
use glow::HasContext;

/// A query object, which keeps the target that it was first used with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub(crate) target: u32,
    pub(crate) object: glow::Query,
}

impl Query {
    pub(crate) fn begin(self, context: &Context) {
        // SAFETY: the context is current and the object is its own.
        unsafe { context.gl.begin_query(self.target, self.object) };
    }

    pub(crate) fn end(self, context: &Context) {
        // SAFETY: the context is current.
        unsafe { context.gl.end_query(self.target) };
    }
}

/// Returns the query target of a kind; `None` for counters that shaders increment.
pub(crate) fn query_target(kind: CounterKind) -> Option<u32> {
    match kind {
        CounterKind::SamplesPassed => Some(glow::SAMPLES_PASSED),
        CounterKind::AnySamplesPassed => Some(glow::ANY_SAMPLES_PASSED),
        CounterKind::FragmentInvocations => Some(glow::FRAGMENT_SHADER_INVOCATIONS),
        CounterKind::ShaderRuns => None,
    }
}
