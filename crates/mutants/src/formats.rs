//! Bugs of colour formats: the rounding and range of each encoding, and the order of channels.

mod orders;

use crate::hooks::{
    blending, clear_code, code, color_code, color_value, faithful_blend, missing_alpha,
};
use crate::list::{CONFUSION, List, PRECISION, ROUNDED, SMALL, STEPS};
use crate::plant::{Plant, nudge};
use etalon_frame::ChannelEncoding::{self, Float16, Float32, Snorm, Srgb8, Ufloat, Unorm};
use etalon_pipeline::{Arithmetic, BlendInput, Plain};
use etalon_scene::{BlendFactor, BlendState};

type Input = BlendInput<[f32; 1]>;
type Encodings = [ChannelEncoding; 4];

const SMALL_FLOATS: &str = "Vulkan: Fundamentals, 16-Bit and Unsigned 11-Bit and 10-Bit \
                            Floating-Point Numbers: either neighbouring value, and the largest \
                            finite one or infinity for values beyond it";

/// The encodings, and the largest offset in codes that stays within their range.
const ENCODINGS: [(&str, ChannelEncoding, i64); 12] = [
    ("unorm1", Unorm(1), 1),
    ("unorm2", Unorm(2), 1),
    ("unorm4", Unorm(4), 3),
    ("unorm5", Unorm(5), 3),
    ("unorm6", Unorm(6), 3),
    ("unorm10", Unorm(10), 3),
    ("snorm8", Snorm(8), 3),
    ("srgb8", Srgb8, 3),
    ("float16", Float16, 3),
    ("float32", Float32, 3),
    ("ufloat11", Ufloat(6), 3),
    ("ufloat10", Ufloat(5), 3),
];

pub(super) fn add(list: &mut List) {
    list.class("format", "blend");
    for (name, encoding, most) in ENCODINGS {
        for (by, steps) in STEPS.into_iter().filter(|(_, steps)| steps.abs() <= most) {
            list.bug(format!(
                "{name}-stored-{by}: {encoding} is stored {steps} codes off."
            ))
            .source(SMALL)
            .plant(store(encoding, move |v| {
                nudge(encoding, code(encoding, v), steps)
            }));
        }
    }
    srgb(list);
    signed(list);
    few_bits(list);
    floats(list);
    alpha(list);
    orders::add(list);
}

/// Replaces the store of one encoding.
fn store(encoding: ChannelEncoding, bug: impl Fn(f32) -> u32 + Send + Sync + 'static) -> Plant {
    color_code(move |e, v| if e == encoding { bug(v) } else { code(e, v) })
}

/// Replaces the destination value that a blend reads of one encoding.
fn read(encoding: ChannelEncoding, bug: impl Fn(u32) -> f32 + Send + Sync + 'static) -> Plant {
    color_value(move |e, c| if e == encoding { bug(c) } else { value(e, c) })
}

/// Replaces the blend of attachments whose red has this property.
fn blend_of(
    which: fn(ChannelEncoding) -> bool,
    bug: impl Fn(&BlendState, Encodings, &Input) -> [f32; 4] + Send + Sync + 'static,
) -> Plant {
    blending(move |state, encodings, input| {
        if which(encodings[0]) {
            bug(state, encodings, input)
        } else {
            faithful_blend(state, encodings, input)
        }
    })
}

/// Returns the correct value of a code.
fn value(encoding: ChannelEncoding, code: u32) -> f32 {
    let [value] = Plain::<1>.decode(encoding, [code]);
    value
}

/// The sRGB-encoded value of a linear one, and back, as an 8-bit texture unit would convert them.
fn encoded(linear: f32) -> f32 {
    etalon_frame::linear_to_srgb(f64::from(linear.clamp(0.0, 1.0))) as f32
}

fn linear(encoded: f32) -> f32 {
    etalon_frame::srgb_to_linear(f64::from(encoded.clamp(0.0, 1.0))) as f32
}

