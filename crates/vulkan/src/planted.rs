//! A device function table with a planted fault, for tests of the suite.
//!
//! The functions of the table have the driver's signatures and nothing else to tell them apart, so the
//! driver's own table and what was seen of the calls are kept per thread: a backend belongs to one thread.
//! The rest of the backend is the one that releases have.

use ash::vk;
use etalon_backend::CallFault;
use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::c_void;

thread_local! {
    static PLANTED: RefCell<Option<Planted>> = const { RefCell::new(None) };
}

/// The driver's functions, and what was seen of the commands since recording began.
struct Planted {
    fault: CallFault,
    v10: ash::DeviceFnV1_0,
    v12: ash::DeviceFnV1_2,
    v13: ash::DeviceFnV1_3,
    /// The number of passes begun.
    passes: u32,
    /// The number of draws of the pass.
    draws: u32,
    /// The number of queries begun, kept until others begin.
    queries: u32,
    /// True if no query has begun since recording began.
    no_query: bool,
    /// True if the pass before was read-only.
    after_read_only: bool,
    /// True if the pass is read-only.
    read_only: bool,
    /// True if the pass is an object.
    in_render_pass: bool,
    /// True if the pass has stencil.
    stencil: bool,
    /// The number of draws of a secondary command buffer; `None` in a primary one.
    secondary: Option<u32>,
    size: vk::Extent2D,
    scissor: vk::Rect2D,
    topology: vk::PrimitiveTopology,
    kept: Kept,
    /// The last clear value of each image, as bits.
    cleared: HashMap<vk::Image, [u32; 4]>,
}

/// The state of the draw before.
#[derive(Default)]
struct Kept {
    compare: Option<vk::CompareOp>,
    write: Option<vk::Bool32>,
    cull: Option<vk::CullModeFlags>,
    references: HashMap<u32, u32>,
    constants: Option<[f32; 4]>,
    viewport: Option<vk::Viewport>,
    scissor: Option<vk::Rect2D>,
}

/// Returns the device with a fault in its function table.
pub(crate) fn plant(device: &ash::Device, fault: CallFault) -> ash::Device {
    let (v10, v13) = (device.fp_v1_0().clone(), device.fp_v1_3().clone());
    let v12 = device.fp_v1_2().clone();
    let (mut faulty10, mut faulty12, mut faulty13) = (v10.clone(), v12.clone(), v13.clone());
    faulty10.create_image_view = create_image_view;
    faulty10.create_graphics_pipelines = create_graphics_pipelines;
    faulty10.cmd_begin_render_pass = cmd_begin_render_pass;
    faulty10.cmd_blit_image = cmd_blit_image;
    faulty12.create_render_pass2 = create_render_pass2;
    faulty10.begin_command_buffer = begin_command_buffer;
    faulty10.cmd_draw = cmd_draw;
    faulty10.cmd_draw_indexed = cmd_draw_indexed;
    faulty10.cmd_set_scissor = cmd_set_scissor;
    faulty10.cmd_set_viewport = cmd_set_viewport;
    faulty10.cmd_set_stencil_reference = cmd_set_stencil_reference;
    faulty10.cmd_set_blend_constants = cmd_set_blend_constants;
    faulty10.cmd_clear_color_image = cmd_clear_color_image;
    faulty10.cmd_clear_attachments = cmd_clear_attachments;
    faulty10.cmd_begin_query = cmd_begin_query;
    faulty10.cmd_end_query = cmd_end_query;
    faulty10.get_query_pool_results = get_query_pool_results;
    faulty13.cmd_begin_rendering = cmd_begin_rendering;
    faulty13.cmd_set_depth_compare_op = cmd_set_depth_compare_op;
    faulty13.cmd_set_depth_write_enable = cmd_set_depth_write_enable;
    faulty13.cmd_set_cull_mode = cmd_set_cull_mode;
    faulty13.cmd_set_primitive_topology = cmd_set_primitive_topology;
    PLANTED.set(Some(Planted {
        fault,
        v10,
        v12,
        v13,
        passes: 0,
        draws: 0,
        queries: 0,
        no_query: true,
        after_read_only: false,
        read_only: false,
        in_render_pass: false,
        stencil: false,
        secondary: None,
        size: vk::Extent2D::default(),
        scissor: vk::Rect2D::default(),
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        kept: Kept::default(),
        cleared: HashMap::new(),
    }));
    ash::Device::from_parts_1_3(
        device.handle(),
        faulty10,
        device.fp_v1_1().clone(),
        faulty12,
        faulty13,
    )
}

