/*
 * SwiftShader: finite colours beyond the range of R16G16B16A16_SFLOAT are stored as NaN
 *
 * Build and run:
 *   cc repro.c -ldl -o repro
 *   VK_DRIVER_FILES=/usr/lib/chromium/vk_swiftshader_icd.json ./repro
 *
 * The first argument, if there is one, is the index of the device; otherwise it is the one whose
 * name is that below, or the first. Exit status: 1 if the bug is there, 0 if not, 77 if the driver
 * lacks something, 2 if a call fails.
 * Needs the headers of the C library and none of the API. Structures and functions have the names
 * of the specification; the names of values are comments.
 */

#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BUG = 1, FAILED = 2, LACKS = 77 };

typedef uint64_t VkBuffer;
typedef void *VkCommandBuffer;
typedef uint64_t VkCommandPool;
typedef uint64_t VkDescriptorPool;
typedef uint64_t VkDescriptorSet;
typedef uint64_t VkDescriptorSetLayout;
typedef void *VkDevice;
typedef uint64_t VkDeviceMemory;
typedef uint64_t VkFence;
typedef uint64_t VkImage;
typedef uint64_t VkImageView;
typedef void *VkPhysicalDevice;
typedef uint64_t VkPipeline;
typedef uint64_t VkPipelineCache;
typedef uint64_t VkPipelineLayout;
typedef void *VkQueue;
typedef uint64_t VkRenderPass;
typedef uint64_t VkShaderModule;

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t queueCreateInfoCount;
    const void *pQueueCreateInfos;
    uint32_t enabledLayerCount;
    const void *ppEnabledLayerNames;
    uint32_t enabledExtensionCount;
    const void *ppEnabledExtensionNames;
    const void *pEnabledFeatures;
} VkDeviceCreateInfo;
typedef char size_of_VkDeviceCreateInfo[sizeof(VkDeviceCreateInfo) == 72 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t robustImageAccess;
    uint32_t inlineUniformBlock;
    uint32_t descriptorBindingInlineUniformBlockUpdateAfterBind;
    uint32_t pipelineCreationCacheControl;
    uint32_t privateData;
    uint32_t shaderDemoteToHelperInvocation;
    uint32_t shaderTerminateInvocation;
    uint32_t subgroupSizeControl;
    uint32_t computeFullSubgroups;
    uint32_t synchronization2;
    uint32_t textureCompressionASTC_HDR;
    uint32_t shaderZeroInitializeWorkgroupMemory;
    uint32_t dynamicRendering;
    uint32_t shaderIntegerDotProduct;
    uint32_t maintenance4;
} VkPhysicalDeviceVulkan13Features;
typedef char size_of_VkPhysicalDeviceVulkan13Features[sizeof(VkPhysicalDeviceVulkan13Features) == 80 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t queueFamilyIndex;
    uint32_t queueCount;
    const void *pQueuePriorities;
} VkDeviceQueueCreateInfo;
typedef char size_of_VkDeviceQueueCreateInfo[sizeof(VkDeviceQueueCreateInfo) == 40 ? 1 : -1];

typedef struct {
    uint32_t robustBufferAccess;
    uint32_t fullDrawIndexUint32;
    uint32_t imageCubeArray;
    uint32_t independentBlend;
    uint32_t geometryShader;
    uint32_t tessellationShader;
    uint32_t sampleRateShading;
    uint32_t dualSrcBlend;
    uint32_t logicOp;
    uint32_t multiDrawIndirect;
    uint32_t drawIndirectFirstInstance;
    uint32_t depthClamp;
    uint32_t depthBiasClamp;
    uint32_t fillModeNonSolid;
    uint32_t depthBounds;
    uint32_t wideLines;
    uint32_t largePoints;
    uint32_t alphaToOne;
    uint32_t multiViewport;
    uint32_t samplerAnisotropy;
    uint32_t textureCompressionETC2;
    uint32_t textureCompressionASTC_LDR;
    uint32_t textureCompressionBC;
    uint32_t occlusionQueryPrecise;
    uint32_t pipelineStatisticsQuery;
    uint32_t vertexPipelineStoresAndAtomics;
    uint32_t fragmentStoresAndAtomics;
    uint32_t shaderTessellationAndGeometryPointSize;
    uint32_t shaderImageGatherExtended;
    uint32_t shaderStorageImageExtendedFormats;
    uint32_t shaderStorageImageMultisample;
    uint32_t shaderStorageImageReadWithoutFormat;
    uint32_t shaderStorageImageWriteWithoutFormat;
    uint32_t shaderUniformBufferArrayDynamicIndexing;
    uint32_t shaderSampledImageArrayDynamicIndexing;
    uint32_t shaderStorageBufferArrayDynamicIndexing;
    uint32_t shaderStorageImageArrayDynamicIndexing;
    uint32_t shaderClipDistance;
    uint32_t shaderCullDistance;
    uint32_t shaderFloat64;
    uint32_t shaderInt64;
    uint32_t shaderInt16;
    uint32_t shaderResourceResidency;
    uint32_t shaderResourceMinLod;
    uint32_t sparseBinding;
    uint32_t sparseResidencyBuffer;
    uint32_t sparseResidencyImage2D;
    uint32_t sparseResidencyImage3D;
    uint32_t sparseResidency2Samples;
    uint32_t sparseResidency4Samples;
    uint32_t sparseResidency8Samples;
    uint32_t sparseResidency16Samples;
    uint32_t sparseResidencyAliased;
    uint32_t variableMultisampleRate;
    uint32_t inheritedQueries;
} VkPhysicalDeviceFeatures;
typedef char size_of_VkPhysicalDeviceFeatures[sizeof(VkPhysicalDeviceFeatures) == 220 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint64_t initialDataSize;
    const void *pInitialData;
} VkPipelineCacheCreateInfo;
typedef char size_of_VkPipelineCacheCreateInfo[sizeof(VkPipelineCacheCreateInfo) == 40 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint64_t size;
    uint32_t usage;
    uint32_t sharingMode;
    uint32_t queueFamilyIndexCount;
    const void *pQueueFamilyIndices;
} VkBufferCreateInfo;
typedef char size_of_VkBufferCreateInfo[sizeof(VkBufferCreateInfo) == 56 ? 1 : -1];

typedef struct {
    uint32_t width;
    uint32_t height;
    uint32_t depth;
} VkExtent3D;
typedef char size_of_VkExtent3D[sizeof(VkExtent3D) == 12 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t imageType;
    uint32_t format;
    VkExtent3D extent;
    uint32_t mipLevels;
    uint32_t arrayLayers;
    uint32_t samples;
    uint32_t tiling;
    uint32_t usage;
    uint32_t sharingMode;
    uint32_t queueFamilyIndexCount;
    const void *pQueueFamilyIndices;
    uint32_t initialLayout;
} VkImageCreateInfo;
typedef char size_of_VkImageCreateInfo[sizeof(VkImageCreateInfo) == 88 ? 1 : -1];

typedef struct {
    uint32_t r;
    uint32_t g;
    uint32_t b;
    uint32_t a;
} VkComponentMapping;
typedef char size_of_VkComponentMapping[sizeof(VkComponentMapping) == 16 ? 1 : -1];

typedef struct {
    uint32_t aspectMask;
    uint32_t baseMipLevel;
    uint32_t levelCount;
    uint32_t baseArrayLayer;
    uint32_t layerCount;
} VkImageSubresourceRange;
typedef char size_of_VkImageSubresourceRange[sizeof(VkImageSubresourceRange) == 20 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    VkImage image;
    uint32_t viewType;
    uint32_t format;
    VkComponentMapping components;
    VkImageSubresourceRange subresourceRange;
} VkImageViewCreateInfo;
typedef char size_of_VkImageViewCreateInfo[sizeof(VkImageViewCreateInfo) == 80 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t queueFamilyIndex;
} VkCommandPoolCreateInfo;
typedef char size_of_VkCommandPoolCreateInfo[sizeof(VkCommandPoolCreateInfo) == 24 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
} VkFenceCreateInfo;
typedef char size_of_VkFenceCreateInfo[sizeof(VkFenceCreateInfo) == 24 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t maxSets;
    uint32_t poolSizeCount;
    const void *pPoolSizes;
} VkDescriptorPoolCreateInfo;
typedef char size_of_VkDescriptorPoolCreateInfo[sizeof(VkDescriptorPoolCreateInfo) == 40 ? 1 : -1];

typedef struct {
    uint32_t type;
    uint32_t descriptorCount;
} VkDescriptorPoolSize;
typedef char size_of_VkDescriptorPoolSize[sizeof(VkDescriptorPoolSize) == 8 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t bindingCount;
    const void *pBindings;
} VkDescriptorSetLayoutCreateInfo;
typedef char size_of_VkDescriptorSetLayoutCreateInfo[sizeof(VkDescriptorSetLayoutCreateInfo) == 32 ? 1 : -1];

