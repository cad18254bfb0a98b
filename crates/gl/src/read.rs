//! Reading attachments back as codes.

use crate::codes;
use crate::context::Context;
use crate::format::gl_format;
use crate::pool::ObjectPool;
use crate::program::{Programs, ReadType, View};
use crate::recording;
use crate::state;
use crate::support::{ReadBackPath, ShaderStencil};
use crate::surface::{Storage, Surface, SurfaceKind};
use etalon_backend::codes::code_of_float;
use etalon_backend::{BackendError, BlitPiece, Blits, NumberForm, halves};
use etalon_frame::{Aspect, ChannelEncoding, Image, PathEnd, ReadPath, TextureFormat};
use glow::HasContext;

/// The objects that reading needs in addition to the surface.
pub(crate) struct ReadObjects<'a> {
    pub(crate) context: &'a Context,
    pub(crate) pool: &'a mut ObjectPool,
    pub(crate) programs: &'a mut Programs,
    /// A vertex array without attributes.
    pub(crate) no_vertices: glow::VertexArray,
}

/// The codes of depth and stencil, each if the format has it.
type DepthStencilCodes = (Option<Vec<u32>>, Option<Vec<u32>>);

/// An attachment to read.
pub(crate) struct ReadSource<'a> {
    pub(crate) name: &'a str,
    pub(crate) format: TextureFormat,
    pub(crate) plan: ReadBackPath,
    pub(crate) depth: &'a [ChannelEncoding],
    pub(crate) surface: &'a Surface,
    /// The size of the attachment.
    pub(crate) size: [u32; 2],
    /// The framebuffer that the attachment was drawn in, and its attachment point there.
    pub(crate) drawn: (glow::Framebuffer, u32),
    /// The route by which it reaches the host.
    pub(crate) end: PathEnd,
    /// The blits that produced the surface's texels.
    pub(crate) blits: Option<Blits>,
}

impl ReadSource<'_> {
    /// Returns true if a shader fetches the texels. Multisampled attachments always are, since a copy would
    /// resolve them.
    fn is_fetched(&self) -> bool {
        self.surface.samples() > 1 || self.end == PathEnd::ShaderRead
    }

    /// Returns the number of texels of the attachment.
    fn texels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Returns the parts in which an aspect is read, each with its position in the result.
    fn pieces(&self, aspect: Aspect) -> Vec<BlitPiece> {
        match self.blits {
            Some(blits) => blits.pieces(aspect),
            None if self.end == PathEnd::Part && !self.is_fetched() => {
                let mut pieces = Vec::new();
                for (y, rows) in halves(self.size[1]) {
                    for (x, columns) in halves(self.size[0]) {
                        let (place, size) = ([x, y], [columns, rows]);
                        pieces.push(piece(place, size));
                    }
                }
                pieces
            }
            None => vec![piece([0, 0], self.size)],
        }
    }
}

/// Returns a part that is not moved.
fn piece(place: [u32; 2], size: [u32; 2]) -> BlitPiece {
    BlitPiece {
        from: place,
        to: place,
        size,
    }
}

