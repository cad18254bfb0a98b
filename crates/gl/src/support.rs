//! A driver's support for formats, and how each is read back.

use etalon_frame::FormatSupport;

/// The way to read back an attachment's codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReadBackPath {
    /// `glReadPixels` of colours in the format and type of uploads.
    Packed,
    /// `glReadPixels` of four bytes per texel. Shorter channels are widened to bytes.
    Bytes,
    /// `glReadPixels` of four floats per texel.
    Floats,
    /// `glReadPixels` of four unsigned integers per texel.
    Integers,
    /// A shader fetches four floats per texel.
    Fetched,
    /// `glReadPixels` of 16-bit codes.
    Depth16,
    /// `glReadPixels` of 32-bit integers; the upper 24 bits are the code.
    Depth24,
    /// `glReadPixels` of floats.
    DepthFloat,
    /// `glReadPixels` of packed codes and stencil.
    Depth24Stencil8,
    /// `glReadPixels` of packed floats and stencil.
    DepthFloatStencil8,
    /// `glReadPixels` of stencil values.
    Stencil,
    /// A shader fetches depth, stencil or both.
    Shader {
        /// True if depth is fetched.
        depth: bool,
        /// The way to read stencil.
        stencil: ShaderStencil,
    },
}

/// The way to read stencil if a shader reads depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShaderStencil {
    /// No stencil.
    None,
    /// By `glReadPixels`.
    Copy,
    /// By a shader.
    Shader,
}

/// A driver's support for a format.
#[derive(Clone, Debug)]
pub(crate) struct Support {
    pub(crate) limits: FormatSupport,
    /// The way to read one sample. A shader always fetches multisampled attachments.
    pub(crate) read: ReadBackPath,
    /// True if a shader's fetch determines the codes that `read` returns.
    pub(crate) fetched_exactly: bool,
}
