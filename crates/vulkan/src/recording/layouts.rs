//! The structures of Vulkan that the backend passes, field by field, as the registry declares them.

#![expect(
    deprecated,
    reason = "fields that devices ignore are part of the structure"
)]

use super::layout::{Count, Field, Kind, Layout};
use Kind::{
    Code, F32, F32s, Floats, Handle, Handles, I32, NamedWords, Next, Struct, Structs, Text, Texts,
    U32, U32s, U64, Unused, Words,
};
use ash::vk;
use std::mem::offset_of;

macro_rules! name_of {
    ($kind:ident) => {
        |raw| format!("{:?}", vk::$kind::from_raw(raw.cast_signed()))
    };
}

/// An enumeration, with the names of its values.
macro_rules! named {
    ($kind:ident) => {
        Kind::Named(name_of!($kind))
    };
}

/// Bits, with their names.
macro_rules! flags {
    ($kind:ident) => {
        Kind::Named(|raw| format!("{:?}", vk::$kind::from_raw(raw)))
    };
}

/// The number that another field has.
macro_rules! count {
    ($kind:ty, $field:ident) => {
        Count::Field(offset_of!($kind, $field))
    };
}

macro_rules! layout {
    (@structure tagged $kind:ty) => { Some(<$kind as vk::TaggedStructure>::STRUCTURE_TYPE) };
    (@structure plain $kind:ty) => { None };
    ($tag:ident $name:ident: $text:literal $kind:ty { $($field:ident: $value:expr,)+ }) => {
        pub(super) static $name: Layout = Layout {
            name: $text,
            size: size_of::<$kind>(),
            structure: layout!(@structure $tag $kind),
            fields: &[$(Field {
                name: stringify!($field),
                offset: offset_of!($kind, $field),
                kind: $value,
            }),+],
        };
    };
}

/// The union of all clear values, as bits.
pub(super) static CLEAR_VALUE: Layout = Layout {
    name: "VkClearValue",
    size: 16,
    structure: None,
    fields: &[Field {
        name: "bits",
        offset: 0,
        kind: U32s(4),
    }],
};

/// The structures that a chain may hold.
pub(super) static TAGGED: &[&Layout] = &[
    &DEVICE_QUEUE_CREATE_INFO,
    &DEVICE_CREATE_INFO,
    &PHYSICAL_DEVICE_VULKAN13_FEATURES,
    &PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT,
    &PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE3_FEATURES_EXT,
    &PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE2_FEATURES_EXT,
    &PHYSICAL_DEVICE_BLEND_OPERATION_ADVANCED_FEATURES_EXT,
    &BUFFER_CREATE_INFO,
    &MEMORY_ALLOCATE_INFO,
    &IMAGE_CREATE_INFO,
    &IMAGE_FORMAT_LIST_CREATE_INFO,
    &IMAGE_VIEW_CREATE_INFO,
    &SHADER_MODULE_CREATE_INFO,
    &DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
    &PIPELINE_LAYOUT_CREATE_INFO,
    &DESCRIPTOR_POOL_CREATE_INFO,
    &DESCRIPTOR_SET_ALLOCATE_INFO,
    &WRITE_DESCRIPTOR_SET,
    &SAMPLER_CREATE_INFO,
    &COMMAND_POOL_CREATE_INFO,
    &COMMAND_BUFFER_ALLOCATE_INFO,
    &COMMAND_BUFFER_INHERITANCE_RENDERING_INFO,
    &COMMAND_BUFFER_INHERITANCE_INFO,
    &COMMAND_BUFFER_BEGIN_INFO,
    &FENCE_CREATE_INFO,
    &QUERY_POOL_CREATE_INFO,
    &PIPELINE_CACHE_CREATE_INFO,
    &PIPELINE_SHADER_STAGE_CREATE_INFO,
    &PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
    &PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
    &PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO,
    &PIPELINE_TESSELLATION_STATE_CREATE_INFO,
    &PIPELINE_VIEWPORT_STATE_CREATE_INFO,
    &PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT,
    &PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
    &PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
    &PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
    &PIPELINE_COLOR_BLEND_ADVANCED_STATE_CREATE_INFO_EXT,
    &PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
    &PIPELINE_DYNAMIC_STATE_CREATE_INFO,
    &PIPELINE_RENDERING_CREATE_INFO,
    &GRAPHICS_PIPELINE_CREATE_INFO,
    &COMPUTE_PIPELINE_CREATE_INFO,
    &ATTACHMENT_DESCRIPTION_STENCIL_LAYOUT,
    &ATTACHMENT_DESCRIPTION2,
    &ATTACHMENT_REFERENCE_STENCIL_LAYOUT,
    &ATTACHMENT_REFERENCE2,
    &SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE,
    &SUBPASS_DESCRIPTION2,
    &MEMORY_BARRIER2,
    &SUBPASS_DEPENDENCY2,
    &RENDER_PASS_CREATE_INFO2,
    &FRAMEBUFFER_CREATE_INFO,
    &RENDER_PASS_BEGIN_INFO,
    &RENDERING_ATTACHMENT_INFO,
    &RENDERING_INFO,
    &BUFFER_MEMORY_BARRIER2,
    &IMAGE_MEMORY_BARRIER2,
    &DEPENDENCY_INFO,
    &COMMAND_BUFFER_SUBMIT_INFO,
    &SEMAPHORE_SUBMIT_INFO,
    &SUBMIT_INFO2,
];

