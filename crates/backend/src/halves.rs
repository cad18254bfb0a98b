//! The parts in which an image is read, if its path reads it in parts.

/// Returns the offset and length of two unequal parts of a side, or of the whole side if it is one texel.
pub fn halves(side: u32) -> Vec<(u32, u32)> {
    match side * 2 / 5 {
        0 => vec![(0, side)],
        first => vec![(0, first), (first, side - first)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_parts_cover_a_whole_side() {
        assert_eq!(halves(1), [(0, 1)]);
        assert_eq!(halves(2), [(0, 2)]);
        assert_eq!(halves(5), [(0, 2), (2, 3)]);
        assert_eq!(halves(16), [(0, 6), (6, 10)]);
    }
}
