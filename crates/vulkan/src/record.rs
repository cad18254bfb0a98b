//! Recording of commands: initial contents, passes, and copies for reading back.

use crate::attached::DepthStencilPlan;
use crate::blits;
use crate::clear::Ends;
use crate::device::{Device, MOST_COUNTED};
use crate::dynamic::Dynamic;
use crate::error::{Check, internal};
use crate::image::ImagePlace;
use crate::image_state::{
    COLOR, COMPUTE, DEPTH_STENCIL, DEPTH_STENCIL_READ_ONLY, DEPTH_STENCIL_RESOLVE, FETCHED,
    ImageState, TRANSFER_DST, TRANSFER_SRC, UNDEFINED,
};
use crate::inputs::{ARGUMENTS_BYTES, Arguments, CallNumbers};
use crate::own_pass;
use crate::pipeline::{INSTANCE_BINDING, Pipeline};
use crate::plan::{AttachmentPlan, DrawPlan, InitialContents, PassPlan, ScenePlan};
use crate::read::ReadPlan;
use crate::render_pass::RenderPass;
use crate::role::Role;
use crate::samples::TILE;
use crate::slot::Slot;
use crate::storage;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::{PathCommands, PathEnd, PathReads};
use std::cell::Cell;
use std::ops::Range;

impl Role {
    /// Returns the state of an attachment in this role.
    pub(crate) fn state(self) -> ImageState {
        match self {
            Self::Color => COLOR,
            Self::DepthStencil => DEPTH_STENCIL,
            Self::DepthStencilReadOnly => DEPTH_STENCIL_READ_ONLY,
            Self::DepthStencilResolve => DEPTH_STENCIL_RESOLVE,
            Self::Fetched => FETCHED,
            Self::Own(way) => own_pass::state(way),
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
        if self.is_read_by_shader() {
            COMPUTE
        } else {
            TRANSFER_SRC
        }
    }

    /// Returns true if a shader reads the image back: it has several samples, which copies cannot read, or its
    /// path says so.
    pub(crate) fn is_read_by_shader(&self) -> bool {
        self.samples > 1 || self.end == PathEnd::ShaderRead
    }

    /// Returns the place that is read back, in the copy if there is one.
    fn read_place(&self) -> ImagePlace {
        self.copy.map_or(self.place, |_| ImagePlace::default())
    }

    pub(crate) fn barrier(
        &self,
        from: ImageState,
        to: ImageState,
    ) -> vk::ImageMemoryBarrier2<'static> {
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
            .subresource_range(self.place.range(self.aspects))
    }
}

