//! Bugs of colour formats: the rounding and range of each encoding, and the order of channels.

mod orders;

use crate::blend::{Encodings, Input, after, before};
use crate::hooks::{
    blending, clear_code, code, color_code, color_value, faithful_blend, missing_alpha, resolve,
};
use crate::list::{CONFUSION, SMALL, STEPS, bugs, coarse, rounded};
use crate::permission::under;
use crate::plant::{Plant, nudge, scene};
use etalon_cpu::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding::{self, Float16, Float32, Snorm, Srgb8, Ufloat, Unorm};
use etalon_pipeline::{Arithmetic, BlendInput, Plain};
use etalon_reference::rules::{ConstantClamp, FactorClamp, SignedClamp};
use etalon_scene::{AttachmentContents, BlendFactor};
use std::collections::BTreeSet;

const CLAMPED: &str = "SwiftShader: negative float blends clamped";

/// The encodings, and the largest offset in codes that stays within their range.
const ENCODINGS: [(&str, ChannelEncoding, i64); 13] = [
    ("unorm1", Unorm(1), 1),
    ("unorm2", Unorm(2), 1),
    ("unorm4", Unorm(4), 3),
    ("unorm5", Unorm(5), 3),
    ("unorm6", Unorm(6), 3),
    ("unorm10", Unorm(10), 3),
    ("unorm16", Unorm(16), 3),
    ("snorm8", Snorm(8), 3),
    ("srgb8", Srgb8, 3),
    ("float16", Float16, 3),
    ("float32", Float32, 3),
    ("ufloat11", Ufloat(6), 3),
    ("ufloat10", Ufloat(5), 3),
];

/// Replaces the conversion of stored colours to one encoding.
pub(super) fn store(
    encoding: ChannelEncoding,
    bug: impl Fn(f32) -> u32 + Send + Sync + 'static,
) -> Plant {
    color_code(move |e, v, _| if e == encoding { bug(v) } else { code(e, v) })
}

/// Replaces the conversion of destination values of one encoding for blending.
fn read(encoding: ChannelEncoding, bug: impl Fn(u32) -> f32 + Send + Sync + 'static) -> Plant {
    color_value(move |e, c| if e == encoding { bug(c) } else { value(e, c) })
}

fn is_srgb(encodings: Encodings) -> bool {
    encodings[0] == Srgb8
}

fn is_signed(encodings: Encodings) -> bool {
    encodings[0] == Snorm(8)
}

/// Changes the inputs of blending with float attachments.
fn float_inputs(bug: fn(&mut Input)) -> Plant {
    before(move |_, encodings, input| {
        if encodings[0].is_float() {
            bug(input);
        }
    })
}

/// Changes the results of blending with float attachments.
fn float_results(bug: fn(f32) -> f32) -> Plant {
    after(move |_, encodings, _, result| {
        if encodings[0].is_float() {
            *result = result.map(bug);
        }
    })
}

/// Replaces the rounding of values of signed formats.
fn signed(round: fn(f32) -> f32) -> Plant {
    store(Snorm(8), move |v| {
        // Nearly exact codes are rounded first, so that the product's last bit does not matter.
        let exact = v.clamp(-1.0, 1.0) * 127.0;
        let near = exact.round();
        let is_integer = (exact - near).abs() < 1e-4;
        Snorm(8).code_of_order((if is_integer { near } else { round(exact) }) as i64)
    })
}

/// Encodings with codes at which a table is wrong.
const TABLES: [(&str, ChannelEncoding, &[u32]); 5] = [
    ("srgb8", Srgb8, &[29, 53, 87, 118, 149, 183, 239]),
    ("unorm10", Unorm(10), &[97, 203, 341, 466, 611, 743, 901]),
    ("unorm6", Unorm(6), &[7, 22, 37, 55]),
    ("unorm5", Unorm(5), &[5, 14, 23]),
    ("unorm4", Unorm(4), &[2, 12]),
];