fn srgb(list: &mut List) {
    const NONLINEAR: &str = "SwiftShader: sRGB treated as linear";
    list.bug("srgb-stored-linear: An sRGB format stores linear values as they are.")
        .source(NONLINEAR)
        .plant(store(Srgb8, |v| code(Unorm(8), v)));
    list.bug("srgb-stored-by-gamma: An sRGB format stores by a power of 1/2.2.")
        .source("a power of 1/2.2 for the sRGB curve")
        .plant(store(Srgb8, |v| {
            code(Unorm(8), v.clamp(0.0, 1.0).powf(1.0 / 2.2))
        }));
    list.bug("srgb-stored-without-straight-part: Small values are stored by the power alone.")
        .source("the sRGB curve without its straight part")
        .plant(store(Srgb8, |v| {
            let power = 1.055 * v.clamp(0.0, 1.0).powf(1.0 / 2.4) - 0.055;
            code(Unorm(8), power)
        }));
    list.bug("srgb-stored-in-7-bits: An sRGB format loses its lowest bit.")
        .source(SMALL)
        .plant(store(Srgb8, |v| code(Srgb8, v) & 0xfe));
    list.bug("srgb-destination-read-linear: An sRGB destination is read as if it were linear.")
        .source(NONLINEAR)
        .plant(read(Srgb8, |c| value(Unorm(8), c)));
    list.bug("srgb-blended-encoded: An sRGB format is blended in encoded values.")
        .source(NONLINEAR)
        .plant(blend_of(
            |e| e == Srgb8,
            |state, _, input| {
                let mut as_stored = *input;
                for c in 0..3 {
                    as_stored.src[c] = input.src[c].map(encoded);
                    as_stored.dst[c] = input.dst[c].map(encoded);
                }
                let result = faithful_blend(state, [Unorm(8); 4], &as_stored);
                std::array::from_fn(|c| if c == 3 { result[c] } else { linear(result[c]) })
            },
        ));
    list.bug("srgb-alpha-encoded: The alpha of an sRGB format is blended as if it were sRGB too.")
        .plant(blend_of(
            |e| e == Srgb8,
            |state, encodings, input| {
                let mut with_alpha = *input;
                with_alpha.dst[3] = input.dst[3].map(linear);
                let mut result = faithful_blend(state, encodings, &with_alpha);
                result[3] = encoded(result[3]);
                result
            },
        ));
    list.bug("srgb-cleared-linear: An sRGB format takes clear values without converting them.")
        .source(NONLINEAR)
        .plant(clear_code(|e, v| {
            code(if e == Srgb8 { Unorm(8) } else { e }, v)
        }));
    list.bug("unorm8-stored-as-srgb: Linear 8-bit formats are stored as sRGB.")
        .source("a linear format treated as sRGB")
        .plant(store(Unorm(8), |v| code(Srgb8, v)));
    list.bug("unorm8-destination-read-as-srgb: Linear 8-bit destinations are read as sRGB.")
        .source("a linear format treated as sRGB")
        .plant(read(Unorm(8), |c| value(Srgb8, c)));
}

fn signed(list: &mut List) {
    let snorm = Snorm(8);
    let mut round = |text: &str, round: fn(f32) -> f32| {
        list.bug(text)
            .source("truncation instead of rounding")
            .legal(ROUNDED)
            .plant(store(snorm, move |v| {
                // Codes are rounded, so that the product's last bit does not matter.
                let exact = v.clamp(-1.0, 1.0) * 127.0;
                let near = exact.round();
                let whole = (exact - near).abs() < 1e-4;
                snorm.code_of_order((if whole { near } else { round(exact) }) as i64)
            }));
    };
    round(
        "snorm8-truncated: Signed values are rounded towards 0.",
        f32::trunc,
    );
    round(
        "snorm8-rounded-down: Signed values are rounded down.",
        f32::floor,
    );
    list.bug("snorm8-negatives-lost: Signed formats store 0 for negative values.")
        .plant(store(snorm, |v| code(Snorm(8), v.max(0.0))));
    list.bug("snorm8-minus-one-as-lowest: -1 is stored as the lowest code.")
        .plant(store(snorm, |v| {
            if v <= -1.0 { 0x80 } else { code(Snorm(8), v) }
        }));
    list.bug("snorm8-times-128: Signed formats are stored by the power of two.")
        .plant(store(snorm, |v| {
            Snorm(8).code_of_order((v * 128.0).round().clamp(-128.0, 127.0) as i64)
        }));
    list.bug("snorm8-wraps: Signed values outside -1 to 1 wrap around.")
        .plant(store(snorm, |v| ((v * 127.0).round() as i64 & 0xff) as u32));
    list.bug("snorm8-stored-as-unorm8: Signed formats are stored as unsigned ones.")
        .plant(store(snorm, |v| code(Unorm(8), v)));
    list.bug("snorm8-destination-read-as-unorm8: Signed destinations are read as unsigned ones.")
        .plant(read(snorm, |c| value(Unorm(8), c)));
    list.bug("snorm8-destination-negatives-lost: Negative destinations are read as 0.")
        .plant(read(snorm, |c| value(Snorm(8), c).max(0.0)));
    let signed = |e| e == Snorm(8);
    list.bug("snorm8-inverse-factors-out-of-range: Factors 1 - x of signed formats exceed 1.")
        .source("llvmpipe: snorm inverse factors out of range")
        .plant(blend_of(signed, |state, _, input| {
            faithful_blend(state, [Float32; 4], &clamp(input, -1.0))
        }));
    list.bug("snorm8-operands-held-above-0: On signed formats, operands are clamped to 0 to 1.")
        .plant(blend_of(signed, |state, encodings, input| {
            let mut held = clamp(input, 0.0);
            held.dst = input.dst;
            faithful_blend(state, encodings, &held)
        }));
    list.bug("snorm8-cleared-above-0: Signed formats take negative clear values for 0.")
        .plant(clear_code(|e, v| {
            code(e, if e == Snorm(8) { v.max(0.0) } else { v })
        }));
}