layout! { tagged DEVICE_QUEUE_CREATE_INFO: "VkDeviceQueueCreateInfo" vk::DeviceQueueCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(DeviceQueueCreateFlags),
    queue_family_index: U32,
    queue_count: U32,
    p_queue_priorities: Floats(count!(vk::DeviceQueueCreateInfo<'static>, queue_count)),
} }

layout! { tagged DEVICE_CREATE_INFO: "VkDeviceCreateInfo" vk::DeviceCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(DeviceCreateFlags),
    queue_create_info_count: U32,
    p_queue_create_infos: Structs(&DEVICE_QUEUE_CREATE_INFO, count!(vk::DeviceCreateInfo<'static>, queue_create_info_count)),
    enabled_layer_count: U32,
    pp_enabled_layer_names: Texts(count!(vk::DeviceCreateInfo<'static>, enabled_layer_count)),
    enabled_extension_count: U32,
    pp_enabled_extension_names: Texts(count!(vk::DeviceCreateInfo<'static>, enabled_extension_count)),
    p_enabled_features: Structs(&PHYSICAL_DEVICE_FEATURES, Count::One),
} }

layout! { plain PHYSICAL_DEVICE_FEATURES: "VkPhysicalDeviceFeatures" vk::PhysicalDeviceFeatures {
    robust_buffer_access: U32,
    full_draw_index_uint32: U32,
    image_cube_array: U32,
    independent_blend: U32,
    geometry_shader: U32,
    tessellation_shader: U32,
    sample_rate_shading: U32,
    dual_src_blend: U32,
    logic_op: U32,
    multi_draw_indirect: U32,
    draw_indirect_first_instance: U32,
    depth_clamp: U32,
    depth_bias_clamp: U32,
    fill_mode_non_solid: U32,
    depth_bounds: U32,
    wide_lines: U32,
    large_points: U32,
    alpha_to_one: U32,
    multi_viewport: U32,
    sampler_anisotropy: U32,
    texture_compression_etc2: U32,
    texture_compression_astc_ldr: U32,
    texture_compression_bc: U32,
    occlusion_query_precise: U32,
    pipeline_statistics_query: U32,
    vertex_pipeline_stores_and_atomics: U32,
    fragment_stores_and_atomics: U32,
    shader_tessellation_and_geometry_point_size: U32,
    shader_image_gather_extended: U32,
    shader_storage_image_extended_formats: U32,
    shader_storage_image_multisample: U32,
    shader_storage_image_read_without_format: U32,
    shader_storage_image_write_without_format: U32,
    shader_uniform_buffer_array_dynamic_indexing: U32,
    shader_sampled_image_array_dynamic_indexing: U32,
    shader_storage_buffer_array_dynamic_indexing: U32,
    shader_storage_image_array_dynamic_indexing: U32,
    shader_clip_distance: U32,
    shader_cull_distance: U32,
    shader_float64: U32,
    shader_int64: U32,
    shader_int16: U32,
    shader_resource_residency: U32,
    shader_resource_min_lod: U32,
    sparse_binding: U32,
    sparse_residency_buffer: U32,
    sparse_residency_image2_d: U32,
    sparse_residency_image3_d: U32,
    sparse_residency2_samples: U32,
    sparse_residency4_samples: U32,
    sparse_residency8_samples: U32,
    sparse_residency16_samples: U32,
    sparse_residency_aliased: U32,
    variable_multisample_rate: U32,
    inherited_queries: U32,
} }

layout! { tagged PHYSICAL_DEVICE_VULKAN13_FEATURES: "VkPhysicalDeviceVulkan13Features" vk::PhysicalDeviceVulkan13Features<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    robust_image_access: U32,
    inline_uniform_block: U32,
    descriptor_binding_inline_uniform_block_update_after_bind: U32,
    pipeline_creation_cache_control: U32,
    private_data: U32,
    shader_demote_to_helper_invocation: U32,
    shader_terminate_invocation: U32,
    subgroup_size_control: U32,
    compute_full_subgroups: U32,
    synchronization2: U32,
    texture_compression_astc_hdr: U32,
    shader_zero_initialize_workgroup_memory: U32,
    dynamic_rendering: U32,
    shader_integer_dot_product: U32,
    maintenance4: U32,
} }

layout! { tagged PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT: "VkPhysicalDeviceProvokingVertexFeaturesEXT" vk::PhysicalDeviceProvokingVertexFeaturesEXT<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    provoking_vertex_last: U32,
    transform_feedback_preserves_provoking_vertex: U32,
} }

layout! { tagged PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE3_FEATURES_EXT: "VkPhysicalDeviceExtendedDynamicState3FeaturesEXT" vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    extended_dynamic_state3_tessellation_domain_origin: U32,
    extended_dynamic_state3_depth_clamp_enable: U32,
    extended_dynamic_state3_polygon_mode: U32,
    extended_dynamic_state3_rasterization_samples: U32,
    extended_dynamic_state3_sample_mask: U32,
    extended_dynamic_state3_alpha_to_coverage_enable: U32,
    extended_dynamic_state3_alpha_to_one_enable: U32,
    extended_dynamic_state3_logic_op_enable: U32,
    extended_dynamic_state3_color_blend_enable: U32,
    extended_dynamic_state3_color_blend_equation: U32,
    extended_dynamic_state3_color_write_mask: U32,
    extended_dynamic_state3_rasterization_stream: U32,
    extended_dynamic_state3_conservative_rasterization_mode: U32,
    extended_dynamic_state3_extra_primitive_overestimation_size: U32,
    extended_dynamic_state3_depth_clip_enable: U32,
    extended_dynamic_state3_sample_locations_enable: U32,
    extended_dynamic_state3_color_blend_advanced: U32,
    extended_dynamic_state3_provoking_vertex_mode: U32,
    extended_dynamic_state3_line_rasterization_mode: U32,
    extended_dynamic_state3_line_stipple_enable: U32,
    extended_dynamic_state3_depth_clip_negative_one_to_one: U32,
    extended_dynamic_state3_viewport_w_scaling_enable: U32,
    extended_dynamic_state3_viewport_swizzle: U32,
    extended_dynamic_state3_coverage_to_color_enable: U32,
    extended_dynamic_state3_coverage_to_color_location: U32,
    extended_dynamic_state3_coverage_modulation_mode: U32,
    extended_dynamic_state3_coverage_modulation_table_enable: U32,
    extended_dynamic_state3_coverage_modulation_table: U32,
    extended_dynamic_state3_coverage_reduction_mode: U32,
    extended_dynamic_state3_representative_fragment_test_enable: U32,
    extended_dynamic_state3_shading_rate_image_enable: U32,
} }

layout! { tagged PHYSICAL_DEVICE_EXTENDED_DYNAMIC_STATE2_FEATURES_EXT: "VkPhysicalDeviceExtendedDynamicState2FeaturesEXT" vk::PhysicalDeviceExtendedDynamicState2FeaturesEXT<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    extended_dynamic_state2: U32,
    extended_dynamic_state2_logic_op: U32,
    extended_dynamic_state2_patch_control_points: U32,
} }

layout! { tagged PHYSICAL_DEVICE_BLEND_OPERATION_ADVANCED_FEATURES_EXT: "VkPhysicalDeviceBlendOperationAdvancedFeaturesEXT" vk::PhysicalDeviceBlendOperationAdvancedFeaturesEXT<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    advanced_blend_coherent_operations: U32,
} }

layout! { tagged BUFFER_CREATE_INFO: "VkBufferCreateInfo" vk::BufferCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(BufferCreateFlags),
    size: U64,
    usage: flags!(BufferUsageFlags),
    sharing_mode: named!(SharingMode),
    queue_family_index_count: U32,
    p_queue_family_indices: Words(count!(vk::BufferCreateInfo<'static>, queue_family_index_count)),
} }

layout! { tagged MEMORY_ALLOCATE_INFO: "VkMemoryAllocateInfo" vk::MemoryAllocateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    allocation_size: U64,
    memory_type_index: U32,
} }

layout! { tagged IMAGE_CREATE_INFO: "VkImageCreateInfo" vk::ImageCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(ImageCreateFlags),
    image_type: named!(ImageType),
    format: named!(Format),
    extent: Struct(&EXTENT3_D),
    mip_levels: U32,
    array_layers: U32,
    samples: flags!(SampleCountFlags),
    tiling: named!(ImageTiling),
    usage: flags!(ImageUsageFlags),
    sharing_mode: named!(SharingMode),
    queue_family_index_count: U32,
    p_queue_family_indices: Words(count!(vk::ImageCreateInfo<'static>, queue_family_index_count)),
    initial_layout: named!(ImageLayout),
} }

layout! { tagged IMAGE_FORMAT_LIST_CREATE_INFO: "VkImageFormatListCreateInfo" vk::ImageFormatListCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    view_format_count: U32,
    p_view_formats: NamedWords(name_of!(Format), count!(vk::ImageFormatListCreateInfo<'static>, view_format_count)),
} }

layout! { plain COMPONENT_MAPPING: "VkComponentMapping" vk::ComponentMapping {
    r: named!(ComponentSwizzle),
    g: named!(ComponentSwizzle),
    b: named!(ComponentSwizzle),
    a: named!(ComponentSwizzle),
} }

layout! { plain IMAGE_SUBRESOURCE_RANGE: "VkImageSubresourceRange" vk::ImageSubresourceRange {
    aspect_mask: flags!(ImageAspectFlags),
    base_mip_level: U32,
    level_count: U32,
    base_array_layer: U32,
    layer_count: U32,
} }

layout! { tagged IMAGE_VIEW_CREATE_INFO: "VkImageViewCreateInfo" vk::ImageViewCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(ImageViewCreateFlags),
    image: Handle("VkImage"),
    view_type: named!(ImageViewType),
    format: named!(Format),
    components: Struct(&COMPONENT_MAPPING),
    subresource_range: Struct(&IMAGE_SUBRESOURCE_RANGE),
} }

layout! { tagged SHADER_MODULE_CREATE_INFO: "VkShaderModuleCreateInfo" vk::ShaderModuleCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(ShaderModuleCreateFlags),
    code_size: U64,
    p_code: Code(offset_of!(vk::ShaderModuleCreateInfo<'static>, code_size)),
} }

layout! { plain DESCRIPTOR_SET_LAYOUT_BINDING: "VkDescriptorSetLayoutBinding" vk::DescriptorSetLayoutBinding<'static> {
    binding: U32,
    descriptor_type: named!(DescriptorType),
    descriptor_count: U32,
    stage_flags: flags!(ShaderStageFlags),
    p_immutable_samplers: Handles("VkSampler", count!(vk::DescriptorSetLayoutBinding<'static>, descriptor_count)),
} }

layout! { tagged DESCRIPTOR_SET_LAYOUT_CREATE_INFO: "VkDescriptorSetLayoutCreateInfo" vk::DescriptorSetLayoutCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(DescriptorSetLayoutCreateFlags),
    binding_count: U32,
    p_bindings: Structs(&DESCRIPTOR_SET_LAYOUT_BINDING, count!(vk::DescriptorSetLayoutCreateInfo<'static>, binding_count)),
} }

layout! { plain PUSH_CONSTANT_RANGE: "VkPushConstantRange" vk::PushConstantRange {
    stage_flags: flags!(ShaderStageFlags),
    offset: U32,
    size: U32,
} }

layout! { tagged PIPELINE_LAYOUT_CREATE_INFO: "VkPipelineLayoutCreateInfo" vk::PipelineLayoutCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineLayoutCreateFlags),
    set_layout_count: U32,
    p_set_layouts: Handles("VkDescriptorSetLayout", count!(vk::PipelineLayoutCreateInfo<'static>, set_layout_count)),
    push_constant_range_count: U32,
    p_push_constant_ranges: Structs(&PUSH_CONSTANT_RANGE, count!(vk::PipelineLayoutCreateInfo<'static>, push_constant_range_count)),
} }

layout! { plain DESCRIPTOR_POOL_SIZE: "VkDescriptorPoolSize" vk::DescriptorPoolSize {
    ty: named!(DescriptorType),
    descriptor_count: U32,
} }

layout! { tagged DESCRIPTOR_POOL_CREATE_INFO: "VkDescriptorPoolCreateInfo" vk::DescriptorPoolCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(DescriptorPoolCreateFlags),
    max_sets: U32,
    pool_size_count: U32,
    p_pool_sizes: Structs(&DESCRIPTOR_POOL_SIZE, count!(vk::DescriptorPoolCreateInfo<'static>, pool_size_count)),
} }

layout! { tagged DESCRIPTOR_SET_ALLOCATE_INFO: "VkDescriptorSetAllocateInfo" vk::DescriptorSetAllocateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    descriptor_pool: Handle("VkDescriptorPool"),
    descriptor_set_count: U32,
    p_set_layouts: Handles("VkDescriptorSetLayout", count!(vk::DescriptorSetAllocateInfo<'static>, descriptor_set_count)),
} }

layout! { plain DESCRIPTOR_IMAGE_INFO: "VkDescriptorImageInfo" vk::DescriptorImageInfo {
    sampler: Handle("VkSampler"),
    image_view: Handle("VkImageView"),
    image_layout: named!(ImageLayout),
} }

layout! { plain DESCRIPTOR_BUFFER_INFO: "VkDescriptorBufferInfo" vk::DescriptorBufferInfo {
    buffer: Handle("VkBuffer"),
    offset: U64,
    range: U64,
} }

layout! { tagged WRITE_DESCRIPTOR_SET: "VkWriteDescriptorSet" vk::WriteDescriptorSet<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    dst_set: Handle("VkDescriptorSet"),
    dst_binding: U32,
    dst_array_element: U32,
    descriptor_count: U32,
    descriptor_type: named!(DescriptorType),
    p_image_info: Structs(&DESCRIPTOR_IMAGE_INFO, count!(vk::WriteDescriptorSet<'static>, descriptor_count)),
    p_buffer_info: Structs(&DESCRIPTOR_BUFFER_INFO, count!(vk::WriteDescriptorSet<'static>, descriptor_count)),
    p_texel_buffer_view: Handles("VkBufferView", count!(vk::WriteDescriptorSet<'static>, descriptor_count)),
} }

layout! { tagged SAMPLER_CREATE_INFO: "VkSamplerCreateInfo" vk::SamplerCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(SamplerCreateFlags),
    mag_filter: named!(Filter),
    min_filter: named!(Filter),
    mipmap_mode: named!(SamplerMipmapMode),
    address_mode_u: named!(SamplerAddressMode),
    address_mode_v: named!(SamplerAddressMode),
    address_mode_w: named!(SamplerAddressMode),
    mip_lod_bias: F32,
    anisotropy_enable: U32,
    max_anisotropy: F32,
    compare_enable: U32,
    compare_op: named!(CompareOp),
    min_lod: F32,
    max_lod: F32,
    border_color: named!(BorderColor),
    unnormalized_coordinates: U32,
} }

layout! { tagged COMMAND_POOL_CREATE_INFO: "VkCommandPoolCreateInfo" vk::CommandPoolCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(CommandPoolCreateFlags),
    queue_family_index: U32,
} }

layout! { tagged COMMAND_BUFFER_ALLOCATE_INFO: "VkCommandBufferAllocateInfo" vk::CommandBufferAllocateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    command_pool: Handle("VkCommandPool"),
    level: named!(CommandBufferLevel),
    command_buffer_count: U32,
} }

layout! { tagged COMMAND_BUFFER_INHERITANCE_RENDERING_INFO: "VkCommandBufferInheritanceRenderingInfo" vk::CommandBufferInheritanceRenderingInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(RenderingFlags),
    view_mask: U32,
    color_attachment_count: U32,
    p_color_attachment_formats: NamedWords(name_of!(Format), count!(vk::CommandBufferInheritanceRenderingInfo<'static>, color_attachment_count)),
    depth_attachment_format: named!(Format),
    stencil_attachment_format: named!(Format),
    rasterization_samples: flags!(SampleCountFlags),
} }

layout! { tagged COMMAND_BUFFER_INHERITANCE_INFO: "VkCommandBufferInheritanceInfo" vk::CommandBufferInheritanceInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    render_pass: Handle("VkRenderPass"),
    subpass: U32,
    framebuffer: Handle("VkFramebuffer"),
    occlusion_query_enable: U32,
    query_flags: flags!(QueryControlFlags),
    pipeline_statistics: flags!(QueryPipelineStatisticFlags),
} }

layout! { tagged COMMAND_BUFFER_BEGIN_INFO: "VkCommandBufferBeginInfo" vk::CommandBufferBeginInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(CommandBufferUsageFlags),
    p_inheritance_info: Structs(&COMMAND_BUFFER_INHERITANCE_INFO, Count::One),
} }

layout! { tagged FENCE_CREATE_INFO: "VkFenceCreateInfo" vk::FenceCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(FenceCreateFlags),
} }

layout! { tagged QUERY_POOL_CREATE_INFO: "VkQueryPoolCreateInfo" vk::QueryPoolCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(QueryPoolCreateFlags),
    query_type: named!(QueryType),
    query_count: U32,
    pipeline_statistics: flags!(QueryPipelineStatisticFlags),
} }

layout! { tagged PIPELINE_CACHE_CREATE_INFO: "VkPipelineCacheCreateInfo" vk::PipelineCacheCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineCacheCreateFlags),
    initial_data_size: U64,
    p_initial_data: Unused,
} }

layout! { tagged PIPELINE_SHADER_STAGE_CREATE_INFO: "VkPipelineShaderStageCreateInfo" vk::PipelineShaderStageCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineShaderStageCreateFlags),
    stage: flags!(ShaderStageFlags),
    module: Handle("VkShaderModule"),
    p_name: Text,
    p_specialization_info: Unused,
} }

layout! { plain VERTEX_INPUT_BINDING_DESCRIPTION: "VkVertexInputBindingDescription" vk::VertexInputBindingDescription {
    binding: U32,
    stride: U32,
    input_rate: named!(VertexInputRate),
} }

layout! { plain VERTEX_INPUT_ATTRIBUTE_DESCRIPTION: "VkVertexInputAttributeDescription" vk::VertexInputAttributeDescription {
    location: U32,
    binding: U32,
    format: named!(Format),
    offset: U32,
} }

layout! { tagged PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO: "VkPipelineVertexInputStateCreateInfo" vk::PipelineVertexInputStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineVertexInputStateCreateFlags),
    vertex_binding_description_count: U32,
    p_vertex_binding_descriptions: Structs(&VERTEX_INPUT_BINDING_DESCRIPTION, count!(vk::PipelineVertexInputStateCreateInfo<'static>, vertex_binding_description_count)),
    vertex_attribute_description_count: U32,
    p_vertex_attribute_descriptions: Structs(&VERTEX_INPUT_ATTRIBUTE_DESCRIPTION, count!(vk::PipelineVertexInputStateCreateInfo<'static>, vertex_attribute_description_count)),
} }

layout! { tagged PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO: "VkPipelineInputAssemblyStateCreateInfo" vk::PipelineInputAssemblyStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineInputAssemblyStateCreateFlags),
    topology: named!(PrimitiveTopology),
    primitive_restart_enable: U32,
} }

layout! { tagged PIPELINE_TESSELLATION_DOMAIN_ORIGIN_STATE_CREATE_INFO: "VkPipelineTessellationDomainOriginStateCreateInfo" vk::PipelineTessellationDomainOriginStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    domain_origin: named!(TessellationDomainOrigin),
} }

layout! { tagged PIPELINE_TESSELLATION_STATE_CREATE_INFO: "VkPipelineTessellationStateCreateInfo" vk::PipelineTessellationStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineTessellationStateCreateFlags),
    patch_control_points: U32,
} }

layout! { plain OFFSET2_D: "VkOffset2D" vk::Offset2D {
    x: I32,
    y: I32,
} }

layout! { plain EXTENT2_D: "VkExtent2D" vk::Extent2D {
    width: U32,
    height: U32,
} }

layout! { plain OFFSET3_D: "VkOffset3D" vk::Offset3D {
    x: I32,
    y: I32,
    z: I32,
} }

layout! { plain EXTENT3_D: "VkExtent3D" vk::Extent3D {
    width: U32,
    height: U32,
    depth: U32,
} }

layout! { plain RECT2_D: "VkRect2D" vk::Rect2D {
    offset: Struct(&OFFSET2_D),
    extent: Struct(&EXTENT2_D),
} }

layout! { plain VIEWPORT: "VkViewport" vk::Viewport {
    x: F32,
    y: F32,
    width: F32,
    height: F32,
    min_depth: F32,
    max_depth: F32,
} }

layout! { tagged PIPELINE_VIEWPORT_STATE_CREATE_INFO: "VkPipelineViewportStateCreateInfo" vk::PipelineViewportStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineViewportStateCreateFlags),
    viewport_count: U32,
    p_viewports: Structs(&VIEWPORT, count!(vk::PipelineViewportStateCreateInfo<'static>, viewport_count)),
    scissor_count: U32,
    p_scissors: Structs(&RECT2_D, count!(vk::PipelineViewportStateCreateInfo<'static>, scissor_count)),
} }

layout! { tagged PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT: "VkPipelineRasterizationProvokingVertexStateCreateInfoEXT" vk::PipelineRasterizationProvokingVertexStateCreateInfoEXT<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    provoking_vertex_mode: named!(ProvokingVertexModeEXT),
} }

layout! { tagged PIPELINE_RASTERIZATION_STATE_CREATE_INFO: "VkPipelineRasterizationStateCreateInfo" vk::PipelineRasterizationStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineRasterizationStateCreateFlags),
    depth_clamp_enable: U32,
    rasterizer_discard_enable: U32,
    polygon_mode: named!(PolygonMode),
    cull_mode: flags!(CullModeFlags),
    front_face: named!(FrontFace),
    depth_bias_enable: U32,
    depth_bias_constant_factor: F32,
    depth_bias_clamp: F32,
    depth_bias_slope_factor: F32,
    line_width: F32,
} }

