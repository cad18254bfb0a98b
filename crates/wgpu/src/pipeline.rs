//! Shaders and pipelines, kept by their state.

use crate::error::Errors;
use crate::fetch::{self, FetchKey};
use crate::format::{self, Shape};
use etalon_backend::BackendError;
use etalon_case::scene::{ColorTarget, Draw, StencilState};
use etalon_case::state::{DepthBias, DepthState, Multisample, Shader};
use etalon_frame::TextureFormat;
use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::Hash;

/// The most pipelines kept; past it all go, which costs little when it happens that seldom.
const MOST_PIPELINES: usize = 1024;
/// The size of [`etalon_case::Vertex`].
pub(crate) const VERTEX_BYTES: u64 = 40;
/// The size of [`etalon_case::scene::Params`].
pub(crate) const PARAMS_BYTES: u64 = 32;

/// A bind group layout and the pipeline layout made of it.
pub(crate) struct Layout {
    pub(crate) bindings: wgpu::BindGroupLayout,
    pub(crate) pipeline: wgpu::PipelineLayout,
}

/// What a shader can be given, by kind.
pub(crate) struct Layouts {
    /// Nothing.
    pub(crate) none: Layout,
    /// The parameter block.
    pub(crate) params: Layout,
    /// One texture.
    pub(crate) texture: Layout,
    /// Two textures.
    pub(crate) textures: Layout,
    /// One texture of several samples of floats.
    pub(crate) samples: Layout,
    /// One texture of several samples of integers.
    pub(crate) integers: Layout,
}

impl Layouts {
    /// The layout for a shader that fetches from so many textures.
    pub(crate) fn textures(&self, count: usize) -> &Layout {
        match count {
            0 => &self.none,
            1 => &self.texture,
            _ => &self.textures,
        }
    }
}

/// Pipelines and what they are made of.
pub(crate) struct Pipelines {
    pub(crate) layouts: Layouts,
    shaders: Kept<Shader, wgpu::ShaderModule>,
    draws: Kept<DrawKey, wgpu::RenderPipeline>,
    fetch: Kept<(), wgpu::ShaderModule>,
    fetches: Kept<FetchKey, wgpu::RenderPipeline>,
}

/// All state of a draw that is not set while drawing.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct DrawKey {
    shader: Shader,
    shape: Shape,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
    bias: Bias,
    targets: Vec<(TextureFormat, ColorTarget)>,
    depth_stencil: Option<TextureFormat>,
    samples: u32,
    multisample: Multisample,
}

