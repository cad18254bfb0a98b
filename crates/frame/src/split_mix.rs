//! Pseudo-random numbers that are the same in every release.

/// SplitMix64 (Steele, Lea, Flood 2014). Scenes and cases are made from its numbers, so they must never
/// change.
#[derive(Clone, Debug)]
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// Returns the next number.
    pub fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.0)
    }
}

/// Mixes a number so that every bit of the result depends on every bit of the input.
pub fn mix(number: u64) -> u64 {
    let mut z = number;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected numbers are the output of the authors' code for the seed 1234567.
    #[test]
    fn random_numbers_are_those_of_the_authors() {
        let mut random = SplitMix64(1_234_567);
        let rolled: Vec<u64> = (0..3).map(|_| random.roll()).collect();
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        assert_eq!(rolled, expected);
    }
}
