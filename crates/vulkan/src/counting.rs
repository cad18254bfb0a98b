//! Counters: queries around draws, and storage words that shaders increment.

use crate::buffer::MappedBuffer;
use crate::device::Device;
use crate::error::internal;
use crate::inputs::OffsetAllocator;
use crate::recording;
use crate::slot::{Needs, Slot};
use crate::storage;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{CounterKind, PathResults};
use etalon_scene::{Draw, Scene};
use std::mem::size_of;

/// The counters of a scene and the storage of their counts.
#[derive(Default)]
pub(crate) struct CounterQueries {
    kinds: Vec<CounterKind>,
    /// The offset of each `ShaderRuns` counter's word.
    words: Vec<Option<u64>>,
    /// The size in bytes of the buffer that holds all words, or 0.
    pub(crate) bytes: u64,
    /// The counters that own the occlusion queries of the slot's pools, one per query.
    occlusion: Vec<usize>,
    statistics: Vec<usize>,
    /// True if results are read twice.
    twice: bool,
}

/// A query of a pool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoolQuery {
    pub(crate) pool: vk::QueryPool,
    pub(crate) index: u32,
    pub(crate) flags: vk::QueryControlFlags,
}

impl PoolQuery {
    /// Records the beginning of the query.
    ///
    /// # Safety
    /// `commands` is being recorded, and the query is begun once, at the same level as its end: both inside
    /// or both outside a pass.
    pub(crate) unsafe fn begin(self, device: &Device, commands: vk::CommandBuffer) {
        let Self { pool, index, flags } = self;
        // SAFETY: upheld by the caller; the pool was reset and outlives the commands.
        unsafe { device.raw.cmd_begin_query(commands, pool, index, flags) };
    }

    /// Records the end of the query.
    ///
    /// # Safety
    /// As for [`PoolQuery::begin`]; the query has begun.
    pub(crate) unsafe fn end(self, device: &Device, commands: vk::CommandBuffer) {
        // SAFETY: upheld by the caller.
        unsafe { device.raw.cmd_end_query(commands, self.pool, self.index) };
    }
}

impl CounterQueries {
    /// Assigns an offset to the word of each counter that a shader increments.
    pub(crate) fn new(device: &Device, scene: &Scene) -> Self {
        let alignment = device.limits.min_storage_buffer_offset_alignment;
        let mut offsets = OffsetAllocator::default();
        let kinds: Vec<_> = scene.counters.iter().map(|c| c.kind).collect();
        let word = |kind: &CounterKind| {
            let counts = *kind == CounterKind::ShaderRuns;
            counts.then(|| offsets.allocate(size_of::<u32>() as u64, alignment.max(4)))
        };
        let words = kinds.iter().map(word).collect();
        Self {
            kinds,
            words,
            bytes: offsets.allocate(0, 1),
            occlusion: Vec::new(),
            statistics: Vec::new(),
            twice: scene.path.results == PathResults::Twice,
        }
    }

    /// Adds the queries of a scene to the needs of a slot.
    pub(crate) fn add_needs(&self, scene: &Scene, needs: &mut Needs) {
        for query in scene.queries() {
            match self.kinds.get(query.counter) {
                Some(kind) if kind.is_occlusion() => needs.occlusion += 1,
                Some(CounterKind::FragmentInvocations) => needs.statistics += 1,
                _ => {}
            }
        }
    }

    /// Returns the queries of a scene. The slot must have room for all of them.
    pub(crate) fn queries(
        &mut self,
        slot: &Slot,
        scene: &Scene,
    ) -> Result<Vec<(etalon_scene::Query, PoolQuery)>, BackendError> {
        let mut queries = Vec::new();
        for query in scene.queries() {
            let kind = self
                .kinds
                .get(query.counter)
                .ok_or_else(|| internal("a query names no counter"))?;
            let (pool, owners, flags) = match kind {
                CounterKind::SamplesPassed => (
                    &slot.occlusion,
                    &mut self.occlusion,
                    vk::QueryControlFlags::PRECISE,
                ),
                CounterKind::AnySamplesPassed => (
                    &slot.occlusion,
                    &mut self.occlusion,
                    vk::QueryControlFlags::empty(),
                ),
                CounterKind::FragmentInvocations => (
                    &slot.statistics,
                    &mut self.statistics,
                    vk::QueryControlFlags::empty(),
                ),
                CounterKind::ShaderRuns => continue,
            };
            let made = PoolQuery {
                pool: pool.raw,
                index: count(owners)?,
                flags,
            };
            owners.push(query.counter);
            queries.push((query, made));
        }
        Ok(queries)
    }

