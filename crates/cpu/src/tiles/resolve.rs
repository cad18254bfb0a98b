//! The resolve of colours: the average of a texel's samples.

use super::image::{AREA, Texel, are_bytes};
use crate::lanes::{Codes, LANES};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};
use fearless_simd::Simd;

/// Returns true if the average of equal samples is their code, for all codes.
fn averages_are_codes(channels: &[ChannelEncoding], samples: usize) -> bool {
    let share = 1.0 / samples as f32;
    let unorm = channels.iter().all(|e| *e == ChannelEncoding::Unorm(8));
    unorm
        && (0..=255).all(|code| {
            let encoding = ChannelEncoding::Unorm(8);
            let [value] = Plain::<1>.decode(encoding, [code]);
            let sum = (1..samples).fold(value, |sum, _| sum + value);
            Plain::<1>.encode(encoding, [sum * share]) == [code]
        })
}

/// Returns the average of the samples of one channel, whose codes a function gives.
#[inline(always)]
fn average(encoding: ChannelEncoding, samples: usize, codes: impl Fn(usize) -> Codes) -> Codes {
    // Integers resolve to one sample.
    if let ChannelEncoding::Uint(_) = encoding {
        return codes(0);
    }
    let mut sum = Plain::<LANES>.decode(encoding, codes(0));
    for sample in 1..samples {
        let value = Plain::<LANES>.decode(encoding, codes(sample));
        sum = Plain::<LANES>.add(sum, value);
    }
    let share = 1.0 / samples as f32;
    let average = Plain::<LANES>.mul(sum, [share; LANES]);
    Plain::<LANES>.encode(encoding, average)
}

/// Resolves the planes of a tile. With `same` the first sample stands for all.
#[inline(never)]
pub(crate) fn resolve<S: Simd>(
    simd: S,
    channels: &[ChannelEncoding],
    planes: &[u32],
    samples: usize,
    same: bool,
    resolved: &mut [u32],
) {
    simd.vectorize(
        #[inline(always)]
        || average_all(channels, planes, samples, same, resolved),
    );
}

#[inline(always)]
fn average_all(
    channels: &[ChannelEncoding],
    planes: &[u32],
    samples: usize,
    same: bool,
    resolved: &mut [u32],
) {
    let bytes = are_bytes(channels);
    if !bytes {
        let words = channels.len();
        for (word, (encoding, target)) in channels
            .iter()
            .zip(resolved.chunks_exact_mut(AREA))
            .enumerate()
        {
            for at in (0..AREA).step_by(LANES) {
                let codes = |sample: usize| {
                    let plane = word + if same { 0 } else { sample * words };
                    let mut codes = [0; LANES];
                    codes.copy_from_slice(&planes[plane * AREA + at..][..LANES]);
                    codes
                };
                target[at..at + LANES].copy_from_slice(&average(*encoding, samples, codes));
            }
        }
        return;
    }
    let known = averages_are_codes(channels, samples);
    let plane = |sample: usize| &planes[if same { 0 } else { sample * AREA }..][..AREA];
    let (targets, _) = resolved.as_chunks_mut::<LANES>();
    for (at, target) in targets.iter_mut().enumerate() {
        let texels = |sample: usize| &plane(sample)[at * LANES..][..LANES];
        let differ = (1..samples).fold(0, |bits, sample| {
            let pairs = texels(0).iter().zip(texels(sample));
            pairs.fold(bits, |bits, (a, b)| bits | (a ^ b))
        });
        if known && differ == 0 {
            target.copy_from_slice(texels(0));
            continue;
        }
        let target: &mut [Texel; LANES] = bytemuck::cast_mut(target);
        for (c, encoding) in channels.iter().enumerate() {
            let codes = |sample: usize| {
                let mut codes = [0; LANES];
                for (code, texel) in codes.iter_mut().zip(texels(sample)) {
                    *code = u32::from(texel.to_ne_bytes()[c]);
                }
                codes
            };
            let new = average(*encoding, samples, codes);
            for (texel, code) in target.iter_mut().zip(new) {
                texel[c] = code as u8;
            }
        }
    }
}