impl ReadObjects<'_> {
    /// Returns the images of all aspects of an attachment, depth before stencil.
    pub(crate) fn images(&mut self, source: &ReadSource<'_>) -> Result<Vec<Image>, BackendError> {
        let images = self.images_at(source)?;
        recording::images(&images);
        Ok(images)
    }

    /// Returns the images, read from a copy if the path has one.
    fn images_at(&mut self, source: &ReadSource<'_>) -> Result<Vec<Image>, BackendError> {
        match source.end {
            PathEnd::Copy | PathEnd::Blit => {}
            PathEnd::BlitMirrored | PathEnd::BlitScaled | PathEnd::BlitPart => {
                return self.moved(source);
            }
            PathEnd::BlitLinear => return self.filtered(source),
            PathEnd::Store | PathEnd::ShaderRead | PathEnd::Part | PathEnd::ReadBuffer => {
                return self.images_of(source);
            }
        }
        let context = self.context;
        let kind = SurfaceKind::plain(source.format, 1);
        let size = source.surface.size();
        let surface = self.pool.surface(context, kind, size)?;
        state::reset(context);
        spoil(context, source.format, &surface);
        match source.end {
            PathEnd::Copy => copy_image(context, source.surface, &surface),
            _ => blit(context, source.format, source.surface, &surface),
        }
        let images = self.images_of(&ReadSource {
            surface: &surface,
            end: PathEnd::Store,
            ..*source
        });
        self.pool.put_surface(context, surface);
        images
    }

    pub(crate) fn images_of(
        &mut self,
        source: &ReadSource<'_>,
    ) -> Result<Vec<Image>, BackendError> {
        let image = |aspect, channels, read, codes| Image {
            attachment: source.name.to_owned(),
            aspect,
            size: source.size,
            samples: source.surface.samples(),
            channels,
            read,
            codes,
        };
        if source.format.is_color() {
            let codes = self.color(source)?;
            let channels = source.format.color_channels().to_vec();
            return Ok(vec![image(Aspect::Color, channels, ReadPath::Copy, codes)]);
        }
        let (depth, stencil) = self.depth_stencil(source)?;
        let mut images = Vec::new();
        if let Some(mut codes) = depth {
            let (channels, path) = match source.plan {
                ReadBackPath::Shader { .. } => (vec![ChannelEncoding::Float32], ReadPath::Shader),
                _ => (source.depth.to_vec(), ReadPath::Copy),
            };
            self.plant(source, &channels, &mut codes);
            images.push(image(Aspect::Depth, channels, path, codes));
        }
        if let Some(mut codes) = stencil {
            // Reading integers is exact in both ways.
            let channels = vec![ChannelEncoding::Uint(8)];
            self.plant(source, &channels, &mut codes);
            images.push(image(Aspect::Stencil, channels, ReadPath::Copy, codes));
        }
        Ok(images)
    }

    /// Returns the codes of a colour surface.
    fn color(&mut self, source: &ReadSource<'_>) -> Result<Vec<u32>, BackendError> {
        let mut codes = self.stored_color(source)?;
        self.plant(source, source.format.color_channels(), &mut codes);
        Ok(codes)
    }

    /// Applies the fault that a test plants.
    fn plant(&self, source: &ReadSource<'_>, channels: &[ChannelEncoding], codes: &mut [u32]) {
        if let Some(fault) = self.context.fault {
            fault.change_codes(codes, source.size, source.surface.samples(), channels);
        }
    }

    /// Returns the codes of a colour surface. Multisampled surfaces are always fetched.
    fn stored_color(&mut self, source: &ReadSource<'_>) -> Result<Vec<u32>, BackendError> {
        let format = source.format;
        let channels = format.color_channels();
        if !source.is_fetched() && source.plan != ReadBackPath::Fetched {
            return Ok(copy(self.context, source, source.plan).0);
        }
        if format.is_integer() {
            let wide = self.fetch(source, ReadType::Integers, Aspect::Color)?;
            return Ok(first_channels(&wide, channels.len()));
        }
        let wide = self.fetch(source, ReadType::Floats, Aspect::Color)?;
        Ok(narrowed(&wide, channels))
    }

    /// Returns the codes of depths that a shader fetches.
    fn fetched_depth(
        &mut self,
        source: &ReadSource<'_>,
        encoding: ChannelEncoding,
    ) -> Result<Vec<u32>, BackendError> {
        let wide = self.fetch(source, ReadType::Floats, Aspect::Depth)?;
        Ok(narrowed(&wide, &[encoding]))
    }

    fn fetched_stencil(&mut self, source: &ReadSource<'_>) -> Result<Vec<u32>, BackendError> {
        let wide = self.fetch(source, ReadType::Integers, Aspect::Stencil)?;
        Ok(wide.chunks_exact(4).map(|texel| texel[0]).collect())
    }

    fn depth_stencil(
        &mut self,
        source: &ReadSource<'_>,
    ) -> Result<DepthStencilCodes, BackendError> {
        let format = source.format;
        let fetched = source.is_fetched();
        let (depth, stencil) = match source.plan {
            ReadBackPath::Shader { depth, stencil } => (depth, stencil),
            _ if fetched => (format.has_depth(), ShaderStencil::Copy),
            plan => {
                let (first, second) = copy(self.context, source, plan);
                return Ok(if format.has_depth() {
                    (Some(first), second)
                } else {
                    (None, Some(first))
                });
            }
        };
        let as_float = matches!(source.plan, ReadBackPath::Shader { .. });
        let encoding = match source.depth.first() {
            Some(encoding) if !as_float => *encoding,
            _ => ChannelEncoding::Float32,
        };
        let depth = if depth {
            Some(self.fetched_depth(source, encoding)?)
        } else {
            None
        };
        let stencil = match stencil {
            _ if !format.has_stencil() => None,
            ShaderStencil::None => None,
            ShaderStencil::Copy if !fetched => {
                Some(copy(self.context, source, ReadBackPath::Stencil).0)
            }
            ShaderStencil::Copy | ShaderStencil::Shader => Some(self.fetched_stencil(source)?),
        };
        Ok((depth, stencil))
    }

    /// Fetches a surface into a scratch surface and reads that: four words per sample, with the samples of a
    /// texel in sequence.
    fn fetch(
        &mut self,
        source: &ReadSource<'_>,
        reader: ReadType,
        aspect: Aspect,
    ) -> Result<Vec<u32>, BackendError> {
        let context = self.context;
        let gl = &context.gl;
        let surface = source.surface;
        let pieces = source.pieces(aspect);
        let Storage::Texture(part) = surface.storage else {
            return Err(BackendError::internal(
                "a renderbuffer cannot be fetched from",
            ));
        };
        let samples = surface.samples();
        let binding = part.binding;
        let view = match binding {
            glow::TEXTURE_3D => View::Slices,
            glow::TEXTURE_2D_ARRAY => View::Layers,
            glow::TEXTURE_2D_MULTISAMPLE => View::Samples,
            _ => View::Plain,
        };
        let (program, location) = self.programs.reader(context, reader, view)?;
        let size = surface.size();
        let target = self.pool.surface(context, SurfaceKind::Fetched, size)?;
        if !target.is_complete() {
            target.delete(context);
            return Err(BackendError::refused(
                "a framebuffer for reading back",
                "incomplete",
            ));
        }
        state::reset(context);
        let has_stencil = surface.kind.format().is_some_and(|f| f.has_stencil());
        let set_mode = |mode: u32| {
            if reader == ReadType::Integers && has_stencil && context.caps.stencil_texturing {
                // SAFETY: the texture is bound and the context has the parameter.
                unsafe {
                    gl.tex_parameter_i32(binding, glow::DEPTH_STENCIL_TEXTURE_MODE, mode as i32)
                }
            }
        };
        let texels = source.texels();
        let mut codes = vec![0_u32; texels * samples as usize * 4];
        let mut wide = vec![0_u32; texels * 4];
        for sample in 0..samples as usize {
            // SAFETY: the context is current and owns all objects, and the draw reads no vertices.
            unsafe {
                gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target.framebuffer));
                gl.viewport(0, 0, size[0] as i32, size[1] as i32);
                gl.use_program(Some(program));
                // A texture has samples or layers, so one of the two numbers is 0.
                gl.uniform_1_i32(location.as_ref(), sample as i32 + part.layer);
                gl.bind_vertex_array(Some(self.no_vertices));
                gl.active_texture(glow::TEXTURE0);
                gl.bind_texture(binding, Some(part.texture));
                set_mode(glow::STENCIL_INDEX);
                gl.draw_arrays(glow::TRIANGLES, 0, 3);
                set_mode(glow::DEPTH_COMPONENT);
            }
            // Every version reads unsigned integers as four channels.
            let (format, kind) = (glow::RGBA_INTEGER, glow::UNSIGNED_INT);
            read_pixels(gl, source.size[0], format, kind, &mut wide, &pieces);
            let form = match reader {
                ReadType::Integers => NumberForm::Code,
                ReadType::Floats => NumberForm::Float,
            };
            recording::plane(aspect, 16, each(4, 32), form);
            for (texel, values) in wide.chunks_exact(4).enumerate() {
                let start = (texel * samples as usize + sample) * 4;
                codes[start..start + 4].copy_from_slice(values);
            }
        }
        self.pool.put_surface(context, target);
        Ok(codes)
    }
}

