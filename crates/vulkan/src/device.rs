//! Physical devices and the logical device.

use crate::error::{Check, describe};
use crate::instance::{INSTANCE_VERSION, Instance};
use crate::own_pass::OwnPassWays;
use crate::recording;
use crate::sanity;
use crate::single_state::SingleState;
use ash::vk;
use etalon_backend::{BackendError, Unavailable};
use etalon_frame::{AdapterInfo, ApiVersion, Property};
use std::collections::BTreeSet;
use std::ffi::CStr;
use std::rc::Rc;

/// The largest number of draws that an indirect draw reads from a buffer.
pub(crate) const MOST_COUNTED: u32 = 2;

/// The properties of a physical device, known before it is opened.
pub(crate) struct Identity {
    pub(crate) properties: vk::PhysicalDeviceProperties,
    pub(crate) info: AdapterInfo,
}

/// A logical device with its queue.
pub(crate) struct Device {
    pub(crate) instance: Rc<Instance>,
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) raw: ash::Device,
    pub(crate) queue: vk::Queue,
    pub(crate) queue_family: u32,
    pub(crate) limits: vk::PhysicalDeviceLimits,
    /// The version of the specification that binds the device: its own, or the instance's if that is older.
    pub(crate) version: ApiVersion,
    /// The device's promises that narrow what the specification allows.
    pub(crate) properties: BTreeSet<Property>,
    pub(crate) memory: vk::PhysicalDeviceMemoryProperties,
    /// The resolve modes of depth and stencil.
    pub(crate) resolves: Resolves,
    /// True if the queue supports compute shaders.
    pub(crate) compute: bool,
    /// The enabled optional features: the ones that the suite uses and the device has.
    pub(crate) features: vk::PhysicalDeviceFeatures,
    /// True if a vertex shader can select the second of two viewports.
    pub(crate) second_viewport: bool,
    /// True if a vertex shader can select a layer.
    pub(crate) written_layer: bool,
    /// True if an indirect draw can read its number of draws from a buffer.
    pub(crate) indirect_count: bool,
    /// The functions of extended dynamic state 3, if `all_extended` is true or `singles` is not empty.
    pub(crate) extended: Option<ash::ext::extended_dynamic_state3::DeviceFn>,
    /// True if the device has all states of extended dynamic state 3 that the suite sets together.
    pub(crate) all_extended: bool,
    /// The states of extended dynamic state 3 that the suite sets one at a time.
    pub(crate) singles: Vec<SingleState>,
    /// The function that sets a dynamic logic operation, if the device has it.
    pub(crate) dynamic_logic: Option<ash::ext::extended_dynamic_state2::Device>,
    /// True if logic operations can be enabled and disabled dynamically.
    pub(crate) logic_enable: bool,
    /// The optional ways of draws that read attachments of their own pass.
    pub(crate) own_pass: OwnPassWays,
    /// The provoking vertices that the device supports in addition to the first.
    pub(crate) provoking: Provoking,
    /// True if advanced blending is coherent; `None` if the device lacks it.
    pub(crate) advanced_blend: Option<bool>,
    /// True if fragment shaders can write the stencil reference.
    pub(crate) stencil_export: bool,
    /// The number of valid bits of a timestamp; 0 if timestamps are not supported.
    pub(crate) timestamp_bits: u32,
}

/// Returns the identity of a physical device, named after its driver.
pub(crate) fn identify(instance: &Instance, physical: vk::PhysicalDevice) -> Identity {
    // SAFETY: `physical` is of this instance.
    let properties = unsafe { instance.raw().get_physical_device_properties(physical) };
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    if properties.api_version >= vk::API_VERSION_1_2 {
        let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: the chained structure is part of Vulkan 1.2.
        unsafe {
            instance
                .raw()
                .get_physical_device_properties2(physical, &mut chain);
        }
    }
    let text = |c: Result<&CStr, _>| {
        c.map(|c| c.to_string_lossy().into_owned())
            .unwrap_or_default()
    };
    let driver_info = text(driver.driver_info_as_c_str().map_err(|_| ()));
    let info = AdapterInfo {
        name: format!(
            "vulkan:{}",
            short_name(driver.driver_id, properties.vendor_id)
        ),
        backend: "vulkan".to_owned(),
        device: text(properties.device_name_as_c_str().map_err(|_| ())),
        driver: text(driver.driver_name_as_c_str().map_err(|_| ())),
        driver_version: if driver_info.is_empty() {
            format!("{:#x}", properties.driver_version)
        } else {
            driver_info
        },
        driver_id: format!(
            "{:?}, {:04x}:{:04x}",
            driver.driver_id, properties.vendor_id, properties.device_id
        ),
        api_version: version(properties.api_version),
        software: properties.device_type == vk::PhysicalDeviceType::CPU,
        offer: None,
    };
    Identity { properties, info }
}

