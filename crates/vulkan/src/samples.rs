//! Reading every sample of a multisampled attachment: no copy can, so a compute shader does.
//!
//! The shader stores codes. It may, because the encodings it is used for survive the way through a
//! 32-bit float: 8- and 16-bit normalized values lie so far apart that rounding finds the code back
//! whatever the last bits of the conversion (Vulkan, Conversion From Normalized Fixed-Point), and
//! floats and integers arrive as they are. 24-bit depth does not, and is never multisampled here.

use crate::device::Device;
use crate::error::Check;
use crate::pipeline::{Layout, create_layout};
use crate::shader;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{Aspect, ChannelEncoding};
use std::collections::HashMap;

/// Texels per side that one workgroup reads.
pub(crate) const TILE: u32 = 8;

/// The readers made so far.
#[derive(Debug, Default)]
pub(crate) struct SampleReaders {
    layout: Option<Layout>,
    pipelines: HashMap<(Aspect, ChannelEncoding), vk::Pipeline>,
}

/// A reader: a pipeline with its layouts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SampleReader {
    pub(crate) pipeline: vk::Pipeline,
    pub(crate) layout: Layout,
}

/// Whether samples of this encoding can be read back code by code.
pub(crate) fn can_read(aspect: Aspect, encoding: ChannelEncoding) -> bool {
    source(aspect, encoding).is_some()
}

/// The compute shader for one aspect, or nothing where codes would not survive.
fn source(aspect: Aspect, encoding: ChannelEncoding) -> Option<String> {
    let texture = match aspect {
        Aspect::Color => "texture_multisampled_2d<f32>",
        Aspect::Depth => "texture_depth_multisampled_2d",
        Aspect::Stencil => "texture_multisampled_2d<u32>",
    };
    let (texel, channels) = match (aspect, encoding) {
        (Aspect::Color, ChannelEncoding::Unorm(8)) => ("vec4u(round(texel * 255.0))", 4),
        (Aspect::Color, ChannelEncoding::Float32) => ("bitcast<vec4u>(texel)", 4),
        (Aspect::Depth, ChannelEncoding::Unorm(16)) => ("vec4u(u32(round(texel * 65535.0)))", 1),
        (Aspect::Depth, ChannelEncoding::Float32) => ("vec4u(bitcast<u32>(texel))", 1),
        (Aspect::Stencil, ChannelEncoding::Uint(8)) => ("texel", 1),
        _ => return None,
    };
    Some(format!(
        "@group(0) @binding(0) var source: {texture};
@group(0) @binding(1) var<storage, read_write> codes: array<u32>;

@compute @workgroup_size({TILE}, {TILE})
fn cs(@builtin(global_invocation_id) id: vec3u) {{
    let size = textureDimensions(source);
    if id.x >= size.x || id.y >= size.y {{
        return;
    }}
    let samples = textureNumSamples(source);
    for (var s = 0u; s < samples; s++) {{
        let texel = textureLoad(source, vec2i(id.xy), i32(s));
        let code = {texel};
        let at = ((id.y * size.x + id.x) * samples + s) * {channels}u;
        for (var c = 0u; c < {channels}u; c++) {{
            codes[at + c] = code[c];
        }}
    }}
}}
"
    ))
}

impl SampleReaders {
    /// The reader of an aspect, made at its first use.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        aspect: Aspect,
        encoding: ChannelEncoding,
    ) -> Result<SampleReader, BackendError> {
        let layout = match self.layout {
            Some(layout) => layout,
            None => *self.layout.insert(layout(device)?),
        };
        let key = (aspect, encoding);
        if let Some(pipeline) = self.pipelines.get(&key).copied() {
            return Ok(SampleReader { pipeline, layout });
        }
        let source = source(aspect, encoding).ok_or_else(|| {
            BackendError::Internal(format!("samples of a {encoding} {aspect} are not readable"))
        })?;
        let pipeline = pipeline(device, &source, layout.pipeline)?;
        self.pipelines.insert(key, pipeline);
        Ok(SampleReader { pipeline, layout })
    }

    /// Destroys everything; called once, before the device goes.
    pub(crate) fn destroy(&mut self, device: &Device) {
        // SAFETY: nothing uses these any more.
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

fn layout(device: &Device) -> Result<Layout, BackendError> {
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
    // SAFETY: module and layout live; the module may go once the pipeline is made.
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
        .ok_or_else(|| BackendError::Internal("no pipeline came back".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reader_translates() {
        for aspect in [Aspect::Color, Aspect::Depth, Aspect::Stencil] {
            for encoding in [
                ChannelEncoding::Unorm(8),
                ChannelEncoding::Unorm(16),
                ChannelEncoding::Unorm(24),
                ChannelEncoding::Uint(8),
                ChannelEncoding::Float32,
            ] {
                if let Some(source) = source(aspect, encoding) {
                    shader::translate("read_samples", &source).expect("our own shader");
                }
            }
        }
    }
}
