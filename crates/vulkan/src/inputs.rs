//! The inputs of a scene: vertices, indices, parameters, texels. All are in one buffer, so that a
//! scene takes one allocation.

use crate::buffer::Buffer;
use crate::device::Device;
use crate::format::{self, Native};
use etalon_backend::BackendError;
use etalon_frame::TextureFormat;
use etalon_scene::{Contents, Draw, Params, PrimitiveTopology, RESTART, Scene, Vertex};
use std::collections::BTreeMap;
use std::mem::size_of;

/// Bytes of the parameter block.
pub(crate) const PARAMS_BYTES: u64 = size_of::<Params>() as u64;

/// Assigns consecutive offsets in a buffer.
#[derive(Default)]
pub(crate) struct OffsetAllocator {
    end: u64,
}

impl OffsetAllocator {
    /// Returns the offset of a range of this size and alignment.
    pub(crate) fn allocate(&mut self, bytes: u64, alignment: u64) -> u64 {
        let offset = self.end.next_multiple_of(alignment.max(1));
        self.end = offset + bytes;
        offset
    }
}

/// The offsets and counts of one draw's inputs.
pub(crate) struct DrawInputs {
    pub(crate) vertices: u64,
    pub(crate) params: u64,
    /// The number of vertices, or of indices in an indexed draw.
    pub(crate) count: usize,
    /// The offset of the indices, and the indices, in an indexed draw.
    indices: Option<(u64, Vec<u32>)>,
}

impl DrawInputs {
    fn place(offsets: &mut OffsetAllocator, uniform: u64, draw: &Draw) -> Self {
        let params = offsets.allocate(PARAMS_BYTES, uniform);
        let mesh = &draw.mesh;
        let vertices = offsets.allocate(mesh.bytes().len() as u64, size_of::<Vertex>() as u64);
        let indices = mesh.indices.as_ref().map(|all| {
            let indices = device_indices(draw.topology, all);
            let bytes = indices.len() * size_of::<u32>();
            (
                offsets.allocate(bytes as u64, size_of::<u32>() as u64),
                indices,
            )
        });
        Self {
            vertices,
            params,
            count: match &indices {
                Some((_, indices)) => indices.len(),
                None => mesh.vertices.len(),
            },
            indices,
        }
    }

    /// The offset of the indices in an indexed draw.
    pub(crate) fn index_offset(&self) -> Option<u64> {
        self.indices.as_ref().map(|(offset, _)| *offset)
    }

    /// True if an index restarts the primitive.
    pub(crate) fn restarts(&self) -> bool {
        let indices = self.indices.as_ref().map(|(_, indices)| indices);
        indices.is_some_and(|i| i.contains(&RESTART))
    }
}

/// Returns the indices to upload. Vulkan restarts lists only with an extension
/// (primitiveTopologyListRestart), so restart indices of lists and the incomplete primitives before
/// them are removed.
fn device_indices(topology: PrimitiveTopology, indices: &[u32]) -> Vec<u32> {
    let per_primitive = match topology {
        PrimitiveTopology::PointList => 1,
        PrimitiveTopology::LineList => 2,
        PrimitiveTopology::TriangleList => 3,
        PrimitiveTopology::LineStrip
        | PrimitiveTopology::TriangleStrip
        | PrimitiveTopology::TriangleFan => return indices.to_vec(),
    };
    let runs = indices.split(|i| *i == RESTART);
    runs.flat_map(|run| &run[..run.len() / per_primitive * per_primitive])
        .copied()
        .collect()
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
            let place = |draw: &Draw| DrawInputs::place(&mut offsets, uniform, draw);
            draws.push(pass.draws.iter().map(place).collect());
        }
        let mut texels = Vec::with_capacity(scene.attachments.len());
        for attachment in &scene.attachments {
            let (Contents::Texels(codes), Some(native)) =
                (&attachment.contents, natives.get(&attachment.format))
            else {
                texels.push(None);
                continue;
            };
            let bytes = format::encode(codes, native.raw);
            // A multiple of every texel size.
            texels.push(Some((offsets.allocate(bytes.len() as u64, 16), bytes)));
        }
        Self {
            draws,
            texels,
            bytes: offsets.end.max(PARAMS_BYTES),
        }
    }

    /// Writes all inputs to a buffer of at least `bytes`.
    pub(crate) fn write(&self, buffer: &mut Buffer, scene: &Scene) -> Result<(), BackendError> {
        for (pass, places) in scene.passes.iter().zip(&self.draws) {
            for (draw, place) in pass.draws.iter().zip(places) {
                buffer.write(place.vertices, draw.mesh.bytes())?;
                buffer.write(place.params, &draw.params.to_bytes())?;
                if let Some((offset, indices)) = &place.indices {
                    let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_ne_bytes()).collect();
                    buffer.write(*offset, &bytes)?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn restarts_of_a_list_remove_incomplete_primitives() {
        let indices = [0, 1, 2, 3, RESTART, 4, 5, 6, RESTART, 7];
        let list = |topology| device_indices(topology, &indices);
        assert_eq!(list(PrimitiveTopology::TriangleList), [0, 1, 2, 4, 5, 6]);
        assert_eq!(list(PrimitiveTopology::LineList), [0, 1, 2, 3, 4, 5]);
        assert_eq!(list(PrimitiveTopology::PointList), [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(list(PrimitiveTopology::TriangleFan), indices);
    }
}
