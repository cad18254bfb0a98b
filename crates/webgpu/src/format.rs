//! WebGPU's texture formats.

use etalon_frame::{Requirement, TextureFormat};
use serde::{Deserialize, Serialize};

/// The format of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum GpuFormat {
    /// `r32uint`, of textures between an attachment and a buffer.
    #[serde(rename = "r32uint")]
    R32Uint,
    /// `rgba32uint`, of textures between an attachment and a buffer.
    #[serde(rename = "rgba32uint")]
    Rgba32Uint,
    /// The format of an attachment, which WebGPU has.
    #[serde(untagged)]
    Attachment(TextureFormat),
}

impl GpuFormat {
    /// Returns the format of an attachment.
    ///
    /// # Errors
    /// If WebGPU lacks it.
    pub fn of(format: TextureFormat) -> Result<Self, Requirement> {
        if is_known(format) {
            Ok(Self::Attachment(format))
        } else {
            Err(Requirement::Format(format))
        }
    }

    /// Returns the name (WebGPU: GPUTextureFormat).
    pub fn name(self) -> &'static str {
        match self {
            Self::Attachment(format) => format.name(),
            Self::R32Uint => "r32uint",
            Self::Rgba32Uint => "rgba32uint",
        }
    }

    /// Returns the format without sRGB conversion whose texels are the codes of this one, if this one
    /// converts.
    pub(crate) fn without_srgb(self) -> Option<Self> {
        match self {
            Self::Attachment(TextureFormat::Rgba8UnormSrgb) => {
                Some(Self::Attachment(TextureFormat::Rgba8Unorm))
            }
            Self::Attachment(TextureFormat::Bgra8UnormSrgb) => {
                Some(Self::Attachment(TextureFormat::Bgra8Unorm))
            }
            _ => None,
        }
    }

    /// Returns the format with the same codes and the opposite sRGB conversion, or `None` if WebGPU has none.
    pub(crate) fn other_srgb(self) -> Option<Self> {
        match self {
            Self::Attachment(TextureFormat::Rgba8Unorm) => {
                Some(Self::Attachment(TextureFormat::Rgba8UnormSrgb))
            }
            Self::Attachment(TextureFormat::Bgra8Unorm) => {
                Some(Self::Attachment(TextureFormat::Bgra8UnormSrgb))
            }
            _ => self.without_srgb(),
        }
    }

    /// Returns true if the format has depth.
    pub(crate) fn has_depth(self) -> bool {
        matches!(self, Self::Attachment(format) if format.has_depth())
    }
}

/// Returns true if WebGPU has a format.
pub fn is_known(format: TextureFormat) -> bool {
    !matches!(
        format,
        TextureFormat::B5g6r5Unorm | TextureFormat::Bgr5a1Unorm | TextureFormat::Bgra4Unorm
    )
}