typedef struct {
    uint32_t binding;
    uint32_t descriptorType;
    uint32_t descriptorCount;
    uint32_t stageFlags;
    const void *pImmutableSamplers;
} VkDescriptorSetLayoutBinding;
typedef char size_of_VkDescriptorSetLayoutBinding[sizeof(VkDescriptorSetLayoutBinding) == 24 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t setLayoutCount;
    const void *pSetLayouts;
    uint32_t pushConstantRangeCount;
    const void *pPushConstantRanges;
} VkPipelineLayoutCreateInfo;
typedef char size_of_VkPipelineLayoutCreateInfo[sizeof(VkPipelineLayoutCreateInfo) == 48 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    VkDescriptorPool descriptorPool;
    uint32_t descriptorSetCount;
    const void *pSetLayouts;
} VkDescriptorSetAllocateInfo;
typedef char size_of_VkDescriptorSetAllocateInfo[sizeof(VkDescriptorSetAllocateInfo) == 40 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    VkDescriptorSet dstSet;
    uint32_t dstBinding;
    uint32_t dstArrayElement;
    uint32_t descriptorCount;
    uint32_t descriptorType;
    const void *pImageInfo;
    const void *pBufferInfo;
    const void *pTexelBufferView;
} VkWriteDescriptorSet;
typedef char size_of_VkWriteDescriptorSet[sizeof(VkWriteDescriptorSet) == 64 ? 1 : -1];

typedef struct {
    VkBuffer buffer;
    uint64_t offset;
    uint64_t range;
} VkDescriptorBufferInfo;
typedef char size_of_VkDescriptorBufferInfo[sizeof(VkDescriptorBufferInfo) == 24 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint64_t codeSize;
    const void *pCode;
} VkShaderModuleCreateInfo;
typedef char size_of_VkShaderModuleCreateInfo[sizeof(VkShaderModuleCreateInfo) == 40 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t stageCount;
    const void *pStages;
    const void *pVertexInputState;
    const void *pInputAssemblyState;
    const void *pTessellationState;
    const void *pViewportState;
    const void *pRasterizationState;
    const void *pMultisampleState;
    const void *pDepthStencilState;
    const void *pColorBlendState;
    const void *pDynamicState;
    VkPipelineLayout layout;
    VkRenderPass renderPass;
    uint32_t subpass;
    VkPipeline basePipelineHandle;
    int32_t basePipelineIndex;
} VkGraphicsPipelineCreateInfo;
typedef char size_of_VkGraphicsPipelineCreateInfo[sizeof(VkGraphicsPipelineCreateInfo) == 144 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t viewMask;
    uint32_t colorAttachmentCount;
    const void *pColorAttachmentFormats;
    uint32_t depthAttachmentFormat;
    uint32_t stencilAttachmentFormat;
} VkPipelineRenderingCreateInfo;
typedef char size_of_VkPipelineRenderingCreateInfo[sizeof(VkPipelineRenderingCreateInfo) == 40 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t stage;
    VkShaderModule module;
    const void *pName;
    const void *pSpecializationInfo;
} VkPipelineShaderStageCreateInfo;
typedef char size_of_VkPipelineShaderStageCreateInfo[sizeof(VkPipelineShaderStageCreateInfo) == 48 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t vertexBindingDescriptionCount;
    const void *pVertexBindingDescriptions;
    uint32_t vertexAttributeDescriptionCount;
    const void *pVertexAttributeDescriptions;
} VkPipelineVertexInputStateCreateInfo;
typedef char size_of_VkPipelineVertexInputStateCreateInfo[sizeof(VkPipelineVertexInputStateCreateInfo) == 48 ? 1 : -1];

typedef struct {
    uint32_t binding;
    uint32_t stride;
    uint32_t inputRate;
} VkVertexInputBindingDescription;
typedef char size_of_VkVertexInputBindingDescription[sizeof(VkVertexInputBindingDescription) == 12 ? 1 : -1];

typedef struct {
    uint32_t location;
    uint32_t binding;
    uint32_t format;
    uint32_t offset;
} VkVertexInputAttributeDescription;
typedef char size_of_VkVertexInputAttributeDescription[sizeof(VkVertexInputAttributeDescription) == 16 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t topology;
    uint32_t primitiveRestartEnable;
} VkPipelineInputAssemblyStateCreateInfo;
typedef char size_of_VkPipelineInputAssemblyStateCreateInfo[sizeof(VkPipelineInputAssemblyStateCreateInfo) == 32 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t viewportCount;
    const void *pViewports;
    uint32_t scissorCount;
    const void *pScissors;
} VkPipelineViewportStateCreateInfo;
typedef char size_of_VkPipelineViewportStateCreateInfo[sizeof(VkPipelineViewportStateCreateInfo) == 48 ? 1 : -1];

typedef struct {
    float x;
    float y;
    float width;
    float height;
    float minDepth;
    float maxDepth;
} VkViewport;
typedef char size_of_VkViewport[sizeof(VkViewport) == 24 ? 1 : -1];

typedef struct {
    int32_t x;
    int32_t y;
} VkOffset2D;
typedef char size_of_VkOffset2D[sizeof(VkOffset2D) == 8 ? 1 : -1];

typedef struct {
    uint32_t width;
    uint32_t height;
} VkExtent2D;
typedef char size_of_VkExtent2D[sizeof(VkExtent2D) == 8 ? 1 : -1];

typedef struct {
    VkOffset2D offset;
    VkExtent2D extent;
} VkRect2D;
typedef char size_of_VkRect2D[sizeof(VkRect2D) == 16 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t depthClampEnable;
    uint32_t rasterizerDiscardEnable;
    uint32_t polygonMode;
    uint32_t cullMode;
    uint32_t frontFace;
    uint32_t depthBiasEnable;
    float depthBiasConstantFactor;
    float depthBiasClamp;
    float depthBiasSlopeFactor;
    float lineWidth;
} VkPipelineRasterizationStateCreateInfo;
typedef char size_of_VkPipelineRasterizationStateCreateInfo[sizeof(VkPipelineRasterizationStateCreateInfo) == 64 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t rasterizationSamples;
    uint32_t sampleShadingEnable;
    float minSampleShading;
    const void *pSampleMask;
    uint32_t alphaToCoverageEnable;
    uint32_t alphaToOneEnable;
} VkPipelineMultisampleStateCreateInfo;
typedef char size_of_VkPipelineMultisampleStateCreateInfo[sizeof(VkPipelineMultisampleStateCreateInfo) == 48 ? 1 : -1];

typedef struct {
    uint32_t failOp;
    uint32_t passOp;
    uint32_t depthFailOp;
    uint32_t compareOp;
    uint32_t compareMask;
    uint32_t writeMask;
    uint32_t reference;
} VkStencilOpState;
typedef char size_of_VkStencilOpState[sizeof(VkStencilOpState) == 28 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t depthTestEnable;
    uint32_t depthWriteEnable;
    uint32_t depthCompareOp;
    uint32_t depthBoundsTestEnable;
    uint32_t stencilTestEnable;
    VkStencilOpState front;
    VkStencilOpState back;
    float minDepthBounds;
    float maxDepthBounds;
} VkPipelineDepthStencilStateCreateInfo;
typedef char size_of_VkPipelineDepthStencilStateCreateInfo[sizeof(VkPipelineDepthStencilStateCreateInfo) == 104 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t logicOpEnable;
    uint32_t logicOp;
    uint32_t attachmentCount;
    const void *pAttachments;
    float blendConstants[4];
} VkPipelineColorBlendStateCreateInfo;
typedef char size_of_VkPipelineColorBlendStateCreateInfo[sizeof(VkPipelineColorBlendStateCreateInfo) == 56 ? 1 : -1];

typedef struct {
    uint32_t blendEnable;
    uint32_t srcColorBlendFactor;
    uint32_t dstColorBlendFactor;
    uint32_t colorBlendOp;
    uint32_t srcAlphaBlendFactor;
    uint32_t dstAlphaBlendFactor;
    uint32_t alphaBlendOp;
    uint32_t colorWriteMask;
} VkPipelineColorBlendAttachmentState;
typedef char size_of_VkPipelineColorBlendAttachmentState[sizeof(VkPipelineColorBlendAttachmentState) == 32 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t dynamicStateCount;
    const void *pDynamicStates;
} VkPipelineDynamicStateCreateInfo;
typedef char size_of_VkPipelineDynamicStateCreateInfo[sizeof(VkPipelineDynamicStateCreateInfo) == 32 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    VkCommandPool commandPool;
    uint32_t level;
    uint32_t commandBufferCount;
} VkCommandBufferAllocateInfo;
typedef char size_of_VkCommandBufferAllocateInfo[sizeof(VkCommandBufferAllocateInfo) == 32 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    const void *pInheritanceInfo;
} VkCommandBufferBeginInfo;
typedef char size_of_VkCommandBufferBeginInfo[sizeof(VkCommandBufferBeginInfo) == 32 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t dependencyFlags;
    uint32_t memoryBarrierCount;
    const void *pMemoryBarriers;
    uint32_t bufferMemoryBarrierCount;
    const void *pBufferMemoryBarriers;
    uint32_t imageMemoryBarrierCount;
    const void *pImageMemoryBarriers;
} VkDependencyInfo;
typedef char size_of_VkDependencyInfo[sizeof(VkDependencyInfo) == 64 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint64_t srcStageMask;
    uint64_t srcAccessMask;
    uint64_t dstStageMask;
    uint64_t dstAccessMask;
    uint32_t oldLayout;
    uint32_t newLayout;
    uint32_t srcQueueFamilyIndex;
    uint32_t dstQueueFamilyIndex;
    VkImage image;
    VkImageSubresourceRange subresourceRange;
} VkImageMemoryBarrier2;
typedef char size_of_VkImageMemoryBarrier2[sizeof(VkImageMemoryBarrier2) == 96 ? 1 : -1];

typedef struct {
    uint32_t bits[4];
} VkClearColorValue;
typedef char size_of_VkClearColorValue[sizeof(VkClearColorValue) == 16 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    VkRect2D renderArea;
    uint32_t layerCount;
    uint32_t viewMask;
    uint32_t colorAttachmentCount;
    const void *pColorAttachments;
    const void *pDepthAttachment;
    const void *pStencilAttachment;
} VkRenderingInfo;
typedef char size_of_VkRenderingInfo[sizeof(VkRenderingInfo) == 72 ? 1 : -1];

