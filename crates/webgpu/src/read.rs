//! The commands that copy attachments and counts into one buffer.

use crate::attachment::{Attached, PITCH, accessed};
use crate::calls::{
    Access, BindGroup, Binding, BufferRows, ColorAttachment, DrawCommand, EncoderCommand, Filled,
    PassCommand, RenderPass, TextureAspect, buffer_usage,
};
use crate::counting::Counting;
use crate::device::{Device, read_path};
use crate::fetch::{self, FetchKey};
use crate::format::GpuFormat;
use crate::path;
use crate::reading::{ImageReading, MappedReading, ReadMethod};
use crate::tables::{Lowering, TextureTarget};
use etalon_backend::halves;
use etalon_frame::{
    Aspect, ChannelEncoding, PathEnd, PathTarget, PathViews, ReadPath, Requirement, TextureFormat,
};
use etalon_scene::{Attachment, Scene};

/// Adds the commands that read a scene to the list, and the meaning of the bytes.
pub(crate) fn plan(
    lowering: &mut Lowering<'_>,
    scene: &Scene,
    attachments: &[Attached],
    counting: &Counting,
) -> Result<(), Requirement> {
    let usage = buffer_usage::MAP_READ | buffer_usage::COPY_DST;
    let output = lowering.buffer(usage, 0);
    let mut copies = Vec::new();
    let mut commands = Vec::new();
    let mut images = Vec::new();
    let mut size = 0;
    for index in &scene.read {
        let attachment = &scene.attachments[*index];
        let end = path::end(scene, *index, lowering.reading(attachment.format));
        let drawn = attachments[*index].target;
        let target = match end {
            PathEnd::Copy => copied(lowering, attachment, drawn, &mut copies)?,
            _ => drawn,
        };
        for aspect in attachment.format.aspects() {
            let image = image(lowering.device, attachment, *aspect, end, size);
            size += image.bytes();
            let read = Read {
                image: &image,
                target,
                end,
                output,
            };
            read.record(lowering, &mut commands)?;
            images.push(image);
        }
    }
    let bytes = size + counting.bytes();
    let padded = bytes.next_multiple_of(4).max(4);
    lowering.list.buffers[output].size = padded;
    // If the driver loses a copy, the codes of an earlier scene with the same picture must not remain.
    copies.push(EncoderCommand::ClearBuffer {
        buffer: output,
        size: padded,
    });
    commands.extend(counting.copy(output, size));
    lowering.list.read = copies.into_iter().chain(commands).collect();
    lowering.list.output = output;
    lowering.list.reading = MappedReading {
        bytes,
        images,
        counters: counting.readings(size),
    };
    Ok(())
}

/// Adds the copy of an attachment to another texture, and returns that texture.
fn copied(
    lowering: &mut Lowering<'_>,
    attachment: &Attachment,
    drawn: TextureTarget,
    commands: &mut Vec<EncoderCommand>,
) -> Result<TextureTarget, Requirement> {
    let (format, size) = (attachment.format, attachment.size);
    let (target, views) = (PathTarget::Plain, PathViews::Same);
    let target = lowering.attachment(format, size, attachment.samples, target, views)?;
    commands.extend(spoiled(lowering, format, target).map(EncoderCommand::Pass));
    let aspect = TextureAspect::All;
    commands.push(EncoderCommand::CopyTexture {
        from: drawn.copied(aspect, [0, 0]),
        to: target.copied(aspect, [0, 0]),
        size,
    });
    Ok(target)
}

/// Returns a pass that fills the target of a copy with values that show a lost copy.
fn spoiled(
    lowering: &mut Lowering<'_>,
    format: TextureFormat,
    target: TextureTarget,
) -> Option<RenderPass> {
    let mut pass = RenderPass::default();
    if format.is_color() {
        let value = if format.is_integer() { 77.0 } else { 0.3 };
        pass.color = vec![Some(ColorAttachment {
            operations: Filled::cleared([value; 4]),
            ..cleared(lowering, target)
        })];
    } else {
        let depth = Access::Written(Filled::cleared(0.3));
        let stencil = Access::Written(Filled::cleared(77));
        pass.depth_stencil = Some(accessed(lowering, target, format, depth, stencil));
    }
    lowering.device.draws(format).then_some(pass)
}

