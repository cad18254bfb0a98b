//! Queries and what each of them encloses.

use crate::query_scope::QueryScope;
use crate::scene::Scene;
use etalon_frame::CounterKind;

/// A query, by the draws that it encloses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Query {
    /// The index of the counter that the query adds to, among the scene's.
    pub counter: usize,
    /// The indices of the pass and the draw before which it begins.
    pub first: (usize, usize),
    /// The indices of the pass and the draw after which it ends.
    pub last: (usize, usize),
    /// True if the query begins before the first draw's pass and ends after the last draw's.
    pub over_passes: bool,
}

impl Query {
    /// Returns true if the query begins before a draw, within the pass.
    pub fn begins_at(&self, draw: (usize, usize)) -> bool {
        !self.over_passes && self.first == draw
    }

    /// Returns true if the query ends after a draw, within the pass.
    pub fn ends_at(&self, draw: (usize, usize)) -> bool {
        !self.over_passes && self.last == draw
    }

    /// Returns true if the query begins before a pass.
    pub fn begins_before(&self, pass: usize) -> bool {
        self.over_passes && self.first.0 == pass
    }

    /// Returns true if the query ends after a pass.
    pub fn ends_behind(&self, pass: usize) -> bool {
        self.over_passes && self.last.0 == pass
    }

    /// Returns true if the query begins and ends within a pass and encloses a clear.
    pub fn encloses_clears(&self, scene: &Scene) -> bool {
        let clears = scene.passes.get(self.first.0).map(|pass| &pass.clears);
        let between = |before: usize| self.first.1 < before && before <= self.last.1;
        !self.over_passes && clears.is_some_and(|clears| clears.iter().any(|c| between(c.before)))
    }
}

/// The queries of a backend that begin before a draw or pass, and the queries that end after it.
#[derive(Clone, Debug)]
pub struct Enclosing<Q> {
    /// The queries that begin.
    pub begun: Vec<Q>,
    /// The queries that end, in reverse order of their beginning.
    pub ended: Vec<Q>,
}

impl<Q> Default for Enclosing<Q> {
    fn default() -> Self {
        Self {
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }
}

impl<Q: Copy> Enclosing<Q> {
    /// Returns the queries that begin and end at a draw, within its pass.
    pub fn draw(queries: &[(Query, Q)], draw: (usize, usize)) -> Self {
        Self::of(queries, |q| q.begins_at(draw), |q| q.ends_at(draw))
    }

    /// Returns the queries that begin before a pass and end after it.
    pub fn pass(queries: &[(Query, Q)], pass: usize) -> Self {
        Self::of(queries, |q| q.begins_before(pass), |q| q.ends_behind(pass))
    }

    fn of(
        queries: &[(Query, Q)],
        begins: impl Fn(&Query) -> bool,
        ends: impl Fn(&Query) -> bool,
    ) -> Self {
        let begun = queries.iter().filter(|(query, _)| begins(query));
        let ended = queries.iter().rev().filter(|(query, _)| ends(query));
        Self {
            begun: begun.map(|(_, made)| *made).collect(),
            ended: ended.map(|(_, made)| *made).collect(),
        }
    }

