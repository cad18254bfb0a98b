//! A device function table with a planted fault, for tests of the suite.
//!
//! The functions of the table have the driver's signatures, and cannot carry a state of their own. The
//! driver's table and the observed calls are therefore kept per thread: a backend belongs to one thread.

use crate::device::Device;
use crate::spirv::{BUILT_IN, DECORATE, LOCATION};
use crate::viewport::LAYER;
use ash::ext::extended_dynamic_state3;
use ash::vk::{self, Handle};
use etalon_backend::{CallFault, DrawNumbers, Fault, FaultyCalls, OpenQuery};
use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::c_void;
use std::process::abort;
use std::{mem, ptr, slice};

thread_local! {
    static PLANTED: RefCell<Option<Planted>> = const { RefCell::new(None) };
}

/// Returns the values at an address, or none if it is null.
///
/// # Safety
/// The address is null, or points to `count` values.
unsafe fn values<T: Copy>(address: *const T, count: u32) -> Vec<T> {
    if address.is_null() {
        return Vec::new();
    }
    // SAFETY: upheld by the caller.
    unsafe { slice::from_raw_parts(address, count as usize) }.to_vec()
}

/// The functions of a device.
#[derive(Clone)]
struct Functions {
    v10: ash::DeviceFnV1_0,
    v12: ash::DeviceFnV1_2,
    v13: ash::DeviceFnV1_3,
    ext3: extended_dynamic_state3::DeviceFn,
}

/// The driver's functions, and what was observed of the commands since recording began.
struct Planted {
    driver: Functions,
    calls: FaultyCalls,
    /// True before the first draw after a read-only pass.
    after_read_only: bool,
    /// True if the pass is read-only.
    read_only: bool,
    /// True within a pass.
    in_pass: bool,
    /// True if the pass is a render pass object.
    in_render_pass: bool,
    /// True if the pass has a stencil attachment.
    stencil: bool,
    /// True before the first clear in a pass whose load operation leaves contents undefined.
    undefined: bool,
    /// True after a clear command of the pass.
    cleared: bool,
    /// True before the first draw of a secondary command buffer.
    secondary: bool,
    topology: vk::PrimitiveTopology,
    /// True if primitive restart is enabled.
    restarts: bool,
    /// True if the pass has a depth attachment.
    depth: bool,
    /// True if the depth test is enabled.
    tests_depth: bool,
    /// The sample mask that was set last, and its sample count.
    mask: Option<(vk::SampleCountFlags, vk::SampleMask)>,
    /// The cull mode that was set last.
    cull: Option<vk::CullModeFlags>,
    /// The formats of images.
    formats: HashMap<vk::Image, vk::Format>,
}

/// Puts a fault of calls into the function table of a device.
pub(crate) fn plant(mut device: Device, fault: Option<Fault>) -> Device {
    let Some(Fault::Call(fault)) = fault else {
        return device;
    };
    let raw = &device.raw;
    let extended = device.extended.clone();
    let driver = Functions {
        v10: raw.fp_v1_0().clone(),
        v12: raw.fp_v1_2().clone(),
        v13: raw.fp_v1_3().clone(),
        // The functions of a missing extension are not loaded.
        ext3: extended.unwrap_or_else(|| extended_dynamic_state3::DeviceFn::load(|_| ptr::null())),
    };
    let mut functions = driver.clone();
    replace(&mut functions);
    let mut calls = FaultyCalls::default();
    (calls.fault, calls.scissor_on) = (Some(fault), true);
    PLANTED.set(Some(Planted {
        driver,
        calls,
        after_read_only: false,
        read_only: false,
        in_pass: false,
        in_render_pass: false,
        stencil: false,
        undefined: false,
        cleared: false,
        secondary: false,
        topology: vk::PrimitiveTopology::TRIANGLE_LIST,
        restarts: false,
        depth: false,
        tests_depth: false,
        mask: None,
        cull: None,
        formats: HashMap::new(),
    }));
    if let Some(extended) = &mut device.extended {
        *extended = functions.ext3;
    }
    device.raw = ash::Device::from_parts_1_3(
        device.raw.handle(),
        functions.v10,
        device.raw.fp_v1_1().clone(),
        functions.v12,
        functions.v13,
    );
    device
}

fn with<R>(call: impl FnOnce(&mut Planted) -> R) -> R {
    // The functions of the table are called on the thread of the backend.
    PLANTED.with_borrow_mut(|planted| planted.as_mut().map_or_else(|| abort(), call))
}