layout! { tagged PIPELINE_MULTISAMPLE_STATE_CREATE_INFO: "VkPipelineMultisampleStateCreateInfo" vk::PipelineMultisampleStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineMultisampleStateCreateFlags),
    rasterization_samples: flags!(SampleCountFlags),
    sample_shading_enable: U32,
    min_sample_shading: F32,
    p_sample_mask: Words(Count::One),
    alpha_to_coverage_enable: U32,
    alpha_to_one_enable: U32,
} }

layout! { plain STENCIL_OP_STATE: "VkStencilOpState" vk::StencilOpState {
    fail_op: named!(StencilOp),
    pass_op: named!(StencilOp),
    depth_fail_op: named!(StencilOp),
    compare_op: named!(CompareOp),
    compare_mask: U32,
    write_mask: U32,
    reference: U32,
} }

layout! { tagged PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO: "VkPipelineDepthStencilStateCreateInfo" vk::PipelineDepthStencilStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineDepthStencilStateCreateFlags),
    depth_test_enable: U32,
    depth_write_enable: U32,
    depth_compare_op: named!(CompareOp),
    depth_bounds_test_enable: U32,
    stencil_test_enable: U32,
    front: Struct(&STENCIL_OP_STATE),
    back: Struct(&STENCIL_OP_STATE),
    min_depth_bounds: F32,
    max_depth_bounds: F32,
} }

