//! Attachments and framebuffers, kept from scene to scene.

use crate::context::{Context, refused};
use crate::format::{GlFormat, gl_format};
use etalon_backend::BackendError;
use etalon_frame::TextureFormat;
use glow::HasContext;
use std::cell::Cell;
use std::collections::HashMap;

/// The most free surfaces, framebuffers and buffers, and bytes of free surfaces, that are kept.
const MAX_FREE: usize = 64;
const MAX_FREE_BYTES: u64 = 64 << 20;
/// The largest buffer that is kept.
const MAX_FREE_BUFFER: usize = 1 << 20;

/// What a surface is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SurfaceKind {
    /// A scene's attachment.
    Attachment(TextureFormat),
    /// What read-back shaders write to: one 32-bit unsigned integer a texel.
    Fetched,
}

impl SurfaceKind {
    fn gl(self) -> GlFormat {
        match self {
            Self::Attachment(format) => gl_format(format),
            Self::Fetched => GlFormat {
                internal: glow::R32UI,
                format: glow::RED_INTEGER,
                kind: glow::UNSIGNED_INT,
                attachment: glow::COLOR_ATTACHMENT0,
            },
        }
    }

    fn bytes(self) -> u64 {
        match self {
            Self::Attachment(TextureFormat::Rgba32Float) => 16,
            Self::Attachment(TextureFormat::Depth32FloatStencil8) => 8,
            _ => 4,
        }
    }
}

/// The memory of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Storage {
    /// A texture.
    Texture(glow::Texture),
    /// A renderbuffer, where textures of the format do not exist.
    Renderbuffer(glow::Renderbuffer),
}

/// A texture or renderbuffer with a framebuffer of its own. Contents are never relied upon.
#[derive(Debug)]
pub(crate) struct Surface {
    pub(crate) storage: Storage,
    pub(crate) framebuffer: glow::Framebuffer,
    status: u32,
    kind: SurfaceKind,
    size: [u32; 2],
    /// Never given twice.
    id: u64,
}

thread_local! {
    static NEXT_ID: Cell<u64> = const { Cell::new(0) };
}

impl Surface {
    /// Makes a surface. What fails half-way is freed with the context.
    pub(crate) fn new(
        context: &Context,
        kind: SurfaceKind,
        size: [u32; 2],
    ) -> Result<Self, BackendError> {
        let gl = &context.gl;
        let format = kind.gl();
        let (width, height) = (size[0] as i32, size[1] as i32);
        let stencil_only = kind == SurfaceKind::Attachment(TextureFormat::Stencil8);
        // ES reads stencil in a shader, hence from a texture.
        let storage = if stencil_only && !(context.caps.es && context.caps.stencil_textures) {
            // SAFETY: the context is current.
            unsafe {
                let buffer = gl
                    .create_renderbuffer()
                    .map_err(|e| refused("a renderbuffer", e))?;
                gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
                gl.renderbuffer_storage(glow::RENDERBUFFER, format.internal, width, height);
                Storage::Renderbuffer(buffer)
            }
        } else {
            // SAFETY: the context is current; no client memory is read.
            unsafe {
                let texture = gl.create_texture().map_err(|e| refused("a texture", e))?;
                gl.active_texture(glow::TEXTURE0);
                gl.bind_texture(glow::TEXTURE_2D, Some(texture));
                let set = |name, value: u32| {
                    gl.tex_parameter_i32(glow::TEXTURE_2D, name, value as i32);
                };
                // Fetches demand a complete texture, whatever they leave unused.
                set(glow::TEXTURE_MAX_LEVEL, 0);
                set(glow::TEXTURE_MIN_FILTER, glow::NEAREST);
                set(glow::TEXTURE_MAG_FILTER, glow::NEAREST);
                set(glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE);
                set(glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE);
                gl.tex_image_2d(
                    glow::TEXTURE_2D,
                    0,
                    format.internal as i32,
                    width,
                    height,
                    0,
                    format.format,
                    format.kind,
                    glow::PixelUnpackData::Slice(None),
                );
                Storage::Texture(texture)
            }
        };
        let (framebuffer, status) = framebuffer(context, &[(storage, format.attachment)])?;
        let id = NEXT_ID.with(|next| next.replace(next.get() + 1));
        Ok(Self {
            storage,
            framebuffer,
            status,
            kind,
            size,
            id,
        })
    }

    /// Whether the surface alone makes a complete framebuffer.
    pub(crate) fn is_complete(&self) -> bool {
        self.status == glow::FRAMEBUFFER_COMPLETE
    }

    /// The texture; `None` for a renderbuffer.
    pub(crate) fn texture(&self) -> Option<glow::Texture> {
        match self.storage {
            Storage::Texture(texture) => Some(texture),
            Storage::Renderbuffer(_) => None,
        }
    }

    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    fn bytes(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1]) * self.kind.bytes()
    }

    /// Frees the surface.
    pub(crate) fn delete(self, context: &Context) {
        let gl = &context.gl;
        // SAFETY: the context is current and the objects are its own.
        unsafe {
            gl.delete_framebuffer(self.framebuffer);
            match self.storage {
                Storage::Texture(texture) => gl.delete_texture(texture),
                Storage::Renderbuffer(buffer) => gl.delete_renderbuffer(buffer),
            }
        }
    }
}