fn with<R>(call: impl FnOnce(&mut Planted) -> R) -> Option<R> {
    PLANTED.with_borrow_mut(|planted| planted.as_mut().map(call))
}

/// Returns the value of the call before, and keeps this one for the next.
fn lag<T: Copy>(kept: &mut Option<T>, value: T) -> T {
    kept.replace(value).unwrap_or(value)
}

fn rect(left: i32, top: i32, right: i32, bottom: i32) -> vk::Rect2D {
    vk::Rect2D {
        offset: vk::Offset2D { x: left, y: top },
        extent: vk::Extent2D {
            width: (right - left).max(0).cast_unsigned(),
            height: (bottom - top).max(0).cast_unsigned(),
        },
    }
}

fn intersection(a: vk::Rect2D, b: vk::Rect2D) -> vk::Rect2D {
    let end = |r: vk::Rect2D| {
        let far = |start: i32, length: u32| start.saturating_add_unsigned(length);
        (
            far(r.offset.x, r.extent.width),
            far(r.offset.y, r.extent.height),
        )
    };
    let (left, top) = (a.offset.x.max(b.offset.x), a.offset.y.max(b.offset.y));
    let ((ax, ay), (bx, by)) = (end(a), end(b));
    rect(left, top, ax.min(bx), ay.min(by))
}

impl Planted {
    /// Returns the parts of the attachments that draws reach.
    fn parts(&self) -> Vec<vk::Rect2D> {
        let (w, h) = (
            self.size.width.cast_signed(),
            self.size.height.cast_signed(),
        );
        match self.fault {
            CallFault::OnlyFirst64 => vec![rect(0, 0, 64, 64)],
            CallFault::LastRow => vec![rect(0, 0, w, h - 1)],
            CallFault::LastColumn => vec![rect(0, 0, w - 1, h)],
            CallFault::SecondTile => {
                vec![rect(0, 0, 32, 32), rect(64, 0, w, 32), rect(0, 32, w, h)]
            }
            _ => Vec::new(),
        }
    }

    /// Draws, in parts if the fault asks for it.
    ///
    /// # Safety
    /// As of the command that `draw` records.
    unsafe fn draw(&mut self, commands: vk::CommandBuffer, draw: impl Fn(&Self)) {
        self.draws += 1;
        let first = self.draws == 1;
        if let Some(draws) = &mut self.secondary {
            *draws += 1;
        }
        let lost = match self.fault {
            CallFault::Draw256 => self.draws == 256,
            CallFault::LaterPassDraw => first && self.passes > 1,
            CallFault::StoreDropped => self.in_render_pass,
            CallFault::SecondaryFirstDraw => self.secondary == Some(1),
            CallFault::AfterReadOnly => first && self.after_read_only,
            _ => false,
        };
        if lost {
            return;
        }
        let parts = self.parts();
        if parts.is_empty() {
            draw(self);
            return;
        }
        for part in parts {
            let scissor = intersection(self.scissor, part);
            // SAFETY: the caller's; the scissor is dynamic in every pipeline.
            unsafe { (self.v10.cmd_set_scissor)(commands, 0, 1, &scissor) };
            draw(self);
        }
    }