/// Declares the functions that replace the driver's. Each does something `before` it calls the driver's
/// function with the arguments that result, or something `instead`. Arrays in brackets are copied first; the
/// expression gives the length.
macro_rules! functions {
    ($(
        $how:ident $version:ident $name:ident($($arg:ident: $kind:ty),*) $(-> $result:ty)?
        $([$array:ident; $length:expr])* |$planted:ident| { $($body:tt)* }
    )+) => {
        /// Replaces the driver's functions.
        fn replace(functions: &mut Functions) {
            $(functions.$version.$name = faulty::$name;)+
        }

        mod faulty {
            #![expect(unused_mut, reason = "not every function changes each of its arguments")]

            use super::*;

            $(
                pub(super) unsafe extern "system" fn $name($(mut $arg: $kind),*) $(-> $result)? {
                    with(|$planted| {
                        // SAFETY: upheld by the caller: the specification, or the backend's use, gives the
                        // length.
                        $(let mut $array = unsafe { values($array, $length) };)*
                        functions!(@$how { $($body)* } {
                            $(let $array = $array.as_ptr();)*
                            // SAFETY: the function has the type of the driver's function of its name. Its
                            // arguments are passed on unchanged, or made from valid ones.
                            unsafe { ($planted.driver.$version.$name)($($arg),*) }
                        })
                    })
                }
            )+
        }
    };
    (@before { $($body:tt)* } { $($call:tt)* }) => {{ $($body)* $($call)* }};
    (@instead { $($body:tt)* } { $($call:tt)* }) => {{ $($body)* }};
}

