//! Checks of what a driver reports, before anything relies on it.

use ash::vk;
use etalon_backend::Unavailable;
use std::ffi::CStr;

/// The largest alignment of an offset in a buffer that a device can need (Vulkan: Required Limits).
const MAX_ALIGNMENT: u64 = 256;

/// The functions of Vulkan 1.3 that the backend calls on a device. `ash` ends the process if it calls one that is
/// missing.
const FUNCTIONS: [&CStr; 103] = [
    c"vkAllocateCommandBuffers",
    c"vkAllocateDescriptorSets",
    c"vkAllocateMemory",
    c"vkBeginCommandBuffer",
    c"vkBindBufferMemory",
    c"vkBindImageMemory",
    c"vkCmdBeginQuery",
    c"vkCmdBeginRenderPass",
    c"vkCmdBeginRendering",
    c"vkCmdBindDescriptorSets",
    c"vkCmdBindIndexBuffer",
    c"vkCmdBindPipeline",
    c"vkCmdBindVertexBuffers",
    c"vkCmdBlitImage",
    c"vkCmdClearAttachments",
    c"vkCmdClearColorImage",
    c"vkCmdClearDepthStencilImage",
    c"vkCmdCopyBufferToImage",
    c"vkCmdCopyImage",
    c"vkCmdCopyImageToBuffer",
    c"vkCmdDispatch",
    c"vkCmdDraw",
    c"vkCmdDrawIndexed",
    c"vkCmdDrawIndexedIndirect",
    c"vkCmdDrawIndirect",
    c"vkCmdEndQuery",
    c"vkCmdEndRenderPass",
    c"vkCmdEndRendering",
    c"vkCmdExecuteCommands",
    c"vkCmdFillBuffer",
    c"vkCmdNextSubpass",
    c"vkCmdPipelineBarrier2",
    c"vkCmdResetQueryPool",
    c"vkCmdResolveImage",
    c"vkCmdSetBlendConstants",
    c"vkCmdSetCullMode",
    c"vkCmdSetDepthBias",
    c"vkCmdSetDepthBiasEnable",
    c"vkCmdSetDepthBounds",
    c"vkCmdSetDepthBoundsTestEnable",
    c"vkCmdSetDepthCompareOp",
    c"vkCmdSetDepthTestEnable",
    c"vkCmdSetDepthWriteEnable",
    c"vkCmdSetFrontFace",
    c"vkCmdSetPrimitiveRestartEnable",
    c"vkCmdSetPrimitiveTopology",
    c"vkCmdSetRasterizerDiscardEnable",
    c"vkCmdSetScissor",
    c"vkCmdSetScissorWithCount",
    c"vkCmdSetStencilCompareMask",
    c"vkCmdSetStencilOp",
    c"vkCmdSetStencilReference",
    c"vkCmdSetStencilTestEnable",
    c"vkCmdSetStencilWriteMask",
    c"vkCmdSetViewport",
    c"vkCmdSetViewportWithCount",
    c"vkCmdWriteTimestamp2",
    c"vkCreateBuffer",
    c"vkCreateCommandPool",
    c"vkCreateComputePipelines",
    c"vkCreateDescriptorPool",
    c"vkCreateDescriptorSetLayout",
    c"vkCreateFence",
    c"vkCreateFramebuffer",
    c"vkCreateGraphicsPipelines",
    c"vkCreateImage",
    c"vkCreateImageView",
    c"vkCreatePipelineCache",
    c"vkCreatePipelineLayout",
    c"vkCreateQueryPool",
    c"vkCreateRenderPass2",
    c"vkCreateSampler",
    c"vkCreateShaderModule",
    c"vkDestroyBuffer",
    c"vkDestroyCommandPool",
    c"vkDestroyDescriptorPool",
    c"vkDestroyDescriptorSetLayout",
    c"vkDestroyDevice",
    c"vkDestroyFence",
    c"vkDestroyFramebuffer",
    c"vkDestroyImage",
    c"vkDestroyImageView",
    c"vkDestroyPipeline",
    c"vkDestroyPipelineCache",
    c"vkDestroyPipelineLayout",
    c"vkDestroyQueryPool",
    c"vkDestroyRenderPass",
    c"vkDestroySampler",
    c"vkDestroyShaderModule",
    c"vkDeviceWaitIdle",
    c"vkEndCommandBuffer",
    c"vkFreeMemory",
    c"vkGetBufferMemoryRequirements",
    c"vkGetDeviceQueue",
    c"vkGetImageMemoryRequirements",
    c"vkGetQueryPoolResults",
    c"vkMapMemory",
    c"vkQueueSubmit2",
    c"vkResetCommandPool",
    c"vkResetDescriptorPool",
    c"vkResetFences",
    c"vkUpdateDescriptorSets",
    c"vkWaitForFences",
];

