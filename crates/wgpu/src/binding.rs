//! The bind groups of a scene's draws.

use crate::attachment::DeviceAttachment;
use crate::counting::Counting;
use crate::gpu::{BufferLease, Gpu};
use crate::layout::{Bindings, PARAMS_BYTES, RUNS_BYTES};
use crate::state;
use etalon_backend::BackendError;
use etalon_scene::{Draw, Sampler, Scene};
use std::collections::HashMap;
use wgpu::BufferUsages;

/// A bind group and the dynamic offset of its parameters, if it has any.
pub(crate) struct Bound {
    pub(crate) group: wgpu::BindGroup,
    pub(crate) offset: Option<u32>,
}

/// The bind groups of a scene, each created once.
pub(crate) struct Groups<'a, 's> {
    gpu: &'a Gpu,
    attachments: &'s [DeviceAttachment<'a>],
    counting: &'s Counting<'a>,
    /// The scene's pool, with its size in bytes.
    pool: Option<(&'s wgpu::Buffer, u64)>,
    /// The parameter blocks of all draws.
    buffer: Option<BufferLease<'a>>,
    /// The contents of `buffer`.
    params: Vec<u8>,
    stride: usize,
    made: HashMap<Key, wgpu::BindGroup>,
}

/// The resources of a bind group.
#[derive(PartialEq, Eq, Hash)]
struct Key {
    bindings: Bindings,
    textures: Vec<usize>,
    sampler: Option<Sampler>,
    runs: Option<usize>,
    pool: bool,
}

impl<'a, 's> Groups<'a, 's> {
    pub(crate) fn new(
        gpu: &'a Gpu,
        scene: &Scene,
        attachments: &'s [DeviceAttachment<'a>],
        counting: &'s Counting<'a>,
        pool: Option<(&'s wgpu::Buffer, u64)>,
    ) -> Self {
        let draws = scene.passes.iter().flat_map(|pass| &pass.draws);
        let blocks = draws.filter(|draw| draw.shader.uses_params()).count();
        let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment;
        let stride = PARAMS_BYTES.next_multiple_of(u64::from(alignment));
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        Self {
            gpu,
            attachments,
            counting,
            pool,
            buffer: (blocks > 0).then(|| gpu.buffer(usage, blocks as u64 * stride)),
            params: Vec::new(),
            stride: stride as usize,
            made: HashMap::new(),
        }
    }

    /// Returns the bind group of a draw; `None` if its shader has no bindings. `runs` is the
    /// counter of its shader runs.
    pub(crate) fn bind(
        &mut self,
        draw: &Draw,
        runs: Option<usize>,
    ) -> Result<Option<Bound>, BackendError> {
        let bindings = Bindings::of(draw.shader);
        let offset = bindings.params.then(|| {
            let start = self.params.len();
            self.params.extend_from_slice(&draw.params.to_bytes());
            self.params.resize(start + self.stride, 0);
            start as u32
        });
        let key = Key {
            bindings,
            textures: draw.textures.clone(),
            sampler: draw.sampler,
            runs,
            pool: draw.shader.uses_pool(),
        };
        if let Some(group) = self.made.get(&key) {
            let group = group.clone();
            return Ok(Some(Bound { group, offset }));
        }
        let Some(group) = self.make(&key)? else {
            return Ok(None);
        };
        self.made.insert(key, group.clone());
        Ok(Some(Bound { group, offset }))
    }

    fn make(&self, key: &Key) -> Result<Option<wgpu::BindGroup>, BackendError> {
        let mut entries = Vec::new();
        let mut give = |binding, resource| {
            entries.push(wgpu::BindGroupEntry { binding, resource });
        };
        if let Some(buffer) = self.buffer.as_ref().filter(|_| key.bindings.params) {
            give(0, part(buffer, 0, PARAMS_BYTES));
        }
        for (binding, texture) in (1..).zip(&key.textures) {
            let view = self.attachments[*texture].target.fetch();
            give(binding, wgpu::BindingResource::TextureView(view));
        }
        if let Some((buffer, offset)) = key.runs.and_then(|counter| self.counting.runs(counter)) {
            give(3, part(buffer, offset, RUNS_BYTES));
        }
        if let Some((buffer, bytes)) = self.pool.filter(|_| key.pool) {
            give(3, part(buffer, 0, bytes));
        }
        let (device, pipelines) = (&self.gpu.device, &self.gpu.pipelines);
        let sampler = match key.sampler {
            None => None,
            Some(sampler) => Some(pipelines.samplers.get(sampler, |sampler| {
                Ok(device.create_sampler(&state::sampler(*sampler)))
            })?),
        };
        if let Some(sampler) = &sampler {
            give(4, wgpu::BindingResource::Sampler(sampler));
        }
        if entries.is_empty() {
            return Ok(None);
        }
        let layout = pipelines.layouts.draw(device, key.bindings)?;
        Ok(Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout.bindings,
            entries: &entries,
        })))
    }

    /// Uploads the parameters and returns their buffer, which must outlive the groups.
    pub(crate) fn finish(self) -> Option<BufferLease<'a>> {
        if let Some(buffer) = &self.buffer {
            self.gpu.queue.write_buffer(buffer, 0, &self.params);
        }
        self.buffer
    }
}

fn part(buffer: &wgpu::Buffer, offset: u64, bytes: u64) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset,
        size: wgpu::BufferSize::new(bytes),
    })
}