/// Records the initial contents of all attachments, and the transitions to their states in the passes.
pub(crate) fn initial_contents(
    device: &Device,
    commands: vk::CommandBuffer,
    plan: &ScenePlan,
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
        let ranges = attachment.place.cleared(attachment.aspects);
        match &attachment.initial {
            InitialContents::Color(color) => match attachment.cleared {
                Some(view) => clear_view(device, commands, attachment, view, *color),
                // SAFETY: `commands` is being recorded; the image is in this layout.
                None => unsafe {
                    device.raw.cmd_clear_color_image(
                        commands,
                        attachment.image,
                        layout,
                        color,
                        &ranges,
                    );
                },
            },
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
                let places = attachment.place.uploaded();
                let regions: Vec<_> = places
                    .into_iter()
                    .map(|place| region(attachment, place, attachment.aspects, *offset))
                    .collect();
                // SAFETY: as above; the input buffer has all texels from the offset on.
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

/// Records a pass that clears an attachment through a view. A transfer would convert the colour to the
/// image's format.
fn clear_view(
    device: &Device,
    commands: vk::CommandBuffer,
    attachment: &AttachmentPlan,
    view: vk::ImageView,
    color: vk::ClearColorValue,
) {
    let [width, height] = attachment.size;
    let targets = [vk::RenderingAttachmentInfo::default()
        .image_view(view)
        .image_layout(COLOR.layout)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::STORE)
        .clear_value(vk::ClearValue { color })];
    let info = vk::RenderingInfo::default()
        .render_area(vk::Rect2D {
            offset: vk::Offset2D::default(),
            extent: vk::Extent2D { width, height },
        })
        .layer_count(attachment.place.layer_count())
        .color_attachments(&targets);
    barriers(device, commands, &[attachment.barrier(TRANSFER_DST, COLOR)]);
    // SAFETY: `commands` is being recorded, outside a pass; the image is in the layout of a colour
    // attachment.
    unsafe {
        device.raw.cmd_begin_rendering(commands, &info);
        device.raw.cmd_end_rendering(commands);
    }
    barriers(device, commands, &[attachment.barrier(COLOR, TRANSFER_DST)]);
}

/// Records all passes. Attachments change state between passes and end in their initial state.
///
/// # Errors
/// If the driver fails to create or end command buffers, or if a pass names an attachment that does not exist.
pub(crate) fn passes(
    device: &Device,
    recorder: &mut CommandRecorder<'_>,
    plan: &ScenePlan,
    input: vk::Buffer,
) -> Result<(), BackendError> {
    let mut roles: Vec<Role> = plan.attachments.iter().map(|a| a.role).collect();
    for (index, pass) in plan.passes.iter().enumerate() {
        let commands = recorder.next_pass(device)?;
        if index > 0 {
            between_passes(device, commands);
            if plan.pool {
                let stage = vk::PipelineStageFlags2::FRAGMENT_SHADER;
                let written = vk::AccessFlags2::SHADER_STORAGE_WRITE;
                storage::before_use(device, commands, stage, written);
            }
        }
        change_roles(
            device,
            commands,
            plan,
            &mut roles,
            pass.roles.iter().copied(),
        )?;
        self::pass(device, recorder, pass, input)?;
        let commands = recorder.slot.commands();
        for resolve in &pass.resolves {
            // SAFETY: `commands` is being recorded; the pass has ended, and its colour attachments are in the
            // layout of colour attachments.
            unsafe { resolve.record(device, commands, &plan.attachments) };
        }
    }
    let first = plan.attachments.iter().map(|a| a.role).enumerate();
    let commands = recorder.next_pass(device)?;
    change_roles(device, commands, plan, &mut roles, first)
}

/// Records the transitions to these roles. An attachment that keeps its role needs only [`between_passes`].
///
/// # Errors
/// If an attachment does not exist.
fn change_roles(
    device: &Device,
    commands: vk::CommandBuffer,
    plan: &ScenePlan,
    roles: &mut [Role],
    new_roles: impl Iterator<Item = (usize, Role)>,
) -> Result<(), BackendError> {
    let mut moved = Vec::new();
    for (index, role) in new_roles {
        let (Some(attachment), Some(now)) = (plan.attachments.get(index), roles.get_mut(index))
        else {
            return Err(internal("a role of an attachment that is not in the plan"));
        };
        // Between passes that read themselves, shaders' reads follow the writes too.
        if *now != role || matches!(role, Role::Own(_)) {
            moved.push(attachment.barrier(now.state(), role.state()));
            *now = role;
        }
    }
    barriers(device, commands, &moved);
    Ok(())
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
    // SAFETY: `commands` is being recorded, outside a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// Makes all writes visible to advanced blends, whose reads are not part of the ordinary accesses (Vulkan,
/// Access Types).
fn before_advanced(device: &Device, commands: vk::CommandBuffer) {
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
        .dst_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_READ_NONCOHERENT_EXT)];
    let info = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: `commands` is being recorded, outside a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// The state that a command buffer has.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CurrentState {
    pipeline: vk::Pipeline,
    dynamic: Option<Dynamic>,
}

/// The command buffers of a submission.
pub(crate) struct CommandRecorder<'a> {
    pub(crate) slot: &'a mut Slot,
    pub(crate) kind: PathCommands,
    /// The state that the command buffer has; `None` if every pass binds pipelines and every draw sets all
    /// state.
    pub(crate) current_state: Option<Cell<CurrentState>>,
    /// True if queries enclose passes.
    pub(crate) over_passes: bool,
}

