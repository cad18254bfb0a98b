//! Colours and depths of random scenes.

use super::Maker;
use serde_json::{Value, json};

/// The colours of a scene, of which few codes are legal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Palette {
    /// Sums of powers of two, of which no multiple by `2^b - 1` is nearly an integer.
    Normalized,
    /// The same with negative values.
    Signed,
    /// Values between two codes that differ in the last bit alone, at 8 and at 10 bits.
    Bits,
    /// Exact in floats, as are their products; few differences are nearly 0.
    Float,
    /// Whole numbers.
    Integer,
}

impl Palette {
    fn values(self) -> &'static [f64] {
        match self {
            Self::Normalized => &[0.0, 1.0, 0.25, 0.375, 0.625, 0.75],
            Self::Signed => &[0.0, 1.0, -1.0, 0.25, -0.375, 0.625, -0.75],
            Self::Bits => &[0.0, 1.0, 0.11, 0.3, 0.62, 0.81],
            Self::Float => &[0.0, 1.0, 0.4375, 0.8125, 1.375, 2.125],
            Self::Integer => &[0.0, 1.0, 2.0, 37.0, 85.0, 170.0, 254.0, 255.0],
        }
    }
}

impl Maker<'_> {
    /// Channels of 0, 1 and values between.
    pub(super) fn color(&mut self) -> Value {
        let values = self.palette.values();
        let mut color = [0; 4].map(|_| self.choices.of(values));
        // Beyond the range, and clamped where the format is normalized.
        if self.palette == Palette::Normalized && self.choices.once_in(12) {
            color[self.choices.below(4) as usize] = self.choices.of(&[1.5, -0.5]);
        }
        if self.whole_alpha {
            color[3] = f64::from(u8::from(color[3] > 0.5));
        }
        json!(color)
    }

    /// A written depth: two of them are the same or far apart.
    pub(super) fn depth(&mut self) -> f64 {
        self.choices
            .of(&[0.0, 1.0, 0.0, 0.21, 0.4, 0.62, 0.83, 1.0])
    }

    /// A clip-space depth, never near a plane that clips.
    pub(super) fn vertex_depth(&mut self) -> f64 {
        match self.extra("beyond the planes") {
            true => self.choices.of(&[0.3, -0.75, 1.75, 0.7]),
            false => self.choices.of(&[0.0, 0.17, 0.37, 0.57, 0.77, 0.97]),
        }
    }
}
