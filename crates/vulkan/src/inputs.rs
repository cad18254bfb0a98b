//! The inputs of a scene: vertices, indices, parameters, texels. One buffer holds all of them, so that a
//! scene needs one allocation.

use crate::buffer::MappedBuffer;
use crate::device::Device;
use crate::format::{self, Native};
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{PathDraws, TextureFormat};
use etalon_scene::{AttachmentContents, Call, Draw, IndexFormat, Params, Scene, Vertex};
use std::collections::BTreeMap;
use std::mem::size_of;

/// The size of the parameter block in bytes.
pub(crate) const PARAMS_BYTES: u64 = size_of::<Params>() as u64;

/// The size of the arguments of an indirect draw in bytes, indexed or not.
pub(crate) const ARGUMENTS_BYTES: u64 = size_of::<vk::DrawIndexedIndirectCommand>() as u64;

/// Assigns consecutive offsets in a buffer.
#[derive(Default)]
pub(crate) struct OffsetAllocator {
    end: u64,
}

impl OffsetAllocator {
    /// Assigns a range of this size and alignment, and returns its offset.
    pub(crate) fn allocate(&mut self, bytes: u64, alignment: u64) -> u64 {
        let offset = self.end.next_multiple_of(alignment.max(1));
        self.end = offset + bytes;
        offset
    }
}

/// The offsets of one draw's inputs, and the arguments of its draw call.
pub(crate) struct DrawInputs {
    pub(crate) vertices: u64,
    pub(crate) params: u64,
    /// The offset of the indices and their type, in an indexed draw.
    pub(crate) indices: Option<(u64, vk::IndexType)>,
    /// The offset of the colours of instances.
    pub(crate) colors: Option<u64>,
    /// The arguments of an indirect draw.
    pub(crate) arguments: Option<Arguments>,
    /// True if primitive restart is enabled.
    pub(crate) restarts: bool,
    pub(crate) call: CallNumbers,
}

/// The offsets of the arguments of an indirect draw.
#[derive(Clone, Copy)]
pub(crate) struct Arguments {
    pub(crate) offset: u64,
    /// The offset of the number of draws, which is 1, if the device reads it from the buffer. The arguments
    /// of a second draw follow it.
    pub(crate) count: Option<u64>,
}

/// The arguments of a draw call.
#[derive(Clone, Copy)]
pub(crate) struct CallNumbers {
    /// The first vertex, or the first index of an indexed draw.
    pub(crate) first: u32,
    /// The number of vertices, or of indices of an indexed draw.
    pub(crate) count: u32,
    pub(crate) base_vertex: i32,
    pub(crate) instances: u32,
    pub(crate) first_instance: u32,
}

impl CallNumbers {
    /// Returns the arguments as an indirect draw reads them (VkDrawIndexedIndirectCommand,
    /// VkDrawIndirectCommand).
    fn arguments(&self, indexed: bool) -> Vec<u8> {
        let mut words = vec![self.count, self.instances, self.first];
        if indexed {
            words.push(self.base_vertex.cast_unsigned());
        }
        words.push(self.first_instance);
        words.into_iter().flat_map(u32::to_ne_bytes).collect()
    }
}

impl DrawInputs {
    fn place(
        offsets: &mut OffsetAllocator,
        uniform: u64,
        draw: &Draw,
        indirect: bool,
        counted: bool,
    ) -> Self {
        let params = offsets.allocate(PARAMS_BYTES, uniform);
        let call = call(draw);
        let bytes = size_of_val(&*call.vertices);
        let vertices = offsets.allocate(bytes as u64, size_of::<Vertex>() as u64);
        let indices = call.indices.as_ref().map(|indices| {
            let (kind, size) = match call.index {
                IndexFormat::Uint16 => (vk::IndexType::UINT16, size_of::<u16>()),
                IndexFormat::Uint32 => (vk::IndexType::UINT32, size_of::<u32>()),
            };
            let bytes = indices.len() * size;
            (offsets.allocate(bytes as u64, size as u64), kind)
        });
        let colors = call.color_bytes().len() as u64;
        let arguments = indirect.then(|| Arguments {
            count: counted.then(|| offsets.allocate(size_of::<u32>() as u64, 4)),
            offset: offsets.allocate(ARGUMENTS_BYTES * (1 + u64::from(counted)), 4),
        });
        Self {
            arguments,
            vertices,
            params,
            indices,
            colors: (colors > 0).then(|| offsets.allocate(colors, size_of::<f32>() as u64)),
            restarts: call.restarts(),
            call: CallNumbers {
                first: call.first,
                count: call.count,
                base_vertex: call.base_vertex,
                instances: call.instances,
                first_instance: call.first_instance,
            },
        }
    }
}

