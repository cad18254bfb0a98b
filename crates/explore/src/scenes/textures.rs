//! Textures that the shaders of random scenes fetch from.

use super::Maker;
use super::palette::Palette;
use serde_json::{Value, json};

impl Maker<'_> {
    /// Adds a texture of colours and returns its name.
    pub(super) fn texture(&mut self, name: &str) -> String {
        if !self.attachments.contains_key(name) {
            let texels = self.texels(&mut |maker| maker.texel());
            let format = match self.palette {
                Palette::Normalized => "rgba8unorm",
                _ => "rgba32float",
            };
            let texture = json!({ "format": format, "size": self.size, "texels": texels });
            self.attachments.insert(name.to_owned(), texture);
        }
        name.to_owned()
    }

    /// Adds a texture of sample masks, which are integers, and returns its name.
    pub(super) fn masks(&mut self) -> String {
        self.numbers("masks", &mut |maker| {
            f64::from(maker.choices.of(&[0xf, 0, 1, 5, 10, 8, 0xfffe]))
        })
    }

    /// Adds a texture of stencil references, many of them equal to the scene's in the bits that count, and
    /// returns its name.
    pub(super) fn references(&mut self) -> String {
        self.numbers("references", &mut |maker| {
            let other = maker.choices.below(256);
            let reference = maker.reference;
            let low = maker
                .choices
                .of(&[reference, reference, reference + 1, other]);
            f64::from(low) + f64::from(maker.choices.of(&[0, 0, 256, -256, 768]))
        })
    }

    /// Adds a texture with numbers in red and alpha, written depths in green, and 0 or 1 in blue.
    fn numbers(&mut self, name: &str, number: &mut dyn FnMut(&mut Self) -> f64) -> String {
        if !self.attachments.contains_key(name) {
            let texels = self.texels(&mut |maker| {
                let (red, alpha) = (number(maker), number(maker));
                let blue = f64::from(maker.choices.below(4).min(1));
                let alpha = if name == "masks" { blue } else { alpha };
                json!([red, maker.depth(), blue, alpha])
            });
            let texture = json!({ "format": "rgba32float", "size": self.size, "texels": texels });
            self.attachments.insert(name.to_owned(), texture);
        }
        name.to_owned()
    }

    /// Returns texels that are the same in all rows or in all columns.
    fn texels(&mut self, texel: &mut dyn FnMut(&mut Self) -> Value) -> Value {
        let [w, h] = self.size;
        let (kind, count) = self.choices.of(&[("columns", w), ("rows", h)]);
        let some: Vec<Value> = (0..count.min(6)).map(|_| texel(self)).collect();
        let values: Vec<&Value> = some.iter().cycle().take(count as usize).collect();
        json!({ "kind": kind, "values": values })
    }

    /// Returns a texel of a texture of colours: codes of normalized formats.
    fn texel(&mut self) -> Value {
        if self.palette != Palette::Normalized {
            return self.color();
        }
        let mut texel = [0; 4].map(|_| self.choices.of(&[0, 255, 64, 96, 159, 191, 1, 254]));
        if self.whole_alpha {
            texel[3] = texel[3] / 128 * 255;
        }
        json!(texel)
    }
}
