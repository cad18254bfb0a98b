//! The functions of Vulkan that are recorded, and the structures that they take, as the registry declares them.
//!
//! Made by `generate` from `vk.xml` 1.3.281. Do not edit.

#![expect(
    deprecated,
    reason = "fields that devices ignore are part of the structure"
)]
#![expect(non_upper_case_globals, reason = "the names are the API's")]

use super::functions::functions;
use super::layout::ArrayCount::{By, Fixed};
use super::layout::ValueKind::*;
use super::layout::{StructField, StructLayout, chained, flags, named, structures, unions};
use ash::vk;
use std::ffi::c_void;
use std::mem::offset_of;

functions! {
    vkCreateDevice -> vk::Result {
        physicalDevice: vk::PhysicalDevice = Handle("VkPhysicalDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkDeviceCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pDevice: *mut c_void = Made("VkDevice", Fixed(1)),
    }
    vkGetDeviceQueue {
        device: vk::Device = Handle("VkDevice"),
        queueFamilyIndex: u32 = U32,
        queueIndex: u32 = U32,
        pQueue: *mut c_void = Made("VkQueue", Fixed(1)),
    }
    vkCreateBuffer -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkBufferCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pBuffer: *mut c_void = Made("VkBuffer", Fixed(1)),
    }
    vkCreateImage -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkImageCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pImage: *mut c_void = Made("VkImage", Fixed(1)),
    }
    vkCreateImageView -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkImageViewCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pView: *mut c_void = Made("VkImageView", Fixed(1)),
    }
    vkCreateShaderModule -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkShaderModuleCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pShaderModule: *mut c_void = Made("VkShaderModule", Fixed(1)),
    }
    vkCreateDescriptorSetLayout -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkDescriptorSetLayoutCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pSetLayout: *mut c_void = Made("VkDescriptorSetLayout", Fixed(1)),
    }
    vkCreatePipelineLayout -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkPipelineLayoutCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pPipelineLayout: *mut c_void = Made("VkPipelineLayout", Fixed(1)),
    }
    vkCreateDescriptorPool -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkDescriptorPoolCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pDescriptorPool: *mut c_void = Made("VkDescriptorPool", Fixed(1)),
    }
    vkCreateSampler -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkSamplerCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pSampler: *mut c_void = Made("VkSampler", Fixed(1)),
    }
    vkCreateCommandPool -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkCommandPoolCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pCommandPool: *mut c_void = Made("VkCommandPool", Fixed(1)),
    }
    vkCreateFence -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkFenceCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pFence: *mut c_void = Made("VkFence", Fixed(1)),
    }
    vkCreateQueryPool -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkQueryPoolCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pQueryPool: *mut c_void = Made("VkQueryPool", Fixed(1)),
    }
    vkCreatePipelineCache -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkPipelineCacheCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pPipelineCache: *mut c_void = Made("VkPipelineCache", Fixed(1)),
    }
    vkCreateRenderPass2 -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkRenderPassCreateInfo2), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pRenderPass: *mut c_void = Made("VkRenderPass", Fixed(1)),
    }
    vkCreateFramebuffer -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pCreateInfo: *const c_void = Array(&Struct(&VkFramebufferCreateInfo), Fixed(1)),
        pAllocator: *const c_void = Unused,
        pFramebuffer: *mut c_void = Made("VkFramebuffer", Fixed(1)),
    }
    vkCreateGraphicsPipelines -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pipelineCache: vk::PipelineCache = Handle("VkPipelineCache"),
        createInfoCount: u32 = U32,
        pCreateInfos: *const c_void = Array(&Struct(&VkGraphicsPipelineCreateInfo), By("createInfoCount")),
        pAllocator: *const c_void = Unused,
        pPipelines: *mut c_void = Made("VkPipeline", By("createInfoCount")),
    }
    vkCreateComputePipelines -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pipelineCache: vk::PipelineCache = Handle("VkPipelineCache"),
        createInfoCount: u32 = U32,
        pCreateInfos: *const c_void = Array(&Struct(&VkComputePipelineCreateInfo), By("createInfoCount")),
        pAllocator: *const c_void = Unused,
        pPipelines: *mut c_void = Made("VkPipeline", By("createInfoCount")),
    }
    vkGetBufferMemoryRequirements {
        device: vk::Device = Handle("VkDevice"),
        buffer: vk::Buffer = Handle("VkBuffer"),
        pMemoryRequirements: *mut c_void = Requirements,
    }
    vkGetImageMemoryRequirements {
        device: vk::Device = Handle("VkDevice"),
        image: vk::Image = Handle("VkImage"),
        pMemoryRequirements: *mut c_void = Requirements,
    }
    vkAllocateMemory -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pAllocateInfo: *const c_void = MemoryType,
        pAllocator: *const c_void = Unused,
        pMemory: *mut c_void = Made("VkDeviceMemory", Fixed(1)),
    }
    vkBindBufferMemory -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        buffer: vk::Buffer = Handle("VkBuffer"),
        memory: vk::DeviceMemory = Handle("VkDeviceMemory"),
        memoryOffset: u64 = U64,
    }
    vkBindImageMemory -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        image: vk::Image = Handle("VkImage"),
        memory: vk::DeviceMemory = Handle("VkDeviceMemory"),
        memoryOffset: u64 = U64,
    }
    vkMapMemory -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        memory: vk::DeviceMemory = Handle("VkDeviceMemory"),
        offset: u64 = U64,
        size: u64 = U64,
        flags: vk::MemoryMapFlags = flags!(vk::MemoryMapFlags),
        ppData: *mut c_void = Mapped,
    }
    vkAllocateDescriptorSets -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pAllocateInfo: *const c_void = Array(&Struct(&VkDescriptorSetAllocateInfo), Fixed(1)),
        pDescriptorSets: *mut c_void = Made("VkDescriptorSet", By("pAllocateInfo->descriptorSetCount")),
    }
    vkResetDescriptorPool -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        descriptorPool: vk::DescriptorPool = Handle("VkDescriptorPool"),
        flags: vk::DescriptorPoolResetFlags = flags!(vk::DescriptorPoolResetFlags),
    }
    vkUpdateDescriptorSets {
        device: vk::Device = Handle("VkDevice"),
        descriptorWriteCount: u32 = U32,
        pDescriptorWrites: *const c_void = Array(&Struct(&VkWriteDescriptorSet), By("descriptorWriteCount")),
        descriptorCopyCount: u32 = U32,
        pDescriptorCopies: *const c_void = Array(&Struct(&VkCopyDescriptorSet), By("descriptorCopyCount")),
    }
    vkAllocateCommandBuffers -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        pAllocateInfo: *const c_void = Array(&Struct(&VkCommandBufferAllocateInfo), Fixed(1)),
        pCommandBuffers: *mut c_void = Made("VkCommandBuffer", By("pAllocateInfo->commandBufferCount")),
    }
    vkResetCommandPool -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        commandPool: vk::CommandPool = Handle("VkCommandPool"),
        flags: vk::CommandPoolResetFlags = flags!(vk::CommandPoolResetFlags),
    }
    vkBeginCommandBuffer -> vk::Result {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        pBeginInfo: *const c_void = Array(&Struct(&VkCommandBufferBeginInfo), Fixed(1)),
    }
    vkEndCommandBuffer -> vk::Result {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
    }
    vkResetFences -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        fenceCount: u32 = U32,
        pFences: *const c_void = Array(&Handle("VkFence"), By("fenceCount")),
    }
    vkWaitForFences -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        fenceCount: u32 = U32,
        pFences: *const c_void = Array(&Handle("VkFence"), By("fenceCount")),
        waitAll: u32 = U32,
        timeout: u64 = U64,
    }
    vkQueueSubmit2 -> vk::Result {
        queue: vk::Queue = Handle("VkQueue"),
        submitCount: u32 = U32,
        pSubmits: *const c_void = Array(&Struct(&VkSubmitInfo2), By("submitCount")),
        fence: vk::Fence = Handle("VkFence"),
    }
    vkGetQueryPoolResults -> vk::Result {
        device: vk::Device = Handle("VkDevice"),
        queryPool: vk::QueryPool = Handle("VkQueryPool"),
        firstQuery: u32 = U32,
        queryCount: u32 = U32,
        dataSize: usize = U64,
        pData: *mut c_void = Output(By("dataSize")),
        stride: u64 = U64,
        flags: vk::QueryResultFlags = flags!(vk::QueryResultFlags),
    }
    vkCmdPipelineBarrier2 {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        pDependencyInfo: *const c_void = Array(&Struct(&VkDependencyInfo), Fixed(1)),
    }
    vkCmdBeginRendering {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        pRenderingInfo: *const c_void = Array(&Struct(&VkRenderingInfo), Fixed(1)),
    }
    vkCmdEndRendering {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
    }
    vkCmdBeginRenderPass {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        pRenderPassBegin: *const c_void = Array(&Struct(&VkRenderPassBeginInfo), Fixed(1)),
        contents: vk::SubpassContents = named!(vk::SubpassContents),
    }
    vkCmdNextSubpass {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        contents: vk::SubpassContents = named!(vk::SubpassContents),
    }
    vkCmdEndRenderPass {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
    }
    vkCmdBindPipeline {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        pipelineBindPoint: vk::PipelineBindPoint = named!(vk::PipelineBindPoint),
        pipeline: vk::Pipeline = Handle("VkPipeline"),
    }
    vkCmdBindDescriptorSets {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        pipelineBindPoint: vk::PipelineBindPoint = named!(vk::PipelineBindPoint),
        layout: vk::PipelineLayout = Handle("VkPipelineLayout"),
        firstSet: u32 = U32,
        descriptorSetCount: u32 = U32,
        pDescriptorSets: *const c_void = Array(&Handle("VkDescriptorSet"), By("descriptorSetCount")),
        dynamicOffsetCount: u32 = U32,
        pDynamicOffsets: *const c_void = Array(&U32, By("dynamicOffsetCount")),
    }
    vkCmdBindVertexBuffers {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        firstBinding: u32 = U32,
        bindingCount: u32 = U32,
        pBuffers: *const c_void = Array(&Handle("VkBuffer"), By("bindingCount")),
        pOffsets: *const c_void = Array(&U64, By("bindingCount")),
    }
    vkCmdBindIndexBuffer {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        buffer: vk::Buffer = Handle("VkBuffer"),
        offset: u64 = U64,
        indexType: vk::IndexType = named!(vk::IndexType),
    }
    vkCmdDraw {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        vertexCount: u32 = U32,
        instanceCount: u32 = U32,
        firstVertex: u32 = U32,
        firstInstance: u32 = U32,
    }
    vkCmdDrawIndexed {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        indexCount: u32 = U32,
        instanceCount: u32 = U32,
        firstIndex: u32 = U32,
        vertexOffset: i32 = I32,
        firstInstance: u32 = U32,
    }
    vkCmdDrawIndirect {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        buffer: vk::Buffer = Handle("VkBuffer"),
        offset: u64 = U64,
        drawCount: u32 = U32,
        stride: u32 = U32,
    }
    vkCmdDrawIndexedIndirect {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        buffer: vk::Buffer = Handle("VkBuffer"),
        offset: u64 = U64,
        drawCount: u32 = U32,
        stride: u32 = U32,
    }
    vkCmdDrawIndirectCount {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        buffer: vk::Buffer = Handle("VkBuffer"),
        offset: u64 = U64,
        countBuffer: vk::Buffer = Handle("VkBuffer"),
        countBufferOffset: u64 = U64,
        maxDrawCount: u32 = U32,
        stride: u32 = U32,
    }
    vkCmdDrawIndexedIndirectCount {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        buffer: vk::Buffer = Handle("VkBuffer"),
        offset: u64 = U64,
        countBuffer: vk::Buffer = Handle("VkBuffer"),
        countBufferOffset: u64 = U64,
        maxDrawCount: u32 = U32,
        stride: u32 = U32,
    }
    vkCmdDispatch {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        groupCountX: u32 = U32,
        groupCountY: u32 = U32,
        groupCountZ: u32 = U32,
    }
    vkCmdFillBuffer {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        dstBuffer: vk::Buffer = Handle("VkBuffer"),
        dstOffset: u64 = U64,
        size: u64 = U64,
        data: u32 = U32,
    }
    vkCmdCopyBufferToImage {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        srcBuffer: vk::Buffer = Handle("VkBuffer"),
        dstImage: vk::Image = Handle("VkImage"),
        dstImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        regionCount: u32 = U32,
        pRegions: *const c_void = Array(&Struct(&VkBufferImageCopy), By("regionCount")),
    }
    vkCmdCopyImageToBuffer {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        srcImage: vk::Image = Handle("VkImage"),
        srcImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        dstBuffer: vk::Buffer = Handle("VkBuffer"),
        regionCount: u32 = U32,
        pRegions: *const c_void = Array(&Struct(&VkBufferImageCopy), By("regionCount")),
    }
    vkCmdCopyImage {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        srcImage: vk::Image = Handle("VkImage"),
        srcImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        dstImage: vk::Image = Handle("VkImage"),
        dstImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        regionCount: u32 = U32,
        pRegions: *const c_void = Array(&Struct(&VkImageCopy), By("regionCount")),
    }
    vkCmdBlitImage {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        srcImage: vk::Image = Handle("VkImage"),
        srcImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        dstImage: vk::Image = Handle("VkImage"),
        dstImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        regionCount: u32 = U32,
        pRegions: *const c_void = Array(&Struct(&VkImageBlit), By("regionCount")),
        filter: vk::Filter = named!(vk::Filter),
    }
    vkCmdResolveImage {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        srcImage: vk::Image = Handle("VkImage"),
        srcImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        dstImage: vk::Image = Handle("VkImage"),
        dstImageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        regionCount: u32 = U32,
        pRegions: *const c_void = Array(&Struct(&VkImageResolve), By("regionCount")),
    }
    vkCmdClearColorImage {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        image: vk::Image = Handle("VkImage"),
        imageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        pColor: *const c_void = Array(&Struct(&VkClearColorValue), Fixed(1)),
        rangeCount: u32 = U32,
        pRanges: *const c_void = Array(&Struct(&VkImageSubresourceRange), By("rangeCount")),
    }
    vkCmdClearDepthStencilImage {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        image: vk::Image = Handle("VkImage"),
        imageLayout: vk::ImageLayout = named!(vk::ImageLayout),
        pDepthStencil: *const c_void = Array(&Struct(&VkClearDepthStencilValue), Fixed(1)),
        rangeCount: u32 = U32,
        pRanges: *const c_void = Array(&Struct(&VkImageSubresourceRange), By("rangeCount")),
    }
    vkCmdClearAttachments {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        attachmentCount: u32 = U32,
        pAttachments: *const c_void = Array(&Struct(&VkClearAttachment), By("attachmentCount")),
        rectCount: u32 = U32,
        pRects: *const c_void = Array(&Struct(&VkClearRect), By("rectCount")),
    }
    vkCmdExecuteCommands {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        commandBufferCount: u32 = U32,
        pCommandBuffers: *const c_void = Array(&Handle("VkCommandBuffer"), By("commandBufferCount")),
    }
    vkCmdBeginQuery {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        queryPool: vk::QueryPool = Handle("VkQueryPool"),
        query: u32 = U32,
        flags: vk::QueryControlFlags = flags!(vk::QueryControlFlags),
    }
    vkCmdEndQuery {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        queryPool: vk::QueryPool = Handle("VkQueryPool"),
        query: u32 = U32,
    }
    vkCmdResetQueryPool {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        queryPool: vk::QueryPool = Handle("VkQueryPool"),
        firstQuery: u32 = U32,
        queryCount: u32 = U32,
    }
    vkCmdSetViewport {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        firstViewport: u32 = U32,
        viewportCount: u32 = U32,
        pViewports: *const c_void = Array(&Struct(&VkViewport), By("viewportCount")),
    }
    vkCmdSetScissor {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        firstScissor: u32 = U32,
        scissorCount: u32 = U32,
        pScissors: *const c_void = Array(&Struct(&VkRect2D), By("scissorCount")),
    }
    vkCmdSetViewportWithCount {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        viewportCount: u32 = U32,
        pViewports: *const c_void = Array(&Struct(&VkViewport), By("viewportCount")),
    }
    vkCmdSetScissorWithCount {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        scissorCount: u32 = U32,
        pScissors: *const c_void = Array(&Struct(&VkRect2D), By("scissorCount")),
    }
    vkCmdSetBlendConstants {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        blendConstants: *const c_void = Array(&F32, Fixed(4)),
    }
    vkCmdSetDepthBias {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthBiasConstantFactor: f32 = F32,
        depthBiasClamp: f32 = F32,
        depthBiasSlopeFactor: f32 = F32,
    }
    vkCmdSetDepthBounds {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        minDepthBounds: f32 = F32,
        maxDepthBounds: f32 = F32,
    }
    vkCmdSetStencilCompareMask {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        faceMask: vk::StencilFaceFlags = flags!(vk::StencilFaceFlags),
        compareMask: u32 = U32,
    }
    vkCmdSetStencilWriteMask {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        faceMask: vk::StencilFaceFlags = flags!(vk::StencilFaceFlags),
        writeMask: u32 = U32,
    }
    vkCmdSetStencilReference {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        faceMask: vk::StencilFaceFlags = flags!(vk::StencilFaceFlags),
        reference: u32 = U32,
    }
    vkCmdSetStencilOp {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        faceMask: vk::StencilFaceFlags = flags!(vk::StencilFaceFlags),
        failOp: vk::StencilOp = named!(vk::StencilOp),
        passOp: vk::StencilOp = named!(vk::StencilOp),
        depthFailOp: vk::StencilOp = named!(vk::StencilOp),
        compareOp: vk::CompareOp = named!(vk::CompareOp),
    }
    vkCmdSetStencilTestEnable {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        stencilTestEnable: u32 = U32,
    }
    vkCmdSetRasterizerDiscardEnable {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        rasterizerDiscardEnable: u32 = U32,
    }
    vkCmdSetPrimitiveRestartEnable {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        primitiveRestartEnable: u32 = U32,
    }
    vkCmdSetDepthWriteEnable {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthWriteEnable: u32 = U32,
    }
    vkCmdSetDepthTestEnable {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthTestEnable: u32 = U32,
    }
    vkCmdSetDepthBoundsTestEnable {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthBoundsTestEnable: u32 = U32,
    }
    vkCmdSetDepthBiasEnable {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthBiasEnable: u32 = U32,
    }
    vkCmdSetLogicOpEnableEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        logicOpEnable: u32 = U32,
    }
    vkCmdSetDepthClampEnableEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthClampEnable: u32 = U32,
    }
    vkCmdSetAlphaToCoverageEnableEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        alphaToCoverageEnable: u32 = U32,
    }
    vkCmdSetPrimitiveTopology {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        primitiveTopology: vk::PrimitiveTopology = named!(vk::PrimitiveTopology),
    }
    vkCmdSetFrontFace {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        frontFace: vk::FrontFace = named!(vk::FrontFace),
    }
    vkCmdSetCullMode {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        cullMode: vk::CullModeFlags = flags!(vk::CullModeFlags),
    }
    vkCmdSetDepthCompareOp {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthCompareOp: vk::CompareOp = named!(vk::CompareOp),
    }
    vkCmdSetLogicOpEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        logicOp: vk::LogicOp = named!(vk::LogicOp),
    }
    vkCmdSetPolygonModeEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        polygonMode: vk::PolygonMode = named!(vk::PolygonMode),
    }
    vkCmdSetRasterizationSamplesEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        rasterizationSamples: vk::SampleCountFlags = flags!(vk::SampleCountFlags),
    }
    vkCmdSetAlphaToOneEnableEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        alphaToOneEnable: u32 = U32,
    }
    vkCmdSetDepthClipEnableEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        depthClipEnable: u32 = U32,
    }
    vkCmdSetProvokingVertexModeEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        provokingVertexMode: vk::ProvokingVertexModeEXT = named!(vk::ProvokingVertexModeEXT),
    }
    vkCmdSetTessellationDomainOriginEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        domainOrigin: vk::TessellationDomainOrigin = named!(vk::TessellationDomainOrigin),
    }
    vkCmdSetSampleMaskEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        samples: vk::SampleCountFlags = flags!(vk::SampleCountFlags),
        pSampleMask: *const c_void = Array(&U32, Fixed(1)),
    }
    vkCmdSetColorBlendEnableEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        firstAttachment: u32 = U32,
        attachmentCount: u32 = U32,
        pColorBlendEnables: *const c_void = Array(&U32, By("attachmentCount")),
    }
    vkCmdSetColorBlendEquationEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        firstAttachment: u32 = U32,
        attachmentCount: u32 = U32,
        pColorBlendEquations: *const c_void = Array(&Struct(&VkColorBlendEquationEXT), By("attachmentCount")),
    }
    vkCmdSetColorWriteMaskEXT {
        commandBuffer: vk::CommandBuffer = Handle("VkCommandBuffer"),
        firstAttachment: u32 = U32,
        attachmentCount: u32 = U32,
        pColorWriteMasks: *const c_void = Array(&flags!(vk::ColorComponentFlags), By("attachmentCount")),
    }
}

