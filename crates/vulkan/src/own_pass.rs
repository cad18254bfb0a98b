//! Draws that read attachments of their own pass: what a device offers, and the way in which a pass does it.

use crate::error::internal;
use crate::image_state::ImageState;
use crate::input_attachment::{Input, Inputs};
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{Aspect, Feature, PathCommands, PathPass, PathReads, PathValue, Requirement};
use etalon_scene::{Draw, Pass, Scene};
use std::ffi::CStr;

/// The optional ways of a device.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OwnPassWays {
    /// Input attachments in dynamic rendering.
    pub(crate) local_read: bool,
    /// Sampled images in the layout of feedback loops.
    pub(crate) feedback_loop: bool,
    /// Accesses in rasterization order to colour, depth and stencil.
    pub(crate) ordered: [bool; 3],
}

impl OwnPassWays {
    /// Returns the ways of a device; `has` returns true for the extensions that it has.
    pub(crate) fn of(
        api: &ash::Instance,
        physical: vk::PhysicalDevice,
        has: impl Fn(&CStr) -> bool,
    ) -> Self {
        let mut local = vk::PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR::default();
        let mut feedback = vk::PhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT::default();
        let mut ordered =
            vk::PhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT::default();
        let mut chain = vk::PhysicalDeviceFeatures2::default();
        if has(ash::khr::dynamic_rendering_local_read::NAME) {
            chain = chain.push_next(&mut local);
        }
        if has(ash::ext::attachment_feedback_loop_layout::NAME) {
            chain = chain.push_next(&mut feedback);
        }
        if has(ash::ext::rasterization_order_attachment_access::NAME) {
            chain = chain.push_next(&mut ordered);
        }
        // SAFETY: the chained structures are of extensions that the device has.
        unsafe { api.get_physical_device_features2(physical, &mut chain) };
        Self {
            local_read: local.dynamic_rendering_local_read != vk::FALSE,
            feedback_loop: feedback.attachment_feedback_loop_layout != vk::FALSE,
            ordered: [
                ordered.rasterization_order_color_attachment_access,
                ordered.rasterization_order_depth_attachment_access,
                ordered.rasterization_order_stencil_attachment_access,
            ]
            .map(|has| has != vk::FALSE),
        }
    }

    /// Returns true if the accesses to colours can be in rasterization order.
    pub(crate) fn orders_colors(self) -> bool {
        self.ordered[0]
    }

    /// Returns the feature structures to enable.
    pub(crate) fn features(self) -> OwnPassFeatures {
        let [color, depth, stencil] = self.ordered;
        OwnPassFeatures {
            ways: self,
            local: vk::PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR::default()
                .dynamic_rendering_local_read(true),
            feedback: vk::PhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT::default()
                .attachment_feedback_loop_layout(true),
            ordered: vk::PhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT::default()
                .rasterization_order_color_attachment_access(color)
                .rasterization_order_depth_attachment_access(depth)
                .rasterization_order_stencil_attachment_access(stencil),
        }
    }
}

/// The feature structures of the ways.
pub(crate) struct OwnPassFeatures {
    ways: OwnPassWays,
    local: vk::PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR<'static>,
    feedback: vk::PhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT<'static>,
    ordered: vk::PhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT<'static>,
}

impl OwnPassFeatures {
    /// Returns the extensions, each with whether the device is created with it.
    pub(crate) fn extensions(&self) -> [(bool, &'static CStr); 3] {
        let OwnPassWays {
            local_read,
            feedback_loop,
            ordered,
        } = self.ways;
        [
            (local_read, ash::khr::dynamic_rendering_local_read::NAME),
            (
                feedback_loop,
                ash::ext::attachment_feedback_loop_layout::NAME,
            ),
            (
                ordered.contains(&true),
                ash::ext::rasterization_order_attachment_access::NAME,
            ),
        ]
    }

    /// Adds the structures of the device's ways to the creation of the device.
    pub(crate) fn enable<'a>(
        &'a mut self,
        mut info: vk::DeviceCreateInfo<'a>,
    ) -> vk::DeviceCreateInfo<'a> {
        if self.ways.local_read {
            info = info.push_next(&mut self.local);
        }
        if self.ways.feedback_loop {
            info = info.push_next(&mut self.feedback);
        }
        if self.ways.ordered.contains(&true) {
            info = info.push_next(&mut self.ordered);
        }
        info
    }
}

