//! Attachments.

use etalon_frame::TextureFormat;
use serde::{Deserialize, Serialize};

/// A texture that passes draw to or read from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attachment {
    /// Name in the case file, by which images and errors refer to it.
    pub name: String,
    /// The format, which decides the aspects and whether passes bind it as colour or as depth and stencil.
    pub format: TextureFormat,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// The initial contents. Every attachment is initialised before the first pass.
    pub contents: AttachmentContents,
}

/// The initial contents of an attachment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum AttachmentContents {
    /// A colour clear in red, green, blue, alpha, converted by the API.
    Color([f32; 4]),
    /// A depth and stencil clear; a format without depth or stencil ignores that part.
    DepthStencil {
        /// Depth in 0..=1.
        depth: f32,
        /// Stencil.
        stencil: u8,
    },
    /// Uploaded codes, index `(y * width + x) * channels + channel`, row 0 at the top. Only for single-sample
    /// colour.
    Texels(Vec<u32>),
}