    fn count(&self, count: u32, indexed: bool) -> u32 {
        let line = matches!(
            self.topology,
            vk::PrimitiveTopology::POINT_LIST
                | vk::PrimitiveTopology::LINE_LIST
                | vk::PrimitiveTopology::LINE_STRIP
        );
        match self.fault {
            CallFault::Indices65535 if indexed => count.min(65_535),
            CallFault::Vertices4096 if !indexed => count.min(4_096),
            CallFault::Lines500 if line => count.min(500),
            _ => count,
        }
    }

    fn instances(&self, instances: u32) -> u32 {
        match self.fault {
            CallFault::SecondInstance => instances.min(1),
            _ => instances,
        }
    }

    fn first_instance(&self, first: u32) -> u32 {
        match self.fault {
            CallFault::FirstInstance => 0,
            _ => first,
        }
    }
}

// SAFETY: of each function below: it has the type of the driver's function of its name, whose arguments it
// passes on as they are or made from valid ones, so the caller's promise holds for the driver's function.

unsafe extern "system" fn begin_command_buffer(
    commands: vk::CommandBuffer,
    info: *const vk::CommandBufferBeginInfo<'_>,
) -> vk::Result {
    let call = |p: &mut Planted| {
        // SAFETY: the caller's.
        let flags = unsafe { (*info).flags };
        let within = flags.contains(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE);
        p.secondary = within.then_some(0);
        if !within {
            (p.passes, p.draws, p.no_query) = (0, 0, true);
            (p.after_read_only, p.read_only, p.in_render_pass) = (false, false, false);
            p.kept = Kept::default();
        }
        // SAFETY: the caller's.
        unsafe { (p.v10.begin_command_buffer)(commands, info) }
    };
    with(call).unwrap_or(vk::Result::ERROR_UNKNOWN)
}

unsafe extern "system" fn cmd_draw(
    commands: vk::CommandBuffer,
    count: u32,
    instances: u32,
    first: u32,
    first_instance: u32,
) {
    with(|p| {
        let count = p.count(count, false);
        let (instances, base) = (p.instances(instances), p.first_instance(first_instance));
        // SAFETY: the caller's; no more is drawn than asked for.
        unsafe {
            p.draw(commands, |p| {
                (p.v10.cmd_draw)(commands, count, instances, first, base);
            });
        }
    });
}

unsafe extern "system" fn cmd_draw_indexed(
    commands: vk::CommandBuffer,
    count: u32,
    instances: u32,
    first: u32,
    base_vertex: i32,
    first_instance: u32,
) {
    with(|p| {
        let mut count = p.count(count, true);
        let (instances, base) = (p.instances(instances), p.first_instance(first_instance));
        let base_vertex = match p.fault {
            CallFault::BaseVertex => 0,
            _ => base_vertex,
        };
        let mut first = match p.fault {
            CallFault::IndexOffset => 0,
            _ => first,
        };
        if p.fault == CallFault::FirstIndex && first > 0 && count > 0 {
            (first, count) = (first + 1, count - 1);
        }
        // SAFETY: the caller's; no more is drawn than asked for.
        unsafe {
            p.draw(commands, |p| {
                let draw = p.v10.cmd_draw_indexed;
                draw(commands, count, instances, first, base_vertex, base);
            });
        }
    });
}

unsafe extern "system" fn cmd_set_scissor(
    commands: vk::CommandBuffer,
    at: u32,
    count: u32,
    scissors: *const vk::Rect2D,
) {
    with(|p| {
        if count > 1 {
            // SAFETY: the caller's.
            unsafe { (p.v10.cmd_set_scissor)(commands, at, count, scissors) };
            return;
        }
        // SAFETY: the backend passes one rectangle at least.
        let mut scissor = unsafe { *scissors };
        if p.fault == CallFault::ScissorKept {
            scissor = lag(&mut p.kept.scissor, scissor);
        }
        let right = scissor
            .offset
            .x
            .saturating_add_unsigned(scissor.extent.width);
        let inside = right < p.size.width.cast_signed();
        if p.fault == CallFault::ScissorEdge && right % 16 == 0 && inside {
            scissor.extent.width = scissor.extent.width.saturating_sub(1);
        }
        p.scissor = scissor;
        // SAFETY: the caller's.
        unsafe { (p.v10.cmd_set_scissor)(commands, at, count, &scissor) };
    });
}

