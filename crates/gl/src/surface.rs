//! Textures and renderbuffers, each with a framebuffer.

use crate::codes;
use crate::context::Context;
use crate::format::{GlFormat, gl_format, viewed};
use crate::path::DRAWN_LAYERS;
use etalon_backend::BackendError;
use etalon_frame::{PathTarget, PathValue, PathViews, Requirement, TextureFormat};
use glow::HasContext;
use std::cell::Cell;

/// The use of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SurfaceKind {
    /// An attachment of a scene: its format, its number of samples per texel, the part of a texture that
    /// serves as the attachment, and how the texture's format is chosen.
    Attachment(TextureFormat, u32, PathTarget, PathViews),
    /// An attachment with three layers: its format, the layer that is read, and how the texture's format is
    /// chosen.
    Layered(TextureFormat, u8, PathViews),
    /// The target of read-back shaders: four 32-bit unsigned integers per texel.
    Fetched,
}

impl SurfaceKind {
    /// Returns an attachment that is a whole texture of its format.
    pub(crate) fn plain(format: TextureFormat, samples: u32) -> Self {
        Self::Attachment(format, samples, PathTarget::Plain, PathViews::Same)
    }

    /// Returns how the path chooses the texture's format; [`PathViews::Same`] if the path does not apply.
    pub(crate) fn views(self) -> PathViews {
        match self {
            Self::Attachment(format, _, _, views) | Self::Layered(format, _, views) => {
                viewed(format, views).map_or(PathViews::Same, |_| views)
            }
            Self::Fetched => PathViews::Same,
        }
    }

    /// Returns the internal format of the texture that the surface is a view of, if the surface is a view.
    fn stored(self) -> Option<u32> {
        match self.target() {
            PathTarget::Renderbuffer => None,
            _ => viewed(self.format()?, self.views()),
        }
    }

    fn gl(self) -> Result<GlFormat, BackendError> {
        match self {
            Self::Attachment(format, ..) | Self::Layered(format, ..) => {
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
            Self::Attachment(_, samples, ..) => samples,
            Self::Layered(..) | Self::Fetched => 1,
        }
    }

    /// Returns the approximate size of a texel in bytes.
    fn bytes(self) -> u64 {
        match self {
            Self::Attachment(format, samples, ..) if format.is_color() => {
                codes::texel_bytes(format) as u64 * u64::from(samples)
            }
            Self::Attachment(_, samples, ..) => 8 * u64::from(samples),
            Self::Layered(format, ..) => 3 * Self::plain(format, 1).bytes(),
            Self::Fetched => 16,
        }
    }

    /// Returns the part of a texture that the surface is.
    pub(crate) fn target(self) -> PathTarget {
        match self {
            Self::Attachment(_, _, target, _) => target,
            Self::Layered(..) => PathTarget::ArrayLayer,
            Self::Fetched => PathTarget::Plain,
        }
    }

    /// Returns the format, if the surface is an attachment.
    pub(crate) fn format(self) -> Option<TextureFormat> {
        match self {
            Self::Attachment(format, ..) | Self::Layered(format, ..) => Some(format),
            Self::Fetched => None,
        }
    }
}

/// The storage of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Storage {
    /// A part of a texture.
    Texture(TextureImage),
    /// A renderbuffer.
    Renderbuffer(glow::Renderbuffer),
}

/// One image of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TextureImage {
    pub(crate) texture: glow::Texture,
    /// The target that the texture is bound to.
    pub(crate) binding: u32,
    pub(crate) level: i32,
    /// The layer of an array, slice of a 3D texture, or face of a cube map.
    pub(crate) layer: i32,
}

impl TextureImage {
    /// Returns the only image of a texture.
    fn whole(texture: glow::Texture, binding: u32) -> Self {
        Self {
            texture,
            binding,
            level: 0,
            layer: 0,
        }
    }

    /// Returns true if the layer is the third coordinate of texels.
    pub(crate) fn is_deep(self) -> bool {
        matches!(self.binding, glow::TEXTURE_2D_ARRAY | glow::TEXTURE_3D)
    }

    /// Returns the target of the image. In a cube map, it is the face's.
    fn image(self) -> u32 {
        match self.binding {
            glow::TEXTURE_CUBE_MAP => glow::TEXTURE_CUBE_MAP_POSITIVE_X + self.layer as u32,
            binding => binding,
        }
    }
}