typedef struct {
    uint32_t bits[4];
} VkClearValue;
typedef char size_of_VkClearValue[sizeof(VkClearValue) == 16 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    VkImageView imageView;
    uint32_t imageLayout;
    uint32_t resolveMode;
    VkImageView resolveImageView;
    uint32_t resolveImageLayout;
    uint32_t loadOp;
    uint32_t storeOp;
    VkClearValue clearValue;
} VkRenderingAttachmentInfo;
typedef char size_of_VkRenderingAttachmentInfo[sizeof(VkRenderingAttachmentInfo) == 72 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint32_t flags;
    uint32_t waitSemaphoreInfoCount;
    const void *pWaitSemaphoreInfos;
    uint32_t commandBufferInfoCount;
    const void *pCommandBufferInfos;
    uint32_t signalSemaphoreInfoCount;
    const void *pSignalSemaphoreInfos;
} VkSubmitInfo2;
typedef char size_of_VkSubmitInfo2[sizeof(VkSubmitInfo2) == 64 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    VkCommandBuffer commandBuffer;
    uint32_t deviceMask;
} VkCommandBufferSubmitInfo;
typedef char size_of_VkCommandBufferSubmitInfo[sizeof(VkCommandBufferSubmitInfo) == 32 ? 1 : -1];

typedef struct {
    uint32_t aspectMask;
    uint32_t mipLevel;
    uint32_t baseArrayLayer;
    uint32_t layerCount;
} VkImageSubresourceLayers;
typedef char size_of_VkImageSubresourceLayers[sizeof(VkImageSubresourceLayers) == 16 ? 1 : -1];

typedef struct {
    int32_t x;
    int32_t y;
    int32_t z;
} VkOffset3D;
typedef char size_of_VkOffset3D[sizeof(VkOffset3D) == 12 ? 1 : -1];

typedef struct {
    uint64_t bufferOffset;
    uint32_t bufferRowLength;
    uint32_t bufferImageHeight;
    VkImageSubresourceLayers imageSubresource;
    VkOffset3D imageOffset;
    VkExtent3D imageExtent;
} VkBufferImageCopy;
typedef char size_of_VkBufferImageCopy[sizeof(VkBufferImageCopy) == 56 ? 1 : -1];

typedef struct {
    uint32_t sType;
    const void *pNext;
    uint64_t srcStageMask;
    uint64_t srcAccessMask;
    uint64_t dstStageMask;
    uint64_t dstAccessMask;
} VkMemoryBarrier2;
typedef char size_of_VkMemoryBarrier2[sizeof(VkMemoryBarrier2) == 48 ? 1 : -1];

static int32_t (*vkAllocateCommandBuffers)(VkDevice, const void *, void *);
static int32_t (*vkAllocateDescriptorSets)(VkDevice, const void *, void *);
static int32_t (*vkBeginCommandBuffer)(VkCommandBuffer, const void *);
static int32_t (*vkBindBufferMemory)(VkDevice, VkBuffer, VkDeviceMemory, uint64_t);
static int32_t (*vkBindImageMemory)(VkDevice, VkImage, VkDeviceMemory, uint64_t);
static void (*vkCmdBeginRendering)(VkCommandBuffer, const void *);
static void (*vkCmdBindDescriptorSets)(VkCommandBuffer, uint32_t, VkPipelineLayout, uint32_t, uint32_t, const void *, uint32_t, const void *);
static void (*vkCmdBindPipeline)(VkCommandBuffer, uint32_t, VkPipeline);
static void (*vkCmdBindVertexBuffers)(VkCommandBuffer, uint32_t, uint32_t, const void *, const void *);
static void (*vkCmdClearColorImage)(VkCommandBuffer, VkImage, uint32_t, const void *, uint32_t, const void *);
static void (*vkCmdCopyImageToBuffer)(VkCommandBuffer, VkImage, uint32_t, VkBuffer, uint32_t, const void *);
static void (*vkCmdDraw)(VkCommandBuffer, uint32_t, uint32_t, uint32_t, uint32_t);
static void (*vkCmdEndRendering)(VkCommandBuffer);
static void (*vkCmdPipelineBarrier2)(VkCommandBuffer, const void *);
static void (*vkCmdSetBlendConstants)(VkCommandBuffer, const void *);
static void (*vkCmdSetCullMode)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetDepthBias)(VkCommandBuffer, float, float, float);
static void (*vkCmdSetDepthBiasEnable)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetDepthBounds)(VkCommandBuffer, float, float);
static void (*vkCmdSetDepthBoundsTestEnable)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetDepthCompareOp)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetDepthTestEnable)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetDepthWriteEnable)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetFrontFace)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetPrimitiveRestartEnable)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetPrimitiveTopology)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetRasterizerDiscardEnable)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetScissor)(VkCommandBuffer, uint32_t, uint32_t, const void *);
static void (*vkCmdSetStencilCompareMask)(VkCommandBuffer, uint32_t, uint32_t);
static void (*vkCmdSetStencilOp)(VkCommandBuffer, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t);
static void (*vkCmdSetStencilReference)(VkCommandBuffer, uint32_t, uint32_t);
static void (*vkCmdSetStencilTestEnable)(VkCommandBuffer, uint32_t);
static void (*vkCmdSetStencilWriteMask)(VkCommandBuffer, uint32_t, uint32_t);
static void (*vkCmdSetViewport)(VkCommandBuffer, uint32_t, uint32_t, const void *);
static int32_t (*vkCreateBuffer)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateCommandPool)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateDescriptorPool)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateDescriptorSetLayout)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateFence)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateGraphicsPipelines)(VkDevice, VkPipelineCache, uint32_t, const void *, const void *, void *);
static int32_t (*vkCreateImageView)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreatePipelineCache)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreatePipelineLayout)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateShaderModule)(VkDevice, const void *, const void *, void *);
static int32_t (*vkEndCommandBuffer)(VkCommandBuffer);
static void (*vkGetBufferMemoryRequirements)(VkDevice, VkBuffer, void *);
static void (*vkGetDeviceQueue)(VkDevice, uint32_t, uint32_t, void *);
static void (*vkGetImageMemoryRequirements)(VkDevice, VkImage, void *);
static int32_t (*vkQueueSubmit2)(VkQueue, uint32_t, const void *, VkFence);
static int32_t (*vkResetCommandPool)(VkDevice, VkCommandPool, uint32_t);
static int32_t (*vkResetFences)(VkDevice, uint32_t, const void *);
static void (*vkUpdateDescriptorSets)(VkDevice, uint32_t, const void *, uint32_t, const void *);
static int32_t (*vkWaitForFences)(VkDevice, uint32_t, const void *, uint32_t, uint64_t);

static const char *const wanted = "SwiftShader Device (Subzero)";
static const uint32_t version = 0x403000;
/* Formats that are blended into; modes in which depth and stencil are resolved. */
static const uint32_t blended[] = { 0 };
static const uint32_t depth_resolve = 0, stencil_resolve = 0, independent = 0, independent_none = 0;

typedef struct {
    uint64_t size, alignment;
    uint32_t types;
} Requirements;

typedef struct {
    uint32_t count;
    struct {
        uint32_t flags, heap;
    } types[32];
    uint32_t heaps;
    struct {
        uint64_t size;
        uint64_t flags;
    } all_heaps[16];
} MemoryProperties;

static void *(*find_instance_function)(void *, const char *);
static void *(*find_device_function)(void *, const char *);
static void *instance;
static VkPhysicalDevice physical;
static MemoryProperties memory_properties;
static Requirements needs;

static void lacks(const char *what)
{
    printf("not supported: %s\n", what);
    exit(LACKS);
}

/* Ends the program if a call has failed. */
static void check(int32_t result, const char *call, int line)
{
    if (result) {
        printf("line %d: %s: VkResult %d\n", line, call, result);
        /* A feature, an extension, a layer or a format that the driver does not have. */
        exit(result == -8 || result == -7 || result == -6 || result == -11 || result == -9 ? LACKS : FAILED);
    }
}

static void *instance_function(const char *name)
{
    void *address = find_instance_function(instance, name);
    if (!address)
        lacks(name);
    return address;
}

static void *device_function(VkDevice device, const char *name)
{
    void *address = find_device_function(device, name);
    if (!address)
        lacks(name);
    return address;
}

/* Ends the program if the device lacks what no feature stands for. */
static void check_device(void)
{
    struct {
        uint32_t linear, optimal, buffer;
    } format;
    struct {
        uint32_t type;
        void *next;
        uint32_t depth, stencil, independent_none, independent;
    } resolves = { 1000199000, NULL, 0, 0, 0, 0 };
    static struct {
        uint32_t type;
        void *next;
        union {
            unsigned char bytes[2048];
            uint64_t aligned;
        } properties;
    } both;
    void (*get_format)(VkPhysicalDevice, uint32_t, void *);
    void (*get_properties)(VkPhysicalDevice, void *);
    uint32_t i;
    *(void **)&get_format = instance_function("vkGetPhysicalDeviceFormatProperties");
    *(void **)&get_properties = instance_function("vkGetPhysicalDeviceProperties2");
    for (i = 0; blended[i]; i++) {
        get_format(physical, blended[i], &format);
        /* VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT */
        if (!(format.optimal & 0x100))
            lacks("blending into the format");
    }
    both.type = 1000059001;
    both.next = &resolves;
    get_properties(physical, &both);
    if ((resolves.depth & depth_resolve) != depth_resolve || (resolves.stencil & stencil_resolve) != stencil_resolve
        || resolves.independent < independent || resolves.independent_none < independent_none)
        lacks("the mode in which depth or stencil is resolved");
}