unsafe extern "system" fn cmd_set_viewport(
    commands: vk::CommandBuffer,
    at: u32,
    count: u32,
    viewports: *const vk::Viewport,
) {
    with(|p| {
        // SAFETY: the backend passes one viewport at least.
        let mut viewport = unsafe { *viewports };
        if count > 1 {
            let first = [viewport; 2];
            let both = match p.fault {
                CallFault::ViewportFirst => first.as_ptr(),
                _ => viewports,
            };
            // SAFETY: the caller's; the backend passes two.
            unsafe { (p.v10.cmd_set_viewport)(commands, at, count, both) };
            return;
        }
        if p.fault == CallFault::ViewportKept {
            viewport = lag(&mut p.kept.viewport, viewport);
        }
        // SAFETY: the caller's.
        unsafe { (p.v10.cmd_set_viewport)(commands, at, count, &viewport) };
    });
}

unsafe extern "system" fn cmd_set_stencil_reference(
    commands: vk::CommandBuffer,
    faces: vk::StencilFaceFlags,
    reference: u32,
) {
    with(|p| {
        let mut used = reference;
        if p.fault == CallFault::StencilReferenceKept {
            let before = p.kept.references.insert(faces.as_raw(), reference);
            used = before.unwrap_or(reference);
        }
        // SAFETY: the caller's.
        unsafe { (p.v10.cmd_set_stencil_reference)(commands, faces, used) };
    });
}

unsafe extern "system" fn cmd_set_blend_constants(
    commands: vk::CommandBuffer,
    constants: *const [f32; 4],
) {
    with(|p| {
        // SAFETY: the caller's.
        let mut used = unsafe { *constants };
        if p.fault == CallFault::BlendConstantKept {
            used = lag(&mut p.kept.constants, used);
        }
        // SAFETY: the caller's.
        unsafe { (p.v10.cmd_set_blend_constants)(commands, &used) };
    });
}

unsafe extern "system" fn cmd_clear_color_image(
    commands: vk::CommandBuffer,
    image: vk::Image,
    layout: vk::ImageLayout,
    color: *const vk::ClearColorValue,
    count: u32,
    ranges: *const vk::ImageSubresourceRange,
) {
    with(|p| {
        // SAFETY: the caller's; every bit pattern is one of integers.
        let bits = unsafe { (*color).uint32 };
        let before = p.cleared.insert(image, bits);
        if p.fault == CallFault::EqualClearSkipped && before == Some(bits) {
            return;
        }
        // SAFETY: the caller's.
        unsafe { (p.v10.cmd_clear_color_image)(commands, image, layout, color, count, ranges) };
    });
}

unsafe extern "system" fn cmd_clear_attachments(
    commands: vk::CommandBuffer,
    count: u32,
    attachments: *const vk::ClearAttachment,
    rects: u32,
    areas: *const vk::ClearRect,
) {
    with(|p| {
        // SAFETY: the backend passes one attachment and one rectangle.
        let (mut attachment, mut area) = unsafe { (*attachments, *areas) };
        let depth = attachment.aspect_mask.contains(vk::ImageAspectFlags::DEPTH);
        match p.fault {
            CallFault::ClearSkipped if p.passes > 1 || p.draws > 0 => return,
            CallFault::ClearRect => area.rect = rect(0, 0, 0, 0),
            CallFault::StencilWithDepth if depth && p.stencil => {
                attachment.aspect_mask |= vk::ImageAspectFlags::STENCIL;
            }
            _ => {}
        }
        if p.fault == CallFault::ClearRect {
            area.rect.extent = p.size;
        }
        // SAFETY: the caller's; the rectangle is the render area, and the pass has stencil.
        unsafe { (p.v10.cmd_clear_attachments)(commands, count, &attachment, rects, &area) };
    });
}