/// Returns the first channels of texels that are four codes each.
fn first_channels(wide: &[u32], channels: usize) -> Vec<u32> {
    let texels = wide.chunks_exact(4);
    texels
        .flat_map(|texel| texel.iter().take(channels).copied())
        .collect()
}

/// Returns the codes of texels that are four floats each.
fn narrowed(wide: &[u32], channels: &[ChannelEncoding]) -> Vec<u32> {
    let mut codes = Vec::with_capacity(wide.len() / 4 * channels.len());
    for texel in wide.chunks_exact(4) {
        let values = channels.iter().zip(texel);
        codes.extend(values.map(|(e, float)| code_of_float(*e, *float)));
    }
    codes
}

/// Reads a single-sample surface with `glReadPixels`: colour, depth, or else stencil, and the stencil if it
/// is packed with depth. One branch per aspect.
fn copy(
    context: &Context,
    source: &ReadSource<'_>,
    plan: ReadBackPath,
) -> (Vec<u32>, Option<Vec<u32>>) {
    let (surface, format) = (source.surface, source.format);
    let first = match (format.is_color(), plan) {
        (true, _) => Aspect::Color,
        (false, ReadBackPath::Stencil | ReadBackPath::Fetched | ReadBackPath::Shader { .. }) => {
            Aspect::Stencil
        }
        (false, _) => Aspect::Depth,
    };
    let pieces = source.pieces(first);
    let gl = &context.gl;
    let (width, texels) = (source.size[0], source.texels());
    // SAFETY: the context is current and owns the framebuffers, and the framebuffer that was drawn to has the
    // attachment point.
    unsafe {
        if source.end == PathEnd::ReadBuffer {
            let (framebuffer, point) = source.drawn;
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            gl.read_buffer(point);
        } else {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
        }
    };
    let words_of = |pieces: &[BlitPiece], format, kind, per_texel: usize| {
        let mut words = vec![0_u32; texels * per_texel];
        read_pixels(gl, width, format, kind, &mut words, pieces);
        words
    };
    let words = |format, kind, per_texel| words_of(&pieces, format, kind, per_texel);
    // If blits move the two aspects differently, each is read alone.
    let stencil_words = |format, kind, per_texel| {
        let others = source.pieces(Aspect::Stencil);
        (others != pieces).then(|| words_of(&others, format, kind, per_texel))
    };
    let depth = glow::DEPTH_COMPONENT;
    let codes = match plan {
        ReadBackPath::Packed => {
            let mut bytes = vec![0_u8; texels * codes::texel_bytes(format)];
            if let Some(client) = gl_format(format) {
                read_pixels(gl, width, client.format, client.kind, &mut bytes, &pieces);
            }
            (codes::unpack(format, &bytes), None)
        }
        ReadBackPath::Bytes => {
            let mut bytes = vec![0_u8; texels * 4];
            let (format, kind) = (glow::RGBA, glow::UNSIGNED_BYTE);
            read_pixels(gl, width, format, kind, &mut bytes, &pieces);
            let channels = source.format.color_channels();
            let mut codes = Vec::with_capacity(texels * channels.len());
            for texel in bytes.chunks_exact(4) {
                let values = channels.iter().zip(texel);
                codes.extend(values.map(|(e, byte)| shortened(*e, *byte)));
            }
            (codes, None)
        }
        ReadBackPath::Floats => {
            let wide = words(glow::RGBA, glow::FLOAT, 4);
            (narrowed(&wide, format.color_channels()), None)
        }
        // Every version reads unsigned integers as four channels.
        ReadBackPath::Integers => {
            let wide = words(glow::RGBA_INTEGER, glow::UNSIGNED_INT, 4);
            (first_channels(&wide, format.color_channels().len()), None)
        }
        ReadBackPath::Depth16 => {
            let mut codes = vec![0_u16; texels];
            let kind = glow::UNSIGNED_SHORT;
            read_pixels(gl, width, depth, kind, &mut codes, &pieces);
            (codes.into_iter().map(u32::from).collect(), None)
        }
        ReadBackPath::Depth24 => {
            let mut codes = words(depth, glow::UNSIGNED_INT, 1);
            codes.iter_mut().for_each(|code| *code >>= 8);
            (codes, None)
        }
        ReadBackPath::DepthFloat => (words(depth, glow::FLOAT, 1), None),
        ReadBackPath::Depth24Stencil8 => {
            let kind = glow::UNSIGNED_INT_24_8;
            let both = words(glow::DEPTH_STENCIL, kind, 1);
            note_depth(plan);
            let others = stencil_words(glow::DEPTH_STENCIL, kind, 1);
            let stencil = others.as_ref().unwrap_or(&both);
            let stencil = stencil.iter().map(|word| word & 0xff).collect();
            (both.iter().map(|word| word >> 8).collect(), Some(stencil))
        }
        ReadBackPath::DepthFloatStencil8 => {
            let kind = glow::FLOAT_32_UNSIGNED_INT_24_8_REV;
            let both = words(glow::DEPTH_STENCIL, kind, 2);
            note_depth(plan);
            let others = stencil_words(glow::DEPTH_STENCIL, kind, 2);
            let every = |both: &[u32], offset: usize| -> Vec<u32> {
                both.iter().skip(offset).step_by(2).copied().collect()
            };
            let stencil = every(others.as_ref().unwrap_or(&both), 1);
            let stencil = stencil.into_iter().map(|word| word & 0xff).collect();
            (every(&both, 0), Some(stencil))
        }
        ReadBackPath::Stencil | ReadBackPath::Fetched | ReadBackPath::Shader { .. } => {
            let mut values = vec![0_u8; texels];
            let (format, kind) = (glow::STENCIL_INDEX, glow::UNSIGNED_BYTE);
            read_pixels(gl, width, format, kind, &mut values, &pieces);
            (values.into_iter().map(u32::from).collect(), None)
        }
    };
    note_planes(plan, format);
    codes
}

