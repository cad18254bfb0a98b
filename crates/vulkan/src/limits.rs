//! The limits and features of a device.

use crate::device::Device;
use crate::format::{self, Native};
use crate::path;
use crate::samples;
use ash::vk;
use etalon_frame::{
    Api, Aspect, Feature, FormatSupport, Limits, ReadPath, Requirement, TextureFormat,
    standard_sample_positions,
};
use std::collections::{BTreeMap, BTreeSet};

/// The sample counts above 1 that cases use.
const COUNTS: [u32; 4] = [2, 4, 8, 16];

/// Returns the limits of a device that has these formats.
pub(crate) fn limits(device: &Device, natives: &BTreeMap<TextureFormat, Native>) -> Limits {
    let raw = &device.limits;
    let max_size = raw
        .max_image_dimension2_d
        .min(raw.max_framebuffer_width)
        .min(raw.max_framebuffer_height)
        .min(raw.max_viewport_dimensions[0])
        .min(raw.max_viewport_dimensions[1]);
    let mut formats = BTreeMap::new();
    for (format, native) in natives {
        let depth = if format.has_depth() {
            vec![format::depth_encoding(native.raw)]
        } else {
            Vec::new()
        };
        let support = FormatSupport {
            samples: sample_counts(device, *format, *native),
            blendable: native.attachment && native.blendable,
            depth,
            // The shader that reads samples also returns stored codes.
            read: ReadPath::Copy,
        };
        formats.insert(*format, support);
    }
    let mut sample_positions = BTreeMap::new();
    for count in [1].into_iter().chain(COUNTS) {
        if formats.values().any(|f| f.samples.contains(&count)) {
            sample_positions.insert(count, standard_sample_positions(count));
        }
    }
    Limits {
        api: Api::Vulkan,
        version: device.version,
        properties: device.properties.clone(),
        exempt: exempt(device, natives),
        sub_pixel_bits: u8::try_from(raw.sub_pixel_precision_bits).unwrap_or(u8::MAX),
        viewport_bits: u8::try_from(raw.viewport_sub_pixel_bits).ok(),
        texel_bits: u8::try_from(raw.sub_texel_precision_bits).ok(),
        max_size,
        max_storage: Some(u64::from(raw.max_storage_buffer_range)),
        max_color_attachments: raw
            .max_color_attachments
            .min(raw.max_fragment_output_attachments),
        formats,
        features: Feature::ALL
            .into_iter()
            .filter(|f| has(device, *f))
            .collect(),
        paths: path::offered(device),
        sample_positions,
    }
}

/// Returns true if the device has a feature. Mandatory features of Vulkan 1.3 are always present.
fn has(device: &Device, feature: Feature) -> bool {
    let features = &device.features;
    let resolves = &device.resolves;
    let depth = |mode| vk::Bool32::from(resolves.depth.contains(mode));
    let stencil = |mode| vk::Bool32::from(resolves.stencil.contains(mode));
    let first = vk::ResolveModeFlags::SAMPLE_ZERO;
    let flag = match feature {
        Feature::AdvancedBlend => device.advanced_blend.is_some().into(),
        Feature::AdvancedBlendCoherent => device.advanced_blend.unwrap_or(false).into(),
        Feature::AlphaToOne => features.alpha_to_one,
        // A device with the feature has at least 8 of them (Required Limits, maxClipDistances).
        Feature::ClipDistances => features.shader_clip_distance,
        // A device with the feature has at least 8 of them (maxCullDistances).
        Feature::CullDistances => features.shader_cull_distance,
        Feature::DepthBiasClamp => features.depth_bias_clamp,
        Feature::DepthBounds => features.depth_bounds,
        Feature::DepthClamp => features.depth_clamp,
        Feature::DepthResolveAverage => depth(vk::ResolveModeFlags::AVERAGE),
        Feature::DepthResolveMax => depth(vk::ResolveModeFlags::MAX),
        Feature::DepthResolveMin => depth(vk::ResolveModeFlags::MIN),
        Feature::DepthStencilResolve => depth(first) & stencil(first),
        Feature::IndependentResolve => resolves.independent.into(),
        Feature::IndependentResolveNone => resolves.independent_none.into(),
        Feature::StencilResolveMax => stencil(vk::ResolveModeFlags::MAX),
        Feature::StencilResolveMin => stencil(vk::ResolveModeFlags::MIN),
        Feature::DualSourceBlending if device.limits.max_fragment_dual_src_attachments == 0 => {
            vk::FALSE
        }
        Feature::DualSourceBlending => features.dual_src_blend,
        Feature::FragmentInvocations => features.pipeline_statistics_query,
        Feature::InheritedQueries => features.inherited_queries,
        Feature::IndependentBlend => features.independent_blend,
        Feature::LastProvokingVertex => device.provoking.last.into(),
        Feature::LogicOperations => features.logic_op,
        Feature::MixedProvokingVertices => device.provoking.mixed.into(),
        Feature::Tessellation | Feature::UpperLeftDomain => features.tessellation_shader,
        Feature::PolygonModeLine => features.fill_mode_non_solid,
        Feature::PreciseOcclusion => features.occlusion_query_precise,
        // Only OpenGL has these features.
        Feature::OwnPassReadsInOrder => device.own_pass.orders_colors().into(),
        Feature::ClipDistanceMask | Feature::MaskedClears | Feature::SampleCoverage => vk::FALSE,
        Feature::MinSampleShading | Feature::SampleInterpolation | Feature::SampleShading => {
            features.sample_rate_shading
        }
        Feature::StencilExport => device.stencil_export.into(),
        Feature::FragmentStorage | Feature::StorageCounters => features.fragment_stores_and_atomics,
        Feature::BaseVertex
        | Feature::CentroidInterpolation
        | Feature::ClearCommands
        | Feature::ConservativeDepth
        | Feature::ConstantAlphaBlendFactor
        | Feature::DepthOutputWithoutDepth
        | Feature::FirstInstance
        | Feature::FirstProvokingVertex
        | Feature::ForcedEarlyTests
        | Feature::ForcedEarlyTestsWithDepth
        | Feature::FractionalViewport
        | Feature::FragmentShaderAbsent
        | Feature::FragmentShaderAbsentWithColor
        | Feature::FrontAndBackCulling
        | Feature::LinearInterpolation
        | Feature::MinMaxBlendFactors
        | Feature::MirroredViewport
        | Feature::OwnPassReads
        | Feature::OwnPassDepthReads
        | Feature::OwnPassStencilReads
        | Feature::QueriesOverPasses
        | Feature::RasterizerDiscard
        | Feature::ReversedDepthRange
        | Feature::SampleMaskInput
        | Feature::SampleMaskOutput
        | Feature::SampleMaskOutputWithAlphaToCoverage
        | Feature::AlphaToCoverageOfOneSample
        | Feature::AlphaToCoverageWithoutAlpha
        | Feature::ScissorOutside
        | Feature::SeparateStencilMasks
        | Feature::TriangleFans
        | Feature::ViewportOutside => vk::TRUE,
    };
    flag != vk::FALSE
}