unsafe extern "system" fn cmd_begin_query(
    commands: vk::CommandBuffer,
    pool: vk::QueryPool,
    query: u32,
    flags: vk::QueryControlFlags,
) {
    with(|p| {
        p.queries = if p.no_query { 1 } else { p.queries + 1 };
        p.no_query = false;
        // SAFETY: the caller's; a query that ends here is not ended again.
        unsafe {
            (p.v10.cmd_begin_query)(commands, pool, query, flags);
            if p.fault == CallFault::QueryEarly && p.queries > 1 {
                (p.v10.cmd_end_query)(commands, pool, query);
            }
        }
    });
}

unsafe extern "system" fn cmd_end_query(
    commands: vk::CommandBuffer,
    pool: vk::QueryPool,
    query: u32,
) {
    with(|p| {
        if p.fault == CallFault::QueryEarly && p.queries > 1 {
            return;
        }
        // SAFETY: the caller's.
        unsafe { (p.v10.cmd_end_query)(commands, pool, query) };
    });
}

unsafe extern "system" fn get_query_pool_results(
    device: vk::Device,
    pool: vk::QueryPool,
    first: u32,
    count: u32,
    size: usize,
    data: *mut c_void,
    stride: vk::DeviceSize,
    flags: vk::QueryResultFlags,
) -> vk::Result {
    let call = |p: &mut Planted| {
        let get = p.v10.get_query_pool_results;
        // SAFETY: the caller's.
        let result = unsafe { get(device, pool, first, count, size, data, stride, flags) };
        // Timestamps come in a pool of two and increase, so they are left alone.
        if p.fault == CallFault::QueryFirst && p.queries > 1 && result == vk::Result::SUCCESS {
            let results = data.cast::<u64>();
            for at in 1..p.queries.min(count) as usize {
                // SAFETY: the backend reads results of 64 bits side by side.
                unsafe { *results.add(at) = *results };
            }
        }
        result
    };
    with(call).unwrap_or(vk::Result::ERROR_UNKNOWN)
}

unsafe extern "system" fn cmd_begin_rendering(
    commands: vk::CommandBuffer,
    info: *const vk::RenderingInfo<'_>,
) {
    with(|p| {
        // SAFETY: the caller's.
        let mut info = unsafe { *info };
        p.passes += 1;
        p.draws = 0;
        p.size = info.render_area.extent;
        p.after_read_only = p.read_only;
        // SAFETY: the caller's: the pointers are null or valid, and there are so many colours.
        let (mut depth, mut stencil, mut colors) = unsafe {
            let colors = info.p_color_attachments;
            let colors = (0..info.color_attachment_count as usize).map(|i| *colors.add(i));
            (
                info.p_depth_attachment.as_ref().copied(),
                info.p_stencil_attachment.as_ref().copied(),
                colors.collect::<Vec<_>>(),
            )
        };
        p.stencil = stencil.is_some();
        let read_only = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
        let tested = depth.or(stencil);
        p.read_only = tested.is_some_and(|a| a.image_layout == read_only);
        p.in_render_pass = false;
        let clears = |a: &vk::RenderingAttachmentInfo<'_>| a.load_op == vk::AttachmentLoadOp::CLEAR;
        let load = |a: &mut vk::RenderingAttachmentInfo<'_>| {
            if clears(a) {
                a.load_op = vk::AttachmentLoadOp::LOAD;
            }
        };
        match p.fault {
            CallFault::LoadClears if p.passes > 1 => {
                for color in &mut colors {
                    if color.load_op == vk::AttachmentLoadOp::LOAD {
                        color.load_op = vk::AttachmentLoadOp::CLEAR;
                        color.clear_value = vk::ClearValue::default();
                    }
                }
            }
            CallFault::ClearSkipped if p.passes > 1 => {
                for a in colors.iter_mut().chain(&mut depth).chain(&mut stencil) {
                    if clears(a) {
                        a.load_op = vk::AttachmentLoadOp::LOAD;
                    }
                }
            }
            CallFault::StencilWithDepth => {
                if let (Some(depth), Some(stencil)) = (&depth, &mut stencil)
                    && clears(depth)
                    && !clears(stencil)
                {
                    stencil.load_op = vk::AttachmentLoadOp::CLEAR;
                    stencil.clear_value = vk::ClearValue::default();
                }
            }
            CallFault::ResolveFirst => {
                for color in colors.iter_mut().skip(1) {
                    color.resolve_mode = vk::ResolveModeFlags::NONE;
                }
            }
            CallFault::LoadColorIgnored => colors.iter_mut().for_each(load),
            CallFault::LoadDepthIgnored => depth.iter_mut().for_each(load),
            CallFault::LoadStencilIgnored => stencil.iter_mut().for_each(load),
            CallFault::ResolveSecondDropped => {
                for color in colors.iter_mut().skip(1).take(1) {
                    color.resolve_mode = vk::ResolveModeFlags::NONE;
                }
            }
            CallFault::ResolveSecondFromFirst => {
                if let [first, second, ..] = &mut colors[..]
                    && second.resolve_mode != vk::ResolveModeFlags::NONE
                {
                    first.resolve_image_view = second.resolve_image_view;
                    second.resolve_mode = vk::ResolveModeFlags::NONE;
                }
            }
            _ => {}
        }
        info.p_color_attachments = colors.as_ptr();
        if let Some(depth) = &depth {
            info.p_depth_attachment = depth;
        }
        if let Some(stencil) = &stencil {
            info.p_stencil_attachment = stencil;
        }
        // SAFETY: the caller's; the copies live until the call returns.
        unsafe { (p.v13.cmd_begin_rendering)(commands, &info) };
    });
}

