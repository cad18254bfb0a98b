//! Textures and renderbuffers, each with a framebuffer.

use crate::codes;
use crate::context::{Context, refused};
use crate::format::{GlFormat, gl_format};
use etalon_backend::BackendError;
use etalon_frame::{Requirement, TextureFormat};
use glow::HasContext;
use std::cell::Cell;

/// The use of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SurfaceKind {
    /// A scene's attachment with this many samples per texel.
    Attachment(TextureFormat, u32),
    /// The target of read-back shaders: four 32-bit unsigned integers per texel.
    Fetched,
}

impl SurfaceKind {
    fn gl(self) -> Result<GlFormat, BackendError> {
        match self {
            Self::Attachment(format, _) => {
                gl_format(format).ok_or(BackendError::NotSupported(Requirement::Format(format)))
            }
            Self::Fetched => Ok(GlFormat {
                internal: glow::RGBA32UI,
                format: glow::RGBA_INTEGER,
                kind: glow::UNSIGNED_INT,
                attachment: glow::COLOR_ATTACHMENT0,
            }),
        }
    }

    fn samples(self) -> u32 {
        match self {
            Self::Attachment(_, samples) => samples,
            Self::Fetched => 1,
        }
    }

    /// Returns the approximate size of a texel.
    fn bytes(self) -> u64 {
        match self {
            Self::Attachment(format, samples) if format.is_color() => {
                codes::texel_bytes(format) as u64 * u64::from(samples)
            }
            Self::Attachment(_, samples) => 8 * u64::from(samples),
            Self::Fetched => 16,
        }
    }
}

/// The storage of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Storage {
    /// A texture and its target.
    Texture(glow::Texture, u32),
    /// A renderbuffer, if textures of the format do not exist.
    Renderbuffer(glow::Renderbuffer),
}

/// A texture or renderbuffer with a framebuffer. Contents of a new one are undefined.
#[derive(Debug)]
pub(crate) struct Surface {
    pub(crate) storage: Storage,
    pub(crate) framebuffer: glow::Framebuffer,
    status: u32,
    pub(crate) attachment: u32,
    pub(crate) kind: SurfaceKind,
    pub(crate) size: [u32; 2],
    /// A unique number.
    pub(crate) id: u64,
}

thread_local! {
    static NEXT_ID: Cell<u64> = const { Cell::new(0) };
}

impl Surface {
    /// Creates a surface. After an error its parts are deleted with the context.
    pub(crate) fn new(
        context: &Context,
        kind: SurfaceKind,
        size: [u32; 2],
    ) -> Result<Self, BackendError> {
        let format = kind.gl()?;
        let samples = kind.samples();
        let stencil_only = matches!(kind, SurfaceKind::Attachment(TextureFormat::Stencil8, _));
        // A shader reads stencil in ES and if multisampled, which takes a texture.
        let fetched = (context.caps.es || samples > 1) && context.caps.stencil_textures;
        let storage = if stencil_only && !fetched {
            renderbuffer(context, format, size)?
        } else if samples > 1 {
            multisample_texture(context, format, size, samples)?
        } else {
            texture(context, format, size)?
        };
        let (framebuffer, status) = framebuffer(context, &[(storage, format.attachment)])?;
        let id = NEXT_ID.with(|next| next.replace(next.get() + 1));
        Ok(Self {
            storage,
            framebuffer,
            status,
            attachment: format.attachment,
            kind,
            size,
            id,
        })
    }

    /// Returns true if the surface alone is a complete framebuffer.
    pub(crate) fn is_complete(&self) -> bool {
        self.status == glow::FRAMEBUFFER_COMPLETE
    }

    /// Returns the texture; `None` for a renderbuffer.
    pub(crate) fn texture(&self) -> Option<glow::Texture> {
        match self.storage {
            Storage::Texture(texture, _) => Some(texture),
            Storage::Renderbuffer(_) => None,
        }
    }

    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    pub(crate) fn samples(&self) -> u32 {
        self.kind.samples()
    }

    pub(crate) fn bytes(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1]) * self.kind.bytes()
    }

    /// Deletes the surface.
    pub(crate) fn delete(self, context: &Context) {
        let gl = &context.gl;
        // SAFETY: the context is current and the objects are its own.
        unsafe {
            gl.delete_framebuffer(self.framebuffer);
            match self.storage {
                Storage::Texture(texture, _) => gl.delete_texture(texture),
                Storage::Renderbuffer(buffer) => gl.delete_renderbuffer(buffer),
            }
        }
    }
}

