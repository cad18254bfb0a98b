//! The texels of an aspect as bytes, which programs send and files hold.

use crate::codes::{TexelLayout, pack_all, texel_bytes, unpack_all, webgpu_layout};
use etalon_frame::{Aspect, ChannelEncoding, Image, ReadPath, TextureFormat};
use etalon_scene::{Attachment, Scene};
use std::fmt;

/// One aspect of an attachment, and the form of its texels: rows from the top, texels from the left, the samples of a
/// texel after each other. A colour has the little-endian bytes of its format in WebGPU, depth is a 32-bit float,
/// stencil one byte.
#[derive(Clone, Debug)]
pub struct AspectForm {
    /// The attachment's name.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// The attachment's format.
    pub format: TextureFormat,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
}

impl fmt::Display for AspectForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.aspect, self.attachment)
    }
}

impl AspectForm {
    /// Returns all aspects that a scene reads back, depth before stencil.
    pub fn of_scene(scene: &Scene) -> Vec<Self> {
        let read = scene.read.iter().map(|i| &scene.attachments[*i]);
        read.flat_map(Self::of_attachment).collect()
    }

    fn of_attachment(attachment: &Attachment) -> impl Iterator<Item = Self> + '_ {
        let aspects = attachment.format.aspects().iter();
        aspects.map(|aspect| Self {
            attachment: attachment.name.clone(),
            aspect: *aspect,
            format: attachment.format,
            size: attachment.size,
            samples: attachment.samples,
        })
    }

    /// Returns true if this is the aspect of the attachment with this name.
    pub fn is(&self, attachment: &str, aspect: Aspect) -> bool {
        self.attachment == attachment && self.aspect == aspect
    }

    /// Returns the layout of a texel's bytes; empty if WebGPU lacks the format.
    pub fn layout(&self) -> &'static TexelLayout {
        match self.aspect {
            Aspect::Color => webgpu_layout(self.format),
            Aspect::Depth => &[(0, 32)],
            Aspect::Stencil => &[(0, 8)],
        }
    }

    /// Returns the encodings of the channels.
    pub fn channels(&self) -> &'static [ChannelEncoding] {
        match self.aspect {
            Aspect::Color => self.format.color_channels(),
            Aspect::Depth => &[ChannelEncoding::Float32],
            Aspect::Stencil => &[ChannelEncoding::Uint(8)],
        }
    }

    /// Returns the number of samples in all texels.
    pub fn all_samples(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize * self.samples as usize
    }

    /// Returns the number of bytes in all texels.
    pub fn all_bytes(&self) -> usize {
        self.all_samples() * texel_bytes(self.layout())
    }

    /// Returns the image with these texels.
    ///
    /// # Errors
    /// If the number of bytes is wrong.
    pub fn image(&self, bytes: &[u8]) -> Result<Image, String> {
        let layout = self.layout();
        let size = texel_bytes(layout);
        if size == 0 {
            return Err(format!(
                "{self} is {}, which has no bytes in WebGPU",
                self.format
            ));
        }
        if bytes.len() != self.all_bytes() {
            let [width, height] = self.size;
            return Err(format!(
                "{self} has {} bytes, but {width} by {height} texels of {} samples of {size} bytes have {}",
                bytes.len(),
                self.samples,
                self.all_bytes()
            ));
        }
        Ok(Image {
            attachment: self.attachment.clone(),
            aspect: self.aspect,
            size: self.size,
            samples: self.samples,
            channels: self.channels().to_vec(),
            read: match self.aspect {
                Aspect::Depth => read_path(self.format),
                Aspect::Color | Aspect::Stencil => ReadPath::Copy,
            },
            codes: unpack_all(layout, size, bytes),
        })
    }

    /// Returns the bytes of codes, which have these encodings.
    pub fn bytes(&self, encodings: &[ChannelEncoding], codes: &[u32]) -> Vec<u8> {
        match (self.aspect, encodings) {
            (Aspect::Depth, [encoding]) if *encoding != ChannelEncoding::Float32 => {
                let depths = codes.iter().map(|code| {
                    let value = encoding.value_of_order(encoding.order_of_code(*code));
                    (value as f32).to_bits()
                });
                pack_all(self.layout(), &depths.collect::<Vec<_>>())
            }
            _ => pack_all(self.layout(), codes),
        }
    }
}

/// Returns true if texels of a format have bytes.
pub fn has_form(format: TextureFormat) -> bool {
    !format.is_color() || !webgpu_layout(format).is_empty()
}

/// Returns how depths are read: as floats, which are exact only for formats of floats.
pub fn read_path(format: TextureFormat) -> ReadPath {
    use etalon_frame::ChannelEncoding::Float32;
    match format.depth_encodings() {
        [] | [Float32] => ReadPath::Copy,
        _ => ReadPath::Shader,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_format_without_bytes_has_no_image() {
        let form = AspectForm {
            attachment: "color".to_owned(),
            aspect: Aspect::Color,
            format: TextureFormat::B5g6r5Unorm,
            size: [1, 1],
            samples: 1,
        };
        assert!(form.image(&[]).is_err());
        let form = AspectForm {
            format: TextureFormat::Rgba8Unorm,
            ..form
        };
        assert!(form.image(&[]).is_err() && form.image(&[0; 4]).is_ok());
    }
}
