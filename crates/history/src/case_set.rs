//! Sets of cases, with one bit per case number.

/// A set of cases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CaseSet {
    /// Bit `n`, counted over all bytes, is case `n + 1`. The last byte is not zero.
    bits: Vec<u8>,
}

impl CaseSet {
    /// Returns the set of these numbers, which must be above zero.
    pub(crate) fn new(cases: impl IntoIterator<Item = u32>) -> Self {
        let mut bits = Vec::new();
        for case in cases {
            let bit = case.saturating_sub(1) as usize;
            if bits.len() <= bit / 8 {
                bits.resize(bit / 8 + 1, 0);
            }
            bits[bit / 8] |= 1 << (bit % 8);
        }
        Self { bits }
    }

    /// Returns the set that the stored bytes describe.
    pub(crate) fn from_bytes(bits: Vec<u8>) -> Self {
        Self { bits }
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bits
    }

    /// Returns true if the case is in the set.
    pub(crate) fn contains(&self, case: u32) -> bool {
        let bit = case.wrapping_sub(1) as usize;
        let byte = self.bits.get(bit / 8);
        byte.is_some_and(|byte| byte >> (bit % 8) & 1 == 1)
    }

    /// Returns the numbers, ascending.
    pub(crate) fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        let bytes = self.bits.iter().zip(0u32..);
        bytes.flat_map(|(byte, index)| {
            let in_byte = (0..8).filter(move |bit| byte >> bit & 1 == 1);
            in_byte.map(move |bit| index * 8 + bit + 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn a_set_holds_exactly_its_cases(cases in prop::collection::btree_set(1u32..5000, 0..300)) {
            let set = CaseSet::new(cases.iter().copied());
            prop_assert_eq!(&set.iter().collect::<BTreeSet<u32>>(), &cases);
            for case in 0..5010 {
                prop_assert_eq!(set.contains(case), cases.contains(&case));
            }
            prop_assert_eq!(CaseSet::from_bytes(set.bytes().to_vec()), set);
        }
    }
}
