//! Reading attachments back: from the output buffer to the frame's images.

use crate::buffer::MappedBuffer;
use crate::descriptors;
use crate::device::Device;
use crate::error::internal;
use crate::format;
use crate::gpu::Gpu;
use crate::image::DeviceImage;
use crate::inputs::OffsetAllocator;
use crate::recording;
use crate::samples::{self, ReaderType, SampleReader, SampleReaders};
use crate::slot::Slot;
use ash::vk;
use etalon_backend::codes::code_of_fetched;
use etalon_backend::{BackendError, Fault, NumberForm, RecordedPlane, doubled};
use etalon_frame::{Aspect, ChannelEncoding, ReadPath};
use etalon_scene::Scene;

/// The read-back of one aspect of an attachment.
pub(crate) struct ReadPlan {
    pub(crate) attachment: usize,
    pub(crate) aspect: Aspect,
    /// The offset of its bytes in the output buffer.
    pub(crate) offset: u64,
    /// True if a shader reads the attachment back.
    by_shader: bool,
    /// The shader and its descriptors, if a shader reads it back.
    pub(crate) reader: Option<(SampleReader, vk::DescriptorSet)>,
    name: String,
    sample_type: ReaderType,
    size: [u32; 2],
    samples: u32,
    raw: vk::Format,
    channels: Vec<ChannelEncoding>,
    bytes: u64,
}

impl ReadPlan {
    /// Returns all reads of a scene, and the size of the output buffer. `by_shader` says of each attachment
    /// whether a shader reads it back.
    pub(crate) fn all(
        gpu: &Gpu,
        scene: &Scene,
        by_shader: &[bool],
    ) -> Result<(Vec<Self>, u64), BackendError> {
        let limits = &gpu.device.limits;
        // Offsets of depth and stencil copies must be multiples of 4, and other offsets multiples of the
        // texel size.
        let alignment = limits.min_storage_buffer_offset_alignment.max(16);
        let mut offsets = OffsetAllocator::default();
        let mut reads = Vec::new();
        for index in &scene.read {
            let Some(attachment) = scene.attachments.get(*index) else {
                return Err(internal("a read names no attachment"));
            };
            let format = attachment.format;
            let by_shader = by_shader.get(*index) == Some(&true);
            let native = format::native(&gpu.natives, format)?;
            for aspect in format.aspects() {
                let channels = format::channels(format, native.raw, *aspect);
                let texels = u64::from(attachment.size[0]) * u64::from(attachment.size[1]);
                let per_texel = if by_shader {
                    attachment.samples as usize * samples::words(*aspect) * size_of::<u32>()
                } else {
                    format::texel_bytes(native.raw, *aspect)
                };
                let bytes = texels * per_texel as u64;
                reads.push(Self {
                    attachment: *index,
                    aspect: *aspect,
                    offset: offsets.allocate(bytes, alignment),
                    by_shader,
                    reader: None,
                    name: attachment.name.clone(),
                    sample_type: ReaderType::of(format, *aspect),
                    size: attachment.size,
                    samples: attachment.samples,
                    raw: native.raw,
                    channels,
                    bytes,
                });
            }
        }
        let bytes = offsets.allocate(0, 1);
        Ok((reads, bytes))
    }

    /// Sets the shader that reads it, if no copy can.
    pub(crate) fn connect(
        &mut self,
        device: &Device,
        readers: &mut SampleReaders,
        slot: &Slot,
        image: &DeviceImage,
        output: &MappedBuffer,
    ) -> Result<(), BackendError> {
        if !self.by_shader {
            return Ok(());
        }
        if self.bytes > u64::from(device.limits.max_storage_buffer_range) {
            let message = format!("{} bytes exceed maxStorageBufferRange", self.bytes);
            return Err(BackendError::refused("samples to read back", message));
        }
        let reader = readers.get(device, self.sample_type, self.samples > 1)?;
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
        let write = |binding, kind| descriptors::write(set, binding, kind);
        let writes = [
            write(0, vk::DescriptorType::SAMPLED_IMAGE).image_info(&images),
            write(1, vk::DescriptorType::STORAGE_BUFFER).buffer_info(&buffers),
        ];
        // SAFETY: the set is new, and view and buffer live as long as the scene.
        unsafe { device.raw.update_descriptor_sets(&writes, &[]) };
        self.reader = Some((reader, set));
        Ok(())
    }

    /// Returns the size of a texel in the output buffer, in bytes.
    pub(crate) fn texel_bytes(&self) -> u64 {
        let texels = u64::from(self.size[0]) * u64::from(self.size[1]);
        self.bytes / texels.max(1)
    }

    /// Returns the image. The device must have written the output buffer. `halved` is true if a filter
    /// averaged its texels with zeros.
    pub(crate) fn image(
        &self,
        output: &MappedBuffer,
        halved: bool,
        fault: Option<Fault>,
    ) -> Result<etalon_frame::Image, BackendError> {
        let length =
            usize::try_from(self.bytes).map_err(|_| internal("an image too large to read"))?;
        let bytes = output.read(self.offset, length)?;
        let mut codes = if self.reader.is_some() {
            self.codes_of_samples(&bytes)
        } else {
            format::decode(&bytes, self.raw, self.aspect)
        };
        if halved {
            for (code, encoding) in codes.iter_mut().zip(self.channels.iter().cycle()) {
                *code = doubled(*encoding, *code);
            }
        }
        if let Some(fault) = fault {
            fault.change_codes(&mut codes, self.size, self.samples, &self.channels);
        }
        let image = etalon_frame::Image {
            attachment: self.name.clone(),
            aspect: self.aspect,
            size: self.size,
            samples: self.samples,
            channels: self.channels.clone(),
            read: ReadPath::Copy,
            codes,
        };
        recording::image(&image, self.planes().into_iter());
        Ok(image)
    }

    /// Returns where the channels of each sample are in the bytes that were read.
    fn planes(&self) -> Vec<RecordedPlane> {
        let texel = u32::try_from(self.texel_bytes()).unwrap_or(u32::MAX);
        if self.reader.is_none() {
            let channels = format::copied_layout(self.raw, self.aspect);
            return vec![RecordedPlane {
                output: 0,
                texel,
                channels: channels.iter().map(|(bit, bits)| [*bit, *bits]).collect(),
                form: NumberForm::Code,
            }];
        }
        let words = samples::words(self.aspect) as u32;
        let form = match self.sample_type {
            ReaderType::Integers | ReaderType::Stencil => NumberForm::Code,
            _ if self.channels.contains(&ChannelEncoding::Srgb8) => NumberForm::Fraction,
            ReaderType::Color | ReaderType::Depth => NumberForm::Float,
        };
        let plane = |sample: u32| RecordedPlane {
            output: 0,
            texel,
            channels: (0..words)
                .map(|word| [32 * (sample * words + word), 32])
                .collect(),
            form,
        };
        (0..self.samples).map(plane).collect()
    }

    /// Returns the codes of the samples that the shader stored, without channels that the format lacks.
    fn codes_of_samples(&self, bytes: &[u8]) -> Vec<u32> {
        let sample = samples::words(self.aspect) * size_of::<u32>();
        let mut codes = Vec::with_capacity(bytes.len() / sample * self.channels.len());
        for stored in bytes.chunks_exact(sample) {
            let words = stored.chunks_exact(4);
            for (encoding, word) in self.channels.iter().zip(words) {
                let bits = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
                codes.push(code_of_fetched(*encoding, bits));
            }
        }
        codes
    }
}