fn version(v: u32) -> String {
    let (major, minor) = (vk::api_version_major(v), vk::api_version_minor(v));
    format!("{major}.{minor}.{}", vk::api_version_patch(v))
}

fn short_name(id: vk::DriverId, vendor: u32) -> String {
    let known = match id {
        vk::DriverId::AMD_PROPRIETARY => "amd",
        vk::DriverId::AMD_OPEN_SOURCE => "amdvlk",
        vk::DriverId::MESA_RADV => "radv",
        vk::DriverId::NVIDIA_PROPRIETARY => "nvidia",
        vk::DriverId::INTEL_PROPRIETARY_WINDOWS => "intel",
        vk::DriverId::INTEL_OPEN_SOURCE_MESA => "anv",
        vk::DriverId::IMAGINATION_PROPRIETARY => "powervr",
        vk::DriverId::IMAGINATION_OPEN_SOURCE_MESA => "pvr",
        vk::DriverId::QUALCOMM_PROPRIETARY => "adreno",
        vk::DriverId::ARM_PROPRIETARY => "mali",
        vk::DriverId::GOOGLE_SWIFTSHADER => "swiftshader",
        vk::DriverId::BROADCOM_PROPRIETARY => "broadcom",
        vk::DriverId::MESA_LLVMPIPE => "lavapipe",
        vk::DriverId::MOLTENVK => "moltenvk",
        vk::DriverId::SAMSUNG_PROPRIETARY => "xclipse",
        vk::DriverId::MESA_VENUS => "venus",
        vk::DriverId::MESA_DOZEN => "dozen",
        vk::DriverId::MESA_TURNIP => "turnip",
        vk::DriverId::MESA_V3DV => "v3dv",
        vk::DriverId::MESA_PANVK => "panvk",
        vk::DriverId::MESA_NVK => "nvk",
        _ => "",
    };
    match (known, id.as_raw()) {
        ("", 0) => format!("vendor-{vendor:04x}"),
        ("", raw) => format!("driver-{raw}"),
        (name, _) => name.to_owned(),
    }
}

/// Returns the version of the specification that binds a device; instances request 1.3.
fn bound_version(device: u32) -> ApiVersion {
    let bound = device.min(INSTANCE_VERSION);
    let part = |number| u8::try_from(number).unwrap_or(u8::MAX);
    ApiVersion::new(
        part(vk::api_version_major(bound)),
        part(vk::api_version_minor(bound)),
    )
}

/// Returns true if a device has an extension.
fn has_extension(api: &ash::Instance, physical: vk::PhysicalDevice, name: &CStr) -> bool {
    // SAFETY: `physical` is of this instance.
    let extensions = unsafe { api.enumerate_device_extension_properties(physical) };
    let properties = extensions.iter().flatten();
    properties
        .into_iter()
        .any(|e| e.extension_name_as_c_str().is_ok_and(|n| n == name))
}

/// Returns the features of the states that the suite sets together, enabled or disabled.
fn extended_features(enabled: bool) -> vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT<'static> {
    vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT::default()
        .extended_dynamic_state3_polygon_mode(enabled)
        .extended_dynamic_state3_depth_clamp_enable(enabled)
        .extended_dynamic_state3_sample_mask(enabled)
        .extended_dynamic_state3_alpha_to_coverage_enable(enabled)
        .extended_dynamic_state3_color_blend_enable(enabled)
        .extended_dynamic_state3_color_blend_equation(enabled)
        .extended_dynamic_state3_color_write_mask(enabled)
}