/// A depth bias by the bits of its floats.
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
        let mut shader = draw.shader;
        // WebGPU refuses a shader that writes depth where there is none (10.3.6). There the depth
        // is lost, and another shader gives the same colours.
        if !depth_stencil.is_some_and(TextureFormat::has_depth) {
            shader = match shader {
                Shader::FlatColorDepth => Shader::UniformColor,
                Shader::FragCoordDepth => Shader::FlatColor,
                other => other,
            };
        }
        Self {
            shader,
            shape: Shape {
                topology: draw.topology,
                indexed: draw.mesh.indices.is_some(),
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
            multisample: draw.multisample,
        }
    }
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let params = wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: wgpu::BufferSize::new(PARAMS_BYTES),
            },
            count: None,
        };
        let texture = |binding, sample_type, multisampled| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled,
            },
            count: None,
        };
        let float = wgpu::TextureSampleType::Float { filterable: false };
        let integer = wgpu::TextureSampleType::Uint;
        Self {
            layouts: Layouts {
                none: layout(device, &[]),
                params: layout(device, &[params]),
                texture: layout(device, &[texture(1, float, false)]),
                textures: layout(
                    device,
                    &[texture(1, float, false), texture(2, float, false)],
                ),
                samples: layout(device, &[texture(1, float, true)]),
                integers: layout(device, &[texture(1, integer, true)]),
            },
            shaders: Kept::default(),
            draws: Kept::default(),
            fetch: Kept::default(),
            fetches: Kept::default(),
        }
    }

    pub(crate) fn clear(&self) {
        self.shaders.0.borrow_mut().clear();
        self.draws.0.borrow_mut().clear();
        self.fetch.0.borrow_mut().clear();
        self.fetches.0.borrow_mut().clear();
    }

    /// The pipeline of a draw.
    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        errors: &Errors,
        key: DrawKey,
    ) -> Result<wgpu::RenderPipeline, BackendError> {
        self.draws.get(key, |key| {
            let shader = key.shader;
            let module = self.shaders.get(shader, |shader| {
                compiled(device, errors, shader.name(), shader.wgsl())
            })?;
            let layout = if shader.uses_params() {
                &self.layouts.params
            } else {
                self.layouts.textures(shader.textures())
            };
            let vertices = wgpu::VertexBufferLayout {
                array_stride: VERTEX_BYTES,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: attributes(shader),
            };
            let targets: Result<Vec<_>, _> =
                key.targets.iter().map(|(f, t)| target(*f, *t)).collect();
            let bias = format::bias(key.bias.get(), key.shape.topology);
            let depth_stencil = key
                .depth_stencil
                .map(|f| format::depth_stencil(f, key.depth, key.stencil, bias));
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(shader.name()),
                layout: Some(&layout.pipeline),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[Some(vertices)],
                },
                primitive: format::primitive(key.shape),
                depth_stencil: depth_stencil.transpose()?,
                multisample: wgpu::MultisampleState {
                    count: key.samples,
                    mask: key.multisample.mask.into(),
                    alpha_to_coverage_enabled: key.multisample.alpha_to_coverage,
                },
                fragment: Some(wgpu::FragmentState {
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

    /// A pipeline that reads depth or stencil.
    pub(crate) fn fetch(
        &self,
        device: &wgpu::Device,
        errors: &Errors,
        key: FetchKey,
    ) -> Result<wgpu::RenderPipeline, BackendError> {
        self.fetches.get(key, |key| {
            let module = self
                .fetch
                .get((), |()| compiled(device, errors, "fetch", fetch::WGSL))?;
            fetch::pipeline(device, errors, &self.layouts, &module, *key)
        })
    }
}

/// The vertex attributes that a shader takes: position, colour, and texture coordinates where one
/// comes to want them. A validation layer warns of those that it does not.
fn attributes(shader: Shader) -> &'static [wgpu::VertexAttribute] {
    const ALL: [wgpu::VertexAttribute; 2] =
        wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
    match shader {
        Shader::FlatColor | Shader::FlatColorDepth | Shader::FragCoordDepth => &ALL,
        Shader::FrontFacing
        | Shader::SampleIndex
        | Shader::TexelColor
        | Shader::TexelColorAll
        | Shader::TexelDualSource
        | Shader::UniformColor => &ALL[..1],
    }
}

fn target(
    format: TextureFormat,
    target: ColorTarget,
) -> Result<Option<wgpu::ColorTargetState>, BackendError> {
    Ok(Some(wgpu::ColorTargetState {
        format: format::known(format)?,
        blend: target.blend.map(format::blend),
        // Both count from bit 0, red, to bit 3, alpha.
        write_mask: wgpu::ColorWrites::from_bits_truncate(target.write_mask.into()),
    }))
}

fn layout(device: &wgpu::Device, entries: &[wgpu::BindGroupLayoutEntry]) -> Layout {
    let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries,
    });
    let groups = [Some(&bindings)];
    let pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: if entries.is_empty() { &[] } else { &groups },
        immediate_size: 0,
    });
    Layout { bindings, pipeline }
}

fn compiled(
    device: &wgpu::Device,
    errors: &Errors,
    name: &str,
    wgsl: &'static str,
) -> Result<wgpu::ShaderModule, BackendError> {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    errors.check_shader(name)?;
    Ok(module)
}

/// Objects by what they are made from.
struct Kept<K, T>(RefCell<HashMap<K, T>>);

impl<K, T> Default for Kept<K, T> {
    fn default() -> Self {
        Self(RefCell::default())
    }
}

impl<K: Eq + Hash, T: Clone> Kept<K, T> {
    fn get(
        &self,
        key: K,
        make: impl FnOnce(&K) -> Result<T, BackendError>,
    ) -> Result<T, BackendError> {
        if let Some(found) = self.0.borrow().get(&key) {
            return Ok(found.clone());
        }
        let made = make(&key)?;
        let mut kept = self.0.borrow_mut();
        if kept.len() >= MOST_PIPELINES {
            kept.clear();
        }
        kept.insert(key, made.clone());
        Ok(made)
    }
}
