//! Shader modules and pipelines, cached by their state.

use crate::cache::Cache;
use crate::error::Errors;
use crate::fetch::{self, FetchKey};
use crate::format;
use crate::layout::{Bindings, Layouts};
use crate::state::{self, Shape};
use etalon_backend::BackendError;
use etalon_frame::TextureFormat;
use etalon_scene::{
    ColorTarget, DepthBias, DepthState, Draw, EarlyTests, Sampler, Shader, StencilState, Vertex,
};
use std::borrow::Cow;

/// The size of a vertex.
pub(crate) const VERTEX_BYTES: u64 = size_of::<Vertex>() as u64;

/// The slot of the colours of instances.
pub(crate) const INSTANCE_SLOT: u32 = 1;

/// The location of the colour.
const COLOR: u32 = 1;

/// The colour of an instance.
const INSTANCE: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![1 => Float32x4];

/// Pipelines with their shaders, layouts and samplers.
pub(crate) struct Pipelines {
    pub(crate) layouts: Layouts,
    pub(crate) samplers: Cache<Sampler, wgpu::Sampler>,
    shaders: Cache<(Shader, EarlyTests), wgpu::ShaderModule>,
    draws: Cache<DrawKey, wgpu::RenderPipeline>,
    fetch: Cache<(), wgpu::ShaderModule>,
    fetches: Cache<FetchKey, wgpu::RenderPipeline>,
}

/// The state of a draw that is part of the pipeline.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct DrawKey {
    shader: Shader,
    /// The bindings of the draw, of which the shader may use fewer.
    bindings: Bindings,
    early_tests: EarlyTests,
    /// True if the vertex colour advances once an instance.
    instanced: bool,
    shape: Shape,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
    bias: Bias,
    targets: Vec<(TextureFormat, ColorTarget)>,
    depth_stencil: Option<TextureFormat>,
    samples: u32,
    sample_mask: u32,
    alpha_to_coverage: bool,
}

/// A depth bias with floats as bits, for hashing.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Bias {
    constant: i32,
    slope: u32,
    clamp: u32,
}

impl Bias {
    fn get(self) -> DepthBias {
        DepthBias {
            constant: self.constant,
            slope: f32::from_bits(self.slope),
            clamp: f32::from_bits(self.clamp),
        }
    }
}

