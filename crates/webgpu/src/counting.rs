//! The counters of a scene: queries around draws, and a storage buffer in which shaders count.
//!
//! WebGPU's occlusion queries return whether any sample passed, not how many (GPUQueryType), so
//! `PreciseOcclusion` is denied.

use crate::calls::{EncoderCommand, PassCommand, QuerySet, QueryType, SetQuery, buffer_usage};
use crate::reading::{CounterReading, Place};
use crate::tables::Lowering;
use etalon_frame::{CounterKind, PathResults};
use etalon_scene::{Query as SceneQuery, Scene};

/// The size of a counter of shader runs in bytes.
pub(crate) const RUNS_BYTES: u64 = 4;
/// The size of a query result in bytes.
const RESULT_BYTES: u64 = 8;
/// The alignment of the first result in a buffer, in bytes (resolveQuerySet).
const RESOLVE_ALIGNMENT: u64 = 256;

/// The counters of a scene.
pub(crate) struct Counting {
    kinds: Vec<CounterKind>,
    occlusion: Option<Queries>,
    statistics: Option<Queries>,
    /// The buffer of the results: first of the occlusion queries, then of the statistics queries.
    results: Option<usize>,
    /// The storage buffer in which shaders count. It has one place per counter of any kind.
    runs: Option<usize>,
    /// The distance between two places in bytes.
    stride: u64,
    /// True if results are read twice.
    twice: bool,
}

/// The queries of one type.
struct Queries {
    set: usize,
    /// The counter of each query, by index.
    counters: Vec<usize>,
    /// The offset of the first result in the results buffer, in bytes.
    offset: u64,
}

/// The queries that begin and end at a draw, and its counter.
#[derive(Clone, Copy, Default)]
pub(crate) struct DrawQueries {
    /// The occlusion query.
    occlusion: Enclosed,
    /// The pipeline statistics query.
    statistics: Enclosed,
    /// The counter that the shader increments.
    pub(crate) runs: Option<usize>,
}

/// The range of draws that a query encloses.
#[derive(Clone, Copy, Default)]
struct Enclosed {
    /// The query, if it begins before the draw.
    begins: Option<u32>,
    /// True if the query ends after the draw.
    ends: bool,
}

impl Enclosed {
    /// Returns how queries of one type enclose a draw. At most one of them does.
    fn new<'q>(draw: (usize, usize), queries: impl Iterator<Item = &'q SceneQuery>) -> Self {
        let mut enclosed = Self::default();
        for (number, query) in (0..).zip(queries) {
            if query.begins_at(draw) {
                enclosed.begins = Some(number);
            }
            enclosed.ends |= query.ends_at(draw);
        }
        enclosed
    }

    /// Returns true if a query begins before the draw or ends after it.
    fn is_edge(self) -> bool {
        self.begins.is_some() || self.ends
    }
}

impl DrawQueries {
    /// Returns true if a query begins before the draw or ends after it.
    pub(crate) fn is_edge(self) -> bool {
        self.occlusion.is_edge() || self.statistics.is_edge()
    }
}

impl Queries {
    /// Returns queries for these counters, or `None` if there are no counters.
    fn new(
        lowering: &mut Lowering<'_>,
        ty: QueryType,
        counters: Vec<usize>,
        offset: u64,
    ) -> Option<Self> {
        if counters.is_empty() {
            return None;
        }
        let sets = &mut lowering.list.query_sets;
        sets.push(QuerySet {
            ty,
            count: counters.len() as u32,
        });
        Some(Self {
            set: sets.len() - 1,
            counters,
            offset,
        })
    }

    fn end(&self) -> u64 {
        self.offset + self.counters.len() as u64 * RESULT_BYTES
    }

    /// Returns the places of a counter's results in a buffer where the results begin at byte `first`.
    fn places(&self, counter: usize, first: u64) -> Vec<Place> {
        let results = (0..).zip(&self.counters);
        let results_of_counter = results.filter(|(_, owner)| **owner == counter);
        results_of_counter
            .map(|(i, _)| Place {
                offset: first + self.offset + i * RESULT_BYTES,
                bytes: RESULT_BYTES,
            })
            .collect()
    }
}

impl Counting {
    /// Returns the counters of a scene and the queries of each draw of all passes.
    pub(crate) fn new(lowering: &mut Lowering<'_>, scene: &Scene) -> (Self, Vec<DrawQueries>) {
        let queries = scene.queries();
        let of_kind = |kind| {
            let is_of_kind = move |query: &&SceneQuery| scene.counters[query.counter].kind == kind;
            queries.iter().filter(is_of_kind)
        };
        let occlusion = || of_kind(CounterKind::AnySamplesPassed);
        let statistics = || of_kind(CounterKind::FragmentInvocations);
        let draws = scene.passes.iter().enumerate().flat_map(|(number, pass)| {
            let draws = pass.draws.iter().enumerate();
            draws.map(move |(index, draw)| ((number, index), draw))
        });
        let counted: Vec<_> = draws
            .map(|(place, draw)| DrawQueries {
                occlusion: Enclosed::new(place, occlusion()),
                statistics: Enclosed::new(place, statistics()),
                runs: draw.counter(scene, |kind| kind == CounterKind::ShaderRuns),
            })
            .collect();
        let occlusion = occlusion().map(|query| query.counter).collect();
        let statistics = statistics().map(|query| query.counter).collect();
        let occlusion = Queries::new(lowering, QueryType::Occlusion, occlusion, 0);
        let behind = occlusion.as_ref().map_or(0, Queries::end);
        let statistics = Queries::new(
            lowering,
            QueryType::FragmentInvocations,
            statistics,
            behind.next_multiple_of(RESOLVE_ALIGNMENT),
        );
        let end = statistics.as_ref().map_or(behind, Queries::end);
        let resolved = buffer_usage::QUERY_RESOLVE | buffer_usage::COPY_SRC;
        let stored = buffer_usage::STORAGE | buffer_usage::COPY_SRC | buffer_usage::COPY_DST;
        let stride = RUNS_BYTES.next_multiple_of(lowering.device.storage_alignment.into());
        let runs = counted.iter().any(|counted| counted.runs.is_some());
        let counting = Self {
            results: (end > 0).then(|| lowering.buffer(resolved, end)),
            runs: runs.then(|| lowering.buffer(stored, scene.counters.len() as u64 * stride)),
            stride,
            twice: scene.path.results == PathResults::Twice,
            kinds: scene.counters.iter().map(|c| c.kind).collect(),
            occlusion,
            statistics,
        };
        (counting, counted)
    }

