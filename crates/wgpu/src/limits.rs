//! The limits and features of an adapter.

use crate::format;
use etalon_frame::{
    Api, ApiVersion, Feature, FormatSupport, Limits, Requirement, TextureFormat,
    standard_sample_positions,
};
use etalon_webgpu::{Abilities, SAMPLES, paths, read_path, samples_are_exact, texture_usages};
use std::collections::{BTreeMap, BTreeSet};
use wgpu::{DownlevelFlags, Features, TextureFormatFeatureFlags, TextureUsages};

/// WebGPU does not report it; 4 is the least that any API under it allows.
const SUB_PIXEL_BITS: u8 = 4;
/// The largest size of a texel in the sum over a pass's colour attachments
/// (maxColorAttachmentBytesPerSample).
const MOST_TEXEL_BYTES: u32 = 16;
/// The largest viewport coordinate in a scene, including the far edge.
const VIEWPORT_REACH: u32 = 8192;

/// Returns the optional device features that this backend uses.
pub(crate) fn used_features() -> Features {
    Features::TIMESTAMP_QUERY
        | Features::DEPTH32FLOAT_STENCIL8
        | Features::FLOAT32_BLENDABLE
        | Features::RG11B10UFLOAT_RENDERABLE
        | Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES
        | Features::DUAL_SOURCE_BLENDING
        | Features::DEPTH_CLIP_CONTROL
        | Features::PIPELINE_STATISTICS_QUERY
        | Features::SHADER_EARLY_DEPTH_TEST
        | Features::INDIRECT_FIRST_INSTANCE
        | Features::CLIP_DISTANCES
}

/// Returns the abilities of an adapter that [`Limits`] do not tell.
pub(crate) fn abilities(adapter: &wgpu::Adapter) -> Abilities {
    let flags = adapter.get_downlevel_capabilities().flags;
    Abilities {
        copies: flags.contains(DownlevelFlags::DEPTH_TEXTURE_AND_BUFFER_COPIES),
        casts: flags.contains(DownlevelFlags::VIEW_FORMATS),
    }
}

/// Returns the uses of a format that wgpu allows a device with these features: the adapter's own if
/// the feature or a downlevel adapter calls for it, else WebGPU's table (as its validation does).
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

fn support(
    adapter: &wgpu::Adapter,
    features: Features,
    abilities: Abilities,
    format: TextureFormat,
) -> Option<FormatSupport> {
    let real = format::texture(format)?;
    if !features.contains(real.required_features()) {
        return None;
    }
    let found = format_features(adapter, features, real);
    let drawable = found
        .allowed_usages
        .contains(TextureUsages::RENDER_ATTACHMENT)
        && (format != TextureFormat::Rg11b10Ufloat
            || features.contains(Features::RG11B10UFLOAT_RENDERABLE)
            || features.contains(Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES));
    let needed = TextureUsages::from_bits_truncate(texture_usages(format));
    if !found.allowed_usages.contains(needed) || !format.is_color() && !drawable {
        return None;
    }
    // WebGPU does not resolve integers (26.1.1).
    let multisampled = found.flags.sample_count_supported(SAMPLES)
        && !format.is_integer()
        && (!format.is_color()
            || found
                .flags
                .contains(TextureFormatFeatureFlags::MULTISAMPLE_RESOLVE))
        && samples_are_exact(format, abilities);
    let mut samples = Vec::new();
    if drawable {
        samples.push(1);
        if multisampled {
            samples.push(SAMPLES);
        }
    }
    Some(FormatSupport {
        samples,
        blendable: drawable
            && !format.is_integer()
            && found.flags.contains(TextureFormatFeatureFlags::BLENDABLE)
            && (format != TextureFormat::Rgba32Float
                || features.contains(Features::FLOAT32_BLENDABLE)),
        // The adapter does not report which one it uses.
        depth: format.depth_encodings().to_vec(),
        read: read_path(format, abilities),
    })
}

