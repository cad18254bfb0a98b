//! Faults of reading back.
//!
//! A backend applies a fault to every image that its read path returns, so that nothing inside the backend
//! bypasses it. The fault simulates a driver whose read-back is broken.

use etalon_frame::ChannelEncoding;
use serde::{Deserialize, Serialize};

/// A planted fault of reading back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReadFault {
    /// Every code differs by one: its lowest bit is flipped.
    OffByOne,
    /// The texels of one block of 2×2 have all their bits flipped.
    WrongBlock,
    /// The first channel of every texel is 0.
    ZeroChannel,
    /// The first two samples of every texel are exchanged.
    SwappedSamples,
}

/// The first row and column of the block.
const BLOCK: u32 = 1;

impl ReadFault {
    /// Changes the codes of an image of this size, which are ordered by texel, sample and channel.
    pub fn apply(
        self,
        codes: &mut [u32],
        size: [u32; 2],
        samples: u32,
        channels: &[ChannelEncoding],
    ) {
        let sample = channels.len().max(1);
        let texel = sample * samples as usize;
        let width = size[0] as usize;
        match self {
            Self::OffByOne => codes.iter_mut().for_each(|code| *code ^= 1),
            Self::ZeroChannel => codes.iter_mut().step_by(sample).for_each(|code| *code = 0),
            Self::SwappedSamples if samples > 1 => {
                for texel in codes.chunks_exact_mut(texel) {
                    let (first, others) = texel.split_at_mut(sample);
                    first.swap_with_slice(&mut others[..sample]);
                }
            }
            Self::SwappedSamples => {}
            Self::WrongBlock => {
                for (number, texel) in codes.chunks_exact_mut(texel).enumerate() {
                    let (x, y) = (number % width.max(1), number / width.max(1));
                    let inside = |v: usize| (v as u32).wrapping_sub(BLOCK) < 2;
                    if inside(x) && inside(y) {
                        for (code, encoding) in texel.iter_mut().zip(channels.iter().cycle()) {
                            *code ^= encoding.mask();
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the codes of an image before and after a fault: 3×3 texels with two samples of two 8-bit
    /// channels, all codes different.
    fn changed(fault: ReadFault) -> (Vec<u32>, Vec<u32>) {
        let before: Vec<u32> = (2..38).collect();
        let mut after = before.clone();
        fault.apply(&mut after, [3, 3], 2, &[ChannelEncoding::Unorm(8); 2]);
        (before, after)
    }

    #[test]
    fn each_fault_changes_what_it_names() {
        let (before, after) = changed(ReadFault::OffByOne);
        assert!(before.iter().zip(&after).all(|(b, a)| b.abs_diff(*a) == 1));
        let (before, after) = changed(ReadFault::ZeroChannel);
        for (number, (b, a)) in before.iter().zip(&after).enumerate() {
            assert_eq!(*a, if number % 2 == 0 { 0 } else { *b });
        }
        let (before, after) = changed(ReadFault::SwappedSamples);
        for (b, a) in before.chunks(4).zip(after.chunks(4)) {
            assert_eq!(a, [b[2], b[3], b[0], b[1]]);
        }
        let (before, after) = changed(ReadFault::WrongBlock);
        for (number, (b, a)) in before.chunks(4).zip(after.chunks(4)).enumerate() {
            let wrong = number % 3 > 0 && number / 3 > 0;
            let flipped: Vec<u32> = b.iter().map(|code| code ^ 0xff).collect();
            assert_eq!(a, if wrong { &flipped } else { b }, "texel {number}");
        }
    }

    #[test]
    fn one_sample_cannot_be_exchanged() {
        let mut codes = [1, 2, 3, 4];
        let channels = [ChannelEncoding::Float32; 2];
        ReadFault::SwappedSamples.apply(&mut codes, [2, 1], 1, &channels);
        assert_eq!(codes, [1, 2, 3, 4]);
    }
}