/// Returns true if a device has all features of the states that the suite sets together.
fn has_all(features: &vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT<'_>) -> bool {
    [
        features.extended_dynamic_state3_polygon_mode,
        features.extended_dynamic_state3_depth_clamp_enable,
        features.extended_dynamic_state3_sample_mask,
        features.extended_dynamic_state3_alpha_to_coverage_enable,
        features.extended_dynamic_state3_color_blend_enable,
        features.extended_dynamic_state3_color_blend_equation,
        features.extended_dynamic_state3_color_write_mask,
    ]
    .into_iter()
    .all(|has| has != vk::FALSE)
}

/// Returns the feature of a state that the suite sets alone.
fn single_feature<'f>(
    features: &'f mut vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT<'_>,
    state: SingleState,
) -> &'f mut vk::Bool32 {
    match state {
        SingleState::Samples => &mut features.extended_dynamic_state3_rasterization_samples,
        SingleState::AlphaToOne => &mut features.extended_dynamic_state3_alpha_to_one_enable,
        SingleState::DepthClip => &mut features.extended_dynamic_state3_depth_clip_enable,
        SingleState::Provoking => &mut features.extended_dynamic_state3_provoking_vertex_mode,
        SingleState::Origin => &mut features.extended_dynamic_state3_tessellation_domain_origin,
    }
}

/// Returns the states that can be set one at a time and can take both of the suite's values.
fn singles(
    api: &ash::Instance,
    physical: vk::PhysicalDevice,
    enabled: &vk::PhysicalDeviceFeatures,
    provoking: Provoking,
) -> Vec<SingleState> {
    if !has_extension(api, physical, ash::ext::extended_dynamic_state3::NAME) {
        return Vec::new();
    }
    let clips = has_extension(api, physical, ash::ext::depth_clip_enable::NAME);
    let mut offered = vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT::default();
    let mut clip = vk::PhysicalDeviceDepthClipEnableFeaturesEXT::default();
    let mut chain = vk::PhysicalDeviceFeatures2::default().push_next(&mut offered);
    if clips {
        chain = chain.push_next(&mut clip);
    }
    // SAFETY: the chained structures are of extensions that the device has.
    unsafe { api.get_physical_device_features2(physical, &mut chain) };
    let has_both = |state: &SingleState| match state {
        SingleState::Samples => true,
        SingleState::AlphaToOne => enabled.alpha_to_one != vk::FALSE,
        SingleState::DepthClip => clip.depth_clip_enable != vk::FALSE,
        SingleState::Provoking => provoking.last,
        SingleState::Origin => enabled.tessellation_shader != vk::FALSE,
    };
    let mut states = SingleState::ALL.to_vec();
    states.retain(|state| has_both(state) && *single_feature(&mut offered, *state) != vk::FALSE);
    states
}

/// Returns true if a device has all states of extended dynamic state 3 that the suite sets together.
fn has_extended(api: &ash::Instance, physical: vk::PhysicalDevice) -> bool {
    if !has_extension(api, physical, ash::ext::extended_dynamic_state3::NAME) {
        return false;
    }
    let mut offered = vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT::default();
    let mut chain = vk::PhysicalDeviceFeatures2::default().push_next(&mut offered);
    // SAFETY: the chained structure is of an extension that the device has.
    unsafe { api.get_physical_device_features2(physical, &mut chain) };
    has_all(&offered)
}

/// Returns true if logic operations can be dynamic.
fn has_dynamic_logic(
    api: &ash::Instance,
    physical: vk::PhysicalDevice,
    features: &vk::PhysicalDeviceFeatures,
) -> bool {
    if features.logic_op == vk::FALSE
        || !has_extension(api, physical, ash::ext::extended_dynamic_state2::NAME)
    {
        return false;
    }
    let mut offered = vk::PhysicalDeviceExtendedDynamicState2FeaturesEXT::default();
    let mut chain = vk::PhysicalDeviceFeatures2::default().push_next(&mut offered);
    // SAFETY: the chained structure is of an extension that the device has.
    unsafe { api.get_physical_device_features2(physical, &mut chain) };
    offered.extended_dynamic_state2_logic_op != vk::FALSE
}

