//! Layouts of bind groups and pipelines, shared by shaders with the same bindings.

use crate::cache::Cache;
use etalon_backend::BackendError;
use etalon_scene::{Params, Shader};

/// The size of the parameter block.
pub(crate) const PARAMS_BYTES: u64 = size_of::<Params>() as u64;
/// The size of a counter of shader runs.
pub(crate) const RUNS_BYTES: u64 = 4;

/// A bind group layout and a pipeline layout with that one group.
#[derive(Clone)]
pub(crate) struct Layout {
    pub(crate) bindings: wgpu::BindGroupLayout,
    pub(crate) pipeline: wgpu::PipelineLayout,
}

/// The bindings of a shader, at the numbers that the suite's shaders use.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Bindings {
    /// The parameter block, at binding 0.
    pub(crate) params: bool,
    /// The number of textures, from binding 1.
    textures: usize,
    /// A storage buffer, at binding 3: the counter of shader runs, or the pool.
    storage: bool,
    /// A sampler, at binding 4.
    sampler: bool,
}

impl Bindings {
    pub(crate) fn of(shader: Shader) -> Self {
        Self {
            params: shader.uses_params(),
            textures: shader.textures(),
            storage: shader.uses_storage(),
            sampler: shader.samples_texture(),
        }
    }

    fn entries(self) -> Vec<wgpu::BindGroupLayoutEntry> {
        let mut entries = Vec::new();
        if self.params {
            let uniform = wgpu::BufferBindingType::Uniform;
            entries.push(entry(0, buffer(uniform, true, PARAMS_BYTES)));
        }
        let sample_type = wgpu::TextureSampleType::Float {
            filterable: self.sampler,
        };
        entries.extend((1..).take(self.textures).map(|binding| {
            let texture = texture(sample_type, false);
            entry(binding, texture)
        }));
        if self.storage {
            let storage = wgpu::BufferBindingType::Storage { read_only: false };
            entries.push(entry(3, buffer(storage, false, RUNS_BYTES)));
        }
        if self.sampler {
            let filtering = wgpu::SamplerBindingType::Filtering;
            entries.push(entry(4, wgpu::BindingType::Sampler(filtering)));
        }
        entries
    }
}

/// The layouts of draws and of fetches.
pub(crate) struct Layouts {
    draws: Cache<Bindings, Layout>,
    /// No binding.
    pub(crate) none: Layout,
    /// One texture.
    pub(crate) texture: Layout,
    /// One texture of integers.
    pub(crate) integer_texture: Layout,
    /// One multisampled texture of floats.
    pub(crate) samples: Layout,
    /// One multisampled texture of integers.
    pub(crate) integers: Layout,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let float = wgpu::TextureSampleType::Float { filterable: false };
        let integer = wgpu::TextureSampleType::Uint;
        Self {
            draws: Cache::default(),
            none: layout(device, &[]),
            texture: layout(device, &[entry(1, texture(float, false))]),
            integer_texture: layout(device, &[entry(1, texture(integer, false))]),
            samples: layout(device, &[entry(1, texture(float, true))]),
            integers: layout(device, &[entry(1, texture(integer, true))]),
        }
    }

    /// Returns the layout of a draw.
    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        bindings: Bindings,
    ) -> Result<Layout, BackendError> {
        self.draws
            .get(bindings, |key| Ok(layout(device, &key.entries())))
    }
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    }
}

fn buffer(ty: wgpu::BufferBindingType, dynamic: bool, bytes: u64) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: dynamic,
        min_binding_size: wgpu::BufferSize::new(bytes),
    }
}

fn texture(sample_type: wgpu::TextureSampleType, multisampled: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled,
    }
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
