//! Attachments of random scenes.

use super::Maker;
use super::palette::Palette;
use etalon_frame::{ChannelEncoding, TextureFormat};
use serde_json::{Value, json};

impl Maker<'_> {
    /// Chooses the formats of `count` colour attachments, and a palette that suits all of them.
    pub(super) fn color_formats(&mut self, count: u32, logic: bool) -> Vec<TextureFormat> {
        let common = TextureFormat::Rgba8Unorm;
        let usable: Vec<TextureFormat> = self.space.color.clone();
        let formats: Vec<TextureFormat> = (0..count)
            .map(|_| {
                let fits = |f: &TextureFormat| count == 1 || !f.is_integer();
                let list: Vec<_> = usable.iter().copied().filter(fits).collect();
                if self.choices.once_in(2) && !list.is_empty() {
                    self.choices.of(&list)
                } else {
                    common
                }
            })
            .collect();
        let channels = |holds: &dyn Fn(&ChannelEncoding) -> bool| {
            formats.iter().any(|f| f.color_channels().iter().any(holds))
        };
        self.palette = if formats.iter().any(|f| f.is_integer()) {
            Palette::Integer
        } else if channels(&|e| e.is_float()) {
            Palette::Float
        } else if logic {
            Palette::Bits
        } else if channels(&|e| matches!(e, ChannelEncoding::Snorm(_))) {
            Palette::Signed
        } else {
            Palette::Normalized
        };
        // With one or two bits of alpha, values in between could legally round to different codes, and alpha
        // as a factor would carry the difference into the colours.
        let few = |f: &TextureFormat| {
            f.color_channels()
                .get(3)
                .is_some_and(|alpha| alpha.mask() <= 3)
        };
        self.whole_alpha = formats.iter().any(few);
        for format in &formats {
            self.choices.note("color", format.name());
        }
        formats
    }

    /// Adds a colour attachment.
    pub(super) fn add_color(&mut self, name: &str, format: TextureFormat, samples: u32) {
        let mut attachment = json!({ "format": format.name(), "size": self.size });
        if samples > 1 {
            attachment["samples"] = json!(samples);
        }
        if samples == 1 && self.choices.flag("uploaded", 8) {
            attachment["texels"] = json!({ "kind": "codes" });
        } else {
            attachment["clear"] = self.color();
        }
        self.attachments.insert(name.to_owned(), attachment);
    }

    /// Adds an attachment of depth, stencil or both.
    pub(super) fn add_depth_stencil(&mut self, name: &str, format: TextureFormat, samples: u32) {
        let mut attachment = json!({ "format": format.name(), "size": self.size });
        if samples > 1 {
            attachment["samples"] = json!(samples);
        }
        let depth = self.choices.of(&[1.0, 0.0, 0.5]);
        let stencil = self.stored_stencil();
        attachment["clear"] = match (format.has_depth(), format.has_stencil()) {
            (true, true) => json!({ "depth": depth, "stencil": stencil }),
            (true, false) => json!(depth),
            _ => json!(stencil),
        };
        self.attachments.insert(name.to_owned(), attachment);
    }

    /// Returns a stored stencil value, often equal or close to the reference of the draws.
    pub(super) fn stored_stencil(&mut self) -> u32 {
        let reference = self.reference;
        let other = self.choices.below(256);
        self.choices.of(&[0, reference, reference + 1, 255, other])
    }

    /// Returns a depth and stencil format, if the pass has such an attachment.
    pub(super) fn depth_stencil_format(&mut self) -> Option<TextureFormat> {
        let none = self.choices.once_in(5);
        if none || self.space.depth_stencil.is_empty() {
            return None;
        }
        let format = self.choices.of(&self.space.depth_stencil);
        self.choices.note("depth_stencil", format.name());
        Some(format)
    }

    /// Returns a clear value for a colour attachment.
    pub(super) fn cleared_color(&mut self) -> Value {
        self.color()
    }
}
