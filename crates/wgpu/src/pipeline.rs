//! Shaders and pipelines, kept by their state.

use crate::error::Errors;
use crate::format;
use etalon_backend::BackendError;
use etalon_case::scene::{ColorTarget, Draw, StencilState};
use etalon_case::state::{CullMode, DepthState, FrontFace, PrimitiveTopology, Shader};
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
const FETCH: &str = include_str!("fetch.wgsl");

/// A bind group layout and the pipeline layout made of it.
pub(crate) struct Layout {
    pub(crate) bindings: wgpu::BindGroupLayout,
    pipeline: wgpu::PipelineLayout,
}

/// What a shader can be given, by kind.
pub(crate) struct Layouts {
    /// Nothing.
    none: Layout,
    /// The parameter block.
    pub(crate) params: Layout,
    /// One texture.
    pub(crate) texture: Layout,
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
    topology: PrimitiveTopology,
    cull: CullMode,
    front_face: FrontFace,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
    targets: Vec<(TextureFormat, ColorTarget)>,
    depth_stencil: Option<TextureFormat>,
}

/// A pipeline that brings depth or stencil into a colour texture.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum FetchKey {
    /// Depth, as a float's bits, into `r32uint`.
    Depth,
    /// One bit of the stencil value, as 0 or 1, into one channel of `rgba8unorm`: bits 0 to 3 and
    /// 4 to 7 into red to alpha.
    StencilBit {
        /// The attachment's format.
        format: TextureFormat,
        /// The bit.
        bit: u8,
    },
}

impl DrawKey {
    pub(crate) fn of(
        draw: &Draw,
        colors: impl Iterator<Item = TextureFormat>,
        depth_stencil: Option<TextureFormat>,
    ) -> Self {
        let mut targets: Vec<_> = colors.zip(draw.targets.iter().copied()).collect();
        // All shaders write location 0 alone. What the others would take is undefined in OpenGL and
        // Vulkan; WebGPU wants it said that they take nothing (10.3.6, fragment state).
        for (_, target) in targets.iter_mut().skip(1) {
            target.write_mask = 0;
        }
        let mut shader = draw.shader;
        // WebGPU refuses a shader that writes depth where there is none (10.3.6). There the depth
        // is lost, and the two shaders' colours are the same.
        if shader == Shader::FlatColorDepth && !depth_stencil.is_some_and(TextureFormat::has_depth)
        {
            shader = Shader::UniformColor;
        }
        Self {
            shader,
            topology: draw.topology,
            cull: draw.cull,
            front_face: draw.front_face,
            depth: draw.depth,
            stencil: draw.stencil.map(|mut s| {
                s.front.reference = 0;
                s.back.reference = 0;
                s
            }),
            targets,
            depth_stencil,
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
        let texture = wgpu::BindGroupLayoutEntry {
            binding: 1,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        Self {
            layouts: Layouts {
                none: layout(device, &[]),
                params: layout(device, &[params]),
                texture: layout(device, &[texture]),
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
            let layout = match (shader.uses_params(), shader.textures()) {
                (true, _) => &self.layouts.params,
                (false, 0) => &self.layouts.none,
                (false, _) => &self.layouts.texture,
            };
            let vertices = wgpu::VertexBufferLayout {
                array_stride: VERTEX_BYTES,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: attributes(shader),
            };
            let targets: Vec<_> = key.targets.iter().map(|(f, t)| target(*f, *t)).collect();
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(shader.name()),
                layout: Some(&layout.pipeline),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[Some(vertices)],
                },
                primitive: format::primitive(key.topology, key.front_face, key.cull),
                depth_stencil: key
                    .depth_stencil
                    .map(|f| format::depth_stencil(f, key.depth, key.stencil)),
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("fs"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &targets,
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
                .get((), |()| compiled(device, errors, "fetch", FETCH))?;
            let (layout, entry, color, write_mask, depth_stencil) = match *key {
                FetchKey::Depth => (
                    &self.layouts.texture,
                    "depth",
                    wgpu::TextureFormat::R32Uint,
                    wgpu::ColorWrites::ALL,
                    None,
                ),
                FetchKey::StencilBit { format, bit } => (
                    &self.layouts.none,
                    "one",
                    wgpu::TextureFormat::Rgba8Unorm,
                    wgpu::ColorWrites::from_bits_truncate(1 << (bit % 4)),
                    Some(stencil_bit(format, bit)),
                ),
            };
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(entry),
                layout: Some(&layout.pipeline),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("everywhere"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: color,
                        blend: None,
                        write_mask,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            });
            errors.check_pipeline("fetch")?;
            Ok(pipeline)
        })
    }
}

/// The vertex attributes that a shader takes: position, colour, and texture coordinates where one
/// comes to want them. A validation layer warns of those that it does not.
fn attributes(shader: Shader) -> &'static [wgpu::VertexAttribute] {
    const ALL: [wgpu::VertexAttribute; 2] =
        wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
    match shader {
        Shader::FlatColor | Shader::FlatColorDepth => &ALL,
        Shader::FrontFacing | Shader::TexelColor | Shader::UniformColor => &ALL[..1],
    }
}

/// Passes where a bit is set and changes nothing.
fn stencil_bit(format: TextureFormat, bit: u8) -> wgpu::DepthStencilState {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Equal,
        ..wgpu::StencilFaceState::default()
    };
    wgpu::DepthStencilState {
        stencil: wgpu::StencilState {
            front: face,
            back: face,
            read_mask: 1 << bit,
            write_mask: 0,
        },
        ..format::depth_stencil(format, None, None)
    }
}

fn target(format: TextureFormat, target: ColorTarget) -> Option<wgpu::ColorTargetState> {
    Some(wgpu::ColorTargetState {
        format: format::texture(format),
        blend: target.blend.map(format::blend),
        // Both count from bit 0, red, to bit 3, alpha.
        write_mask: wgpu::ColorWrites::from_bits_truncate(target.write_mask.into()),
    })
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