/// A texture or renderbuffer with a framebuffer. A new one has undefined contents.
#[derive(Debug)]
pub(crate) struct Surface {
    pub(crate) storage: Storage,
    /// The texture that the storage is a view of, if it is a view.
    viewed: Option<glow::Texture>,
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
    /// Creates a surface. After an error, what it created is deleted with the context.
    pub(crate) fn new(
        context: &Context,
        kind: SurfaceKind,
        size: [u32; 2],
    ) -> Result<Self, BackendError> {
        let format = kind.gl()?;
        let samples = kind.samples();
        let stencil_only = kind.format() == Some(TextureFormat::Stencil8);
        // In ES, and from multisampled surfaces, stencil is read by a shader, which needs a texture.
        let fetched = (context.caps.es || samples > 1) && context.caps.stencil_textures;
        let target = kind.target();
        let (storage, viewed) = match kind.stored() {
            Some(stored) => {
                let (part, viewed) = view(context, kind, format, size, stored)?;
                (Storage::Texture(part), Some(viewed))
            }
            None => {
                let storage = match target {
                    PathTarget::Renderbuffer => renderbuffer(context, format, size)?,
                    PathTarget::Plain if stencil_only && !fetched => {
                        renderbuffer(context, format, size)?
                    }
                    PathTarget::Plain if samples > 1 => {
                        multisample_texture(context, format, size, samples)?
                    }
                    target => texture(context, format, size, target)?,
                };
                (storage, None)
            }
        };
        let storage = match (kind, storage) {
            (SurfaceKind::Layered(_, layer, _), Storage::Texture(part)) => {
                let layer = i32::from(layer);
                Storage::Texture(TextureImage { layer, ..part })
            }
            _ => storage,
        };
        let (framebuffer, status) = framebuffer(context, &[(storage, format.attachment)], false)?;
        let id = NEXT_ID.with(|next| next.replace(next.get() + 1));
        Ok(Self {
            storage,
            viewed,
            framebuffer,
            status,
            attachment: format.attachment,
            kind,
            size,
            id,
        })
    }

    /// Returns true if the surface alone makes a complete framebuffer.
    pub(crate) fn is_complete(&self) -> bool {
        self.status == glow::FRAMEBUFFER_COMPLETE
    }

