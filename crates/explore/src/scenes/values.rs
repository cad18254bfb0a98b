//! Colours and depths of random scenes.

use super::Maker;
use super::palette::Palette;
use serde_json::{Value, json};

impl Maker<'_> {
    /// Returns a colour with channels of 0, 1 and values between.
    pub(super) fn color(&mut self) -> Value {
        let values = self.palette.values();
        let mut color = [0; 4].map(|_| self.choices.of(values));
        // A value out of range, which normalized formats clamp.
        if self.palette == Palette::Normalized && self.choices.once_in(12) {
            color[self.choices.below(4) as usize] = self.choices.of(&[1.5, -0.5]);
        }
        // Only signed formats keep negative values.
        if self.palette == Palette::Float && self.choices.once_in(6) {
            color[self.choices.below(4) as usize] = self.choices.of(&[-0.4375, -1.375]);
        }
        let is_integer = self.palette == Palette::Integer;
        if self.whole_alpha && (is_integer || !self.choices.once_in(16)) {
            color[3] = f64::from(u8::from(color[3] > 0.5));
        }
        json!(color)
    }

    /// Returns a written depth: any two are usually equal or far apart.
    pub(super) fn depth(&mut self) -> f64 {
        if self.extra("near depths") {
            // Neighbouring 32-bit floats.
            return self.choices.of(&[0.5, 0.500_000_06, 0.499_999_97]);
        }
        self.choices
            .of(&[0.0, 1.0, 0.0, 0.21, 0.4, 0.62, 0.83, 1.0])
    }

    /// Returns a clip-space depth, never close to a clip plane.
    pub(super) fn vertex_depth(&mut self) -> f64 {
        if self.extra("beyond the planes") {
            self.choices.of(&[0.3, -0.75, 1.75, 0.7])
        } else {
            self.choices.of(&[0.0, 0.17, 0.37, 0.57, 0.77, 0.97])
        }
    }
}
