//! Graphics pipelines and their layouts, cached by their static state.

use crate::device::Device;
use crate::dynamic::{Dynamic, Setting};
use crate::error::{Check, internal};
use crate::input_attachment::Inputs;
use crate::own_pass;
use crate::render_pass::{Compatible, RenderPass};
use crate::shader::Modules;
use crate::single_state::{SingleState, other_samples};
use crate::state;
use crate::targets::Targets;
use crate::tessellation;
use crate::viewport::Chosen;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::PathViewport;
use etalon_scene::{
    ColorTarget, Draw, EarlyTests, LogicOperation, Multisample, PolygonMode, PrimitiveTopology,
    ProvokingVertex, Shader, Tessellation,
};
use std::collections::HashMap;
use std::mem::{offset_of, size_of};
use std::rc::Rc;

/// The largest number of pipelines kept. A full cache drops the pipelines that no prepared scene uses:
/// Lavapipe keeps about a megabyte of machine code for each.
const KEPT_PIPELINES: usize = 256;

/// The static state of a pipeline; the rest is [`Setting::states`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct StaticState {
    targets: Targets,
    shader: Shader,
    early_tests: EarlyTests,
    /// The first topology of its class (Vulkan, Topology Class). Within a class, topology is dynamic.
    class: PrimitiveTopology,
    tessellation: Option<Tessellation>,
    /// True if the last vertex of a primitive is the provoking vertex, false if the first is.
    last_provokes: bool,
    /// True if the vertex colour advances once per instance.
    instanced: bool,
    polygon_mode: PolygonMode,
    depth_clamp: bool,
    multisample: MultisampleKey,
    logic: Option<LogicOperation>,
    color: Vec<ColorTarget>,
    pass: Option<Compatible>,
    subpass: u32,
    inputs: Inputs,
    layer: Option<u32>,
    setting: Setting,
    /// The rest of the state as text, unless it is dynamic.
    fixed: Option<String>,
}

/// The multisample state of a pipeline. Floats are compared bit by bit.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct MultisampleKey {
    mask: u32,
    alpha_to_coverage: bool,
    alpha_to_one: bool,
    min_sample_shading: Option<u32>,
}

impl MultisampleKey {
    /// Returns the state without sample coverage, which Vulkan lacks and the limits deny.
    fn of(state: &Multisample) -> Self {
        Self {
            mask: state.mask,
            alpha_to_coverage: state.alpha_to_coverage,
            alpha_to_one: state.alpha_to_one,
            min_sample_shading: state.min_sample_shading.map(f32::to_bits),
        }
    }
}

fn class(topology: PrimitiveTopology) -> PrimitiveTopology {
    match topology {
        PrimitiveTopology::PointList => PrimitiveTopology::PointList,
        PrimitiveTopology::LineList | PrimitiveTopology::LineStrip => PrimitiveTopology::LineList,
        PrimitiveTopology::TriangleList
        | PrimitiveTopology::TriangleStrip
        | PrimitiveTopology::TriangleFan => PrimitiveTopology::TriangleList,
    }
}

/// The binding of the storage buffer: the counter of shader runs, or the pool.
pub(crate) const STORAGE_BINDING: u32 = 3;
/// The binding of the sampler.
pub(crate) const SAMPLER_BINDING: u32 = 4;

/// The vertex binding of the colours of instances.
pub(crate) const INSTANCE_BINDING: u32 = 1;

/// The bindings of a shader in addition to its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ShaderBindings {
    pub(crate) textures: usize,
    /// True if the textures are input attachments.
    pub(crate) inputs: bool,
    pub(crate) sampler: bool,
    pub(crate) storage: bool,
}

impl ShaderBindings {
    pub(crate) fn of(shader: Shader, inputs: bool) -> Self {
        Self {
            textures: shader.textures(),
            inputs,
            sampler: shader.samples_texture(),
            storage: shader.uses_storage(),
        }
    }
}

/// The layouts that shaders with the same bindings share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PipelineLayouts {
    pub(crate) set: vk::DescriptorSetLayout,
    pub(crate) pipeline: vk::PipelineLayout,
}

/// A pipeline with its layout. Scenes hold it in an [`Rc`], so that the cache can tell which pipelines are in
/// use.
#[derive(Debug)]
pub(crate) struct Pipeline {
    pub(crate) raw: vk::Pipeline,
    pub(crate) layout: vk::PipelineLayout,
}