layout! { plain PIPELINE_COLOR_BLEND_ATTACHMENT_STATE: "VkPipelineColorBlendAttachmentState" vk::PipelineColorBlendAttachmentState {
    blend_enable: U32,
    src_color_blend_factor: named!(BlendFactor),
    dst_color_blend_factor: named!(BlendFactor),
    color_blend_op: named!(BlendOp),
    src_alpha_blend_factor: named!(BlendFactor),
    dst_alpha_blend_factor: named!(BlendFactor),
    alpha_blend_op: named!(BlendOp),
    color_write_mask: flags!(ColorComponentFlags),
} }

layout! { tagged PIPELINE_COLOR_BLEND_ADVANCED_STATE_CREATE_INFO_EXT: "VkPipelineColorBlendAdvancedStateCreateInfoEXT" vk::PipelineColorBlendAdvancedStateCreateInfoEXT<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    src_premultiplied: U32,
    dst_premultiplied: U32,
    blend_overlap: named!(BlendOverlapEXT),
} }

layout! { tagged PIPELINE_COLOR_BLEND_STATE_CREATE_INFO: "VkPipelineColorBlendStateCreateInfo" vk::PipelineColorBlendStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineColorBlendStateCreateFlags),
    logic_op_enable: U32,
    logic_op: named!(LogicOp),
    attachment_count: U32,
    p_attachments: Structs(&PIPELINE_COLOR_BLEND_ATTACHMENT_STATE, count!(vk::PipelineColorBlendStateCreateInfo<'static>, attachment_count)),
    blend_constants: F32s(4),
} }