unsafe extern "system" fn cmd_set_depth_compare_op(
    commands: vk::CommandBuffer,
    compare: vk::CompareOp,
) {
    with(|p| {
        let mut used = compare;
        if p.fault == CallFault::CompareKept {
            used = lag(&mut p.kept.compare, compare);
        }
        // SAFETY: the caller's.
        unsafe { (p.v13.cmd_set_depth_compare_op)(commands, used) };
    });
}

unsafe extern "system" fn cmd_set_depth_write_enable(
    commands: vk::CommandBuffer,
    write: vk::Bool32,
) {
    with(|p| {
        let mut used = write;
        if p.fault == CallFault::DepthWriteKept && !p.read_only {
            used = lag(&mut p.kept.write, write);
        }
        // SAFETY: the caller's.
        unsafe { (p.v13.cmd_set_depth_write_enable)(commands, used) };
    });
}

unsafe extern "system" fn cmd_set_cull_mode(commands: vk::CommandBuffer, mode: vk::CullModeFlags) {
    with(|p| {
        let mut used = mode;
        match p.fault {
            CallFault::CullKept => used = lag(&mut p.kept.cull, mode),
            // What the backend leaves in a pipeline whose culling is dynamic.
            CallFault::StaticForDynamic => used = vk::CullModeFlags::NONE,
            _ => {}
        }
        // SAFETY: the caller's.
        unsafe { (p.v13.cmd_set_cull_mode)(commands, used) };
    });
}

unsafe extern "system" fn cmd_set_primitive_topology(
    commands: vk::CommandBuffer,
    topology: vk::PrimitiveTopology,
) {
    with(|p| {
        p.topology = topology;
        // SAFETY: the caller's.
        unsafe { (p.v13.cmd_set_primitive_topology)(commands, topology) };
    });
}

unsafe extern "system" fn create_image_view(
    device: vk::Device,
    info: *const vk::ImageViewCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    view: *mut vk::ImageView,
) -> vk::Result {
    let call = |p: &mut Planted| {
        // SAFETY: the caller's.
        let mut info = unsafe { *info };
        match p.fault {
            CallFault::LayerDropped => info.subresource_range.base_array_layer = 0,
            CallFault::LevelDropped => info.subresource_range.base_mip_level = 0,
            _ => {}
        }
        // SAFETY: the caller's; every image has a first level and layer.
        unsafe { (p.v10.create_image_view)(device, &info, allocator, view) }
    };
    with(call).unwrap_or(vk::Result::ERROR_UNKNOWN)
}

