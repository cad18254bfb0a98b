//! The judged texels of an image: all of them, or a lattice. Large pictures exist to be timed, and judging
//! one completely would take longer than drawing it.

use etalon_scene::{Attachment, Scene};

/// The texels that are judged. Nothing is computed or asserted for others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Texels {
    /// All texels.
    All,
    /// At most this many texels of each image, on a lattice that is the same for all images of one size. It
    /// reaches every row and column if the number allows it.
    AtMost(u64),
    /// One texel, as column and row.
    One([u32; 2]),
}

/// The judged texels of images of one size: a single one, or all whose column plus five times the row is a
/// multiple of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lattice {
    Step(u64),
    One([u32; 2]),
}

/// The shift of a lattice from one row to the next. It is prime, as are all steps except 1, so that any run
/// of as many lattice rows as the step reaches every column.
const SHEAR: u64 = 5;

impl Texels {
    /// Returns true if all texels are judged.
    pub fn is_all(self) -> bool {
        self == Self::All
    }

    /// Returns the choice for a scene: [`Texels::All`] if the choice would leave out nothing.
    pub(crate) fn simplified_for(self, scene: &Scene) -> Self {
        let is_complete = |a: &Attachment| self.lattice(a.size) == Lattice::ALL;
        if scene.attachments.iter().all(is_complete) {
            Self::All
        } else {
            self
        }
    }

    /// Returns true if a texel of an image of this size is judged.
    pub fn contains(self, size: [u32; 2], x: u32, y: u32) -> bool {
        self.lattice(size).contains(x, y)
    }

    /// Returns the number of judged texels of an image of this size.
    pub fn count(self, size: [u32; 2]) -> u64 {
        self.lattice(size).count(size)
    }

    pub(crate) fn lattice(self, size: [u32; 2]) -> Lattice {
        match self {
            Self::All => Lattice::ALL,
            Self::One(texel) => Lattice::One(texel),
            Self::AtMost(most) => {
                let texels = u64::from(size[0]) * u64::from(size[1]);
                let most = most.max(1);
                if texels <= most {
                    return Lattice::ALL;
                }
                let fits = |step: &u64| Lattice::Step(*step).count(size) <= most;
                let primes = (texels.div_ceil(most)..).filter(|n| is_prime(*n) && *n != SHEAR);
                // A step as large as the number of texels leaves one lattice point, so some step always fits.
                Lattice::Step(primes.into_iter().find(fits).unwrap_or(texels))
            }
        }
    }
}

impl Lattice {
    /// All texels.
    pub(crate) const ALL: Self = Self::Step(1);

    pub(crate) fn contains(self, x: u32, y: u32) -> bool {
        self.first(x, y) == Some(x)
    }

    /// Returns the first judged column of a row at or after `from`.
    pub(crate) fn first(self, from: u32, y: u32) -> Option<u32> {
        match self {
            Self::One([x, row]) => (row == y && x >= from).then_some(x),
            Self::Step(step) => {
                let behind = (u64::from(from) + SHEAR * u64::from(y)) % step;
                let ahead = if behind == 0 { 0 } else { step - behind };
                u32::try_from(u64::from(from) + ahead).ok()
            }
        }
    }

    /// Returns true if a rectangle of left, top, right and bottom, the last two excluded, contains a judged
    /// texel.
    pub(crate) fn meets(self, [left, top, right, bottom]: [u32; 4]) -> bool {
        (top..bottom).any(|y| self.first(left, y).is_some_and(|x| x < right))
    }

    fn count(self, [width, height]: [u32; 2]) -> u64 {
        match self {
            Self::One([x, y]) => u64::from(x < width && y < height),
            Self::Step(1) => u64::from(width) * u64::from(height),
            Self::Step(step) => {
                let of_row = |y| match self.first(0, y) {
                    Some(first) if first < width => u64::from(width - 1 - first) / step + 1,
                    _ => 0,
                };
                (0..height).map(of_row).sum()
            }
        }
    }
}

fn is_prime(n: u64) -> bool {
    n > 1
        && (2..)
            .take_while(|d| d * d <= n)
            .all(|d| !n.is_multiple_of(d))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_meets_every_row_and_column_and_no_more_texels_than_asked() {
        for (size, most) in [
            ([1920, 1080], 4096),
            ([1280, 720], 2000),
            ([128, 128], 1000),
            ([64, 48], 100),
            ([16, 16], 50),
        ] {
            let texels = Texels::AtMost(most);
            let lattice = texels.lattice(size);
            let (mut rows, mut columns) = (vec![0; size[1] as usize], vec![0; size[0] as usize]);
            for y in 0..size[1] {
                for x in 0..size[0] {
                    if lattice.contains(x, y) {
                        rows[y as usize] += 1;
                        columns[x as usize] += 1;
                    }
                }
            }
            let count: u64 = rows.iter().sum();
            assert_eq!(count, texels.count(size), "{size:?}");
            assert!(count <= most && count * 2 > most, "{size:?}: {count}");
            assert!(rows.iter().all(|n| *n > 0), "{size:?}: a row is missed");
            assert!(
                columns.iter().all(|n: &u64| *n > 0),
                "{size:?}: a column is missed"
            );
        }
    }

    #[test]
    fn the_first_column_and_met_rectangles_agree_with_single_texels() {
        for lattice in [Lattice::ALL, Lattice::Step(7), Lattice::One([3, 4])] {
            for (x, y) in (0..12).flat_map(|y| (0..12).map(move |x| (x, y))) {
                let first = (x..100).find(|column| lattice.contains(*column, y));
                assert_eq!(lattice.first(x, y), first, "{lattice:?} ({x}, {y})");
                let (right, bottom) = (x + 2, y + 3);
                let meets = (x..right).any(|x| (y..bottom).any(|y| lattice.contains(x, y)));
                assert_eq!(lattice.meets([x, y, right, bottom]), meets, "{lattice:?}");
            }
        }
    }

    #[test]
    fn small_images_are_looked_at_whole_and_tiny_numbers_keep_their_bound() {
        assert_eq!(Texels::AtMost(256).count([16, 16]), 256);
        assert_eq!(Texels::AtMost(1).count([16, 16]), 1);
        assert_eq!(Texels::AtMost(0).count([16, 16]), 1);
        assert_eq!(Texels::One([3, 4]).count([16, 16]), 1);
        assert!(Texels::One([3, 4]).contains([16, 16], 3, 4));
        assert!(!Texels::One([3, 4]).contains([16, 16], 4, 3));
    }
}