/// All pipelines with their modules and layouts.
#[derive(Debug, Default)]
pub(crate) struct Pipelines {
    modules: Modules,
    tessellation: tessellation::Stages,
    cache: vk::PipelineCache,
    layouts: HashMap<ShaderBindings, PipelineLayouts>,
    pipelines: HashMap<StaticState, Rc<Pipeline>>,
}

/// The parts of a pipeline that depend on the path.
#[derive(Clone, Copy)]
pub(crate) struct Way<'a> {
    /// The render pass object; `None` for dynamic rendering.
    pub(crate) pass: Option<&'a RenderPass>,
    /// The subpass of the render pass object.
    pub(crate) subpass: u32,
    /// The input attachments that the draw's textures are.
    pub(crate) inputs: Inputs,
    /// The layer that the vertex shader writes, if it writes one.
    pub(crate) layer: Option<u32>,
    pub(crate) setting: Setting,
    /// The state of the draw, which the pipeline holds if the setting says so.
    pub(crate) state: &'a Dynamic,
}

impl Pipelines {
    /// Creates the driver's pipeline cache.
    pub(crate) fn create(&mut self, device: &Device) -> Result<(), BackendError> {
        let info = vk::PipelineCacheCreateInfo::default();
        // SAFETY: the device is alive.
        self.cache =
            unsafe { device.raw.create_pipeline_cache(&info, None) }.check("a pipeline cache")?;
        Ok(())
    }

    /// Returns the layouts for shaders with these bindings.
    pub(crate) fn layout(
        &mut self,
        device: &Device,
        bindings: ShaderBindings,
    ) -> Result<PipelineLayouts, BackendError> {
        if let Some(layout) = self.layouts.get(&bindings) {
            return Ok(*layout);
        }
        let binding = |binding, kind, stages| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(kind)
                .descriptor_count(1)
                .stage_flags(stages)
        };
        let fragment = vk::ShaderStageFlags::FRAGMENT;
        let both = vk::ShaderStageFlags::VERTEX | fragment;
        let mut entries = vec![binding(0, vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC, both)];
        for (number, _) in (1..).zip(0..bindings.textures) {
            let stages = if bindings.inputs { fragment } else { both };
            entries.push(binding(
                number,
                own_pass::descriptor(bindings.inputs),
                stages,
            ));
        }
        if bindings.storage {
            let kind = vk::DescriptorType::STORAGE_BUFFER;
            entries.push(binding(STORAGE_BINDING, kind, fragment));
        }
        if bindings.sampler {
            let kind = vk::DescriptorType::SAMPLER;
            entries.push(binding(SAMPLER_BINDING, kind, both));
        }
        let layout = create_layout(device, &entries)?;
        self.layouts.insert(bindings, layout);
        Ok(layout)
    }

    /// Returns the pipeline of a draw, created on first use.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        targets: &Targets,
        draw: &Draw,
        way: Way<'_>,
    ) -> Result<Rc<Pipeline>, BackendError> {
        let key = StaticState {
            targets: targets.clone(),
            shader: draw.shader,
            early_tests: draw.early_tests,
            class: class(draw.topology),
            tessellation: draw.tessellation,
            last_provokes: draw.provoking == Some(ProvokingVertex::Last),
            instanced: draw.fetch.instances > 0,
            pass: way.pass.map(|p| p.compatible.clone()),
            subpass: way.subpass,
            inputs: way.inputs,
            layer: way.layer,
            setting: way.setting,
            fixed: way.setting.fixed.then(|| way.state.text()),
            polygon_mode: draw.polygon_mode,
            depth_clamp: draw.depth_clamp,
            multisample: MultisampleKey::of(&draw.multisample),
            logic: draw.logic,
            color: draw.targets.clone(),
        };
        if let Some(pipeline) = self.pipelines.get(&key) {
            return Ok(pipeline.clone());
        }
        if self.pipelines.len() >= KEPT_PIPELINES {
            self.drop_unused(device);
        }
        let module = self.modules.get(
            device,
            draw.shader,
            draw.early_tests,
            way.inputs,
            Chosen {
                second_viewport: way.setting.viewport == PathViewport::Array,
                layer: way.layer,
            },
        )?;
        let layout = self.layout(
            device,
            ShaderBindings::of(draw.shader, way.inputs != [None; 2]),
        )?;
        let stage = |stage, name| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(stage)
                .module(module.raw)
                .name(name)
        };
        let mut stages = vec![stage(vk::ShaderStageFlags::VERTEX, c"vs")];
        if draw.shader.has_fragment() {
            stages.push(stage(vk::ShaderStageFlags::FRAGMENT, c"fs"));
        }
        if let Some(tessellation) = draw.tessellation {
            stages.extend(self.tessellation.get(device, tessellation)?);
        }
        let attributes = attributes(&module.attributes, key.instanced)?;
        let inputs = (stages.as_slice(), attributes.as_slice());
        let raw = create(device, self.cache, &key, inputs, layout.pipeline, way)?;
        let pipeline = Rc::new(Pipeline {
            raw,
            layout: layout.pipeline,
        });
        self.pipelines.insert(key, pipeline.clone());
        Ok(pipeline)
    }

    fn drop_unused(&mut self, device: &Device) {
        self.pipelines.retain(|_, pipeline| {
            let used = Rc::strong_count(pipeline) > 1;
            if !used {
                // SAFETY: no prepared scene uses it, so nothing on the device does.
                unsafe { device.raw.destroy_pipeline(pipeline.raw, None) };
            }
            used
        });
    }

    /// Destroys everything. All prepared scenes must have been dropped.
    pub(crate) fn destroy(&mut self, device: &Device) {
        self.drop_unused(device);
        self.modules.destroy(device);
        self.tessellation.destroy(device);
        // SAFETY: nothing uses these any longer; a null cache is ignored.
        unsafe {
            for (_, layout) in self.layouts.drain() {
                device.raw.destroy_pipeline_layout(layout.pipeline, None);
                device.raw.destroy_descriptor_set_layout(layout.set, None);
            }
            device.raw.destroy_pipeline_cache(self.cache, None);
        }
    }
}