layout! { tagged PIPELINE_DYNAMIC_STATE_CREATE_INFO: "VkPipelineDynamicStateCreateInfo" vk::PipelineDynamicStateCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineDynamicStateCreateFlags),
    dynamic_state_count: U32,
    p_dynamic_states: NamedWords(name_of!(DynamicState), count!(vk::PipelineDynamicStateCreateInfo<'static>, dynamic_state_count)),
} }

layout! { tagged PIPELINE_RENDERING_CREATE_INFO: "VkPipelineRenderingCreateInfo" vk::PipelineRenderingCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    view_mask: U32,
    color_attachment_count: U32,
    p_color_attachment_formats: NamedWords(name_of!(Format), count!(vk::PipelineRenderingCreateInfo<'static>, color_attachment_count)),
    depth_attachment_format: named!(Format),
    stencil_attachment_format: named!(Format),
} }

layout! { tagged GRAPHICS_PIPELINE_CREATE_INFO: "VkGraphicsPipelineCreateInfo" vk::GraphicsPipelineCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineCreateFlags),
    stage_count: U32,
    p_stages: Structs(&PIPELINE_SHADER_STAGE_CREATE_INFO, count!(vk::GraphicsPipelineCreateInfo<'static>, stage_count)),
    p_vertex_input_state: Structs(&PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO, Count::One),
    p_input_assembly_state: Structs(&PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, Count::One),
    p_tessellation_state: Structs(&PIPELINE_TESSELLATION_STATE_CREATE_INFO, Count::One),
    p_viewport_state: Structs(&PIPELINE_VIEWPORT_STATE_CREATE_INFO, Count::One),
    p_rasterization_state: Structs(&PIPELINE_RASTERIZATION_STATE_CREATE_INFO, Count::One),
    p_multisample_state: Structs(&PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, Count::One),
    p_depth_stencil_state: Structs(&PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO, Count::One),
    p_color_blend_state: Structs(&PIPELINE_COLOR_BLEND_STATE_CREATE_INFO, Count::One),
    p_dynamic_state: Structs(&PIPELINE_DYNAMIC_STATE_CREATE_INFO, Count::One),
    layout: Handle("VkPipelineLayout"),
    render_pass: Handle("VkRenderPass"),
    subpass: U32,
    base_pipeline_handle: Handle("VkPipeline"),
    base_pipeline_index: I32,
} }

layout! { tagged COMPUTE_PIPELINE_CREATE_INFO: "VkComputePipelineCreateInfo" vk::ComputePipelineCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(PipelineCreateFlags),
    stage: Struct(&PIPELINE_SHADER_STAGE_CREATE_INFO),
    layout: Handle("VkPipelineLayout"),
    base_pipeline_handle: Handle("VkPipeline"),
    base_pipeline_index: I32,
} }

