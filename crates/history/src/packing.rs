//! Packed lists: the outcomes of an adapter in a run, and frame times.

use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use std::io::{self, Read, Write};

/// Packs numbers: the differences from one to the next, as variable-length integers, deflated.
pub(crate) fn pack(numbers: &[u32]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(numbers.len() * 2);
    let mut before = 0;
    for number in numbers {
        let difference = i64::from(*number) - before;
        before = i64::from(*number);
        // Zigzag encoding: numbers of small magnitude become small unsigned ones.
        let mut left = ((difference << 1) ^ (difference >> 63)) as u64;
        while left >= 0x80 {
            bytes.push(left as u8 | 0x80);
            left >>= 7;
        }
        bytes.push(left as u8);
    }
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&bytes)?;
    encoder.finish()
}

/// Unpacks `count` numbers; `None` if the bytes do not hold exactly this many.
pub(crate) fn unpack(packed: &[u8], count: usize) -> Option<Vec<u32>> {
    // A number takes at most five bytes.
    let most = (count as u64).saturating_mul(5);
    let mut bytes = Vec::new();
    DeflateDecoder::new(packed)
        .take(most + 1)
        .read_to_end(&mut bytes)
        .ok()?;
    let mut numbers = Vec::with_capacity(bytes.len());
    let mut bytes = bytes.into_iter();
    let mut before = 0i64;
    while let Some(first) = bytes.next() {
        let mut left = u64::from(first & 0x7f);
        let mut last = first;
        let mut shift = 7;
        while last & 0x80 != 0 {
            last = bytes.next()?;
            if shift > 28 {
                return None;
            }
            left |= u64::from(last & 0x7f) << shift;
            shift += 7;
        }
        before += (left >> 1) as i64 ^ -((left & 1) as i64);
        numbers.push(u32::try_from(before).ok()?);
    }
    (numbers.len() == count).then_some(numbers)
}

/// Packs times.
pub(crate) fn pack_times(times: &[f32]) -> Vec<u8> {
    times.iter().flat_map(|t| t.to_le_bytes()).collect()
}

/// Unpacks times; `None` if the number of bytes is not a multiple of four.
pub(crate) fn unpack_times(bytes: &[u8]) -> Option<Vec<f32>> {
    let (times, behind) = bytes.as_chunks::<4>();
    let times = times.iter().map(|t| f32::from_le_bytes(*t)).collect();
    behind.is_empty().then_some(times)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn packed_numbers_unpack_equal(numbers in prop::collection::vec(prop_oneof![0u32..50, any::<u32>()], 0..200)) {
            let packed = pack(&numbers).unwrap();
            prop_assert_eq!(unpack(&packed, numbers.len()), Some(numbers.clone()));
            prop_assert_eq!(unpack(&packed, numbers.len() + 1), None);
        }

        #[test]
        fn packed_times_unpack_equal(times in prop::collection::vec(0f32..10.0, 0..50)) {
            prop_assert_eq!(unpack_times(&pack_times(&times)), Some(times));
        }

        #[test]
        fn unpacking_damaged_bytes_does_not_panic(
            bytes in prop::collection::vec(any::<u8>(), 0..100),
            count in 0usize..100,
        ) {
            let _ = unpack(&bytes, count);
        }
    }

    #[test]
    fn equal_numbers_take_almost_nothing() {
        assert!(pack(&[7; 14_000]).unwrap().len() < 100);
        assert_eq!(unpack_times(&[1, 2, 3]), None);
    }
}
