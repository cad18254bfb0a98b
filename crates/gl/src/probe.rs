//! Probing of the formats that a driver supports.
//!
//! A driver may use another internal format than the requested one. A format is offered only if the
//! framebuffer reports exactly the channels of the format's name, and all codes survive an upload
//! and a read.

use crate::context::Context;
use crate::format::gl_format;
use crate::read::{self, Reading};
use crate::support::{ReadPlan, ShaderStencil, Support};
use crate::surface::{Surface, SurfaceKind, upload};
use crate::{codes, features};
use etalon_frame::{ChannelEncoding, Feature, FormatSupport, ReadPath, TextureFormat};
use etalon_scene::{EarlyTests, Shader};
use glow::HasContext;
use std::collections::{BTreeMap, BTreeSet};

const SAMPLE_COUNTS: [u32; 4] = [2, 4, 8, 16];
/// Enough texels for every code of a 16-bit channel spread over four channels.
const SIZE: [u32; 2] = [128, 128];

/// Sample positions by sample count, in 1/256 texel from the top left corner.
type Positions = BTreeMap<u32, Vec<[u16; 2]>>;

/// The results of probing.
#[derive(Default)]
pub(crate) struct Probed {
    pub(crate) formats: BTreeMap<TextureFormat, Support>,
    pub(crate) positions: Positions,
    pub(crate) features: BTreeSet<Feature>,
}

/// Probes every format.
pub(crate) fn probe(reading: &mut Reading<'_>) -> Probed {
    let mut probed = Probed::default();
    let context = reading.context;
    for format in TextureFormat::ALL {
        let Some(mut support) = with_surface(context, format, 1, |surface| {
            examine(reading, format, surface)
        }) else {
            // A refused format may leave errors behind.
            context.check("probing formats").ok();
            continue;
        };
        if context.check("probing formats").is_ok() {
            let more = sample_counts(reading, format, &support, &mut probed.positions);
            support.limits.samples.extend(more);
            probed.formats.insert(format, support);
        }
    }
    probed.features = features::features(context)
        .into_iter()
        .filter(|feature| compiles(reading, *feature))
        .collect();
    probed
}

/// Returns true if naga can write the shaders of a feature and the driver compiles them.
fn compiles(reading: &mut Reading<'_>, feature: Feature) -> bool {
    let shader = Shader::FlatColorDepth;
    let tried: &[_] = match feature {
        Feature::CentroidInterpolation => &[(Shader::Centroid, EarlyTests::Implicit)],
        Feature::ConservativeDepth => &[
            (shader, EarlyTests::GreaterEqual),
            (shader, EarlyTests::LessEqual),
            (shader, EarlyTests::Unchanged),
        ],
        Feature::ForcedEarlyTests => &[(shader, EarlyTests::Forced)],
        Feature::StorageCounters => &[(Shader::CountedColor, EarlyTests::Implicit)],
        _ => &[],
    };
    let context = reading.context;
    let mut takes = |&(shader, tests)| reading.programs.shader(context, shader, tests).is_ok();
    tried.iter().all(&mut takes)
}

/// Calls `body` with a surface of a format.
fn with_surface<T>(
    context: &Context,
    format: TextureFormat,
    samples: u32,
    body: impl FnOnce(&Surface) -> Option<T>,
) -> Option<T> {
    gl_format(format)?;
    let kind = SurfaceKind::Attachment(format, samples);
    let surface = Surface::new(context, kind, SIZE).ok()?;
    let result = body(&surface);
    surface.delete(context);
    result
}