/// Records the places of the codes that were just copied.
fn note_planes(plan: ReadBackPath, format: TextureFormat) {
    let plane = |aspect, texel, channels, form| recording::plane(aspect, texel, channels, form);
    let place = |bit, bits| vec![[bit, bits]];
    match plan {
        ReadBackPath::Packed => {
            let texel = codes::texel_bytes(format) as u32;
            plane(
                Aspect::Color,
                texel,
                codes::places(format),
                NumberForm::Code,
            );
        }
        ReadBackPath::Bytes => plane(Aspect::Color, 4, each(4, 8), NumberForm::Byte),
        ReadBackPath::Floats => plane(Aspect::Color, 16, each(4, 32), NumberForm::Float),
        ReadBackPath::Integers => plane(Aspect::Color, 16, each(4, 32), NumberForm::Code),
        ReadBackPath::Depth16 => plane(Aspect::Depth, 2, place(0, 16), NumberForm::Code),
        ReadBackPath::Depth24 => plane(Aspect::Depth, 4, place(8, 24), NumberForm::Code),
        ReadBackPath::DepthFloat => plane(Aspect::Depth, 4, place(0, 32), NumberForm::Code),
        // `note_depth` records depth when it is read.
        ReadBackPath::Depth24Stencil8 => plane(Aspect::Stencil, 4, place(0, 8), NumberForm::Code),
        ReadBackPath::DepthFloatStencil8 => {
            plane(Aspect::Stencil, 8, place(32, 8), NumberForm::Code)
        }
        ReadBackPath::Stencil | ReadBackPath::Fetched | ReadBackPath::Shader { .. } => {
            plane(Aspect::Stencil, 1, place(0, 8), NumberForm::Code);
        }
    }
}

