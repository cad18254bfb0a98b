//! Reading the samples of a multisampled attachment with a compute shader, since no copy can.
//!
//! The shader stores the values that it fetches, 32-bit floats or integers, and `etalon_backend::codes`
//! recovers their codes. This is exact for the encodings used here: normalized values of up to 16 bits are
//! far enough apart that rounding undoes the conversion whatever its last bits (Vulkan, Conversion From
//! Normalized Fixed-Point), floats and integers are stored unchanged, and sRGB codes are fetched unconverted.
//! A signed -1 has two codes; the one nearer to 0 is returned. 24-bit depth would not be exact and is never
//! multisampled here.

use crate::device::Device;
use crate::error::{Check, internal};
use crate::pipeline::{PipelineLayouts, create_layout};
use crate::shader;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{Aspect, ChannelEncoding, TextureFormat};
use std::collections::HashMap;

/// The side of a workgroup in texels.
pub(crate) const TILE: u32 = 8;

/// The readers created so far.
#[derive(Debug, Default)]
pub(crate) struct SampleReaders {
    layout: Option<PipelineLayouts>,
    pipelines: HashMap<(ReaderType, bool), vk::Pipeline>,
}

/// The compute pipeline of a reader with its layouts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleReader {
    pub(crate) pipeline: vk::Pipeline,
    pub(crate) layout: PipelineLayouts,
}

/// Returns true if a shader can recover the codes of this encoding.
pub(crate) fn can_read(encoding: ChannelEncoding) -> bool {
    match encoding {
        ChannelEncoding::Unorm(bits) | ChannelEncoding::Snorm(bits) => bits <= 16,
        _ => true,
    }
}

/// The type of the values that a reader fetches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum ReaderType {
    /// Colours as floats.
    Color,
    /// Integer colours.
    Integers,
    Depth,
    Stencil,
}

impl ReaderType {
    /// Returns the sample type of an aspect.
    pub(crate) fn of(format: TextureFormat, aspect: Aspect) -> Self {
        match aspect {
            Aspect::Color if format.is_integer() => Self::Integers,
            Aspect::Color => Self::Color,
            Aspect::Depth => Self::Depth,
            Aspect::Stencil => Self::Stencil,
        }
    }
}

/// Returns the number of words that the shader stores for a sample of an aspect.
pub(crate) fn words(aspect: Aspect) -> usize {
    if aspect == Aspect::Color { 4 } else { 1 }
}

/// Returns the WGSL of a reader of multisampled images, or of images with one sample.
fn source(seen: ReaderType, several: bool) -> String {
    let (texture, code, aspect) = match seen {
        ReaderType::Color => (
            "texture_multisampled_2d<f32>",
            "bitcast<vec4u>(texel)",
            Aspect::Color,
        ),
        ReaderType::Integers => ("texture_multisampled_2d<u32>", "texel", Aspect::Color),
        ReaderType::Depth => (
            "texture_depth_multisampled_2d",
            "vec4u(bitcast<u32>(texel))",
            Aspect::Depth,
        ),
        ReaderType::Stencil => ("texture_multisampled_2d<u32>", "texel", Aspect::Stencil),
    };
    let words = words(aspect);
    let (texture, samples, place) = if several {
        (texture.to_owned(), "textureNumSamples(source)", "i32(s)")
    } else {
        (texture.replace("multisampled_", ""), "1u", "0")
    };
    format!(
        "@group(0) @binding(0) var source: {texture};
@group(0) @binding(1) var<storage, read_write> codes: array<u32>;

@compute @workgroup_size({TILE}, {TILE})
fn cs(@builtin(global_invocation_id) id: vec3u) {{
    let size = textureDimensions(source);
    if id.x >= size.x || id.y >= size.y {{
        return;
    }}
    let samples = {samples};
    for (var s = 0u; s < samples; s++) {{
        let texel = textureLoad(source, vec2i(id.xy), {place});
        let code = {code};
        let at = ((id.y * size.x + id.x) * samples + s) * {words}u;
        for (var c = 0u; c < {words}u; c++) {{
            codes[at + c] = code[c];
        }}
    }}
}}
"
    )
}

impl SampleReaders {
    /// Returns the reader of a sample type, for multisampled images or not, created on first use.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        seen: ReaderType,
        several: bool,
    ) -> Result<SampleReader, BackendError> {
        let layout = match self.layout {
            Some(layout) => layout,
            None => *self.layout.insert(layout(device)?),
        };
        if let Some(pipeline) = self.pipelines.get(&(seen, several)).copied() {
            return Ok(SampleReader { pipeline, layout });
        }
        let pipeline = pipeline(device, &source(seen, several), layout.pipeline)?;
        self.pipelines.insert((seen, several), pipeline);
        Ok(SampleReader { pipeline, layout })
    }

    /// Destroys everything. The device must still exist.
    pub(crate) fn destroy(&mut self, device: &Device) {
        // SAFETY: nothing uses these any longer.
        unsafe {
            for (_, pipeline) in self.pipelines.drain() {
                device.raw.destroy_pipeline(pipeline, None);
            }
            if let Some(layout) = self.layout.take() {
                device.raw.destroy_pipeline_layout(layout.pipeline, None);
                device.raw.destroy_descriptor_set_layout(layout.set, None);
            }
        }
    }
}

fn layout(device: &Device) -> Result<PipelineLayouts, BackendError> {
    let binding = |binding, kind| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(binding)
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
    };
    let bindings = [
        binding(0, vk::DescriptorType::SAMPLED_IMAGE),
        binding(1, vk::DescriptorType::STORAGE_BUFFER),
    ];
    create_layout(device, &bindings)
}

fn pipeline(
    device: &Device,
    source: &str,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline, BackendError> {
    let name = "read_samples";
    let translated = shader::translate(name, source)?;
    let module = shader::create_module(device, name, &translated.words)?;
    let stage = vk::PipelineShaderStageCreateInfo::default()
        .stage(vk::ShaderStageFlags::COMPUTE)
        .module(module)
        .name(c"cs");
    let info = vk::ComputePipelineCreateInfo::default()
        .stage(stage)
        .layout(layout);
    // SAFETY: module and layout live; the module is not needed after the pipeline is created.
    let made = unsafe {
        let made = device
            .raw
            .create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
        device.raw.destroy_shader_module(module, None);
        made.map_err(|(_, code)| code)
    };
    let made = made.check("a pipeline that reads samples")?;
    made.first()
        .copied()
        .ok_or_else(|| internal("no pipeline came back"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reader_shader_translates() {
        for seen in [
            ReaderType::Color,
            ReaderType::Integers,
            ReaderType::Depth,
            ReaderType::Stencil,
        ] {
            for several in [false, true] {
                let source = source(seen, several);
                shader::translate("read_samples", &source).expect("our own shader");
            }
        }
    }

    #[test]
    fn short_codes_can_be_read() {
        for encoding in [
            ChannelEncoding::Unorm(1),
            ChannelEncoding::Unorm(5),
            ChannelEncoding::Unorm(10),
            ChannelEncoding::Unorm(16),
            ChannelEncoding::Snorm(8),
            ChannelEncoding::Float16,
            ChannelEncoding::Ufloat(6),
            ChannelEncoding::Ufloat(5),
        ] {
            assert!(can_read(encoding));
        }
        assert!(!can_read(ChannelEncoding::Unorm(24)));
    }
}
