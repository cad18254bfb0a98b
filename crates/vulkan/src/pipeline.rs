//! Pipelines, kept by everything static about them.

use crate::device::Device;
use crate::error::Check;
use crate::shader::{Module, Modules};
use crate::state;
use ash::vk;
use etalon_backend::BackendError;
use etalon_case::scene::{ColorTarget, Draw, StencilFace};
use etalon_case::state::{
    BlendComponent, CompareFunction, CullMode, DepthState, FrontFace, PrimitiveTopology, Shader,
    StencilOperation,
};
use std::collections::HashMap;
use std::mem::{offset_of, size_of};
use std::rc::Rc;

/// The most pipelines kept; a full cache drops those that no prepared scene holds. Lavapipe keeps
/// about a megabyte of machine code for each.
const KEPT_PIPELINES: usize = 256;

/// What the attachments of a pass are to a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Targets {
    pub(crate) color: Vec<vk::Format>,
    /// `UNDEFINED` without a depth aspect.
    pub(crate) depth: vk::Format,
    /// `UNDEFINED` without a stencil aspect.
    pub(crate) stencil: vk::Format,
    pub(crate) samples: u32,
}

/// One face's stencil state without what is dynamic: the masks and the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct StencilKey {
    compare: CompareFunction,
    fail_op: StencilOperation,
    depth_fail_op: StencilOperation,
    pass_op: StencilOperation,
}

/// Everything static about a pipeline. Dynamic are viewport, scissor, blend constant, stencil masks
/// and references.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Key {
    targets: Targets,
    shader: Shader,
    topology: PrimitiveTopology,
    cull: CullMode,
    front_face: FrontFace,
    depth: Option<DepthState>,
    stencil: Option<[StencilKey; 2]>,
    color: Vec<ColorTarget>,
}

/// The layouts that shaders with so many textures share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(crate) set: vk::DescriptorSetLayout,
    pub(crate) pipeline: vk::PipelineLayout,
}

/// A pipeline with its layout; scenes hold it through an [`Rc`] so that the cache sees who is alive.
#[derive(Debug)]
pub(crate) struct Pipeline {
    pub(crate) raw: vk::Pipeline,
    pub(crate) layout: vk::PipelineLayout,
}

/// All pipelines and what they are made of.
#[derive(Debug, Default)]
pub(crate) struct Pipelines {
    modules: Modules,
    cache: vk::PipelineCache,
    layouts: HashMap<usize, Layout>,
    pipelines: HashMap<Key, Rc<Pipeline>>,
}

impl StencilKey {
    fn new(face: &StencilFace) -> Self {
        Self {
            compare: face.compare,
            fail_op: face.fail_op,
            depth_fail_op: face.depth_fail_op,
            pass_op: face.pass_op,
        }
    }

    fn native(self) -> vk::StencilOpState {
        vk::StencilOpState::default()
            .compare_op(state::compare(self.compare))
            .fail_op(state::stencil(self.fail_op))
            .depth_fail_op(state::stencil(self.depth_fail_op))
            .pass_op(state::stencil(self.pass_op))
    }
}

impl Pipelines {
    /// Makes the driver's own cache.
    pub(crate) fn create(&mut self, device: &Device) -> Result<(), BackendError> {
        let info = vk::PipelineCacheCreateInfo::default();
        // SAFETY: the device lives.
        self.cache =
            unsafe { device.raw.create_pipeline_cache(&info, None) }.check("a pipeline cache")?;
        Ok(())
    }

    /// The layouts for shaders with so many textures.
    pub(crate) fn layout(
        &mut self,
        device: &Device,
        textures: usize,
    ) -> Result<Layout, BackendError> {
        if let Some(layout) = self.layouts.get(&textures) {
            return Ok(*layout);
        }
        let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
        let mut bindings = vec![
            vk::DescriptorSetLayoutBinding::default()
                .binding(0)
                .descriptor_type(vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC)
                .descriptor_count(1)
                .stage_flags(stages),
        ];
        for (binding, _) in (1..).zip(0..textures) {
            bindings.push(
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(vk::DescriptorType::SAMPLED_IMAGE)
                    .descriptor_count(1)
                    .stage_flags(stages),
            );
        }
        let layout = create_layout(device, &bindings)?;
        self.layouts.insert(textures, layout);
        Ok(layout)
    }

    /// The pipeline of a draw, made at its first use.
    pub(crate) fn get(
        &mut self,
        device: &Device,
        targets: &Targets,
        draw: &Draw,
    ) -> Result<Rc<Pipeline>, BackendError> {
        let key = Key {
            targets: targets.clone(),
            shader: draw.shader,
            topology: draw.topology,
            cull: draw.cull,
            front_face: draw.front_face,
            depth: draw.depth,
            stencil: draw
                .stencil
                .map(|s| [StencilKey::new(&s.front), StencilKey::new(&s.back)]),
            color: draw.targets.clone(),
        };
        if let Some(pipeline) = self.pipelines.get(&key) {
            return Ok(pipeline.clone());
        }
        if key.color.windows(2).any(|w| w[0] != w[1]) && !device.independent_blend {
            return Err(BackendError::Resource {
                what: "a pipeline with different blending per attachment".to_owned(),
                message: "the device lacks independentBlend".to_owned(),
            });
        }
        if self.pipelines.len() >= KEPT_PIPELINES {
            self.drop_unused(device);
        }
        let module = self.modules.get(device, draw.shader)?;
        let layout = self.layout(device, draw.shader.textures())?;
        let raw = create(device, self.cache, &key, &module, layout.pipeline)?;
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
                // SAFETY: no prepared scene holds it, so nothing on the device uses it.
                unsafe { device.raw.destroy_pipeline(pipeline.raw, None) };
            }
            used
        });
    }

    /// Destroys everything; called once, when no prepared scene is left.
    pub(crate) fn destroy(&mut self, device: &Device) {
        self.drop_unused(device);
        self.modules.destroy(device);
        // SAFETY: nothing uses these any more; a null cache is ignored.
        unsafe {
            for (_, layout) in self.layouts.drain() {
                device.raw.destroy_pipeline_layout(layout.pipeline, None);
                device.raw.destroy_descriptor_set_layout(layout.set, None);
            }
            device.raw.destroy_pipeline_cache(self.cache, None);
        }
    }
}