unsafe extern "system" fn create_graphics_pipelines(
    device: vk::Device,
    cache: vk::PipelineCache,
    count: u32,
    infos: *const vk::GraphicsPipelineCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    let call = |p: &mut Planted| {
        // SAFETY: the caller's; the backend makes one pipeline at a time, with this state.
        let (mut info, mut raster) = unsafe { (*infos, *(*infos).p_rasterization_state) };
        if p.fault == CallFault::StaticIgnored {
            raster.cull_mode = vk::CullModeFlags::NONE;
        }
        info.p_rasterization_state = &raster;
        // SAFETY: the caller's; the copies live until the call returns.
        unsafe {
            let create = p.v10.create_graphics_pipelines;
            create(device, cache, count.min(1), &info, allocator, pipelines)
        }
    };
    with(call).unwrap_or(vk::Result::ERROR_UNKNOWN)
}

unsafe extern "system" fn create_render_pass2(
    device: vk::Device,
    info: *const vk::RenderPassCreateInfo2<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    pass: *mut vk::RenderPass,
) -> vk::Result {
    let call = |p: &mut Planted| {
        // SAFETY: the caller's: there are so many attachments.
        let (mut info, mut attachments) = unsafe {
            let all = (*info).p_attachments;
            let count = (*info).attachment_count as usize;
            (*info, (0..count).map(|i| *all.add(i)).collect::<Vec<_>>())
        };
        let load = |operation: &mut vk::AttachmentLoadOp| {
            if *operation == vk::AttachmentLoadOp::CLEAR {
                *operation = vk::AttachmentLoadOp::LOAD;
            }
        };
        for attachment in &mut attachments {
            let tested = attachment.final_layout != vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
            match p.fault {
                CallFault::LoadColorIgnored if !tested => load(&mut attachment.load_op),
                CallFault::LoadDepthIgnored if tested => load(&mut attachment.load_op),
                CallFault::LoadStencilIgnored => load(&mut attachment.stencil_load_op),
                _ => {}
            }
        }
        info.p_attachments = attachments.as_ptr();
        // SAFETY: the caller's; the copies live until the call returns.
        unsafe { (p.v12.create_render_pass2)(device, &info, allocator, pass) }
    };
    with(call).unwrap_or(vk::Result::ERROR_UNKNOWN)
}

unsafe extern "system" fn cmd_begin_render_pass(
    commands: vk::CommandBuffer,
    info: *const vk::RenderPassBeginInfo<'_>,
    contents: vk::SubpassContents,
) {
    with(|p| {
        p.passes += 1;
        p.draws = 0;
        p.in_render_pass = true;
        // SAFETY: the caller's.
        unsafe {
            p.size = (*info).render_area.extent;
            (p.v10.cmd_begin_render_pass)(commands, info, contents);
        }
    });
}

unsafe extern "system" fn cmd_blit_image(
    commands: vk::CommandBuffer,
    source: vk::Image,
    source_layout: vk::ImageLayout,
    target: vk::Image,
    target_layout: vk::ImageLayout,
    count: u32,
    regions: *const vk::ImageBlit,
    filter: vk::Filter,
) {
    with(|p| {
        // SAFETY: the caller's; the backend passes one region.
        let mut region = unsafe { *regions };
        if p.fault == CallFault::BlitColumn {
            region.src_offsets[1].x -= 1;
            region.dst_offsets[1].x -= 1;
        }
        // SAFETY: the caller's; the region is no larger.
        unsafe {
            let blit = p.v10.cmd_blit_image;
            let (from, to) = (source_layout, target_layout);
            blit(commands, source, from, target, to, count, &region, filter);
        }
    });
}
