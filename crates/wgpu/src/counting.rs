//! The counters of a scene: queries around draws, and a storage buffer that shaders count in.
//!
//! WebGPU's occlusion queries tell whether any sample passed, not how many (GPUQueryType), so
//! `PreciseOcclusion` is denied.

use crate::gpu::{BufferLease, Gpu};
use crate::layout::RUNS_BYTES;
use crate::recording::{Recorder, Rows};
use etalon_backend::{CounterPart, RecordedCounter};
use etalon_frame::{CounterKind, PathResults};
use etalon_scene::{Query, Scene};
use wgpu::BufferUsages;

/// The size of a query result.
const RESULT_BYTES: u64 = wgpu::QUERY_SIZE as u64;

/// The counters of a scene.
pub(crate) struct Counting<'a> {
    kinds: Vec<CounterKind>,
    occlusion: Option<Queries>,
    statistics: Option<Queries>,
    /// The results of the occlusion queries, then of the statistics queries.
    results: Option<BufferLease<'a>>,
    /// The storage buffer that shaders count in: one place per counter, of any kind.
    runs: Option<BufferLease<'a>>,
    /// The distance between two places.
    stride: u64,
    /// True if results are read twice.
    twice: bool,
}

/// The queries of one type.
struct Queries {
    set: wgpu::QuerySet,
    /// The counter of each query.
    counters: Vec<usize>,
    /// The offset of the first result in the results buffer.
    offset: u64,
}

/// The queries that begin and end at a draw, and its counter.
#[derive(Clone, Copy, Default)]
pub(crate) struct Counted {
    /// The occlusion query.
    occlusion: Enclosed,
    /// The pipeline statistics query.
    statistics: Enclosed,
    /// The counter that the shader increments.
    pub(crate) runs: Option<usize>,
}

/// A query that encloses a draw, and perhaps others.
#[derive(Clone, Copy, Default)]
struct Enclosed {
    /// The query, if it begins before the draw.
    begins: Option<u32>,
    /// True if it ends after the draw.
    ends: bool,
}

impl Enclosed {
    /// Returns the part of a draw in queries of one type, of which no two enclose it.
    fn new<'q>(draw: (usize, usize), queries: impl Iterator<Item = &'q Query>) -> Self {
        let mut enclosed = Self::default();
        for (number, query) in (0..).zip(queries) {
            if query.begins_at(draw) {
                enclosed.begins = Some(number);
            }
            enclosed.ends |= query.ends_at(draw);
        }
        enclosed
    }

    /// True if a query begins before the draw or ends after it.
    fn is_edge(self) -> bool {
        self.begins.is_some() || self.ends
    }
}

impl Counted {
    /// True if a query begins before the draw or ends after it.
    pub(crate) fn is_edge(self) -> bool {
        self.occlusion.is_edge() || self.statistics.is_edge()
    }
}

impl Queries {
    /// Returns queries for these counters; `None` if there are no counters.
    fn new(gpu: &Gpu, ty: wgpu::QueryType, counters: Vec<usize>, offset: u64) -> Option<Self> {
        let descriptor = wgpu::QuerySetDescriptor {
            label: None,
            ty,
            count: counters.len() as u32,
        };
        (!counters.is_empty()).then(|| Self {
            set: gpu.device.create_query_set(&descriptor),
            counters,
            offset,
        })
    }

    fn end(&self) -> u64 {
        self.offset + self.counters.len() as u64 * RESULT_BYTES
    }

    fn resolve(&self, encoder: &mut wgpu::CommandEncoder, results: &wgpu::Buffer) {
        let queries = 0..self.counters.len() as u32;
        encoder.resolve_query_set(&self.set, queries, results, self.offset);
    }
}