/// Returns the way in which draws of a pass read attachments of the pass; `None` if no draw does. Draws that
/// overlap themselves need accesses in order.
pub(crate) fn way(
    ways: OwnPassWays,
    scene: &Scene,
    pass: &Pass,
) -> Result<Option<PathReads>, BackendError> {
    if !pass.reads_itself() {
        return Ok(None);
    }
    let in_order = Requirement::Feature(Feature::OwnPassReadsInOrder);
    let overlaps = scene.requirements().contains(&in_order);
    let way = match scene.path.reads {
        PathReads::Barriers if overlaps => PathReads::Ordered,
        way => way,
    };
    let has = |draw: &Draw| {
        let mut own = draw.textures.iter().filter(|index| pass.attaches(**index));
        own.all(
            |index| match draw.aspect_read(scene.attachments[*index].format) {
                Aspect::Color => ways.ordered[0],
                Aspect::Depth => ways.ordered[1],
                Aspect::Stencil => ways.ordered[2],
            },
        )
    };
    let orders = way == PathReads::Ordered;
    if orders && !pass.draws.iter().all(has) || !orders && overlaps {
        let value = PathValue::Reads(scene.path.reads);
        return Err(BackendError::NotSupported(Requirement::Path(value)));
    }
    let secondary = [PathCommands::Secondary, PathCommands::SecondaryEach];
    if way == PathReads::Subpasses && secondary.contains(&scene.path.commands) {
        // The draws of a secondary command buffer are in one subpass.
        let value = PathValue::Commands(scene.path.commands);
        return Err(BackendError::NotSupported(Requirement::Path(value)));
    }
    if pass.moved_resolves(&scene.path).next().is_some() {
        let value = PathValue::Resolves(scene.path.resolves);
        return Err(BackendError::NotSupported(Requirement::Path(value)));
    }
    Ok(Some(way))
}

/// Returns true if some pass reads an attachment that it draws to or tests.
pub(crate) fn is_read(scene: &Scene, index: usize) -> bool {
    let reads = |pass: &Pass| pass.draws.iter().any(|draw| draw.textures.contains(&index));
    let mut passes = scene.passes.iter().filter(|pass| pass.attaches(index));
    passes.any(reads)
}

/// Returns true if draws read input attachments of subpasses.
pub(crate) fn has_inputs(way: Option<PathReads>) -> bool {
    way.is_some_and(|way| usage(way).contains(vk::ImageUsageFlags::INPUT_ATTACHMENT))
}

/// Returns the type of the descriptors of textures that are input attachments, or images.
pub(crate) fn descriptor(inputs: bool) -> vk::DescriptorType {
    if inputs {
        vk::DescriptorType::INPUT_ATTACHMENT
    } else {
        vk::DescriptorType::SAMPLED_IMAGE
    }
}

/// Returns the flags of subpasses.
pub(crate) fn subpass_flags(
    way: Option<PathReads>,
    ways: OwnPassWays,
) -> vk::SubpassDescriptionFlags {
    use vk::SubpassDescriptionFlags as Flags;
    let each = [
        Flags::RASTERIZATION_ORDER_ATTACHMENT_COLOR_ACCESS_EXT,
        Flags::RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_EXT,
        Flags::RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_EXT,
    ];
    let used = each.into_iter().zip(ways.ordered);
    let used = used.filter(|(_, has)| *has && way == Some(PathReads::Ordered));
    used.fold(Flags::empty(), |flags, (flag, _)| flags | flag)
}

/// Returns the flags of a pipeline's blending.
pub(crate) fn blend_flags(way: Option<PathReads>) -> vk::PipelineColorBlendStateCreateFlags {
    use vk::PipelineColorBlendStateCreateFlags as Flags;
    match way {
        Some(PathReads::Ordered) => Flags::RASTERIZATION_ORDER_ATTACHMENT_ACCESS_EXT,
        _ => Flags::empty(),
    }
}

/// Returns the flags of a pipeline's depth and stencil tests.
pub(crate) fn depth_stencil_flags(
    way: Option<PathReads>,
    ways: OwnPassWays,
) -> vk::PipelineDepthStencilStateCreateFlags {
    use vk::PipelineDepthStencilStateCreateFlags as Flags;
    let [_, depth, stencil] = ways.ordered;
    let each = [
        (
            depth,
            Flags::RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_EXT,
        ),
        (
            stencil,
            Flags::RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_EXT,
        ),
    ];
    let used = each
        .into_iter()
        .filter(|(has, _)| *has && way == Some(PathReads::Ordered));
    used.fold(Flags::empty(), |flags, (_, flag)| flags | flag)
}

/// Returns the flags of pipelines.
pub(crate) fn pipeline_flags(way: Option<PathReads>) -> vk::PipelineCreateFlags {
    use vk::PipelineCreateFlags as Flags;
    match way {
        Some(PathReads::FeedbackLoop) => {
            Flags::COLOR_ATTACHMENT_FEEDBACK_LOOP_EXT
                | Flags::DEPTH_STENCIL_ATTACHMENT_FEEDBACK_LOOP_EXT
        }
        _ => Flags::empty(),
    }
}