/* Makes the instance, and chooses a device. */
static void choose_device(int index)
{
    void *library = dlopen("libvulkan.so.1", RTLD_NOW);
    struct {
        uint32_t type;
        const void *next;
        const char *name;
        uint32_t name_version;
        const char *engine;
        uint32_t engine_version, version;
    } application = { 0, NULL, "repro", 0, NULL, 0, version };
    struct {
        uint32_t type;
        const void *next;
        uint32_t flags;
        const void *application;
        uint32_t layers;
        const void *layer_names;
        uint32_t extensions;
        const void *extension_names;
    } info = { 1, NULL, 0, &application, 0, NULL, 0, NULL };
    int32_t (*create_instance)(const void *, const void *, void **);
    int32_t (*enumerate)(void *, uint32_t *, VkPhysicalDevice *);
    void (*get_properties)(VkPhysicalDevice, void *);
    void (*get_memory)(VkPhysicalDevice, MemoryProperties *);
    static union {
        unsigned char bytes[2048];
        uint64_t aligned;
    } properties;
    static VkPhysicalDevice all[64];
    uint32_t number = 64, i, api;
    const char *name = (const char *)properties.bytes + 20;
    if (!library)
        lacks(dlerror());
    *(void **)&find_instance_function = dlsym(library, "vkGetInstanceProcAddr");
    if (!find_instance_function)
        lacks("vkGetInstanceProcAddr");
    *(void **)&create_instance = instance_function("vkCreateInstance");
    check(create_instance(&info, NULL, &instance), "vkCreateInstance", __LINE__);
    *(void **)&enumerate = instance_function("vkEnumeratePhysicalDevices");
    *(void **)&get_properties = instance_function("vkGetPhysicalDeviceProperties");
    *(void **)&get_memory = instance_function("vkGetPhysicalDeviceMemoryProperties");
    *(void **)&find_device_function = instance_function("vkGetDeviceProcAddr");
    check(enumerate(instance, &number, all), "vkEnumeratePhysicalDevices", __LINE__);
    if (!number || index >= (int)number)
        lacks("the device");
    for (i = 0; index < 0 && i < number; i++) {
        get_properties(all[i], properties.bytes);
        if (!strcmp(name, wanted))
            index = (int)i;
    }
    physical = all[index < 0 ? 0 : index];
    get_properties(physical, properties.bytes);
    memcpy(&api, properties.bytes, sizeof api);
    printf("%s\n", name);
    if (api < version)
        lacks("the version of Vulkan");
    get_memory(physical, &memory_properties);
    check_device();
}

static VkDevice create_device(const void *info, int line)
{
    int32_t (*create)(VkPhysicalDevice, const void *, const void *, VkDevice *);
    VkDevice device = NULL;
    *(void **)&create = instance_function("vkCreateDevice");
    check(create(physical, info, NULL, &device), "vkCreateDevice", line);
    return device;
}

/* Creates an image, if the driver has its format for its usage. */
static void create_image(VkDevice device, const VkImageCreateInfo *info, VkImage *image, int line)
{
    int32_t (*get_format)(VkPhysicalDevice, uint32_t, uint32_t, uint32_t, uint32_t, uint32_t, void *);
    int32_t (*create)(VkDevice, const void *, const void *, VkImage *);
    struct {
        uint32_t width, height, depth, levels, layers, samples;
        uint64_t size;
    } format = { 0, 0, 0, 0, 0, 0, 0 };
    *(void **)&get_format = instance_function("vkGetPhysicalDeviceImageFormatProperties");
    *(void **)&create = device_function(device, "vkCreateImage");
    check(
        get_format(physical, info->format, info->imageType, info->tiling, info->usage, info->flags, &format),
        "vkGetPhysicalDeviceImageFormatProperties", line);
    if (format.width < info->extent.width || format.height < info->extent.height || format.layers < info->arrayLayers
        || format.levels < info->mipLevels || !(format.samples & info->samples))
        lacks("such an image");
    check(create(device, info, NULL, image), "vkCreateImage", line);
}

/* Allocates what the last buffer or image needs, of a type that has these properties. */
static void allocate(VkDevice device, uint32_t flags, VkDeviceMemory *memory, int line)
{
    struct {
        uint32_t type;
        const void *next;
        uint64_t size;
        uint32_t memory_type;
    } info = { 5, NULL, 0, 0 };
    int32_t (*allocate_memory)(VkDevice, const void *, const void *, VkDeviceMemory *);
    uint32_t i, wanted_flags[2];
    int tries;
    /* Else of one that the host sees, if it has to. */
    wanted_flags[0] = flags;
    wanted_flags[1] = flags & 6;
    *(void **)&allocate_memory = device_function(device, "vkAllocateMemory");
    info.size = needs.size;
    for (tries = 0; tries < 2; tries++)
        for (i = 0; i < memory_properties.count; i++)
            if ((needs.types >> i & 1) && (memory_properties.types[i].flags & wanted_flags[tries]) == wanted_flags[tries]) {
                info.memory_type = i;
                check(allocate_memory(device, &info, NULL, memory), "vkAllocateMemory", line);
                return;
            }
    lacks("a memory type");
}

static unsigned char *map(VkDevice device, VkDeviceMemory memory, int line)
{
    int32_t (*map_memory)(VkDevice, VkDeviceMemory, uint64_t, uint64_t, uint32_t, void **);
    void *start = NULL;
    *(void **)&map_memory = device_function(device, "vkMapMemory");
    check(map_memory(device, memory, 0, ~(uint64_t)0, 0, &start), "vkMapMemory", line);
    return start;
}

static void load_device(VkDevice device)
{
    *(void **)&vkAllocateCommandBuffers = device_function(device, "vkAllocateCommandBuffers");
    *(void **)&vkAllocateDescriptorSets = device_function(device, "vkAllocateDescriptorSets");
    *(void **)&vkBeginCommandBuffer = device_function(device, "vkBeginCommandBuffer");
    *(void **)&vkBindBufferMemory = device_function(device, "vkBindBufferMemory");
    *(void **)&vkBindImageMemory = device_function(device, "vkBindImageMemory");
    *(void **)&vkCmdBeginRendering = device_function(device, "vkCmdBeginRendering");
    *(void **)&vkCmdBindDescriptorSets = device_function(device, "vkCmdBindDescriptorSets");
    *(void **)&vkCmdBindPipeline = device_function(device, "vkCmdBindPipeline");
    *(void **)&vkCmdBindVertexBuffers = device_function(device, "vkCmdBindVertexBuffers");
    *(void **)&vkCmdClearColorImage = device_function(device, "vkCmdClearColorImage");
    *(void **)&vkCmdCopyImageToBuffer = device_function(device, "vkCmdCopyImageToBuffer");
    *(void **)&vkCmdDraw = device_function(device, "vkCmdDraw");
    *(void **)&vkCmdEndRendering = device_function(device, "vkCmdEndRendering");
    *(void **)&vkCmdPipelineBarrier2 = device_function(device, "vkCmdPipelineBarrier2");
    *(void **)&vkCmdSetBlendConstants = device_function(device, "vkCmdSetBlendConstants");
    *(void **)&vkCmdSetCullMode = device_function(device, "vkCmdSetCullMode");
    *(void **)&vkCmdSetDepthBias = device_function(device, "vkCmdSetDepthBias");
    *(void **)&vkCmdSetDepthBiasEnable = device_function(device, "vkCmdSetDepthBiasEnable");
    *(void **)&vkCmdSetDepthBounds = device_function(device, "vkCmdSetDepthBounds");
    *(void **)&vkCmdSetDepthBoundsTestEnable = device_function(device, "vkCmdSetDepthBoundsTestEnable");
    *(void **)&vkCmdSetDepthCompareOp = device_function(device, "vkCmdSetDepthCompareOp");
    *(void **)&vkCmdSetDepthTestEnable = device_function(device, "vkCmdSetDepthTestEnable");
    *(void **)&vkCmdSetDepthWriteEnable = device_function(device, "vkCmdSetDepthWriteEnable");
    *(void **)&vkCmdSetFrontFace = device_function(device, "vkCmdSetFrontFace");
    *(void **)&vkCmdSetPrimitiveRestartEnable = device_function(device, "vkCmdSetPrimitiveRestartEnable");
    *(void **)&vkCmdSetPrimitiveTopology = device_function(device, "vkCmdSetPrimitiveTopology");
    *(void **)&vkCmdSetRasterizerDiscardEnable = device_function(device, "vkCmdSetRasterizerDiscardEnable");
    *(void **)&vkCmdSetScissor = device_function(device, "vkCmdSetScissor");
    *(void **)&vkCmdSetStencilCompareMask = device_function(device, "vkCmdSetStencilCompareMask");
    *(void **)&vkCmdSetStencilOp = device_function(device, "vkCmdSetStencilOp");
    *(void **)&vkCmdSetStencilReference = device_function(device, "vkCmdSetStencilReference");
    *(void **)&vkCmdSetStencilTestEnable = device_function(device, "vkCmdSetStencilTestEnable");
    *(void **)&vkCmdSetStencilWriteMask = device_function(device, "vkCmdSetStencilWriteMask");
    *(void **)&vkCmdSetViewport = device_function(device, "vkCmdSetViewport");
    *(void **)&vkCreateBuffer = device_function(device, "vkCreateBuffer");
    *(void **)&vkCreateCommandPool = device_function(device, "vkCreateCommandPool");
    *(void **)&vkCreateDescriptorPool = device_function(device, "vkCreateDescriptorPool");
    *(void **)&vkCreateDescriptorSetLayout = device_function(device, "vkCreateDescriptorSetLayout");
    *(void **)&vkCreateFence = device_function(device, "vkCreateFence");
    *(void **)&vkCreateGraphicsPipelines = device_function(device, "vkCreateGraphicsPipelines");
    *(void **)&vkCreateImageView = device_function(device, "vkCreateImageView");
    *(void **)&vkCreatePipelineCache = device_function(device, "vkCreatePipelineCache");
    *(void **)&vkCreatePipelineLayout = device_function(device, "vkCreatePipelineLayout");
    *(void **)&vkCreateShaderModule = device_function(device, "vkCreateShaderModule");
    *(void **)&vkEndCommandBuffer = device_function(device, "vkEndCommandBuffer");
    *(void **)&vkGetBufferMemoryRequirements = device_function(device, "vkGetBufferMemoryRequirements");
    *(void **)&vkGetDeviceQueue = device_function(device, "vkGetDeviceQueue");
    *(void **)&vkGetImageMemoryRequirements = device_function(device, "vkGetImageMemoryRequirements");
    *(void **)&vkQueueSubmit2 = device_function(device, "vkQueueSubmit2");
    *(void **)&vkResetCommandPool = device_function(device, "vkResetCommandPool");
    *(void **)&vkResetFences = device_function(device, "vkResetFences");
    *(void **)&vkUpdateDescriptorSets = device_function(device, "vkUpdateDescriptorSets");
    *(void **)&vkWaitForFences = device_function(device, "vkWaitForFences");
}

