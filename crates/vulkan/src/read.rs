//! From the output buffer to the frame's images.

use crate::device::Device;
use crate::format;
use crate::gpu::Gpu;
use crate::inputs::Placer;
use crate::memory::{Buffer, Image};
use crate::samples::{self, SampleReader, SampleReaders, Seen};
use crate::slot::Slot;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{Aspect, ChannelEncoding, ReadPath, Requirement};
use etalon_scene::Scene;

/// One aspect of one attachment on its way back.
pub(crate) struct ReadPlan {
    pub(crate) attachment: usize,
    pub(crate) aspect: Aspect,
    /// Where its bytes lie in the output buffer.
    pub(crate) offset: u64,
    /// For multisampled attachments, the shader that reads them, and its descriptors.
    pub(crate) reader: Option<(SampleReader, vk::DescriptorSet)>,
    name: String,
    seen: Seen,
    size: [u32; 2],
    samples: u32,
    raw: vk::Format,
    channels: Vec<ChannelEncoding>,
    bytes: u64,
}

impl ReadPlan {
    /// Everything that a scene reads, and the size of the buffer that takes it.
    pub(crate) fn all(gpu: &Gpu, scene: &Scene) -> Result<(Vec<Self>, u64), BackendError> {
        let limits = &gpu.device.limits;
        // Offsets of depth and stencil copies are multiples of 4, of others of the texel's size.
        let alignment = limits.min_storage_buffer_offset_alignment.max(16);
        let mut placer = Placer::default();
        let mut reads = Vec::new();
        for index in &scene.read {
            let Some(attachment) = scene.attachments.get(*index) else {
                let message = "a read names no attachment".to_owned();
                return Err(BackendError::Internal(message));
            };
            let format = attachment.format;
            let native = gpu
                .natives
                .get(&format)
                .ok_or(BackendError::NotSupported(Requirement::Format(format)))?;
            for aspect in format.aspects() {
                let channels = format::channels(format, native.raw, *aspect);
                let texels = u64::from(attachment.size[0]) * u64::from(attachment.size[1]);
                let per_texel = if attachment.samples > 1 {
                    attachment.samples as usize * samples::words(*aspect) * size_of::<u32>()
                } else {
                    format::texel_bytes(native.raw, *aspect)
                };
                let bytes = texels * per_texel as u64;
                reads.push(Self {
                    attachment: *index,
                    aspect: *aspect,
                    offset: placer.place(bytes, alignment),
                    reader: None,
                    name: attachment.name.clone(),
                    seen: Seen::of(format, *aspect),
                    size: attachment.size,
                    samples: attachment.samples,
                    raw: native.raw,
                    channels,
                    bytes,
                });
            }
        }
        let bytes = placer.place(0, 1);
        Ok((reads, bytes))
    }

    /// Gives the read of a multisampled image its shader.
    pub(crate) fn connect(
        &mut self,
        device: &Device,
        readers: &mut SampleReaders,
        slot: &Slot,
        image: &Image,
        output: &Buffer,
    ) -> Result<(), BackendError> {
        if self.samples == 1 {
            return Ok(());
        }
        if self.bytes > u64::from(device.limits.max_storage_buffer_range) {
            return Err(BackendError::Resource {
                what: format!("{} bytes of samples to read back", self.bytes),
                message: "maxStorageBufferRange is smaller".to_owned(),
            });
        }
        let reader = readers.get(device, self.seen)?;
        let set = slot.descriptor_set(device, reader.layout.set)?;
        let images = [vk::DescriptorImageInfo {
            sampler: vk::Sampler::null(),
            image_view: image.sample_view(format::aspect_flag(self.aspect))?,
            image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        }];
        let buffers = [vk::DescriptorBufferInfo {
            buffer: output.raw,
            offset: self.offset,
            range: self.bytes,
        }];
        let write = |binding, kind| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding)
                .descriptor_type(kind)
        };
        let writes = [
            write(0, vk::DescriptorType::SAMPLED_IMAGE).image_info(&images),
            write(1, vk::DescriptorType::STORAGE_BUFFER).buffer_info(&buffers),
        ];
        // SAFETY: the set is new, and view and buffer live as long as the scene.
        unsafe { device.raw.update_descriptor_sets(&writes, &[]) };
        self.reader = Some((reader, set));
        Ok(())
    }

    /// The image, after the device wrote the output buffer.
    pub(crate) fn image(&self, output: &Buffer) -> Result<etalon_frame::Image, BackendError> {
        let length = usize::try_from(self.bytes)
            .map_err(|_| BackendError::Internal("an image too large to read".to_owned()))?;
        let bytes = output.read(self.offset, length)?;
        let codes = if self.reader.is_some() {
            self.codes_of_samples(&bytes)
        } else {
            format::decode(&bytes, self.raw, self.aspect)
        };
        Ok(etalon_frame::Image {
            attachment: self.name.clone(),
            aspect: self.aspect,
            size: self.size,
            samples: self.samples,
            channels: self.channels.clone(),
            read: ReadPath::Copy,
            codes,
        })
    }

    /// The codes of what the shader stored, the channels that the format lacks left out.
    fn codes_of_samples(&self, bytes: &[u8]) -> Vec<u32> {
        let sample = samples::words(self.aspect) * size_of::<u32>();
        let mut codes = Vec::with_capacity(bytes.len() / sample * self.channels.len());
        for stored in bytes.chunks_exact(sample) {
            let words = stored.chunks_exact(4);
            for (encoding, word) in self.channels.iter().zip(words) {
                let seen = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
                codes.push(samples::code(*encoding, seen));
            }
        }
        codes
    }
}
