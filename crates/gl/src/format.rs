//! Texel formats: GL's names for them, what the driver really makes of them, and how each is read.

use crate::context::Context;
use crate::read;
use crate::surface::{Surface, SurfaceKind};
use etalon_frame::{ChannelEncoding, FormatSupport, ReadPath, TextureFormat};
use glow::HasContext;
use std::collections::BTreeMap;

const STENCIL_INDEX: u32 = 0x1901;

/// A format in GL's words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GlFormat {
    pub(crate) internal: u32,
    /// Format and type of a client image of it, as far as every version takes them.
    pub(crate) format: u32,
    pub(crate) kind: u32,
    pub(crate) attachment: u32,
}

/// GL's words for a format.
pub(crate) fn gl_format(format: TextureFormat) -> GlFormat {
    use glow::{
        COLOR_ATTACHMENT0, DEPTH_ATTACHMENT, DEPTH_COMPONENT, DEPTH_STENCIL,
        DEPTH_STENCIL_ATTACHMENT, STENCIL_ATTACHMENT,
    };
    let (internal, format, kind, attachment) = match format {
        TextureFormat::Rgba8Unorm => (
            glow::RGBA8,
            glow::RGBA,
            glow::UNSIGNED_BYTE,
            COLOR_ATTACHMENT0,
        ),
        TextureFormat::Rgba32Float => (glow::RGBA32F, glow::RGBA, glow::FLOAT, COLOR_ATTACHMENT0),
        TextureFormat::Depth16Unorm => (
            glow::DEPTH_COMPONENT16,
            DEPTH_COMPONENT,
            glow::UNSIGNED_SHORT,
            DEPTH_ATTACHMENT,
        ),
        TextureFormat::Depth24Plus => (
            glow::DEPTH_COMPONENT24,
            DEPTH_COMPONENT,
            glow::UNSIGNED_INT,
            DEPTH_ATTACHMENT,
        ),
        TextureFormat::Depth24PlusStencil8 => (
            glow::DEPTH24_STENCIL8,
            DEPTH_STENCIL,
            glow::UNSIGNED_INT_24_8,
            DEPTH_STENCIL_ATTACHMENT,
        ),
        TextureFormat::Depth32Float => (
            glow::DEPTH_COMPONENT32F,
            DEPTH_COMPONENT,
            glow::FLOAT,
            DEPTH_ATTACHMENT,
        ),
        TextureFormat::Depth32FloatStencil8 => (
            glow::DEPTH32F_STENCIL8,
            DEPTH_STENCIL,
            glow::FLOAT_32_UNSIGNED_INT_24_8_REV,
            DEPTH_STENCIL_ATTACHMENT,
        ),
        TextureFormat::Stencil8 => (
            glow::STENCIL_INDEX8,
            STENCIL_INDEX,
            glow::UNSIGNED_BYTE,
            STENCIL_ATTACHMENT,
        ),
    };
    GlFormat {
        internal,
        format,
        kind,
        attachment,
    }
}

/// How an attachment's codes reach the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReadPlan {
    /// `glReadPixels` of four bytes a texel.
    Bytes,
    /// `glReadPixels` of four floats a texel.
    Floats,
    /// `glReadPixels` of 16-bit codes.
    Depth16,
    /// `glReadPixels` of 32-bit integers, whose upper 24 bits are the code.
    Depth24,
    /// `glReadPixels` of floats.
    DepthFloat,
    /// `glReadPixels` of codes and stencil, packed.
    Depth24Stencil8,
    /// `glReadPixels` of floats and stencil, packed.
    DepthFloatStencil8,
    /// `glReadPixels` of stencil values.
    Stencil,
    /// A shader fetches depth, stencil or both.
    Shader {
        /// Depth is fetched.
        depth: bool,
        /// How stencil is read.
        stencil: ShaderStencil,
    },
}

/// How stencil is read where depth is read by a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShaderStencil {
    /// There is none.
    None,
    /// By `glReadPixels`.
    Copy,
    /// By a shader as well.
    Shader,
}

/// What the driver does with a format.
#[derive(Clone, Debug)]
pub(crate) struct Support {
    pub(crate) limits: FormatSupport,
    pub(crate) read: ReadPlan,
}