/// Makes a framebuffer, leaves it bound, and tells its status.
fn framebuffer(
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
                Storage::Texture(texture) => gl.framebuffer_texture_2d(
                    glow::FRAMEBUFFER,
                    *point,
                    glow::TEXTURE_2D,
                    Some(*texture),
                    0,
                ),
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

/// A pass's framebuffer with the surfaces it joins.
#[derive(Debug)]
pub(crate) struct Target {
    pub(crate) framebuffer: glow::Framebuffer,
    key: TargetKey,
}

type TargetKey = (Vec<u64>, Option<u64>);

/// Objects that no scene uses now.
#[derive(Default)]
pub(crate) struct Pool {
    surfaces: HashMap<(SurfaceKind, [u32; 2]), Vec<Surface>>,
    count: usize,
    bytes: u64,
    targets: HashMap<TargetKey, Vec<glow::Framebuffer>>,
    buffers: Vec<glow::Buffer>,
}

impl Pool {
    /// A surface of this kind and size with any contents.
    pub(crate) fn surface(
        &mut self,
        context: &Context,
        kind: SurfaceKind,
        size: [u32; 2],
    ) -> Result<Surface, BackendError> {
        match self.surfaces.get_mut(&(kind, size)).and_then(Vec::pop) {
            Some(surface) => {
                self.count -= 1;
                self.bytes -= surface.bytes();
                Ok(surface)
            }
            None => Surface::new(context, kind, size),
        }
    }

    /// Takes a surface back.
    pub(crate) fn put_surface(&mut self, context: &Context, surface: Surface) {
        self.count += 1;
        self.bytes += surface.bytes();
        let key = (surface.kind, surface.size);
        self.surfaces.entry(key).or_default().push(surface);
        if self.count > MAX_FREE || self.bytes > MAX_FREE_BYTES {
            self.delete_surfaces(context);
        }
    }

    /// Frees all free surfaces, and the targets with them: whatever a scene needs next is made
    /// anew, and targets never name what is gone.
    pub(crate) fn delete_surfaces(&mut self, context: &Context) {
        self.delete_targets(context);
        for surface in self.surfaces.drain().flat_map(|(_, list)| list) {
            surface.delete(context);
        }
        self.count = 0;
        self.bytes = 0;
    }

    fn delete_targets(&mut self, context: &Context) {
        for framebuffer in self.targets.drain().flat_map(|(_, list)| list) {
            // SAFETY: the context is current and the object is its own.
            unsafe { context.gl.delete_framebuffer(framebuffer) };
        }
    }

    /// A framebuffer of these surfaces; `None` where the driver does not draw to them together.
    pub(crate) fn target(
        &mut self,
        context: &Context,
        color: &[&Surface],
        depth_stencil: Option<&Surface>,
    ) -> Result<Option<Target>, BackendError> {
        let key = (
            color.iter().map(|s| s.id).collect::<Vec<_>>(),
            depth_stencil.map(|s| s.id),
        );
        if let Some(framebuffer) = self.targets.get_mut(&key).and_then(Vec::pop) {
            return Ok(Some(Target { framebuffer, key }));
        }
        let mut attachments = Vec::new();
        for (i, surface) in color.iter().enumerate() {
            attachments.push((surface.storage, glow::COLOR_ATTACHMENT0 + i as u32));
        }
        if let Some(surface) = depth_stencil {
            attachments.push((surface.storage, surface.kind.gl().attachment));
        }
        let (framebuffer, status) = framebuffer(context, &attachments)?;
        if status == glow::FRAMEBUFFER_COMPLETE {
            return Ok(Some(Target { framebuffer, key }));
        }
        // SAFETY: the context is current and the object is its own.
        unsafe { context.gl.delete_framebuffer(framebuffer) };
        Ok(None)
    }

    /// Takes a target back, before its surfaces.
    pub(crate) fn put_target(&mut self, context: &Context, target: Target) {
        if self.targets.values().map(Vec::len).sum::<usize>() >= MAX_FREE {
            self.delete_targets(context);
        }
        self.targets
            .entry(target.key)
            .or_default()
            .push(target.framebuffer);
    }

    /// A buffer with these contents, bound to a target.
    pub(crate) fn buffer(
        &mut self,
        context: &Context,
        target: u32,
        data: &[u8],
    ) -> Result<glow::Buffer, BackendError> {
        let gl = &context.gl;
        // SAFETY: the context is current.
        unsafe {
            let buffer = match self.buffers.pop() {
                Some(buffer) => buffer,
                None => gl.create_buffer().map_err(|e| refused("a buffer", e))?,
            };
            gl.bind_buffer(target, Some(buffer));
            gl.buffer_data_u8_slice(target, data, glow::STATIC_DRAW);
            Ok(buffer)
        }
    }

    /// Takes a buffer of a size in bytes back.
    pub(crate) fn put_buffer(&mut self, context: &Context, buffer: glow::Buffer, size: usize) {
        if self.buffers.len() < MAX_FREE && size <= MAX_FREE_BUFFER {
            self.buffers.push(buffer);
        } else {
            // SAFETY: the context is current and the object is its own.
            unsafe { context.gl.delete_buffer(buffer) };
        }
    }
}

impl Target {
    /// Frees the framebuffer.
    pub(crate) fn delete(self, context: &Context) {
        // SAFETY: the context is current and the object is its own.
        unsafe { context.gl.delete_framebuffer(self.framebuffer) };
    }
}