/// Returns the input clamped to a lower end and 1.
fn clamp(input: &Input, low: f32) -> Input {
    let held = |values: [[f32; 1]; 4]| values.map(|[v]| [v.clamp(low, 1.0)]);
    BlendInput {
        src: held(input.src),
        src1: held(input.src1),
        dst: held(input.dst),
        constant: held(input.constant),
    }
}

fn few_bits(list: &mut List) {
    const FEW: &str = "SwiftShader: 565/5551 blended on truncated bits";
    for bits in [4_u8, 5, 6] {
        list.bug(format!(
            "unorm{bits}-destination-truncated: Destinations of {bits} bits are read as the upper of 8."
        ))
        .source(FEW)
        .plant(read(Unorm(bits), move |c| (c << (8 - bits)) as f32 / 255.0));
        // Four bits repeated are exactly their value.
        if bits > 4 {
            list.bug(format!(
                "unorm{bits}-destination-replicated: Destinations of {bits} bits are read as 8 that repeat them."
            ))
            .source("blending in 8 bits, as mobile GPUs do it")
            .legal(PRECISION)
            .plant(read(Unorm(bits), move |c| {
                (c << (8 - bits) | c >> (2 * bits - 8)) as f32 / 255.0
            }));
        }
        list.bug(format!(
            "unorm{bits}-stored-through-8-bits: Formats of {bits} bits take the upper bits of 8."
        ))
        .source("blending in 8 bits, as mobile GPUs do it")
        .legal(ROUNDED)
        .plant(store(Unorm(bits), move |v| code(Unorm(8), v) >> (8 - bits)));
        list.bug(format!(
            "unorm{bits}-stored-in-{}-bits: Formats of {bits} bits lose their lowest.",
            bits - 1
        ))
        .source(SMALL)
        .plant(store(Unorm(bits), move |v| code(Unorm(bits), v) & !1));
    }
    list.bug("unorm10-stored-in-8-bits: Formats of 10 bits keep 8.")
        .source("a format of 10 bits backed by one of 8")
        .plant(store(Unorm(10), |v| {
            code(Unorm(10), code(Unorm(8), v) as f32 / 255.0)
        }));
    list.bug("unorm10-destination-in-8-bits: Destinations of 10 bits are read by their upper 8.")
        .source("a format of 10 bits backed by one of 8")
        .plant(read(Unorm(10), |c| (c >> 2) as f32 / 255.0));
    list.bug("unorm2-stored-in-1-bit: Alpha of 2 bits is stored as all or nothing.")
        .source(SMALL)
        .plant(store(Unorm(2), |v| if v < 0.5 { 0 } else { 3 }));
    list.bug("unorm2-opaque: Alpha of 2 bits is stored as 1.")
        .plant(store(Unorm(2), |_| 3));
    list.bug("unorm1-opaque: Alpha of 1 bit is stored as 1.")
        .plant(store(Unorm(1), |_| 1));
    list.bug("unorm1-only-for-one: Alpha of 1 bit is set for 1 alone.")
        .source("truncation instead of rounding")
        .legal(ROUNDED)
        .plant(store(Unorm(1), |v| u32::from(v >= 1.0)));
}