structures! {
    VkDeviceCreateInfo: vk::DeviceCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::DeviceCreateFlags),
        queueCreateInfoCount = queue_create_info_count: U32,
        pQueueCreateInfos = p_queue_create_infos: Array(&Struct(&VkDeviceQueueCreateInfo), By("queueCreateInfoCount")),
        enabledLayerCount = enabled_layer_count: U32,
        ppEnabledLayerNames = pp_enabled_layer_names: Array(&Text, By("enabledLayerCount")),
        enabledExtensionCount = enabled_extension_count: U32,
        ppEnabledExtensionNames = pp_enabled_extension_names: Array(&Text, By("enabledExtensionCount")),
        pEnabledFeatures = p_enabled_features: Array(&Struct(&VkPhysicalDeviceFeatures), Fixed(1)),
    }
    VkDeviceQueueCreateInfo: vk::DeviceQueueCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::DeviceQueueCreateFlags),
        queueFamilyIndex = queue_family_index: U32,
        queueCount = queue_count: U32,
        pQueuePriorities = p_queue_priorities: Array(&F32, By("queueCount")),
    }
    VkPhysicalDeviceFeatures: vk::PhysicalDeviceFeatures {
        robustBufferAccess = robust_buffer_access: U32,
        fullDrawIndexUint32 = full_draw_index_uint32: U32,
        imageCubeArray = image_cube_array: U32,
        independentBlend = independent_blend: U32,
        geometryShader = geometry_shader: U32,
        tessellationShader = tessellation_shader: U32,
        sampleRateShading = sample_rate_shading: U32,
        dualSrcBlend = dual_src_blend: U32,
        logicOp = logic_op: U32,
        multiDrawIndirect = multi_draw_indirect: U32,
        drawIndirectFirstInstance = draw_indirect_first_instance: U32,
        depthClamp = depth_clamp: U32,
        depthBiasClamp = depth_bias_clamp: U32,
        fillModeNonSolid = fill_mode_non_solid: U32,
        depthBounds = depth_bounds: U32,
        wideLines = wide_lines: U32,
        largePoints = large_points: U32,
        alphaToOne = alpha_to_one: U32,
        multiViewport = multi_viewport: U32,
        samplerAnisotropy = sampler_anisotropy: U32,
        textureCompressionETC2 = texture_compression_etc2: U32,
        textureCompressionASTC_LDR = texture_compression_astc_ldr: U32,
        textureCompressionBC = texture_compression_bc: U32,
        occlusionQueryPrecise = occlusion_query_precise: U32,
        pipelineStatisticsQuery = pipeline_statistics_query: U32,
        vertexPipelineStoresAndAtomics = vertex_pipeline_stores_and_atomics: U32,
        fragmentStoresAndAtomics = fragment_stores_and_atomics: U32,
        shaderTessellationAndGeometryPointSize = shader_tessellation_and_geometry_point_size: U32,
        shaderImageGatherExtended = shader_image_gather_extended: U32,
        shaderStorageImageExtendedFormats = shader_storage_image_extended_formats: U32,
        shaderStorageImageMultisample = shader_storage_image_multisample: U32,
        shaderStorageImageReadWithoutFormat = shader_storage_image_read_without_format: U32,
        shaderStorageImageWriteWithoutFormat = shader_storage_image_write_without_format: U32,
        shaderUniformBufferArrayDynamicIndexing = shader_uniform_buffer_array_dynamic_indexing: U32,
        shaderSampledImageArrayDynamicIndexing = shader_sampled_image_array_dynamic_indexing: U32,
        shaderStorageBufferArrayDynamicIndexing = shader_storage_buffer_array_dynamic_indexing: U32,
        shaderStorageImageArrayDynamicIndexing = shader_storage_image_array_dynamic_indexing: U32,
        shaderClipDistance = shader_clip_distance: U32,
        shaderCullDistance = shader_cull_distance: U32,
        shaderFloat64 = shader_float64: U32,
        shaderInt64 = shader_int64: U32,
        shaderInt16 = shader_int16: U32,
        shaderResourceResidency = shader_resource_residency: U32,
        shaderResourceMinLod = shader_resource_min_lod: U32,
        sparseBinding = sparse_binding: U32,
        sparseResidencyBuffer = sparse_residency_buffer: U32,
        sparseResidencyImage2D = sparse_residency_image2_d: U32,
        sparseResidencyImage3D = sparse_residency_image3_d: U32,
        sparseResidency2Samples = sparse_residency2_samples: U32,
        sparseResidency4Samples = sparse_residency4_samples: U32,
        sparseResidency8Samples = sparse_residency8_samples: U32,
        sparseResidency16Samples = sparse_residency16_samples: U32,
        sparseResidencyAliased = sparse_residency_aliased: U32,
        variableMultisampleRate = variable_multisample_rate: U32,
        inheritedQueries = inherited_queries: U32,
    }
    VkBufferCreateInfo: vk::BufferCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::BufferCreateFlags),
        size = size: U64,
        usage = usage: flags!(vk::BufferUsageFlags),
        sharingMode = sharing_mode: named!(vk::SharingMode),
        queueFamilyIndexCount = queue_family_index_count: U32,
        pQueueFamilyIndices = p_queue_family_indices: Array(&U32, By("queueFamilyIndexCount")),
    }
    VkImageCreateInfo: vk::ImageCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::ImageCreateFlags),
        imageType = image_type: named!(vk::ImageType),
        format = format: named!(vk::Format),
        extent = extent: Struct(&VkExtent3D),
        mipLevels = mip_levels: U32,
        arrayLayers = array_layers: U32,
        samples = samples: flags!(vk::SampleCountFlags),
        tiling = tiling: named!(vk::ImageTiling),
        usage = usage: flags!(vk::ImageUsageFlags),
        sharingMode = sharing_mode: named!(vk::SharingMode),
        queueFamilyIndexCount = queue_family_index_count: U32,
        pQueueFamilyIndices = p_queue_family_indices: Array(&U32, By("queueFamilyIndexCount")),
        initialLayout = initial_layout: named!(vk::ImageLayout),
    }
    VkExtent3D: vk::Extent3D {
        width = width: U32,
        height = height: U32,
        depth = depth: U32,
    }
    VkImageViewCreateInfo: vk::ImageViewCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::ImageViewCreateFlags),
        image = image: Handle("VkImage"),
        viewType = view_type: named!(vk::ImageViewType),
        format = format: named!(vk::Format),
        components = components: Struct(&VkComponentMapping),
        subresourceRange = subresource_range: Struct(&VkImageSubresourceRange),
    }
    VkComponentMapping: vk::ComponentMapping {
        r = r: named!(vk::ComponentSwizzle),
        g = g: named!(vk::ComponentSwizzle),
        b = b: named!(vk::ComponentSwizzle),
        a = a: named!(vk::ComponentSwizzle),
    }
    VkImageSubresourceRange: vk::ImageSubresourceRange {
        aspectMask = aspect_mask: flags!(vk::ImageAspectFlags),
        baseMipLevel = base_mip_level: U32,
        levelCount = level_count: U32,
        baseArrayLayer = base_array_layer: U32,
        layerCount = layer_count: U32,
    }
    VkShaderModuleCreateInfo: vk::ShaderModuleCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::ShaderModuleCreateFlags),
        codeSize = code_size: U64,
        pCode = p_code: Bytes(By("codeSize")),
    }
    VkDescriptorSetLayoutCreateInfo: vk::DescriptorSetLayoutCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::DescriptorSetLayoutCreateFlags),
        bindingCount = binding_count: U32,
        pBindings = p_bindings: Array(&Struct(&VkDescriptorSetLayoutBinding), By("bindingCount")),
    }
    VkDescriptorSetLayoutBinding: vk::DescriptorSetLayoutBinding {
        binding = binding: U32,
        descriptorType = descriptor_type: named!(vk::DescriptorType),
        descriptorCount = descriptor_count: U32,
        stageFlags = stage_flags: flags!(vk::ShaderStageFlags),
        pImmutableSamplers = p_immutable_samplers: Array(&Handle("VkSampler"), By("descriptorCount")),
    }
    VkPipelineLayoutCreateInfo: vk::PipelineLayoutCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineLayoutCreateFlags),
        setLayoutCount = set_layout_count: U32,
        pSetLayouts = p_set_layouts: Array(&Handle("VkDescriptorSetLayout"), By("setLayoutCount")),
        pushConstantRangeCount = push_constant_range_count: U32,
        pPushConstantRanges = p_push_constant_ranges: Array(&Struct(&VkPushConstantRange), By("pushConstantRangeCount")),
    }
    VkPushConstantRange: vk::PushConstantRange {
        stageFlags = stage_flags: flags!(vk::ShaderStageFlags),
        offset = offset: U32,
        size = size: U32,
    }
    VkDescriptorPoolCreateInfo: vk::DescriptorPoolCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::DescriptorPoolCreateFlags),
        maxSets = max_sets: U32,
        poolSizeCount = pool_size_count: U32,
        pPoolSizes = p_pool_sizes: Array(&Struct(&VkDescriptorPoolSize), By("poolSizeCount")),
    }
    VkDescriptorPoolSize: vk::DescriptorPoolSize {
        type = ty: named!(vk::DescriptorType),
        descriptorCount = descriptor_count: U32,
    }
    VkSamplerCreateInfo: vk::SamplerCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::SamplerCreateFlags),
        magFilter = mag_filter: named!(vk::Filter),
        minFilter = min_filter: named!(vk::Filter),
        mipmapMode = mipmap_mode: named!(vk::SamplerMipmapMode),
        addressModeU = address_mode_u: named!(vk::SamplerAddressMode),
        addressModeV = address_mode_v: named!(vk::SamplerAddressMode),
        addressModeW = address_mode_w: named!(vk::SamplerAddressMode),
        mipLodBias = mip_lod_bias: F32,
        anisotropyEnable = anisotropy_enable: U32,
        maxAnisotropy = max_anisotropy: F32,
        compareEnable = compare_enable: U32,
        compareOp = compare_op: named!(vk::CompareOp),
        minLod = min_lod: F32,
        maxLod = max_lod: F32,
        borderColor = border_color: named!(vk::BorderColor),
        unnormalizedCoordinates = unnormalized_coordinates: U32,
    }
    VkCommandPoolCreateInfo: vk::CommandPoolCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::CommandPoolCreateFlags),
        queueFamilyIndex = queue_family_index: U32,
    }
    VkFenceCreateInfo: vk::FenceCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::FenceCreateFlags),
    }
    VkQueryPoolCreateInfo: vk::QueryPoolCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::QueryPoolCreateFlags),
        queryType = query_type: named!(vk::QueryType),
        queryCount = query_count: U32,
        pipelineStatistics = pipeline_statistics: flags!(vk::QueryPipelineStatisticFlags),
    }
    VkPipelineCacheCreateInfo: vk::PipelineCacheCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineCacheCreateFlags),
        initialDataSize = initial_data_size: U64,
        pInitialData = p_initial_data: Bytes(By("initialDataSize")),
    }
    VkRenderPassCreateInfo2: vk::RenderPassCreateInfo2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::RenderPassCreateFlags),
        attachmentCount = attachment_count: U32,
        pAttachments = p_attachments: Array(&Struct(&VkAttachmentDescription2), By("attachmentCount")),
        subpassCount = subpass_count: U32,
        pSubpasses = p_subpasses: Array(&Struct(&VkSubpassDescription2), By("subpassCount")),
        dependencyCount = dependency_count: U32,
        pDependencies = p_dependencies: Array(&Struct(&VkSubpassDependency2), By("dependencyCount")),
        correlatedViewMaskCount = correlated_view_mask_count: U32,
        pCorrelatedViewMasks = p_correlated_view_masks: Array(&U32, By("correlatedViewMaskCount")),
    }
    VkAttachmentDescription2: vk::AttachmentDescription2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::AttachmentDescriptionFlags),
        format = format: named!(vk::Format),
        samples = samples: flags!(vk::SampleCountFlags),
        loadOp = load_op: named!(vk::AttachmentLoadOp),
        storeOp = store_op: named!(vk::AttachmentStoreOp),
        stencilLoadOp = stencil_load_op: named!(vk::AttachmentLoadOp),
        stencilStoreOp = stencil_store_op: named!(vk::AttachmentStoreOp),
        initialLayout = initial_layout: named!(vk::ImageLayout),
        finalLayout = final_layout: named!(vk::ImageLayout),
    }
    VkSubpassDescription2: vk::SubpassDescription2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::SubpassDescriptionFlags),
        pipelineBindPoint = pipeline_bind_point: named!(vk::PipelineBindPoint),
        viewMask = view_mask: U32,
        inputAttachmentCount = input_attachment_count: U32,
        pInputAttachments = p_input_attachments: Array(&Struct(&VkAttachmentReference2), By("inputAttachmentCount")),
        colorAttachmentCount = color_attachment_count: U32,
        pColorAttachments = p_color_attachments: Array(&Struct(&VkAttachmentReference2), By("colorAttachmentCount")),
        pResolveAttachments = p_resolve_attachments: Array(&Struct(&VkAttachmentReference2), By("colorAttachmentCount")),
        pDepthStencilAttachment = p_depth_stencil_attachment: Array(&Struct(&VkAttachmentReference2), Fixed(1)),
        preserveAttachmentCount = preserve_attachment_count: U32,
        pPreserveAttachments = p_preserve_attachments: Array(&U32, By("preserveAttachmentCount")),
    }
    VkAttachmentReference2: vk::AttachmentReference2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        attachment = attachment: U32,
        layout = layout: named!(vk::ImageLayout),
        aspectMask = aspect_mask: flags!(vk::ImageAspectFlags),
    }
    VkSubpassDependency2: vk::SubpassDependency2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        srcSubpass = src_subpass: U32,
        dstSubpass = dst_subpass: U32,
        srcStageMask = src_stage_mask: flags!(vk::PipelineStageFlags),
        dstStageMask = dst_stage_mask: flags!(vk::PipelineStageFlags),
        srcAccessMask = src_access_mask: flags!(vk::AccessFlags),
        dstAccessMask = dst_access_mask: flags!(vk::AccessFlags),
        dependencyFlags = dependency_flags: flags!(vk::DependencyFlags),
        viewOffset = view_offset: I32,
    }
    VkFramebufferCreateInfo: vk::FramebufferCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::FramebufferCreateFlags),
        renderPass = render_pass: Handle("VkRenderPass"),
        attachmentCount = attachment_count: U32,
        pAttachments = p_attachments: Array(&Handle("VkImageView"), By("attachmentCount")),
        width = width: U32,
        height = height: U32,
        layers = layers: U32,
    }
    VkGraphicsPipelineCreateInfo: vk::GraphicsPipelineCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineCreateFlags),
        stageCount = stage_count: U32,
        pStages = p_stages: Array(&Struct(&VkPipelineShaderStageCreateInfo), By("stageCount")),
        pVertexInputState = p_vertex_input_state: Array(&Struct(&VkPipelineVertexInputStateCreateInfo), Fixed(1)),
        pInputAssemblyState = p_input_assembly_state: Array(&Struct(&VkPipelineInputAssemblyStateCreateInfo), Fixed(1)),
        pTessellationState = p_tessellation_state: Array(&Struct(&VkPipelineTessellationStateCreateInfo), Fixed(1)),
        pViewportState = p_viewport_state: Array(&Struct(&VkPipelineViewportStateCreateInfo), Fixed(1)),
        pRasterizationState = p_rasterization_state: Array(&Struct(&VkPipelineRasterizationStateCreateInfo), Fixed(1)),
        pMultisampleState = p_multisample_state: Array(&Struct(&VkPipelineMultisampleStateCreateInfo), Fixed(1)),
        pDepthStencilState = p_depth_stencil_state: Array(&Struct(&VkPipelineDepthStencilStateCreateInfo), Fixed(1)),
        pColorBlendState = p_color_blend_state: Array(&Struct(&VkPipelineColorBlendStateCreateInfo), Fixed(1)),
        pDynamicState = p_dynamic_state: Array(&Struct(&VkPipelineDynamicStateCreateInfo), Fixed(1)),
        layout = layout: Handle("VkPipelineLayout"),
        renderPass = render_pass: Handle("VkRenderPass"),
        subpass = subpass: U32,
        basePipelineHandle = base_pipeline_handle: Handle("VkPipeline"),
        basePipelineIndex = base_pipeline_index: I32,
    }
    VkPipelineShaderStageCreateInfo: vk::PipelineShaderStageCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineShaderStageCreateFlags),
        stage = stage: flags!(vk::ShaderStageFlags),
        module = module: Handle("VkShaderModule"),
        pName = p_name: Text,
        pSpecializationInfo = p_specialization_info: Unused,
    }
    VkPipelineVertexInputStateCreateInfo: vk::PipelineVertexInputStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineVertexInputStateCreateFlags),
        vertexBindingDescriptionCount = vertex_binding_description_count: U32,
        pVertexBindingDescriptions = p_vertex_binding_descriptions: Array(&Struct(&VkVertexInputBindingDescription), By("vertexBindingDescriptionCount")),
        vertexAttributeDescriptionCount = vertex_attribute_description_count: U32,
        pVertexAttributeDescriptions = p_vertex_attribute_descriptions: Array(&Struct(&VkVertexInputAttributeDescription), By("vertexAttributeDescriptionCount")),
    }
    VkVertexInputBindingDescription: vk::VertexInputBindingDescription {
        binding = binding: U32,
        stride = stride: U32,
        inputRate = input_rate: named!(vk::VertexInputRate),
    }
    VkVertexInputAttributeDescription: vk::VertexInputAttributeDescription {
        location = location: U32,
        binding = binding: U32,
        format = format: named!(vk::Format),
        offset = offset: U32,
    }
    VkPipelineInputAssemblyStateCreateInfo: vk::PipelineInputAssemblyStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineInputAssemblyStateCreateFlags),
        topology = topology: named!(vk::PrimitiveTopology),
        primitiveRestartEnable = primitive_restart_enable: U32,
    }
    VkPipelineTessellationStateCreateInfo: vk::PipelineTessellationStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineTessellationStateCreateFlags),
        patchControlPoints = patch_control_points: U32,
    }
    VkPipelineViewportStateCreateInfo: vk::PipelineViewportStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineViewportStateCreateFlags),
        viewportCount = viewport_count: U32,
        pViewports = p_viewports: Array(&Struct(&VkViewport), By("viewportCount")),
        scissorCount = scissor_count: U32,
        pScissors = p_scissors: Array(&Struct(&VkRect2D), By("scissorCount")),
    }
    VkViewport: vk::Viewport {
        x = x: F32,
        y = y: F32,
        width = width: F32,
        height = height: F32,
        minDepth = min_depth: F32,
        maxDepth = max_depth: F32,
    }
    VkRect2D: vk::Rect2D {
        offset = offset: Struct(&VkOffset2D),
        extent = extent: Struct(&VkExtent2D),
    }
    VkOffset2D: vk::Offset2D {
        x = x: I32,
        y = y: I32,
    }
    VkExtent2D: vk::Extent2D {
        width = width: U32,
        height = height: U32,
    }
    VkPipelineRasterizationStateCreateInfo: vk::PipelineRasterizationStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineRasterizationStateCreateFlags),
        depthClampEnable = depth_clamp_enable: U32,
        rasterizerDiscardEnable = rasterizer_discard_enable: U32,
        polygonMode = polygon_mode: named!(vk::PolygonMode),
        cullMode = cull_mode: flags!(vk::CullModeFlags),
        frontFace = front_face: named!(vk::FrontFace),
        depthBiasEnable = depth_bias_enable: U32,
        depthBiasConstantFactor = depth_bias_constant_factor: F32,
        depthBiasClamp = depth_bias_clamp: F32,
        depthBiasSlopeFactor = depth_bias_slope_factor: F32,
        lineWidth = line_width: F32,
    }
    VkPipelineMultisampleStateCreateInfo: vk::PipelineMultisampleStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineMultisampleStateCreateFlags),
        rasterizationSamples = rasterization_samples: flags!(vk::SampleCountFlags),
        sampleShadingEnable = sample_shading_enable: U32,
        minSampleShading = min_sample_shading: F32,
        pSampleMask = p_sample_mask: Array(&U32, Fixed(1)),
        alphaToCoverageEnable = alpha_to_coverage_enable: U32,
        alphaToOneEnable = alpha_to_one_enable: U32,
    }
    VkPipelineDepthStencilStateCreateInfo: vk::PipelineDepthStencilStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineDepthStencilStateCreateFlags),
        depthTestEnable = depth_test_enable: U32,
        depthWriteEnable = depth_write_enable: U32,
        depthCompareOp = depth_compare_op: named!(vk::CompareOp),
        depthBoundsTestEnable = depth_bounds_test_enable: U32,
        stencilTestEnable = stencil_test_enable: U32,
        front = front: Struct(&VkStencilOpState),
        back = back: Struct(&VkStencilOpState),
        minDepthBounds = min_depth_bounds: F32,
        maxDepthBounds = max_depth_bounds: F32,
    }
    VkStencilOpState: vk::StencilOpState {
        failOp = fail_op: named!(vk::StencilOp),
        passOp = pass_op: named!(vk::StencilOp),
        depthFailOp = depth_fail_op: named!(vk::StencilOp),
        compareOp = compare_op: named!(vk::CompareOp),
        compareMask = compare_mask: U32,
        writeMask = write_mask: U32,
        reference = reference: U32,
    }
    VkPipelineColorBlendStateCreateInfo: vk::PipelineColorBlendStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineColorBlendStateCreateFlags),
        logicOpEnable = logic_op_enable: U32,
        logicOp = logic_op: named!(vk::LogicOp),
        attachmentCount = attachment_count: U32,
        pAttachments = p_attachments: Array(&Struct(&VkPipelineColorBlendAttachmentState), By("attachmentCount")),
        blendConstants = blend_constants: Values(&F32, 4),
    }
    VkPipelineColorBlendAttachmentState: vk::PipelineColorBlendAttachmentState {
        blendEnable = blend_enable: U32,
        srcColorBlendFactor = src_color_blend_factor: named!(vk::BlendFactor),
        dstColorBlendFactor = dst_color_blend_factor: named!(vk::BlendFactor),
        colorBlendOp = color_blend_op: named!(vk::BlendOp),
        srcAlphaBlendFactor = src_alpha_blend_factor: named!(vk::BlendFactor),
        dstAlphaBlendFactor = dst_alpha_blend_factor: named!(vk::BlendFactor),
        alphaBlendOp = alpha_blend_op: named!(vk::BlendOp),
        colorWriteMask = color_write_mask: flags!(vk::ColorComponentFlags),
    }
    VkPipelineDynamicStateCreateInfo: vk::PipelineDynamicStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineDynamicStateCreateFlags),
        dynamicStateCount = dynamic_state_count: U32,
        pDynamicStates = p_dynamic_states: Array(&named!(vk::DynamicState), By("dynamicStateCount")),
    }
    VkComputePipelineCreateInfo: vk::ComputePipelineCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineCreateFlags),
        stage = stage: Struct(&VkPipelineShaderStageCreateInfo),
        layout = layout: Handle("VkPipelineLayout"),
        basePipelineHandle = base_pipeline_handle: Handle("VkPipeline"),
        basePipelineIndex = base_pipeline_index: I32,
    }
    VkDescriptorSetAllocateInfo: vk::DescriptorSetAllocateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        descriptorPool = descriptor_pool: Handle("VkDescriptorPool"),
        descriptorSetCount = descriptor_set_count: U32,
        pSetLayouts = p_set_layouts: Array(&Handle("VkDescriptorSetLayout"), By("descriptorSetCount")),
    }
    VkWriteDescriptorSet: vk::WriteDescriptorSet {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        dstSet = dst_set: Handle("VkDescriptorSet"),
        dstBinding = dst_binding: U32,
        dstArrayElement = dst_array_element: U32,
        descriptorCount = descriptor_count: U32,
        descriptorType = descriptor_type: named!(vk::DescriptorType),
        pImageInfo = p_image_info: Array(&Struct(&VkDescriptorImageInfo), By("descriptorCount")),
        pBufferInfo = p_buffer_info: Array(&Struct(&VkDescriptorBufferInfo), By("descriptorCount")),
        pTexelBufferView = p_texel_buffer_view: Array(&Handle("VkBufferView"), By("descriptorCount")),
    }
    VkDescriptorImageInfo: vk::DescriptorImageInfo {
        sampler = sampler: Handle("VkSampler"),
        imageView = image_view: Handle("VkImageView"),
        imageLayout = image_layout: named!(vk::ImageLayout),
    }
    VkDescriptorBufferInfo: vk::DescriptorBufferInfo {
        buffer = buffer: Handle("VkBuffer"),
        offset = offset: U64,
        range = range: U64,
    }
    VkCopyDescriptorSet: vk::CopyDescriptorSet {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        srcSet = src_set: Handle("VkDescriptorSet"),
        srcBinding = src_binding: U32,
        srcArrayElement = src_array_element: U32,
        dstSet = dst_set: Handle("VkDescriptorSet"),
        dstBinding = dst_binding: U32,
        dstArrayElement = dst_array_element: U32,
        descriptorCount = descriptor_count: U32,
    }
    VkCommandBufferAllocateInfo: vk::CommandBufferAllocateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        commandPool = command_pool: Handle("VkCommandPool"),
        level = level: named!(vk::CommandBufferLevel),
        commandBufferCount = command_buffer_count: U32,
    }
    VkCommandBufferBeginInfo: vk::CommandBufferBeginInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::CommandBufferUsageFlags),
        pInheritanceInfo = p_inheritance_info: Array(&Struct(&VkCommandBufferInheritanceInfo), Fixed(1)),
    }
    VkCommandBufferInheritanceInfo: vk::CommandBufferInheritanceInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        renderPass = render_pass: Handle("VkRenderPass"),
        subpass = subpass: U32,
        framebuffer = framebuffer: Handle("VkFramebuffer"),
        occlusionQueryEnable = occlusion_query_enable: U32,
        queryFlags = query_flags: flags!(vk::QueryControlFlags),
        pipelineStatistics = pipeline_statistics: flags!(vk::QueryPipelineStatisticFlags),
    }
    VkSubmitInfo2: vk::SubmitInfo2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::SubmitFlags),
        waitSemaphoreInfoCount = wait_semaphore_info_count: U32,
        pWaitSemaphoreInfos = p_wait_semaphore_infos: Array(&Struct(&VkSemaphoreSubmitInfo), By("waitSemaphoreInfoCount")),
        commandBufferInfoCount = command_buffer_info_count: U32,
        pCommandBufferInfos = p_command_buffer_infos: Array(&Struct(&VkCommandBufferSubmitInfo), By("commandBufferInfoCount")),
        signalSemaphoreInfoCount = signal_semaphore_info_count: U32,
        pSignalSemaphoreInfos = p_signal_semaphore_infos: Array(&Struct(&VkSemaphoreSubmitInfo), By("signalSemaphoreInfoCount")),
    }
    VkSemaphoreSubmitInfo: vk::SemaphoreSubmitInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        semaphore = semaphore: Handle("VkSemaphore"),
        value = value: U64,
        stageMask = stage_mask: U64,
        deviceIndex = device_index: U32,
    }
    VkCommandBufferSubmitInfo: vk::CommandBufferSubmitInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        commandBuffer = command_buffer: Handle("VkCommandBuffer"),
        deviceMask = device_mask: U32,
    }
    VkDependencyInfo: vk::DependencyInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        dependencyFlags = dependency_flags: flags!(vk::DependencyFlags),
        memoryBarrierCount = memory_barrier_count: U32,
        pMemoryBarriers = p_memory_barriers: Array(&Struct(&VkMemoryBarrier2), By("memoryBarrierCount")),
        bufferMemoryBarrierCount = buffer_memory_barrier_count: U32,
        pBufferMemoryBarriers = p_buffer_memory_barriers: Array(&Struct(&VkBufferMemoryBarrier2), By("bufferMemoryBarrierCount")),
        imageMemoryBarrierCount = image_memory_barrier_count: U32,
        pImageMemoryBarriers = p_image_memory_barriers: Array(&Struct(&VkImageMemoryBarrier2), By("imageMemoryBarrierCount")),
    }
    VkMemoryBarrier2: vk::MemoryBarrier2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        srcStageMask = src_stage_mask: U64,
        srcAccessMask = src_access_mask: U64,
        dstStageMask = dst_stage_mask: U64,
        dstAccessMask = dst_access_mask: U64,
    }
    VkBufferMemoryBarrier2: vk::BufferMemoryBarrier2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        srcStageMask = src_stage_mask: U64,
        srcAccessMask = src_access_mask: U64,
        dstStageMask = dst_stage_mask: U64,
        dstAccessMask = dst_access_mask: U64,
        srcQueueFamilyIndex = src_queue_family_index: U32,
        dstQueueFamilyIndex = dst_queue_family_index: U32,
        buffer = buffer: Handle("VkBuffer"),
        offset = offset: U64,
        size = size: U64,
    }
    VkImageMemoryBarrier2: vk::ImageMemoryBarrier2 {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        srcStageMask = src_stage_mask: U64,
        srcAccessMask = src_access_mask: U64,
        dstStageMask = dst_stage_mask: U64,
        dstAccessMask = dst_access_mask: U64,
        oldLayout = old_layout: named!(vk::ImageLayout),
        newLayout = new_layout: named!(vk::ImageLayout),
        srcQueueFamilyIndex = src_queue_family_index: U32,
        dstQueueFamilyIndex = dst_queue_family_index: U32,
        image = image: Handle("VkImage"),
        subresourceRange = subresource_range: Struct(&VkImageSubresourceRange),
    }
    VkRenderingInfo: vk::RenderingInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::RenderingFlags),
        renderArea = render_area: Struct(&VkRect2D),
        layerCount = layer_count: U32,
        viewMask = view_mask: U32,
        colorAttachmentCount = color_attachment_count: U32,
        pColorAttachments = p_color_attachments: Array(&Struct(&VkRenderingAttachmentInfo), By("colorAttachmentCount")),
        pDepthAttachment = p_depth_attachment: Array(&Struct(&VkRenderingAttachmentInfo), Fixed(1)),
        pStencilAttachment = p_stencil_attachment: Array(&Struct(&VkRenderingAttachmentInfo), Fixed(1)),
    }
    VkRenderingAttachmentInfo: vk::RenderingAttachmentInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        imageView = image_view: Handle("VkImageView"),
        imageLayout = image_layout: named!(vk::ImageLayout),
        resolveMode = resolve_mode: flags!(vk::ResolveModeFlags),
        resolveImageView = resolve_image_view: Handle("VkImageView"),
        resolveImageLayout = resolve_image_layout: named!(vk::ImageLayout),
        loadOp = load_op: named!(vk::AttachmentLoadOp),
        storeOp = store_op: named!(vk::AttachmentStoreOp),
        clearValue = clear_value: Struct(&VkClearValue),
    }
    VkRenderPassBeginInfo: vk::RenderPassBeginInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        renderPass = render_pass: Handle("VkRenderPass"),
        framebuffer = framebuffer: Handle("VkFramebuffer"),
        renderArea = render_area: Struct(&VkRect2D),
        clearValueCount = clear_value_count: U32,
        pClearValues = p_clear_values: Array(&Struct(&VkClearValue), By("clearValueCount")),
    }
    VkBufferImageCopy: vk::BufferImageCopy {
        bufferOffset = buffer_offset: U64,
        bufferRowLength = buffer_row_length: U32,
        bufferImageHeight = buffer_image_height: U32,
        imageSubresource = image_subresource: Struct(&VkImageSubresourceLayers),
        imageOffset = image_offset: Struct(&VkOffset3D),
        imageExtent = image_extent: Struct(&VkExtent3D),
    }
    VkImageSubresourceLayers: vk::ImageSubresourceLayers {
        aspectMask = aspect_mask: flags!(vk::ImageAspectFlags),
        mipLevel = mip_level: U32,
        baseArrayLayer = base_array_layer: U32,
        layerCount = layer_count: U32,
    }
    VkOffset3D: vk::Offset3D {
        x = x: I32,
        y = y: I32,
        z = z: I32,
    }
    VkImageCopy: vk::ImageCopy {
        srcSubresource = src_subresource: Struct(&VkImageSubresourceLayers),
        srcOffset = src_offset: Struct(&VkOffset3D),
        dstSubresource = dst_subresource: Struct(&VkImageSubresourceLayers),
        dstOffset = dst_offset: Struct(&VkOffset3D),
        extent = extent: Struct(&VkExtent3D),
    }
    VkImageBlit: vk::ImageBlit {
        srcSubresource = src_subresource: Struct(&VkImageSubresourceLayers),
        srcOffsets = src_offsets: Values(&Struct(&VkOffset3D), 2),
        dstSubresource = dst_subresource: Struct(&VkImageSubresourceLayers),
        dstOffsets = dst_offsets: Values(&Struct(&VkOffset3D), 2),
    }
    VkImageResolve: vk::ImageResolve {
        srcSubresource = src_subresource: Struct(&VkImageSubresourceLayers),
        srcOffset = src_offset: Struct(&VkOffset3D),
        dstSubresource = dst_subresource: Struct(&VkImageSubresourceLayers),
        dstOffset = dst_offset: Struct(&VkOffset3D),
        extent = extent: Struct(&VkExtent3D),
    }
    VkClearDepthStencilValue: vk::ClearDepthStencilValue {
        depth = depth: F32,
        stencil = stencil: U32,
    }
    VkClearAttachment: vk::ClearAttachment {
        aspectMask = aspect_mask: flags!(vk::ImageAspectFlags),
        colorAttachment = color_attachment: U32,
        clearValue = clear_value: Struct(&VkClearValue),
    }
    VkClearRect: vk::ClearRect {
        rect = rect: Struct(&VkRect2D),
        baseArrayLayer = base_array_layer: U32,
        layerCount = layer_count: U32,
    }
    VkColorBlendEquationEXT: vk::ColorBlendEquationEXT {
        srcColorBlendFactor = src_color_blend_factor: named!(vk::BlendFactor),
        dstColorBlendFactor = dst_color_blend_factor: named!(vk::BlendFactor),
        colorBlendOp = color_blend_op: named!(vk::BlendOp),
        srcAlphaBlendFactor = src_alpha_blend_factor: named!(vk::BlendFactor),
        dstAlphaBlendFactor = dst_alpha_blend_factor: named!(vk::BlendFactor),
        alphaBlendOp = alpha_blend_op: named!(vk::BlendOp),
    }
    VkPhysicalDeviceVulkan11Features: vk::PhysicalDeviceVulkan11Features {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        storageBuffer16BitAccess = storage_buffer16_bit_access: U32,
        uniformAndStorageBuffer16BitAccess = uniform_and_storage_buffer16_bit_access: U32,
        storagePushConstant16 = storage_push_constant16: U32,
        storageInputOutput16 = storage_input_output16: U32,
        multiview = multiview: U32,
        multiviewGeometryShader = multiview_geometry_shader: U32,
        multiviewTessellationShader = multiview_tessellation_shader: U32,
        variablePointersStorageBuffer = variable_pointers_storage_buffer: U32,
        variablePointers = variable_pointers: U32,
        protectedMemory = protected_memory: U32,
        samplerYcbcrConversion = sampler_ycbcr_conversion: U32,
        shaderDrawParameters = shader_draw_parameters: U32,
    }
    VkPhysicalDeviceVulkan12Features: vk::PhysicalDeviceVulkan12Features {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        samplerMirrorClampToEdge = sampler_mirror_clamp_to_edge: U32,
        drawIndirectCount = draw_indirect_count: U32,
        storageBuffer8BitAccess = storage_buffer8_bit_access: U32,
        uniformAndStorageBuffer8BitAccess = uniform_and_storage_buffer8_bit_access: U32,
        storagePushConstant8 = storage_push_constant8: U32,
        shaderBufferInt64Atomics = shader_buffer_int64_atomics: U32,
        shaderSharedInt64Atomics = shader_shared_int64_atomics: U32,
        shaderFloat16 = shader_float16: U32,
        shaderInt8 = shader_int8: U32,
        descriptorIndexing = descriptor_indexing: U32,
        shaderInputAttachmentArrayDynamicIndexing = shader_input_attachment_array_dynamic_indexing: U32,
        shaderUniformTexelBufferArrayDynamicIndexing = shader_uniform_texel_buffer_array_dynamic_indexing: U32,
        shaderStorageTexelBufferArrayDynamicIndexing = shader_storage_texel_buffer_array_dynamic_indexing: U32,
        shaderUniformBufferArrayNonUniformIndexing = shader_uniform_buffer_array_non_uniform_indexing: U32,
        shaderSampledImageArrayNonUniformIndexing = shader_sampled_image_array_non_uniform_indexing: U32,
        shaderStorageBufferArrayNonUniformIndexing = shader_storage_buffer_array_non_uniform_indexing: U32,
        shaderStorageImageArrayNonUniformIndexing = shader_storage_image_array_non_uniform_indexing: U32,
        shaderInputAttachmentArrayNonUniformIndexing = shader_input_attachment_array_non_uniform_indexing: U32,
        shaderUniformTexelBufferArrayNonUniformIndexing = shader_uniform_texel_buffer_array_non_uniform_indexing: U32,
        shaderStorageTexelBufferArrayNonUniformIndexing = shader_storage_texel_buffer_array_non_uniform_indexing: U32,
        descriptorBindingUniformBufferUpdateAfterBind = descriptor_binding_uniform_buffer_update_after_bind: U32,
        descriptorBindingSampledImageUpdateAfterBind = descriptor_binding_sampled_image_update_after_bind: U32,
        descriptorBindingStorageImageUpdateAfterBind = descriptor_binding_storage_image_update_after_bind: U32,
        descriptorBindingStorageBufferUpdateAfterBind = descriptor_binding_storage_buffer_update_after_bind: U32,
        descriptorBindingUniformTexelBufferUpdateAfterBind = descriptor_binding_uniform_texel_buffer_update_after_bind: U32,
        descriptorBindingStorageTexelBufferUpdateAfterBind = descriptor_binding_storage_texel_buffer_update_after_bind: U32,
        descriptorBindingUpdateUnusedWhilePending = descriptor_binding_update_unused_while_pending: U32,
        descriptorBindingPartiallyBound = descriptor_binding_partially_bound: U32,
        descriptorBindingVariableDescriptorCount = descriptor_binding_variable_descriptor_count: U32,
        runtimeDescriptorArray = runtime_descriptor_array: U32,
        samplerFilterMinmax = sampler_filter_minmax: U32,
        scalarBlockLayout = scalar_block_layout: U32,
        imagelessFramebuffer = imageless_framebuffer: U32,
        uniformBufferStandardLayout = uniform_buffer_standard_layout: U32,
        shaderSubgroupExtendedTypes = shader_subgroup_extended_types: U32,
        separateDepthStencilLayouts = separate_depth_stencil_layouts: U32,
        hostQueryReset = host_query_reset: U32,
        timelineSemaphore = timeline_semaphore: U32,
        bufferDeviceAddress = buffer_device_address: U32,
        bufferDeviceAddressCaptureReplay = buffer_device_address_capture_replay: U32,
        bufferDeviceAddressMultiDevice = buffer_device_address_multi_device: U32,
        vulkanMemoryModel = vulkan_memory_model: U32,
        vulkanMemoryModelDeviceScope = vulkan_memory_model_device_scope: U32,
        vulkanMemoryModelAvailabilityVisibilityChains = vulkan_memory_model_availability_visibility_chains: U32,
        shaderOutputViewportIndex = shader_output_viewport_index: U32,
        shaderOutputLayer = shader_output_layer: U32,
        subgroupBroadcastDynamicId = subgroup_broadcast_dynamic_id: U32,
    }
    VkPhysicalDeviceVulkan13Features: vk::PhysicalDeviceVulkan13Features {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        robustImageAccess = robust_image_access: U32,
        inlineUniformBlock = inline_uniform_block: U32,
        descriptorBindingInlineUniformBlockUpdateAfterBind = descriptor_binding_inline_uniform_block_update_after_bind: U32,
        pipelineCreationCacheControl = pipeline_creation_cache_control: U32,
        privateData = private_data: U32,
        shaderDemoteToHelperInvocation = shader_demote_to_helper_invocation: U32,
        shaderTerminateInvocation = shader_terminate_invocation: U32,
        subgroupSizeControl = subgroup_size_control: U32,
        computeFullSubgroups = compute_full_subgroups: U32,
        synchronization2 = synchronization2: U32,
        textureCompressionASTC_HDR = texture_compression_astc_hdr: U32,
        shaderZeroInitializeWorkgroupMemory = shader_zero_initialize_workgroup_memory: U32,
        dynamicRendering = dynamic_rendering: U32,
        shaderIntegerDotProduct = shader_integer_dot_product: U32,
        maintenance4 = maintenance4: U32,
    }
    VkPhysicalDeviceProvokingVertexFeaturesEXT: vk::PhysicalDeviceProvokingVertexFeaturesEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        provokingVertexLast = provoking_vertex_last: U32,
        transformFeedbackPreservesProvokingVertex = transform_feedback_preserves_provoking_vertex: U32,
    }
    VkPhysicalDeviceDynamicRenderingLocalReadFeaturesKHR: vk::PhysicalDeviceDynamicRenderingLocalReadFeaturesKHR {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        dynamicRenderingLocalRead = dynamic_rendering_local_read: U32,
    }
    VkPhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT: vk::PhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        attachmentFeedbackLoopLayout = attachment_feedback_loop_layout: U32,
    }
    VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT: vk::PhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        rasterizationOrderColorAttachmentAccess = rasterization_order_color_attachment_access: U32,
        rasterizationOrderDepthAttachmentAccess = rasterization_order_depth_attachment_access: U32,
        rasterizationOrderStencilAttachmentAccess = rasterization_order_stencil_attachment_access: U32,
    }
    VkPhysicalDeviceExtendedDynamicState3FeaturesEXT: vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        extendedDynamicState3TessellationDomainOrigin = extended_dynamic_state3_tessellation_domain_origin: U32,
        extendedDynamicState3DepthClampEnable = extended_dynamic_state3_depth_clamp_enable: U32,
        extendedDynamicState3PolygonMode = extended_dynamic_state3_polygon_mode: U32,
        extendedDynamicState3RasterizationSamples = extended_dynamic_state3_rasterization_samples: U32,
        extendedDynamicState3SampleMask = extended_dynamic_state3_sample_mask: U32,
        extendedDynamicState3AlphaToCoverageEnable = extended_dynamic_state3_alpha_to_coverage_enable: U32,
        extendedDynamicState3AlphaToOneEnable = extended_dynamic_state3_alpha_to_one_enable: U32,
        extendedDynamicState3LogicOpEnable = extended_dynamic_state3_logic_op_enable: U32,
        extendedDynamicState3ColorBlendEnable = extended_dynamic_state3_color_blend_enable: U32,
        extendedDynamicState3ColorBlendEquation = extended_dynamic_state3_color_blend_equation: U32,
        extendedDynamicState3ColorWriteMask = extended_dynamic_state3_color_write_mask: U32,
        extendedDynamicState3RasterizationStream = extended_dynamic_state3_rasterization_stream: U32,
        extendedDynamicState3ConservativeRasterizationMode = extended_dynamic_state3_conservative_rasterization_mode: U32,
        extendedDynamicState3ExtraPrimitiveOverestimationSize = extended_dynamic_state3_extra_primitive_overestimation_size: U32,
        extendedDynamicState3DepthClipEnable = extended_dynamic_state3_depth_clip_enable: U32,
        extendedDynamicState3SampleLocationsEnable = extended_dynamic_state3_sample_locations_enable: U32,
        extendedDynamicState3ColorBlendAdvanced = extended_dynamic_state3_color_blend_advanced: U32,
        extendedDynamicState3ProvokingVertexMode = extended_dynamic_state3_provoking_vertex_mode: U32,
        extendedDynamicState3LineRasterizationMode = extended_dynamic_state3_line_rasterization_mode: U32,
        extendedDynamicState3LineStippleEnable = extended_dynamic_state3_line_stipple_enable: U32,
        extendedDynamicState3DepthClipNegativeOneToOne = extended_dynamic_state3_depth_clip_negative_one_to_one: U32,
        extendedDynamicState3ViewportWScalingEnable = extended_dynamic_state3_viewport_w_scaling_enable: U32,
        extendedDynamicState3ViewportSwizzle = extended_dynamic_state3_viewport_swizzle: U32,
        extendedDynamicState3CoverageToColorEnable = extended_dynamic_state3_coverage_to_color_enable: U32,
        extendedDynamicState3CoverageToColorLocation = extended_dynamic_state3_coverage_to_color_location: U32,
        extendedDynamicState3CoverageModulationMode = extended_dynamic_state3_coverage_modulation_mode: U32,
        extendedDynamicState3CoverageModulationTableEnable = extended_dynamic_state3_coverage_modulation_table_enable: U32,
        extendedDynamicState3CoverageModulationTable = extended_dynamic_state3_coverage_modulation_table: U32,
        extendedDynamicState3CoverageReductionMode = extended_dynamic_state3_coverage_reduction_mode: U32,
        extendedDynamicState3RepresentativeFragmentTestEnable = extended_dynamic_state3_representative_fragment_test_enable: U32,
        extendedDynamicState3ShadingRateImageEnable = extended_dynamic_state3_shading_rate_image_enable: U32,
    }
    VkPhysicalDeviceExtendedDynamicState2FeaturesEXT: vk::PhysicalDeviceExtendedDynamicState2FeaturesEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        extendedDynamicState2 = extended_dynamic_state2: U32,
        extendedDynamicState2LogicOp = extended_dynamic_state2_logic_op: U32,
        extendedDynamicState2PatchControlPoints = extended_dynamic_state2_patch_control_points: U32,
    }
    VkPhysicalDeviceBlendOperationAdvancedFeaturesEXT: vk::PhysicalDeviceBlendOperationAdvancedFeaturesEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        advancedBlendCoherentOperations = advanced_blend_coherent_operations: U32,
    }
    VkImageFormatListCreateInfo: vk::ImageFormatListCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        viewFormatCount = view_format_count: U32,
        pViewFormats = p_view_formats: Array(&named!(vk::Format), By("viewFormatCount")),
    }
    VkCommandBufferInheritanceRenderingInfo: vk::CommandBufferInheritanceRenderingInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::RenderingFlags),
        viewMask = view_mask: U32,
        colorAttachmentCount = color_attachment_count: U32,
        pColorAttachmentFormats = p_color_attachment_formats: Array(&named!(vk::Format), By("colorAttachmentCount")),
        depthAttachmentFormat = depth_attachment_format: named!(vk::Format),
        stencilAttachmentFormat = stencil_attachment_format: named!(vk::Format),
        rasterizationSamples = rasterization_samples: flags!(vk::SampleCountFlags),
    }
    VkPhysicalDeviceDepthClipEnableFeaturesEXT: vk::PhysicalDeviceDepthClipEnableFeaturesEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        depthClipEnable = depth_clip_enable: U32,
    }
    VkPipelineRasterizationDepthClipStateCreateInfoEXT: vk::PipelineRasterizationDepthClipStateCreateInfoEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        flags = flags: flags!(vk::PipelineRasterizationDepthClipStateCreateFlagsEXT),
        depthClipEnable = depth_clip_enable: U32,
    }
    VkPipelineTessellationDomainOriginStateCreateInfo: vk::PipelineTessellationDomainOriginStateCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        domainOrigin = domain_origin: named!(vk::TessellationDomainOrigin),
    }
    VkPipelineRasterizationProvokingVertexStateCreateInfoEXT: vk::PipelineRasterizationProvokingVertexStateCreateInfoEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        provokingVertexMode = provoking_vertex_mode: named!(vk::ProvokingVertexModeEXT),
    }
    VkPipelineColorBlendAdvancedStateCreateInfoEXT: vk::PipelineColorBlendAdvancedStateCreateInfoEXT {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        srcPremultiplied = src_premultiplied: U32,
        dstPremultiplied = dst_premultiplied: U32,
        blendOverlap = blend_overlap: named!(vk::BlendOverlapEXT),
    }
    VkPipelineRenderingCreateInfo: vk::PipelineRenderingCreateInfo {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        viewMask = view_mask: U32,
        colorAttachmentCount = color_attachment_count: U32,
        pColorAttachmentFormats = p_color_attachment_formats: Array(&named!(vk::Format), By("colorAttachmentCount")),
        depthAttachmentFormat = depth_attachment_format: named!(vk::Format),
        stencilAttachmentFormat = stencil_attachment_format: named!(vk::Format),
    }
    VkAttachmentDescriptionStencilLayout: vk::AttachmentDescriptionStencilLayout {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        stencilInitialLayout = stencil_initial_layout: named!(vk::ImageLayout),
        stencilFinalLayout = stencil_final_layout: named!(vk::ImageLayout),
    }
    VkAttachmentReferenceStencilLayout: vk::AttachmentReferenceStencilLayout {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        stencilLayout = stencil_layout: named!(vk::ImageLayout),
    }
    VkSubpassDescriptionDepthStencilResolve: vk::SubpassDescriptionDepthStencilResolve {
        sType = s_type: named!(vk::StructureType),
        pNext = p_next: Next(chained),
        depthResolveMode = depth_resolve_mode: flags!(vk::ResolveModeFlags),
        stencilResolveMode = stencil_resolve_mode: flags!(vk::ResolveModeFlags),
        pDepthStencilResolveAttachment = p_depth_stencil_resolve_attachment: Array(&Struct(&VkAttachmentReference2), Fixed(1)),
    }
}

