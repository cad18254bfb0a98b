//! Descriptor sets of draws: parameters, textures, sampler and storage.

use crate::buffer::MappedBuffer;
use crate::counting::CounterQueries;
use crate::device::Device;
use crate::error::internal;
use crate::image::DeviceImage;
use crate::image_state::FETCHED;
use crate::inputs::PARAMS_BYTES;
use crate::own_pass;
use crate::pipeline::{Pipelines, SAMPLER_BINDING, STORAGE_BINDING, ShaderBindings};
use crate::samplers::Samplers;
use crate::slot::Slot;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::PathReads;
use etalon_scene::{Draw, Sampler};
use std::collections::HashMap;
use std::mem::size_of;

/// The resources of a draw. Draws with equal resources share a descriptor set, since the offset of the
/// parameters is dynamic.
#[derive(PartialEq, Eq, Hash)]
struct Resources {
    textures: Vec<usize>,
    /// The way in which the draw reads attachments of its pass, and the aspect of depth and stencil.
    own: Option<(PathReads, bool)>,
    sampler: Option<Sampler>,
    counter: Option<usize>,
    pool: bool,
}

/// The resources of a scene and the descriptor sets made so far.
pub(crate) struct Descriptors<'a> {
    pub(crate) input: &'a MappedBuffer,
    /// The buffer of the shaders' counts, if any shader counts.
    pub(crate) counts: Option<&'a MappedBuffer>,
    /// The pool and its size in bytes, if the scene has a pool.
    pub(crate) pool: Option<(&'a MappedBuffer, u64)>,
    pub(crate) images: &'a [DeviceImage],
    sets: HashMap<Resources, vk::DescriptorSet>,
}

/// Returns a write of one binding of a set; the caller adds the resource.
pub(crate) fn write(
    set: vk::DescriptorSet,
    binding: u32,
    kind: vk::DescriptorType,
) -> vk::WriteDescriptorSet<'static> {
    vk::WriteDescriptorSet::default()
        .dst_set(set)
        .dst_binding(binding)
        .descriptor_type(kind)
}

impl<'a> Descriptors<'a> {
    pub(crate) fn new(
        input: &'a MappedBuffer,
        counts: Option<&'a MappedBuffer>,
        pool: Option<(&'a MappedBuffer, u64)>,
        images: &'a [DeviceImage],
    ) -> Self {
        Self {
            input,
            counts,
            pool,
            images,
            sets: HashMap::new(),
        }
    }

    /// Returns the descriptor set of a draw.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        (pipelines, samplers): (&mut Pipelines, &mut Samplers),
        slot: &Slot,
        counting: &CounterQueries,
        (draw, own): (&Draw, Option<PathReads>),
    ) -> Result<vk::DescriptorSet, BackendError> {
        let word = counting.word(draw)?;
        let bindings = ShaderBindings::of(draw.shader, own_pass::has_inputs(own));
        if draw.textures.len() != bindings.textures || draw.sampler.is_some() != bindings.sampler {
            return Err(internal("a draw lacks the textures that its shader reads"));
        }
        let resources = Resources {
            textures: draw.textures.clone(),
            own: own.map(|way| (way, draw.shader.reads_stencil())),
            sampler: draw.sampler,
            counter: word.map(|(counter, _)| counter),
            pool: draw.shader.uses_pool(),
        };
        if let Some(set) = self.sets.get(&resources) {
            return Ok(*set);
        }
        let layout = pipelines.layout(device, bindings)?;
        let set = slot.descriptor_set(device, layout.set)?;
        let sampler = match draw.sampler {
            Some(sampler) => Some(samplers.get(device, sampler)?),
            None => None,
        };
        let word = word.map(|(_, offset)| offset);
        self.write(device, set, (draw, own), sampler, word)?;
        self.sets.insert(resources, set);
        Ok(set)
    }

    fn write(
        &self,
        device: &Device,
        set: vk::DescriptorSet,
        (draw, own): (&Draw, Option<PathReads>),
        sampler: Option<vk::Sampler>,
        word: Option<u64>,
    ) -> Result<(), BackendError> {
        let write = |binding, kind| write(set, binding, kind);
        let params = [vk::DescriptorBufferInfo {
            buffer: self.input.raw,
            offset: 0,
            range: PARAMS_BYTES,
        }];
        let mut writes =
            vec![write(0, vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC).buffer_info(&params)];
        let mut textures = Vec::with_capacity(draw.textures.len());
        for index in &draw.textures {
            let image = self
                .images
                .get(*index)
                .ok_or_else(|| internal("a draw names no attachment"))?;
            let aspect = match (image.aspects(), draw.shader.reads_stencil()) {
                (vk::ImageAspectFlags::COLOR, _) => vk::ImageAspectFlags::COLOR,
                (_, true) => vk::ImageAspectFlags::STENCIL,
                (_, false) => vk::ImageAspectFlags::DEPTH,
            };
            textures.push([vk::DescriptorImageInfo {
                sampler: vk::Sampler::null(),
                image_view: image.view(aspect)?,
                image_layout: own.map_or(FETCHED, own_pass::state).layout,
            }]);
        }
        for (binding, info) in (1..).zip(&textures) {
            let kind = own_pass::descriptor(own_pass::has_inputs(own));
            writes.push(write(binding, kind).image_info(info));
        }
        let samplers = [vk::DescriptorImageInfo::default().sampler(sampler.unwrap_or_default())];
        if sampler.is_some() {
            writes.push(write(SAMPLER_BINDING, vk::DescriptorType::SAMPLER).image_info(&samplers));
        }
        let mut storage = [vk::DescriptorBufferInfo::default()];
        if let Some(info) = self.storage(draw, word)? {
            storage[0] = info;
            let kind = vk::DescriptorType::STORAGE_BUFFER;
            writes.push(write(STORAGE_BINDING, kind).buffer_info(&storage));
        }
        // SAFETY: the set is new, the resources that it names live as long as the scene, and samplers live
        // longer.
        unsafe { device.raw.update_descriptor_sets(&writes, &[]) };
        Ok(())
    }

    /// Returns the part of a storage buffer that a draw's shader uses: its counter's word, or the pool.
    fn storage(
        &self,
        draw: &Draw,
        word: Option<u64>,
    ) -> Result<Option<vk::DescriptorBufferInfo>, BackendError> {
        let (found, offset) = match word {
            Some(offset) => {
                let word = |buffer| (buffer, size_of::<u32>() as u64);
                (self.counts.map(word), offset)
            }
            None if draw.shader.uses_pool() => (self.pool, 0),
            None => return Ok(None),
        };
        let (buffer, range) = found.ok_or_else(|| internal("a shader's storage is missing"))?;
        Ok(Some(vk::DescriptorBufferInfo {
            buffer: buffer.raw,
            offset,
            range,
        }))
    }
}