fn floats(list: &mut List) {
    const CLAMPED: &str = "SwiftShader: negative float blends clamped";
    let is_float: fn(ChannelEncoding) -> bool = ChannelEncoding::is_float;
    for (name, encoding) in [("float16", Float16), ("float32", Float32)] {
        list.bug(format!(
            "{name}-clamped: Channels of {encoding} are clamped to 0 to 1 at the store."
        ))
        .source(CLAMPED)
        .plant(store(encoding, move |v| code(encoding, v.clamp(0.0, 1.0))));
        list.bug(format!(
            "{name}-negatives-lost: Channels of {encoding} store 0 for negative values."
        ))
        .source(CLAMPED)
        .plant(store(encoding, move |v| code(encoding, v.max(0.0))));
        list.bug(format!(
            "{name}-sign-lost: Channels of {encoding} lose their sign."
        ))
        .plant(store(encoding, move |v| code(encoding, v.abs())));
    }
    list.bug("float16-truncated: 16-bit floats are rounded towards 0.")
        .source("truncation instead of rounding")
        .legal(SMALL_FLOATS)
        .plant(store(Float16, |v| truncated(Float16, v)));
    list.bug("float16-overflow-to-largest: 16-bit floats hold the largest value, not infinity.")
        .source("a saturating conversion")
        .legal(SMALL_FLOATS)
        .plant(store(Float16, |v| {
            code(Float16, v.clamp(-65504.0, 65504.0))
        }));
    list.bug("float16-in-8-bits: 16-bit floats lose the lowest two bits.")
        .source(SMALL)
        .plant(store(Float16, |v| code(Float16, v) & !3));
    list.bug("float32-in-16-bits: 32-bit floats are rounded to 16-bit ones.")
        .source("a 32-bit float format backed by a 16-bit one")
        .plant(store(Float32, |v| {
            value(Float16, code(Float16, v)).to_bits()
        }));
    for (name, bits) in [("ufloat11", 6), ("ufloat10", 5)] {
        let encoding = Ufloat(bits);
        list.bug(format!(
            "{name}-truncated: Channels of {encoding} are rounded down."
        ))
        .source("truncation instead of rounding")
        .legal(SMALL_FLOATS)
        .plant(store(encoding, move |v| truncated(encoding, v)));
        list.bug(format!(
            "{name}-sign-lost: Channels of {encoding} store negative values without their sign."
        ))
        .plant(store(encoding, move |v| code(encoding, v.abs())));
        list.bug(format!(
            "{name}-clamped: Channels of {encoding} are clamped to 0 to 1."
        ))
        .source(CLAMPED)
        .plant(store(encoding, move |v| code(encoding, v.min(1.0))));
        list.bug(format!(
            "{name}-lowest-bit-lost: Channels of {encoding} lose their lowest bit."
        ))
        .source(SMALL)
        .plant(store(encoding, move |v| code(encoding, v) & !1));
    }
    list.source(CLAMPED);
    let mut inputs = |text: &str, bug: fn(&mut Input)| {
        list.bug(text)
            .plant(blend_of(is_float, move |state, encodings, input| {
                let mut changed = *input;
                bug(&mut changed);
                faithful_blend(state, encodings, &changed)
            }));
    };
    inputs(
        "float-constant-clamped: On float formats, the constant is clamped to 0 to 1.",
        |i| i.constant = clamp(i, 0.0).constant,
    );
    inputs(
        "float-source-clamped: On float formats, sources are clamped to 0 to 1.",
        |i| i.src = clamp(i, 0.0).src,
    );
    inputs(
        "float-destination-clamped: On float formats, destinations are clamped to 0 to 1.",
        |i| i.dst = clamp(i, 0.0).dst,
    );
    inputs(
        "float-source-negatives-lost: On float formats, negative sources count as 0.",
        |i| i.src = i.src.map(|[v]| [v.max(0.0)]),
    );
    inputs(
        "float-destination-negatives-lost: Negative destinations of floats count as 0.",
        |i| i.dst = i.dst.map(|[v]| [v.max(0.0)]),
    );
    list.bug("float-result-clamped: On float formats, blend results are clamped to 0 to 1.")
        .source(CLAMPED)
        .plant(blend_of(is_float, |state, encodings, input| {
            faithful_blend(state, encodings, input).map(|v| v.clamp(0.0, 1.0))
        }));
    list.bug("float-result-negatives-lost: Negative results of blending floats become 0.")
        .source(CLAMPED)
        .plant(blend_of(is_float, |state, encodings, input| {
            faithful_blend(state, encodings, input).map(|v| v.max(0.0))
        }));
}

/// The code next to a value on the side of 0.
fn truncated(encoding: ChannelEncoding, v: f32) -> u32 {
    let v = f64::from(v);
    let order = if v < 0.0 {
        encoding.order_above(v)
    } else {
        encoding.order_below(v)
    };
    encoding.code_of_order(order)
}

fn alpha(list: &mut List) {
    list.source(CONFUSION);
    list.bug("missing-alpha-zero: Formats without alpha are blended as if it were 0.")
        .plant(missing_alpha(|_| 0.0));
    list.bug("missing-alpha-zero-for-saturate: Saturate takes a missing destination alpha for 0.")
        .source("llvmpipe: saturate wrong on formats without alpha")
        .plant(missing_alpha(|state| {
            let saturated = BlendFactor::SrcAlphaSaturated;
            let color = &state.color;
            let used = [color.src_factor, color.dst_factor].contains(&saturated);
            if used { 0.0 } else { 1.0 }
        }));
}