functions! {
    before v10 begin_command_buffer(
        commands: vk::CommandBuffer, infos: *const vk::CommandBufferBeginInfo<'_>
    ) -> vk::Result [infos; 1] |planted| {
        planted.secondary = infos[0].flags.contains(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE);
        if !planted.secondary {
            planted.calls.end_submission();
            (planted.after_read_only, planted.read_only, planted.in_render_pass) = (false, false, false);
        }
    }
    instead v10 cmd_draw(
        commands: vk::CommandBuffer, count: u32, instances: u32, first: u32, first_instance: u32
    ) |planted| {
        let (count, instances) = (count.cast_signed(), instances.cast_signed());
        let numbers = DrawNumbers { count, instances, first_instance, ..DrawNumbers::default() };
        planted.draw(commands, numbers, |driver, numbers| {
            let (count, instances) = (numbers.count.cast_unsigned(), numbers.instances.cast_unsigned());
            // SAFETY: upheld by the caller; no more is drawn than requested.
            unsafe { (driver.v10.cmd_draw)(commands, count, instances, first, numbers.first_instance) };
        });
    }
    instead v10 cmd_draw_indexed(
        commands: vk::CommandBuffer, count: u32, instances: u32, first: u32, base_vertex: i32, first_instance: u32
    ) |planted| {
        let [count, instances, first] = [count, instances, first].map(u32::cast_signed);
        let numbers = DrawNumbers { indexed: true, count, instances, first, base_vertex, first_instance, thin: false };
        planted.draw(commands, numbers, |driver, numbers| {
            let counts = [numbers.count, numbers.instances, numbers.first];
            let [count, instances, first] = counts.map(i32::cast_unsigned);
            let (base_vertex, first_instance) = (numbers.base_vertex, numbers.first_instance);
            // SAFETY: as above.
            unsafe {
                (driver.v10.cmd_draw_indexed)(commands, count, instances, first, base_vertex, first_instance);
            }
        });
    }
    before v10 cmd_execute_commands(
        commands: vk::CommandBuffer, count: u32, buffers: *const vk::CommandBuffer
    ) |planted| {
        if planted.calls.has(CallFault::SecondarySecond) {
            count = count.min(1);
        }
    }
    instead v12 cmd_draw_indirect_count(
        commands: vk::CommandBuffer, buffer: vk::Buffer, offset: vk::DeviceSize, count_buffer: vk::Buffer,
        count_offset: vk::DeviceSize, most: u32, stride: u32
    ) |planted| {
        // SAFETY: upheld by the caller; there are arguments for `most` draws.
        unsafe {
            if planted.calls.has(CallFault::IndirectFewer) {
                // Draws nothing. The backend's number is 1.
            } else if planted.calls.has(CallFault::IndirectMost) {
                (planted.driver.v10.cmd_draw_indirect)(commands, buffer, offset, most, stride);
            } else {
                (planted.driver.v12.cmd_draw_indirect_count)(
                    commands, buffer, offset, count_buffer, count_offset, most, stride
                );
            }
        }
    }
    before v10 cmd_set_scissor(
        commands: vk::CommandBuffer, first: u32, count: u32, scissors: *const vk::Rect2D
    ) [scissors; count] |planted| {
        if let [first, second] = &mut scissors[..]
            && planted.calls.has(CallFault::ScissorFirst)
            && planted.cleared
        {
            *second = *first;
        }
        if let [scissor] = &mut scissors[..] {
            let vk::Rect2D { offset: vk::Offset2D { x, y }, extent: vk::Extent2D { width, height } } = *scissor;
            let limit = planted.calls.area[2];
            let set = planted.calls.set_scissor([x, y, width.cast_signed(), height.cast_signed()], limit);
            *scissor = rectangle(set);
        }
    }
    before v10 cmd_set_viewport(
        commands: vk::CommandBuffer, first: u32, count: u32, viewports: *const vk::Viewport
    ) [viewports; count] |planted| {
        match &mut viewports[..] {
            [viewport] => *viewport = planted.calls.kept(CallFault::ViewportKept, 0, *viewport),
            [first, second] if planted.calls.has(CallFault::ViewportFirst) => *second = *first,
            _ => {}
        }
    }
    before v10 cmd_set_stencil_reference(
        commands: vk::CommandBuffer, faces: vk::StencilFaceFlags, reference: u32
    ) |planted| {
        reference = planted.calls.kept(CallFault::StencilReferenceKept, faces.as_raw(), reference);
    }
    before v10 cmd_set_blend_constants(
        commands: vk::CommandBuffer, constants: *const [f32; 4]
    ) [constants; 1] |planted| {
        constants[0] = planted.calls.kept(CallFault::BlendConstantKept, 0, constants[0]);
    }
    before v10 cmd_clear_color_image(
        commands: vk::CommandBuffer, image: vk::Image, layout: vk::ImageLayout, colors: *const vk::ClearColorValue,
        count: u32, ranges: *const vk::ImageSubresourceRange
    ) [colors; 1] |planted| {
        if planted.calls.has(CallFault::ClearFirstRange) {
            count = count.min(1);
        }
        // SAFETY: every bit pattern is a valid integer.
        let color = unsafe { colors[0].uint32 };
        if planted.calls.skips_equal_clear(image.as_raw(), color) {
            return;
        }
    }
    before v10 cmd_clear_attachments(
        commands: vk::CommandBuffer, count: u32, attachments: *const vk::ClearAttachment, rectangles: u32,
        areas: *const vk::ClearRect
    ) [attachments; count] [areas; rectangles] |planted| {
        let undefined = mem::take(&mut planted.undefined);
        planted.cleared = true;
        let calls = &planted.calls;
        if calls.has(CallFault::ClearForgets) {
            // SAFETY: the caller's commands are being recorded.
            unsafe {
                (planted.driver.v10.cmd_set_blend_constants)(commands, &[0.0; 4]);
                let faces = vk::StencilFaceFlags::FRONT_AND_BACK;
                (planted.driver.v10.cmd_set_stencil_reference)(commands, faces, 0);
            }
        }
        if calls.has(CallFault::ClearFirstLayer) {
            areas.iter_mut().for_each(|area| area.layer_count = 1);
        }
        if calls.has(CallFault::ClearSkipped) && (calls.passes > 1 || calls.draws > 0) {
            return;
        }
        if calls.has(CallFault::ClearUndefinedSkipped) && undefined {
            return;
        }
        if calls.has(CallFault::ClearFirstRect) {
            rectangles = rectangles.min(1);
        }
        if calls.has(CallFault::ClearFirstOfCall) {
            count = count.min(1);
        }
        if calls.has(CallFault::ClearRect) {
            areas.iter_mut().for_each(|area| area.rect = rectangle(calls.area));
        }
        if calls.has(CallFault::StencilWithDepth) && planted.stencil {
            for attachment in &mut attachments {
                if attachment.aspect_mask.contains(vk::ImageAspectFlags::DEPTH) {
                    attachment.aspect_mask |= vk::ImageAspectFlags::STENCIL;
                }
            }
        }
    }
    instead v10 cmd_begin_query(
        commands: vk::CommandBuffer, pool: vk::QueryPool, query: u32, flags: vk::QueryControlFlags
    ) |planted| {
        planted.calls.begin_query(query);
        planted.calls.open_query(pool.as_raw(), query, planted.in_pass);
        // SAFETY: upheld by the caller; a query that ends here is not ended again.
        unsafe {
            (planted.driver.v10.cmd_begin_query)(commands, pool, query, flags);
            if planted.calls.ends_query_early() {
                (planted.driver.v10.cmd_end_query)(commands, pool, query);
            }
        }
    }
    before v10 cmd_end_query(commands: vk::CommandBuffer, pool: vk::QueryPool, query: u32) |planted| {
        let ended = planted.calls.close_query(pool.as_raw(), Some(query));
        if ended || planted.calls.ends_query_early() {
            return;
        }
    }
    instead v13 cmd_end_rendering(commands: vk::CommandBuffer) |planted| {
        // SAFETY: upheld by the caller.
        unsafe { (planted.driver.v13.cmd_end_rendering)(commands) };
        planted.end_pass(commands);
    }
    instead v10 cmd_end_render_pass(commands: vk::CommandBuffer) |planted| {
        // SAFETY: as above.
        unsafe { (planted.driver.v10.cmd_end_render_pass)(commands) };
        planted.end_pass(commands);
    }
    instead v10 get_query_pool_results(
        device: vk::Device, pool: vk::QueryPool, first: u32, count: u32, size: usize, data: *mut c_void,
        stride: vk::DeviceSize, flags: vk::QueryResultFlags
    ) -> vk::Result |planted| {
        let get = planted.driver.v10.get_query_pool_results;
        // SAFETY: upheld by the caller.
        let result = unsafe { get(device, pool, first, count, size, data, stride, flags) };
        if planted.calls.has(CallFault::QueryFirst) && result == vk::Result::SUCCESS {
            let queries = planted.calls.queries.len().min(count as usize);
            // SAFETY: the backend reads 64-bit results without gaps.
            let results = unsafe { slice::from_raw_parts_mut(data.cast::<u64>(), queries) };
            // Timestamps come in a pool of two and increase, so this leaves them alone.
            if let [first, others @ ..] = results {
                others.fill(*first);
            }
        }
        if result == vk::Result::SUCCESS && planted.calls.has(CallFault::ResultOnce) {
            // SAFETY: as above.
            let results = unsafe { slice::from_raw_parts_mut(data.cast::<u64>(), count as usize) };
            for (query, result) in (first..).zip(results) {
                *result = planted.calls.result(pool.as_raw(), query, *result);
            }
        }
        result
    }
    before v13 cmd_begin_rendering(
        commands: vk::CommandBuffer, infos: *const vk::RenderingInfo<'_>
    ) [infos; 1] |planted| {
        let info = &mut infos[0];
        planted.in_pass = true;
        planted.calls.begin_pass();
        if planted.calls.has(CallFault::AreaEven) {
            let offset = &mut info.render_area.offset;
            (offset.x, offset.y) = (offset.x & !1, offset.y & !1);
        }
        planted.calls.area = area(info.render_area);
        // SAFETY: upheld by the caller: the pointers are null or valid, and `color_attachment_count` is the
        // number of colours.
        let (mut depth, mut stencil, mut colors) = unsafe {
            (
                values(info.p_depth_attachment, 1),
                values(info.p_stencil_attachment, 1),
                values(info.p_color_attachments, info.color_attachment_count),
            )
        };
        let read_only = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
        planted.after_read_only = planted.read_only;
        planted.read_only = depth.iter().chain(&stencil).any(|tested| tested.image_layout == read_only);
        (planted.depth, planted.stencil) = (!depth.is_empty(), !stencil.is_empty());
        let is_undefined =
            |attachment: &Attachment<'_>| attachment.load_op == vk::AttachmentLoadOp::DONT_CARE;
        planted.undefined = colors.iter().chain(&depth).chain(&stencil).any(is_undefined);
        if planted.calls.has(CallFault::StateForgotten) {
            // SAFETY: the caller's commands are being recorded.
            unsafe {
                let faces = vk::StencilFaceFlags::FRONT_AND_BACK;
                (planted.driver.v10.cmd_set_stencil_write_mask)(commands, faces, 0xff);
                (planted.driver.v13.cmd_set_cull_mode)(commands, vk::CullModeFlags::NONE);
            }
        }
        planted.in_render_pass = false;
        planted.cleared = false;
        if planted.calls.has(CallFault::ViewFirst) {
            info.view_mask = first_view(info.view_mask);
        }
        planted.change_attachments(&mut colors, &mut depth, &mut stencil);
        info.p_color_attachments = address(&colors);
        info.p_depth_attachment = address(&depth);
        info.p_stencil_attachment = address(&stencil);
    }
    before v13 cmd_set_depth_compare_op(commands: vk::CommandBuffer, compare: vk::CompareOp) |planted| {
        compare = planted.calls.kept(CallFault::CompareKept, 0, compare);
    }
    before v13 cmd_set_depth_write_enable(commands: vk::CommandBuffer, write: vk::Bool32) |planted| {
        if !planted.read_only {
            write = planted.calls.kept(CallFault::DepthWriteKept, 0, write);
        }
    }
    before v13 cmd_set_cull_mode(commands: vk::CommandBuffer, mode: vk::CullModeFlags) |planted| {
        mode = planted.calls.kept(CallFault::CullKept, 0, mode);
        let same = planted.cull.replace(mode) == Some(mode);
        if same && planted.calls.has(CallFault::DynamicSkipped) {
            return;
        }
        // The value that the backend gives a pipeline whose culling is dynamic.
        if planted.calls.has(CallFault::StaticForDynamic) {
            mode = vk::CullModeFlags::NONE;
        }
    }
    before v13 cmd_set_rasterizer_discard_enable(commands: vk::CommandBuffer, discard: vk::Bool32) |planted| {
        discard = planted.calls.kept(CallFault::DiscardKept, 0, discard);
    }
    before ext3 cmd_set_alpha_to_coverage_enable_ext(commands: vk::CommandBuffer, covers: vk::Bool32) |planted| {
        covers = planted.calls.kept(CallFault::CoverageKept, 0, covers);
    }
    before ext3 cmd_set_sample_mask_ext(
        commands: vk::CommandBuffer, samples: vk::SampleCountFlags, masks: *const vk::SampleMask
    ) [masks; 1] |planted| {
        masks[0] = planted.calls.kept(CallFault::SampleMaskKept, 0, masks[0]);
        planted.mask = Some((samples, masks[0]));
    }
    before ext3 cmd_set_polygon_mode_ext(commands: vk::CommandBuffer, mode: vk::PolygonMode) |planted| {
        mode = planted.calls.kept(CallFault::PolygonModeKept, 0, mode);
    }
    before ext3 cmd_set_depth_clamp_enable_ext(commands: vk::CommandBuffer, clamp: vk::Bool32) |planted| {
        clamp = planted.calls.kept(CallFault::DepthClampKept, 0, clamp);
    }
    before v13 cmd_set_primitive_restart_enable(commands: vk::CommandBuffer, restarts: vk::Bool32) |planted| {
        planted.restarts = restarts != vk::FALSE;
    }
    before v13 cmd_set_depth_test_enable(commands: vk::CommandBuffer, tests: vk::Bool32) |planted| {
        planted.tests_depth = tests != vk::FALSE;
    }
    instead v10 cmd_bind_pipeline(
        commands: vk::CommandBuffer, point: vk::PipelineBindPoint, pipeline: vk::Pipeline
    ) |planted| {
        // SAFETY: upheld by the caller.
        unsafe { (planted.driver.v10.cmd_bind_pipeline)(commands, point, pipeline) };
        if let (true, Some((samples, mask))) = (planted.calls.has(CallFault::SetBeforeBind), planted.mask) {
            // SAFETY: as above; the mask was set earlier. The backend gives the pipeline the opposite mask.
            unsafe { (planted.driver.ext3.cmd_set_sample_mask_ext)(commands, samples, &!mask) };
        }
    }
    before v13 cmd_set_primitive_topology(
        commands: vk::CommandBuffer, topology: vk::PrimitiveTopology
    ) |planted| {
        planted.topology = topology;
    }
    instead v10 create_image(
        device: vk::Device, infos: *const vk::ImageCreateInfo<'_>, allocator: *const vk::AllocationCallbacks<'_>,
        image: *mut vk::Image
    ) -> vk::Result [infos; 1] |planted| {
        // SAFETY: upheld by the caller.
        let result = unsafe { (planted.driver.v10.create_image)(device, infos.as_ptr(), allocator, image) };
        if result == vk::Result::SUCCESS {
            // SAFETY: the driver wrote the image.
            planted.formats.insert(unsafe { *image }, infos[0].format);
        }
        result
    }
    before v10 create_image_view(
        device: vk::Device, infos: *const vk::ImageViewCreateInfo<'_>,
        allocator: *const vk::AllocationCallbacks<'_>, view: *mut vk::ImageView
    ) -> vk::Result [infos; 1] |planted| {
        // Every image has a first level and layer.
        let range = &mut infos[0].subresource_range;
        if planted.calls.has(CallFault::LayerDropped) {
            range.base_array_layer = 0;
        }
        if planted.calls.has(CallFault::LayerOfLevelDropped) && range.base_mip_level > 0 {
            range.base_array_layer = 0;
        }
        if planted.calls.has(CallFault::LevelDropped) {
            range.base_mip_level = 0;
        }
        if planted.calls.has(CallFault::ViewFormat) {
            let format = planted.formats.get(&infos[0].image);
            infos[0].format = format.copied().unwrap_or(infos[0].format);
        }
    }
    before v10 create_graphics_pipelines(
        device: vk::Device, cache: vk::PipelineCache, count: u32, infos: *const vk::GraphicsPipelineCreateInfo<'_>,
        allocator: *const vk::AllocationCallbacks<'_>, pipelines: *mut vk::Pipeline
    ) -> vk::Result [infos; 1] |planted| {
        // SAFETY: upheld by the caller; the backend makes one pipeline at a time, with this state.
        let mut rasterization = unsafe { *infos[0].p_rasterization_state };
        if planted.calls.has(CallFault::StaticIgnored) {
            rasterization.cull_mode = vk::CullModeFlags::NONE;
        }
        infos[0].p_rasterization_state = &rasterization;
        let chained = infos[0].p_next.cast::<vk::PipelineRenderingCreateInfo<'_>>();
        // SAFETY: upheld by the caller; the first structure of a chain, if any, begins with its type.
        let first = unsafe { values(chained.cast::<vk::StructureType>(), 1) };
        let rendering = vk::StructureType::PIPELINE_RENDERING_CREATE_INFO;
        let chains = planted.calls.has(CallFault::ViewFirst) && first.contains(&rendering);
        // SAFETY: the structure is of this type.
        let mut rendered = if chains { unsafe { values(chained, 1) } } else { Vec::new() };
        for rendering in &mut rendered {
            rendering.view_mask = first_view(rendering.view_mask);
            infos[0].p_next = ptr::from_ref(rendering).cast();
        }
    }
    before v10 create_shader_module(
        device: vk::Device, infos: *const vk::ShaderModuleCreateInfo<'_>,
        allocator: *const vk::AllocationCallbacks<'_>, module: *mut vk::ShaderModule
    ) -> vk::Result [infos; 1] |planted| {
        // SAFETY: upheld by the caller: `code_size` is the number of bytes.
        let mut words = unsafe { values(infos[0].p_code, (infos[0].code_size / 4) as u32) };
        if planted.calls.has(CallFault::LayerUnwritten) {
            let mut start = 5;
            while let Some(head) = words.get(start).copied() {
                if head & 0xffff == DECORATE && words[start + 2..start + 4] == [BUILT_IN, LAYER] {
                    // An output that nothing reads.
                    words[start + 2..start + 4].copy_from_slice(&[LOCATION, 15]);
                }
                start += (head >> 16).max(1) as usize;
            }
        }
        infos[0].p_code = words.as_ptr();
    }
    before v12 create_render_pass2(
        device: vk::Device, infos: *const vk::RenderPassCreateInfo2<'_>,
        allocator: *const vk::AllocationCallbacks<'_>, pass: *mut vk::RenderPass
    ) -> vk::Result [infos; 1] |planted| {
        // SAFETY: upheld by the caller: `attachment_count` is the number of attachments.
        let mut attachments = unsafe { values(infos[0].p_attachments, infos[0].attachment_count) };
        for attachment in &mut attachments {
            let color = attachment.final_layout == vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
            match planted.calls.fault {
                Some(CallFault::LoadColorIgnored) if color => load(&mut attachment.load_op),
                Some(CallFault::LoadDepthIgnored) if !color => load(&mut attachment.load_op),
                Some(CallFault::LoadStencilIgnored) => load(&mut attachment.stencil_load_op),
                _ => {}
            }
        }
        infos[0].p_attachments = address(&attachments);
        // SAFETY: as above.
        let mut subpasses = unsafe { values(infos[0].p_subpasses, infos[0].subpass_count) };
        if planted.calls.has(CallFault::ViewFirst) {
            let masks = subpasses.iter_mut().map(|subpass| &mut subpass.view_mask);
            masks.for_each(|mask| *mask = first_view(*mask));
        }
        infos[0].p_subpasses = address(&subpasses);
    }
    before v10 cmd_begin_render_pass(
        commands: vk::CommandBuffer, infos: *const vk::RenderPassBeginInfo<'_>, contents: vk::SubpassContents
    ) [infos; 1] |planted| {
        planted.calls.begin_pass();
        planted.calls.area = area(infos[0].render_area);
        (planted.in_pass, planted.in_render_pass) = (true, true);
        // This call does not show which attachments the object has.
        planted.depth = true;
        planted.cleared = false;
    }
    before v10 cmd_resolve_image(
        commands: vk::CommandBuffer, source: vk::Image, source_layout: vk::ImageLayout, target: vk::Image,
        target_layout: vk::ImageLayout, count: u32, regions: *const vk::ImageResolve
    ) [regions; count] |planted| {
        if planted.calls.has(CallFault::ResolvePlace) {
            for vk::ImageResolve { src_offset, dst_offset, .. } in &mut regions {
                (dst_offset.x, dst_offset.y) = (src_offset.x, src_offset.y);
            }
        }
    }
    before v10 cmd_blit_image(
        commands: vk::CommandBuffer, source: vk::Image, source_layout: vk::ImageLayout, target: vk::Image,
        target_layout: vk::ImageLayout, count: u32, regions: *const vk::ImageBlit, filter: vk::Filter
    ) [regions; count] |planted| {
        if planted.calls.has(CallFault::BlitColumn) {
            for region in &mut regions {
                region.src_offsets[1].x -= 1;
                region.dst_offsets[1].x -= 1;
            }
        }
        if planted.calls.has(CallFault::BlitFirstRegion) {
            count = count.min(1);
        }
        if planted.calls.has(CallFault::BlitFilter) {
            filter = vk::Filter::NEAREST;
        }
        for region in &mut regions {
            let vk::ImageBlit { src_offsets: from, dst_offsets: to, .. } = region;
            match planted.calls.fault {
                Some(CallFault::BlitMirror) => {
                    for corners in [from, to] {
                        let [first, second] = *corners;
                        corners[0].x = first.x.min(second.x);
                        corners[0].y = first.y.min(second.y);
                        corners[1].x = first.x.max(second.x);
                        corners[1].y = first.y.max(second.y);
                    }
                }
                Some(CallFault::BlitScale) => {
                    to[1].x = to[0].x + from[1].x - from[0].x;
                    to[1].y = to[0].y + from[1].y - from[0].y;
                }
                Some(CallFault::BlitPlace) => {
                    (to[1].x, to[1].y) = (to[1].x - to[0].x, to[1].y - to[0].y);
                    (to[0].x, to[0].y) = (0, 0);
                }
                _ => {}
            }
        }
    }
}