layout! { tagged ATTACHMENT_DESCRIPTION_STENCIL_LAYOUT: "VkAttachmentDescriptionStencilLayout" vk::AttachmentDescriptionStencilLayout<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    stencil_initial_layout: named!(ImageLayout),
    stencil_final_layout: named!(ImageLayout),
} }

layout! { tagged ATTACHMENT_DESCRIPTION2: "VkAttachmentDescription2" vk::AttachmentDescription2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(AttachmentDescriptionFlags),
    format: named!(Format),
    samples: flags!(SampleCountFlags),
    load_op: named!(AttachmentLoadOp),
    store_op: named!(AttachmentStoreOp),
    stencil_load_op: named!(AttachmentLoadOp),
    stencil_store_op: named!(AttachmentStoreOp),
    initial_layout: named!(ImageLayout),
    final_layout: named!(ImageLayout),
} }

layout! { tagged ATTACHMENT_REFERENCE_STENCIL_LAYOUT: "VkAttachmentReferenceStencilLayout" vk::AttachmentReferenceStencilLayout<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    stencil_layout: named!(ImageLayout),
} }

layout! { tagged ATTACHMENT_REFERENCE2: "VkAttachmentReference2" vk::AttachmentReference2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    attachment: U32,
    layout: named!(ImageLayout),
    aspect_mask: flags!(ImageAspectFlags),
} }

