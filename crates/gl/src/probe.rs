//! The formats and features that a context reports.
//!
//! Probing draws, uploads and reads nothing. A format is supported if a framebuffer with it is complete and
//! the queries of its attachment report exactly the channels of the format's name, since a driver can
//! substitute another internal format. Whether texels survive is for the cases to test. If GL has several
//! ways to read a format, [`read_plan`] takes one that the specification makes exact.

use crate::context::Context;
use crate::features;
use crate::format::gl_format;
use crate::program::translates;
use crate::support::{ReadBackPath, ShaderStencil, Support};
use crate::surface::{Surface, SurfaceKind};
use etalon_frame::{ChannelEncoding, Feature, FormatSupport, ReadPath, Requirement, TextureFormat};
use etalon_scene::{EarlyTests, Shader};
use glow::HasContext;
use std::collections::{BTreeMap, BTreeSet};

const SAMPLE_COUNTS: [u32; 4] = [2, 4, 8, 16];
/// The least value of `GL_MAX_SAMPLES`.
const REQUIRED_SAMPLES: u32 = 4;
/// The width and height of probed surfaces.
const SIZE: [u32; 2] = [16, 16];

/// Sample positions by sample count, in 1/256 texel from the top left corner.
type Positions = BTreeMap<u32, Vec<[u16; 2]>>;

/// The results of probing.
#[derive(Default)]
pub(crate) struct Probed {
    pub(crate) formats: BTreeMap<TextureFormat, Support>,
    pub(crate) positions: Positions,
    pub(crate) features: BTreeSet<Feature>,
    /// Requirements that the driver might meet, but this backend does not use.
    pub(crate) exempt: BTreeSet<Requirement>,
}

/// Probes every format and feature.
pub(crate) fn probe(context: &Context) -> Probed {
    let mut probed = Probed::default();
    for format in TextureFormat::ALL {
        let found = with_surface(context, format, 1, |surface| {
            Some((surface.is_complete(), examine(context, format, surface)))
        });
        // A format that the driver refuses causes an error.
        let accepted = context.check("probing formats").is_ok();
        let (complete, support) = match found {
            Some(found) if accepted => found,
            _ => (false, None),
        };
        let Some(mut support) = support else {
            if complete || gl_format(format).is_none() {
                let both = [Requirement::Format(format), Requirement::Drawing(format)];
                probed.exempt.extend(both);
            }
            continue;
        };
        support.fetched_exactly = fetch_is_exact(&support) && stencil_is_fetched(context, format);
        let more = sample_counts(context, format, &support, &mut probed.positions);
        support.limits.samples.extend(more);
        let offered = &support.limits.samples;
        if context.caps.max_samples >= REQUIRED_SAMPLES && !offered.contains(&REQUIRED_SAMPLES) {
            // Renderbuffers have as many, but their samples cannot be read.
            let samples = Requirement::Samples(format, REQUIRED_SAMPLES);
            probed.exempt.insert(samples);
        }
        probed.formats.insert(format, support);
    }
    for feature in features::features(context) {
        if can_be_written(context, feature) {
            probed.features.insert(feature);
        } else {
            probed.exempt.insert(Requirement::Feature(feature));
        }
    }
    probed
}

/// Returns true if naga can write the shaders of a feature in the context's GLSL. If the driver then refuses
/// to compile them, the feature's cases fail.
fn can_be_written(context: &Context, feature: Feature) -> bool {
    let shader = Shader::FlatColorDepth;
    let needed: &[_] = match feature {
        Feature::CentroidInterpolation => &[(Shader::Centroid, EarlyTests::Implicit)],
        Feature::ClipDistances => &[
            (Shader::ClipFlat, EarlyTests::Implicit),
            (Shader::ClipUniform, EarlyTests::Implicit),
        ],
        Feature::CullDistances => &[(Shader::CullFlat, EarlyTests::Implicit)],
        Feature::ConservativeDepth => &[
            (shader, EarlyTests::GreaterEqual),
            (shader, EarlyTests::LessEqual),
            (shader, EarlyTests::Unchanged),
        ],
        Feature::ForcedEarlyTests => &[(Shader::FlatColor, EarlyTests::Forced)],
        Feature::ForcedEarlyTestsWithDepth => &[(shader, EarlyTests::Forced)],
        Feature::FragmentStorage => &[
            (Shader::ListAppend, EarlyTests::Implicit),
            (Shader::ListCompose, EarlyTests::Implicit),
            (Shader::NearestDepths, EarlyTests::Implicit),
            (Shader::NearestColors, EarlyTests::Implicit),
            (Shader::NearestCompose, EarlyTests::Implicit),
        ],
        Feature::LinearInterpolation => &[(Shader::SteppedLinear, EarlyTests::Implicit)],
        Feature::SampleInterpolation => &[(Shader::SteppedPerspectiveSample, EarlyTests::Implicit)],
        Feature::StorageCounters => &[(Shader::CountedColor, EarlyTests::Implicit)],
        _ => &[],
    };
    needed
        .iter()
        .all(|(shader, tests)| translates(context, *shader, *tests))
}