impl CommandRecorder<'_> {
    /// Returns the command buffer for the next pass. It is outside a pass.
    fn next_pass(&mut self, device: &Device) -> Result<vk::CommandBuffer, BackendError> {
        match self.kind {
            PathCommands::Several => {
                if let Some(current_state) = &self.current_state {
                    current_state.take();
                }
                self.slot.next_primary(device)
            }
            PathCommands::One | PathCommands::Secondary | PathCommands::SecondaryEach => {
                Ok(self.slot.commands())
            }
        }
    }

    /// Records commands inside a pass that has begun.
    fn within(
        &mut self,
        device: &Device,
        pass: &PassPlan,
        record: impl Fn(vk::CommandBuffer, Range<usize>, Option<&Cell<CurrentState>>),
    ) -> Result<(), BackendError> {
        let all = 0..pass.draws.len();
        if !self.is_secondary() {
            record(self.slot.commands(), all, self.current_state.as_ref());
            return Ok(());
        }
        // A query ends in the command buffer in which it begins.
        let spans = |d: &DrawPlan| d.queries.begun.len() != d.queries.ended.len();
        let parts = if self.kind == PathCommands::SecondaryEach && !pass.draws.iter().any(spans) {
            each(all)
        } else {
            vec![all]
        };
        let mut rendering = vk::CommandBufferInheritanceRenderingInfo::default()
            .view_mask(pass.targets.views())
            .color_attachment_formats(&pass.targets.color)
            .depth_attachment_format(pass.targets.depth)
            .stencil_attachment_format(pass.targets.stencil)
            .rasterization_samples(crate::state::samples(pass.targets.samples));
        let mut inheritance = vk::CommandBufferInheritanceInfo::default();
        if self.over_passes {
            inheritance = inherited_queries(device);
        }
        let inheritance = match &pass.object {
            Some(object) => inheritance
                .render_pass(object.raw)
                .subpass(object.first_subpass)
                .framebuffer(object.framebuffer),
            None => inheritance.push_next(&mut rendering),
        };
        let mut secondaries = Vec::with_capacity(parts.len());
        for part in parts {
            let commands = self.slot.secondary(device, &inheritance)?;
            // A secondary command buffer begins without state.
            record(commands, part, None);
            // SAFETY: the secondary commands are complete.
            unsafe { device.raw.end_command_buffer(commands) }.check("command memory")?;
            secondaries.push(commands);
        }
        // SAFETY: the primary commands are being recorded; each secondary is executed once.
        unsafe {
            device
                .raw
                .cmd_execute_commands(self.slot.commands(), &secondaries);
        }
        Ok(())
    }

    /// Returns true if secondary command buffers record the commands inside passes.
    fn is_secondary(&self) -> bool {
        match self.kind {
            PathCommands::Secondary | PathCommands::SecondaryEach => true,
            PathCommands::One | PathCommands::Several => false,
        }
    }

    /// Returns which command buffers record the commands inside a pass.
    fn contents(&self) -> vk::SubpassContents {
        if self.is_secondary() {
            vk::SubpassContents::SECONDARY_COMMAND_BUFFERS
        } else {
            vk::SubpassContents::INLINE
        }
    }
}

/// Returns inheritance info with every kind of query that the device has.
fn inherited_queries(device: &Device) -> vk::CommandBufferInheritanceInfo<'static> {
    let features = &device.features;
    let mut inheritance = vk::CommandBufferInheritanceInfo::default().occlusion_query_enable(true);
    if features.occlusion_query_precise != vk::FALSE {
        inheritance = inheritance.query_flags(vk::QueryControlFlags::PRECISE);
    }
    if features.pipeline_statistics_query != vk::FALSE {
        let statistic = vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS;
        inheritance = inheritance.pipeline_statistics(statistic);
    }
    inheritance
}

