//! The capabilities of an adapter, as wgpu reports them.

use crate::format;
use etalon_frame::{ChannelEncoding, Feature, TextureFormat};
use etalon_webgpu::{Abilities, DeviceLimits, Level, Offer, SAMPLES, Uses, texture_usages};
use std::collections::BTreeSet;
use wgpu::{DownlevelFlags, Features, TextureFormatFeatureFlags, TextureUsages};

/// Returns the optional device features that this backend uses.
pub(crate) fn used_features() -> Features {
    Features::TIMESTAMP_QUERY
        | Features::DEPTH32FLOAT_STENCIL8
        | Features::FLOAT32_BLENDABLE
        | Features::RG11B10UFLOAT_RENDERABLE
        | Features::TEXTURE_FORMAT_16BIT_NORM
        | Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
        | Features::DUAL_SOURCE_BLENDING
        | Features::DEPTH_CLIP_CONTROL
        | Features::PIPELINE_STATISTICS_QUERY
        | Features::SHADER_EARLY_DEPTH_TEST
        | Features::INDIRECT_FIRST_INSTANCE
        | Features::CLIP_DISTANCES
}

/// Returns the abilities of an adapter with these flags.
fn abilities(flags: DownlevelFlags) -> Abilities {
    Abilities {
        copies: flags.contains(DownlevelFlags::DEPTH_TEXTURE_AND_BUFFER_COPIES),
        casts: flags.contains(DownlevelFlags::VIEW_FORMATS),
        layers: true,
    }
}

/// Returns the uses of a format that wgpu allows a device with these features. As in wgpu's validation, these
/// are the adapter's own if the feature is enabled or the adapter is downlevel, and otherwise those of
/// WebGPU's table.
fn format_features(
    adapter: &wgpu::Adapter,
    features: Features,
    format: wgpu::TextureFormat,
) -> wgpu::TextureFormatFeatures {
    let flags = adapter.get_downlevel_capabilities().flags;
    if features.contains(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)
        || !flags.contains(DownlevelFlags::WEBGPU_TEXTURE_FORMAT_SUPPORT)
    {
        adapter.get_texture_format_features(format)
    } else {
        format.guaranteed_format_features(features)
    }
}

/// Returns the uses of a format, or `None` if its textures cannot be uploaded, fetched from and read.
fn uses(adapter: &wgpu::Adapter, features: Features, format: TextureFormat) -> Option<Uses> {
    let real = format::texture(format)?;
    if !features.contains(real.required_features()) {
        return None;
    }
    let found = format_features(adapter, features, real);
    let needed = TextureUsages::from_bits_truncate(texture_usages(format));
    if !found.allowed_usages.contains(needed) {
        return None;
    }
    let flag = |flag| found.flags.contains(flag);
    let drawn = found
        .allowed_usages
        .contains(TextureUsages::RENDER_ATTACHMENT);
    let any = |choices: Features| features.intersects(choices);
    Some(Uses {
        drawn: drawn
            && (format != TextureFormat::Rg11b10Ufloat
                || any(Features::RG11B10UFLOAT_RENDERABLE
                    | Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)),
        blended: flag(TextureFormatFeatureFlags::BLENDABLE)
            && (format.color_channels().first() != Some(&ChannelEncoding::Float32)
                || any(Features::FLOAT32_BLENDABLE)),
        multisampled: found.flags.sample_count_supported(SAMPLES)
            && (!format.is_color() || flag(TextureFormatFeatureFlags::MULTISAMPLE_RESOLVE)),
    })
}

/// Returns the features that wgpu supports beyond those of every device. wgpu lacks or refuses the rest:
/// advanced blending, clears within a pass, resolves of depth and stencil, reversed depth ranges, mirrored
/// viewports, scissors beyond the attachments, polygon modes (a native feature of wgpu that no specification
/// describes), tessellation, last provoking vertices, disabled clip distances, factors of `min` and `max`,
/// counts of samples, sample coverage, and minimum sample shading.
///
/// Translation keeps early-test attributes of shaders, since the wgpu feature requires the GLSL versions that
/// have them. If wgpu reports a feature and then refuses it, the feature's cases fail.
fn offered(flags: DownlevelFlags, features: Features, limits: &wgpu::Limits) -> BTreeSet<Feature> {
    let flag = |flag| flags.contains(flag);
    let feature = |feature| features.contains(feature);
    let storage = flag(DownlevelFlags::FRAGMENT_WRITABLE_STORAGE)
        && limits.max_storage_buffers_per_shader_stage > 0;
    let per_sample = flag(DownlevelFlags::MULTISAMPLED_SHADING);
    let early_tests = feature(Features::SHADER_EARLY_DEPTH_TEST);
    let features_found = [
        (Feature::BaseVertex, flag(DownlevelFlags::BASE_VERTEX)),
        (Feature::ClipDistances, feature(Features::CLIP_DISTANCES)),
        (Feature::ConservativeDepth, early_tests),
        (
            Feature::DepthBiasClamp,
            flag(DownlevelFlags::DEPTH_BIAS_CLAMP),
        ),
        (Feature::DepthClamp, feature(Features::DEPTH_CLIP_CONTROL)),
        (
            Feature::DualSourceBlending,
            feature(Features::DUAL_SOURCE_BLENDING),
        ),
        (Feature::ForcedEarlyTests, early_tests),
        (Feature::ForcedEarlyTestsWithDepth, early_tests),
        (Feature::FragmentStorage, storage),
        (
            Feature::FragmentInvocations,
            feature(Features::PIPELINE_STATISTICS_QUERY),
        ),
        (
            Feature::IndependentBlend,
            flag(DownlevelFlags::INDEPENDENT_BLEND),
        ),
        (Feature::SampleInterpolation, per_sample),
        (Feature::SampleShading, per_sample),
        (Feature::StorageCounters, storage),
    ];
    let found = features_found.into_iter().filter(|(_, has)| *has);
    found.map(|(feature, _)| feature).collect()
}

/// Returns what an adapter's device with these features supports.
pub(crate) fn offer(adapter: &wgpu::Adapter, features: Features, limits: &wgpu::Limits) -> Offer {
    let flags = adapter.get_downlevel_capabilities().flags;
    let known = TextureFormat::ALL.into_iter();
    Offer {
        formats: known
            .filter_map(|format| Some((format, uses(adapter, features, format)?)))
            .collect(),
        abilities: abilities(flags),
        features: offered(flags, features, &adapter.limits()),
        indirect: flags.contains(DownlevelFlags::INDIRECT_EXECUTION),
        indirect_first_instance: features.contains(Features::INDIRECT_FIRST_INSTANCE),
        level: if adapter.get_downlevel_capabilities().is_webgpu_compliant() {
            Level::Core
        } else {
            Level::Less
        },
        limits: DeviceLimits {
            texture_2d: limits.max_texture_dimension_2d,
            texture_3d: limits.max_texture_dimension_3d,
            color_attachments: limits.max_color_attachments,
            color_bytes_per_sample: limits.max_color_attachment_bytes_per_sample,
            uniform_alignment: limits.min_uniform_buffer_offset_alignment,
            storage_alignment: limits.min_storage_buffer_offset_alignment,
        },
    }
}