fn examine(reading: &mut Reading<'_>, format: TextureFormat, surface: &Surface) -> Option<Support> {
    let context = reading.context;
    let done = |samples: &[u32], blendable, depth: &[ChannelEncoding], read| {
        let path = match read {
            ReadPlan::Shader { depth: true, .. } => ReadPath::Shader,
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
        })
    };
    if format.is_color() && !surface.is_complete() {
        // Useful as an exact source of values even if it is not drawable.
        let useful = format == TextureFormat::Rgba32Float
            && color_round_trips(reading, surface, format, ReadPlan::Fetched);
        return if useful {
            done(&[], false, &[], ReadPlan::Fetched)
        } else {
            None
        };
    }
    if !surface.is_complete() || !has_promised_channels(context, surface, format) {
        return None;
    }
    if format.is_color() {
        // Mesa's ES reads negative values of `rgba8snorm` as 0, and a shader sees one value for
        // both codes of -1, so nothing reads that format exactly there.
        let plans: &[ReadPlan] = if format.is_integer() {
            &[ReadPlan::Integers]
        } else {
            &[ReadPlan::Packed, ReadPlan::Bytes, ReadPlan::Floats]
        };
        let read = plans
            .iter()
            .copied()
            .find(|plan| color_round_trips(reading, surface, format, *plan))?;
        let blendable = match format {
            TextureFormat::Rgba32Float => context.caps.float_blend,
            _ => !format.is_integer(),
        };
        return done(&[1], blendable, &[], read);
    }
    if format == TextureFormat::Stencil8 {
        // In ES only a shader can read stencil.
        if !context.caps.es {
            return done(&[1], false, &[], ReadPlan::Stencil);
        }
        let shader = ReadPlan::Shader {
            depth: false,
            stencil: ShaderStencil::Shader,
        };
        let can = context.caps.stencil_textures && context.caps.stencil_texturing;
        return if can {
            done(&[1], false, &[], shader)
        } else {
            None
        };
    }
    let encoding = depth_encoding(context, surface)?;
    let read = if context.caps.es {
        by_shader(context, format)?
    } else {
        let plan = copy_plan(format, encoding);
        if depth_round_trips(context, surface, format, plan) {
            plan
        } else {
            by_shader(context, format)?
        }
    };
    done(&[1], false, &[encoding], read)
}

fn by_shader(context: &Context, format: TextureFormat) -> Option<ReadPlan> {
    let stencil = match (format.has_stencil(), context.caps.es) {
        (false, _) => ShaderStencil::None,
        (true, false) => ShaderStencil::Copy,
        (true, true) if context.caps.stencil_texturing => ShaderStencil::Shader,
        (true, true) => return None,
    };
    Some(ReadPlan::Shader {
        depth: true,
        stencil,
    })
}

fn copy_plan(format: TextureFormat, encoding: ChannelEncoding) -> ReadPlan {
    match (encoding, format.has_stencil()) {
        (ChannelEncoding::Unorm(16), _) => ReadPlan::Depth16,
        (ChannelEncoding::Float32, false) => ReadPlan::DepthFloat,
        (ChannelEncoding::Float32, true) => ReadPlan::DepthFloatStencil8,
        (_, false) => ReadPlan::Depth24,
        (_, true) => ReadPlan::Depth24Stencil8,
    }
}