/// Returns the features that wgpu offers beyond WebGPU's minimum. It lacks or refuses the rest: advanced blending, clears
/// within a pass, resolves of depth and stencil, reversed depth ranges, mirrored viewports, scissors beyond the attachments, tessellation, last provoking vertices, clip distances that are off, factors of `min` and
/// `max`, counts of samples, sample coverage, least shares of sample shading.
///
/// Shaders with early-test attributes keep them in translation, since the wgpu feature requires the
/// GLSL versions that have them. What wgpu offers and then refuses fails its cases.
fn offered(flags: DownlevelFlags, features: Features, limits: &wgpu::Limits) -> BTreeSet<Feature> {
    let max_size = limits.max_texture_dimension_2d;
    let flag = |flag| flags.contains(flag);
    let feature = |feature| features.contains(feature);
    let storage = flag(DownlevelFlags::FRAGMENT_WRITABLE_STORAGE)
        && limits.max_storage_buffers_per_shader_stage > 0;
    let features_found = [
        (Feature::BaseVertex, flag(DownlevelFlags::BASE_VERTEX)),
        (Feature::CentroidInterpolation, true),
        (Feature::ClipDistances, feature(Features::CLIP_DISTANCES)),
        (
            Feature::ConservativeDepth,
            feature(Features::SHADER_EARLY_DEPTH_TEST),
        ),
        (
            Feature::DepthBiasClamp,
            flag(DownlevelFlags::DEPTH_BIAS_CLAMP),
        ),
        (Feature::DepthClamp, feature(Features::DEPTH_CLIP_CONTROL)),
        // A pipeline whose shader writes `frag_depth` has a format with depth (GPURenderPipelineDescriptor).
        (Feature::DepthOutputWithoutDepth, false),
        (
            Feature::DualSourceBlending,
            feature(Features::DUAL_SOURCE_BLENDING),
        ),
        (Feature::LinearInterpolation, true),
        // Only the arguments of indirect draws need a feature of their own.
        (Feature::FirstInstance, true),
        // `@interpolate(flat)` is that of the first vertex (WGSL, Interpolation); there is no other.
        (Feature::FirstProvokingVertex, true),
        (
            Feature::ForcedEarlyTests,
            feature(Features::SHADER_EARLY_DEPTH_TEST),
        ),
        (
            Feature::ForcedEarlyTestsWithDepth,
            feature(Features::SHADER_EARLY_DEPTH_TEST),
        ),
        (Feature::FragmentStorage, storage),
        // A pipeline without targets fits no pass with colour attachments (render pass layouts).
        (Feature::FragmentShaderAbsent, true),
        (Feature::FragmentShaderAbsentWithColor, false),
        (
            Feature::FragmentInvocations,
            feature(Features::PIPELINE_STATISTICS_QUERY),
        ),
        (
            Feature::IndependentBlend,
            flag(DownlevelFlags::INDEPENDENT_BLEND),
        ),
        // WebGPU has no polygon modes; a native feature of wgpu answers to no text.
        (Feature::PolygonModeLine, false),
        (Feature::SampleMaskOutput, true),
        // A pipeline that writes one has alpha to coverage off (GPURenderPipelineDescriptor).
        (Feature::SampleMaskOutputWithAlphaToCoverage, false),
        (
            Feature::SampleShading,
            flag(DownlevelFlags::MULTISAMPLED_SHADING),
        ),
        // WGSL has no such built-in.
        (Feature::StencilExport, false),
        (Feature::StorageCounters, storage),
        // WebGPU limits a viewport to twice the largest texture (setViewport).
        (Feature::ViewportOutside, 2 * max_size > VIEWPORT_REACH),
    ];
    features_found
        .into_iter()
        .filter_map(|(f, has)| has.then_some(f))
        .collect()
}

/// Returns what an adapter may lack without breaking WebGPU's word: what this backend does not use, and
/// everything where wgpu itself says that the adapter has less than WebGPU.
fn exempt(adapter: &wgpu::Adapter, abilities: Abilities) -> BTreeSet<Requirement> {
    let complete = adapter.get_downlevel_capabilities().is_webgpu_compliant();
    // Only four targets of the shortest texels fit into WebGPU's bytes.
    let mut exempt = BTreeSet::from([Requirement::ColorAttachments(4)]);
    for format in TextureFormat::ALL {
        if !complete || format.is_integer() || !samples_are_exact(format, abilities) {
            exempt.insert(Requirement::Samples(format, SAMPLES));
        }
        if !complete {
            exempt.extend([
                Requirement::Format(format),
                Requirement::Drawing(format),
                Requirement::Blending(format),
            ]);
        }
    }
    if !complete {
        exempt.extend(Feature::ALL.map(Requirement::Feature));
    }
    exempt
}

/// Returns the limits of an adapter's device with these features, all of them by wgpu's own word.
pub(crate) fn limits(adapter: &wgpu::Adapter, features: Features, abilities: Abilities) -> Limits {
    let limits = adapter.limits();
    let flags = adapter.get_downlevel_capabilities().flags;
    let formats: BTreeMap<_, _> = TextureFormat::ALL
        .into_iter()
        .filter_map(|f| Some((f, support(adapter, features, abilities, f)?)))
        .collect();
    let max_size = limits.max_texture_dimension_2d;
    let offered = offered(flags, features, &limits);
    Limits {
        api: Api::WebGpu,
        version: ApiVersion::UNKNOWN,
        properties: BTreeSet::new(),
        exempt: exempt(adapter, abilities),
        sub_pixel_bits: SUB_PIXEL_BITS,
        max_size,
        max_color_attachments: limits
            .max_color_attachments
            .min(limits.max_color_attachment_bytes_per_sample / MOST_TEXEL_BYTES),
        formats,
        paths: paths(flags.contains(DownlevelFlags::INDIRECT_EXECUTION), &offered),
        features: offered,
        // WebGPU requires the standard ones of all adapters (Rasterization).
        sample_positions: BTreeMap::from([1, SAMPLES].map(|n| (n, standard_sample_positions(n)))),
    }
}
