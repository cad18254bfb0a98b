//! Shader modules, layouts, samplers and pipelines, cached by their descriptions.

use crate::cache::Cache;
use crate::error::Errors;
use crate::state;
use etalon_backend::BackendError;
use etalon_scene::Sampler;
use etalon_webgpu::{CallList, LayoutEntry, PipelineState, RenderPipeline, Shader, VertexBuffer};

/// The description of a pipeline.
type PipelineKey = (Shader, Vec<LayoutEntry>, PipelineState);

/// The objects that do not depend on a scene's textures and buffers.
#[derive(Default)]
pub(crate) struct SharedPipelines {
    layouts: Cache<Vec<LayoutEntry>, Layout>,
    samplers: Cache<Sampler, wgpu::Sampler>,
    shaders: Cache<Shader, wgpu::ShaderModule>,
    pipelines: Cache<PipelineKey, wgpu::RenderPipeline>,
}

/// A bind group layout, and a pipeline layout with that group.
#[derive(Clone)]
pub(crate) struct Layout {
    pub(crate) bindings: wgpu::BindGroupLayout,
    pipeline: wgpu::PipelineLayout,
}

impl SharedPipelines {
    pub(crate) fn clear(&self) {
        self.layouts.clear();
        self.samplers.clear();
        self.shaders.clear();
        self.pipelines.clear();
    }

    pub(crate) fn layout(
        &self,
        device: &wgpu::Device,
        entries: &[LayoutEntry],
    ) -> Result<Layout, BackendError> {
        self.layouts.get(entries.to_vec(), |entries| {
            let made: Vec<_> = entries.iter().map(state::layout_entry).collect();
            let bindings = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: None,
                entries: &made,
            });
            let groups = [Some(&bindings)];
            let pipeline = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: if made.is_empty() { &[] } else { &groups },
                immediate_size: 0,
            });
            Ok(Layout { bindings, pipeline })
        })
    }

    pub(crate) fn sampler(
        &self,
        device: &wgpu::Device,
        sampler: Sampler,
    ) -> Result<wgpu::Sampler, BackendError> {
        self.samplers.get(sampler, |sampler| {
            Ok(device.create_sampler(&state::sampler(*sampler)))
        })
    }

    /// Returns a pipeline of the list.
    pub(crate) fn pipeline(
        &self,
        device: &wgpu::Device,
        errors: &Errors,
        list: &CallList,
        pipeline: &RenderPipeline,
    ) -> Result<wgpu::RenderPipeline, BackendError> {
        let entries = pipeline.layout.map(|layout| list.layouts[layout].clone());
        let key = (
            list.shaders[pipeline.shader].clone(),
            entries.unwrap_or_default(),
            pipeline.state.clone(),
        );
        self.pipelines.get(key, |(shader, entries, state)| {
            let module = self.shaders.get(shader.clone(), |shader| {
                let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: Some(&shader.label),
                    source: wgpu::ShaderSource::Wgsl(shader.code.clone()),
                });
                errors.check_shader(&shader.label)?;
                Ok(module)
            })?;
            let layout = self.layout(device, entries)?;
            let made = create(device, &module, &layout.pipeline, state)?;
            errors.check_pipeline(&state.label)?;
            Ok(made)
        })
    }
}

fn create(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    state: &PipelineState,
) -> Result<wgpu::RenderPipeline, BackendError> {
    let attributes =
        |buffer: &VertexBuffer| buffer.attributes.iter().map(state::attribute).collect();
    let attributes: Vec<Vec<_>> = state.buffers.iter().map(attributes).collect();
    let buffer = |(buffer, attributes): (&VertexBuffer, _)| {
        Some(wgpu::VertexBufferLayout {
            array_stride: buffer.stride,
            step_mode: if buffer.per_instance {
                wgpu::VertexStepMode::Instance
            } else {
                wgpu::VertexStepMode::Vertex
            },
            attributes,
        })
    };
    let given = state
        .buffers
        .iter()
        .zip(attributes.iter().map(Vec::as_slice));
    let buffers: Vec<_> = given.map(buffer).collect();
    let target = |target: &Option<_>| target.as_ref().map(state::target).transpose();
    let targets: Result<Vec<_>, _> = state.targets.iter().map(target).collect();
    let (targets, depth_stencil) = (targets?, state.depth_stencil.as_ref());
    let options = wgpu::PipelineCompilationOptions::default;
    Ok(
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&state.label),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(&state.vertex),
                compilation_options: options(),
                buffers: &buffers,
            },
            primitive: state::primitive(state.primitive),
            depth_stencil: depth_stencil.map(state::depth_stencil).transpose()?,
            multisample: wgpu::MultisampleState {
                count: state.samples,
                mask: state.mask.into(),
                alpha_to_coverage_enabled: state.alpha_to_coverage,
            },
            fragment: state.fragment.as_ref().map(|entry| wgpu::FragmentState {
                module,
                entry_point: Some(entry),
                compilation_options: options(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        }),
    )
}
