//! The bindings of draws.

use crate::attachment::Attached;
use crate::calls::{BindGroup, Binding, LayoutEntry, LayoutResource, SampleType, buffer_usage};
use crate::counting::{Counting, RUNS_BYTES};
use crate::tables::Lowering;
use etalon_scene::{Draw, Params, Scene, Shader};

/// The size of the parameter block in bytes.
const PARAMS_BYTES: u64 = size_of::<Params>() as u64;

/// The bindings of a shader, at the numbers that the suite's shaders use.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Bindings {
    /// The parameter block, at binding 0.
    params: bool,
    /// The number of textures, from binding 1.
    textures: usize,
    /// A storage buffer, at binding 3: the counter of shader runs, or the pool.
    storage: bool,
    /// A sampler, at binding 4.
    sampler: bool,
}

impl Bindings {
    pub(crate) fn of(shader: Shader) -> Self {
        Self {
            params: shader.uses_params(),
            textures: shader.textures(),
            storage: shader.uses_storage(),
            sampler: shader.samples_texture(),
        }
    }

    pub(crate) fn entries(self) -> Vec<LayoutEntry> {
        let mut entries = Vec::new();
        let mut add = |binding, resource| entries.push(LayoutEntry { binding, resource });
        if self.params {
            add(0, LayoutResource::Uniform(PARAMS_BYTES));
        }
        let sample_type = if self.sampler {
            SampleType::Float
        } else {
            SampleType::UnfilterableFloat
        };
        for binding in (1..).take(self.textures) {
            add(binding, texture(sample_type, false));
        }
        if self.storage {
            add(3, LayoutResource::Storage(RUNS_BYTES));
        }
        if self.sampler {
            add(4, LayoutResource::Sampler);
        }
        entries
    }
}

pub(crate) fn texture(sample_type: SampleType, multisampled: bool) -> LayoutResource {
    LayoutResource::Texture {
        sample_type,
        multisampled,
    }
}

/// A bind group and the dynamic offset of its parameters, if it has parameters.
#[derive(Clone, Copy)]
pub(crate) struct Bound {
    pub(crate) group: usize,
    pub(crate) offset: Option<u32>,
}

/// The bind groups of a scene.
pub(crate) struct BindGroups<'s> {
    attachments: &'s [Attached],
    counting: &'s Counting,
    /// The scene's pool and its size in bytes.
    pub(crate) pool: Option<(usize, u64)>,
    /// The buffer that holds the parameter blocks of all draws.
    buffer: Option<usize>,
    /// The contents of `buffer`.
    params: Vec<u8>,
    stride: usize,
}

impl<'s> BindGroups<'s> {
    pub(crate) fn new(
        lowering: &mut Lowering<'_>,
        scene: &Scene,
        attachments: &'s [Attached],
        counting: &'s Counting,
    ) -> Self {
        let mut draws = scene.passes.iter().flat_map(|pass| &pass.draws);
        let stride = PARAMS_BYTES.next_multiple_of(lowering.device.uniform_alignment.into());
        let usage = buffer_usage::UNIFORM | buffer_usage::COPY_DST;
        let used = draws.any(|draw| draw.shader.uses_params());
        Self {
            attachments,
            counting,
            pool: None,
            buffer: used.then(|| lowering.buffer(usage, 0)),
            params: Vec::new(),
            stride: stride as usize,
        }
    }

    /// Returns the bind group of a draw, or `None` if its shader has no bindings. `runs` is the counter of
    /// its shader runs.
    pub(crate) fn bind(
        &mut self,
        lowering: &mut Lowering<'_>,
        draw: &Draw,
        runs: Option<usize>,
    ) -> Option<Bound> {
        let bindings = Bindings::of(draw.shader);
        let mut entries = Vec::new();
        let offset = self.buffer.filter(|_| bindings.params).map(|buffer| {
            entries.push((0, part(buffer, 0, PARAMS_BYTES)));
            let start = self.params.len();
            self.params.extend_from_slice(&draw.params.to_bytes());
            self.params.resize(start + self.stride, 0);
            start as u32
        });
        for (binding, texture) in (1..).zip(&draw.textures) {
            let view = lowering.fetched(self.attachments[*texture].target);
            entries.push((binding, Binding::View(view)));
        }
        if let Some((buffer, offset)) = runs.and_then(|counter| self.counting.runs(counter)) {
            entries.push((3, part(buffer, offset, RUNS_BYTES)));
        }
        if let Some((buffer, bytes)) = self.pool.filter(|_| draw.shader.uses_pool()) {
            entries.push((3, part(buffer, 0, bytes)));
        }
        if let Some(sampler) = draw.sampler {
            entries.push((4, Binding::Sampler(lowering.sampler(sampler))));
        }
        if entries.is_empty() {
            return None;
        }
        let layout = lowering.layout(bindings.entries());
        let group = lowering.group(BindGroup { layout, entries });
        Some(Bound { group, offset })
    }

    /// Fills the parameter buffer.
    pub(crate) fn finish(self, lowering: &mut Lowering<'_>) {
        if let Some(buffer) = self.buffer {
            lowering.fill(buffer, self.params);
        }
    }
}

fn part(buffer: usize, offset: u64, size: u64) -> Binding {
    Binding::Buffer {
        buffer,
        offset,
        size,
    }
}
