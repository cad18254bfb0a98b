//! The resolve of colours: the average of a texel's samples.

use super::image::{AREA, Texel};
use crate::lanes::LANES;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};

/// Resolves the planes of a tile. With `same` the first stands for all.
#[inline(always)]
pub(crate) fn resolve(
    channels: &[ChannelEncoding],
    planes: &[Texel],
    samples: usize,
    same: bool,
    resolved: &mut [Texel],
) {
    let share = 1.0 / samples as f32;
    let plane = |sample: usize| &planes[if same { 0 } else { sample * AREA }..][..AREA];
    let (targets, _) = resolved.as_chunks_mut::<LANES>();
    for (at, target) in targets.iter_mut().enumerate() {
        let texels = |sample: usize| &plane(sample)[at * LANES..][..LANES];
        for (c, encoding) in channels.iter().enumerate() {
            let codes = |sample: usize| {
                let mut codes = [0; LANES];
                for (code, texel) in codes.iter_mut().zip(texels(sample)) {
                    *code = u32::from(texel[c]);
                }
                codes
            };
            let new = match encoding {
                // Integers resolve to one sample.
                ChannelEncoding::Uint(_) => codes(0),
                _ => {
                    let mut sum = Plain::<LANES>.decode(*encoding, codes(0));
                    for sample in 1..samples {
                        let value = Plain::<LANES>.decode(*encoding, codes(sample));
                        sum = Plain::<LANES>.add(sum, value);
                    }
                    let average = Plain::<LANES>.mul(sum, [share; LANES]);
                    Plain::<LANES>.encode(*encoding, average)
                }
            };
            for (texel, code) in target.iter_mut().zip(new) {
                texel[c] = code as u8;
            }
        }
    }
}