/// Calls `body` with a surface of a format.
fn with_surface<T>(
    context: &Context,
    format: TextureFormat,
    samples: u32,
    body: impl FnOnce(&Surface) -> Option<T>,
) -> Option<T> {
    gl_format(format)?;
    let kind = SurfaceKind::plain(format, samples);
    let surface = Surface::new(context, kind, SIZE).ok()?;
    let result = body(&surface);
    surface.delete(context);
    result
}

fn examine(context: &Context, format: TextureFormat, surface: &Surface) -> Option<Support> {
    let done = |samples: &[u32], blendable, depth: &[ChannelEncoding], read| {
        let path = match read {
            ReadBackPath::Shader { depth: true, .. } => ReadPath::Shader,
            _ => ReadPath::Copy,
        };
        Some(Support {
            limits: FormatSupport {
                samples: samples.to_vec(),
                blendable,
                depth: depth.to_vec(),
                read: path,
            },
            read,
            fetched_exactly: false,
        })
    };
    if format == TextureFormat::Rgba32Float && !surface.is_complete() {
        // Every version has this format as a texture, and thus as an exact source of values, even if it is
        // not drawable.
        return done(&[], false, &[], ReadBackPath::Fetched);
    }
    // Without the extension, ES has no rules for drawing to this format.
    if format.is_snorm() && !context.caps.snorm_attachments {
        return None;
    }
    if !surface.is_complete() || !has_promised_channels(context, surface, format) {
        return None;
    }
    let encoding = if format.has_depth() {
        Some(match reported_depth_encoding(context, surface)? {
            // A depth for which the driver reports 24 bits can be a float (radeonsi).
            ChannelEncoding::Unorm(24) if !context.caps.es && holds_floats(context, surface) => {
                ChannelEncoding::Float32
            }
            reported => reported,
        })
    } else {
        None
    };
    let read = read_plan(context, format, encoding)?;
    let blendable = match format.color_channels().first() {
        Some(ChannelEncoding::Float32) => context.caps.float_blend,
        _ => format.is_color() && !format.is_integer(),
    };
    // No function of ES reads a depth, so either encoding is possible there.
    let encodings = match encoding {
        Some(ChannelEncoding::Unorm(24)) if context.caps.es => format.depth_encodings(),
        _ => encoding.as_slice(),
    };
    done(&[1], blendable, encodings, read)
}

/// Returns how to read single-sample surfaces of a format; `None` if the context has no exact way.
///
/// OpenGL converts to any format and type, so the layout of uploads returns each code (4.6, 18.2.8, with read
/// color clamping off). Before 4.2, types other than float clamp signed values to 0..=1 (3.3, 4.3.1, Final
/// Conversion), so signed formats are read as floats, in which both codes of -1 are one value.
///
/// ES returns four bytes for normalized formats, the packed type for `rgb10a2unorm`, and floats for floats
/// (ES 3.2, 16.1.2). None of its types returns negative values (16.1.5), depth or stencil, so a shader
/// fetches these.
fn read_plan(
    context: &Context,
    format: TextureFormat,
    depth: Option<ChannelEncoding>,
) -> Option<ReadBackPath> {
    let caps = &context.caps;
    if let Some(encoding) = depth {
        return if caps.es {
            by_shader(context, format)
        } else {
            Some(copy_plan(format, encoding))
        };
    }
    if format == TextureFormat::Stencil8 {
        let shader = ReadBackPath::Shader {
            depth: false,
            stencil: ShaderStencil::Shader,
        };
        return if caps.es {
            (caps.stencil_textures && caps.stencil_texturing).then_some(shader)
        } else {
            Some(ReadBackPath::Stencil)
        };
    }
    let first = format.color_channels().first()?;
    Some(match first {
        ChannelEncoding::Uint(_) => ReadBackPath::Integers,
        ChannelEncoding::Snorm(_) if caps.es => ReadBackPath::Fetched,
        ChannelEncoding::Snorm(_) if caps.version < (4, 2) => ReadBackPath::Floats,
        _ if !caps.es || format == TextureFormat::Rgb10a2Unorm => ReadBackPath::Packed,
        ChannelEncoding::Unorm(16) => ReadBackPath::Fetched,
        ChannelEncoding::Unorm(_) | ChannelEncoding::Srgb8 => ReadBackPath::Bytes,
        _ => ReadBackPath::Floats,
    })
}

