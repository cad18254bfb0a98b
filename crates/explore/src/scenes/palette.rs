//! The colours of a random scene. They are few, and the rules leave few of their codes open.

/// The colours of a scene, for which few codes are legal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Palette {
    /// Sums of powers of two whose multiples by `2^b - 1` are never close to an integer.
    Normalized,
    /// Like `Normalized`, with negative values.
    Signed,
    /// Values between two codes that differ only in the last bit, with 8 and 10 bits.
    Bits,
    /// Values that are exact in floats, as are their products. Few differences are close to 0.
    Float,
    /// Integers.
    Integer,
}

impl Palette {
    /// Returns the values of a channel, the simplest first.
    pub(super) fn values(self) -> &'static [f64] {
        match self {
            Self::Normalized => &[0.0, 1.0, 0.25, 0.375, 0.625, 0.75],
            Self::Signed => &[0.0, 1.0, -1.0, 0.25, -0.375, 0.625, -0.75],
            Self::Bits => &[0.0, 1.0, 0.11, 0.3, 0.62, 0.81],
            Self::Float => &[0.0, 1.0, 0.4375, 0.8125, 1.375, 2.125, 0.984375],
            Self::Integer => &[0.0, 1.0, 2.0, 37.0, 85.0, 170.0, 254.0, 255.0],
        }
    }
}