static VkDevice device_1;
static VkQueue queue_1;
static VkPipelineCache pipeline_cache_1;
static VkBuffer buffer_1;
static VkDeviceMemory device_memory_1;
static unsigned char * mapped_1;
static VkImage image_1;
static VkDeviceMemory device_memory_2;
static VkImageView image_view_1;
static VkCommandPool command_pool_1;
static VkFence fence_1;
static VkDescriptorPool descriptor_pool_1;
static VkDescriptorSetLayout descriptor_set_layout_1;
static VkPipelineLayout pipeline_layout_1;
static VkDescriptorSet descriptor_set_1;
static VkShaderModule shader_module_1;
static VkPipeline pipeline_1;
static VkBuffer buffer_2;
static VkDeviceMemory device_memory_3;
static unsigned char * mapped_2;
static VkCommandBuffer command_buffer_1;
static unsigned char memory_0[8];
static const uint32_t data_1[60] = {
    0xbf800000, 0xbf000000, 0x00000000, 0x3f800000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x3f800000, 0xbf800000,
    0x00000000, 0x3f800000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x3f000000, 0x3f800000, 0x00000000, 0x3f800000,
    0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0xbf800000, 0xbf000000, 0x00000000, 0x3f800000, 0x00000000, 0x00000000,
    0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x3f000000, 0x3f800000, 0x00000000, 0x3f800000, 0x00000000, 0x00000000, 0x00000000, 0x00000000,
    0x00000000, 0x00000000, 0xbf800000, 0x3f800000, 0x00000000, 0x3f800000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000, 0x00000000,
};
static const uint32_t data_2[8] = {
    0x00000000, 0x00000000, 0x00000000, 0x4788b800, 0x00000000, 0x00000000, 0x00000000, 0x00000000,
};
static const uint32_t data_3[201] = {
    0x07230203, 0x00010300, 0x0000001c, 0x00000020, 0x00000000, 0x00020011, 0x00000001, 0x0006000b, 0x00000001, 0x4c534c47, 0x6474732e, 0x3035342e,
    0x00000000, 0x0003000e, 0x00000000, 0x00000001, 0x0007000f, 0x00000000, 0x00000012, 0x00007376, 0x0000000a, 0x0000000d, 0x0000000f, 0x0005000f,
    0x00000004, 0x00000017, 0x00007366, 0x00000016, 0x00030010, 0x00000017, 0x00000007, 0x00050048, 0x00000005, 0x00000000, 0x00000023, 0x00000000,
    0x00050048, 0x00000005, 0x00000001, 0x00000023, 0x00000010, 0x00040047, 0x00000006, 0x00000022, 0x00000000, 0x00040047, 0x00000006, 0x00000021,
    0x00000000, 0x00030047, 0x00000007, 0x00000002, 0x00050048, 0x00000007, 0x00000000, 0x00000023, 0x00000000, 0x00040047, 0x0000000a, 0x0000001e,
    0x00000000, 0x00040047, 0x0000000d, 0x0000000b, 0x00000000, 0x00040047, 0x0000000f, 0x0000000b, 0x00000001, 0x00040047, 0x00000016, 0x0000001e,
    0x00000000, 0x00020013, 0x00000002, 0x00030016, 0x00000004, 0x00000020, 0x00040017, 0x00000003, 0x00000004, 0x00000004, 0x0004001e, 0x00000005,
    0x00000003, 0x00000003, 0x0003001e, 0x00000007, 0x00000005, 0x00040020, 0x00000008, 0x00000002, 0x00000007, 0x0004003b, 0x00000008, 0x00000006,
    0x00000002, 0x00040020, 0x0000000b, 0x00000001, 0x00000003, 0x0004003b, 0x0000000b, 0x0000000a, 0x00000001, 0x00040020, 0x0000000e, 0x00000003,
    0x00000003, 0x0004003b, 0x0000000e, 0x0000000d, 0x00000003, 0x00040020, 0x00000010, 0x00000003, 0x00000004, 0x0004003b, 0x00000010, 0x0000000f,
    0x00000003, 0x0004002b, 0x00000004, 0x00000011, 0x3f800000, 0x00030021, 0x00000013, 0x00000002, 0x0004003b, 0x0000000e, 0x00000016, 0x00000003,
    0x00040020, 0x00000018, 0x00000002, 0x00000005, 0x00040015, 0x0000001a, 0x00000020, 0x00000000, 0x0004002b, 0x0000001a, 0x00000019, 0x00000000,
    0x00040020, 0x0000001d, 0x00000002, 0x00000003, 0x00050036, 0x00000002, 0x00000012, 0x00000000, 0x00000013, 0x000200f8, 0x00000009, 0x0004003d,
    0x00000003, 0x0000000c, 0x0000000a, 0x0003003e, 0x0000000f, 0x00000011, 0x000200f9, 0x00000014, 0x000200f8, 0x00000014, 0x0003003e, 0x0000000d,
    0x0000000c, 0x000100fd, 0x00010038, 0x00050036, 0x00000002, 0x00000017, 0x00000000, 0x00000013, 0x000200f8, 0x00000015, 0x00050041, 0x00000018,
    0x0000001b, 0x00000006, 0x00000019, 0x000200f9, 0x0000001c, 0x000200f8, 0x0000001c, 0x00050041, 0x0000001d, 0x0000001e, 0x0000001b, 0x00000019,
    0x0004003d, 0x00000003, 0x0000001f, 0x0000001e, 0x0003003e, 0x00000016, 0x0000001f, 0x000100fd, 0x00010038,
};

