//! The functions that record.

use super::layout::{Layout, constant};
use super::layouts;
use super::recorder::{driver, flags_of, keep, new_output};
use Argument::Null;
use ash::vk::{self, Handle};
use etalon_backend::Argument;
use std::ffi::c_void;

/// True if a function only asks about the device, waits for all of it, or destroys: it stays the driver's own.
pub(super) fn only_asks(name: &str) -> bool {
    ["vkGet", "vkDestroy", "vkFree", "vkDeviceWaitIdle"]
        .iter()
        .any(|start| name.starts_with(start))
}

/// A value that says all by itself.
trait Plain {
    fn argument(self) -> Argument;
}

macro_rules! plain {
    ($($kind:ty: $value:expr;)+) => {
        $(
            impl Plain for $kind {
                fn argument(self) -> Argument {
                    let value: fn($kind) -> Argument = $value;
                    value(self)
                }
            }
        )+
    };
}

plain! {
    u32: Argument::Unsigned;
    i32: Argument::Integer;
    u64: |value| Argument::Size(value.cast_signed());
    usize: |value| Argument::Size(value as i64);
    f32: |value| Argument::Float(value.to_bits());
}

/// A handle, with the name of its type.
trait Object: Handle + Copy {
    const KIND: &'static str;
}

macro_rules! objects {
    ($($kind:ident)+) => {
        $(
            impl Object for vk::$kind {
                const KIND: &'static str = concat!("Vk", stringify!($kind));
            }

            impl Plain for vk::$kind {
                fn argument(self) -> Argument {
                    Argument::Object(Self::KIND.to_owned(), self.as_raw())
                }
            }
        )+
    };
}

objects! {
    Device Queue CommandBuffer Buffer Image ImageView ShaderModule DescriptorSetLayout PipelineLayout DescriptorPool
    DescriptorSet Sampler CommandPool Fence QueryPool PipelineCache RenderPass Framebuffer Pipeline DeviceMemory
}

macro_rules! enumerations {
    ($($kind:ident)+) => {
        $(
            impl Plain for vk::$kind {
                fn argument(self) -> Argument {
                    constant(self.as_raw().cast_unsigned(), |raw| {
                        format!("{:?}", vk::$kind::from_raw(raw.cast_signed()))
                    })
                }
            }
        )+
    };
}

enumerations! {
    SubpassContents PipelineBindPoint IndexType ImageLayout Filter StencilOp CompareOp PrimitiveTopology FrontFace
    LogicOp PolygonMode
}

macro_rules! bits {
    ($($kind:ident)+) => {
        $(
            impl Plain for vk::$kind {
                fn argument(self) -> Argument {
                    constant(self.as_raw(), |raw| format!("{:?}", vk::$kind::from_raw(raw)))
                }
            }
        )+
    };
}

bits! {
    MemoryMapFlags DescriptorPoolResetFlags CommandPoolResetFlags QueryResultFlags QueryControlFlags StencilFaceFlags
    CullModeFlags SampleCountFlags
}

/// Returns the values at an address.
///
/// # Safety
/// So many are there, or the address is null.
pub(crate) unsafe fn values<T: Copy>(address: *const T, count: u32) -> Vec<T> {
    if address.is_null() {
        return Vec::new();
    }
    // SAFETY: the caller's.
    unsafe { std::slice::from_raw_parts(address, count as usize) }.to_vec()
}

/// Returns values as an array; none as no address.
fn array(values: impl Iterator<Item = Argument>) -> Argument {
    let values: Vec<Argument> = values.collect();
    match values.is_empty() {
        true => Null,
        false => Argument::Array(values),
    }
}

/// Returns structures.
///
/// # Safety
/// So many of this layout are there, as the specification says.
unsafe fn many<T>(layout: &Layout, address: *const T, count: u32) -> Argument {
    // SAFETY: the caller's.
    unsafe { layout.array(address.cast(), count as usize) }
}

/// Returns a structure.
///
/// # Safety
/// As for [`many`].
unsafe fn one<T>(layout: &Layout, address: *const T) -> Argument {
    // SAFETY: the caller's.
    unsafe { many(layout, address, 1) }
}