    /// Returns the buffer and offset of a counter that a shader increments.
    pub(crate) fn runs(&self, counter: usize) -> Option<(usize, u64)> {
        Some((self.runs?, counter as u64 * self.stride))
    }

    /// Returns the set of occlusion queries that passes use.
    pub(crate) fn occlusion(&self) -> Option<usize> {
        self.occlusion.as_ref().map(|queries| queries.set)
    }

    /// Returns the command that clears the storage buffer.
    pub(crate) fn start(&self) -> Option<EncoderCommand> {
        self.runs.map(|buffer| EncoderCommand::ClearBuffer {
            buffer,
            size: self.runs_bytes(),
        })
    }

    /// Returns the commands that begin queries before a draw.
    pub(crate) fn begin(&self, counted: DrawQueries) -> Vec<PassCommand> {
        let query = |ty, queries: &Option<Queries>, index: Option<u32>| {
            let (set, index) = (queries.as_ref()?.set, index?);
            Some(PassCommand::Begin(SetQuery { ty, set, index }))
        };
        let occlusion = query(
            QueryType::Occlusion,
            &self.occlusion,
            counted.occlusion.begins,
        );
        let counts = QueryType::FragmentInvocations;
        let statistics = query(counts, &self.statistics, counted.statistics.begins);
        occlusion.into_iter().chain(statistics).collect()
    }

    /// Returns the commands that end queries after a draw.
    pub(crate) fn end(&self, counted: DrawQueries) -> Vec<PassCommand> {
        let end = |query: Enclosed, ty| query.ends.then_some(PassCommand::End(ty));
        let statistics = end(counted.statistics, QueryType::FragmentInvocations);
        let occlusion = end(counted.occlusion, QueryType::Occlusion);
        statistics.into_iter().chain(occlusion).collect()
    }

    /// Returns the commands that resolve all queries.
    pub(crate) fn finish(&self) -> Vec<EncoderCommand> {
        let both = self.occlusion.iter().chain(&self.statistics);
        let resolve = |queries: &Queries| {
            Some(EncoderCommand::Resolve {
                set: queries.set,
                buffer: self.results?,
                offset: queries.offset,
            })
        };
        let once = both.filter_map(resolve);
        once.flat_map(|resolve| vec![resolve; 1 + usize::from(self.twice)])
            .collect()
    }

    /// Returns the size of all counts in bytes, in the layout of [`Counting::copy`].
    pub(crate) fn bytes(&self) -> u64 {
        self.runs_start() + self.runs_bytes()
    }

    /// Returns where the shaders' counts begin, after the query results.
    fn runs_start(&self) -> u64 {
        let both = self.occlusion.iter().chain(&self.statistics);
        both.map(Queries::end).max().unwrap_or(0)
    }

    fn runs_bytes(&self) -> u64 {
        let bytes = self.kinds.len() as u64 * self.stride;
        self.runs.map_or(0, |_| bytes)
    }

    /// Returns the copies of all counts to a buffer.
    pub(crate) fn copy(&self, to: usize, offset: u64) -> Vec<EncoderCommand> {
        let start = self.runs_start();
        let copy = |from: Option<usize>, offset, size| {
            from.map(|from| EncoderCommand::CopyBuffer {
                from,
                to,
                offset,
                size,
            })
        };
        let results = copy(self.results, offset, start);
        let runs = copy(self.runs, offset + start, self.runs_bytes());
        results.into_iter().chain(runs).collect()
    }

    /// Returns the places of the counts in a buffer to which [`Counting::copy`] copied them, in the order of
    /// the scene's counters.
    pub(crate) fn readings(&self, first: u64) -> Vec<CounterReading> {
        let queried = |queries: &Option<Queries>, counter| {
            let queries = queries.as_ref();
            queries.map_or(Vec::new(), |queries| queries.places(counter, first))
        };
        let reading = |(counter, kind): (usize, &CounterKind)| CounterReading {
            parts: match kind {
                CounterKind::AnySamplesPassed => queried(&self.occlusion, counter),
                CounterKind::FragmentInvocations => queried(&self.statistics, counter),
                CounterKind::ShaderRuns if self.runs.is_some() => vec![Place {
                    offset: first + self.runs_start() + counter as u64 * self.stride,
                    bytes: RUNS_BYTES,
                }],
                // No draw increments the counter, or it is denied.
                CounterKind::ShaderRuns | CounterKind::SamplesPassed => Vec::new(),
            },
            any: *kind == CounterKind::AnySamplesPassed,
        };
        self.kinds.iter().enumerate().map(reading).collect()
    }
}
