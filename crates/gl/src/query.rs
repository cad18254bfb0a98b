//! Query objects and their targets.

use crate::context::Context;
use etalon_frame::CounterKind;
use glow::HasContext;

/// A query object with the target of its first use, which it keeps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QueryObject {
    pub(crate) target: u32,
    pub(crate) object: glow::Query,
}

impl QueryObject {
    pub(crate) fn begin(self, context: &Context) {
        // SAFETY: the context is current and owns the object.
        unsafe { context.gl.begin_query(self.target, self.object) };
    }

    pub(crate) fn end(self, context: &Context) {
        // SAFETY: the context is current.
        unsafe { context.gl.end_query(self.target) };
    }
}

/// Returns the query target of a counter kind, or `None` if shaders increment the counter.
pub(crate) fn query_target(kind: CounterKind) -> Option<u32> {
    match kind {
        CounterKind::SamplesPassed => Some(glow::SAMPLES_PASSED),
        CounterKind::AnySamplesPassed => Some(glow::ANY_SAMPLES_PASSED),
        CounterKind::FragmentInvocations => Some(glow::FRAGMENT_SHADER_INVOCATIONS),
        CounterKind::ShaderRuns => None,
    }
}