/// Returns true if a device with extended dynamic state 3 can enable and disable logic operations
/// dynamically.
fn has_dynamic_logic_enable(api: &ash::Instance, physical: vk::PhysicalDevice) -> bool {
    let mut offered = vk::PhysicalDeviceExtendedDynamicState3FeaturesEXT::default();
    let mut chain = vk::PhysicalDeviceFeatures2::default().push_next(&mut offered);
    // SAFETY: the chained structure is of an extension that the device has.
    unsafe { api.get_physical_device_features2(physical, &mut chain) };
    offered.extended_dynamic_state3_logic_op_enable != vk::FALSE
}

/// Returns true if an indirect draw can read its number of draws from a buffer, up to [`MOST_COUNTED`].
fn has_indirect_count(
    api: &ash::Instance,
    physical: vk::PhysicalDevice,
    limits: &vk::PhysicalDeviceLimits,
) -> bool {
    let mut offered = vk::PhysicalDeviceVulkan12Features::default();
    let mut chain = vk::PhysicalDeviceFeatures2::default().push_next(&mut offered);
    // SAFETY: the chained structure is part of Vulkan 1.2, and devices have 1.3.
    unsafe { api.get_physical_device_features2(physical, &mut chain) };
    offered.draw_indirect_count != vk::FALSE && limits.max_draw_indirect_count >= MOST_COUNTED
}

/// Returns whether a device's advanced blending is coherent, or `None` if the device lacks it.
fn advanced_blend(api: &ash::Instance, physical: vk::PhysicalDevice) -> Option<bool> {
    if !has_extension(api, physical, ash::ext::blend_operation_advanced::NAME) {
        return None;
    }
    let mut offered = vk::PhysicalDeviceBlendOperationAdvancedFeaturesEXT::default();
    let mut chain = vk::PhysicalDeviceFeatures2::default().push_next(&mut offered);
    // SAFETY: the chained structure is of an extension that the device has.
    unsafe { api.get_physical_device_features2(physical, &mut chain) };
    Some(offered.advanced_blend_coherent_operations != vk::FALSE)
}

/// The first version whose text lets shading precede forced early tests.
const SHADES_ANYWHERE: u32 = vk::make_api_version(0, 1, 3, 217);

/// Returns the promises that follow from a device's limits and version, from Vulkan 1.1, and from
/// maintenance5 if the device has it.
fn promises(api: &ash::Instance, physical: vk::PhysicalDevice) -> BTreeSet<Property> {
    let mut clipping = vk::PhysicalDevicePointClippingProperties::default();
    let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut clipping);
    // SAFETY: a device of Vulkan 1.0 leaves the chained structure as it is.
    unsafe { api.get_physical_device_properties2(physical, &mut chain) };
    let properties = chain.properties;
    let fills = properties.api_version >= vk::API_VERSION_1_1;
    let mut promises = BTreeSet::new();
    if fills && clipping.point_clipping_behavior == vk::PointClippingBehavior::ALL_CLIP_PLANES {
        promises.insert(Property::DiscardsPointsOutside);
    }
    if properties.api_version < SHADES_ANYWHERE {
        promises.insert(Property::ShadesAfterCounting);
    }
    if properties.limits.strict_lines == vk::TRUE {
        promises.insert(Property::LinesAreParallelograms);
    }
    if !has_extension(api, physical, ash::khr::maintenance5::NAME) {
        return promises;
    }
    let mut raw = vk::PhysicalDeviceMaintenance5PropertiesKHR::default();
    let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut raw);
    // SAFETY: the chained structure is of an extension that the device has.
    unsafe { api.get_physical_device_properties2(physical, &mut chain) };
    let promised = [
        (
            Property::CoverageAfterCounting,
            raw.early_fragment_multisample_coverage_after_sample_counting,
        ),
        (
            Property::MaskBeforeCounting,
            raw.early_fragment_sample_mask_test_before_sample_counting,
        ),
        (
            Property::LinesAreParallelograms,
            raw.non_strict_single_pixel_wide_lines_use_parallelogram,
        ),
    ];
    let kept = promised.into_iter().filter(|(_, has)| *has == vk::TRUE);
    promises.extend(kept.map(|(property, _)| property));
    promises
}

/// The depth and stencil resolve modes of a device.
pub(crate) struct Resolves {
    pub(crate) depth: vk::ResolveModeFlags,
    pub(crate) stencil: vk::ResolveModeFlags,
    /// True if the modes of depth and stencil can differ.
    pub(crate) independent: bool,
    /// True if one of depth and stencil can be resolved without the other.
    pub(crate) independent_none: bool,
}