/// Records the position of depth within the depth-stencil texels that were just copied.
fn note_depth(plan: ReadBackPath) {
    let (texel, place) = match plan {
        ReadBackPath::DepthFloatStencil8 => (8, [0, 32]),
        _ => (4, [8, 24]),
    };
    recording::plane(Aspect::Depth, texel, vec![place], NumberForm::Code);
}

/// Returns the offsets and sizes of `channels` consecutive channels of `bits` bits each.
fn each(channels: u32, bits: u32) -> Vec<[u32; 2]> {
    (0..channels).map(|c| [c * bits, bits]).collect()
}

/// Returns the code that was widened to a byte, if it has fewer than 8 bits, or else the byte.
fn shortened(encoding: ChannelEncoding, byte: u8) -> u32 {
    match encoding.bits() {
        bits @ 1..8 => {
            let most = (1 << bits) - 1;
            (u32::from(byte) * most + 127) / 255
        }
        _ => u32::from(byte),
    }
}

/// Reads pieces of the bound framebuffer into a slice, which has exactly the size of an image of this width.
fn read_pixels<T: bytemuck::Pod>(
    gl: &glow::Context,
    width: u32,
    format: u32,
    kind: u32,
    into: &mut [T],
    pieces: &[BlitPiece],
) {
    recording::memory(bytemuck::cast_slice(into));
    for piece in pieces {
        let [x, y] = piece.from.map(|place| place as i32);
        let [to_x, to_y] = piece.to.map(|place| place as i32);
        let [wide, high] = piece.size.map(|length| length as i32);
        let bytes = bytemuck::cast_slice_mut(into);
        let pixels = glow::PixelPackData::Slice(Some(bytes));
        // SAFETY: rows are as long as the image's and tightly packed, the pieces are inside the image, and
        // the callers size the slice by format and type.
        unsafe {
            gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
            gl.pixel_store_i32(glow::PACK_ROW_LENGTH, width as i32);
            gl.pixel_store_i32(glow::PACK_SKIP_PIXELS, to_x);
            gl.pixel_store_i32(glow::PACK_SKIP_ROWS, to_y);
            gl.read_pixels(x, y, wide, high, format, kind, pixels);
        }
    }
    for name in [
        glow::PACK_ROW_LENGTH,
        glow::PACK_SKIP_PIXELS,
        glow::PACK_SKIP_ROWS,
    ] {
        // SAFETY: the context is current.
        unsafe { gl.pixel_store_i32(name, 0) };
    }
}

