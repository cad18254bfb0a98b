//! Render pass objects and their framebuffers, for passes without dynamic rendering.

use crate::attached::{ColorPlan, DepthStencilPlan};
use crate::clear::Ends;
use crate::device::Device;
use crate::error::Check;
use crate::image_state::{COLOR, DEPTH_STENCIL_RESOLVE};
use crate::own_pass;
use crate::state;
use crate::targets::Targets;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::PathReads;

/// The properties that compatible render passes share, in addition to formats (Vulkan, Render Pass
/// Compatibility).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Compatible {
    /// The number of subpasses.
    subpasses: u32,
    resolves: Vec<bool>,
    modes: Option<[u32; 2]>,
    read_only: bool,
}

/// A render pass with its framebuffer.
pub(crate) struct RenderPass {
    pub(crate) raw: vk::RenderPass,
    pub(crate) framebuffer: vk::Framebuffer,
    pub(crate) compatible: Compatible,
    /// The subpass of the first draw.
    pub(crate) first_subpass: u32,
    /// The clear values, one per attachment, in the render pass's order.
    pub(crate) values: Vec<vk::ClearValue>,
}

/// The attachments of a render pass in order, with the views of its framebuffer.
#[derive(Default)]
struct Attachments {
    descriptions: Vec<vk::AttachmentDescription2<'static>>,
    views: Vec<vk::ImageView>,
    values: Vec<vk::ClearValue>,
}

impl Attachments {
    /// Adds an attachment and returns a reference to it. Its layout is the same before, during and after the
    /// pass.
    fn add(
        &mut self,
        (view, format, samples): (vk::ImageView, vk::Format, u32),
        layout: vk::ImageLayout,
        aspects: vk::ImageAspectFlags,
        [first, second]: [&Ends; 2],
    ) -> vk::AttachmentReference2<'static> {
        let number = self.views.len() as u32;
        self.views.push(view);
        self.values.push(first.value);
        self.descriptions.push(
            vk::AttachmentDescription2::default()
                .format(format)
                .samples(state::samples(samples))
                .load_op(first.load)
                .store_op(first.store)
                .stencil_load_op(second.load)
                .stencil_store_op(second.store)
                .initial_layout(layout)
                .final_layout(layout),
        );
        vk::AttachmentReference2::default()
            .attachment(number)
            .layout(layout)
            .aspect_mask(aspects)
    }
}

