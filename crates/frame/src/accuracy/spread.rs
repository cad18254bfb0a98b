//! The numbers of distances by size, which add up over frames, records and runs.

use serde::{Deserialize, Serialize};

/// The number of ranges: up to half a code, and from each threshold to twice that, up to 2^32 codes.
const RANGES: usize = 34;

/// The numbers of channel values that are not exact, by distance. The first number counts distances up to half a
/// code, each further one those from the previous threshold up to twice that: ½, 1, 2, 4, … codes. So a
/// percentile is known to within a factor of two, however many frames are added. The file form is a list
/// without the zeros at its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<u64>", into = "Vec<u64>")]
pub struct Spread([u64; RANGES]);

impl Default for Spread {
    fn default() -> Self {
        Self([0; RANGES])
    }
}

impl Spread {
    /// Returns true if no distance above 0 was counted.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Counts a distance in codes. A distance of 0 is not counted.
    pub fn count(&mut self, codes: f64) {
        if codes > 0.0 {
            let range = (codes.log2().ceil() + 1.0).clamp(0.0, (RANGES - 1) as f64);
            let count = &mut self.0[range as usize];
            *count = count.saturating_add(1);
        }
    }

    /// Adds the numbers of another frame or record.
    pub fn add(&mut self, other: &Self) {
        for (sum, more) in self.0.iter_mut().zip(other.0) {
            *sum = sum.saturating_add(more);
        }
    }

    /// Returns the least threshold, in codes, that at least this share of all channel values does not exceed.
    /// Values that are not counted are exact.
    pub(super) fn percentile(&self, channels: u64, share: f64) -> f64 {
        let counted = self.0.iter().fold(0_u64, |sum, n| sum.saturating_add(*n));
        let mut within = channels.saturating_sub(counted);
        let needed = channels as f64 * share;
        if within as f64 >= needed {
            return 0.0;
        }
        let ranges = self.0.iter().enumerate();
        let found = ranges.into_iter().find(|(_, n)| {
            within = within.saturating_add(**n);
            within as f64 >= needed
        });
        let range = found.map_or(RANGES - 1, |(range, _)| range);
        (range as f64 - 1.0).exp2()
    }
}

impl From<Spread> for Vec<u64> {
    fn from(spread: Spread) -> Self {
        let counted = spread.0.iter().rposition(|n| *n > 0).map_or(0, |i| i + 1);
        spread.0[..counted].to_vec()
    }
}

impl TryFrom<Vec<u64>> for Spread {
    type Error = String;

    fn try_from(counts: Vec<u64>) -> Result<Self, String> {
        let mut spread = Self::default();
        let Some(ranges) = spread.0.get_mut(..counts.len()) else {
            return Err(format!(
                "{} ranges of distances, but there are {RANGES}",
                counts.len()
            ));
        };
        ranges.copy_from_slice(&counts);
        Ok(spread)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(distances: &[f64]) -> Spread {
        let mut spread = Spread::default();
        distances.iter().for_each(|codes| spread.count(*codes));
        spread
    }

    #[test]
    fn a_distance_is_counted_up_to_the_next_threshold() {
        let counted = spread(&[0.0, 0.01, 0.5, 0.51, 1.0, 1.5, 2.0, 2.1, 4.0]);
        assert_eq!(Vec::from(counted), [2, 2, 2, 2]);
        let far = Vec::from(spread(&[4_294_967_296.0, 1e300]));
        assert_eq!((far.len(), far[RANGES - 1]), (RANGES, 2));
    }

    #[test]
    fn percentiles_of_a_sum_are_those_of_all_distances_together() {
        let (first, second) = (spread(&[0.3; 5]), spread(&[3.0, 100.0]));
        let mut sum = first;
        sum.add(&second);
        assert_eq!(sum, spread(&[0.3, 0.3, 0.3, 0.3, 0.3, 3.0, 100.0]));
        // Of 100 values, 93 are exact.
        let at = |share| sum.percentile(100, share);
        assert_eq!(
            [at(0.93), at(0.98), at(0.99), at(1.0)],
            [0.0, 0.5, 4.0, 128.0]
        );
    }

    #[test]
    fn the_file_form_has_no_zeros_at_its_end_and_no_unknown_range() {
        let text = serde_json::to_string(&spread(&[0.5, 3.0])).unwrap();
        assert_eq!(text, "[1,0,0,1]");
        assert_eq!(
            serde_json::from_str::<Spread>(&text).unwrap(),
            spread(&[0.5, 3.0])
        );
        let long = serde_json::to_string(&vec![1; RANGES + 1]).unwrap();
        let error = serde_json::from_str::<Spread>(&long)
            .unwrap_err()
            .to_string();
        assert!(error.contains("35 ranges"), "{error}");
    }
}
