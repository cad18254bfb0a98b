//! The capabilities of a device, as limits against which scenes are checked.

use crate::device::{Abilities, Device, SAMPLES, read_path, samples_are_exact};
use crate::path::paths;
use etalon_frame::{
    Api, ApiVersion, Feature, FormatSupport, Limits, Requirement, TextureFormat,
    standard_sample_positions,
};
use std::collections::{BTreeMap, BTreeSet};

/// WebGPU does not report this number; 4 is the minimum of the APIs under WebGPU.
const SUB_PIXEL_BITS: u8 = 4;
/// The largest size of a texel in the sum over a pass's colour attachments, in bytes
/// (maxColorAttachmentBytesPerSample).
const MOST_TEXEL_BYTES: u32 = 16;
/// The largest viewport coordinate in a scene, including the far edge.
const VIEWPORT_REACH: u32 = 8192;

/// The features that every WebGPU device has: interpolation (WGSL, Interpolation), first instances of direct
/// draws, and pipelines without a fragment shader in passes without colour.
const EVERYWHERE: [Feature; 4] = [
    Feature::CentroidInterpolation,
    Feature::FirstInstance,
    Feature::FractionalViewport,
    Feature::FragmentShaderAbsent,
];

/// The features that every device has, except in compatibility mode: linear interpolation and the flat value
/// of the first vertex (GPURenderPipelineDescriptor, validating Compatibility Mode shader binding), and
/// sample masks of shaders.
const BEYOND_COMPATIBILITY: [Feature; 4] = [
    Feature::LinearInterpolation,
    Feature::FirstProvokingVertex,
    Feature::SampleMaskInput,
    Feature::SampleMaskOutput,
];

/// The guarantees of WebGPU about a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Everything: the device has `core-features-and-limits`.
    Core,
    /// The feature level `compatibility`.
    Compatibility,
    /// Nothing: the API reports that the device has less than WebGPU.
    Less,
}

/// The capabilities of a device.
#[derive(Clone, Debug)]
pub struct Offer {
    /// The formats whose textures can be uploaded, fetched from and read, with their other uses.
    pub formats: BTreeMap<TextureFormat, Uses>,
    /// Abilities that the limits do not include.
    pub abilities: Abilities,
    /// Features beyond the ones that every device has.
    pub features: BTreeSet<Feature>,
    /// True if the device executes indirect draws.
    pub indirect: bool,
    /// True if the first instance of an indirect draw can be other than 0 (feature `indirect-first-instance`).
    pub indirect_first_instance: bool,
    /// The guarantees of WebGPU about the device.
    pub level: Level,
    /// GPUSupportedLimits.
    pub limits: DeviceLimits,
}

/// The uses of a format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uses {
    /// True if attachments can be drawn to.
    pub drawn: bool,
    /// True if attachments can be blended into.
    pub blended: bool,
    /// True if attachments can be multisampled, and, if they are colours, resolved.
    pub multisampled: bool,
}

/// Limits of a device (GPUSupportedLimits).
#[derive(Clone, Copy, Debug)]
pub struct DeviceLimits {
    /// maxTextureDimension2D.
    pub texture_2d: u32,
    /// maxTextureDimension3D.
    pub texture_3d: u32,
    /// maxColorAttachments.
    pub color_attachments: u32,
    /// maxColorAttachmentBytesPerSample.
    pub color_bytes_per_sample: u32,
    /// minUniformBufferOffsetAlignment.
    pub uniform_alignment: u32,
    /// minStorageBufferOffsetAlignment.
    pub storage_alignment: u32,
}

impl Device {
    /// Returns the facts about a device from what it supports.
    pub fn new(offer: Offer) -> Self {
        let DeviceLimits {
            texture_2d,
            texture_3d,
            uniform_alignment,
            storage_alignment,
            ..
        } = offer.limits;
        Self {
            abilities: offer.abilities,
            max_texture_2d: texture_2d,
            max_texture_3d: texture_3d,
            uniform_alignment,
            storage_alignment,
            indirect_first_instance: offer.indirect_first_instance,
            limits: limits(offer),
        }
    }
}

fn limits(offer: Offer) -> Limits {
    let max_size = offer.limits.texture_2d;
    let support = |(format, uses): (&TextureFormat, &Uses)| {
        Some((*format, support(*format, *uses, offer.abilities)?))
    };
    let formats = offer.formats.iter().filter_map(support).collect();
    let exempt = exempt(&offer);
    let mut features = offer.features;
    features.extend(EVERYWHERE);
    if offer.level != Level::Compatibility {
        features.extend(BEYOND_COMPATIBILITY);
    }
    // WebGPU limits a viewport to twice the largest texture size (setViewport).
    if max_size > VIEWPORT_REACH / 2 {
        features.insert(Feature::ViewportOutside);
    }
    let most_of_bytes = offer.limits.color_bytes_per_sample / MOST_TEXEL_BYTES;
    Limits {
        api: Api::WebGpu,
        version: ApiVersion::UNKNOWN,
        properties: BTreeSet::new(),
        exempt,
        sub_pixel_bits: SUB_PIXEL_BITS,
        viewport_bits: None,
        texel_bits: None,
        max_size,
        max_storage: None,
        max_color_attachments: offer.limits.color_attachments.min(most_of_bytes),
        formats,
        paths: paths(offer.indirect, offer.abilities, &features),
        features,
        // WebGPU requires the standard sample positions of all adapters (Rasterization).
        sample_positions: BTreeMap::from([1, SAMPLES].map(|n| (n, standard_sample_positions(n)))),
    }
}