impl Resolves {
    fn of(api: &ash::Instance, physical: vk::PhysicalDevice) -> Self {
        let mut raw = vk::PhysicalDeviceDepthStencilResolveProperties::default();
        let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut raw);
        // SAFETY: the chained structure is part of Vulkan 1.2, and devices have 1.3.
        unsafe { api.get_physical_device_properties2(physical, &mut chain) };
        Self {
            depth: raw.supported_depth_resolve_modes,
            stencil: raw.supported_stencil_resolve_modes,
            independent: raw.independent_resolve != vk::FALSE,
            independent_none: raw.independent_resolve_none != vk::FALSE,
        }
    }
}

/// The provoking vertices that a device supports in addition to the first.
#[derive(Clone, Copy)]
pub(crate) struct Provoking {
    /// True if the last vertex can be the provoking vertex.
    pub(crate) last: bool,
    /// True if pipelines of one pass can differ in the provoking vertex.
    pub(crate) mixed: bool,
}

impl Provoking {
    fn of(api: &ash::Instance, physical: vk::PhysicalDevice) -> Self {
        if !has_extension(api, physical, ash::ext::provoking_vertex::NAME) {
            return Self {
                last: false,
                mixed: false,
            };
        }
        let mut features = vk::PhysicalDeviceProvokingVertexFeaturesEXT::default();
        let mut chain = vk::PhysicalDeviceFeatures2::default().push_next(&mut features);
        // SAFETY: the chained structure is of an extension that the device has.
        unsafe { api.get_physical_device_features2(physical, &mut chain) };
        let mut properties = vk::PhysicalDeviceProvokingVertexPropertiesEXT::default();
        let mut chain = vk::PhysicalDeviceProperties2::default().push_next(&mut properties);
        // SAFETY: as above.
        unsafe { api.get_physical_device_properties2(physical, &mut chain) };
        let last = features.provoking_vertex_last != vk::FALSE;
        Self {
            last,
            mixed: last && properties.provoking_vertex_mode_per_pipeline != vk::FALSE,
        }
    }
}

/// Returns the device's features that the suite uses.
fn used_features(has: &vk::PhysicalDeviceFeatures) -> vk::PhysicalDeviceFeatures {
    vk::PhysicalDeviceFeatures {
        alpha_to_one: has.alpha_to_one,
        depth_bias_clamp: has.depth_bias_clamp,
        depth_bounds: has.depth_bounds,
        depth_clamp: has.depth_clamp,
        draw_indirect_first_instance: has.draw_indirect_first_instance,
        dual_src_blend: has.dual_src_blend,
        fill_mode_non_solid: has.fill_mode_non_solid,
        fragment_stores_and_atomics: has.fragment_stores_and_atomics,
        independent_blend: has.independent_blend,
        inherited_queries: has.inherited_queries,
        logic_op: has.logic_op,
        multi_viewport: has.multi_viewport,
        occlusion_query_precise: has.occlusion_query_precise,
        pipeline_statistics_query: has.pipeline_statistics_query,
        sample_rate_shading: has.sample_rate_shading,
        shader_clip_distance: has.shader_clip_distance,
        shader_cull_distance: has.shader_cull_distance,
        tessellation_shader: has.tessellation_shader,
        ..vk::PhysicalDeviceFeatures::default()
    }
}