/// Returns the reading of an aspect whose bytes begin at an offset.
fn image(
    device: &Device,
    attachment: &Attachment,
    aspect: Aspect,
    end: PathEnd,
    offset: u64,
) -> ImageReading {
    let format = attachment.format;
    let path = read_path(format, device.abilities);
    let channels = match (aspect, format) {
        (Aspect::Color, _) => format.color_channels().to_vec(),
        (Aspect::Stencil, _) => vec![ChannelEncoding::Uint(8)],
        (Aspect::Depth, TextureFormat::Depth16Unorm) if path == ReadPath::Copy => {
            vec![ChannelEncoding::Unorm(16)]
        }
        (Aspect::Depth, _) => vec![ChannelEncoding::Float32],
    };
    let method = match aspect {
        _ if attachment.samples > 1 => ReadMethod::FetchSamples,
        Aspect::Color if end == PathEnd::ShaderRead => ReadMethod::FetchTexel,
        Aspect::Depth if path == ReadPath::Shader || end == PathEnd::ShaderRead => {
            ReadMethod::FetchDepth
        }
        Aspect::Stencil if !device.abilities.copies => ReadMethod::StencilBits,
        Aspect::Color | Aspect::Depth | Aspect::Stencil => ReadMethod::Copy,
    };
    let mut image = ImageReading {
        attachment: attachment.name.clone(),
        format,
        aspect,
        size: attachment.size,
        samples: attachment.samples,
        channels,
        read: if aspect == Aspect::Depth {
            path
        } else {
            ReadPath::Copy
        },
        method,
        offset,
        pitch: 0,
    };
    image.pitch = (image.size[0] * image.texel_bytes() as u32).next_multiple_of(PITCH);
    image
}

/// The route by which one aspect reaches the buffer.
struct Read<'a> {
    image: &'a ImageReading,
    target: TextureTarget,
    end: PathEnd,
    output: usize,
}

