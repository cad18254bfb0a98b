/*
 * SwiftShader: resolving to a face of a cube image writes the wrong texels
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
typedef void *VkDevice;
typedef uint64_t VkDeviceMemory;
typedef uint64_t VkFence;
typedef uint64_t VkImage;
typedef uint64_t VkImageView;
typedef void *VkPhysicalDevice;
typedef uint64_t VkPipelineCache;
typedef void *VkQueue;

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
static int32_t (*vkBeginCommandBuffer)(VkCommandBuffer, const void *);
static int32_t (*vkBindBufferMemory)(VkDevice, VkBuffer, VkDeviceMemory, uint64_t);
static int32_t (*vkBindImageMemory)(VkDevice, VkImage, VkDeviceMemory, uint64_t);
static void (*vkCmdBeginRendering)(VkCommandBuffer, const void *);
static void (*vkCmdClearColorImage)(VkCommandBuffer, VkImage, uint32_t, const void *, uint32_t, const void *);
static void (*vkCmdCopyImageToBuffer)(VkCommandBuffer, VkImage, uint32_t, VkBuffer, uint32_t, const void *);
static void (*vkCmdEndRendering)(VkCommandBuffer);
static void (*vkCmdPipelineBarrier2)(VkCommandBuffer, const void *);
static int32_t (*vkCreateBuffer)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateCommandPool)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateDescriptorPool)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateFence)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreateImageView)(VkDevice, const void *, const void *, void *);
static int32_t (*vkCreatePipelineCache)(VkDevice, const void *, const void *, void *);
static int32_t (*vkEndCommandBuffer)(VkCommandBuffer);
static void (*vkGetBufferMemoryRequirements)(VkDevice, VkBuffer, void *);
static void (*vkGetDeviceQueue)(VkDevice, uint32_t, uint32_t, void *);
static void (*vkGetImageMemoryRequirements)(VkDevice, VkImage, void *);
static int32_t (*vkQueueSubmit2)(VkQueue, uint32_t, const void *, VkFence);
static int32_t (*vkResetCommandPool)(VkDevice, VkCommandPool, uint32_t);
static int32_t (*vkResetFences)(VkDevice, uint32_t, const void *);
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
    *(void **)&vkBeginCommandBuffer = device_function(device, "vkBeginCommandBuffer");
    *(void **)&vkBindBufferMemory = device_function(device, "vkBindBufferMemory");
    *(void **)&vkBindImageMemory = device_function(device, "vkBindImageMemory");
    *(void **)&vkCmdBeginRendering = device_function(device, "vkCmdBeginRendering");
    *(void **)&vkCmdClearColorImage = device_function(device, "vkCmdClearColorImage");
    *(void **)&vkCmdCopyImageToBuffer = device_function(device, "vkCmdCopyImageToBuffer");
    *(void **)&vkCmdEndRendering = device_function(device, "vkCmdEndRendering");
    *(void **)&vkCmdPipelineBarrier2 = device_function(device, "vkCmdPipelineBarrier2");
    *(void **)&vkCreateBuffer = device_function(device, "vkCreateBuffer");
    *(void **)&vkCreateCommandPool = device_function(device, "vkCreateCommandPool");
    *(void **)&vkCreateDescriptorPool = device_function(device, "vkCreateDescriptorPool");
    *(void **)&vkCreateFence = device_function(device, "vkCreateFence");
    *(void **)&vkCreateImageView = device_function(device, "vkCreateImageView");
    *(void **)&vkCreatePipelineCache = device_function(device, "vkCreatePipelineCache");
    *(void **)&vkEndCommandBuffer = device_function(device, "vkEndCommandBuffer");
    *(void **)&vkGetBufferMemoryRequirements = device_function(device, "vkGetBufferMemoryRequirements");
    *(void **)&vkGetDeviceQueue = device_function(device, "vkGetDeviceQueue");
    *(void **)&vkGetImageMemoryRequirements = device_function(device, "vkGetImageMemoryRequirements");
    *(void **)&vkQueueSubmit2 = device_function(device, "vkQueueSubmit2");
    *(void **)&vkResetCommandPool = device_function(device, "vkResetCommandPool");
    *(void **)&vkResetFences = device_function(device, "vkResetFences");
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
static VkImage image_2;
static VkDeviceMemory device_memory_3;
static VkImageView image_view_2;
static VkCommandPool command_pool_1;
static VkFence fence_1;
static VkDescriptorPool descriptor_pool_1;
static VkBuffer buffer_2;
static VkDeviceMemory device_memory_4;
static unsigned char * mapped_2;
static VkCommandBuffer command_buffer_1;
static unsigned char memory_0[16];

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
    create_image(
        device_1,
        (const VkImageCreateInfo[]){
            {
                .sType = 14 /* IMAGE_CREATE_INFO */,
                .flags = 16 /* CUBE_COMPATIBLE */,
                .imageType = 1 /* TYPE_2D */,
                .format = 37 /* R8G8B8A8_UNORM */,
                .extent = { .width = 2, .height = 2, .depth = 1 },
                .mipLevels = 1,
                .arrayLayers = 6,
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
                    .format = 37 /* R8G8B8A8_UNORM */,
                    .subresourceRange = {
                        .aspectMask = 1 /* COLOR */,
                        .levelCount = 1,
                        .baseArrayLayer = 4,
                        .layerCount = 1
                    }
                }
            },
            NULL,
            &image_view_1
        ),
        "vkCreateImageView",
        __LINE__
    );
    create_image(
        device_1,
        (const VkImageCreateInfo[]){
            {
                .sType = 14 /* IMAGE_CREATE_INFO */,
                .imageType = 1 /* TYPE_2D */,
                .format = 37 /* R8G8B8A8_UNORM */,
                .extent = { .width = 2, .height = 2, .depth = 1 },
                .mipLevels = 1,
                .arrayLayers = 1,
                .samples = 4 /* TYPE_4 */,
                .usage = 18 /* TRANSFER_DST | COLOR_ATTACHMENT */
            }
        },
        &image_2,
        __LINE__
    );
    vkGetImageMemoryRequirements(device_1, image_2, &needs);
    allocate(
        device_1,
        15 /* DEVICE_LOCAL | HOST_VISIBLE | HOST_COHERENT | HOST_CACHED */,
        &device_memory_3,
        __LINE__
    );
    check(vkBindImageMemory(device_1, image_2, device_memory_3, 0), "vkBindImageMemory", __LINE__);
    check(
        vkCreateImageView(
            device_1,
            (const VkImageViewCreateInfo[]){
                {
                    .sType = 15 /* IMAGE_VIEW_CREATE_INFO */,
                    .image = image_2,
                    .viewType = 1 /* TYPE_2D */,
                    .format = 37 /* R8G8B8A8_UNORM */,
                    .subresourceRange = { .aspectMask = 1 /* COLOR */, .levelCount = 1, .layerCount = 1 }
                }
            },
            NULL,
            &image_view_2
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
        &device_memory_4,
        __LINE__
    );
    check(vkBindBufferMemory(device_1, buffer_2, device_memory_4, 0), "vkBindBufferMemory", __LINE__);
    mapped_2 = map(device_1, device_memory_4, __LINE__);
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
                .imageMemoryBarrierCount = 2,
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
                        .subresourceRange = {
                            .aspectMask = 1 /* COLOR */,
                            .levelCount = 1,
                            .baseArrayLayer = 4,
                            .layerCount = 1
                        }
                    },
                    {
                        .sType = 0x3b9f9492u /* IMAGE_MEMORY_BARRIER_2 */,
                        .srcStageMask = 65536,
                        .srcAccessMask = 65536,
                        .dstStageMask = 4096,
                        .dstAccessMask = 4096,
                        .newLayout = 7 /* TRANSFER_DST_OPTIMAL */,
                        .srcQueueFamilyIndex = 0xffffffffu,
                        .dstQueueFamilyIndex = 0xffffffffu,
                        .image = image_2,
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
        (const VkClearColorValue[]){ { .bits = { 0, 0, 0, 0x3f800000u } } },
        1,
        (const VkImageSubresourceRange[]){
            { .aspectMask = 1 /* COLOR */, .levelCount = 1, .baseArrayLayer = 4, .layerCount = 1 }
        }
    );
    vkCmdClearColorImage(
        command_buffer_1,
        image_2,
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
                .imageMemoryBarrierCount = 2,
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
                        .subresourceRange = {
                            .aspectMask = 1 /* COLOR */,
                            .levelCount = 1,
                            .baseArrayLayer = 4,
                            .layerCount = 1
                        }
                    },
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
                        .image = image_2,
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
                .renderArea = { .extent = { .width = 2, .height = 2 } },
                .layerCount = 1,
                .colorAttachmentCount = 1,
                .pColorAttachments = (const VkRenderingAttachmentInfo[]){
                    {
                        .sType = 0x3b9b75e1u /* RENDERING_ATTACHMENT_INFO */,
                        .imageView = image_view_2,
                        .imageLayout = 2 /* COLOR_ATTACHMENT_OPTIMAL */,
                        .resolveMode = 2 /* AVERAGE */,
                        .resolveImageView = image_view_1,
                        .resolveImageLayout = 2 /* COLOR_ATTACHMENT_OPTIMAL */
                    }
                }
            }
        }
    );
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
                        .subresourceRange = {
                            .aspectMask = 1 /* COLOR */,
                            .levelCount = 1,
                            .baseArrayLayer = 4,
                            .layerCount = 1
                        }
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
                .imageSubresource = { .aspectMask = 1 /* COLOR */, .baseArrayLayer = 4, .layerCount = 1 },
                .imageExtent = { .width = 2, .height = 2, .depth = 1 }
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
    memcpy(memory_0, mapped_2 + 0, 16);
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
    double sign = order < 0 ? -1 : 1, size = fabs(order);
    uint32_t code = size < 0x7F800000 ? (uint32_t)size : 0x7F800000;
    float value;
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
    { "red of first", memory_0 + 8, 0, 8, UNSIGNED, 8 },
    { "green of first", memory_0 + 8, 8, 8, UNSIGNED, 8 },
    { "blue of first", memory_0 + 8, 16, 8, UNSIGNED, 8 },
    { "alpha of first", memory_0 + 8, 24, 8, UNSIGNED, 8 },
};
static const struct range allowed_0[] = {
    { 0.0, 0.0 }, { 0.0, 0.0 }, { 0.0, 0.0 }, { 0.0, 0.0 },
};

static const struct channel channels_1[] = {
    { "red of first", memory_0 + 12, 0, 8, UNSIGNED, 8 },
    { "green of first", memory_0 + 12, 8, 8, UNSIGNED, 8 },
    { "blue of first", memory_0 + 12, 16, 8, UNSIGNED, 8 },
    { "alpha of first", memory_0 + 12, 24, 8, UNSIGNED, 8 },
};
static const struct range allowed_1[] = {
    { 0.0, 0.0 }, { 0.0, 0.0 }, { 0.0, 0.0 }, { 0.0, 0.0 },
};

static int check_values(void)
{
    static const struct texel all[] = {
        { "texel 0,1", 4, 1, channels_0, allowed_0 },
        { "texel 1,1", 4, 1, channels_1, allowed_1 },
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