fn renderbuffer(
    context: &Context,
    format: GlFormat,
    [width, height]: [u32; 2],
) -> Result<Storage, BackendError> {
    let gl = &context.gl;
    let (width, height) = (width as i32, height as i32);
    // SAFETY: the context is current.
    unsafe {
        let buffer = gl
            .create_renderbuffer()
            .map_err(|e| refused("a renderbuffer", e))?;
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
        gl.renderbuffer_storage(glow::RENDERBUFFER, format.internal, width, height);
        Ok(Storage::Renderbuffer(buffer))
    }
}

fn texture(
    context: &Context,
    format: GlFormat,
    [width, height]: [u32; 2],
) -> Result<Storage, BackendError> {
    let gl = &context.gl;
    let target = glow::TEXTURE_2D;
    // SAFETY: the context is current; no client memory is read.
    unsafe {
        let texture = gl.create_texture().map_err(|e| refused("a texture", e))?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(target, Some(texture));
        let set = |name, value: u32| gl.tex_parameter_i32(target, name, value as i32);
        // Fetches require a complete texture, even if they do not use its filter.
        set(glow::TEXTURE_MAX_LEVEL, 0);
        set(glow::TEXTURE_MIN_FILTER, glow::NEAREST);
        set(glow::TEXTURE_MAG_FILTER, glow::NEAREST);
        set(glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE);
        set(glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE);
        gl.tex_image_2d(
            target,
            0,
            format.internal as i32,
            width as i32,
            height as i32,
            0,
            format.format,
            format.kind,
            glow::PixelUnpackData::Slice(None),
        );
        Ok(Storage::Texture(texture, target))
    }
}

fn multisample_texture(
    context: &Context,
    format: GlFormat,
    [width, height]: [u32; 2],
    samples: u32,
) -> Result<Storage, BackendError> {
    let gl = &context.gl;
    let target = glow::TEXTURE_2D_MULTISAMPLE;
    let (samples, width, height) = (samples as i32, width as i32, height as i32);
    let internal = format.internal;
    // SAFETY: the context is current. Multisampling is offered from ES 3.1 and OpenGL 3.3 on,
    // which have these entry points.
    unsafe {
        let texture = gl.create_texture().map_err(|e| refused("a texture", e))?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(target, Some(texture));
        // The same sample positions for every texel and format.
        if context.caps.es {
            gl.tex_storage_2d_multisample(target, samples, internal, width, height, true);
        } else {
            let internal = internal as i32;
            gl.tex_image_2d_multisample(target, samples, internal, width, height, true);
        }
        Ok(Storage::Texture(texture, target))
    }
}

/// Replaces the contents of a single-sample colour texture. `bytes` covers it.
pub(crate) fn upload(context: &Context, format: TextureFormat, surface: &Surface, bytes: &[u8]) {
    let gl = &context.gl;
    let Some(words) = gl_format(format) else {
        return;
    };
    let size = surface.size();
    // SAFETY: the context is current, rows are packed tightly (`state::reset`), and the caller has
    // counted the bytes.
    unsafe {
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, surface.texture());
        gl.tex_sub_image_2d(
            glow::TEXTURE_2D,
            0,
            0,
            0,
            size[0] as i32,
            size[1] as i32,
            words.format,
            words.kind,
            glow::PixelUnpackData::Slice(Some(bytes)),
        );
    }
}

/// Creates a framebuffer, leaves it bound, and returns its status.
pub(crate) fn framebuffer(
    context: &Context,
    attachments: &[(Storage, u32)],
) -> Result<(glow::Framebuffer, u32), BackendError> {
    let gl = &context.gl;
    // SAFETY: the context is current and the attachments are its own.
    unsafe {
        let framebuffer = gl
            .create_framebuffer()
            .map_err(|e| refused("a framebuffer", e))?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        let mut buffers = Vec::new();
        for (storage, point) in attachments {
            match storage {
                Storage::Texture(texture, target) => {
                    gl.framebuffer_texture_2d(glow::FRAMEBUFFER, *point, *target, Some(*texture), 0)
                }
                Storage::Renderbuffer(buffer) => gl.framebuffer_renderbuffer(
                    glow::FRAMEBUFFER,
                    *point,
                    glow::RENDERBUFFER,
                    Some(*buffer),
                ),
            }
            let depth_stencil = [
                glow::DEPTH_ATTACHMENT,
                glow::STENCIL_ATTACHMENT,
                glow::DEPTH_STENCIL_ATTACHMENT,
            ];
            if !depth_stencil.contains(point) {
                buffers.push(*point);
            }
        }
        let read = buffers.first().copied().unwrap_or(glow::NONE);
        if buffers.is_empty() {
            buffers.push(glow::NONE);
        }
        gl.draw_buffers(&buffers);
        gl.read_buffer(read);
        let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
        Ok((framebuffer, status))
    }
}