/// Tries every format.
pub(crate) fn probe(context: &Context) -> BTreeMap<TextureFormat, Support> {
    let mut result = BTreeMap::new();
    for format in TextureFormat::ALL {
        let support = probe_one(context, format);
        // A refused format may leave errors behind, which are no news to anybody.
        let clean = context.check("probing formats").is_ok();
        if let (Some(support), true) = (support, clean) {
            result.insert(format, support);
        }
    }
    result
}

fn probe_one(context: &Context, format: TextureFormat) -> Option<Support> {
    let size = [64, 64];
    let surface = Surface::new(context, SurfaceKind::Attachment(format), size).ok()?;
    let support = examine(context, format, &surface);
    surface.delete(context);
    support
}

fn examine(context: &Context, format: TextureFormat, surface: &Surface) -> Option<Support> {
    let done = |depth, read| {
        let path = match read {
            ReadPlan::Shader { depth: true, .. } => ReadPath::Shader,
            _ => ReadPath::Copy,
        };
        Some(Support {
            limits: FormatSupport {
                samples: vec![1],
                depth,
                read: path,
            },
            read,
        })
    };
    if format == TextureFormat::Rgba32Float {
        // A source of uploaded values: drawing to it may be denied.
        return done(Vec::new(), ReadPlan::Floats);
    }
    if !surface.is_complete() {
        return None;
    }
    if format == TextureFormat::Rgba8Unorm {
        return done(Vec::new(), ReadPlan::Bytes);
    }
    if format == TextureFormat::Stencil8 {
        // In ES nothing but a shader reads stencil.
        if !context.caps.es {
            return done(Vec::new(), ReadPlan::Stencil);
        }
        let shader = ReadPlan::Shader {
            depth: false,
            stencil: ShaderStencil::Shader,
        };
        let can = context.caps.stencil_textures && context.caps.stencil_texturing;
        return if can { done(Vec::new(), shader) } else { None };
    }
    let encoding = depth_encoding(context, surface)?;
    if !format.depth_encodings().contains(&encoding) {
        // A driver may store more bits than it was asked for; then the format is not what its
        // name says, and no rule speaks of it.
        return None;
    }
    let read = if context.caps.es {
        by_shader(context, format)?
    } else {
        let plan = copy_plan(format, encoding);
        if read::round_trips(context, surface, format, plan) {
            plan
        } else {
            by_shader(context, format)?
        }
    };
    done(vec![encoding], read)
}

fn by_shader(context: &Context, format: TextureFormat) -> Option<ReadPlan> {
    let stencil = match (format.has_stencil(), context.caps.es) {
        (false, _) => ShaderStencil::None,
        (true, false) => ShaderStencil::Copy,
        (true, true) if context.caps.stencil_texturing => ShaderStencil::Shader,
        (true, true) => return None,
    };
    Some(ReadPlan::Shader {
        depth: true,
        stencil,
    })
}

fn copy_plan(format: TextureFormat, encoding: ChannelEncoding) -> ReadPlan {
    match (encoding, format.has_stencil()) {
        (ChannelEncoding::Unorm(16), _) => ReadPlan::Depth16,
        (ChannelEncoding::Float32, false) => ReadPlan::DepthFloat,
        (ChannelEncoding::Float32, true) => ReadPlan::DepthFloatStencil8,
        (_, false) => ReadPlan::Depth24,
        (_, true) => ReadPlan::Depth24Stencil8,
    }
}

/// What the driver says it stores.
fn depth_encoding(context: &Context, surface: &Surface) -> Option<ChannelEncoding> {
    let gl = &context.gl;
    let query = |name| {
        // SAFETY: the framebuffer is bound and has a depth attachment.
        unsafe {
            gl.get_framebuffer_attachment_parameter_i32(
                glow::FRAMEBUFFER,
                glow::DEPTH_ATTACHMENT,
                name,
            )
        }
    };
    // SAFETY: the framebuffer lives.
    unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer)) };
    let bits = query(glow::FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE);
    let kind = query(glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE);
    match (u32::try_from(kind).ok()?, bits) {
        (glow::UNSIGNED_NORMALIZED, bits) => Some(ChannelEncoding::Unorm(u8::try_from(bits).ok()?)),
        (glow::FLOAT, 32) => Some(ChannelEncoding::Float32),
        _ => None,
    }
}
