//! The counters of a scene: queries around draws, and a storage buffer in which shaders count.

use crate::context::Context;
use crate::pool::ObjectPool;
use crate::query::{QueryObject, query_target};
use crate::recording;
use etalon_backend::BackendError;
use etalon_frame::{CounterKind, PathResults};
use etalon_scene::{Draw, Scene};
use glow::HasContext;

/// The counters of a scene.
#[derive(Default)]
pub(crate) struct Counters {
    kinds: Vec<CounterKind>,
    /// The queries of all draws, with the index of their counter.
    queries: Vec<(usize, QueryObject)>,
    /// The distance between two counters in the storage buffer, in bytes.
    stride: usize,
    /// True if results are read twice.
    twice: bool,
}

impl Counters {
    /// Returns a scene's counters; they have no queries yet.
    pub(crate) fn new(context: &Context, scene: &Scene) -> Self {
        let alignment = context.caps.storage_alignment.unwrap_or(1);
        Self {
            kinds: scene.counters.iter().map(|c| c.kind).collect(),
            queries: Vec::new(),
            stride: size_of::<u32>().next_multiple_of(alignment),
            twice: scene.path.results == PathResults::Twice,
        }
    }

    /// Returns the size of the storage buffer in bytes. If shaders count, it contains every counter.
    pub(crate) fn storage_size(&self) -> usize {
        if self.kinds.contains(&CounterKind::ShaderRuns) {
            self.stride * self.kinds.len()
        } else {
            0
        }
    }

    /// Creates and returns the queries of a scene.
    pub(crate) fn queries(
        &mut self,
        context: &Context,
        pool: &mut ObjectPool,
        scene: &Scene,
    ) -> Result<Vec<(etalon_scene::Query, QueryObject)>, BackendError> {
        let mut made = Vec::new();
        for query in scene.queries() {
            let kind = self.kinds.get(query.counter).copied();
            if let Some(target) = kind.and_then(query_target) {
                let object = pool.query(context, target)?;
                self.queries.push((query.counter, object));
                made.push((query, object));
            }
        }
        Ok(made)
    }

    /// Returns the offset of the counter that the draw's shader increments.
    pub(crate) fn runs(&self, draw: &Draw) -> Option<i32> {
        let counts = |i: &usize| self.kinds.get(*i) == Some(&CounterKind::ShaderRuns);
        let index = draw.counters.iter().copied().find(counts)?;
        Some((index * self.stride) as i32)
    }

    /// Returns the counts. The draws must be done.
    pub(crate) fn read(
        &self,
        context: &Context,
        runs: Option<(glow::Buffer, usize)>,
    ) -> Result<Vec<u64>, BackendError> {
        let any = |kind: &CounterKind| *kind == CounterKind::AnySamplesPassed;
        recording::counters(self.kinds.iter().map(any));
        let mut counts = match runs {
            Some((buffer, size)) => self.read_runs(context, buffer, size)?,
            None => vec![0; self.kinds.len()],
        };
        for (index, query) in &self.queries {
            if self.twice {
                context.query_result(query.object);
            }
            let result = context.query_result(query.object);
            recording::counter_part(*index, 0, recording::WHOLE);
            let count = &mut counts[*index];
            *count = match self.kinds[*index] {
                CounterKind::AnySamplesPassed => (*count).max(result.min(1)),
                _ => *count + result,
            };
        }
        Ok(counts)
    }

    fn read_runs(
        &self,
        context: &Context,
        buffer: glow::Buffer,
        size: usize,
    ) -> Result<Vec<u64>, BackendError> {
        let gl = &context.gl;
        let mut bytes = vec![0_u8; size];
        // SAFETY: the context is current, has storage buffers, and the buffer has this size; the mapped bytes
        // are copied before the buffer is unmapped.
        unsafe {
            gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
            let target = glow::SHADER_STORAGE_BUFFER;
            gl.bind_buffer(target, Some(buffer));
            // ES has no other way to read a buffer.
            let mapped = gl.map_buffer_range(target, 0, size as i32, glow::MAP_READ_BIT);
            if mapped.is_null() {
                return Err(BackendError::refused(
                    "the counts of shader runs",
                    "glMapBufferRange",
                ));
            }
            bytes.copy_from_slice(std::slice::from_raw_parts(mapped, size));
            gl.unmap_buffer(target);
        }
        for (index, kind) in self.kinds.iter().enumerate() {
            if *kind == CounterKind::ShaderRuns {
                recording::counter_part(index, (index * self.stride) as u32, 4);
            }
        }
        let first = |place: &[u8]| {
            let word = place.first_chunk().copied().unwrap_or_default();
            u64::from(u32::from_ne_bytes(word))
        };
        Ok(bytes.chunks_exact(self.stride).map(first).collect())
    }

    /// Returns the queries to the pool, or deletes them if they are not reusable.
    pub(crate) fn give_back(self, context: &Context, pool: &mut ObjectPool, reusable: bool) {
        for (_, query) in self.queries {
            if reusable {
                pool.put_query(context, query);
            } else {
                // SAFETY: the context is current and owns the object.
                unsafe { context.gl.delete_query(query.object) };
            }
        }
    }
}

/// Sets the first bytes of a storage buffer to zero, after all writes of earlier shaders.
pub(crate) fn zero(context: &Context, buffer: glow::Buffer, size: usize) {
    let gl = &context.gl;
    // SAFETY: the context is current, has storage buffers, and the buffer has at least this size.
    unsafe {
        gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
        gl.bind_buffer(glow::SHADER_STORAGE_BUFFER, Some(buffer));
        gl.buffer_sub_data_u8_slice(glow::SHADER_STORAGE_BUFFER, 0, &vec![0; size]);
    }
}