impl<'a> Counting<'a> {
    /// Returns the counters of a scene and the queries of each draw of all passes.
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene) -> (Self, Vec<Counted>) {
        let queries = scene.queries();
        let of_kind = |kind| {
            let is_of_kind = move |query: &&Query| scene.counters[query.counter].kind == kind;
            queries.iter().filter(is_of_kind)
        };
        let occlusion = || of_kind(CounterKind::AnySamplesPassed);
        let statistics = || of_kind(CounterKind::FragmentInvocations);
        let draws = scene.passes.iter().enumerate().flat_map(|(number, pass)| {
            let draws = pass.draws.iter().enumerate();
            draws.map(move |(index, draw)| ((number, index), draw))
        });
        let counted: Vec<_> = draws
            .map(|(place, draw)| Counted {
                occlusion: Enclosed::new(place, occlusion()),
                statistics: Enclosed::new(place, statistics()),
                runs: draw.counter(scene, |kind| kind == CounterKind::ShaderRuns),
            })
            .collect();
        let occlusion = occlusion().map(|query| query.counter).collect();
        let statistics = statistics().map(|query| query.counter).collect();
        let occlusion = Queries::new(gpu, wgpu::QueryType::Occlusion, occlusion, 0);
        let behind = occlusion.as_ref().map_or(0, Queries::end);
        let statistics = Queries::new(
            gpu,
            wgpu::QueryType::PipelineStatistics(
                wgpu::PipelineStatisticsTypes::FRAGMENT_SHADER_INVOCATIONS,
            ),
            statistics,
            behind.next_multiple_of(wgpu::QUERY_RESOLVE_BUFFER_ALIGNMENT),
        );
        let end = statistics.as_ref().map_or(behind, Queries::end);
        let resolved = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
        let stored = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let alignment = gpu.device.limits().min_storage_buffer_offset_alignment;
        let stride = RUNS_BYTES.next_multiple_of(alignment.into());
        let runs = counted.iter().any(|counted| counted.runs.is_some());
        let counting = Self {
            results: (end > 0).then(|| gpu.buffer(resolved, end)),
            runs: runs.then(|| gpu.buffer(stored, scene.counters.len() as u64 * stride)),
            stride,
            twice: scene.path.results == PathResults::Twice,
            kinds: scene.counters.iter().map(|c| c.kind).collect(),
            occlusion,
            statistics,
        };
        (counting, counted)
    }

    /// Returns the buffer and offset of a counter that a shader increments.
    pub(crate) fn runs(&self, counter: usize) -> Option<(&wgpu::Buffer, u64)> {
        let buffer = self.runs.as_ref()?;
        Some((buffer, counter as u64 * self.stride))
    }

    /// Returns the occlusion queries for a pass.
    pub(crate) fn occlusion(&self) -> Option<&wgpu::QuerySet> {
        self.occlusion.as_ref().map(|queries| &queries.set)
    }

    /// Records the reset of the storage buffer.
    pub(crate) fn start(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(runs) = &self.runs {
            encoder.clear_buffer(runs, 0, None);
        }
    }

    /// Records the start of queries before a draw.
    pub(crate) fn begin(&self, pass: &mut wgpu::RenderPass<'_>, counted: Counted) {
        if let Some(query) = counted.occlusion.begins {
            pass.begin_occlusion_query(query);
        }
        if let (Some(query), Some(queries)) = (counted.statistics.begins, &self.statistics) {
            pass.begin_pipeline_statistics_query(&queries.set, query);
        }
    }

    /// Records the end of queries after a draw.
    pub(crate) fn end(&self, pass: &mut wgpu::RenderPass<'_>, counted: Counted) {
        if counted.statistics.ends {
            pass.end_pipeline_statistics_query();
        }
        if counted.occlusion.ends {
            pass.end_occlusion_query();
        }
    }

    /// Records the resolve of all queries.
    pub(crate) fn finish(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(results) = &self.results {
            let twice = usize::from(self.twice);
            for queries in self.occlusion.iter().chain(&self.statistics) {
                for _ in 0..=twice {
                    queries.resolve(encoder, results);
                }
            }
        }
    }

    /// Returns the size of all counts in the layout of [`Counting::copy`].
    pub(crate) fn bytes(&self) -> u64 {
        self.runs_start() + self.runs_bytes()
    }

    /// Query results come first.
    fn runs_start(&self) -> u64 {
        let both = self.occlusion.iter().chain(&self.statistics);
        both.map(Queries::end).max().unwrap_or(0)
    }

    fn runs_bytes(&self) -> u64 {
        let bytes = self.kinds.len() as u64 * self.stride;
        self.runs.as_ref().map_or(0, |_| bytes)
    }

    /// Records the copy of all counts to a buffer.
    pub(crate) fn copy(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &wgpu::Buffer,
        offset: u64,
    ) {
        let start = self.runs_start();
        if let Some(results) = &self.results {
            encoder.copy_buffer_to_buffer(results, 0, buffer, offset, start);
        }
        if let Some(runs) = &self.runs {
            encoder.copy_buffer_to_buffer(runs, 0, buffer, offset + start, self.runs_bytes());
        }
    }

    /// Returns the counts, in the order of the scene's counters, from the copied bytes.
    pub(crate) fn counts(&self, bytes: &[u8]) -> Vec<u64> {
        let start = self.runs_start();
        let total = |(counter, kind): (usize, &CounterKind)| match kind {
            CounterKind::AnySamplesPassed => {
                let sum = sum(bytes, self.occlusion.as_ref(), counter);
                u64::from(sum > 0)
            }
            CounterKind::FragmentInvocations => sum(bytes, self.statistics.as_ref(), counter),
            CounterKind::ShaderRuns if self.runs.is_some() => {
                number(bytes, start + counter as u64 * self.stride, RUNS_BYTES)
            }
            // No draw increments it, or it is denied.
            CounterKind::ShaderRuns | CounterKind::SamplesPassed => 0,
        };
        self.kinds.iter().enumerate().map(total).collect()
    }

    /// Notes where the counts are that were just copied to an offset of the mapped buffer.
    pub(crate) fn recorded(&self, recorder: &Recorder, offset: u64) -> Vec<RecordedCounter> {
        if self.bytes() == 0 {
            let none = |kind: &CounterKind| RecordedCounter {
                parts: Vec::new(),
                any: *kind == CounterKind::AnySamplesPassed,
            };
            return self.kinds.iter().map(none).collect();
        }
        let output = recorder.rows(Rows {
            offset,
            pitch: self.bytes() as u32,
            row: self.bytes() as u32,
            rows: 1,
        });
        let part = |offset: u64, bytes: u64| CounterPart {
            output,
            offset: offset as u32,
            bytes: bytes as u32,
        };
        let queried = |queries: Option<&Queries>, counter: usize| -> Vec<CounterPart> {
            let Some(queries) = queries else {
                return Vec::new();
            };
            let results = (0..).zip(&queries.counters);
            let results_of_counter = results.filter(|(_, owner)| **owner == counter);
            results_of_counter
                .map(|(i, _)| part(queries.offset + i * RESULT_BYTES, RESULT_BYTES))
                .collect()
        };
        let counter = |(index, kind): (usize, &CounterKind)| RecordedCounter {
            parts: match kind {
                CounterKind::AnySamplesPassed => queried(self.occlusion.as_ref(), index),
                CounterKind::FragmentInvocations => queried(self.statistics.as_ref(), index),
                CounterKind::ShaderRuns if self.runs.is_some() => {
                    let place = self.runs_start() + index as u64 * self.stride;
                    vec![part(place, RUNS_BYTES)]
                }
                CounterKind::ShaderRuns | CounterKind::SamplesPassed => Vec::new(),
            },
            any: *kind == CounterKind::AnySamplesPassed,
        };
        self.kinds.iter().enumerate().map(counter).collect()
    }
}

/// Returns the sum of a counter's results.
fn sum(bytes: &[u8], queries: Option<&Queries>, counter: usize) -> u64 {
    let Some(queries) = queries else { return 0 };
    let results = (0..).zip(&queries.counters);
    results
        .filter(|(_, owner)| **owner == counter)
        .map(|(i, _)| number(bytes, queries.offset + i * RESULT_BYTES, RESULT_BYTES))
        .fold(0, u64::saturating_add)
}

/// Returns the little-endian number of this many bytes.
fn number(bytes: &[u8], start: u64, size: u64) -> u64 {
    let bytes = bytes[start as usize..(start + size) as usize].iter().rev();
    bytes.fold(0, |value, byte| value << 8 | u64::from(*byte))
}
