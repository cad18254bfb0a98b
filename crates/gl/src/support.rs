//! The support of formats by a driver, and the way to read each back.

use etalon_frame::FormatSupport;

/// The way in which an attachment's codes are read back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReadPlan {
    /// `glReadPixels` of colours in the format and type of uploads.
    Packed,
    /// `glReadPixels` of four bytes per texel, to which shorter channels are widened.
    Bytes,
    /// `glReadPixels` of four floats per texel.
    Floats,
    /// `glReadPixels` of four unsigned integers per texel.
    Integers,
    /// A shader fetches four floats per texel.
    Fetched,
    /// `glReadPixels` of 16-bit codes.
    Depth16,
    /// `glReadPixels` of 32-bit integers, whose upper 24 bits are the code.
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
        /// The way in which stencil is read.
        stencil: ShaderStencil,
    },
}

/// The way in which stencil is read beside a depth that a shader reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShaderStencil {
    /// No stencil.
    None,
    /// By `glReadPixels`.
    Copy,
    /// By a shader.
    Shader,
}

/// The support of a format by a driver.
#[derive(Clone, Debug)]
pub(crate) struct Support {
    pub(crate) limits: FormatSupport,
    /// For one sample; several are always fetched by a shader.
    pub(crate) read: ReadPlan,
    /// A shader's fetch determines the codes that `read` returns.
    pub(crate) fetched_exactly: bool,
}