fn by_shader(context: &Context, format: TextureFormat) -> Option<ReadBackPath> {
    let stencil = match (format.has_stencil(), context.caps.es) {
        (false, _) => ShaderStencil::None,
        (true, false) => ShaderStencil::Copy,
        (true, true) if context.caps.stencil_texturing => ShaderStencil::Shader,
        (true, true) => return None,
    };
    Some(ReadBackPath::Shader {
        depth: true,
        stencil,
    })
}

fn copy_plan(format: TextureFormat, encoding: ChannelEncoding) -> ReadBackPath {
    match (encoding, format.has_stencil()) {
        (ChannelEncoding::Unorm(16), _) => ReadBackPath::Depth16,
        (ChannelEncoding::Float32, false) => ReadBackPath::DepthFloat,
        (ChannelEncoding::Float32, true) => ReadBackPath::DepthFloatStencil8,
        (_, false) => ReadBackPath::Depth24,
        (_, true) => ReadBackPath::Depth24Stencil8,
    }
}

/// Returns true if a complete surface has the channels that its format promises.
fn has_promised_channels(context: &Context, surface: &Surface, format: TextureFormat) -> bool {
    if format.has_depth() {
        // A driver can store more bits than requested; the format then differs from its name.
        return reported_depth_encoding(context, surface)
            .is_some_and(|encoding| format.depth_encodings().contains(&encoding));
    }
    if format.has_stencil() {
        let bits = query(
            context,
            surface,
            glow::STENCIL_ATTACHMENT,
            glow::FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE,
        );
        return bits == 8;
    }
    let of_color = |name| query(context, surface, glow::COLOR_ATTACHMENT0, name);
    let sizes = [
        glow::FRAMEBUFFER_ATTACHMENT_RED_SIZE,
        glow::FRAMEBUFFER_ATTACHMENT_GREEN_SIZE,
        glow::FRAMEBUFFER_ATTACHMENT_BLUE_SIZE,
        glow::FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE,
    ];
    let channels = format.color_channels();
    let same = (0..).zip(sizes).all(|(i, name)| {
        let expected = channels.get(i).map_or(0, |e| e.bits());
        u32::try_from(of_color(name)) == Ok(expected)
    });
    let expected = match channels.first() {
        Some(ChannelEncoding::Unorm(_) | ChannelEncoding::Srgb8) => glow::UNSIGNED_NORMALIZED,
        Some(ChannelEncoding::Snorm(_)) => glow::SIGNED_NORMALIZED,
        Some(ChannelEncoding::Uint(_)) => glow::UNSIGNED_INT,
        _ => glow::FLOAT,
    };
    let kind = of_color(glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE);
    let encoding = of_color(glow::FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING);
    let expected_encoding = if format == TextureFormat::Rgba8UnormSrgb {
        glow::SRGB
    } else {
        glow::LINEAR
    };
    same && u32::try_from(kind) == Ok(expected) && u32::try_from(encoding) == Ok(expected_encoding)
}

/// Returns a property of an attachment of a complete surface.
fn query(context: &Context, surface: &Surface, attachment: u32, name: u32) -> i32 {
    let gl = &context.gl;
    // SAFETY: the context is current, the framebuffer lives and has the attachment.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
        gl.get_framebuffer_attachment_parameter_i32(glow::FRAMEBUFFER, attachment, name)
    }
}

/// Returns the depth encoding that the driver reports, if it is a known one.
fn reported_depth_encoding(context: &Context, surface: &Surface) -> Option<ChannelEncoding> {
    let of_depth = |name| query(context, surface, glow::DEPTH_ATTACHMENT, name);
    let bits = of_depth(glow::FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE);
    let kind = of_depth(glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE);
    match (u32::try_from(kind).ok()?, bits) {
        (glow::UNSIGNED_NORMALIZED, bits) => Some(ChannelEncoding::Unorm(u8::try_from(bits).ok()?)),
        (glow::FLOAT, 32) => Some(ChannelEncoding::Float32),
        _ => None,
    }
}