/// Checks what a physical device reports.
///
/// # Errors
/// If a number is impossible; the reason names it.
pub(crate) fn check_numbers(
    memory: &vk::PhysicalDeviceMemoryProperties,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Unavailable> {
    let types = memory.memory_type_count as usize;
    if types > vk::MAX_MEMORY_TYPES {
        return Err(wrong(format!(
            "memoryTypeCount is {types}, more than VK_MAX_MEMORY_TYPES, {}",
            vk::MAX_MEMORY_TYPES
        )));
    }
    let alignments = [
        (
            "minUniformBufferOffsetAlignment",
            limits.min_uniform_buffer_offset_alignment,
        ),
        (
            "minStorageBufferOffsetAlignment",
            limits.min_storage_buffer_offset_alignment,
        ),
    ];
    for (name, value) in alignments {
        if !value.is_power_of_two() || value > MAX_ALIGNMENT {
            return Err(wrong(format!(
                "{name} is {value}, which must be a power of two up to {MAX_ALIGNMENT}"
            )));
        }
    }
    Ok(())
}

/// Checks that a device has all functions that the backend calls. `has` looks a function up.
///
/// # Errors
/// If one is missing; the reason names it.
pub(crate) fn check_functions(has: impl Fn(&CStr) -> bool) -> Result<(), Unavailable> {
    match FUNCTIONS.into_iter().find(|name| !has(name)) {
        None => Ok(()),
        Some(name) => Err(wrong(format!(
            "{} is missing, which Vulkan 1.3 has",
            name.to_string_lossy()
        ))),
    }
}

fn wrong(reason: String) -> Unavailable {
    Unavailable::new(
        format!("the driver breaks the specification: {reason}"),
        "use another version of the driver",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(uniform: u64, storage: u64) -> vk::PhysicalDeviceLimits {
        vk::PhysicalDeviceLimits {
            min_uniform_buffer_offset_alignment: uniform,
            min_storage_buffer_offset_alignment: storage,
            ..Default::default()
        }
    }

    fn memory(types: u32) -> vk::PhysicalDeviceMemoryProperties {
        vk::PhysicalDeviceMemoryProperties {
            memory_type_count: types,
            ..Default::default()
        }
    }

    fn reason(result: Result<(), Unavailable>) -> String {
        result.err().map_or_else(String::new, |e| e.reason)
    }

    #[test]
    fn more_memory_types_than_vulkan_has_are_an_error_that_names_them() {
        assert_eq!(check_numbers(&memory(32), &limits(256, 1)), Ok(()));
        for types in [33, u32::MAX] {
            let reason = reason(check_numbers(&memory(types), &limits(64, 16)));
            assert!(
                reason.contains(&format!("memoryTypeCount is {types}")),
                "{reason}"
            );
        }
    }

    #[test]
    fn an_impossible_alignment_is_an_error_that_names_it() {
        for value in [0, 3, 512, u64::MAX] {
            let uniform = reason(check_numbers(&memory(1), &limits(value, 64)));
            let words = format!("minUniformBufferOffsetAlignment is {value}");
            assert!(uniform.contains(&words), "{uniform}");
            let storage = reason(check_numbers(&memory(1), &limits(64, value)));
            let words = format!("minStorageBufferOffsetAlignment is {value}");
            assert!(storage.contains(&words), "{storage}");
        }
    }

    #[test]
    fn a_missing_function_is_an_error_that_names_it() {
        assert_eq!(check_functions(|_| true), Ok(()));
        let reason = reason(check_functions(|name| name != c"vkCmdDraw"));
        assert!(reason.contains("vkCmdDraw is missing"), "{reason}");
    }
}