/// Returns the sample counts that the device might support, but about whose results nothing can be asserted.
fn exempt(device: &Device, natives: &BTreeMap<TextureFormat, Native>) -> BTreeSet<Requirement> {
    let unread = |(format, native): &(&TextureFormat, &Native)| {
        native.attachment && !samples_are_readable(device, **format, **native)
    };
    let unreadable = natives.iter().filter(unread);
    unreadable
        .flat_map(|(format, _)| COUNTS.map(|count| Requirement::Samples(*format, count)))
        .collect()
}

/// Returns true if the samples of a format can be read back and have standard locations. Without standard
/// sample locations, nothing could be asserted about more than one sample.
fn samples_are_readable(device: &Device, format: TextureFormat, native: Native) -> bool {
    let readable = format.aspects().iter().all(|aspect| {
        let channels = format::channels(format, native.raw, *aspect);
        channels.iter().all(|c| samples::can_read(*c))
    });
    device.limits.standard_sample_locations != 0 && device.compute && readable
}

/// Returns the sample counts that a format can be drawn with, cleared with, and read back with, sample by
/// sample.
fn sample_counts(device: &Device, format: TextureFormat, native: Native) -> Vec<u32> {
    if !native.attachment {
        return Vec::new();
    }
    let mut counts = vec![1];
    let raw = &device.limits;
    if !samples_are_readable(device, format, native) {
        return counts;
    }
    let usage =
        vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST | attachment_usage(format);
    // SAFETY: the physical device is of this living instance.
    let properties = unsafe {
        device
            .instance
            .raw()
            .get_physical_device_image_format_properties(
                device.physical,
                native.raw,
                vk::ImageType::TYPE_2D,
                vk::ImageTiling::OPTIMAL,
                usage,
                vk::ImageCreateFlags::empty(),
            )
    };
    let Ok(properties) = properties else {
        return counts;
    };
    let mut flags = properties.sample_counts;
    for aspect in format.aspects() {
        flags &= match aspect {
            // The limits give what every format supports; a format can support more (Vulkan, Supported Sample
            // Counts). The limit for integers is often 1 although this format has several.
            Aspect::Color if format.is_integer() => flags,
            Aspect::Color => {
                raw.framebuffer_color_sample_counts & raw.sampled_image_color_sample_counts
            }
            Aspect::Depth => {
                raw.framebuffer_depth_sample_counts & raw.sampled_image_depth_sample_counts
            }
            Aspect::Stencil => {
                raw.framebuffer_stencil_sample_counts & raw.sampled_image_stencil_sample_counts
            }
        };
    }
    counts.extend(COUNTS.iter().filter(|c| flags.as_raw() & **c != 0));
    counts
}

/// Returns the usage of an attachment of this format.
pub(crate) fn attachment_usage(format: TextureFormat) -> vk::ImageUsageFlags {
    if format.is_color() {
        vk::ImageUsageFlags::COLOR_ATTACHMENT
    } else {
        vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_has_a_position_of_its_own() {
        for count in [1, 2, 4, 8, 16] {
            let mut positions = standard_sample_positions(count);
            positions.sort_unstable();
            positions.dedup();
            assert_eq!(positions.len(), count as usize);
        }
        assert_eq!(standard_sample_positions(1), [[128, 128]]);
    }
}
