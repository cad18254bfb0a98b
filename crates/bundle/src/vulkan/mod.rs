//! Vulkan: one C file that loads `libvulkan` and needs no headers of the API.

mod calls;

use crate::c::string;
use crate::check;
use crate::due::Due;
use crate::error::BundleError;
use crate::head::Head;
use crate::language::BUILD_C;
use calls::Printer;
use etalon_backend::{Recording, VulkanNeeds};

/// The device of a program.
pub(crate) struct ProgramDevice<'a> {
    /// The device's name.
    pub(crate) name: &'a str,
    /// The version of Vulkan that the program asks for, encoded as in `VkApplicationInfo`.
    pub(crate) version: u32,
    /// The abilities that the device must have.
    pub(crate) needs: &'a VulkanNeeds,
}

/// Returns the C program that repeats a recording and checks its values.
pub(crate) fn program(
    head: &Head,
    device: &ProgramDevice<'_>,
    recording: &Recording,
    expected: &Due,
) -> Result<String, BundleError> {
    let ProgramDevice {
        name,
        version,
        needs,
    } = *device;
    let mut printer = Printer::new();
    let body = printer.body(&recording.calls)?;
    let check = check::check(recording, expected)?;
    let mut text = head.beginning(
        BUILD_C,
        "the index of the device; by default, the device with the name below is used, or the first one",
        "Structures and functions have the names of the specification; names of values are in comments.",
    );
    text.push('\n');
    text.push_str(&printer.types());
    text.push_str(&printer.declarations.functions());
    text.push_str(&format!(
        "\nstatic const char *const wanted = {};\nstatic const uint32_t version = 0x{version:x};\n\
         /* Formats that are blended into; modes in which depth and stencil are resolved. */\n\
         static const uint32_t blended[] = {{ {} }};\n\
         static const uint32_t depth_resolve = {}, stencil_resolve = {}, independent = {}, independent_none = {};\n",
        string(name),
        needs.blended.iter().map(|format| format!("{format}, ")).collect::<String>() + "0",
        needs.depth_resolve,
        needs.stencil_resolve,
        u32::from(needs.independent_resolve),
        u32::from(needs.independent_resolve_none),
    ));
    text.push_str(HELPERS);
    let signature = "load_device(VkDevice device)";
    let find = "device_function(device, ";
    text.push_str(&printer.declarations.load(signature, find, &[]));
    text.push_str(&printer.declarations.variables());
    text.push_str(&body.definitions);
    text.push_str(&check);
    text.push_str(&format!(
        "\nint main(int count, char **arguments)\n{{\n    choose_device(count > 1 ? atoi(arguments[1]) : -1);\n{}    return \
         check_values();\n}}\n",
        body.calls
    ));
    Ok(text)
}

/// The functions that create the instance and the device, and allocate memory.
const HELPERS: &str = r#"
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
        /* VK_ERROR_FEATURE_NOT_PRESENT, EXTENSION_NOT_PRESENT, LAYER_NOT_PRESENT, FORMAT_NOT_SUPPORTED, INCOMPATIBLE_DRIVER */
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

/* Ends the program if the device lacks an ability that no feature announces. */
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

/* Allocates memory for the last buffer or image, from a type with these properties. */
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
    /* If there is no such type, only HOST_VISIBLE and HOST_COHERENT are required. */
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
"#;