static void prepare(void)
{
    device_1 = create_device(
        (const VkDeviceCreateInfo[]){
            {
                .sType = 3 /* DEVICE_CREATE_INFO */,
                .pNext = (const VkPhysicalDeviceVulkan13Features[]){
                    {
                        .sType = 53 /* PHYSICAL_DEVICE_VULKAN_1_3_FEATURES */,
                        .synchronization2 = 1,
                        .dynamicRendering = 1
                    }
                },
                .queueCreateInfoCount = 1,
                .pQueueCreateInfos = (const VkDeviceQueueCreateInfo[]){
                    {
                        .sType = 2 /* DEVICE_QUEUE_CREATE_INFO */,
                        .queueCount = 1,
                        .pQueuePriorities = (const float[]){ 1.0f }
                    }
                },
                .pEnabledFeatures = (const VkPhysicalDeviceFeatures[]){ { .robustBufferAccess = 0 } }
            }
        },
        __LINE__
    );
    load_device(device_1);
    vkGetDeviceQueue(device_1, 0, 0, &queue_1);
    check(
        vkCreatePipelineCache(
            device_1,
            (const VkPipelineCacheCreateInfo[]){ { .sType = 17 /* PIPELINE_CACHE_CREATE_INFO */ } },
            NULL,
            &pipeline_cache_1
        ),
        "vkCreatePipelineCache",
        __LINE__
    );
    check(
        vkCreateBuffer(
            device_1,
            (const VkBufferCreateInfo[]){
                {
                    .sType = 12 /* BUFFER_CREATE_INFO */,
                    .size = 65536,
                    .usage = 465 /* TRANSFER_SRC | UNIFORM_BUFFER | INDEX_BUFFER | VERTEX_BUFFER | INDIRECT_BUFFER */
                }
            },
            NULL,
            &buffer_1
        ),
        "vkCreateBuffer",
        __LINE__
    );
    vkGetBufferMemoryRequirements(device_1, buffer_1, &needs);
    allocate(
        device_1,
        15 /* DEVICE_LOCAL | HOST_VISIBLE | HOST_COHERENT | HOST_CACHED */,
        &device_memory_1,
        __LINE__
    );
    check(vkBindBufferMemory(device_1, buffer_1, device_memory_1, 0), "vkBindBufferMemory", __LINE__);
    mapped_1 = map(device_1, device_memory_1, __LINE__);
    memcpy(mapped_1 + 40, data_1, 240);
    memcpy(mapped_1 + 0, data_2, 32);
    create_image(
        device_1,
        (const VkImageCreateInfo[]){
            {
                .sType = 14 /* IMAGE_CREATE_INFO */,
                .imageType = 1 /* TYPE_2D */,
                .format = 97 /* R16G16B16A16_SFLOAT */,
                .extent = { .width = 1, .height = 1, .depth = 1 },
                .mipLevels = 1,
                .arrayLayers = 1,
                .samples = 1 /* TYPE_1 */,
                .usage = 19 /* TRANSFER_SRC | TRANSFER_DST | COLOR_ATTACHMENT */
            }
        },
        &image_1,
        __LINE__
    );
    vkGetImageMemoryRequirements(device_1, image_1, &needs);
    allocate(
        device_1,
        15 /* DEVICE_LOCAL | HOST_VISIBLE | HOST_COHERENT | HOST_CACHED */,
        &device_memory_2,
        __LINE__
    );
    check(vkBindImageMemory(device_1, image_1, device_memory_2, 0), "vkBindImageMemory", __LINE__);
    check(
        vkCreateImageView(
            device_1,
            (const VkImageViewCreateInfo[]){
                {
                    .sType = 15 /* IMAGE_VIEW_CREATE_INFO */,
                    .image = image_1,
                    .viewType = 1 /* TYPE_2D */,
                    .format = 97 /* R16G16B16A16_SFLOAT */,
                    .subresourceRange = { .aspectMask = 1 /* COLOR */, .levelCount = 1, .layerCount = 1 }
                }
            },
            NULL,
            &image_view_1
        ),
        "vkCreateImageView",
        __LINE__
    );
    check(
        vkCreateCommandPool(
            device_1,
            (const VkCommandPoolCreateInfo[]){
                { .sType = 39 /* COMMAND_POOL_CREATE_INFO */, .flags = 1 /* TRANSIENT */ }
            },
            NULL,
            &command_pool_1
        ),
        "vkCreateCommandPool",
        __LINE__
    );
    check(
        vkCreateFence(
            device_1,
            (const VkFenceCreateInfo[]){ { .sType = 8 /* FENCE_CREATE_INFO */ } },
            NULL,
            &fence_1
        ),
        "vkCreateFence",
        __LINE__
    );
    check(
        vkCreateDescriptorPool(
            device_1,
            (const VkDescriptorPoolCreateInfo[]){
                {
                    .sType = 33 /* DESCRIPTOR_POOL_CREATE_INFO */,
                    .maxSets = 8,
                    .poolSizeCount = 4,
                    .pPoolSizes = (const VkDescriptorPoolSize[]){
                        { .type = 8 /* UNIFORM_BUFFER_DYNAMIC */, .descriptorCount = 8 },
                        { .type = 2 /* SAMPLED_IMAGE */, .descriptorCount = 8 },
                        { .type = 7 /* STORAGE_BUFFER */, .descriptorCount = 8 },
                        { .descriptorCount = 8 }
                    }
                }
            },
            NULL,
            &descriptor_pool_1
        ),
        "vkCreateDescriptorPool",
        __LINE__
    );
    check(
        vkCreateDescriptorSetLayout(
            device_1,
            (const VkDescriptorSetLayoutCreateInfo[]){
                {
                    .sType = 32 /* DESCRIPTOR_SET_LAYOUT_CREATE_INFO */,
                    .bindingCount = 1,
                    .pBindings = (const VkDescriptorSetLayoutBinding[]){
                        {
                            .descriptorType = 8 /* UNIFORM_BUFFER_DYNAMIC */,
                            .descriptorCount = 1,
                            .stageFlags = 17 /* VERTEX | FRAGMENT */
                        }
                    }
                }
            },
            NULL,
            &descriptor_set_layout_1
        ),
        "vkCreateDescriptorSetLayout",
        __LINE__
    );
    check(
        vkCreatePipelineLayout(
            device_1,
            (const VkPipelineLayoutCreateInfo[]){
                {
                    .sType = 30 /* PIPELINE_LAYOUT_CREATE_INFO */,
                    .setLayoutCount = 1,
                    .pSetLayouts = (const VkDescriptorSetLayout[]){ descriptor_set_layout_1 }
                }
            },
            NULL,
            &pipeline_layout_1
        ),
        "vkCreatePipelineLayout",
        __LINE__
    );
    check(
        vkAllocateDescriptorSets(
            device_1,
            (const VkDescriptorSetAllocateInfo[]){
                {
                    .sType = 34 /* DESCRIPTOR_SET_ALLOCATE_INFO */,
                    .descriptorPool = descriptor_pool_1,
                    .descriptorSetCount = 1,
                    .pSetLayouts = (const VkDescriptorSetLayout[]){ descriptor_set_layout_1 }
                }
            },
            &descriptor_set_1
        ),
        "vkAllocateDescriptorSets",
        __LINE__
    );
    vkUpdateDescriptorSets(
        device_1,
        1,
        (const VkWriteDescriptorSet[]){
            {
                .sType = 35 /* WRITE_DESCRIPTOR_SET */,
                .dstSet = descriptor_set_1,
                .descriptorCount = 1,
                .descriptorType = 8 /* UNIFORM_BUFFER_DYNAMIC */,
                .pBufferInfo = (const VkDescriptorBufferInfo[]){ { .buffer = buffer_1, .range = 32 } }
            }
        },
        0,
        NULL
    );
    check(
        vkCreateShaderModule(
            device_1,
            (const VkShaderModuleCreateInfo[]){
                { .sType = 16 /* SHADER_MODULE_CREATE_INFO */, .codeSize = 804, .pCode = data_3 }
            },
            NULL,
            &shader_module_1
        ),
        "vkCreateShaderModule",
        __LINE__
    );
    check(
        vkCreateGraphicsPipelines(
            device_1,
            pipeline_cache_1,
            1,
            (const VkGraphicsPipelineCreateInfo[]){
                {
                    .sType = 28 /* GRAPHICS_PIPELINE_CREATE_INFO */,
                    .pNext = (const VkPipelineRenderingCreateInfo[]){
                        {
                            .sType = 0x3b9b75e2u /* PIPELINE_RENDERING_CREATE_INFO */,
                            .colorAttachmentCount = 1,
                            .pColorAttachmentFormats = (const uint32_t[]){ 97 /* R16G16B16A16_SFLOAT */ }
                        }
                    },
                    .stageCount = 2,
                    .pStages = (const VkPipelineShaderStageCreateInfo[]){
                        {
                            .sType = 18 /* PIPELINE_SHADER_STAGE_CREATE_INFO */,
                            .stage = 1 /* VERTEX */,
                            .module = shader_module_1,
                            .pName = "vs"
                        },
                        {
                            .sType = 18 /* PIPELINE_SHADER_STAGE_CREATE_INFO */,
                            .stage = 16 /* FRAGMENT */,
                            .module = shader_module_1,
                            .pName = "fs"
                        }
                    },
                    .pVertexInputState = (const VkPipelineVertexInputStateCreateInfo[]){
                        {
                            .sType = 19 /* PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO */,
                            .vertexBindingDescriptionCount = 1,
                            .pVertexBindingDescriptions = (
                                const VkVertexInputBindingDescription[]
                            ){ { .stride = 40 } },
                            .vertexAttributeDescriptionCount = 1,
                            .pVertexAttributeDescriptions = (const VkVertexInputAttributeDescription[]){
                                { .format = 109 /* R32G32B32A32_SFLOAT */ }
                            }
                        }
                    },
                    .pInputAssemblyState = (const VkPipelineInputAssemblyStateCreateInfo[]){
                        {
                            .sType = 20 /* PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO */,
                            .topology = 3 /* TRIANGLE_LIST */
                        }
                    },
                    .pViewportState = (const VkPipelineViewportStateCreateInfo[]){
                        {
                            .sType = 22 /* PIPELINE_VIEWPORT_STATE_CREATE_INFO */,
                            .viewportCount = 1,
                            .pViewports = (const VkViewport[]){
                                { .y = 1.0f, .width = 1.0f, .height = -1.0f, .maxDepth = 1.0f }
                            },
                            .scissorCount = 1,
                            .pScissors = (const VkRect2D[]){ { .extent = { .width = 1, .height = 1 } } }
                        }
                    },
                    .pRasterizationState = (const VkPipelineRasterizationStateCreateInfo[]){
                        { .sType = 23 /* PIPELINE_RASTERIZATION_STATE_CREATE_INFO */, .lineWidth = 1.0f }
                    },
                    .pMultisampleState = (const VkPipelineMultisampleStateCreateInfo[]){
                        {
                            .sType = 24 /* PIPELINE_MULTISAMPLE_STATE_CREATE_INFO */,
                            .rasterizationSamples = 1 /* TYPE_1 */,
                            .pSampleMask = (const uint32_t[]){ 0xffffffffu }
                        }
                    },
                    .pDepthStencilState = (const VkPipelineDepthStencilStateCreateInfo[]){
                        { .sType = 25 /* PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO */ }
                    },
                    .pColorBlendState = (const VkPipelineColorBlendStateCreateInfo[]){
                        {
                            .sType = 26 /* PIPELINE_COLOR_BLEND_STATE_CREATE_INFO */,
                            .attachmentCount = 1,
                            .pAttachments = (const VkPipelineColorBlendAttachmentState[]){
                                { .colorWriteMask = 15 /* R | G | B | A */ }
                            }
                        }
                    },
                    .pDynamicState = (const VkPipelineDynamicStateCreateInfo[]){
                        {
                            .sType = 27 /* PIPELINE_DYNAMIC_STATE_CREATE_INFO */,
                            .dynamicStateCount = 20,
                            .pDynamicStates = (const uint32_t[]){
                                0,
                                1 /* SCISSOR */,
                                0x3b9edcfau /* PRIMITIVE_TOPOLOGY */,
                                0x3ba08aacu /* PRIMITIVE_RESTART_ENABLE */,
                                0x3b9edcf8u /* CULL_MODE */,
                                0x3b9edcf9u /* FRONT_FACE */,
                                0x3ba08aa9u /* RASTERIZER_DISCARD_ENABLE */,
                                0x3ba08aaau /* DEPTH_BIAS_ENABLE */,
                                3 /* DEPTH_BIAS */,
                                0x3b9edd01u /* DEPTH_BOUNDS_TEST_ENABLE */,
                                5 /* DEPTH_BOUNDS */,
                                0x3b9edcfeu /* DEPTH_TEST_ENABLE */,
                                0x3b9edcffu /* DEPTH_WRITE_ENABLE */,
                                0x3b9edd00u /* DEPTH_COMPARE_OP */,
                                0x3b9edd02u /* STENCIL_TEST_ENABLE */,
                                0x3b9edd03u /* STENCIL_OP */,
                                6 /* STENCIL_COMPARE_MASK */,
                                7 /* STENCIL_WRITE_MASK */,
                                8 /* STENCIL_REFERENCE */,
                                4 /* BLEND_CONSTANTS */
                            }
                        }
                    },
                    .layout = pipeline_layout_1
                }
            },
            NULL,
            &pipeline_1
        ),
        "vkCreateGraphicsPipelines",
        __LINE__
    );
    check(
        vkCreateBuffer(
            device_1,
            (const VkBufferCreateInfo[]){
                {
                    .sType = 12 /* BUFFER_CREATE_INFO */,
                    .size = 65536,
                    .usage = 34 /* TRANSFER_DST | STORAGE_BUFFER */
                }
            },
            NULL,
            &buffer_2
        ),
        "vkCreateBuffer",
        __LINE__
    );
    vkGetBufferMemoryRequirements(device_1, buffer_2, &needs);
    allocate(
        device_1,
        15 /* DEVICE_LOCAL | HOST_VISIBLE | HOST_COHERENT | HOST_CACHED */,
        &device_memory_3,
        __LINE__
    );
    check(vkBindBufferMemory(device_1, buffer_2, device_memory_3, 0), "vkBindBufferMemory", __LINE__);
    mapped_2 = map(device_1, device_memory_3, __LINE__);
}