/// Returns the mask of the first view in a mask of views.
fn first_view(views: u32) -> u32 {
    views & views.wrapping_neg()
}

/// Returns the rectangle with this x, y, width and height.
fn rectangle([x, y, width, height]: [i32; 4]) -> vk::Rect2D {
    vk::Rect2D {
        offset: vk::Offset2D { x, y },
        extent: vk::Extent2D {
            width: width.cast_unsigned(),
            height: height.cast_unsigned(),
        },
    }
}

/// Returns the area of a pass from the origin on, with the extent of a rectangle.
fn area(rectangle: vk::Rect2D) -> [i32; 4] {
    let vk::Extent2D { width, height } = rectangle.extent;
    [0, 0, width.cast_signed(), height.cast_signed()]
}

/// Replaces a load operation that clears by one that loads.
fn load(operation: &mut vk::AttachmentLoadOp) {
    if *operation == vk::AttachmentLoadOp::CLEAR {
        *operation = vk::AttachmentLoadOp::LOAD;
    }
}

type Attachment<'a> = vk::RenderingAttachmentInfo<'a>;

/// Makes a load operation clear to zeros.
fn clear(attachment: &mut Attachment<'_>) {
    attachment.load_op = vk::AttachmentLoadOp::CLEAR;
    attachment.clear_value = vk::ClearValue::default();
}

