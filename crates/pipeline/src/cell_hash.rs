//! A hash of points on an integer grid.

/// Returns a pseudo-random number above 0 and at most 1 for a cell. Only integers are computed, so that every
/// shader has the same bits.
pub fn cell_hash([x, y]: [u32; 2]) -> f32 {
    let mut bits = x.wrapping_mul(0x9e37_79b1);
    bits = (bits ^ (bits >> 15)).wrapping_add(y);
    bits = bits.wrapping_mul(0x85eb_ca6b);
    bits = (bits ^ (bits >> 13)).wrapping_mul(0xc2b2_ae35);
    bits ^= bits >> 16;
    ((bits >> 8) as f32 + 1.0) / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the mean of a function of the hashes of neighbouring cells.
    fn mean(f: impl Fn(f64, f64) -> f64, step: [u32; 2]) -> f64 {
        let hash = |x: u32, y: u32| f64::from(cell_hash([x, y]));
        let cells = (0..128).flat_map(|y| (0..128).map(move |x| (x, y)));
        let values = cells.map(|(x, y)| f(hash(x, y), hash(x + step[0], y + step[1])));
        values.sum::<f64>() / (128.0 * 128.0)
    }

    #[test]
    fn hashes_are_uniform_and_neighbours_are_independent() {
        for eighth in 1..8 {
            let limit = f64::from(eighth) / 8.0;
            let share = mean(|a, _| f64::from(u8::from(a <= limit)), [0, 0]);
            // Six standard deviations of the mean of this many numbers.
            assert!(
                (share - limit).abs() < 6.0 * 0.5 / 128.0,
                "{share} of {limit}"
            );
        }
        for step in [[1, 0], [0, 1], [1, 1], [7, 0], [0, 256], [256, 256]] {
            let covariance = mean(|a, b| (a - 0.5) * (b - 0.5), step);
            assert!(
                covariance.abs() < 6.0 / 12.0 / 128.0,
                "{step:?}: {covariance}"
            );
        }
    }

    #[test]
    fn hashes_are_above_0_and_at_most_1() {
        for x in 0..1000 {
            let hash = cell_hash([x, x / 7]);
            assert!(hash > 0.0 && hash <= 1.0, "{hash}");
        }
        assert_eq!(cell_hash([0, 0]), 1.0 / 16_777_216.0);
    }
}