/// Returns handles.
///
/// # Safety
/// As for [`values`].
unsafe fn handles<T: Object + Plain>(address: *const T, count: u32) -> Argument {
    // SAFETY: the caller's.
    array(
        unsafe { values(address, count) }
            .into_iter()
            .map(Plain::argument),
    )
}

/// Returns words.
///
/// # Safety
/// As for [`values`].
unsafe fn words<T: Copy>(address: *const T, count: u32) -> Argument {
    // SAFETY: the caller's.
    let all = unsafe { values(address.cast::<u32>(), count) };
    array(all.into_iter().map(Argument::Unsigned))
}

/// Returns sizes.
///
/// # Safety
/// As for [`values`].
unsafe fn sizes(address: *const u64, count: u32) -> Argument {
    // SAFETY: the caller's.
    array(
        unsafe { values(address, count) }
            .into_iter()
            .map(Plain::argument),
    )
}

/// Returns floats.
///
/// # Safety
/// As for [`values`].
unsafe fn floats(address: *const f32, count: u32) -> Argument {
    // SAFETY: the caller's.
    array(
        unsafe { values(address, count) }
            .into_iter()
            .map(Plain::argument),
    )
}

/// Returns the objects that a call has made.
///
/// # Safety
/// The driver wrote so many.
unsafe fn made_of<T: Object>(address: *mut T, count: u32) -> Argument {
    // SAFETY: the caller's.
    let made = unsafe { values(address.cast_const(), count) };
    let made = made.into_iter().map(Handle::as_raw).collect();
    Argument::Created(T::KIND.to_owned(), made)
}

/// Returns the object that a call has made.
///
/// # Safety
/// The driver wrote it.
unsafe fn made<T: Object>(address: *mut T) -> Argument {
    // SAFETY: the caller's.
    unsafe { made_of(address, 1) }
}

/// Returns the place of requirements: how large memory is and of which types is for the driver to say.
fn needs(_: *mut vk::MemoryRequirements) -> Argument {
    Argument::Offset(0)
}

/// Returns the properties of the memory that is allocated.
///
/// # Safety
/// The structure is there.
unsafe fn memory_type(info: *const vk::MemoryAllocateInfo<'_>) -> Argument {
    // SAFETY: the caller's.
    let index = unsafe { (*info).memory_type_index };
    constant(flags_of(index), |raw| {
        format!("{:?}", vk::MemoryPropertyFlags::from_raw(raw))
    })
}

/// Returns the memory that was mapped.
///
/// # Safety
/// The driver wrote its address.
unsafe fn mapped(address: *mut *mut c_void) -> Argument {
    // SAFETY: the caller's.
    let start = unsafe { *address };
    Argument::Created("mapped".to_owned(), vec![start.addr() as u64])
}

/// The value of an argument: what is said of it, or what it says itself.
macro_rules! value {
    ($arg:ident) => {
        $arg.argument()
    };
    ($arg:ident => $value:expr) => {
        // SAFETY: the arguments are as the specification says, and the call has succeeded or what it made is not used.
        unsafe { $value }
    };
    ($arg:ident as $value:expr) => {
        $value
    };
}

macro_rules! functions {
    ($($name:ident($($arg:ident: $kind:ty $(as $plain:expr)? $(=> $value:expr)?),*) $(-> $result:ty)?;)+) => {
        /// Functions that call the driver's and keep the call.
        mod recording {
            use super::*;
            $(
                #[expect(non_snake_case, reason = "the name is the API's")]
                pub(super) unsafe extern "system" fn $name($($arg: $kind),*) $(-> $result)? {
                    type Own = unsafe extern "system" fn($($kind),*) $(-> $result)?;
                    // SAFETY: the backend found this function in place of the driver's, whose address was kept, and
                    // the specification gives the name this type.
                    let own: Own = unsafe { std::mem::transmute(driver(stringify!($name))) };
                    // SAFETY: the arguments are the caller's.
                    let result = unsafe { own($($arg),*) };
                    keep(stringify!($name), || vec![$(value!($arg $(as $plain)? $(=> $value)?)),*]);
                    result
                }
            )+
        }

        /// Returns the function that records one of the device's, with its name.
        pub(super) fn shim(name: &str) -> Option<(&'static str, *const ())> {
            match name {
                $(stringify!($name) => Some((stringify!($name), recording::$name as *const ())),)+
                _ => None,
            }
        }
    };
}