/// Returns the address of values, or null if the slice is empty.
fn address<T>(values: &[T]) -> *const T {
    values.first().map_or(ptr::null(), ptr::from_ref)
}

impl Planted {
    /// Draws with the numbers that the fault leaves, in parts if the fault asks for it.
    fn draw(
        &mut self,
        commands: vk::CommandBuffer,
        mut numbers: DrawNumbers,
        draw: impl Fn(&Functions, &DrawNumbers),
    ) {
        let lost = match self.calls.fault {
            Some(CallFault::StoreDropped) => self.in_render_pass,
            Some(CallFault::SecondaryFirstDraw) => mem::take(&mut self.secondary),
            Some(CallFault::AfterReadOnly) => mem::take(&mut self.after_read_only),
            Some(CallFault::TestUnattached) => self.tests_depth && !self.depth,
            _ => false,
        };
        if lost {
            return;
        }
        let thin = [
            vk::PrimitiveTopology::POINT_LIST,
            vk::PrimitiveTopology::LINE_LIST,
            vk::PrimitiveTopology::LINE_STRIP,
        ];
        numbers.thin = thin.contains(&self.topology);
        if self.calls.has(CallFault::RestartUnindexed) && self.restarts && !numbers.indexed {
            numbers.count -= 1;
        }
        let driver = &self.driver;
        let set_scissor = |part| {
            // SAFETY: the caller's commands are being recorded; the scissor is dynamic in every pipeline.
            unsafe { (driver.v10.cmd_set_scissor)(commands, 0, 1, &rectangle(part)) };
        };
        let draw = |numbers: &DrawNumbers| draw(driver, numbers);
        self.calls.draw(numbers, set_scissor, draw);
        let ended = self.calls.queries_after_draw();
        self.end_queries(commands, &ended);
    }