/// Returns true if a depth of 2^-30, which 24 bits cannot tell from 0, is read back from a single-sample surface as
/// another number.
fn holds_floats(context: &Context, surface: &Surface) -> bool {
    let gl = &context.gl;
    let mut depth = [0_u8; 4];
    // SAFETY: the context is current, the surface lives and has a depth attachment, and the pixel fits into the array.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
        gl.disable(glow::SCISSOR_TEST);
        gl.depth_mask(true);
        gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[2_f32.powi(-30)]);
        let pixel = glow::PixelPackData::Slice(Some(&mut depth));
        gl.read_pixels(0, 0, 1, 1, glow::DEPTH_COMPONENT, glow::FLOAT, pixel);
    }
    let depth = f32::from_ne_bytes(depth);
    depth > 0.0 && depth < 2_f32.powi(-25)
}

/// Returns the sample counts above 1 of complete attachments that a shader can read exactly.
fn sample_counts(
    context: &Context,
    format: TextureFormat,
    support: &Support,
    positions: &mut Positions,
) -> Vec<u32> {
    let drawn = !support.limits.samples.is_empty();
    if !context.caps.multisample_textures || !drawn || !support.fetched_exactly {
        return Vec::new();
    }
    let mut counts = Vec::new();
    for count in SAMPLE_COUNTS {
        let found = with_surface(context, format, count, |surface| {
            let good = surface.is_complete() && has_promised_channels(context, surface, format);
            good.then(|| sample_positions(context, surface, count))?
        });
        let clean = context.check("probing samples").is_ok();
        if let (Some(found), true) = (found, clean) {
            // Fixed sample locations are the same for every format (OpenGL 4.6, 8.8).
            positions.entry(count).or_insert(found);
            counts.push(count);
        }
    }
    counts
}

/// Returns true if the format has no stencil, or a shader can fetch it.
fn stencil_is_fetched(context: &Context, format: TextureFormat) -> bool {
    let caps = &context.caps;
    !format.has_stencil()
        || caps.stencil_texturing && (caps.stencil_textures || format != TextureFormat::Stencil8)
}

/// Returns true if a shader's fetch determines the code that a copy would return. Floating-point operations
/// are accurate to 1 part in 10^5 (OpenGL 4.6, 2.3.4), which is less than the distance between two codes of a
/// colour, sRGB included. Rounding also distinguishes depth codes of up to 16 bits, as in Vulkan, but not of
/// 24 bits.
fn fetch_is_exact(support: &Support) -> bool {
    let is_long = |e: &ChannelEncoding| matches!(e, ChannelEncoding::Unorm(17..));
    support.limits.read == ReadPath::Shader || !support.limits.depth.iter().any(is_long)
}

/// Returns the sample positions of a surface, or `None` if the surface has another sample count.
fn sample_positions(context: &Context, surface: &Surface, count: u32) -> Option<Vec<[u16; 2]>> {
    let get = context.entry_points.get_multisample?;
    let gl = &context.gl;
    // SAFETY: the context is current, the surface lives, and the array has room for both values. The texture
    // is bound to its target.
    unsafe {
        gl.bind_texture(glow::TEXTURE_2D_MULTISAMPLE, surface.texture());
        let target = glow::TEXTURE_2D_MULTISAMPLE;
        let stored = gl.get_tex_level_parameter_i32(target, 0, glow::TEXTURE_SAMPLES);
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
        let drawn = gl.get_parameter_i32(glow::SAMPLES);
        // A driver can give 4 samples if 2 are requested.
        if [stored, drawn].map(u32::try_from) != [Ok(count); 2] {
            return None;
        }
        let position = |i| {
            let mut position = [0.0_f32; 2];
            get(glow::SAMPLE_POSITION, i, position.as_mut_ptr());
            // Rows count upwards in window coordinates, and row 0 is the top row here, so nothing is
            // mirrored.
            position.map(|v| (v * 256.0).round() as u16)
        };
        Some((0..count).map(position).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_24_bit_depth_is_fetched_exactly_only_if_a_shader_reads_it_back() {
        let support = |read, depth| Support {
            limits: FormatSupport {
                samples: vec![1],
                blendable: false,
                depth,
                read,
            },
            read: ReadBackPath::Depth24,
            fetched_exactly: false,
        };
        let long = vec![ChannelEncoding::Unorm(24)];
        assert!(!fetch_is_exact(&support(ReadPath::Copy, long.clone())));
        assert!(fetch_is_exact(&support(ReadPath::Shader, long)));
        let short = vec![ChannelEncoding::Unorm(16)];
        assert!(fetch_is_exact(&support(ReadPath::Copy, short)));
        assert!(fetch_is_exact(&support(ReadPath::Copy, Vec::new())));
    }
}