    /// Returns true if no query begins or ends there.
    pub fn is_empty(&self) -> bool {
        self.begun.is_empty() && self.ended.is_empty()
    }
}

impl Scene {
    /// Returns the queries of the scene, in the order in which they begin. Counters of shader runs have no
    /// query.
    pub fn queries(&self) -> Vec<Query> {
        let mut queries: Vec<Query> = Vec::new();
        // Queries that the next draw can continue.
        let mut open: Vec<usize> = Vec::new();
        for (number, pass) in self.passes.iter().enumerate() {
            if self.query_scope == QueryScope::Pass {
                open.clear();
            }
            for (index, draw) in pass.draws.iter().enumerate() {
                if self.query_scope == QueryScope::Draw {
                    open.clear();
                }
                let counts = |counter: &usize| {
                    let kind = self.counters.get(*counter).map(|c| c.kind);
                    kind.is_some_and(|kind| kind != CounterKind::ShaderRuns)
                };
                open.retain(|query| draw.counters.contains(&queries[*query].counter));
                for counter in draw.counters.iter().copied().filter(counts) {
                    let last = (number, index);
                    match open
                        .iter()
                        .find(|query| queries[**query].counter == counter)
                    {
                        Some(query) => queries[*query].last = last,
                        None => {
                            open.push(queries.len());
                            queries.push(Query {
                                counter,
                                first: last,
                                last,
                                over_passes: self.query_scope == QueryScope::Frame,
                            });
                        }
                    }
                }
            }
        }
        queries
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;
    use crate::mesh::Mesh;
    use crate::pass::{Clear, ClearTarget, Pass};
    use crate::path::Path;
    use crate::rasterization::Viewport;
    use crate::scene::Counter;
    use crate::shader::Shader;

    /// Returns a scene of passes whose draws use these counters: queries `a` and `b`, and `c` for shader
    /// runs.
    fn scene(query_scope: QueryScope, passes: &[&[&[usize]]]) -> Scene {
        let counter = |name: &str, kind| Counter {
            name: name.to_owned(),
            kind,
        };
        let draw = |counters: &&[usize]| {
            let mesh = Mesh {
                vertices: Vec::new(),
                indices: None,
            };
            let mut draw = Draw::new(Shader::FlatColor, mesh, Viewport::whole([4, 4]));
            draw.counters = counters.to_vec();
            draw
        };
        let pass = |draws: &&[&[usize]]| Pass {
            draws: draws.iter().map(draw).collect(),
            ..Pass::default()
        };
        Scene {
            attachments: Vec::new(),
            passes: passes.iter().map(pass).collect(),
            read: Vec::new(),
            counters: vec![
                counter("a", CounterKind::SamplesPassed),
                counter("b", CounterKind::FragmentInvocations),
                counter("c", CounterKind::ShaderRuns),
            ],
            query_scope,
            pool: None,
            path: Path::default(),
        }
    }

    /// The counter of a query, and its first and last draw.
    type Span = (usize, (usize, usize), (usize, usize));

    fn spans(scene: &Scene) -> Vec<Span> {
        let queries = scene.queries();
        queries
            .iter()
            .map(|q| (q.counter, q.first, q.last))
            .collect()
    }

    #[test]
    fn a_query_spans_the_draws_or_passes_of_its_scope() {
        let passes: &[&[&[usize]]] = &[&[&[0, 2], &[1, 0], &[1], &[0]], &[], &[&[0]]];
        assert_eq!(
            spans(&scene(QueryScope::Draw, passes)),
            [
                (0, (0, 0), (0, 0)),
                (1, (0, 1), (0, 1)),
                (0, (0, 1), (0, 1)),
                (1, (0, 2), (0, 2)),
                (0, (0, 3), (0, 3)),
                (0, (2, 0), (2, 0)),
            ]
        );
        assert_eq!(
            spans(&scene(QueryScope::Pass, passes)),
            [
                (0, (0, 0), (0, 1)),
                (1, (0, 1), (0, 2)),
                (0, (0, 3), (0, 3)),
                (0, (2, 0), (2, 0)),
            ]
        );
        let whole_passes: &[&[&[usize]]] = &[&[&[0], &[0]], &[], &[&[0, 1]], &[&[1]]];
        assert_eq!(
            spans(&scene(QueryScope::Frame, whole_passes)),
            [(0, (0, 0), (2, 0)), (1, (2, 0), (3, 0))]
        );
    }

    #[test]
    fn clears_between_the_draws_are_enclosed() {
        let clear = |before| Clear {
            before,
            target: ClearTarget::DepthStencil {
                depth: Some(1.0),
                stencil: None,
                depth_write: true,
                stencil_write_mask: 0xff,
            },
            rect: None,
        };
        let mut scene = scene(QueryScope::Pass, &[&[&[], &[0], &[0]]]);
        scene.passes[0].clears = vec![clear(1), clear(3)];
        assert!(!scene.queries()[0].encloses_clears(&scene));
        scene.passes[0].clears.push(clear(2));
        assert!(scene.queries()[0].encloses_clears(&scene));
        scene.query_scope = QueryScope::Frame;
        assert!(!scene.queries()[0].encloses_clears(&scene));
    }
}