/// Returns true if the pass is an object: its path says so, or only subpasses can read themselves in this way.
pub(crate) fn has_object(way: Option<PathReads>, pass: PathPass) -> bool {
    match way {
        None => pass != PathPass::DynamicRendering,
        Some(way) => way != PathReads::LocalRead,
    }
}

/// Returns the usage of attachments that their passes read.
pub(crate) fn usage(way: PathReads) -> vk::ImageUsageFlags {
    match way {
        PathReads::FeedbackLoop => {
            vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::ATTACHMENT_FEEDBACK_LOOP_EXT
        }
        PathReads::Barriers | PathReads::Subpasses | PathReads::LocalRead | PathReads::Ordered => {
            vk::ImageUsageFlags::INPUT_ATTACHMENT
        }
    }
}

/// Returns the state of attachments in a pass that reads them.
pub(crate) fn state(way: PathReads) -> ImageState {
    let layout = match way {
        PathReads::Barriers | PathReads::Subpasses | PathReads::Ordered => vk::ImageLayout::GENERAL,
        PathReads::LocalRead => vk::ImageLayout::RENDERING_LOCAL_READ_KHR,
        PathReads::FeedbackLoop => vk::ImageLayout::ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT,
    };
    let read = match way {
        PathReads::FeedbackLoop => vk::AccessFlags2::SHADER_READ,
        _ => vk::AccessFlags2::INPUT_ATTACHMENT_READ,
    };
    ImageState {
        layout,
        stages: STAGES,
        access: WRITTEN | READ | read,
    }
}

/// The stages that access attachments.
const STAGES: vk::PipelineStageFlags2 = vk::PipelineStageFlags2::from_raw(
    vk::PipelineStageFlags2::FRAGMENT_SHADER.as_raw()
        | vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS.as_raw()
        | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS.as_raw()
        | vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT.as_raw(),
);

const WRITTEN: vk::AccessFlags2 = vk::AccessFlags2::from_raw(
    vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw()
        | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
);

const READ: vk::AccessFlags2 = vk::AccessFlags2::from_raw(
    vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
        | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ.as_raw(),
);

/// Returns the flags of dependencies between draws.
fn flags(way: PathReads) -> vk::DependencyFlags {
    match way {
        PathReads::FeedbackLoop => {
            vk::DependencyFlags::BY_REGION | vk::DependencyFlags::FEEDBACK_LOOP_EXT
        }
        _ => vk::DependencyFlags::BY_REGION,
    }
}

/// Returns the dependency between two subpasses, or of a subpass on itself.
pub(crate) fn dependency(way: PathReads, from: u32, to: u32) -> vk::SubpassDependency2<'static> {
    // The first 32 bits of both versions of these flags agree.
    let stages = vk::PipelineStageFlags::from_raw(STAGES.as_raw() as u32);
    let accesses = |flags: vk::AccessFlags2| vk::AccessFlags::from_raw(flags.as_raw() as u32);
    vk::SubpassDependency2::default()
        .src_subpass(from)
        .dst_subpass(to)
        .src_stage_mask(stages)
        .dst_stage_mask(stages)
        .src_access_mask(accesses(WRITTEN))
        .dst_access_mask(accesses(state(way).access))
        .dependency_flags(flags(way))
}

/// Records a barrier between two draws.
///
/// # Safety
/// `commands` is being recorded, inside a pass that reads itself in this way.
pub(crate) unsafe fn barrier(device: &ash::Device, commands: vk::CommandBuffer, way: PathReads) {
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(STAGES)
        .src_access_mask(WRITTEN)
        .dst_stage_mask(STAGES)
        .dst_access_mask(state(way).access)];
    let info = vk::DependencyInfo::default()
        .memory_barriers(&barriers)
        .dependency_flags(flags(way));
    // SAFETY: upheld by the caller.
    unsafe { device.cmd_pipeline_barrier2(commands, &info) };
}

/// Returns the input attachments of a draw: for each of its textures, the number of an attachment of the pass.
/// Colours have the numbers of their locations, and depth and stencil follow.
pub(crate) fn inputs(
    way: Option<PathReads>,
    pass: &Pass,
    draw: &Draw,
) -> Result<Inputs, BackendError> {
    let mut inputs = [None; 2];
    let way = way.filter(|way| *way != PathReads::FeedbackLoop && draw.reads_own(pass));
    let Some(way) = way else {
        return Ok(inputs);
    };
    for (input, index) in inputs.iter_mut().zip(&draw.textures) {
        let location = pass.color.iter().position(|color| color == index);
        *input = Some(match location {
            Some(location) => Input::Numbered(location as u32),
            None if pass.depth_stencil != Some(*index) => {
                return Err(internal("a draw reads its pass and other textures"));
            }
            // By default, depth and stencil are the input attachment without a number.
            None if way == PathReads::LocalRead => Input::Unnumbered,
            None => Input::Numbered(pass.color.len() as u32),
        });
    }
    Ok(inputs)
}