/// A set layout and a pipeline layout with that one set.
pub(crate) fn create_layout(
    device: &Device,
    bindings: &[vk::DescriptorSetLayoutBinding<'_>],
) -> Result<Layout, BackendError> {
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(bindings);
    // SAFETY: `info` is complete.
    let set = unsafe { device.raw.create_descriptor_set_layout(&info, None) }
        .check("a descriptor set layout")?;
    let sets = [set];
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
    // SAFETY: the set layout was just made.
    let pipeline = unsafe { device.raw.create_pipeline_layout(&info, None) };
    if pipeline.is_err() {
        // SAFETY: nothing uses it.
        unsafe { device.raw.destroy_descriptor_set_layout(set, None) };
    }
    let pipeline = pipeline.check("a pipeline layout")?;
    Ok(Layout { set, pipeline })
}

fn create(
    device: &Device,
    cache: vk::PipelineCache,
    key: &Key,
    module: &Module,
    layout: vk::PipelineLayout,
) -> Result<vk::Pipeline, BackendError> {
    let stage = |stage, name| {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage)
            .module(module.raw)
            .name(name)
    };
    let stages = [
        stage(vk::ShaderStageFlags::VERTEX, c"vs"),
        stage(vk::ShaderStageFlags::FRAGMENT, c"fs"),
    ];
    let bindings = [vk::VertexInputBindingDescription {
        binding: 0,
        stride: size_of::<etalon_case::Vertex>() as u32,
        input_rate: vk::VertexInputRate::VERTEX,
    }];
    let attributes = attributes(&module.attributes)?;
    let vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&bindings)
        .vertex_attribute_descriptions(&attributes);
    let assembly =
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(state::topology(key.topology));
    let viewport = vk::PipelineViewportStateCreateInfo::default()
        .viewport_count(1)
        .scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(state::cull(key.cull))
        .front_face(state::front_face(key.front_face))
        .line_width(1.0);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(state::samples(key.targets.samples));

    let mut depth_stencil = vk::PipelineDepthStencilStateCreateInfo::default();
    if let Some(depth) = key.depth {
        depth_stencil = depth_stencil
            .depth_test_enable(true)
            .depth_write_enable(depth.write)
            .depth_compare_op(state::compare(depth.compare));
    }
    if let Some([front, back]) = key.stencil {
        depth_stencil = depth_stencil
            .stencil_test_enable(true)
            .front(front.native())
            .back(back.native());
    }
    let targets: Vec<_> = key.color.iter().map(color_target).collect();
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&targets);
    let dynamic = [
        vk::DynamicState::VIEWPORT,
        vk::DynamicState::SCISSOR,
        vk::DynamicState::BLEND_CONSTANTS,
        vk::DynamicState::STENCIL_COMPARE_MASK,
        vk::DynamicState::STENCIL_WRITE_MASK,
        vk::DynamicState::STENCIL_REFERENCE,
    ];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&key.targets.color)
        .depth_attachment_format(key.targets.depth)
        .stencil_attachment_format(key.targets.stencil);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages)
        .vertex_input_state(&vertex_input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth_stencil)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering);
    // SAFETY: all parts of `info` live, and the formats are those the device can draw to.
    let made = unsafe {
        device
            .raw
            .create_graphics_pipelines(cache, &[info], None)
            .map_err(|(_, code)| code)
    };
    let made = made.check(&format!("a pipeline of shader {}", key.shader.name()))?;
    made.first()
        .copied()
        .ok_or_else(|| BackendError::Internal("no pipeline came back".to_owned()))
}

/// The attributes that a shader reads: others would be declared in vain.
fn attributes(locations: &[u32]) -> Result<Vec<vk::VertexInputAttributeDescription>, BackendError> {
    type Vertex = etalon_case::Vertex;
    let attribute = |location: &u32| {
        let (format, offset) = match location {
            0 => (
                vk::Format::R32G32B32A32_SFLOAT,
                offset_of!(Vertex, position),
            ),
            1 => (vk::Format::R32G32B32A32_SFLOAT, offset_of!(Vertex, color)),
            2 => (vk::Format::R32G32_SFLOAT, offset_of!(Vertex, uv)),
            other => {
                let message = format!("no vertex attribute has location {other}");
                return Err(BackendError::Internal(message));
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

fn color_target(target: &ColorTarget) -> vk::PipelineColorBlendAttachmentState {
    let mut native = vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(state::write_mask(target.write_mask));
    if let Some(blend) = target.blend {
        let parts = |c: BlendComponent| {
            (
                state::blend_factor(c.src_factor),
                state::blend_factor(c.dst_factor),
                state::blend_operation(c.operation),
            )
        };
        let (src, dst, operation) = parts(blend.color);
        let (src_alpha, dst_alpha, alpha_operation) = parts(blend.alpha);
        native = native
            .blend_enable(true)
            .src_color_blend_factor(src)
            .dst_color_blend_factor(dst)
            .color_blend_op(operation)
            .src_alpha_blend_factor(src_alpha)
            .dst_alpha_blend_factor(dst_alpha)
            .alpha_blend_op(alpha_operation);
    }
    native
}