/// Returns the support of a format. Depth and stencil are useful only as attachments.
fn support(format: TextureFormat, uses: Uses, abilities: Abilities) -> Option<FormatSupport> {
    if !format.is_color() && !uses.drawn {
        return None;
    }
    // WebGPU does not resolve integers (26.1.1).
    let multisampled =
        uses.multisampled && !format.is_integer() && samples_are_exact(format, abilities);
    let samples = match (uses.drawn, multisampled) {
        (false, _) => Vec::new(),
        (true, false) => vec![1],
        (true, true) => vec![1, SAMPLES],
    };
    Some(FormatSupport {
        samples,
        blendable: uses.drawn && uses.blended && !format.is_integer(),
        // The adapter does not report which encoding it uses.
        depth: format.depth_encodings().to_vec(),
        read: read_path(format, abilities),
    })
}

/// Returns what a device can lack without violating WebGPU: requirements that this crate does not use, and
/// requirements that the device's level does not guarantee.
fn exempt(offer: &Offer) -> BTreeSet<Requirement> {
    // Only four targets of the shortest texels fit into the number of bytes that WebGPU guarantees.
    let mut exempt = BTreeSet::from([Requirement::ColorAttachments(4)]);
    let inexact = |f: &TextureFormat| f.is_integer() || !samples_are_exact(*f, offer.abilities);
    let inexact = TextureFormat::ALL.into_iter().filter(inexact);
    exempt.extend(inexact.map(|format| Requirement::Samples(format, SAMPLES)));
    match offer.level {
        Level::Core => {}
        Level::Compatibility => exempt.extend([
            Requirement::Size(8192),
            Requirement::Samples(TextureFormat::Rgba16Float, SAMPLES),
            Requirement::Feature(Feature::DepthBiasClamp),
            Requirement::Feature(Feature::IndependentBlend),
            Requirement::Feature(Feature::SampleInterpolation),
            Requirement::Feature(Feature::SampleShading),
        ]),
        Level::Less => {
            exempt.insert(Requirement::Size(8192));
            exempt.extend(Feature::ALL.map(Requirement::Feature));
            exempt.extend(TextureFormat::ALL.into_iter().flat_map(|format| {
                [
                    Requirement::Format(format),
                    Requirement::Drawing(format),
                    Requirement::Blending(format),
                    Requirement::Samples(format, SAMPLES),
                ]
            }));
        }
    }
    exempt
}