impl DrawKey {
    pub(crate) fn of(
        draw: &Draw,
        colors: impl Iterator<Item = TextureFormat>,
        depth_stencil: Option<TextureFormat>,
        samples: u32,
    ) -> Self {
        let (mut shader, mut early_tests) = (draw.shader, draw.early_tests);
        // WebGPU refuses a shader that writes depth without a depth attachment (10.3.6). The depth
        // would be discarded, so another shader gives the same colours.
        if !depth_stencil.is_some_and(TextureFormat::has_depth) {
            shader = match shader {
                Shader::FlatColorDepth => Shader::UniformColor,
                Shader::CountedDepth => Shader::CountedColor,
                Shader::MaskedDepth => Shader::MaskedColor,
                Shader::FragCoordDepth => Shader::FlatColor,
                Shader::ExpensiveDepth => Shader::ExpensiveColor,
                Shader::LinearDepth | Shader::LogarithmicDepth => Shader::FlatColor,
                // Runs per sample, which a counter would reveal.
                Shader::SampleDepth if draw.counters.is_empty() => Shader::UniformColor,
                other => other,
            };
            if early_tests.is_conservative() {
                early_tests = EarlyTests::Implicit;
            }
        }
        Self {
            shader,
            bindings: Bindings::of(draw.shader),
            early_tests,
            instanced: draw.fetch.instances > 0,
            shape: Shape {
                topology: draw.topology,
                strip_indices: draw
                    .mesh
                    .indices
                    .as_ref()
                    .filter(|_| state::is_strip(draw.topology))
                    .map(|_| draw.fetch.index),
                cull: draw.cull,
                front_face: draw.front_face,
                polygon_mode: draw.polygon_mode,
                depth_clamp: draw.depth_clamp,
            },
            depth: draw.depth,
            stencil: draw.stencil.map(|mut s| {
                s.front.reference = 0;
                s.back.reference = 0;
                s
            }),
            bias: Bias {
                constant: draw.depth_bias.constant,
                slope: draw.depth_bias.slope.to_bits(),
                clamp: draw.depth_bias.clamp.to_bits(),
            },
            targets: colors.zip(draw.targets.iter().copied()).collect(),
            depth_stencil,
            samples,
            sample_mask: draw.multisample.mask,
            alpha_to_coverage: draw.multisample.alpha_to_coverage,
        }
    }
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self {
            layouts: Layouts::new(device),
            samplers: Cache::default(),
            shaders: Cache::default(),
            draws: Cache::default(),
            fetch: Cache::default(),
            fetches: Cache::default(),
        }
    }

    pub(crate) fn clear(&self) {
        self.samplers.clear();
        self.shaders.clear();
        self.draws.clear();
        self.fetch.clear();
        self.fetches.clear();
    }

    /// Returns the pipeline of a draw.
    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        errors: &Errors,
        key: DrawKey,
    ) -> Result<wgpu::RenderPipeline, BackendError> {
        self.draws.get(key, |key| {
            let shader = key.shader;
            let module = self
                .shaders
                .get((shader, key.early_tests), |(shader, tests)| {
                    compiled(device, errors, shader.name(), shader.wgsl_with(*tests))
                })?;
            let layout = self.layouts.draw(device, key.bindings)?;
            let attributes = attributes(shader);
            let apart: Vec<_> = if key.instanced {
                attributes
                    .iter()
                    .filter(|a| a.shader_location != COLOR)
                    .copied()
                    .collect()
            } else {
                attributes.to_vec()
            };
            let vertices = wgpu::VertexBufferLayout {
                array_stride: VERTEX_BYTES,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &apart,
            };
            let colors = wgpu::VertexBufferLayout {
                array_stride: size_of::<[f32; 4]>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &INSTANCE[..usize::from(apart.len() < attributes.len())],
            };
            let buffers = [Some(vertices), Some(colors)];
            let used = if key.instanced { 2 } else { 1 };
            let targets: Result<Vec<_>, _> =
                key.targets.iter().map(|(f, t)| target(*f, *t)).collect();
            let bias = state::bias(key.bias.get(), key.shape.topology);
            let depth_stencil = key
                .depth_stencil
                .map(|f| state::depth_stencil(f, key.depth, key.stencil, bias));
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(shader.name()),
                layout: Some(&layout.pipeline),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &buffers[..used],
                },
                primitive: state::primitive(key.shape),
                depth_stencil: depth_stencil.transpose()?,
                multisample: wgpu::MultisampleState {
                    count: key.samples,
                    mask: key.sample_mask.into(),
                    alpha_to_coverage_enabled: key.alpha_to_coverage,
                },
                fragment: shader.has_fragment().then_some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("fs"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &targets?,
                }),
                multiview_mask: None,
                cache: None,
            });
            errors.check_pipeline(shader.name())?;
            Ok(pipeline)
        })
    }

    /// Returns the pipeline of a fetch.
    pub(crate) fn fetch(
        &self,
        device: &wgpu::Device,
        errors: &Errors,
        key: FetchKey,
    ) -> Result<wgpu::RenderPipeline, BackendError> {
        self.fetches.get(key, |key| {
            let module = self.fetch.get((), |()| {
                compiled(device, errors, "fetch", fetch::WGSL.into())
            })?;
            fetch::pipeline(device, errors, &self.layouts, &module, *key)
        })
    }
}