    /// Returns the texture; `None` for a renderbuffer.
    pub(crate) fn texture(&self) -> Option<glow::Texture> {
        match self.storage {
            Storage::Texture(part) => Some(part.texture),
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
        // SAFETY: the context is current and owns the objects.
        unsafe {
            gl.delete_framebuffer(self.framebuffer);
            match self.storage {
                Storage::Texture(part) => gl.delete_texture(part.texture),
                Storage::Renderbuffer(buffer) => gl.delete_renderbuffer(buffer),
            }
            if let Some(texture) = self.viewed {
                gl.delete_texture(texture);
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
            .map_err(|e| BackendError::refused("a renderbuffer", e))?;
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
        gl.renderbuffer_storage(glow::RENDERBUFFER, format.internal, width, height);
        Ok(Storage::Renderbuffer(buffer))
    }
}

fn texture(
    context: &Context,
    format: GlFormat,
    size: [u32; 2],
    path: PathTarget,
) -> Result<Storage, BackendError> {
    let gl = &context.gl;
    let shape = TextureShape::of(path, size);
    let target = shape.binding;
    check_size(context, path, shape)?;
    // SAFETY: the context is current; no client memory is read.
    unsafe {
        let texture = gl
            .create_texture()
            .map_err(|e| BackendError::refused("a texture", e))?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(target, Some(texture));
        set_parameters(gl, shape);
        let part = shape.part(texture);
        let none = || glow::PixelUnpackData::Slice(None);
        let (internal, words, kind) = (format.internal as i32, format.format, format.kind);
        for level in 0..=shape.level {
            let [width, height] = shape.size.map(|side| (side >> level) as i32);
            if part.is_deep() {
                let depth = shape.layers;
                gl.tex_image_3d(
                    target,
                    level,
                    internal,
                    width,
                    height,
                    depth,
                    0,
                    words,
                    kind,
                    none(),
                );
                continue;
            }
            for layer in 0..shape.layers {
                let image = TextureImage { layer, ..part }.image();
                gl.tex_image_2d(
                    image,
                    level,
                    internal,
                    width,
                    height,
                    0,
                    words,
                    kind,
                    none(),
                );
            }
        }
        Ok(Storage::Texture(part))
    }
}

/// Sets the parameters of the bound texture.
///
/// # Safety
/// The context is current, and the texture has these parameters.
unsafe fn set_parameters(gl: &glow::Context, shape: TextureShape) {
    // SAFETY: upheld by the caller.
    let set = |name, value: u32| unsafe {
        gl.tex_parameter_i32(shape.binding, name, value as i32);
    };
    // Fetches require a complete texture, even if they do not use its filter. Shaders see only this level.
    set(glow::TEXTURE_BASE_LEVEL, shape.level as u32);
    set(glow::TEXTURE_MAX_LEVEL, shape.level as u32);
    set(glow::TEXTURE_MIN_FILTER, glow::NEAREST);
    set(glow::TEXTURE_MAG_FILTER, glow::NEAREST);
    set(glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE);
    set(glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE);
}

/// The texture that an attachment is a part of.
#[derive(Clone, Copy)]
struct TextureShape {
    binding: u32,
    /// The size of level 0.
    size: [u32; 2],
    /// The level that is used, which is the last.
    level: i32,
    /// The number of layers, slices or faces.
    layers: i32,
    /// The layer, slice or face that is used.
    layer: i32,
}

impl TextureShape {
    /// Returns the part of a texture of this shape that is used.
    fn part(self, texture: glow::Texture) -> TextureImage {
        TextureImage {
            texture,
            binding: self.binding,
            level: self.level,
            layer: self.layer,
        }
    }

    fn of(path: PathTarget, size: [u32; 2]) -> Self {
        let plain = Self {
            binding: glow::TEXTURE_2D,
            size,
            level: 0,
            layers: 1,
            layer: 0,
        };
        match path {
            PathTarget::Plain | PathTarget::Renderbuffer => plain,
            PathTarget::MipLevel => Self {
                // Odd sizes: each level's size is rounded down.
                size: size.map(|side| 2 * side + 1),
                level: 1,
                ..plain
            },
            PathTarget::LevelOfLayer => Self {
                binding: glow::TEXTURE_2D_ARRAY,
                size: size.map(|side| 2 * side + 1),
                level: 1,
                layers: 3,
                layer: 2,
            },
            PathTarget::ArrayLayer => Self {
                binding: glow::TEXTURE_2D_ARRAY,
                layers: 3,
                layer: 2,
                ..plain
            },
            PathTarget::Slice3d => Self {
                binding: glow::TEXTURE_3D,
                layers: 4,
                layer: 3,
                ..plain
            },
            PathTarget::CubeFace => Self {
                binding: glow::TEXTURE_CUBE_MAP,
                layers: 6,
                layer: 4,
                ..plain
            },
        }
    }
}

/// Checks that the context supports textures of the size that the part needs.
fn check_size(
    context: &Context,
    path: PathTarget,
    shape: TextureShape,
) -> Result<(), BackendError> {
    let name = match path {
        PathTarget::Plain | PathTarget::Renderbuffer => return Ok(()),
        PathTarget::MipLevel | PathTarget::ArrayLayer | PathTarget::LevelOfLayer => {
            glow::MAX_TEXTURE_SIZE
        }
        PathTarget::Slice3d => glow::MAX_3D_TEXTURE_SIZE,
        PathTarget::CubeFace => glow::MAX_CUBE_MAP_TEXTURE_SIZE,
    };
    // SAFETY: the context is current, and has had these limits since version 3.
    let most = unsafe { context.gl.get_parameter_i32(name) };
    let fits = shape
        .size
        .iter()
        .all(|side| i64::from(*side) <= i64::from(most));
    let value = Requirement::Path(PathValue::Target(path));
    fits.then_some(()).ok_or(BackendError::NotSupported(value))
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
    // SAFETY: the context is current. Multisampling is supported from ES 3.1 and OpenGL 3.3 on, which have
    // these entry points.
    unsafe {
        let texture = gl
            .create_texture()
            .map_err(|e| BackendError::refused("a texture", e))?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(target, Some(texture));
        // Requests the same sample positions for every texel and format.
        if context.caps.es {
            gl.tex_storage_2d_multisample(target, samples, internal, width, height, true);
        } else {
            let internal = internal as i32;
            gl.tex_image_2d_multisample(target, samples, internal, width, height, true);
        }
        Ok(Storage::Texture(TextureImage::whole(texture, target)))
    }
}

/// Creates a texture of the format `stored` and a view of it. Returns the part of the view that is used, and
/// the texture (OpenGL 4.6, 8.18; `GL_OES_texture_view`).
///
/// # Errors
/// If the context has no texture of this format and number of samples.
fn view(
    context: &Context,
    kind: SurfaceKind,
    format: GlFormat,
    size: [u32; 2],
    stored: u32,
) -> Result<(TextureImage, glow::Texture), BackendError> {
    let gl = &context.gl;
    let samples = kind.samples();
    let mut shape = TextureShape::of(kind.target(), size);
    if samples > 1 {
        shape.binding = glow::TEXTURE_2D_MULTISAMPLE;
    }
    check_size(context, kind.target(), shape)?;
    let missing = || BackendError::NotSupported(Requirement::Path(PathValue::Views(kind.views())));
    let make_view = context.entry_points.texture_view.ok_or_else(missing)?;
    if samples > most_samples(gl, stored) {
        return Err(missing());
    }
    let [width, height] = shape.size.map(|side| side as i32);
    let (binding, layers, levels) = (shape.binding, shape.layers, shape.level + 1);
    // SAFETY: the context is current and has views, and therefore storage of every target here. The view has
    // the texture's levels and layers, and a format of its class.
    unsafe {
        let create = || {
            let texture = gl.create_texture();
            texture.map_err(|e| BackendError::refused("a texture", e))
        };
        let (texture, viewing) = (create()?, create()?);
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(binding, Some(texture));
        match binding {
            glow::TEXTURE_2D_MULTISAMPLE => {
                // Requests the same sample positions for every texel and format.
                let samples = samples as i32;
                gl.tex_storage_2d_multisample(binding, samples, stored, width, height, true);
            }
            glow::TEXTURE_2D_ARRAY | glow::TEXTURE_3D => {
                gl.tex_storage_3d(binding, levels, stored, width, height, layers);
            }
            _ => gl.tex_storage_2d(binding, levels, stored, width, height),
        }
        // Slices do not count as layers.
        let layers = match binding {
            glow::TEXTURE_3D => 1,
            _ => layers as u32,
        };
        let (to, from) = (viewing.0.get(), texture.0.get());
        make_view(
            to,
            binding,
            from,
            format.internal,
            0,
            levels as u32,
            0,
            layers,
        );
        gl.bind_texture(binding, Some(viewing));
        if samples == 1 {
            set_parameters(gl, shape);
        }
        Ok((shape.part(viewing), texture))
    }
}

/// Returns the largest sample count of a texture of this format.
fn most_samples(gl: &glow::Context, format: u32) -> u32 {
    let mut counts = [1];
    let target = glow::TEXTURE_2D_MULTISAMPLE;
    // SAFETY: the context is current, and has the query because it has views. Counts are in descending order.
    unsafe { gl.get_internal_format_i32_slice(target, format, glow::SAMPLES, &mut counts) };
    counts[0].max(1).cast_unsigned()
}

/// Replaces the contents of a single-sample colour texture. `bytes` has all of its texels.
pub(crate) fn upload(context: &Context, format: TextureFormat, surface: &Surface, bytes: &[u8]) {
    let gl = &context.gl;
    let (Some(words), Storage::Texture(part)) = (gl_format(format), surface.storage) else {
        return;
    };
    let [width, height] = surface.size().map(|side| side as i32);
    // SAFETY: the context is current, rows are tightly packed (`state::reset`), and the caller counted the
    // bytes.
    unsafe {
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(part.binding, Some(part.texture));
        let texels = glow::PixelUnpackData::Slice(Some(bytes));
        let (image, level) = (part.image(), part.level);
        let (kind, format) = (words.kind, words.format);
        if !part.is_deep() {
            gl.tex_sub_image_2d(image, level, 0, 0, width, height, format, kind, texels);
            return;
        }
        let layers = match surface.kind {
            SurfaceKind::Layered(..) => DRAWN_LAYERS.map(i32::from).to_vec(),
            _ => vec![part.layer],
        };
        for layer in layers {
            let texels = glow::PixelUnpackData::Slice(Some(bytes));
            gl.tex_sub_image_3d(
                image, level, 0, 0, layer, width, height, 1, format, kind, texels,
            );
        }
    }
}

/// Creates a framebuffer, with all layers if `layered` is true. Leaves it bound, and returns it with its
/// status.
pub(crate) fn framebuffer(
    context: &Context,
    attachments: &[(Storage, u32)],
    layered: bool,
) -> Result<(glow::Framebuffer, u32), BackendError> {
    let gl = &context.gl;
    // SAFETY: the context is current and owns the attachments.
    unsafe {
        let framebuffer = gl
            .create_framebuffer()
            .map_err(|e| BackendError::refused("a framebuffer", e))?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        let (mut buffers, mut next) = (Vec::new(), glow::COLOR_ATTACHMENT0);
        for (storage, point) in attachments {
            match storage {
                Storage::Texture(part) if layered => gl.framebuffer_texture(
                    glow::FRAMEBUFFER,
                    *point,
                    Some(part.texture),
                    part.level,
                ),
                Storage::Texture(part) if part.is_deep() => gl.framebuffer_texture_layer(
                    glow::FRAMEBUFFER,
                    *point,
                    Some(part.texture),
                    part.level,
                    part.layer,
                ),
                Storage::Texture(part) => gl.framebuffer_texture_2d(
                    glow::FRAMEBUFFER,
                    *point,
                    part.image(),
                    Some(part.texture),
                    part.level,
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
                buffers.extend((next..*point).map(|_| glow::NONE));
                buffers.push(*point);
                next = point + 1;
            }
        }
        let attached = buffers.iter().find(|point| **point != glow::NONE);
        let read = attached.copied().unwrap_or(glow::NONE);
        if buffers.is_empty() {
            buffers.push(glow::NONE);
        }
        gl.draw_buffers(&buffers);
        gl.read_buffer(read);
        let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
        Ok((framebuffer, status))
    }
}