impl Device {
    /// Creates the device with everything that cases can use. It is one call, and its structures must outlive it.
    pub(crate) fn new(
        instance: Rc<Instance>,
        physical: vk::PhysicalDevice,
        identity: &Identity,
    ) -> Result<Self, Unavailable> {
        let properties = &identity.properties;
        if properties.api_version < vk::API_VERSION_1_3 {
            return Err(Unavailable::new(
                format!(
                    "{} supports Vulkan {}, but 1.3 is required",
                    identity.info.device, identity.info.api_version
                ),
                "update the driver, or use an OpenGL adapter of the same device",
            ));
        }
        let api = instance.raw();
        // SAFETY: `physical` is of this instance.
        let families = unsafe { api.get_physical_device_queue_family_properties(physical) };
        let (graphics, compute) = (vk::QueueFlags::GRAPHICS, vk::QueueFlags::COMPUTE);
        let Some((index, family)) = [graphics | compute, graphics].iter().find_map(|flags| {
            let mut numbered = (0_u32..).zip(&families);
            numbered.find(|(_, f)| f.queue_flags.contains(*flags))
        }) else {
            return Err(Unavailable::new(
                format!("{} has no graphics queue", identity.info.device),
                "choose another device",
            ));
        };
        // SAFETY: as above.
        let features = unsafe { api.get_physical_device_features(physical) };
        let promises = promises(api, physical);
        // SAFETY: as above.
        let memory = unsafe { api.get_physical_device_memory_properties(physical) };
        sanity::check_numbers(&memory, &properties.limits)?;
        recording::memory_types(&memory);

        let priorities = [1.0];
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(index)
            .queue_priorities(&priorities)];
        let enabled = used_features(&features);
        let written_layer =
            has_extension(api, physical, ash::ext::shader_viewport_index_layer::NAME);
        let second_viewport =
            features.multi_viewport != 0 && properties.limits.max_viewports > 1 && written_layer;
        let all_extended = has_extended(api, physical);
        let provoking = Provoking::of(api, physical);
        let singles = singles(api, physical, &enabled, provoking);
        let clips = singles.contains(&SingleState::DepthClip);
        let extended = all_extended || !singles.is_empty();
        let dynamic_logic = has_dynamic_logic(api, physical, &enabled);
        let logic_enable = dynamic_logic && all_extended && has_dynamic_logic_enable(api, physical);
        let advanced_blend = advanced_blend(api, physical);
        let stencil_export = has_extension(api, physical, ash::ext::shader_stencil_export::NAME);
        let has = |name: &CStr| has_extension(api, physical, name);
        let mut own_pass = OwnPassWays::of(api, physical, has);
        own_pass.local_read &= instance.knows_local_reads();
        let mut own_features = own_pass.features();
        let extensions: Vec<_> = [
            (stencil_export, ash::ext::shader_stencil_export::NAME),
            (
                advanced_blend.is_some(),
                ash::ext::blend_operation_advanced::NAME,
            ),
            (provoking.last, ash::ext::provoking_vertex::NAME),
            (dynamic_logic, ash::ext::extended_dynamic_state2::NAME),
            (written_layer, ash::ext::shader_viewport_index_layer::NAME),
            (extended, ash::ext::extended_dynamic_state3::NAME),
            (clips, ash::ext::depth_clip_enable::NAME),
        ]
        .into_iter()
        .chain(own_features.extensions())
        .filter_map(|(used, name)| used.then_some(name.as_ptr()))
        .collect();
        let mut enabled_extended =
            extended_features(all_extended).extended_dynamic_state3_logic_op_enable(logic_enable);
        for single in &singles {
            *single_feature(&mut enabled_extended, *single) = vk::TRUE;
        }
        let mut enabled_clip =
            vk::PhysicalDeviceDepthClipEnableFeaturesEXT::default().depth_clip_enable(true);
        let mut enabled_logic = vk::PhysicalDeviceExtendedDynamicState2FeaturesEXT::default()
            .extended_dynamic_state2_logic_op(true);
        // Both features are mandatory in Vulkan 1.3.
        let mut enabled13 = vk::PhysicalDeviceVulkan13Features::default()
            .dynamic_rendering(true)
            .synchronization2(true);
        // Mandatory since Vulkan 1.1.
        let mut enabled11 = vk::PhysicalDeviceVulkan11Features::default().multiview(true);
        let mut info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&enabled)
            .enabled_extension_names(&extensions)
            .push_next(&mut enabled13)
            .push_next(&mut enabled11);
        info = own_features.enable(info);
        let indirect_count = has_indirect_count(api, physical, &properties.limits);
        // A device with the extension has both of its features
        // (VUID-VkDeviceCreateInfo-ppEnabledExtensionNames-02835).
        let mut counted = vk::PhysicalDeviceVulkan12Features::default()
            .draw_indirect_count(true)
            .shader_output_viewport_index(written_layer)
            .shader_output_layer(written_layer);
        if indirect_count {
            info = info.push_next(&mut counted);
        }
        let mut last_provokes =
            vk::PhysicalDeviceProvokingVertexFeaturesEXT::default().provoking_vertex_last(true);
        if provoking.last {
            info = info.push_next(&mut last_provokes);
        }
        if extended {
            info = info.push_next(&mut enabled_extended);
        }
        if clips {
            info = info.push_next(&mut enabled_clip);
        }
        if dynamic_logic {
            info = info.push_next(&mut enabled_logic);
        }
        let mut coherent = vk::PhysicalDeviceBlendOperationAdvancedFeaturesEXT::default()
            .advanced_blend_coherent_operations(true);
        if advanced_blend == Some(true) {
            info = info.push_next(&mut coherent);
        }
        // SAFETY: every pointer in `info` outlives the call.
        let raw = unsafe { api.create_device(physical, &info, None) }.map_err(|code| {
            Unavailable::new(
                format!(
                    "{} cannot be opened: {}",
                    identity.info.device,
                    describe(code)
                ),
                "check that this user may open the device (/dev/dri, /dev/nvidia*)",
            )
        })?;
        // A recording hides the functions that it does not record.
        let hides = recording::is_installed();
        sanity::check_functions(|name| {
            // SAFETY: the device lives, and the name is zero-terminated.
            let address =
                unsafe { (api.fp_v1_0().get_device_proc_addr)(raw.handle(), name.as_ptr()) };
            hides || address.is_some()
        })?;
        // SAFETY: the device was created with one queue of this family.
        let queue = unsafe { raw.get_device_queue(index, 0) };
        Ok(Self {
            physical,
            queue,
            queue_family: index,
            limits: properties.limits,
            version: bound_version(properties.api_version),
            properties: promises,
            memory,
            resolves: Resolves::of(api, physical),
            compute: family.queue_flags.contains(compute),
            features: enabled,
            second_viewport,
            written_layer,
            provoking,
            indirect_count,
            extended: extended.then(|| {
                let loaded = ash::ext::extended_dynamic_state3::Device::new(api, &raw);
                loaded.fp().clone()
            }),
            all_extended,
            singles,
            dynamic_logic: dynamic_logic
                .then(|| ash::ext::extended_dynamic_state2::Device::new(api, &raw)),
            logic_enable,
            advanced_blend,
            stencil_export,
            own_pass,
            // A recording has no timestamps.
            timestamp_bits: if properties.limits.timestamp_period > 0.0
                && !recording::is_installed()
            {
                family.timestamp_valid_bits
            } else {
                0
            },
            instance,
            raw,
        })
    }

    /// Returns true if images of a format have these features.
    pub(crate) fn has(&self, format: vk::Format, features: vk::FormatFeatureFlags) -> bool {
        // SAFETY: the physical device is of this living instance.
        let properties = unsafe {
            let api = self.instance.raw();
            api.get_physical_device_format_properties(self.physical, format)
        };
        properties.optimal_tiling_features.contains(features)
    }

    /// Returns the memory types among `allowed` that have the requested flags, in order of
    /// preference.
    pub(crate) fn memory_types(
        &self,
        allowed: u32,
        preferences: &[vk::MemoryPropertyFlags],
    ) -> Vec<u32> {
        let types = &self.memory.memory_types_as_slice();
        let mut found = Vec::new();
        for flags in preferences {
            for (index, kind) in (0_u32..).zip(types.iter()) {
                let fits = allowed & (1 << index) != 0 && kind.property_flags.contains(*flags);
                if fits && !found.contains(&index) {
                    found.push(index);
                }
            }
        }
        found
    }

    /// Allocates from the first suitable memory type with free memory.
    pub(crate) fn allocate(
        &self,
        needs: vk::MemoryRequirements,
        preferences: &[vk::MemoryPropertyFlags],
        what: &str,
    ) -> Result<vk::DeviceMemory, BackendError> {
        let mut result = Err(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY);
        for index in self.memory_types(needs.memory_type_bits, preferences) {
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(index);
            // SAFETY: the type index is one of the device's.
            result = unsafe { self.raw.allocate_memory(&info, None) };
            if result != Err(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY) {
                break;
            }
        }
        result.check(what)
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: the backend destroyed all objects of the device earlier, and owns the device alone. Waiting
        // can fail on a lost device, which can still be destroyed.
        unsafe {
            let _ = self.raw.device_wait_idle();
            self.raw.destroy_device(None);
        }
    }
}