/// Returns the code that follows if a table is wrong at this one.
fn tabulated(wrong: &[u32], code: u32) -> u32 {
    code + u32::from(wrong.contains(&code))
}

/// Changes the uploaded codes of an encoding in attachments that shaders read.
fn fetched(encoding: ChannelEncoding, bug: impl Fn(u32) -> u32 + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let textures = scene
            .passes
            .iter()
            .flat_map(|p| &p.draws)
            .flat_map(|d| &d.textures);
        let textures: BTreeSet<usize> = textures.copied().collect();
        for texture in textures {
            let attachment = &mut scene.attachments[texture];
            let channels = attachment.format.color_channels();
            if let AttachmentContents::Texels(codes) = &mut attachment.contents {
                let of_encoding = codes.iter_mut().zip(channels.iter().cycle());
                let of_encoding = of_encoding.filter(|(_, e)| **e == encoding);
                of_encoding.for_each(|(code, _)| *code = bug(*code));
            }
        }
    })
}

/// Returns the correct value of a code.
pub(super) fn value(encoding: ChannelEncoding, code: u32) -> f32 {
    let [value] = Plain::<1>.decode(encoding, [code]);
    value
}

/// Converts a linear value to sRGB, clamped to 0 to 1; `linear` is the inverse.
fn encoded(linear: f32) -> f32 {
    etalon_frame::linear_to_srgb(f64::from(linear.clamp(0.0, 1.0))) as f32
}

fn linear(encoded: f32) -> f32 {
    etalon_frame::srgb_to_linear(f64::from(encoded.clamp(0.0, 1.0))) as f32
}

/// Clamps the inputs to the range from `low` to 1.
fn clamp(input: &Input, low: f32) -> Input {
    let held = |values: [[f32; 1]; 4]| values.map(|[v]| [v.clamp(low, 1.0)]);
    BlendInput {
        src: held(input.src),
        src1: held(input.src1),
        dst: held(input.dst),
        constant: held(input.constant),
    }
}

/// Rounds a value to a code, towards 0.
fn truncated(encoding: ChannelEncoding, v: f32) -> u32 {
    let v = f64::from(v);
    let order = if v < 0.0 {
        encoding.order_above(v)
    } else {
        encoding.order_below(v)
    };
    encoding.code_of_order(order)
}

const NONLINEAR: &str = "SwiftShader: sRGB treated as linear";

