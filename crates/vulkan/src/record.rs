//! Recording of commands: initial contents, passes, and copies for reading back.

use crate::clear::Ends;
use crate::device::Device;
use crate::image::range;
use crate::pipeline::Pipeline;
use crate::plan::{
    AttachmentPlan, DepthStencilPlan, DrawPlan, InitialContents, PassPlan, Plan, Role,
};
use crate::samples::TILE;
use ash::vk;

/// The layout of an image with the stages and accesses that use it.
#[derive(Clone, Copy)]
struct ImageState {
    layout: vk::ImageLayout,
    stages: vk::PipelineStageFlags2,
    access: vk::AccessFlags2,
}

const TRANSFER_DST: ImageState = ImageState {
    layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
    stages: vk::PipelineStageFlags2::ALL_TRANSFER,
    access: vk::AccessFlags2::TRANSFER_WRITE,
};

const TRANSFER_SRC: ImageState = ImageState {
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
    stages: vk::PipelineStageFlags2::ALL_TRANSFER,
    access: vk::AccessFlags2::TRANSFER_READ,
};

const COMPUTE: ImageState = ImageState {
    layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    stages: vk::PipelineStageFlags2::COMPUTE_SHADER,
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
};

/// Depth and stencil attachments of a read-only pass.
const DEPTH_STENCIL_READ_ONLY: ImageState = ImageState {
    layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    stages: DEPTH_STENCIL.stages,
    access: vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ,
};

const DEPTH_STENCIL: ImageState = ImageState {
    layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
    stages: vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS.as_raw(),
    ),
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
};

/// Targets of resolves of depth and stencil, which the colour stage writes (Vulkan, Render Pass Multisample
/// Resolve Operations).
const DEPTH_STENCIL_RESOLVE: ImageState = ImageState {
    layout: DEPTH_STENCIL.layout,
    stages: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
};

/// Any earlier use; the contents are discarded.
const UNDEFINED: ImageState = ImageState {
    layout: vk::ImageLayout::UNDEFINED,
    stages: vk::PipelineStageFlags2::ALL_COMMANDS,
    access: vk::AccessFlags2::MEMORY_WRITE,
};

const COLOR: ImageState = ImageState {
    layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
    stages: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::COLOR_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::COLOR_ATTACHMENT_WRITE.as_raw(),
    ),
};

const FETCHED: ImageState = ImageState {
    layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    stages: vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::VERTEX_SHADER.as_raw()
            | vk::PipelineStageFlags2::FRAGMENT_SHADER.as_raw(),
    ),
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
};

impl Role {
    /// Returns the state of an attachment in this role.
    fn state(self) -> ImageState {
        match self {
            Self::Color => COLOR,
            Self::DepthStencil => DEPTH_STENCIL,
            Self::DepthStencilReadOnly => DEPTH_STENCIL_READ_ONLY,
            Self::DepthStencilResolve => DEPTH_STENCIL_RESOLVE,
            Self::Fetched => FETCHED,
            Self::Idle => TRANSFER_DST,
        }
    }
}

impl AttachmentPlan {
    /// Returns the state before the first pass and after the last.
    fn initial_state(&self) -> ImageState {
        self.role.state()
    }

    /// Returns the state for reading back.
    fn read_state(&self) -> ImageState {
        if self.samples > 1 {
            COMPUTE
        } else {
            TRANSFER_SRC
        }
    }

    fn barrier(&self, from: ImageState, to: ImageState) -> vk::ImageMemoryBarrier2<'static> {
        vk::ImageMemoryBarrier2::default()
            .src_stage_mask(from.stages)
            .src_access_mask(from.access)
            .dst_stage_mask(to.stages)
            .dst_access_mask(to.access)
            .old_layout(from.layout)
            .new_layout(to.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.image)
            .subresource_range(range(self.aspects))
    }
}

/// Records the initial contents of all attachments and the transition to their states for the
/// passes.
pub(crate) fn initial_contents(
    device: &Device,
    commands: vk::CommandBuffer,
    plan: &Plan,
    input: vk::Buffer,
) {
    let into: Vec<_> = plan
        .attachments
        .iter()
        .map(|a| a.barrier(UNDEFINED, TRANSFER_DST))
        .collect();
    barriers(device, commands, &into);
    let layout = TRANSFER_DST.layout;
    for attachment in &plan.attachments {
        let ranges = [range(attachment.aspects)];
        match &attachment.initial {
            InitialContents::Color(color) => {
                // SAFETY: recording; the image is in this layout.
                unsafe {
                    device.raw.cmd_clear_color_image(
                        commands,
                        attachment.image,
                        layout,
                        color,
                        &ranges,
                    );
                }
            }
            InitialContents::DepthStencil { depth, stencil } => {
                let value = vk::ClearDepthStencilValue {
                    depth: *depth,
                    stencil: u32::from(*stencil),
                };
                // SAFETY: as above.
                unsafe {
                    device.raw.cmd_clear_depth_stencil_image(
                        commands,
                        attachment.image,
                        layout,
                        &value,
                        &ranges,
                    );
                }
            }
            InitialContents::Upload(offset) => {
                let regions = [region(attachment, attachment.aspects, *offset)];
                // SAFETY: as above; the input buffer holds all texels from the offset on.
                unsafe {
                    device.raw.cmd_copy_buffer_to_image(
                        commands,
                        input,
                        attachment.image,
                        layout,
                        &regions,
                    );
                }
            }
        }
    }
    let initial: Vec<_> = plan
        .attachments
        .iter()
        .filter(|a| a.role != Role::Idle)
        .map(|a| a.barrier(TRANSFER_DST, a.initial_state()))
        .collect();
    barriers(device, commands, &initial);
}