/// Records a whole pass with the queries that enclose it. The attachments are in the layouts of their roles.
fn pass(
    device: &Device,
    recorder: &mut CommandRecorder<'_>,
    pass: &PassPlan,
    input: vk::Buffer,
) -> Result<(), BackendError> {
    let commands = recorder.slot.commands();
    if pass.advanced {
        before_advanced(device, commands);
    }
    // SAFETY: `commands` is being recorded, outside a pass; the attachments are in the layouts of their
    // roles, and each query that begins here is begun once.
    unsafe {
        for query in &pass.queries.begun {
            query.begin(device, commands);
        }
        match &pass.object {
            Some(object) => begin_render_pass(device, recorder, pass, object),
            None => begin_rendering(device, recorder, pass),
        }
    }
    recorder.within(device, pass, |commands, part, current_state| {
        // SAFETY: `commands` is being recorded, inside the pass.
        unsafe { draws(device, commands, pass, part, input, current_state) };
    })?;
    // SAFETY: `commands` is being recorded, inside the pass.
    unsafe {
        match &pass.object {
            Some(_) => device.raw.cmd_end_render_pass(commands),
            None => device.raw.cmd_end_rendering(commands),
        }
        for query in &pass.queries.ended {
            query.end(device, commands);
        }
    }
    Ok(())
}

/// # Safety
/// `commands` of the recorder is being recorded, outside a pass, and the attachments are in the layouts of
/// their roles.
unsafe fn begin_render_pass(
    device: &Device,
    recorder: &CommandRecorder<'_>,
    pass: &PassPlan,
    object: &RenderPass,
) {
    let (commands, contents) = (recorder.slot.commands(), recorder.contents());
    let subpasses = object.first_subpass;
    let info = vk::RenderPassBeginInfo::default()
        .render_pass(object.raw)
        .framebuffer(object.framebuffer)
        .render_area(pass.area)
        .clear_values(&object.values);
    // SAFETY: upheld by the caller; the first of two subpasses stays empty.
    unsafe {
        let first = match subpasses {
            0 => contents,
            _ => vk::SubpassContents::INLINE,
        };
        device.raw.cmd_begin_render_pass(commands, &info, first);
        for _ in 0..subpasses {
            device.raw.cmd_next_subpass(commands, contents);
        }
    }
}