/// Returns true if a complete surface has the channels that its format promises.
fn has_promised_channels(context: &Context, surface: &Surface, format: TextureFormat) -> bool {
    if format.has_depth() {
        // A driver may store more bits than requested; the format is then not what its name says.
        return depth_encoding(context, surface)
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
        let expected = channels.get(i).map_or(0, |e| codes::bits(*e));
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

/// Returns the depth encoding that the driver reports.
fn depth_encoding(context: &Context, surface: &Surface) -> Option<ChannelEncoding> {
    let of_depth = |name| query(context, surface, glow::DEPTH_ATTACHMENT, name);
    let bits = of_depth(glow::FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE);
    let kind = of_depth(glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE);
    match (u32::try_from(kind).ok()?, bits) {
        (glow::UNSIGNED_NORMALIZED, bits) => Some(ChannelEncoding::Unorm(u8::try_from(bits).ok()?)),
        (glow::FLOAT, 32) => Some(ChannelEncoding::Float32),
        _ => None,
    }
}

/// Returns true if all codes are read back unchanged: every code of channels of up to 16 bits, each
/// channel in another order, and a spread of 32-bit floats. NaNs are left out, since their payload
/// may change.
fn color_round_trips(
    reading: &mut Reading<'_>,
    surface: &Surface,
    format: TextureFormat,
    plan: ReadPlan,
) -> bool {
    let channels = format.color_channels();
    let mut all = Vec::new();
    for texel in 0..SIZE[0] * SIZE[1] {
        for (c, encoding) in (0..).zip(channels) {
            // Odd factors reach every code; four channels share those of a 16-bit float.
            let code = match codes::bits(*encoding) {
                32 => (texel * 4 + c).wrapping_mul(0x9e37_79b1),
                bits => (texel * 4 + c).wrapping_mul(2 * c + 1) >> (2 * u32::from(bits < 16)),
            };
            let code = code & (u32::MAX >> (32 - codes::bits(*encoding)));
            all.push(if encoding.is_nan(code) { c } else { code });
        }
    }
    crate::state::reset(reading.context);
    upload(reading.context, format, surface, &codes::pack(format, &all));
    let read = reading.color(surface, format, plan);
    let clean = reading.context.check("probing a format").is_ok();
    clean && read.is_ok_and(|codes| codes == all)
}

/// Returns the sample counts above 1 for which the driver creates, draws to and reads attachments.
fn sample_counts(
    reading: &mut Reading<'_>,
    format: TextureFormat,
    support: &Support,
    positions: &mut Positions,
) -> Vec<u32> {
    let context = reading.context;
    let caps = &context.caps;
    let stencil_fetched =
        caps.stencil_texturing && (caps.stencil_textures || format != TextureFormat::Stencil8);
    let drawn = !support.limits.samples.is_empty();
    // A shader sees one value for both codes of -1.
    let has_distinct_codes = format != TextureFormat::Rgba8Snorm;
    let readable = drawn && has_distinct_codes && (!format.has_stencil() || stencil_fetched);
    if !caps.multisample_textures || !readable {
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
            // One table for all formats.
            if positions.entry(count).or_insert_with(|| found.clone()) == &found {
                counts.push(count);
            }
        }
    }
    if counts.is_empty() || fetch_is_exact(reading, format, support) {
        counts
    } else {
        Vec::new()
    }
}

/// Returns true if a shader's fetch returns the same codes as a copy. Short normalized codes and
/// floats are exact in any float; sRGB and 24-bit depth may not be.
fn fetch_is_exact(reading: &mut Reading<'_>, format: TextureFormat, support: &Support) -> bool {
    if format == TextureFormat::Rgba8UnormSrgb {
        let context = reading.context;
        return with_surface(context, format, 1, |surface| {
            Some(color_round_trips(
                reading,
                surface,
                format,
                ReadPlan::Fetched,
            ))
        })
        .unwrap_or(false);
    }
    let copied = support.limits.read == ReadPath::Copy;
    if copied && support.limits.depth.contains(&ChannelEncoding::Unorm(24)) {
        let context = reading.context;
        return with_surface(context, format, 1, |surface| {
            // The surface then holds a spread of codes.
            let plan = support.read;
            let exact = depth_round_trips(context, surface, format, plan);
            let (expected, _) = read::copy(context, surface, format, plan);
            let seen = reading.fetched_depth(surface, ChannelEncoding::Unorm(24));
            Some(exact && seen.is_ok_and(|codes| codes == expected))
        })
        .unwrap_or(false);
    }
    true
}

/// Returns the sample positions of a surface; `None` if it has another sample count.
fn sample_positions(context: &Context, surface: &Surface, count: u32) -> Option<Vec<[u16; 2]>> {
    let get = context.entry_points.get_multisample?;
    let gl = &context.gl;
    // SAFETY: the context is current, the surface lives, and the pair has room. The texture is
    // bound to its target.
    unsafe {
        gl.bind_texture(glow::TEXTURE_2D_MULTISAMPLE, surface.texture());
        let target = glow::TEXTURE_2D_MULTISAMPLE;
        let stored = gl.get_tex_level_parameter_i32(target, 0, glow::TEXTURE_SAMPLES);
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
        let drawn = gl.get_parameter_i32(glow::SAMPLES);
        // A request for 2 samples may yield 4.
        if [stored, drawn].map(u32::try_from) != [Ok(count); 2] {
            return None;
        }
        let position = |i| {
            let mut position = [0.0_f32; 2];
            get(glow::SAMPLE_POSITION, i, position.as_mut_ptr());
            // Rows count upwards in window coordinates, and row 0 is the top one here: nothing is
            // mirrored.
            position.map(|v| (v * 256.0).round() as u16)
        };
        Some((0..count).map(position).collect())
    }
}

/// Returns the first 32-bit code that is not below a 24-bit one. Truncation and rounding both
/// return it to the same code.
fn widened(code: u32) -> u32 {
    let exact = u64::from(code) * u64::from(u32::MAX);
    exact.div_ceil(0xff_ffff) as u32
}

/// Returns true if codes uploaded to a depth texture are read back unchanged, so that reading is an
/// exact copy: GL describes both ways as conversions, which might round.
fn depth_round_trips(
    context: &Context,
    surface: &Surface,
    format: TextureFormat,
    plan: ReadPlan,
) -> bool {
    let Some(texture) = surface.texture() else {
        return false;
    };
    let size = surface.size();
    let last = size[0] * size[1] - 1;
    let spread = |most: u32| {
        let code = move |i| (u64::from(i) * u64::from(most) / u64::from(last)) as u32;
        (0..=last).map(code)
    };
    let floats = || (0..=last).map(|i| (i as f32 / last as f32).to_bits());
    let stencils = || (0..=last).map(|i| i & 0xff);
    let (kind, bytes, codes): (u32, Vec<u8>, Vec<u32>) = match plan {
        ReadPlan::Depth16 => (
            glow::UNSIGNED_SHORT,
            spread(0xffff)
                .flat_map(|c| (c as u16).to_ne_bytes())
                .collect(),
            spread(0xffff).collect(),
        ),
        ReadPlan::Depth24 => (
            glow::UNSIGNED_INT,
            spread(0xff_ffff)
                .flat_map(|c| widened(c).to_ne_bytes())
                .collect(),
            spread(0xff_ffff).collect(),
        ),
        ReadPlan::DepthFloat => (
            glow::FLOAT,
            floats().flat_map(u32::to_ne_bytes).collect(),
            floats().collect(),
        ),
        ReadPlan::Depth24Stencil8 => (
            glow::UNSIGNED_INT_24_8,
            spread(0xff_ffff)
                .zip(stencils())
                .flat_map(|(c, s)| (c << 8 | s).to_ne_bytes())
                .collect(),
            spread(0xff_ffff).collect(),
        ),
        ReadPlan::DepthFloatStencil8 => (
            glow::FLOAT_32_UNSIGNED_INT_24_8_REV,
            floats()
                .zip(stencils())
                .flat_map(|(c, s)| [c, s])
                .flat_map(u32::to_ne_bytes)
                .collect(),
            floats().collect(),
        ),
        _ => return false,
    };
    let layout = if format.has_stencil() {
        glow::DEPTH_STENCIL
    } else {
        glow::DEPTH_COMPONENT
    };
    let gl = &context.gl;
    crate::state::reset(context);
    // SAFETY: the context is current, rows are packed tightly, and the bytes cover the texture.
    unsafe {
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        gl.tex_sub_image_2d(
            glow::TEXTURE_2D,
            0,
            0,
            0,
            size[0] as i32,
            size[1] as i32,
            layout,
            kind,
            glow::PixelUnpackData::Slice(Some(&bytes)),
        );
    }
    let (read, stencil) = read::copy(context, surface, format, plan);
    read == codes && stencil.is_none_or(|s| s.into_iter().eq(stencils()))
}