/// Returns the draw call. Vulkan restarts lists only with an extension (primitiveTopologyListRestart).
fn call(draw: &Draw) -> Call<'_> {
    draw.call().without_list_restarts(draw.topology)
}

/// The inputs of a scene with their offsets.
pub(crate) struct Inputs {
    /// The inputs of each draw of each pass.
    pub(crate) draws: Vec<Vec<DrawInputs>>,
    /// The offset and bytes of each attachment's texels, if it is uploaded.
    texels: Vec<Option<(u64, Vec<u8>)>>,
    pub(crate) bytes: u64,
}

impl Inputs {
    /// Assigns offsets to all inputs.
    pub(crate) fn place(
        device: &Device,
        natives: &BTreeMap<TextureFormat, Native>,
        scene: &Scene,
    ) -> Self {
        let mut offsets = OffsetAllocator::default();
        let uniform = device.limits.min_uniform_buffer_offset_alignment;
        let mut draws = Vec::with_capacity(scene.passes.len());
        for pass in &scene.passes {
            // Without the feature, an indirect draw must have the first instance 0.
            let place = |draw: &Draw| {
                let first = draw.fetch.first_instance == 0
                    || device.features.draw_indirect_first_instance != 0;
                let counted = scene.path.draws == PathDraws::IndirectCount;
                let indirect = (counted || scene.path.draws == PathDraws::Indirect) && first;
                let mut place = DrawInputs::place(&mut offsets, uniform, draw, indirect, counted);
                place.restarts |=
                    scene.path.draws == PathDraws::RestartUnindexed && draw.is_unindexed_strip();
                place
            };
            draws.push(pass.draws.iter().map(place).collect());
        }
        let mut texels = Vec::with_capacity(scene.attachments.len());
        for attachment in &scene.attachments {
            let (AttachmentContents::Texels(codes), Some(native)) =
                (&attachment.contents, natives.get(&attachment.format))
            else {
                texels.push(None);
                continue;
            };
            let bytes = format::encode(codes, native.raw);
            // 16 is a multiple of every texel size.
            texels.push(Some((offsets.allocate(bytes.len() as u64, 16), bytes)));
        }
        Self {
            draws,
            texels,
            bytes: offsets.end.max(PARAMS_BYTES),
        }
    }

    /// Writes all inputs to a buffer of at least `bytes`.
    pub(crate) fn write(
        &self,
        buffer: &mut MappedBuffer,
        scene: &Scene,
    ) -> Result<(), BackendError> {
        for (pass, places) in scene.passes.iter().zip(&self.draws) {
            for (draw, place) in pass.draws.iter().zip(places) {
                let call = call(draw);
                buffer.write(place.vertices, call.vertex_bytes())?;
                buffer.write(place.params, &draw.params.to_bytes())?;
                if let Some(Arguments { offset, count }) = place.arguments {
                    let arguments = place.call.arguments(place.indices.is_some());
                    buffer.write(offset, &arguments)?;
                    if let Some(count) = count {
                        buffer.write(count, &1_u32.to_ne_bytes())?;
                        buffer.write(offset + ARGUMENTS_BYTES, &arguments)?;
                    }
                }
                if let Some((offset, _)) = place.indices {
                    buffer.write(offset, &call.index_bytes())?;
                }
                if let Some(offset) = place.colors {
                    buffer.write(offset, call.color_bytes())?;
                }
            }
        }
        for (offset, bytes) in self.texels.iter().flatten() {
            buffer.write(*offset, bytes)?;
        }
        Ok(())
    }

    /// Returns the offset of an attachment's texels; 0 if it is not uploaded.
    pub(crate) fn texels(&self, attachment: usize) -> u64 {
        let texels = self.texels.get(attachment).and_then(Option::as_ref);
        texels.map_or(0, |(offset, _)| *offset)
    }
}
