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

/// Queries that begin before a draw or pass, and those that end after it.
#[derive(Debug, Default)]
pub(crate) struct Enclosing {
    begun: Vec<Query>,
    ended: Vec<Query>,
}

impl Enclosing {
    /// Returns those of all queries that begin and end there.
    pub(crate) fn new(
        queries: &[(etalon_scene::Query, Query)],
        begins: impl Fn(&etalon_scene::Query) -> bool,
        ends: impl Fn(&etalon_scene::Query) -> bool,
    ) -> Self {
        let begun = queries.iter().filter(|(query, _)| begins(query));
        let ended = queries.iter().filter(|(query, _)| ends(query));
        Self {
            begun: begun.map(|(_, object)| *object).collect(),
            ended: ended.map(|(_, object)| *object).collect(),
        }
    }

    /// Begins queries.
    pub(crate) fn begin(&self, context: &Context) {
        for query in &self.begun {
            // SAFETY: the context is current and the object is its own.
            unsafe { context.gl.begin_query(query.target, query.object) };
        }
    }

    /// Ends queries.
    pub(crate) fn end(&self, context: &Context) {
        for query in &self.ended {
            // SAFETY: the context is current.
            unsafe { context.gl.end_query(query.target) };
        }
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
