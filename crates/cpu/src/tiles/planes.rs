//! Planes: one channel of several groups of texels, decoded and encoded together.

use crate::lanes::LANES;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain, srgb_codes, srgb_values};

/// The number of groups that are blended together.
pub(crate) const GROUPS: usize = 8;

/// The number of texels of the groups.
pub(crate) const TEXELS: usize = GROUPS * LANES;

/// The values of one channel.
pub(crate) type Plane = [f32; TEXELS];

/// The codes of one channel, or words.
pub(crate) type CodePlane = [u32; TEXELS];

/// Runs code once with an encoding. A common encoding has its own branch, in which the compiler knows the
/// encoding. The branches are patterns, because the compiler learns nothing from comparisons.
macro_rules! with_encoding {
    ($encoding:expr, |$known:ident| $run:expr) => {{
        use etalon_frame::ChannelEncoding::{Float16, Float32, Ufloat, Unorm};
        with_encoding!($encoding, |$known| $run; [Unorm(8)] [Unorm(10)] [Unorm(16)] [Float16] [Float32]
            [Ufloat(6)] [Ufloat(5)])
    }};
    ($encoding:expr, |$known:ident| $run:expr; $([$($common:tt)*])*) => {
        match $encoding {
            $($($common)* => {
                let $known = $($common)*;
                $run
            })*
            Unorm(bits) if bits <= 16 => {
                let $known = Unorm(bits);
                $run
            }
            $known => $run,
        }
    };
}
pub(crate) use with_encoding;

/// Decodes codes to values.
#[inline(always)]
pub(crate) fn decode(encoding: ChannelEncoding, codes: &[u32], values: &mut Plane) {
    if encoding == ChannelEncoding::Srgb8 {
        return decode_srgb(codes, values);
    }
    with_encoding!(encoding, |known| {
        for (value, code) in values.iter_mut().zip(codes) {
            [*value] = Plain::<1>.decode(known, [*code]);
        }
    });
}

/// Computes the values of sRGB codes. It is not inlined, so that it is compiled without gathers, which take
/// longer than single loads.
#[inline(never)]
fn decode_srgb(codes: &[u32], values: &mut Plane) {
    srgb_values(codes, values);
}

/// Computes the sRGB codes of values. It is not inlined, like [`decode_srgb`].
#[inline(never)]
fn encode_srgb(values: &[f32], codes: &mut CodePlane) {
    srgb_codes(values, codes);
}

/// Computes the codes of values.
#[inline(always)]
pub(crate) fn encode(encoding: ChannelEncoding, values: &[f32], codes: &mut CodePlane) {
    if encoding == ChannelEncoding::Srgb8 {
        return encode_srgb(values, codes);
    }
    with_encoding!(encoding, |known| {
        for (code, value) in codes.iter_mut().zip(values) {
            [*code] = Plain::<1>.encode(known, [*value]);
        }
    });
}