    /// Records that a pass has ended.
    fn end_pass(&mut self, commands: vk::CommandBuffer) {
        self.in_pass = false;
        let ended = self.calls.queries_after_pass();
        self.end_queries(commands, &ended);
    }

    /// Ends the queries that the fault ends early.
    fn end_queries(&self, commands: vk::CommandBuffer, queries: &[OpenQuery]) {
        for open in queries {
            let pool = vk::QueryPool::from_raw(open.owner);
            // SAFETY: the query has begun, inside or outside a pass as here, and is not ended again.
            unsafe { (self.driver.v10.cmd_end_query)(commands, pool, open.query) };
        }
    }

    /// Changes the attachments of a pass as the fault asks.
    fn change_attachments<'a>(
        &self,
        colors: &mut [Attachment<'a>],
        depth: &mut [Attachment<'a>],
        stencil: &mut [Attachment<'a>],
    ) {
        let is_later = self.calls.passes > 1;
        let load = |attachment: &mut Attachment<'_>| load(&mut attachment.load_op);
        let drop_resolve =
            |color: &mut Attachment<'_>| color.resolve_mode = vk::ResolveModeFlags::NONE;
        match self.calls.fault {
            Some(CallFault::LoadClears) if is_later => {
                let loaded =
                    |color: &&mut Attachment<'_>| color.load_op == vk::AttachmentLoadOp::LOAD;
                colors.iter_mut().filter(loaded).for_each(clear);
            }
            Some(CallFault::ClearSkipped) if is_later => {
                colors.iter_mut().chain(depth).chain(stencil).for_each(load);
            }
            Some(CallFault::ClearFirstTarget) => colors.iter_mut().skip(1).for_each(load),
            Some(CallFault::LoadColorIgnored) => colors.iter_mut().for_each(load),
            Some(CallFault::LoadDepthIgnored) => depth.iter_mut().for_each(load),
            Some(CallFault::LoadStencilIgnored) => stencil.iter_mut().for_each(load),
            Some(CallFault::StencilWithDepth)
                if depth
                    .iter()
                    .any(|depth| depth.load_op == vk::AttachmentLoadOp::CLEAR) =>
            {
                let kept =
                    |stencil: &&mut Attachment<'_>| stencil.load_op != vk::AttachmentLoadOp::CLEAR;
                stencil.iter_mut().filter(kept).for_each(clear);
            }
            Some(CallFault::GapEnds) => {
                let is_attached =
                    |color: &&mut Attachment<'_>| color.image_view != vk::ImageView::null();
                for color in colors.iter_mut().skip_while(is_attached) {
                    color.image_view = vk::ImageView::null();
                }
            }
            Some(CallFault::ResolveFirst) => colors.iter_mut().skip(1).for_each(drop_resolve),
            Some(CallFault::ResolveSecondDropped) => {
                colors.iter_mut().skip(1).take(1).for_each(drop_resolve);
            }
            Some(CallFault::ResolveSecondFromFirst) => {
                if let [first, second, ..] = colors
                    && second.resolve_mode != vk::ResolveModeFlags::NONE
                {
                    first.resolve_image_view = second.resolve_image_view;
                    drop_resolve(second);
                }
            }
            _ => {}
        }
    }
}