/// Records all passes. Attachments change state between passes and end in their first state.
pub(crate) fn passes(device: &Device, commands: vk::CommandBuffer, plan: &Plan, input: vk::Buffer) {
    let mut roles: Vec<Role> = plan.attachments.iter().map(|a| a.role).collect();
    for (index, pass) in plan.passes.iter().enumerate() {
        if index > 0 {
            between_passes(device, commands);
        }
        change_roles(
            device,
            commands,
            plan,
            &mut roles,
            pass.roles.iter().copied(),
        );
        self::pass(device, commands, pass, input);
    }
    let first = plan.attachments.iter().map(|a| a.role).enumerate();
    change_roles(device, commands, plan, &mut roles, first);
}

/// Records the transitions to these roles. Attachments that keep their role need only
/// [`between_passes`].
fn change_roles(
    device: &Device,
    commands: vk::CommandBuffer,
    plan: &Plan,
    roles: &mut [Role],
    new_roles: impl Iterator<Item = (usize, Role)>,
) {
    let mut moved = Vec::new();
    for (index, role) in new_roles {
        let (Some(attachment), Some(now)) = (plan.attachments.get(index), roles.get_mut(index))
        else {
            continue;
        };
        if *now != role {
            moved.push(attachment.barrier(now.state(), role.state()));
            *now = role;
        }
    }
    barriers(device, commands, &moved);
}

/// Makes the writes of a pass visible to the next.
fn between_passes(device: &Device, commands: vk::CommandBuffer) {
    let stages = vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT
        | vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS
        | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS;
    let written =
        vk::AccessFlags2::COLOR_ATTACHMENT_WRITE | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE;
    let read =
        vk::AccessFlags2::COLOR_ATTACHMENT_READ | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ;
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(stages)
        .src_access_mask(written)
        .dst_stage_mask(stages)
        .dst_access_mask(read | written)];
    let info = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: recording, outside of a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}

fn pass(device: &Device, commands: vk::CommandBuffer, pass: &PassPlan, input: vk::Buffer) {
    let api = &device.raw;
    let attachment = |view: vk::ImageView, layout: vk::ImageLayout, ends: &Ends| {
        vk::RenderingAttachmentInfo::default()
            .image_view(view)
            .image_layout(layout)
            .load_op(ends.load)
            .store_op(ends.store)
            .clear_value(ends.value)
    };
    let drawn = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    let mut color = Vec::with_capacity(pass.color.len());
    for target in &pass.color {
        let mut info = attachment(target.view, drawn, &target.ends);
        if let Some((resolve, mode)) = target.resolve {
            info = info
                .resolve_mode(mode)
                .resolve_image_view(resolve)
                .resolve_image_layout(drawn);
        }
        color.push(info);
    }
    let aspect = |ends: fn(&DepthStencilPlan) -> Option<&Ends>, place: usize| {
        let plan = pass.depth_stencil.as_ref()?;
        let ends = ends(plan)?;
        let info = if plan.read_only {
            // A store operation would count as a write.
            attachment(plan.view, DEPTH_STENCIL_READ_ONLY.layout, ends)
                .store_op(vk::AttachmentStoreOp::NONE)
        } else {
            attachment(plan.view, DEPTH_STENCIL.layout, ends)
        };
        Some(match plan.resolve {
            None => info,
            Some((view, modes)) => info
                .resolve_mode(modes[place])
                .resolve_image_view(view)
                .resolve_image_layout(DEPTH_STENCIL_RESOLVE.layout),
        })
    };
    let depth = aspect(|plan| plan.depth.as_ref(), 0);
    let stencil = aspect(|plan| plan.stencil.as_ref(), 1);
    let [width, height] = pass.size;
    let area = vk::Rect2D {
        offset: vk::Offset2D::default(),
        extent: vk::Extent2D { width, height },
    };
    let mut info = vk::RenderingInfo::default()
        .render_area(area)
        .layer_count(1)
        .color_attachments(&color);
    if let Some(depth) = &depth {
        info = info.depth_attachment(depth);
    }
    if let Some(stencil) = &stencil {
        info = info.stencil_attachment(stencil);
    }
    // SAFETY: recording; the attachments are in the layouts named, and live as long as the scene.
    unsafe {
        api.cmd_begin_rendering(commands, &info);
        let mut bound: Option<&Pipeline> = None;
        let mut clears = pass.clears.iter().peekable();
        for (index, draw) in pass.draws.iter().enumerate() {
            while let Some((_, clear)) = clears.next_if(|(before, _)| *before <= index) {
                clear.record(device, commands);
            }
            let pipeline = &*draw.pipeline;
            if bound.is_none_or(|b| b.raw != pipeline.raw) {
                let point = vk::PipelineBindPoint::GRAPHICS;
                api.cmd_bind_pipeline(commands, point, pipeline.raw);
                bound = Some(pipeline);
            }
            self::draw(device, commands, draw, input);
        }
        for (_, clear) in clears {
            clear.record(device, commands);
        }
        api.cmd_end_rendering(commands);
    }
}