bugs! {
    class "format", "blend";
    for (name, encoding, most) in ENCODINGS {
        let within = STEPS.into_iter().filter(|(_, steps)| steps.abs() <= most);
        for (by, steps) in within {
            "{name}-stored-{by}: {encoding} is stored {steps} codes off." =>
                store(encoding, move |v| nudge(encoding, code(encoding, v), steps)), source SMALL;
        }
    }
    source "a table of codes that is off in a few entries";
    for (name, encoding, wrong) in TABLES {
        "{name}-stored-by-wrong-table: Values near a few codes of {encoding} are stored one code too high." =>
            store(encoding, move |v| tabulated(wrong, code(encoding, v)));
        "{name}-destination-read-by-wrong-table: Destinations of a few codes of {encoding} are read three codes too high." =>
            read(encoding, move |c| value(encoding, c + 3 * u32::from(wrong.contains(&c))));
        "{name}-cleared-by-wrong-table: Clears to a few codes of {encoding} are one code too high." =>
            clear_code(move |e, v| if e == encoding { tabulated(wrong, code(e, v)) } else { code(e, v) });
        "{name}-fetched-by-wrong-table: Shaders read a few codes of {encoding} as the next." =>
            fetched(encoding, move |c| tabulated(wrong, c));
        "{name}-resolved-by-wrong-table: A few codes of {encoding} are resolved to the next." =>
            resolve(move |e, codes| {
                let code = Faithful.resolve(e, codes);
                if e == encoding { tabulated(wrong, code) } else { code }
            });
    }
    source CONFUSION;
    "srgb-stored-linear: An sRGB format stores linear values as they are." =>
        store(Srgb8, |v| code(Unorm(8), v)), source NONLINEAR;
    "srgb-stored-by-gamma: An sRGB format stores by a power of 1/2.2." =>
        store(Srgb8, |v| code(Unorm(8), v.clamp(0.0, 1.0).powf(1.0 / 2.2))),
        source "a power of 1/2.2 for the sRGB curve";
    "srgb-stored-without-straight-part: Small values are stored by the power alone." =>
        store(Srgb8, |v| { let power = 1.055 * v.clamp(0.0, 1.0).powf(1.0 / 2.4) - 0.055; code(Unorm(8), power) }),
        source "the sRGB curve without its straight part";
    "srgb-stored-in-7-bits: An sRGB format loses its lowest bit." =>
        store(Srgb8, |v| code(Srgb8, v) & 0xfe), source SMALL;
    "srgb-destination-read-linear: An sRGB destination is read as if it were linear." =>
        read(Srgb8, |c| value(Unorm(8), c)), source NONLINEAR;
    "srgb-blended-encoded: An sRGB format is blended in encoded values." =>
        blending(|state, encodings, input: &Input| {
            if !is_srgb(encodings) { return faithful_blend(state, encodings, input); }
            let mut stored = *input;
            (0..3).for_each(|c| stored.src[c] = input.src[c].map(encoded));
            (0..3).for_each(|c| stored.dst[c] = input.dst[c].map(encoded));
            let result = faithful_blend(state, [Unorm(8); 4], &stored);
            std::array::from_fn(|c| if c == 3 { result[c] } else { linear(result[c]) })
        }), source NONLINEAR;
    "srgb-alpha-encoded: The alpha of an sRGB format is blended as if it were sRGB too." =>
        after(|state, encodings, input, result| if is_srgb(encodings) {
            let mut with_alpha = *input;
            with_alpha.dst[3] = input.dst[3].map(linear);
            *result = faithful_blend(state, encodings, &with_alpha);
            result[3] = encoded(result[3]);
        });
    "srgb-cleared-linear: An sRGB format takes clear values without converting them." =>
        clear_code(|e, v| code(if e == Srgb8 { Unorm(8) } else { e }, v)), source NONLINEAR;
    "unorm8-stored-as-srgb: Linear 8-bit formats are stored as sRGB." =>
        store(Unorm(8), |v| code(Srgb8, v)), source "a linear format treated as sRGB";
    "unorm8-destination-read-as-srgb: Linear 8-bit destinations are read as sRGB." =>
        read(Unorm(8), |c| value(Srgb8, c)), source "a linear format treated as sRGB";
    for (name, about, round as fn(f32) -> f32) in [
        ("truncated", "towards 0", f32::trunc), ("rounded-down", "down", f32::floor),
    ] {
        "snorm8-{name}: Signed values are rounded {about}." =>
            signed(round), source "truncation instead of rounding", permitted rounded();
    }
    "snorm8-negatives-lost: Signed formats store 0 for negative values." =>
        store(Snorm(8), |v| code(Snorm(8), v.max(0.0))), permitted vec![under!(signed_result: SignedClamp::Unit | SignedClamp::Either)];
    "snorm8-minus-one-as-lowest: -1 is stored as the lowest code." =>
        store(Snorm(8), |v| if v <= -1.0 { 0x80 } else { code(Snorm(8), v) });
    "snorm8-times-128: Signed formats are stored by the power of two." =>
        store(Snorm(8), |v| Snorm(8).code_of_order((v * 128.0).round().clamp(-128.0, 127.0) as i64));
    "snorm8-wraps: Signed values outside -1 to 1 wrap around." =>
        store(Snorm(8), |v| ((v * 127.0).round() as i64 & 0xff) as u32);
    "snorm8-stored-as-unorm8: Signed formats are stored as unsigned ones." => store(Snorm(8), |v| code(Unorm(8), v));
    "snorm8-destination-read-as-unorm8: Signed destinations are read as unsigned ones." =>
        read(Snorm(8), |c| value(Unorm(8), c));
    "snorm8-destination-negatives-lost: Negative destinations are read as 0." =>
        read(Snorm(8), |c| value(Snorm(8), c).max(0.0));
    "snorm8-inverse-factors-out-of-range: Factors 1 - x of signed formats exceed 1." =>
        before(|_, e, input| if is_signed(*e) { (*e, *input) = ([Float32; 4], clamp(input, -1.0)) }),
        source "llvmpipe: snorm inverse factors out of range", permitted vec![under!(factor_clamp: FactorClamp::Either)];
    "snorm8-operands-held-above-0: On signed formats, operands are clamped to 0 to 1." =>
        before(|_, e, input| if is_signed(*e) { *input = Input { dst: input.dst, ..clamp(input, 0.0) } });
    "snorm8-all-operands-held-above-0: On signed formats, all operands are clamped to 0 to 1." =>
        before(|_, e, input| if is_signed(*e) { *input = clamp(input, 0.0) }), source "drivers of OpenGL 3.3",
        permitted vec![under!(signed_clamp: SignedClamp::Unit | SignedClamp::Either)];
    "snorm8-cleared-above-0: Signed formats take negative clear values for 0." =>
        clear_code(|e, v| code(e, if e == Snorm(8) { v.max(0.0) } else { v }));
    for bits in [4, 5, 6] {
        "unorm{bits}-destination-truncated: Destinations of {bits} bits are read as the upper of 8." =>
            read(Unorm(bits), move |c| (c << (8 - bits)) as f32 / 255.0),
            source "SwiftShader: 565/5551 blended on truncated bits";
        // For four bits, repeating the bits gives the exact value.
        if (bits > 4) {
            "unorm{bits}-destination-replicated: Destinations of {bits} bits are read as 8 that repeat them." =>
                read(Unorm(bits), move |c| (c << (8 - bits) | c >> (2 * bits - 8)) as f32 / 255.0),
                source "blending in 8 bits, as mobile GPUs do it", permitted coarse();
        }
        "unorm{bits}-stored-through-8-bits: Formats of {bits} bits take the upper bits of 8." =>
            store(Unorm(bits), move |v| code(Unorm(8), v) >> (8 - bits)),
            source "blending in 8 bits, as mobile GPUs do it", permitted rounded();
        let fewer = bits - 1;
        "unorm{bits}-stored-in-{fewer}-bits: Formats of {bits} bits lose their lowest." =>
            store(Unorm(bits), move |v| code(Unorm(bits), v) & !1), source SMALL;
    }
    "unorm10-stored-in-8-bits: Formats of 10 bits keep 8." =>
        store(Unorm(10), |v| code(Unorm(10), code(Unorm(8), v) as f32 / 255.0)),
        source "a format of 10 bits backed by one of 8";
    "unorm10-destination-in-8-bits: Destinations of 10 bits are read by their upper 8." =>
        read(Unorm(10), |c| (c >> 2) as f32 / 255.0), source "a format of 10 bits backed by one of 8";
    "unorm2-stored-in-1-bit: Alpha of 2 bits is stored as all or nothing." =>
        store(Unorm(2), |v| if v < 0.5 { 0 } else { 3 }), source SMALL;
    "unorm2-opaque: Alpha of 2 bits is stored as 1." => store(Unorm(2), |_| 3);
    "unorm1-opaque: Alpha of 1 bit is stored as 1." => store(Unorm(1), |_| 1);
    "unorm1-only-for-one: Alpha of 1 bit is set for 1 alone." =>
        store(Unorm(1), |v| u32::from(v >= 1.0)), source "truncation instead of rounding", permitted rounded();
    for (name, encoding) in [("float16", Float16), ("float32", Float32)] {
        "{name}-clamped: Channels of {encoding} are clamped to 0 to 1 at the store." =>
            store(encoding, move |v| code(encoding, v.clamp(0.0, 1.0))), source CLAMPED;
        "{name}-negatives-lost: Channels of {encoding} store 0 for negative values." =>
            store(encoding, move |v| code(encoding, v.max(0.0))), source CLAMPED;
        "{name}-sign-lost: Channels of {encoding} lose their sign." =>
            store(encoding, move |v| code(encoding, v.abs()));
    }
    "float16-truncated: 16-bit floats are rounded towards 0." =>
        store(Float16, |v| truncated(Float16, v)), source "truncation instead of rounding", permitted vec![under!(store: _)];
    "float16-overflow-to-largest: 16-bit floats hold the largest value, not infinity." =>
        store(Float16, |v| code(Float16, v.clamp(-65504.0, 65504.0))),
        source "a saturating conversion", permitted vec![under!(half_overflows: _)];
    "float16-in-8-bits: 16-bit floats lose the lowest two bits." =>
        store(Float16, |v| code(Float16, v) & !3), source SMALL;
    "float32-in-16-bits: 32-bit floats are rounded to 16-bit ones." =>
        store(Float32, |v| value(Float16, code(Float16, v)).to_bits()),
        source "a 32-bit float format backed by a 16-bit one";
    for (name, encoding) in [("ufloat11", Ufloat(6)), ("ufloat10", Ufloat(5))] {
        "{name}-truncated: Channels of {encoding} are rounded down." =>
            store(encoding, move |v| truncated(encoding, v)),
            source "truncation instead of rounding", permitted vec![under!(small_floats: _)];
        "{name}-sign-lost: Channels of {encoding} store negative values without their sign." =>
            store(encoding, move |v| code(encoding, v.abs()));
        "{name}-clamped: Channels of {encoding} are clamped to 0 to 1." =>
            store(encoding, move |v| code(encoding, v.min(1.0))), source CLAMPED;
        "{name}-lowest-bit-lost: Channels of {encoding} lose their lowest bit." =>
            store(encoding, move |v| code(encoding, v) & !1), source SMALL;
    }
    source CLAMPED;
    "float-constant-clamped: On float formats, the constant is clamped to 0 to 1." =>
        float_inputs(|i| i.constant = clamp(i, 0.0).constant), permitted vec![under!(constant_clamp: ConstantClamp::Always | ConstantClamp::Either)];
    "float-source-clamped: On float formats, sources are clamped to 0 to 1." =>
        float_inputs(|i| i.src = clamp(i, 0.0).src);
    "float-destination-clamped: On float formats, destinations are clamped to 0 to 1." =>
        float_inputs(|i| i.dst = clamp(i, 0.0).dst);
    "float-source-negatives-lost: On float formats, negative sources count as 0." =>
        float_inputs(|i| i.src = i.src.map(|[v]| [v.max(0.0)]));
    "float-destination-negatives-lost: Negative destinations of floats count as 0." =>
        float_inputs(|i| i.dst = i.dst.map(|[v]| [v.max(0.0)]));
    "float-result-clamped: On float formats, blend results are clamped to 0 to 1." =>
        float_results(|v| v.clamp(0.0, 1.0));
    "float-result-negatives-lost: Negative results of blending floats become 0." => float_results(|v| v.max(0.0));
    source CONFUSION;
    "missing-alpha-zero: Formats without alpha are blended as if it were 0." => missing_alpha(|_| 0.0);
    "missing-alpha-zero-for-saturate: Saturate takes a missing destination alpha for 0." =>
        missing_alpha(|state| {
            let saturated = BlendFactor::SrcAlphaSaturated;
            let color = &state.color;
            let used = [color.src_factor, color.dst_factor].contains(&saturated);
            if used { 0.0 } else { 1.0 }
        }), source "llvmpipe: saturate wrong on formats without alpha";
    also orders::add;
}