impl RenderPass {
    /// Creates the render pass object of a planned pass. The subpasses before that of the first draw use the same
    /// attachments and draw nothing, so that load operations and draws are in different subpasses. All draws are in
    /// one subpass, or, if their reads need it, each is in one of its own.
    /// It is one call, and its structures must outlive it.
    pub(crate) fn new(
        device: &Device,
        size: [u32; 2],
        (colors, depth_stencil): (&[ColorPlan], Option<&DepthStencilPlan>),
        targets: &Targets,
        first_subpass: u32,
        draws: usize,
    ) -> Result<Self, BackendError> {
        let mut attachments = Attachments::default();
        let kept = Ends::kept();
        let (mut color, mut resolves) = (Vec::new(), Vec::new());
        let unused = || vk::AttachmentReference2::default().attachment(vk::ATTACHMENT_UNUSED);
        for (plan, format) in colors.iter().zip(&targets.color) {
            if plan.view == vk::ImageView::null() {
                color.push(unused());
                resolves.push(unused());
                continue;
            }
            let shape = (plan.view, *format, targets.samples);
            let aspect = vk::ImageAspectFlags::COLOR;
            color.push(attachments.add(shape, plan.layout, aspect, [&plan.ends, &kept]));
            resolves.push(match plan.resolve {
                None => unused(),
                Some((view, _)) => {
                    attachments.add((view, *format, 1), COLOR.layout, aspect, [&kept, &kept])
                }
            });
        }
        let tested = depth_stencil.map(|plan| {
            let ends = depth_stencil_ends(plan);
            let shape = (plan.view, targets.depth_stencil(), targets.samples);
            let reference =
                attachments.add(shape, plan.layout, targets.aspects(), [&ends[0], &ends[1]]);
            let last = attachments.values.last_mut();
            if let Some(value) = last {
                *value = vk::ClearValue {
                    depth_stencil: vk::ClearDepthStencilValue {
                        // SAFETY: the values were made as depth-stencil values, or are zero.
                        depth: unsafe { ends[0].value.depth_stencil.depth },
                        // SAFETY: as above.
                        stencil: unsafe { ends[1].value.depth_stencil.stencil },
                    },
                };
            }
            reference
        });
        let resolved = depth_stencil.and_then(|plan| plan.resolve);
        let target = resolved.map(|(view, _)| {
            let shape = (view, targets.depth_stencil(), 1);
            let layout = DEPTH_STENCIL_RESOLVE.layout;
            attachments.add(shape, layout, targets.aspects(), [&kept, &kept])
        });
        let mut depth_stencil_resolve = vk::SubpassDescriptionDepthStencilResolve::default();
        if let (Some((_, [depth, stencil])), Some(target)) = (resolved, &target) {
            depth_stencil_resolve = depth_stencil_resolve
                .depth_resolve_mode(depth)
                .stencil_resolve_mode(stencil)
                .depth_stencil_resolve_attachment(target);
        }
        // Attachments that draws read have a layout for it.
        let is_read = |reference: &&vk::AttachmentReference2<'_>| {
            let state = targets.reads.map(own_pass::state);
            state.is_some_and(|state| state.layout == reference.layout)
        };
        let inputs: Vec<_> = color
            .iter()
            .chain(&tested)
            .map(|input| Some(input).filter(is_read).copied().unwrap_or_else(unused))
            .collect();
        let described = |last: bool| {
            let mut subpass = vk::SubpassDescription2::default()
                .flags(own_pass::subpass_flags(targets.reads, device.own_pass))
                .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
                .view_mask(targets.views())
                .color_attachments(&color);
            if own_pass::has_inputs(targets.reads) {
                subpass = subpass.input_attachments(&inputs);
            }
            if let Some(tested) = &tested {
                subpass = subpass.depth_stencil_attachment(tested);
            }
            if last && colors.iter().any(|c| c.resolve.is_some()) {
                subpass = subpass.resolve_attachments(&resolves);
            }
            subpass
        };
        let mut last = described(true);
        if target.is_some() {
            last = last.push_next(&mut depth_stencil_resolve);
        }
        let drawing = match targets.reads {
            Some(PathReads::Subpasses) => u32::try_from(draws.max(1)).unwrap_or(u32::MAX),
            _ => 1,
        };
        let last_number = first_subpass + drawing - 1;
        let mut subpasses: Vec<_> = (0..last_number).map(|_| described(false)).collect();
        subpasses.push(last);
        let between = (1..=last_number).map(|to| match targets.reads {
            Some(way) => own_pass::dependency(way, to - 1, to),
            None => between_subpasses(),
        });
        let within = (0..=last_number)
            .filter_map(|number| Some(own_pass::dependency(targets.reads?, number, number)));
        let dependencies: Vec<_> = between.chain(within).collect();
        let info = vk::RenderPassCreateInfo2::default()
            .attachments(&attachments.descriptions)
            .subpasses(&subpasses)
            .dependencies(&dependencies);
        // SAFETY: all parts of `info` live.
        let raw = unsafe { device.raw.create_render_pass2(&info, None) }.check("a render pass")?;
        let mut made = Self {
            raw,
            framebuffer: vk::Framebuffer::null(),
            compatible: Compatible {
                subpasses: last_number + 1,
                resolves: colors.iter().map(|c| c.resolve.is_some()).collect(),
                modes: resolved.map(|(_, modes)| modes.map(vk::ResolveModeFlags::as_raw)),
                read_only: depth_stencil.is_some_and(|d| d.read_only),
            },
            first_subpass,
            values: attachments.values,
        };
        let [width, height] = size;
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(raw)
            .attachments(&attachments.views)
            .width(width)
            .height(height)
            .layers(targets.layer_count());
        // SAFETY: the views have the render pass's formats, and are at least this large.
        let framebuffer =
            unsafe { device.raw.create_framebuffer(&info, None) }.check("a framebuffer");
        match framebuffer {
            Ok(framebuffer) => made.framebuffer = framebuffer,
            Err(error) => {
                made.destroy(device);
                return Err(error);
            }
        }
        Ok(made)
    }

    pub(crate) fn destroy(&self, device: &Device) {
        // SAFETY: the device is done with the pass; null handles are ignored.
        unsafe {
            device.raw.destroy_framebuffer(self.framebuffer, None);
            device.raw.destroy_render_pass(self.raw, None);
        }
    }
}

/// Returns the operations of depth and stencil. A read-only pass writes nothing, not even by a store
/// operation.
fn depth_stencil_ends(plan: &DepthStencilPlan) -> [Ends; 2] {
    [&plan.depth, &plan.stencil].map(|ends| {
        let mut ends = ends.clone().unwrap_or_else(Ends::kept);
        if plan.read_only {
            ends.store = vk::AttachmentStoreOp::NONE;
        }
        ends
    })
}

/// Returns the dependency that makes the writes of the first subpass, including its load operations, visible
/// to the second.
fn between_subpasses() -> vk::SubpassDependency2<'static> {
    let stages = vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT
        | vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS
        | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS;
    let written =
        vk::AccessFlags::COLOR_ATTACHMENT_WRITE | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE;
    let read =
        vk::AccessFlags::COLOR_ATTACHMENT_READ | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ;
    vk::SubpassDependency2::default()
        .src_subpass(0)
        .dst_subpass(1)
        .src_stage_mask(stages)
        .dst_stage_mask(stages)
        .src_access_mask(written)
        .dst_access_mask(read | written)
        .dependency_flags(vk::DependencyFlags::BY_REGION)
}