/// Returns the vertex attributes that a shader reads. A validation layer warns of others.
fn attributes(shader: Shader) -> &'static [wgpu::VertexAttribute] {
    const ALL: [wgpu::VertexAttribute; 3] =
        wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x2];
    const TEXTURED: [wgpu::VertexAttribute; 2] = [ALL[0], ALL[2]];
    match shader {
        Shader::ClipFlat | Shader::ClipUniform | Shader::CullFlat | Shader::EdgeAlpha => &ALL,
        Shader::Centroid
        | Shader::Fxaa
        | Shader::SampledColor
        | Shader::SampledDiscard
        | Shader::SteppedLinear
        | Shader::SteppedLinearCentroid
        | Shader::SteppedLinearSample
        | Shader::SteppedPerspective
        | Shader::SteppedPerspectiveCentroid
        | Shader::SteppedPerspectiveSample => &TEXTURED,
        Shader::CountedDepth
        | Shader::DualPeel
        | Shader::ExpensiveColor
        | Shader::ExpensiveDepth
        | Shader::ExpensiveDiscard
        | Shader::FlatColor
        | Shader::FlatColorDepth
        | Shader::FlatEither
        | Shader::Fog
        | Shader::FragCoordDepth
        | Shader::LinearDepth
        | Shader::ListAppend
        | Shader::LogarithmicDepth
        | Shader::MomentAbsorbance
        | Shader::MomentTransmittance
        | Shader::Peel
        | Shader::Stochastic
        | Shader::WeightedAccumulate => &ALL[..2],
        Shader::CountedColor
        | Shader::CountedDiscard
        | Shader::DepthGrey
        | Shader::DepthLinearized
        | Shader::DepthRange
        | Shader::ExportedColor
        | Shader::ExportedDepth
        | Shader::ExportedDiscard
        | Shader::ExportedFacing
        | Shader::ExportedSample
        | Shader::FragCoordColor
        | Shader::FrontFacing
        | Shader::MaskedColor
        | Shader::MaskedDepth
        | Shader::MaskedDiscard
        | Shader::MaskedSample
        | Shader::ListCompose
        | Shader::MomentResolve
        | Shader::SampleDepth
        | Shader::SampleIndex
        | Shader::SteppedFragCoord
        | Shader::TexelColor
        | Shader::TexelColorAll
        | Shader::TexelDiscard
        | Shader::TexelDualSource
        | Shader::UintColor
        | Shader::UniformColor
        | Shader::VertexOnly
        | Shader::WeightedResolve => &ALL[..1],
    }
}

fn target(
    format: TextureFormat,
    target: ColorTarget,
) -> Result<Option<wgpu::ColorTargetState>, BackendError> {
    Ok(Some(wgpu::ColorTargetState {
        format: format::known(format)?,
        blend: target.blend.map(state::blend),
        // Bit 0 is red in both.
        write_mask: wgpu::ColorWrites::from_bits_truncate(target.write_mask.into()),
    }))
}

fn compiled(
    device: &wgpu::Device,
    errors: &Errors,
    name: &str,
    wgsl: Cow<'static, str>,
) -> Result<wgpu::ShaderModule, BackendError> {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(wgsl),
    });
    errors.check_shader(name)?;
    Ok(module)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The locations of a vertex entry point's arguments.
    fn locations(wgsl: &str) -> Vec<u32> {
        let (_, arguments) = wgsl.split_once("fn vs(").expect("a vertex entry point");
        let (arguments, _) = arguments.split_once("->").expect("its result");
        let parts = arguments.split("@location(").skip(1);
        let number = |part: &str| part.split(')').next()?.parse().ok();
        parts.filter_map(number).collect()
    }

    #[test]
    fn attributes_are_those_that_the_shader_reads() {
        for shader in Shader::ALL {
            let given = attributes(*shader).iter();
            let given: Vec<_> = given.map(|a| a.shader_location).collect();
            assert_eq!(given, locations(shader.wgsl()), "{}", shader.name());
            for attribute in attributes(*shader) {
                let offset = [0, 16, 32][attribute.shader_location as usize];
                assert_eq!(attribute.offset, offset, "{}", shader.name());
            }
        }
    }
}