/// # Safety
/// Within a render pass of `commands`, with the draw's pipeline bound.
unsafe fn draw(device: &Device, commands: vk::CommandBuffer, draw: &DrawPlan, input: vk::Buffer) {
    let api = &device.raw;
    // SAFETY: set, buffers, queries and pipeline live as long as the scene, the offsets lie inside the
    // input buffer, which was written before, and each query is begun once.
    unsafe {
        api.cmd_bind_descriptor_sets(
            commands,
            vk::PipelineBindPoint::GRAPHICS,
            draw.pipeline.layout,
            0,
            &[draw.set],
            &[draw.params],
        );
        draw.dynamic.set(device, commands);
        api.cmd_bind_vertex_buffers(commands, 0, &[input], &[draw.vertices]);
        for query in &draw.queries {
            api.cmd_begin_query(commands, query.pool, query.index, query.flags);
        }
        match draw.indices {
            Some(offset) => {
                api.cmd_bind_index_buffer(commands, input, offset, vk::IndexType::UINT32);
                api.cmd_draw_indexed(commands, draw.count, 1, 0, 0, 0);
            }
            None => api.cmd_draw(commands, draw.count, 1, 0, 0),
        }
        for query in draw.queries.iter().rev() {
            api.cmd_end_query(commands, query.pool, query.index);
        }
    }
}

/// Records the copies of everything that is read back to the output buffer.
pub(crate) fn reads(device: &Device, commands: vk::CommandBuffer, plan: &Plan, output: vk::Buffer) {
    let into: Vec<_> = plan
        .attachments
        .iter()
        .filter(|a| a.read)
        .map(|a| a.barrier(a.initial_state(), a.read_state()))
        .collect();
    barriers(device, commands, &into);
    for read in &plan.reads {
        let Some(attachment) = plan.attachments.get(read.attachment) else {
            continue;
        };
        if let Some((reader, set)) = read.reader {
            let point = vk::PipelineBindPoint::COMPUTE;
            let [x, y] = attachment.size.map(|side| side.div_ceil(TILE));
            // SAFETY: recording; the set names the image's view and this read's part of the output.
            unsafe {
                let layout = reader.layout.pipeline;
                device
                    .raw
                    .cmd_bind_pipeline(commands, point, reader.pipeline);
                device
                    .raw
                    .cmd_bind_descriptor_sets(commands, point, layout, 0, &[set], &[]);
                device.raw.cmd_dispatch(commands, x, y, 1);
            }
        } else {
            let aspect = crate::format::aspect_flag(read.aspect);
            let regions = [region(attachment, aspect, read.offset)];
            // SAFETY: recording; the output buffer holds all texels from the offset on.
            unsafe {
                device.raw.cmd_copy_image_to_buffer(
                    commands,
                    attachment.image,
                    TRANSFER_SRC.layout,
                    output,
                    &regions,
                );
            }
        }
    }
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(
            vk::PipelineStageFlags2::ALL_TRANSFER | vk::PipelineStageFlags2::COMPUTE_SHADER,
        )
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE | vk::AccessFlags2::SHADER_STORAGE_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::HOST)
        .dst_access_mask(vk::AccessFlags2::HOST_READ)];
    let info = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: recording, outside of a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}

fn barriers(
    device: &Device,
    commands: vk::CommandBuffer,
    barriers: &[vk::ImageMemoryBarrier2<'_>],
) {
    if barriers.is_empty() {
        return;
    }
    let info = vk::DependencyInfo::default().image_memory_barriers(barriers);
    // SAFETY: recording, outside of a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// Returns the copy of a whole aspect, tightly packed at an offset of a buffer.
fn region(
    attachment: &AttachmentPlan,
    aspect: vk::ImageAspectFlags,
    offset: u64,
) -> vk::BufferImageCopy {
    vk::BufferImageCopy {
        buffer_offset: offset,
        buffer_row_length: 0,
        buffer_image_height: 0,
        image_subresource: vk::ImageSubresourceLayers {
            aspect_mask: aspect,
            mip_level: 0,
            base_array_layer: 0,
            layer_count: 1,
        },
        image_offset: vk::Offset3D::default(),
        image_extent: vk::Extent3D {
            width: attachment.size[0],
            height: attachment.size[1],
            depth: 1,
        },
    }
}