impl Read<'_> {
    fn record(
        &self,
        lowering: &mut Lowering<'_>,
        commands: &mut Vec<EncoderCommand>,
    ) -> Result<(), Requirement> {
        match self.image.method {
            ReadMethod::Copy => {
                let aspect = match self.image.aspect {
                    Aspect::Color => TextureAspect::All,
                    Aspect::Depth => TextureAspect::DepthOnly,
                    Aspect::Stencil => TextureAspect::StencilOnly,
                };
                self.copy(self.target, aspect, 0, commands);
            }
            ReadMethod::FetchTexel => {
                let key = if self.image.format.is_integer() {
                    FetchKey::IntegerTexel
                } else {
                    FetchKey::Texel
                };
                let view = lowering.fetched(self.target);
                self.fetch(lowering, key, view, 0, commands)?;
            }
            ReadMethod::FetchDepth => {
                let view = lowering.fetched(self.target);
                self.fetch(lowering, FetchKey::Depth, view, 0, commands)?;
            }
            ReadMethod::FetchSamples => {
                let (key, view) = if self.image.aspect == Aspect::Stencil {
                    let view = lowering.fetched_stencil(self.target);
                    (FetchKey::StencilSample, view)
                } else {
                    (FetchKey::Sample, lowering.fetched(self.target))
                };
                for sample in 0..self.image.samples {
                    self.fetch(lowering, key, view, sample, commands)?;
                }
            }
            ReadMethod::StencilBits => {
                let format = GpuFormat::of(TextureFormat::Rgba8Unorm)?;
                for half in [0_u8, 1] {
                    let target = lowering.scratch(format, self.image.size);
                    let pass = self.bits(lowering, target, half)?;
                    commands.push(EncoderCommand::Pass(pass));
                    self.copy(target, TextureAspect::All, half.into(), commands);
                }
            }
        }
        Ok(())
    }

    /// Adds the fetch of one sample and its copy to the buffer.
    fn fetch(
        &self,
        lowering: &mut Lowering<'_>,
        key: FetchKey,
        view: usize,
        sample: u32,
        commands: &mut Vec<EncoderCommand>,
    ) -> Result<(), Requirement> {
        let target = lowering.scratch(key.target()?, self.image.size);
        let pipeline = fetch::pipeline(lowering, key)?;
        let layout = lowering.layout(key.entries());
        let group = lowering.group(BindGroup {
            layout,
            entries: vec![(1, Binding::View(view))],
        });
        let draws = [
            DrawCommand::SetPipeline(pipeline),
            DrawCommand::SetBindGroup {
                group,
                offset: None,
            },
            DrawCommand::Draw {
                vertices: 3 * sample..3 * sample + 3,
                instances: 0..1,
            },
        ];
        commands.push(EncoderCommand::Pass(RenderPass {
            color: vec![Some(cleared(lowering, target))],
            commands: draws.map(PassCommand::Draw).to_vec(),
            ..RenderPass::default()
        }));
        self.copy(target, TextureAspect::All, sample.into(), commands);
        Ok(())
    }

    /// Returns the pass that writes four bits of stencil to the channels of a texture.
    fn bits(
        &self,
        lowering: &mut Lowering<'_>,
        target: TextureTarget,
        half: u8,
    ) -> Result<RenderPass, Requirement> {
        let format = self.image.format;
        let mut commands = vec![PassCommand::SetStencilReference(0xff)];
        for bit in 4 * half..4 * half + 4 {
            let pipeline = fetch::pipeline(lowering, FetchKey::StencilBit { format, bit })?;
            commands.push(PassCommand::Draw(DrawCommand::SetPipeline(pipeline)));
            commands.push(PassCommand::Draw(DrawCommand::Draw {
                vertices: 0..3,
                instances: 0..1,
            }));
        }
        let depth = Access::Written(Filled::kept());
        let stencil = Access::Written(Filled::kept());
        Ok(RenderPass {
            color: vec![Some(cleared(lowering, target))],
            depth_stencil: Some(accessed(lowering, self.target, format, depth, stencil)),
            commands,
            ..RenderPass::default()
        })
    }

    /// Adds the copies of a texture to the image with index `image` in the buffer.
    fn copy(
        &self,
        from: TextureTarget,
        aspect: TextureAspect,
        image: u64,
        commands: &mut Vec<EncoderCommand>,
    ) {
        let [width, height] = self.image.size;
        let (columns, rows) = match self.end {
            PathEnd::Part => (halves(width), halves(height)),
            _ => (vec![(0, width)], vec![(0, height)]),
        };
        let first = self.image.offset + image * self.image.image_bytes();
        for (y, high) in rows {
            for (x, wide) in &columns {
                let texels = u64::from(*x) * self.image.texel_bytes() as u64;
                let row = u64::from(y) * u64::from(self.image.pitch);
                commands.push(EncoderCommand::Download {
                    from: from.copied(aspect, [*x, y]),
                    to: BufferRows {
                        buffer: self.output,
                        offset: first + row + texels,
                        pitch: self.image.pitch,
                    },
                    size: [*wide, high],
                });
            }
        }
    }
}

/// Returns a colour attachment that clears a target to zeros.
fn cleared(lowering: &mut Lowering<'_>, target: TextureTarget) -> ColorAttachment {
    ColorAttachment {
        view: lowering.view(target),
        depth_slice: None,
        resolve: None,
        operations: Filled::cleared([0.0; 4]),
    }
}