static void draw(void)
{
    check(vkResetCommandPool(device_1, command_pool_1, 0), "vkResetCommandPool", __LINE__);
    check(
        vkAllocateCommandBuffers(
            device_1,
            (const VkCommandBufferAllocateInfo[]){
                {
                    .sType = 40 /* COMMAND_BUFFER_ALLOCATE_INFO */,
                    .commandPool = command_pool_1,
                    .commandBufferCount = 1
                }
            },
            &command_buffer_1
        ),
        "vkAllocateCommandBuffers",
        __LINE__
    );
    check(
        vkBeginCommandBuffer(
            command_buffer_1,
            (const VkCommandBufferBeginInfo[]){
                { .sType = 42 /* COMMAND_BUFFER_BEGIN_INFO */, .flags = 1 /* ONE_TIME_SUBMIT */ }
            }
        ),
        "vkBeginCommandBuffer",
        __LINE__
    );
    vkCmdPipelineBarrier2(
        command_buffer_1,
        (const VkDependencyInfo[]){
            {
                .sType = 0x3b9f9493u /* DEPENDENCY_INFO */,
                .imageMemoryBarrierCount = 1,
                .pImageMemoryBarriers = (const VkImageMemoryBarrier2[]){
                    {
                        .sType = 0x3b9f9492u /* IMAGE_MEMORY_BARRIER_2 */,
                        .srcStageMask = 65536,
                        .srcAccessMask = 65536,
                        .dstStageMask = 4096,
                        .dstAccessMask = 4096,
                        .newLayout = 7 /* TRANSFER_DST_OPTIMAL */,
                        .srcQueueFamilyIndex = 0xffffffffu,
                        .dstQueueFamilyIndex = 0xffffffffu,
                        .image = image_1,
                        .subresourceRange = { .aspectMask = 1 /* COLOR */, .levelCount = 1, .layerCount = 1 }
                    }
                }
            }
        }
    );
    vkCmdClearColorImage(
        command_buffer_1,
        image_1,
        7 /* TRANSFER_DST_OPTIMAL */,
        (const VkClearColorValue[]){ { .bits = { 0, 0, 0, 0 } } },
        1,
        (const VkImageSubresourceRange[]){ { .aspectMask = 1 /* COLOR */, .levelCount = 1, .layerCount = 1 } }
    );
    vkCmdPipelineBarrier2(
        command_buffer_1,
        (const VkDependencyInfo[]){
            {
                .sType = 0x3b9f9493u /* DEPENDENCY_INFO */,
                .imageMemoryBarrierCount = 1,
                .pImageMemoryBarriers = (const VkImageMemoryBarrier2[]){
                    {
                        .sType = 0x3b9f9492u /* IMAGE_MEMORY_BARRIER_2 */,
                        .srcStageMask = 4096,
                        .srcAccessMask = 4096,
                        .dstStageMask = 1024,
                        .dstAccessMask = 384,
                        .oldLayout = 7 /* TRANSFER_DST_OPTIMAL */,
                        .newLayout = 2 /* COLOR_ATTACHMENT_OPTIMAL */,
                        .srcQueueFamilyIndex = 0xffffffffu,
                        .dstQueueFamilyIndex = 0xffffffffu,
                        .image = image_1,
                        .subresourceRange = { .aspectMask = 1 /* COLOR */, .levelCount = 1, .layerCount = 1 }
                    }
                }
            }
        }
    );
    vkCmdBeginRendering(
        command_buffer_1,
        (const VkRenderingInfo[]){
            {
                .sType = 0x3b9b75e0u /* RENDERING_INFO */,
                .renderArea = { .extent = { .width = 1, .height = 1 } },
                .layerCount = 1,
                .colorAttachmentCount = 1,
                .pColorAttachments = (const VkRenderingAttachmentInfo[]){
                    {
                        .sType = 0x3b9b75e1u /* RENDERING_ATTACHMENT_INFO */,
                        .imageView = image_view_1,
                        .imageLayout = 2 /* COLOR_ATTACHMENT_OPTIMAL */
                    }
                }
            }
        }
    );
    vkCmdBindPipeline(command_buffer_1, 0, pipeline_1);
    vkCmdSetViewport(
        command_buffer_1,
        0,
        1,
        (const VkViewport[]){ { .y = 1.0f, .width = 1.0f, .height = -1.0f, .maxDepth = 1.0f } }
    );
    vkCmdSetScissor(command_buffer_1, 0, 1, (const VkRect2D[]){ { .extent = { .width = 1, .height = 1 } } });
    vkCmdSetPrimitiveTopology(command_buffer_1, 3 /* TRIANGLE_LIST */);
    vkCmdSetPrimitiveRestartEnable(command_buffer_1, 0);
    vkCmdSetCullMode(command_buffer_1, 0);
    vkCmdSetFrontFace(command_buffer_1, 0);
    vkCmdSetRasterizerDiscardEnable(command_buffer_1, 0);
    vkCmdSetDepthBiasEnable(command_buffer_1, 0);
    vkCmdSetDepthBias(command_buffer_1, 1000000.0f, 0.0f, 0.0f);
    vkCmdSetDepthBoundsTestEnable(command_buffer_1, 0);
    vkCmdSetDepthBounds(command_buffer_1, 0.999999f, 0.9999995f);
    vkCmdSetDepthTestEnable(command_buffer_1, 0);
    vkCmdSetDepthWriteEnable(command_buffer_1, 1);
    vkCmdSetDepthCompareOp(command_buffer_1, 0);
    vkCmdSetBlendConstants(command_buffer_1, (const float[]){ 0.0f, 0.0f, 0.0f, 0.0f });
    vkCmdSetStencilTestEnable(command_buffer_1, 0);
    vkCmdSetStencilOp(command_buffer_1, 1 /* FRONT */, 5 /* INVERT */, 5 /* INVERT */, 5 /* INVERT */, 0);
    vkCmdSetStencilCompareMask(command_buffer_1, 1 /* FRONT */, 255);
    vkCmdSetStencilWriteMask(command_buffer_1, 1 /* FRONT */, 255);
    vkCmdSetStencilReference(command_buffer_1, 1 /* FRONT */, 0);
    vkCmdSetStencilOp(command_buffer_1, 2 /* BACK */, 5 /* INVERT */, 5 /* INVERT */, 5 /* INVERT */, 0);
    vkCmdSetStencilCompareMask(command_buffer_1, 2 /* BACK */, 255);
    vkCmdSetStencilWriteMask(command_buffer_1, 2 /* BACK */, 255);
    vkCmdSetStencilReference(command_buffer_1, 2 /* BACK */, 0);
    vkCmdBindDescriptorSets(
        command_buffer_1,
        0,
        pipeline_layout_1,
        0,
        1,
        (const VkDescriptorSet[]){ descriptor_set_1 },
        1,
        (const uint32_t[]){ 0 }
    );
    vkCmdBindVertexBuffers(command_buffer_1, 0, 1, (const VkBuffer[]){ buffer_1 }, (const uint64_t[]){ 40 });
    vkCmdDraw(command_buffer_1, 6, 1, 0, 0);
    vkCmdEndRendering(command_buffer_1);
    check(vkEndCommandBuffer(command_buffer_1), "vkEndCommandBuffer", __LINE__);
    check(vkResetFences(device_1, 1, (const VkFence[]){ fence_1 }), "vkResetFences", __LINE__);
    check(
        vkQueueSubmit2(
            queue_1,
            1,
            (const VkSubmitInfo2[]){
                {
                    .sType = 0x3b9f9494u /* SUBMIT_INFO_2 */,
                    .commandBufferInfoCount = 1,
                    .pCommandBufferInfos = (const VkCommandBufferSubmitInfo[]){
                        {
                            .sType = 0x3b9f9496u /* COMMAND_BUFFER_SUBMIT_INFO */,
                            .commandBuffer = command_buffer_1
                        }
                    }
                }
            },
            fence_1
        ),
        "vkQueueSubmit2",
        __LINE__
    );
    check(
        vkWaitForFences(device_1, 1, (const VkFence[]){ fence_1 }, 1, ~(uint64_t)0),
        "vkWaitForFences",
        __LINE__
    );
}