functions! {
    vkGetDeviceQueue(device: vk::Device, family: u32, index: u32, out: *mut vk::Queue => made(out));
    vkCreateBuffer(device: vk::Device, info: *const vk::BufferCreateInfo<'_> => one(&layouts::BUFFER_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::Buffer => made(out)) -> vk::Result;
    vkCreateImage(device: vk::Device, info: *const vk::ImageCreateInfo<'_> => one(&layouts::IMAGE_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::Image => made(out)) -> vk::Result;
    vkCreateImageView(device: vk::Device, info: *const vk::ImageViewCreateInfo<'_> => one(&layouts::IMAGE_VIEW_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::ImageView => made(out)) -> vk::Result;
    vkCreateShaderModule(device: vk::Device, info: *const vk::ShaderModuleCreateInfo<'_> => one(&layouts::SHADER_MODULE_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::ShaderModule => made(out)) -> vk::Result;
    vkCreateDescriptorSetLayout(device: vk::Device, info: *const vk::DescriptorSetLayoutCreateInfo<'_> => one(&layouts::DESCRIPTOR_SET_LAYOUT_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::DescriptorSetLayout => made(out)) -> vk::Result;
    vkCreatePipelineLayout(device: vk::Device, info: *const vk::PipelineLayoutCreateInfo<'_> => one(&layouts::PIPELINE_LAYOUT_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::PipelineLayout => made(out)) -> vk::Result;
    vkCreateDescriptorPool(device: vk::Device, info: *const vk::DescriptorPoolCreateInfo<'_> => one(&layouts::DESCRIPTOR_POOL_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::DescriptorPool => made(out)) -> vk::Result;
    vkCreateSampler(device: vk::Device, info: *const vk::SamplerCreateInfo<'_> => one(&layouts::SAMPLER_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::Sampler => made(out)) -> vk::Result;
    vkCreateCommandPool(device: vk::Device, info: *const vk::CommandPoolCreateInfo<'_> => one(&layouts::COMMAND_POOL_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::CommandPool => made(out)) -> vk::Result;
    vkCreateFence(device: vk::Device, info: *const vk::FenceCreateInfo<'_> => one(&layouts::FENCE_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::Fence => made(out)) -> vk::Result;
    vkCreateQueryPool(device: vk::Device, info: *const vk::QueryPoolCreateInfo<'_> => one(&layouts::QUERY_POOL_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::QueryPool => made(out)) -> vk::Result;
    vkCreatePipelineCache(device: vk::Device, info: *const vk::PipelineCacheCreateInfo<'_> => one(&layouts::PIPELINE_CACHE_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::PipelineCache => made(out)) -> vk::Result;
    vkCreateRenderPass2(device: vk::Device, info: *const vk::RenderPassCreateInfo2<'_> => one(&layouts::RENDER_PASS_CREATE_INFO2, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::RenderPass => made(out)) -> vk::Result;
    vkCreateFramebuffer(device: vk::Device, info: *const vk::FramebufferCreateInfo<'_> => one(&layouts::FRAMEBUFFER_CREATE_INFO, info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::Framebuffer => made(out)) -> vk::Result;
    vkCreateGraphicsPipelines(device: vk::Device, cache: vk::PipelineCache, count: u32, infos: *const vk::GraphicsPipelineCreateInfo<'_> => many(&layouts::GRAPHICS_PIPELINE_CREATE_INFO, infos, count), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::Pipeline => made_of(out, count)) -> vk::Result;
    vkCreateComputePipelines(device: vk::Device, cache: vk::PipelineCache, count: u32, infos: *const vk::ComputePipelineCreateInfo<'_> => many(&layouts::COMPUTE_PIPELINE_CREATE_INFO, infos, count), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::Pipeline => made_of(out, count)) -> vk::Result;
    vkGetBufferMemoryRequirements(device: vk::Device, buffer: vk::Buffer, out: *mut vk::MemoryRequirements as needs(out));
    vkGetImageMemoryRequirements(device: vk::Device, image: vk::Image, out: *mut vk::MemoryRequirements as needs(out));
    vkAllocateMemory(device: vk::Device, info: *const vk::MemoryAllocateInfo<'_> => memory_type(info), allocator: *const vk::AllocationCallbacks<'_> as Null, out: *mut vk::DeviceMemory => made(out)) -> vk::Result;
    vkBindBufferMemory(device: vk::Device, buffer: vk::Buffer, memory: vk::DeviceMemory, offset: u64) -> vk::Result;
    vkBindImageMemory(device: vk::Device, image: vk::Image, memory: vk::DeviceMemory, offset: u64) -> vk::Result;
    vkMapMemory(device: vk::Device, memory: vk::DeviceMemory, offset: u64, size: u64, flags: vk::MemoryMapFlags, out: *mut *mut c_void => mapped(out)) -> vk::Result;
    vkAllocateDescriptorSets(device: vk::Device, info: *const vk::DescriptorSetAllocateInfo<'_> => one(&layouts::DESCRIPTOR_SET_ALLOCATE_INFO, info), out: *mut vk::DescriptorSet => made_of(out, (*info).descriptor_set_count)) -> vk::Result;
    vkResetDescriptorPool(device: vk::Device, pool: vk::DescriptorPool, flags: vk::DescriptorPoolResetFlags) -> vk::Result;
    vkUpdateDescriptorSets(device: vk::Device, writes: u32, all: *const vk::WriteDescriptorSet<'_> => many(&layouts::WRITE_DESCRIPTOR_SET, all, writes), copies: u32, others: *const vk::CopyDescriptorSet<'_> as Null);
    vkAllocateCommandBuffers(device: vk::Device, info: *const vk::CommandBufferAllocateInfo<'_> => one(&layouts::COMMAND_BUFFER_ALLOCATE_INFO, info), out: *mut vk::CommandBuffer => made_of(out, (*info).command_buffer_count)) -> vk::Result;
    vkResetCommandPool(device: vk::Device, pool: vk::CommandPool, flags: vk::CommandPoolResetFlags) -> vk::Result;
    vkBeginCommandBuffer(commands: vk::CommandBuffer, info: *const vk::CommandBufferBeginInfo<'_> => one(&layouts::COMMAND_BUFFER_BEGIN_INFO, info)) -> vk::Result;
    vkEndCommandBuffer(commands: vk::CommandBuffer) -> vk::Result;
    vkResetFences(device: vk::Device, count: u32, fences: *const vk::Fence => handles(fences, count)) -> vk::Result;
    vkWaitForFences(device: vk::Device, count: u32, fences: *const vk::Fence => handles(fences, count), all: u32, timeout: u64) -> vk::Result;
    vkQueueSubmit2(queue: vk::Queue, count: u32, all: *const vk::SubmitInfo2<'_> => many(&layouts::SUBMIT_INFO2, all, count), fence: vk::Fence) -> vk::Result;
    vkGetQueryPoolResults(device: vk::Device, pool: vk::QueryPool, first: u32, count: u32, size: usize, out: *mut c_void as new_output(size as u64), stride: u64, flags: vk::QueryResultFlags) -> vk::Result;
    vkCmdPipelineBarrier2(commands: vk::CommandBuffer, info: *const vk::DependencyInfo<'_> => one(&layouts::DEPENDENCY_INFO, info));
    vkCmdBeginRendering(commands: vk::CommandBuffer, info: *const vk::RenderingInfo<'_> => one(&layouts::RENDERING_INFO, info));
    vkCmdEndRendering(commands: vk::CommandBuffer);
    vkCmdBeginRenderPass(commands: vk::CommandBuffer, info: *const vk::RenderPassBeginInfo<'_> => one(&layouts::RENDER_PASS_BEGIN_INFO, info), contents: vk::SubpassContents);
    vkCmdNextSubpass(commands: vk::CommandBuffer, contents: vk::SubpassContents);
    vkCmdEndRenderPass(commands: vk::CommandBuffer);
    vkCmdBindPipeline(commands: vk::CommandBuffer, point: vk::PipelineBindPoint, pipeline: vk::Pipeline);
    vkCmdBindDescriptorSets(commands: vk::CommandBuffer, point: vk::PipelineBindPoint, layout: vk::PipelineLayout, first: u32, count: u32, sets: *const vk::DescriptorSet => handles(sets, count), dynamic: u32, offsets: *const u32 => words(offsets, dynamic));
    vkCmdBindVertexBuffers(commands: vk::CommandBuffer, first: u32, count: u32, buffers: *const vk::Buffer => handles(buffers, count), offsets: *const u64 => sizes(offsets, count));
    vkCmdBindIndexBuffer(commands: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, kind: vk::IndexType);
    vkCmdDraw(commands: vk::CommandBuffer, vertices: u32, instances: u32, first: u32, first_instance: u32);
    vkCmdDrawIndexed(commands: vk::CommandBuffer, indices: u32, instances: u32, first: u32, base: i32, first_instance: u32);
    vkCmdDrawIndirect(commands: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, count: u32, stride: u32);
    vkCmdDrawIndexedIndirect(commands: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, count: u32, stride: u32);
    vkCmdDispatch(commands: vk::CommandBuffer, x: u32, y: u32, z: u32);
    vkCmdFillBuffer(commands: vk::CommandBuffer, buffer: vk::Buffer, offset: u64, size: u64, word: u32);
    vkCmdCopyBufferToImage(commands: vk::CommandBuffer, buffer: vk::Buffer, image: vk::Image, layout: vk::ImageLayout, count: u32, regions: *const vk::BufferImageCopy => many(&layouts::BUFFER_IMAGE_COPY, regions, count));
    vkCmdCopyImageToBuffer(commands: vk::CommandBuffer, image: vk::Image, layout: vk::ImageLayout, buffer: vk::Buffer, count: u32, regions: *const vk::BufferImageCopy => many(&layouts::BUFFER_IMAGE_COPY, regions, count));
    vkCmdCopyImage(commands: vk::CommandBuffer, from: vk::Image, from_layout: vk::ImageLayout, to: vk::Image, to_layout: vk::ImageLayout, count: u32, regions: *const vk::ImageCopy => many(&layouts::IMAGE_COPY, regions, count));
    vkCmdBlitImage(commands: vk::CommandBuffer, from: vk::Image, from_layout: vk::ImageLayout, to: vk::Image, to_layout: vk::ImageLayout, count: u32, regions: *const vk::ImageBlit => many(&layouts::IMAGE_BLIT, regions, count), filter: vk::Filter);
    vkCmdClearColorImage(commands: vk::CommandBuffer, image: vk::Image, layout: vk::ImageLayout, value: *const vk::ClearColorValue => many(&layouts::CLEAR_VALUE, value, 1), count: u32, ranges: *const vk::ImageSubresourceRange => many(&layouts::IMAGE_SUBRESOURCE_RANGE, ranges, count));
    vkCmdClearDepthStencilImage(commands: vk::CommandBuffer, image: vk::Image, layout: vk::ImageLayout, value: *const vk::ClearDepthStencilValue => one(&layouts::CLEAR_DEPTH_STENCIL_VALUE, value), count: u32, ranges: *const vk::ImageSubresourceRange => many(&layouts::IMAGE_SUBRESOURCE_RANGE, ranges, count));
    vkCmdClearAttachments(commands: vk::CommandBuffer, count: u32, clears: *const vk::ClearAttachment => many(&layouts::CLEAR_ATTACHMENT, clears, count), areas: u32, rects: *const vk::ClearRect => many(&layouts::CLEAR_RECT, rects, areas));
    vkCmdExecuteCommands(commands: vk::CommandBuffer, count: u32, secondaries: *const vk::CommandBuffer => handles(secondaries, count));
    vkCmdBeginQuery(commands: vk::CommandBuffer, pool: vk::QueryPool, query: u32, flags: vk::QueryControlFlags);
    vkCmdEndQuery(commands: vk::CommandBuffer, pool: vk::QueryPool, query: u32);
    vkCmdResetQueryPool(commands: vk::CommandBuffer, pool: vk::QueryPool, first: u32, count: u32);
    vkCmdSetViewport(commands: vk::CommandBuffer, first: u32, count: u32, all: *const vk::Viewport => many(&layouts::VIEWPORT, all, count));
    vkCmdSetScissor(commands: vk::CommandBuffer, first: u32, count: u32, all: *const vk::Rect2D => many(&layouts::RECT2_D, all, count));
    vkCmdSetViewportWithCount(commands: vk::CommandBuffer, count: u32, all: *const vk::Viewport => many(&layouts::VIEWPORT, all, count));
    vkCmdSetScissorWithCount(commands: vk::CommandBuffer, count: u32, all: *const vk::Rect2D => many(&layouts::RECT2_D, all, count));
    vkCmdSetBlendConstants(commands: vk::CommandBuffer, values: *const f32 => floats(values, 4));
    vkCmdSetDepthBias(commands: vk::CommandBuffer, constant: f32, clamp: f32, slope: f32);
    vkCmdSetDepthBounds(commands: vk::CommandBuffer, least: f32, most: f32);
    vkCmdSetStencilCompareMask(commands: vk::CommandBuffer, faces: vk::StencilFaceFlags, value: u32);
    vkCmdSetStencilWriteMask(commands: vk::CommandBuffer, faces: vk::StencilFaceFlags, value: u32);
    vkCmdSetStencilReference(commands: vk::CommandBuffer, faces: vk::StencilFaceFlags, value: u32);
    vkCmdSetStencilOp(commands: vk::CommandBuffer, faces: vk::StencilFaceFlags, fail: vk::StencilOp, pass: vk::StencilOp, depth_fail: vk::StencilOp, compare: vk::CompareOp);
    vkCmdSetStencilTestEnable(commands: vk::CommandBuffer, on: u32);
    vkCmdSetRasterizerDiscardEnable(commands: vk::CommandBuffer, on: u32);
    vkCmdSetPrimitiveRestartEnable(commands: vk::CommandBuffer, on: u32);
    vkCmdSetDepthWriteEnable(commands: vk::CommandBuffer, on: u32);
    vkCmdSetDepthTestEnable(commands: vk::CommandBuffer, on: u32);
    vkCmdSetDepthBoundsTestEnable(commands: vk::CommandBuffer, on: u32);
    vkCmdSetDepthBiasEnable(commands: vk::CommandBuffer, on: u32);
    vkCmdSetLogicOpEnableEXT(commands: vk::CommandBuffer, on: u32);
    vkCmdSetDepthClampEnableEXT(commands: vk::CommandBuffer, on: u32);
    vkCmdSetAlphaToCoverageEnableEXT(commands: vk::CommandBuffer, on: u32);
    vkCmdSetPrimitiveTopology(commands: vk::CommandBuffer, value: vk::PrimitiveTopology);
    vkCmdSetFrontFace(commands: vk::CommandBuffer, value: vk::FrontFace);
    vkCmdSetCullMode(commands: vk::CommandBuffer, value: vk::CullModeFlags);
    vkCmdSetDepthCompareOp(commands: vk::CommandBuffer, value: vk::CompareOp);
    vkCmdSetLogicOpEXT(commands: vk::CommandBuffer, value: vk::LogicOp);
    vkCmdSetPolygonModeEXT(commands: vk::CommandBuffer, value: vk::PolygonMode);
    vkCmdSetSampleMaskEXT(commands: vk::CommandBuffer, samples: vk::SampleCountFlags, mask: *const u32 => words(mask, 1));
    vkCmdSetColorBlendEnableEXT(commands: vk::CommandBuffer, first: u32, count: u32, all: *const u32 => words(all, count));
    vkCmdSetColorBlendEquationEXT(commands: vk::CommandBuffer, first: u32, count: u32, all: *const vk::ColorBlendEquationEXT => many(&layouts::COLOR_BLEND_EQUATION_EXT, all, count));
    vkCmdSetColorWriteMaskEXT(commands: vk::CommandBuffer, first: u32, count: u32, all: *const u32 => words(all, count));
}

/// Creates a device, and keeps the call.
pub(super) unsafe extern "system" fn create_device(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    out: *mut vk::Device,
) -> vk::Result {
    // SAFETY: the address was the driver's function of this type.
    let own: vk::PFN_vkCreateDevice = unsafe { std::mem::transmute(driver("vkCreateDevice")) };
    // SAFETY: the arguments are the caller's.
    let result = unsafe { own(physical, info, allocator, out) };
    if result == vk::Result::SUCCESS {
        keep("vkCreateDevice", || {
            // SAFETY: the arguments are as the specification says, and the driver wrote the device.
            unsafe {
                vec![
                    Argument::Object("VkPhysicalDevice".to_owned(), physical.as_raw()),
                    one(&layouts::DEVICE_CREATE_INFO, info),
                    Null,
                    made(out),
                ]
            }
        });
    }
    result
}