unions! {
    VkClearValue: vk::ClearValue,
    VkClearColorValue: vk::ClearColorValue,
}

chained! {
    VkPhysicalDeviceVulkan11Features: PHYSICAL_DEVICE_VULKAN_1_1_FEATURES,
    VkPhysicalDeviceVulkan12Features: PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
    VkPhysicalDeviceVulkan13Features: PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
    VkPhysicalDeviceProvokingVertexFeaturesEXT: PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT,
    VkPhysicalDeviceDynamicRenderingLocalReadFeaturesKHR: PHYSICAL_DEVICE_DYNAMIC_RENDERING_LOCAL_READ_FEATURES_KHR,
    VkPhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT: PHYSICAL_DEVICE_ATTACHMENT_FEEDBACK_LOOP_LAYOUT_FEATURES_EXT,
    VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT: PHYSICAL_DEVICE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_FEATURES_EXT,
    VkPhysicalDeviceExtendedDynamicState3FeaturesEXT: PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_3_FEATURES_EXT,
    VkPhysicalDeviceExtendedDynamicState2FeaturesEXT: PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE_2_FEATURES_EXT,
    VkPhysicalDeviceBlendOperationAdvancedFeaturesEXT: PHYSICAL_DEVICE_BLEND_OPERATION_ADVANCED_FEATURES_EXT,
    VkImageFormatListCreateInfo: IMAGE_FORMAT_LIST_CREATE_INFO,
    VkCommandBufferInheritanceRenderingInfo: COMMAND_BUFFER_INHERITANCE_RENDERING_INFO,
    VkPhysicalDeviceDepthClipEnableFeaturesEXT: PHYSICAL_DEVICE_DEPTH_CLIP_ENABLE_FEATURES_EXT,
    VkPipelineRasterizationDepthClipStateCreateInfoEXT: PIPELINE_RASTERIZATION_DEPTH_CLIP_STATE_CREATE_INFO_EXT,
    VkPipelineTessellationDomainOriginStateCreateInfo: PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO,
    VkPipelineRasterizationProvokingVertexStateCreateInfoEXT: PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT,
    VkPipelineColorBlendAdvancedStateCreateInfoEXT: PIPELINE_COLOR_BLEND_ADVANCED_STATE_CREATE_INFO_EXT,
    VkPipelineRenderingCreateInfo: PIPELINE_RENDERING_CREATE_INFO,
    VkAttachmentDescriptionStencilLayout: ATTACHMENT_DESCRIPTION_STENCIL_LAYOUT,
    VkAttachmentReferenceStencilLayout: ATTACHMENT_REFERENCE_STENCIL_LAYOUT,
    VkSubpassDescriptionDepthStencilResolve: SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE,
    VkMemoryBarrier2: MEMORY_BARRIER_2,
}