static void read_back(void)
{
    check(vkResetCommandPool(device_1, command_pool_1, 0), "vkResetCommandPool", __LINE__);
    check(
        vkBeginCommandBuffer(
            command_buffer_1,
            (const VkCommandBufferBeginInfo[]){
                { .sType = 42 /* COMMAND_BUFFER_BEGIN_INFO */, .flags = 1 /* ONE_TIME_SUBMIT */ }
            }
        ),
        "vkBeginCommandBuffer",
        __LINE__
    );
    vkCmdPipelineBarrier2(
        command_buffer_1,
        (const VkDependencyInfo[]){
            {
                .sType = 0x3b9f9493u /* DEPENDENCY_INFO */,
                .imageMemoryBarrierCount = 1,
                .pImageMemoryBarriers = (const VkImageMemoryBarrier2[]){
                    {
                        .sType = 0x3b9f9492u /* IMAGE_MEMORY_BARRIER_2 */,
                        .srcStageMask = 1024,
                        .srcAccessMask = 384,
                        .dstStageMask = 4096,
                        .dstAccessMask = 2048,
                        .oldLayout = 2 /* COLOR_ATTACHMENT_OPTIMAL */,
                        .newLayout = 6 /* TRANSFER_SRC_OPTIMAL */,
                        .srcQueueFamilyIndex = 0xffffffffu,
                        .dstQueueFamilyIndex = 0xffffffffu,
                        .image = image_1,
                        .subresourceRange = { .aspectMask = 1 /* COLOR */, .levelCount = 1, .layerCount = 1 }
                    }
                }
            }
        }
    );
    vkCmdCopyImageToBuffer(
        command_buffer_1,
        image_1,
        6 /* TRANSFER_SRC_OPTIMAL */,
        buffer_2,
        1,
        (const VkBufferImageCopy[]){
            {
                .imageSubresource = { .aspectMask = 1 /* COLOR */, .layerCount = 1 },
                .imageExtent = { .width = 1, .height = 1, .depth = 1 }
            }
        }
    );
    vkCmdPipelineBarrier2(
        command_buffer_1,
        (const VkDependencyInfo[]){
            {
                .sType = 0x3b9f9493u /* DEPENDENCY_INFO */,
                .memoryBarrierCount = 1,
                .pMemoryBarriers = (const VkMemoryBarrier2[]){
                    {
                        .sType = 0x3b9f9490u /* MEMORY_BARRIER_2 */,
                        .srcStageMask = 6144,
                        .srcAccessMask = 17179873280,
                        .dstStageMask = 16384,
                        .dstAccessMask = 8192
                    }
                }
            }
        }
    );
    check(vkEndCommandBuffer(command_buffer_1), "vkEndCommandBuffer", __LINE__);
    check(vkResetFences(device_1, 1, (const VkFence[]){ fence_1 }), "vkResetFences", __LINE__);
    check(
        vkQueueSubmit2(
            queue_1,
            1,
            (const VkSubmitInfo2[]){
                {
                    .sType = 0x3b9f9494u /* SUBMIT_INFO_2 */,
                    .commandBufferInfoCount = 1,
                    .pCommandBufferInfos = (const VkCommandBufferSubmitInfo[]){
                        {
                            .sType = 0x3b9f9496u /* COMMAND_BUFFER_SUBMIT_INFO */,
                            .commandBuffer = command_buffer_1
                        }
                    }
                }
            },
            fence_1
        ),
        "vkQueueSubmit2",
        __LINE__
    );
    check(
        vkWaitForFences(device_1, 1, (const VkFence[]){ fence_1 }, 1, ~(uint64_t)0),
        "vkWaitForFences",
        __LINE__
    );
    memcpy(memory_0, mapped_2 + 0, 8);
}

/* How the bits of a channel are compared: as a number, a signed number, a float of 16 bits (by its sign and magnitude),
 * a float of 32 bits, or a byte that a shorter code was widened to. */
enum order { UNSIGNED, SIGNED, HALF, SINGLE, VALUE, WIDENED };

struct channel {
    const char *name;
    const unsigned char *texel;
    unsigned bit, bits;
    enum order order;
    unsigned width;
};

struct range {
    double least, most;
};

struct texel {
    const char *place;
    unsigned channels, outcomes;
    const struct channel *channel;
    const struct range *allowed;
};

static double value_of(const struct channel *c)
{
    uint64_t word = 0;
    uint32_t code, sign;
    float value;
    memcpy(&word, c->texel + c->bit / 8, (c->bit % 8 + c->bits + 7) / 8);
    code = (uint32_t)(word >> c->bit % 8) & (0xFFFFFFFFu >> (32 - c->bits));
    sign = 1u << (c->width - 1);
    switch (c->order) {
    case SIGNED:
        return (code & sign) ? (double)code - 2.0 * sign : code;
    case HALF:
    case SINGLE:
        return (code & sign) ? -(double)(code - sign) : code;
    case VALUE:
        memcpy(&value, &code, sizeof value);
        return value;
    case WIDENED:
        return (code * ((1u << c->width) - 1) + 127) / 255;
    default:
        return code;
    }
}

static int is_allowed(const struct texel *t, const struct range *outcome)
{
    unsigned i;
    for (i = 0; i < t->channels; i++) {
        double value = value_of(&t->channel[i]);
        if (!(value >= outcome[i].least && value <= outcome[i].most))
            return 0;
    }
    return 1;
}

static int is_right(const struct texel *t)
{
    unsigned i;
    for (i = 0; i < t->outcomes; i++)
        if (is_allowed(t, t->allowed + i * t->channels))
            return 1;
    return 0;
}

/* The number that a place in the order stands for. */
static double shown(const struct channel *c, double order)
{
    double sign = order < 0 ? -1 : 1, size = fabs(order), infinity = c->order == SINGLE ? 0x7F800000 : 0x7C00;
    uint32_t code = size < 0x7F800000 ? (uint32_t)size : 0x7F800000;
    float value;
    if ((c->order == SINGLE || c->order == HALF) && size > infinity && !isinf(size))
        return NAN;
    if (c->order == SINGLE) {
        memcpy(&value, &code, sizeof value);
        return sign * (double)value;
    }
    if (c->order == HALF && size < 0x7C00)
        return sign * (code < 0x400 ? ldexp(code, -24) : ldexp(code % 0x400 + 0x400, (int)(code / 0x400) - 25));
    return c->order == HALF ? sign * INFINITY : order;
}

static void tell(const struct texel *t)
{
    unsigned i;
    printf("%s is wrong:", t->place);
    for (i = 0; i < t->channels; i++) {
        const struct channel *c = &t->channel[i];
        double value = value_of(c);
        double least = t->allowed[i].least, most = t->allowed[i].most;
        if (t->outcomes == 1 && value >= least && value <= most)
            continue;
        printf(" %s %.9g", c->name, shown(c, value));
        if (t->outcomes != 1)
            continue;
        if (least == most)
            printf(" (must be %.9g)", shown(c, least));
        else if (isinf(most))
            printf(" (must be at least %.9g)", shown(c, least));
        else if (isinf(least))
            printf(" (must be at most %.9g)", shown(c, most));
        else
            printf(" (must be %.9g to %.9g)", shown(c, least), shown(c, most));
    }
    printf("\n");
}

static const struct channel channels_0[] = {
    { "red of color", memory_0 + 0, 0, 16, HALF, 16 },
    { "green of color", memory_0 + 0, 16, 16, HALF, 16 },
    { "blue of color", memory_0 + 0, 32, 16, HALF, 16 },
    { "alpha of color", memory_0 + 0, 48, 16, HALF, 16 },
};
static const struct range allowed_0[] = {
    { 0.0, 0.0 }, { 0.0, 0.0 }, { 0.0, 0.0 }, { 31743.0, 31744.0 },
};

static int check_values(void)
{
    static const struct texel all[] = {
        { "texel 0,0", 4, 1, channels_0, allowed_0 },
    };
    unsigned i;
    for (i = 0; i < sizeof all / sizeof *all; i++)
        if (!is_right(&all[i])) {
            tell(&all[i]);
            return BUG;
        }
    printf("right\n");
    return 0;
}

int main(int count, char **arguments)
{
    choose_device(count > 1 ? atoi(arguments[1]) : -1);
    prepare();
    draw();
    read_back();
    return check_values();
}