/// Creates a set layout, and a pipeline layout with that set.
pub(crate) fn create_layout(
    device: &Device,
    bindings: &[vk::DescriptorSetLayoutBinding<'_>],
) -> Result<PipelineLayouts, BackendError> {
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(bindings);
    // SAFETY: `info` is complete.
    let set = unsafe { device.raw.create_descriptor_set_layout(&info, None) }
        .check("a descriptor set layout")?;
    let sets = [set];
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
    // SAFETY: the set layout was just made.
    let pipeline = unsafe { device.raw.create_pipeline_layout(&info, None) };
    if pipeline.is_err() {
        // SAFETY: nothing uses the set layout.
        unsafe { device.raw.destroy_descriptor_set_layout(set, None) };
    }
    let pipeline = pipeline.check("a pipeline layout")?;
    Ok(PipelineLayouts { set, pipeline })
}

/// Creates a pipeline. It is one call, and its structures must outlive it.
fn create(
    device: &Device,
    cache: vk::PipelineCache,
    key: &StaticState,
    (stages, attributes): (
        &[vk::PipelineShaderStageCreateInfo<'_>],
        &[vk::VertexInputAttributeDescription],
    ),
    layout: vk::PipelineLayout,
    way: Way<'_>,
) -> Result<vk::Pipeline, BackendError> {
    let bindings = [
        vk::VertexInputBindingDescription {
            binding: 0,
            stride: size_of::<etalon_scene::Vertex>() as u32,
            input_rate: vk::VertexInputRate::VERTEX,
        },
        vk::VertexInputBindingDescription {
            binding: INSTANCE_BINDING,
            stride: size_of::<[f32; 4]>() as u32,
            input_rate: vk::VertexInputRate::INSTANCE,
        },
    ];
    let used = if key.instanced { 2 } else { 1 };
    let vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&bindings[..used])
        .vertex_attribute_descriptions(attributes);
    let fixed = way.setting.fixed.then_some(way.state);
    let assembly = match fixed {
        Some(state) => state.assembly(),
        None => {
            let topology = state::topology(key.class, key.tessellation);
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(topology)
        }
    };
    let (viewports, scissors, count) = way.state.viewports();
    let mut viewport = vk::PipelineViewportStateCreateInfo::default();
    if way.setting.viewport != PathViewport::WithCount {
        // The driver reads them only if they are not dynamic.
        viewport = viewport
            .viewports(&viewports[..count])
            .scissors(&scissors[..count]);
    }
    let raster = fixed.map(Dynamic::rasterization).unwrap_or_default();
    let mut provoking = vk::PipelineRasterizationProvokingVertexStateCreateInfoEXT::default()
        .provoking_vertex_mode(vk::ProvokingVertexModeEXT::LAST_VERTEX);
    let mut raster = raster
        .polygon_mode(state::polygon_mode(key.polygon_mode))
        .depth_clamp_enable(key.depth_clamp)
        .line_width(1.0);
    let single = way.setting.beyond.single;
    // This must differ from the value that is set dynamically.
    let mut clip = vk::PipelineRasterizationDepthClipStateCreateInfoEXT::default()
        .depth_clip_enable(key.depth_clamp);
    if single == Some(SingleState::DepthClip) {
        raster = raster.push_next(&mut clip);
    }
    let samples = if single == Some(SingleState::Samples) {
        other_samples(key.targets.samples)
    } else {
        key.targets.samples
    };
    if key.last_provokes {
        raster = raster.push_next(&mut provoking);
    }
    let mut origin = key.tessellation.and_then(tessellation::origin);
    let mut patches = vk::PipelineTessellationStateCreateInfo::default()
        .patch_control_points(tessellation::PATCH_VERTICES);
    if let Some(origin) = &mut origin {
        patches = patches.push_next(origin);
    }
    // One 32-bit word holds the mask of up to 32 samples.
    let mask = [key.multisample.mask];
    let min_sample_shading = key.multisample.min_sample_shading.map(f32::from_bits);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(state::samples(samples))
        .sample_mask(&mask)
        .sample_shading_enable(min_sample_shading.is_some())
        .min_sample_shading(min_sample_shading.unwrap_or(0.0))
        .alpha_to_coverage_enable(key.multisample.alpha_to_coverage)
        .alpha_to_one_enable(key.multisample.alpha_to_one);
    let depth_stencil = fixed.map(Dynamic::depth_stencil).unwrap_or_default();
    let targets: Vec<_> = key.color.iter().map(state::color_target).collect();
    let mut blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&targets);
    if let Some(logic) = key.logic {
        blend = blend.logic_op_enable(true).logic_op(state::logic(logic));
    }
    blend = blend.flags(own_pass::blend_flags(key.targets.reads));
    let depth_stencil = depth_stencil.flags(own_pass::depth_stencil_flags(
        key.targets.reads,
        device.own_pass,
    ));
    if let Some(state) = fixed {
        blend = blend.blend_constants(state.blend_constants());
    }
    let states = way.setting.states(!key.color.is_empty());
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .view_mask(key.targets.views())
        .color_attachment_formats(&key.targets.color)
        .depth_attachment_format(key.targets.depth)
        .stencil_attachment_format(key.targets.stencil);
    let mut info = vk::GraphicsPipelineCreateInfo::default()
        .stages(stages)
        .vertex_input_state(&vertex_input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth_stencil)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .flags(own_pass::pipeline_flags(key.targets.reads))
        .layout(layout);
    if key.tessellation.is_some() {
        info = info.tessellation_state(&patches);
    }
    info = match way.pass {
        Some(pass) => info.render_pass(pass.raw).subpass(key.subpass),
        None => info.push_next(&mut rendering),
    };
    // SAFETY: all parts of `info` live, and the device can draw to the formats and has every feature used.
    let made = unsafe {
        device
            .raw
            .create_graphics_pipelines(cache, &[info], None)
            .map_err(|(_, code)| code)
    };
    let made = made.check(&format!("a pipeline of shader {}", key.shader.name()))?;
    made.first()
        .copied()
        .ok_or_else(|| internal("no pipeline came back"))
}

/// Returns the attributes at the locations that a shader reads. Validation warns about unread attributes.
fn attributes(
    locations: &[u32],
    instanced: bool,
) -> Result<Vec<vk::VertexInputAttributeDescription>, BackendError> {
    type Vertex = etalon_scene::Vertex;
    let attribute = |location: &u32| {
        let (format, offset) = match location {
            1 if instanced => {
                return Ok(vk::VertexInputAttributeDescription {
                    location: 1,
                    binding: INSTANCE_BINDING,
                    format: vk::Format::R32G32B32A32_SFLOAT,
                    offset: 0,
                });
            }
            0 => (
                vk::Format::R32G32B32A32_SFLOAT,
                offset_of!(Vertex, position),
            ),
            1 => (vk::Format::R32G32B32A32_SFLOAT, offset_of!(Vertex, color)),
            2 => (vk::Format::R32G32_SFLOAT, offset_of!(Vertex, uv)),
            other => {
                return Err(BackendError::internal_of(
                    "no vertex attribute has this location",
                    other.to_string(),
                ));
            }
        };
        Ok(vk::VertexInputAttributeDescription {
            location: *location,
            binding: 0,
            format,
            offset: offset as u32,
        })
    };
    locations.iter().map(attribute).collect()
}