layout! { tagged SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE: "VkSubpassDescriptionDepthStencilResolve" vk::SubpassDescriptionDepthStencilResolve<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    depth_resolve_mode: flags!(ResolveModeFlags),
    stencil_resolve_mode: flags!(ResolveModeFlags),
    p_depth_stencil_resolve_attachment: Structs(&ATTACHMENT_REFERENCE2, Count::One),
} }

layout! { tagged SUBPASS_DESCRIPTION2: "VkSubpassDescription2" vk::SubpassDescription2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(SubpassDescriptionFlags),
    pipeline_bind_point: named!(PipelineBindPoint),
    view_mask: U32,
    input_attachment_count: U32,
    p_input_attachments: Structs(&ATTACHMENT_REFERENCE2, count!(vk::SubpassDescription2<'static>, input_attachment_count)),
    color_attachment_count: U32,
    p_color_attachments: Structs(&ATTACHMENT_REFERENCE2, count!(vk::SubpassDescription2<'static>, color_attachment_count)),
    p_resolve_attachments: Structs(&ATTACHMENT_REFERENCE2, count!(vk::SubpassDescription2<'static>, color_attachment_count)),
    p_depth_stencil_attachment: Structs(&ATTACHMENT_REFERENCE2, Count::One),
    preserve_attachment_count: U32,
    p_preserve_attachments: Words(count!(vk::SubpassDescription2<'static>, preserve_attachment_count)),
} }

layout! { tagged MEMORY_BARRIER2: "VkMemoryBarrier2" vk::MemoryBarrier2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    src_stage_mask: U64,
    src_access_mask: U64,
    dst_stage_mask: U64,
    dst_access_mask: U64,
} }

layout! { tagged SUBPASS_DEPENDENCY2: "VkSubpassDependency2" vk::SubpassDependency2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    src_subpass: U32,
    dst_subpass: U32,
    src_stage_mask: flags!(PipelineStageFlags),
    dst_stage_mask: flags!(PipelineStageFlags),
    src_access_mask: flags!(AccessFlags),
    dst_access_mask: flags!(AccessFlags),
    dependency_flags: flags!(DependencyFlags),
    view_offset: I32,
} }

layout! { tagged RENDER_PASS_CREATE_INFO2: "VkRenderPassCreateInfo2" vk::RenderPassCreateInfo2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(RenderPassCreateFlags),
    attachment_count: U32,
    p_attachments: Structs(&ATTACHMENT_DESCRIPTION2, count!(vk::RenderPassCreateInfo2<'static>, attachment_count)),
    subpass_count: U32,
    p_subpasses: Structs(&SUBPASS_DESCRIPTION2, count!(vk::RenderPassCreateInfo2<'static>, subpass_count)),
    dependency_count: U32,
    p_dependencies: Structs(&SUBPASS_DEPENDENCY2, count!(vk::RenderPassCreateInfo2<'static>, dependency_count)),
    correlated_view_mask_count: U32,
    p_correlated_view_masks: Words(count!(vk::RenderPassCreateInfo2<'static>, correlated_view_mask_count)),
} }

layout! { tagged FRAMEBUFFER_CREATE_INFO: "VkFramebufferCreateInfo" vk::FramebufferCreateInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(FramebufferCreateFlags),
    render_pass: Handle("VkRenderPass"),
    attachment_count: U32,
    p_attachments: Handles("VkImageView", count!(vk::FramebufferCreateInfo<'static>, attachment_count)),
    width: U32,
    height: U32,
    layers: U32,
} }

layout! { tagged RENDER_PASS_BEGIN_INFO: "VkRenderPassBeginInfo" vk::RenderPassBeginInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    render_pass: Handle("VkRenderPass"),
    framebuffer: Handle("VkFramebuffer"),
    render_area: Struct(&RECT2_D),
    clear_value_count: U32,
    p_clear_values: Structs(&CLEAR_VALUE, count!(vk::RenderPassBeginInfo<'static>, clear_value_count)),
} }

layout! { tagged RENDERING_ATTACHMENT_INFO: "VkRenderingAttachmentInfo" vk::RenderingAttachmentInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    image_view: Handle("VkImageView"),
    image_layout: named!(ImageLayout),
    resolve_mode: flags!(ResolveModeFlags),
    resolve_image_view: Handle("VkImageView"),
    resolve_image_layout: named!(ImageLayout),
    load_op: named!(AttachmentLoadOp),
    store_op: named!(AttachmentStoreOp),
    clear_value: Struct(&CLEAR_VALUE),
} }

layout! { tagged RENDERING_INFO: "VkRenderingInfo" vk::RenderingInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(RenderingFlags),
    render_area: Struct(&RECT2_D),
    layer_count: U32,
    view_mask: U32,
    color_attachment_count: U32,
    p_color_attachments: Structs(&RENDERING_ATTACHMENT_INFO, count!(vk::RenderingInfo<'static>, color_attachment_count)),
    p_depth_attachment: Structs(&RENDERING_ATTACHMENT_INFO, Count::One),
    p_stencil_attachment: Structs(&RENDERING_ATTACHMENT_INFO, Count::One),
} }

layout! { tagged BUFFER_MEMORY_BARRIER2: "VkBufferMemoryBarrier2" vk::BufferMemoryBarrier2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    src_stage_mask: U64,
    src_access_mask: U64,
    dst_stage_mask: U64,
    dst_access_mask: U64,
    src_queue_family_index: U32,
    dst_queue_family_index: U32,
    buffer: Handle("VkBuffer"),
    offset: U64,
    size: U64,
} }

layout! { tagged IMAGE_MEMORY_BARRIER2: "VkImageMemoryBarrier2" vk::ImageMemoryBarrier2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    src_stage_mask: U64,
    src_access_mask: U64,
    dst_stage_mask: U64,
    dst_access_mask: U64,
    old_layout: named!(ImageLayout),
    new_layout: named!(ImageLayout),
    src_queue_family_index: U32,
    dst_queue_family_index: U32,
    image: Handle("VkImage"),
    subresource_range: Struct(&IMAGE_SUBRESOURCE_RANGE),
} }

layout! { tagged DEPENDENCY_INFO: "VkDependencyInfo" vk::DependencyInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    dependency_flags: flags!(DependencyFlags),
    memory_barrier_count: U32,
    p_memory_barriers: Structs(&MEMORY_BARRIER2, count!(vk::DependencyInfo<'static>, memory_barrier_count)),
    buffer_memory_barrier_count: U32,
    p_buffer_memory_barriers: Structs(&BUFFER_MEMORY_BARRIER2, count!(vk::DependencyInfo<'static>, buffer_memory_barrier_count)),
    image_memory_barrier_count: U32,
    p_image_memory_barriers: Structs(&IMAGE_MEMORY_BARRIER2, count!(vk::DependencyInfo<'static>, image_memory_barrier_count)),
} }

layout! { tagged COMMAND_BUFFER_SUBMIT_INFO: "VkCommandBufferSubmitInfo" vk::CommandBufferSubmitInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    command_buffer: Handle("VkCommandBuffer"),
    device_mask: U32,
} }

layout! { tagged SEMAPHORE_SUBMIT_INFO: "VkSemaphoreSubmitInfo" vk::SemaphoreSubmitInfo<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    semaphore: Handle("VkSemaphore"),
    value: U64,
    stage_mask: U64,
    device_index: U32,
} }

layout! { tagged SUBMIT_INFO2: "VkSubmitInfo2" vk::SubmitInfo2<'static> {
    s_type: named!(StructureType),
    p_next: Next(&TAGGED),
    flags: flags!(SubmitFlags),
    wait_semaphore_info_count: U32,
    p_wait_semaphore_infos: Structs(&SEMAPHORE_SUBMIT_INFO, count!(vk::SubmitInfo2<'static>, wait_semaphore_info_count)),
    command_buffer_info_count: U32,
    p_command_buffer_infos: Structs(&COMMAND_BUFFER_SUBMIT_INFO, count!(vk::SubmitInfo2<'static>, command_buffer_info_count)),
    signal_semaphore_info_count: U32,
    p_signal_semaphore_infos: Structs(&SEMAPHORE_SUBMIT_INFO, count!(vk::SubmitInfo2<'static>, signal_semaphore_info_count)),
} }

layout! { plain IMAGE_SUBRESOURCE_LAYERS: "VkImageSubresourceLayers" vk::ImageSubresourceLayers {
    aspect_mask: flags!(ImageAspectFlags),
    mip_level: U32,
    base_array_layer: U32,
    layer_count: U32,
} }

layout! { plain IMAGE_BLIT: "VkImageBlit" vk::ImageBlit {
    src_subresource: Struct(&IMAGE_SUBRESOURCE_LAYERS),
    src_offsets: F32s(2),
    dst_subresource: Struct(&IMAGE_SUBRESOURCE_LAYERS),
    dst_offsets: F32s(2),
} }

layout! { plain IMAGE_COPY: "VkImageCopy" vk::ImageCopy {
    src_subresource: Struct(&IMAGE_SUBRESOURCE_LAYERS),
    src_offset: Struct(&OFFSET3_D),
    dst_subresource: Struct(&IMAGE_SUBRESOURCE_LAYERS),
    dst_offset: Struct(&OFFSET3_D),
    extent: Struct(&EXTENT3_D),
} }

layout! { plain BUFFER_IMAGE_COPY: "VkBufferImageCopy" vk::BufferImageCopy {
    buffer_offset: U64,
    buffer_row_length: U32,
    buffer_image_height: U32,
    image_subresource: Struct(&IMAGE_SUBRESOURCE_LAYERS),
    image_offset: Struct(&OFFSET3_D),
    image_extent: Struct(&EXTENT3_D),
} }

layout! { plain CLEAR_DEPTH_STENCIL_VALUE: "VkClearDepthStencilValue" vk::ClearDepthStencilValue {
    depth: F32,
    stencil: U32,
} }

layout! { plain CLEAR_ATTACHMENT: "VkClearAttachment" vk::ClearAttachment {
    aspect_mask: flags!(ImageAspectFlags),
    color_attachment: U32,
    clear_value: Struct(&CLEAR_VALUE),
} }

layout! { plain CLEAR_RECT: "VkClearRect" vk::ClearRect {
    rect: Struct(&RECT2_D),
    base_array_layer: U32,
    layer_count: U32,
} }

layout! { plain COLOR_BLEND_EQUATION_EXT: "VkColorBlendEquationEXT" vk::ColorBlendEquationEXT {
    src_color_blend_factor: named!(BlendFactor),
    dst_color_blend_factor: named!(BlendFactor),
    color_blend_op: named!(BlendOp),
    src_alpha_blend_factor: named!(BlendFactor),
    dst_alpha_blend_factor: named!(BlendFactor),
    alpha_blend_op: named!(BlendOp),
} }