/// Fills a surface with values that show a lost copy. Otherwise the texels of an earlier scene with the same
/// picture could hide the loss.
pub(crate) fn spoil(context: &Context, format: TextureFormat, surface: &Surface) {
    let gl = &context.gl;
    // SAFETY: the context is current and owns the framebuffer, and masks and scissor are open.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
        match (
            format.is_integer(),
            format.has_depth(),
            format.has_stencil(),
        ) {
            (true, ..) => gl.clear_buffer_u32_slice(glow::COLOR, 0, &[77; 4]),
            (_, true, true) => gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, 0.3, 77),
            (_, true, false) => gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[0.3]),
            (_, false, true) => gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[77]),
            (false, false, false) => gl.clear_buffer_f32_slice(glow::COLOR, 0, &[0.3; 4]),
        }
    }
}

/// Copies a surface's texels to another of the same size and format.
fn copy_image(context: &Context, from: &Surface, to: &Surface) {
    let gl = &context.gl;
    let [width, height] = from.size().map(|side| side as i32);
    let (source, target) = (CopiedImage::of(from), CopiedImage::of(to));
    // SAFETY: the context is current, has the function, and owns the images, which are of equal size.
    unsafe {
        gl.copy_image_sub_data(
            source.name,
            source.binding,
            source.level,
            0,
            0,
            source.layer,
            target.name,
            target.binding,
            target.level,
            0,
            0,
            target.layer,
            width,
            height,
            1,
        );
    }
}

/// An image as copies name it. Renderbuffers have names, as textures do.
struct CopiedImage {
    name: glow::Texture,
    binding: u32,
    level: i32,
    layer: i32,
}

impl CopiedImage {
    fn of(surface: &Surface) -> Self {
        match surface.storage {
            Storage::Texture(part) => Self {
                name: part.texture,
                binding: part.binding,
                level: part.level,
                layer: part.layer,
            },
            Storage::Renderbuffer(buffer) => Self {
                name: glow::NativeTexture(buffer.0),
                binding: glow::RENDERBUFFER,
                level: 0,
                layer: 0,
            },
        }
    }
}

/// Blits a surface to another of the same size and format.
fn blit(context: &Context, format: TextureFormat, from: &Surface, to: &Surface) {
    let gl = &context.gl;
    let [w, h] = from.size().map(|side| side as i32);
    let mask = bits(format.aspects());
    // SAFETY: the context is current and owns the framebuffers.
    unsafe {
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(from.framebuffer));
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to.framebuffer));
        gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, mask, glow::NEAREST);
    }
}

/// Returns the buffer bits of aspects.
pub(crate) fn bits(aspects: &[Aspect]) -> u32 {
    aspects.iter().fold(0, |mask, aspect| {
        mask | match aspect {
            Aspect::Color => glow::COLOR_BUFFER_BIT,
            Aspect::Depth => glow::DEPTH_BUFFER_BIT,
            Aspect::Stencil => glow::STENCIL_BUFFER_BIT,
        }
    })
}