    /// Returns the counter that the draw's shader increments, and the offset of its word.
    pub(crate) fn word(&self, draw: &Draw) -> Result<Option<(usize, u64)>, BackendError> {
        let place = |counter: &usize| Some((*counter, self.words.get(*counter).copied()??));
        let word = draw.counters.iter().find_map(place);
        if word.is_some() != draw.shader.counts_runs() {
            return Err(internal("a draw lacks the counter of its shader"));
        }
        Ok(word)
    }

    /// Records the reset of all queries and words.
    pub(crate) fn reset(
        &self,
        device: &Device,
        commands: vk::CommandBuffer,
        slot: &Slot,
        counts: Option<&MappedBuffer>,
    ) -> Result<(), BackendError> {
        let pools = [
            (&slot.occlusion, &self.occlusion),
            (&slot.statistics, &self.statistics),
        ];
        for (pool, owners) in pools {
            pool.reset(device, commands, count(owners)?);
        }
        if let Some(counts) = counts {
            storage::zero(device, commands, counts.raw, vk::WHOLE_SIZE);
        }
        Ok(())
    }

    /// Records the barrier that makes the words visible to the host.
    pub(crate) fn end(&self, device: &Device, commands: vk::CommandBuffer) {
        if self.bytes > 0 {
            barrier(
                device,
                commands,
                vk::MemoryBarrier2::default()
                    .src_stage_mask(vk::PipelineStageFlags2::FRAGMENT_SHADER)
                    .src_access_mask(vk::AccessFlags2::SHADER_STORAGE_WRITE)
                    .dst_stage_mask(vk::PipelineStageFlags2::HOST)
                    .dst_access_mask(vk::AccessFlags2::HOST_READ),
            );
        }
    }

    /// Returns the counts of finished work, in the order of the scene's counters.
    pub(crate) fn read(
        &self,
        device: &Device,
        slot: &Slot,
        counts: Option<&MappedBuffer>,
    ) -> Result<Vec<u64>, BackendError> {
        let mut totals = vec![0_u64; self.kinds.len()];
        let any = |kind: &CounterKind| *kind == CounterKind::AnySamplesPassed;
        recording::counters(self.kinds.iter().map(any));
        if self.twice {
            slot.occlusion.results(device, self.occlusion.len())?;
            slot.statistics.results(device, self.statistics.len())?;
        }
        let passed = slot.occlusion.results(device, self.occlusion.len())?;
        let note = |owners: &[usize]| {
            for (counter, offset) in owners.iter().zip((0..).step_by(8)) {
                recording::counter_part(*counter, offset, 8);
            }
        };
        note(&self.occlusion);
        let invoked = slot.statistics.results(device, self.statistics.len())?;
        note(&self.statistics);
        let passed = self.occlusion.iter().zip(passed);
        let invoked = self.statistics.iter().zip(invoked);
        for (counter, result) in passed.chain(invoked) {
            let total = &mut totals[*counter];
            *total = match self.kinds[*counter] {
                // Any value but 0 means that some passed (Vulkan, Occlusion Queries).
                CounterKind::AnySamplesPassed => *total | u64::from(result != 0),
                _ => total.wrapping_add(result),
            };
        }
        for (index, (total, word)) in totals.iter_mut().zip(&self.words).enumerate() {
            if let Some(offset) = word {
                let counts = counts.ok_or_else(|| internal("there is no buffer of counts"))?;
                let bytes = counts.read(*offset, size_of::<u32>())?;
                recording::counter_part(index, 0, 4);
                let word = bytes
                    .try_into()
                    .map_err(|_| internal("a count is a word"))?;
                *total = u32::from_ne_bytes(word).into();
            }
        }
        Ok(totals)
    }
}

fn count(owners: &[usize]) -> Result<u32, BackendError> {
    u32::try_from(owners.len()).map_err(|_| internal("too many queries"))
}

fn barrier(device: &Device, commands: vk::CommandBuffer, barrier: vk::MemoryBarrier2<'_>) {
    let barriers = [barrier];
    let info = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: `commands` is being recorded, outside a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}