/// # Safety
/// `commands` of the recorder is being recorded, outside a pass, and the attachments are in the layouts of
/// their roles.
unsafe fn begin_rendering(device: &Device, recorder: &CommandRecorder<'_>, pass: &PassPlan) {
    let attachment = |view: vk::ImageView, layout: vk::ImageLayout, ends: &Ends| {
        vk::RenderingAttachmentInfo::default()
            .image_view(view)
            .image_layout(layout)
            .load_op(ends.load)
            .store_op(ends.store)
            .clear_value(ends.value)
    };
    let mut color = Vec::with_capacity(pass.color.len());
    for target in &pass.color {
        let mut info = attachment(target.view, target.layout, &target.ends);
        if let Some((resolve, mode)) = target.resolve {
            info = info
                .resolve_mode(mode)
                .resolve_image_view(resolve)
                .resolve_image_layout(COLOR.layout);
        }
        color.push(info);
    }
    let aspect = |ends: fn(&DepthStencilPlan) -> Option<&Ends>, place: usize| {
        let plan = pass.depth_stencil.as_ref()?;
        let ends = ends(plan)?;
        let info = if plan.read_only {
            // A store operation would count as a write.
            attachment(plan.view, plan.layout, ends).store_op(vk::AttachmentStoreOp::NONE)
        } else {
            attachment(plan.view, plan.layout, ends)
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
    let mut info = vk::RenderingInfo::default()
        .render_area(pass.area)
        .layer_count(pass.targets.layer_count())
        .view_mask(pass.targets.views())
        .color_attachments(&color);
    if recorder.is_secondary() {
        info = info.flags(vk::RenderingFlags::CONTENTS_SECONDARY_COMMAND_BUFFERS);
    }
    if let Some(depth) = &depth {
        info = info.depth_attachment(depth);
    }
    if let Some(stencil) = &stencil {
        info = info.stencil_attachment(stencil);
    }
    // SAFETY: upheld by the caller; the attachments live as long as the scene.
    unsafe {
        device
            .raw
            .cmd_begin_rendering(recorder.slot.commands(), &info);
    }
}

/// Returns the ranges of one number each, or an empty range.
fn each(range: Range<usize>) -> Vec<Range<usize>> {
    if range.is_empty() {
        return vec![range];
    }
    range.map(|i| i..i + 1).collect()
}

/// Records a part of a pass's draws and the clears before them. The last part has the clears at the end.
///
/// # Safety
/// `commands` is being recorded, inside the pass.
unsafe fn draws(
    device: &Device,
    commands: vk::CommandBuffer,
    pass: &PassPlan,
    part: Range<usize>,
    input: vk::Buffer,
    current_state: Option<&Cell<CurrentState>>,
) {
    let api = &device.raw;
    // SAFETY: upheld by the caller; pipelines live as long as the scene.
    unsafe {
        let bind = |pipeline: &Pipeline| {
            api.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, pipeline.raw);
        };
        let mut current = current_state.map(Cell::take).unwrap_or_default();
        let mut bound = current.pipeline;
        let (first, end) = (part.start, part.end);
        let clears = pass.clears.iter();
        let mut clears = clears
            .skip_while(|(before, _)| first > 0 && *before < first)
            .peekable();
        for (index, draw) in pass.draws.iter().enumerate().take(end).skip(first) {
            let mut cleared = false;
            while let Some((_, clear)) = clears.next_if(|(before, _)| *before <= index) {
                clear.record(device, commands);
                cleared = true;
            }
            match pass.targets.reads {
                Some(PathReads::Subpasses) if index > 0 => {
                    api.cmd_next_subpass(commands, vk::SubpassContents::INLINE);
                }
                Some(way) if cleared || index > 0 && way != PathReads::Ordered => {
                    own_pass::barrier(api, commands, way);
                }
                _ => {}
            }
            let pipeline = &*draw.pipeline;
            // The path decides the order of pipeline and state:
            // - the pipeline, then the state;
            // - the state, then the pipeline, with `before_pipeline`;
            // - another pipeline, the state, then the pipeline, with `before_pipeline` and `other`;
            // - the pipeline, the state, another pipeline, then the pipeline again, with `other`.
            if let Some(single) = draw.single {
                single.set(device, commands);
                bound = vk::Pipeline::null();
            }
            if !draw.before_pipeline && bound != pipeline.raw {
                bind(pipeline);
                bound = pipeline.raw;
            }
            if let Some(other) = draw.other.as_ref().filter(|_| draw.before_pipeline) {
                bind(other);
            }
            if draw.overwritten {
                draw.dynamic.opposite().set(device, commands, None);
            }
            let before = current.dynamic.filter(|_| current_state.is_some());
            draw.dynamic.set(device, commands, before.as_ref());
            current.dynamic = Some(draw.dynamic);
            if let Some(values) = &draw.beyond {
                values.record(device, commands);
            }
            if draw.before_pipeline {
                bind(pipeline);
                bound = pipeline.raw;
            } else if let Some(other) = &draw.other {
                bind(other);
                bind(pipeline);
            }
            self::draw(device, commands, draw, input);
            if let Some(again) = &draw.again {
                bind(again);
                bound = again.raw;
                self::draw(device, commands, draw, input);
            }
        }
        for (_, clear) in clears.filter(|_| end == pass.draws.len()) {
            clear.record(device, commands);
        }
        if let Some(PathReads::FeedbackLoop) = pass.targets.reads {
            // Store operations write after the reads, which are not those of attachments.
            own_pass::barrier(api, commands, PathReads::FeedbackLoop);
        }
        if let Some(current_state) = current_state {
            current.pipeline = bound;
            current_state.set(current);
        }
    }
}

/// Records the bindings of a draw's data, its queries and its call.
///
/// # Safety
/// `commands` is being recorded, inside a render pass, with the draw's pipeline bound and its state set.
unsafe fn draw(device: &Device, commands: vk::CommandBuffer, draw: &DrawPlan, input: vk::Buffer) {
    let api = &device.raw;
    // SAFETY: set, buffers, queries and pipeline live as long as the scene, the offsets are inside the input
    // buffer, which was written earlier, and each query is begun once.
    unsafe {
        api.cmd_bind_descriptor_sets(
            commands,
            vk::PipelineBindPoint::GRAPHICS,
            draw.pipeline.layout,
            0,
            &[draw.set],
            &[draw.params],
        );
        api.cmd_bind_vertex_buffers(commands, 0, &[input], &[draw.vertices]);
        for query in &draw.queries.begun {
            query.begin(device, commands);
        }
        if let Some(colors) = draw.colors {
            api.cmd_bind_vertex_buffers(commands, INSTANCE_BINDING, &[input], &[colors]);
        }
        let mut call = draw.call;
        if let Some((mut offset, kind)) = draw.indices {
            if draw.arguments.is_none() {
                // An odd first index is partly in the offset, which then is no multiple of 4 for short indices.
                let odd = call.first % 2;
                call.first -= odd;
                offset += u64::from(odd) * if kind == vk::IndexType::UINT16 { 2 } else { 4 };
            }
            api.cmd_bind_index_buffer(commands, input, offset, kind);
        }
        let CallNumbers {
            first,
            count,
            base_vertex,
            instances,
            first_instance,
        } = call;
        let direct = |count, instances| match draw.indices {
            Some(_) => api.cmd_draw_indexed(
                commands,
                count,
                instances,
                first,
                base_vertex,
                first_instance,
            ),
            None => api.cmd_draw(commands, count, instances, first, first_instance),
        };
        if draw.after_empty {
            direct(0, instances);
            direct(count, 0);
        }
        match (draw.indices, draw.arguments) {
            (
                indices,
                Some(Arguments {
                    offset,
                    count: None,
                }),
            ) => match indices {
                Some(_) => api.cmd_draw_indexed_indirect(commands, input, offset, 1, 0),
                None => api.cmd_draw_indirect(commands, input, offset, 1, 0),
            },
            (
                indices,
                Some(Arguments {
                    offset,
                    count: Some(count),
                }),
            ) => {
                let draw = match indices {
                    Some(_) => api.fp_v1_2().cmd_draw_indexed_indirect_count,
                    None => api.fp_v1_2().cmd_draw_indirect_count,
                };
                draw(
                    commands,
                    input,
                    offset,
                    input,
                    count,
                    MOST_COUNTED,
                    ARGUMENTS_BYTES as u32,
                );
            }
            (_, None) => direct(count, instances),
        }
        for query in &draw.queries.ended {
            query.end(device, commands);
        }
    }
}

/// Records the copies of attachments to the images that are read instead.
fn copies(device: &Device, commands: vk::CommandBuffer, plan: &ScenePlan) {
    let copied = || plan.attachments.iter().filter_map(|a| Some((a, a.copy?)));
    let moved = |image: vk::Image, a: &AttachmentPlan, from: ImageState, to: ImageState| {
        a.barrier(from, to)
            .image(image)
            .subresource_range(ImagePlace::default().range(a.aspects))
    };
    let into: Vec<_> = copied()
        .flat_map(|(a, copy)| {
            let source = a.barrier(a.initial_state(), TRANSFER_SRC);
            [source, moved(copy, a, UNDEFINED, TRANSFER_DST)]
        })
        .collect();
    barriers(device, commands, &into);
    for (attachment, copy) in copied() {
        let [width, height] = attachment.size;
        let (from, to) = (attachment.place, ImagePlace::default());
        let source = from.layers(attachment.aspects);
        let target = to.layers(attachment.aspects);
        let extent = vk::Extent3D {
            width,
            height,
            depth: 1,
        };
        if let Some(between) = attachment.between {
            // SAFETY: `commands` is being recorded; the images are in these layouts.
            unsafe { blits::record(device, commands, attachment, between, copy) };
            continue;
        }
        // SAFETY: `commands` is being recorded; the images are in these layouts, and both contain the
        // rectangle.
        unsafe {
            if attachment.end == PathEnd::Blit {
                let corners = |place: ImagePlace| {
                    let end = place.offset(width, height);
                    [
                        place.offset(0, 0),
                        vk::Offset3D {
                            z: end.z + 1,
                            ..end
                        },
                    ]
                };
                let region = vk::ImageBlit {
                    src_subresource: source,
                    src_offsets: corners(from),
                    dst_subresource: target,
                    dst_offsets: corners(to),
                };
                device.raw.cmd_blit_image(
                    commands,
                    attachment.image,
                    TRANSFER_SRC.layout,
                    copy,
                    TRANSFER_DST.layout,
                    &[region],
                    vk::Filter::NEAREST,
                );
            } else {
                let region = vk::ImageCopy {
                    src_subresource: source,
                    src_offset: from.offset(0, 0),
                    dst_subresource: target,
                    dst_offset: to.offset(0, 0),
                    extent,
                };
                device.raw.cmd_copy_image(
                    commands,
                    attachment.image,
                    TRANSFER_SRC.layout,
                    copy,
                    TRANSFER_DST.layout,
                    &[region],
                );
            }
        }
    }
    let out: Vec<_> = copied()
        .map(|(a, copy)| moved(copy, a, TRANSFER_DST, a.read_state()))
        .collect();
    barriers(device, commands, &out);
}

/// Records the copies into the output buffer of everything that is read back.
///
/// # Errors
/// If a read names an attachment that does not exist.
pub(crate) fn reads(
    device: &Device,
    commands: vk::CommandBuffer,
    plan: &ScenePlan,
    output: vk::Buffer,
) -> Result<(), BackendError> {
    copies(device, commands, plan);
    let into: Vec<_> = plan
        .attachments
        .iter()
        .filter(|a| a.read && a.copy.is_none())
        .map(|a| a.barrier(a.initial_state(), a.read_state()))
        .collect();
    barriers(device, commands, &into);
    for read in &plan.reads {
        let attachment = plan
            .attachments
            .get(read.attachment)
            .ok_or_else(|| internal("a read of an attachment that is not in the plan"))?;
        if let Some((reader, set)) = read.reader {
            let point = vk::PipelineBindPoint::COMPUTE;
            let [x, y] = attachment.size.map(|side| side.div_ceil(TILE));
            // SAFETY: `commands` is being recorded; the set names the image's view and this read's part of
            // the output.
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
            let regions = match attachment.end {
                PathEnd::Part => read.parts(attachment, aspect),
                _ => vec![region(
                    attachment,
                    attachment.read_place(),
                    aspect,
                    read.offset,
                )],
            };
            // SAFETY: `commands` is being recorded; the output buffer has room for all texels from the offset
            // on.
            unsafe {
                device.raw.cmd_copy_image_to_buffer(
                    commands,
                    attachment.copy.unwrap_or(attachment.image),
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
    // SAFETY: `commands` is being recorded, outside a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
    Ok(())
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
    // SAFETY: `commands` is being recorded, outside a render pass.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// Returns the copy of a whole aspect, tightly packed at an offset of a buffer.
fn region(
    attachment: &AttachmentPlan,
    place: ImagePlace,
    aspect: vk::ImageAspectFlags,
    offset: u64,
) -> vk::BufferImageCopy {
    vk::BufferImageCopy {
        buffer_offset: offset,
        buffer_row_length: 0,
        buffer_image_height: 0,
        image_subresource: place.layers(aspect),
        image_offset: place.offset(0, 0),
        image_extent: vk::Extent3D {
            width: attachment.size[0],
            height: attachment.size[1],
            depth: 1,
        },
    }
}

impl ReadPlan {
    /// Returns the copies of an aspect in up to four parts. Together they fill the buffer as one copy would.
    fn parts(
        &self,
        attachment: &AttachmentPlan,
        aspect: vk::ImageAspectFlags,
    ) -> Vec<vk::BufferImageCopy> {
        let [width, height] = attachment.size;
        // Buffer offsets of depth and stencil must be multiples of 4 (VkBufferImageCopy).
        let cut = |length: u32| match length / 3 / 4 * 4 {
            0 => vec![(0, length)],
            first => vec![(0, first), (first, length - first)],
        };
        let texel = self.texel_bytes();
        let mut regions = Vec::new();
        for (y, rows) in cut(height) {
            for (x, columns) in cut(width) {
                regions.push(vk::BufferImageCopy {
                    buffer_offset: self.offset
                        + (u64::from(y) * u64::from(width) + u64::from(x)) * texel,
                    buffer_row_length: width,
                    buffer_image_height: 0,
                    image_subresource: attachment.place.layers(aspect),
                    image_offset: attachment.place.offset(x, y),
                    image_extent: vk::Extent3D {
                        width: columns,
                        height: rows,
                        depth: 1,
                    },
                });
            }
        }
        regions
    }
}
