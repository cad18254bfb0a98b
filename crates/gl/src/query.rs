//! Query objects and their targets.

use etalon_frame::CounterKind;

/// A query around one draw. A query object keeps the target it was first used with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub(crate) target: u32,
    pub(crate) object: glow::Query,
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
