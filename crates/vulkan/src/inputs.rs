//! What the processor gives the device: vertices, parameters, texels.

use crate::device::Device;
use crate::format;
use crate::memory::Buffer;
use etalon_backend::BackendError;
use etalon_case::scene::{Contents, Draw, Params};
use etalon_case::{Scene, Vertex};
use std::mem::size_of;

/// Bytes of the parameter block.
pub(crate) const PARAMS_BYTES: u64 = size_of::<Params>() as u64;

/// Places things in a buffer one behind the other.
#[derive(Default)]
pub(crate) struct Placer {
    end: u64,
}

impl Placer {
    /// The offset of so many bytes, a multiple of the alignment.
    pub(crate) fn place(&mut self, bytes: u64, alignment: u64) -> u64 {
        let offset = self.end.next_multiple_of(alignment.max(1));
        self.end = offset + bytes;
        offset
    }
}

/// Where a scene's inputs lie in its buffer.
pub(crate) struct Inputs {
    /// Vertices and parameters of each draw of each pass.
    pub(crate) draws: Vec<Vec<(u64, u64)>>,
    /// Texels of each attachment that is uploaded.
    texels: Vec<Option<(u64, Vec<u8>)>>,
    pub(crate) bytes: u64,
}

impl Inputs {
    /// Finds a place for everything.
    pub(crate) fn place(device: &Device, scene: &Scene) -> Self {
        let mut placer = Placer::default();
        let uniform = device.limits.min_uniform_buffer_offset_alignment;
        let mut draws = Vec::with_capacity(scene.passes.len());
        for pass in &scene.passes {
            let place = |draw: &Draw| {
                let params = placer.place(PARAMS_BYTES, uniform);
                let vertices =
                    placer.place(draw.mesh.bytes().len() as u64, size_of::<Vertex>() as u64);
                (vertices, params)
            };
            draws.push(pass.draws.iter().map(place).collect());
        }
        let mut texels = Vec::with_capacity(scene.attachments.len());
        for attachment in &scene.attachments {
            let Contents::Texels(codes) = &attachment.contents else {
                texels.push(None);
                continue;
            };
            let bytes = format::encode(codes, attachment.format);
            // A multiple of every texel's size.
            texels.push(Some((placer.place(bytes.len() as u64, 16), bytes)));
        }
        Self {
            draws,
            texels,
            bytes: placer.end.max(PARAMS_BYTES),
        }
    }

    /// Writes everything to its place in a buffer of at least `bytes`.
    pub(crate) fn write(&self, buffer: &mut Buffer, scene: &Scene) -> Result<(), BackendError> {
        for (pass, offsets) in scene.passes.iter().zip(&self.draws) {
            for (draw, (vertices, params)) in pass.draws.iter().zip(offsets) {
                buffer.write(*vertices, draw.mesh.bytes())?;
                buffer.write(*params, &draw.params.to_bytes())?;
            }
        }
        for (offset, bytes) in self.texels.iter().flatten() {
            buffer.write(*offset, bytes)?;
        }
        Ok(())
    }

    /// Where an attachment's texels lie; 0 where it has none.
    pub(crate) fn texels(&self, attachment: usize) -> u64 {
        let texels = self.texels.get(attachment).and_then(Option::as_ref);
        texels.map_or(0, |(offset, _)| *offset)
    }
}