/// Returns the formats of a device with these features, by their names in WebGPU (26.1, Texture Format
/// Capabilities). The level must not be [`Level::Less`].
pub fn standard_formats(level: Level, has: impl Fn(&str) -> bool) -> BTreeMap<TextureFormat, Uses> {
    let every_use = Uses {
        drawn: true,
        blended: true,
        multisampled: true,
    };
    let unblended = Uses {
        blended: false,
        ..every_use
    };
    let when = |feature: &str| {
        if has(feature) {
            every_use
        } else {
            Uses::default()
        }
    };
    let uses = |format: TextureFormat| {
        Some(match format {
            TextureFormat::R8Unorm
            | TextureFormat::Rg8Unorm
            | TextureFormat::Rgba8Unorm
            | TextureFormat::Rgba8UnormSrgb
            | TextureFormat::Bgra8Unorm
            | TextureFormat::R16Float
            | TextureFormat::Rg16Float
            | TextureFormat::Rgb10a2Unorm => every_use,
            // OpenGL ES has no such format.
            TextureFormat::Bgra8UnormSrgb => {
                return (level != Level::Compatibility).then_some(every_use);
            }
            TextureFormat::Rgba16Float => Uses {
                multisampled: level == Level::Core,
                ..every_use
            },
            TextureFormat::R8Snorm | TextureFormat::Rg8Snorm | TextureFormat::Rgba8Snorm => {
                when("texture-formats-tier1")
            }
            TextureFormat::R16Unorm | TextureFormat::Rg16Unorm | TextureFormat::Rgba16Unorm => {
                return has("texture-formats-tier1").then_some(every_use);
            }
            TextureFormat::Rg11b10Ufloat => when("rg11b10ufloat-renderable"),
            TextureFormat::R32Float | TextureFormat::Rg32Float | TextureFormat::Rgba32Float => {
                Uses {
                    drawn: true,
                    blended: has("float32-blendable"),
                    multisampled: false,
                }
            }
            TextureFormat::Depth32FloatStencil8 if !has("depth32float-stencil8") => return None,
            TextureFormat::R8Uint
            | TextureFormat::Rgba8Uint
            | TextureFormat::Rgb10a2Uint
            | TextureFormat::R16Uint
            | TextureFormat::Rg16Uint
            | TextureFormat::Rgba16Uint
            | TextureFormat::Depth16Unorm
            | TextureFormat::Depth24Plus
            | TextureFormat::Depth24PlusStencil8
            | TextureFormat::Depth32Float
            | TextureFormat::Depth32FloatStencil8
            | TextureFormat::Stencil8 => unblended,
            TextureFormat::B5g6r5Unorm | TextureFormat::Bgr5a1Unorm | TextureFormat::Bgra4Unorm => {
                return None;
            }
        })
    };
    let formats = TextureFormat::ALL.into_iter();
    formats.filter_map(|f| Some((f, uses(f)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_widen_the_uses_of_formats() {
        let plain = standard_formats(Level::Core, |_| false);
        let wide = standard_formats(Level::Core, |_| true);
        assert_eq!(plain[&TextureFormat::Rgba8Snorm], Uses::default());
        assert_eq!(plain[&TextureFormat::Rg11b10Ufloat], Uses::default());
        assert!(!plain[&TextureFormat::Rgba32Float].blended);
        assert!(!plain.contains_key(&TextureFormat::Depth32FloatStencil8));
        assert!(wide[&TextureFormat::Rgba8Snorm].drawn);
        assert!(wide[&TextureFormat::Rg11b10Ufloat].multisampled);
        assert!(wide[&TextureFormat::Rgba32Float].blended);
        assert!(wide.contains_key(&TextureFormat::Depth32FloatStencil8));
        assert!(!wide.contains_key(&TextureFormat::B5g6r5Unorm));
    }

    /// Returns the limits of a device with these properties.
    fn limits(level: Level, texture_2d: u32, color_bytes_per_sample: u32) -> Limits {
        let core = level == Level::Core;
        let offer = Offer {
            formats: standard_formats(level, |_| false),
            abilities: Abilities {
                copies: true,
                casts: core,
                layers: core,
            },
            features: BTreeSet::new(),
            indirect: true,
            indirect_first_instance: false,
            level,
            limits: DeviceLimits {
                texture_2d,
                texture_3d: 2048,
                color_attachments: 8,
                color_bytes_per_sample,
                uniform_alignment: 256,
                storage_alignment: 256,
            },
        };
        Device::new(offer).limits
    }

    #[test]
    fn limits_follow_the_offer() {
        let small = limits(Level::Core, 4096, 32);
        assert_eq!(small.max_color_attachments, 2);
        assert!(!small.features.contains(&Feature::ViewportOutside));
        assert!(small.features.contains(&Feature::FragmentShaderAbsent));
        // WebGPU resolves no integers, and fetches do not determine 16-bit codes.
        assert_eq!(small.formats[&TextureFormat::Rgba8Uint].samples, [1]);
        assert_eq!(small.formats[&TextureFormat::Depth16Unorm].samples, [1]);
        assert_eq!(small.formats[&TextureFormat::Depth32Float].samples, [1, 4]);
        let large = limits(Level::Core, 8192, 128);
        assert_eq!(large.max_color_attachments, 8);
        assert!(large.features.contains(&Feature::ViewportOutside));
    }

    #[test]
    fn compatibility_mode_lacks_only_what_its_specification_names() {
        let core = limits(Level::Core, 4096, 32);
        let compatible = limits(Level::Compatibility, 4096, 32);
        let lacked: Vec<_> = core.features.difference(&compatible.features).collect();
        let mut named: Vec<_> = BEYOND_COMPATIBILITY.iter().collect();
        named.sort();
        assert_eq!(lacked, named);
        let samples = |limits: &Limits, format| limits.formats[&format].samples.clone();
        for format in [TextureFormat::Rgba16Float, TextureFormat::Rgba8UnormSrgb] {
            assert_eq!(samples(&core, format), [1, 4]);
            assert_eq!(samples(&compatible, format), [1]);
            let four = Requirement::Samples(format, SAMPLES);
            assert!(compatible.exempt.contains(&four) && !core.exempt.contains(&four));
        }
        let shading = Requirement::Feature(Feature::SampleShading);
        assert!(compatible.exempt.contains(&shading) && !core.exempt.contains(&shading));
        let drawing = Requirement::Drawing(TextureFormat::Rgba16Float);
        assert!(!compatible.exempt.contains(&drawing));
    }
}
