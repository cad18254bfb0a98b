//! Planes: one channel of several groups of texels, decoded and encoded at once.

use crate::lanes::LANES;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};

/// The groups that are blended at once.
pub(crate) const GROUPS: usize = 8;

/// The texels of the groups.
pub(crate) const TEXELS: usize = GROUPS * LANES;

/// The values of one channel.
pub(crate) type Plane = [f32; TEXELS];

/// The codes of one channel, or words.
pub(crate) type CodePlane = [u32; TEXELS];

/// Gives the values of codes.
#[inline(always)]
pub(crate) fn decode(encoding: ChannelEncoding, codes: &[u32], values: &mut Plane) {
    use ChannelEncoding::{Float16, Float32, Srgb8, Unorm};
    // Known to the compiler.
    macro_rules! run {
        ($encoding:expr) => {
            for (value, code) in values.iter_mut().zip(codes) {
                [*value] = Plain::<1>.decode($encoding, [*code]);
            }
        };
    }
    match encoding {
        Unorm(8) => run!(Unorm(8)),
        Float16 => run!(Float16),
        Float32 => run!(Float32),
        Srgb8 => run!(Srgb8),
        Unorm(bits) if bits <= 16 => run!(Unorm(bits)),
        other => run!(other),
    }
}

/// Gives the codes of values.
#[inline(always)]
pub(crate) fn encode(encoding: ChannelEncoding, values: &[f32], codes: &mut CodePlane) {
    use ChannelEncoding::{Float16, Float32, Srgb8, Unorm};
    macro_rules! run {
        ($encoding:expr) => {
            for (code, value) in codes.iter_mut().zip(values) {
                [*code] = Plain::<1>.encode($encoding, [*value]);
            }
        };
    }
    match encoding {
        Unorm(8) => run!(Unorm(8)),
        Float16 => run!(Float16),
        Float32 => run!(Float32),
        Srgb8 => run!(Srgb8),
        Unorm(bits) if bits <= 16 => run!(Unorm(bits)),
        other => run!(other),
    }
}
