//! A scene with all its objects, ready to be drawn.

use crate::GlBackend;
use crate::context::{Context, refused};
use crate::format::gl_format;
use crate::program::PARAMS_BINDING;
use crate::read::{Reading, Source};
use crate::state::{self, DrawState};
use crate::surface::{Pool, Surface, SurfaceKind, Target};
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_case::scene::{Contents, Draw, Scene};
use etalon_case::{Vertex, scene};
use etalon_frame::{Frame, Requirement, TextureFormat};
use glow::HasContext;
use std::mem::offset_of;
use std::time::{Duration, Instant};

/// A scene's objects. On drop they go back to the backend.
pub(crate) struct GlPrepared<'a> {
    backend: &'a GlBackend,
    attachments: Vec<Attachment>,
    passes: Vec<Pass>,
    read: Vec<usize>,
    /// Buffers and their sizes in bytes.
    vertices: Option<(glow::Buffer, usize)>,
    params: Option<(glow::Buffer, usize)>,
    submitted: bool,
    /// Nothing has failed, so that the objects may serve another scene.
    sound: bool,
}

struct Attachment {
    name: String,
    format: TextureFormat,
    surface: Surface,
    start: Start,
}

/// How an attachment gets its first contents at each submit.
enum Start {
    /// Uploaded once: no pass draws to it.
    Uploaded,
    Upload(Vec<u8>),
    Color([f32; 4]),
    DepthStencil(f32, u8),
}

struct Pass {
    target: Target,
    size: [u32; 2],
    draws: Vec<DrawCall>,
}

struct DrawCall {
    program: glow::Program,
    state: DrawState,
    textures: Vec<glow::Texture>,
    /// Where the parameter block lies, if the shader has one.
    params: Option<i32>,
    mode: u32,
    first: i32,
    count: i32,
}

impl<'a> GlPrepared<'a> {
    pub(crate) fn new(backend: &'a GlBackend, scene: &Scene) -> Result<Self, BackendError> {
        let mut prepared = Self {
            backend,
            attachments: Vec::new(),
            passes: Vec::new(),
            read: scene.read.clone(),
            vertices: None,
            params: None,
            submitted: false,
            sound: false,
        };
        prepared.fill(scene)?;
        backend.context.check("preparing a scene")?;
        prepared.sound = true;
        Ok(prepared)
    }

    fn fill(&mut self, scene: &Scene) -> Result<(), BackendError> {
        let context = &self.backend.context;
        state::reset(context);
        let mut pool = self.backend.pool.borrow_mut();
        for (index, attachment) in scene.attachments.iter().enumerate() {
            let is_drawn =
                |p: &scene::Pass| p.color.contains(&index) || p.depth_stencil == Some(index);
            let drawn = scene.passes.iter().any(is_drawn);
            self.attachment(&mut pool, attachment, drawn, scene.read.contains(&index))?;
        }
        self.buffers(&mut pool, scene)?;
        let mut first = 0;
        let mut params = 0;
        for pass in &scene.passes {
            self.pass(&mut pool, pass, &mut first, &mut params)?;
        }
        Ok(())
    }

    fn attachment(
        &mut self,
        pool: &mut Pool,
        attachment: &scene::Attachment,
        drawn: bool,
        read: bool,
    ) -> Result<(), BackendError> {
        let context = &self.backend.context;
        let format = attachment.format;
        let kind = SurfaceKind::Attachment(format);
        let surface = pool.surface(context, kind, attachment.size)?;
        let start = match &attachment.contents {
            Contents::Color(color) => Start::Color(*color),
            Contents::DepthStencil { depth, stencil } => Start::DepthStencil(*depth, *stencil),
            Contents::Texels(codes) => {
                let bytes = match format {
                    TextureFormat::Rgba8Unorm => codes.iter().map(|c| *c as u8).collect(),
                    _ => bytemuck::cast_slice(codes).to_vec(),
                };
                let texels = attachment.size[0] as usize * attachment.size[1] as usize;
                if codes.len() != texels * 4 {
                    return Err(BackendError::Internal(format!(
                        "{} codes for {texels} texels of {format}",
                        codes.len()
                    )));
                }
                if drawn {
                    Start::Upload(bytes)
                } else {
                    upload(context, format, &surface, &bytes);
                    Start::Uploaded
                }
            }
        };
        let needs_framebuffer = read || !matches!(start, Start::Uploaded);
        let complete = surface.is_complete();
        self.attachments.push(Attachment {
            name: attachment.name.clone(),
            format,
            surface,
            start,
        });
        if needs_framebuffer && !complete {
            return Err(BackendError::NotSupported(Requirement::Format(format)));
        }
        Ok(())
    }

    /// All vertices in one buffer, all parameter blocks in another.
    fn buffers(&mut self, pool: &mut Pool, scene: &Scene) -> Result<(), BackendError> {
        let context = &self.backend.context;
        let mut vertices = Vec::new();
        let mut params = Vec::new();
        for draw in scene.passes.iter().flat_map(|pass| &pass.draws) {
            vertices.extend_from_slice(draw.mesh.bytes());
            if draw.shader.uses_params() {
                params.extend_from_slice(&draw.params.to_bytes());
                params.resize(params.len().next_multiple_of(self.backend.params_stride), 0);
            }
        }
        // Positions within buffers are 32-bit.
        let most = i32::MAX as usize;
        if vertices.len() > most || params.len() > most {
            return Err(refused(
                "a buffer",
                "the scene has too many vertices or draws",
            ));
        }
        if !vertices.is_empty() {
            let buffer = pool.buffer(context, glow::ARRAY_BUFFER, &vertices)?;
            self.vertices = Some((buffer, vertices.len()));
        }
        if !params.is_empty() {
            let buffer = pool.buffer(context, glow::UNIFORM_BUFFER, &params)?;
            self.params = Some((buffer, params.len()));
        }
        Ok(())
    }

    fn pass(
        &mut self,
        pool: &mut Pool,
        pass: &scene::Pass,
        first: &mut i32,
        params: &mut i32,
    ) -> Result<(), BackendError> {
        let context = &self.backend.context;
        if pass.color.len() > context.caps.max_color_targets {
            return Err(refused(
                "a framebuffer",
                format!("{} colour attachments", pass.color.len()),
            ));
        }
        let attachment = |index: usize| {
            let missing = || BackendError::Internal(format!("there is no attachment {index}"));
            self.attachments.get(index).ok_or_else(missing)
        };
        let color: Vec<&Attachment> = pass
            .color
            .iter()
            .map(|i| attachment(*i))
            .collect::<Result<_, _>>()?;
        let depth = pass.depth_stencil.map(attachment).transpose()?;
        let Some(any) = depth.or(color.first().copied()) else {
            return Err(BackendError::Internal(
                "a pass has no attachment".to_owned(),
            ));
        };
        let size = any.surface.size();
        let format = any.format;
        let surfaces: Vec<&Surface> = color.iter().map(|a| &a.surface).collect();
        let target = pool
            .target(context, &surfaces, depth.map(|a| &a.surface))?
            .ok_or(BackendError::NotSupported(Requirement::Format(format)))?;
        let mut draws = Vec::new();
        for draw in &pass.draws {
            // On error the target is lost to the pool; it goes with the context.
            draws.push(self.draw(draw, first, params)?);
        }
        self.passes.push(Pass {
            target,
            size,
            draws,
        });
        Ok(())
    }

    fn draw(
        &self,
        draw: &Draw,
        first: &mut i32,
        params: &mut i32,
    ) -> Result<DrawCall, BackendError> {
        let context = &self.backend.context;
        let count = draw.mesh.vertices.len() as i32;
        let block = draw.shader.uses_params().then_some(*params);
        let textures = draw
            .textures
            .iter()
            .map(|index| {
                let attachment = self.attachments.get(*index);
                attachment.and_then(|a| a.surface.texture()).ok_or_else(|| {
                    BackendError::Internal(format!("attachment {index} is no texture"))
                })
            })
            .collect::<Result<_, _>>()?;
        let call = DrawCall {
            program: self
                .backend
                .programs
                .borrow_mut()
                .shader(context, draw.shader)?,
            state: DrawState::new(context, draw)?,
            textures,
            params: block,
            mode: state::topology(draw.topology),
            first: *first,
            count,
        };
        *first += count;
        if block.is_some() {
            *params += self.backend.params_stride as i32;
        }
        Ok(call)
    }

    fn initialise(&self) {
        let context = &self.backend.context;
        let gl = &context.gl;
        for attachment in &self.attachments {
            let surface = &attachment.surface;
            // SAFETY: the context is current; masks and scissor are open (`state::reset`).
            unsafe {
                match &attachment.start {
                    Start::Uploaded => {}
                    Start::Upload(bytes) => upload(context, attachment.format, surface, bytes),
                    Start::Color(color) => {
                        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
                        gl.clear_buffer_f32_slice(glow::COLOR, 0, color);
                    }
                    Start::DepthStencil(depth, stencil) => {
                        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.framebuffer));
                        let stencil = i32::from(*stencil);
                        let format = attachment.format;
                        match (format.has_depth(), format.has_stencil()) {
                            (true, true) => {
                                gl.clear_buffer_depth_stencil(
                                    glow::DEPTH_STENCIL,
                                    0,
                                    *depth,
                                    stencil,
                                );
                            }
                            (true, false) => gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[*depth]),
                            _ => gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[stencil]),
                        }
                    }
                }
            }
        }
    }

    fn draw_all(&self) {
        let gl = &self.backend.context.gl;
        // SAFETY: the context is current and all objects are its own; vertex positions were
        // counted when the buffer was filled.
        unsafe {
            gl.bind_vertex_array(Some(self.backend.vertex_array));
            gl.bind_buffer(glow::ARRAY_BUFFER, self.vertices.map(|(buffer, _)| buffer));
            let attributes = [
                (0, 4, offset_of!(Vertex, position)),
                (1, 4, offset_of!(Vertex, color)),
                (2, 2, offset_of!(Vertex, uv)),
            ];
            if self.vertices.is_some() {
                let stride = size_of::<Vertex>() as i32;
                for (index, size, offset) in attributes {
                    let kind = glow::FLOAT;
                    let offset = offset as i32;
                    gl.vertex_attrib_pointer_f32(index, size, kind, false, stride, offset);
                }
            }
            for pass in &self.passes {
                gl.bind_framebuffer(glow::FRAMEBUFFER, Some(pass.target.framebuffer));
                gl.viewport(0, 0, pass.size[0] as i32, pass.size[1] as i32);
                for draw in &pass.draws {
                    draw.state.apply(gl);
                    gl.use_program(Some(draw.program));
                    if let (Some(offset), Some((buffer, _))) = (draw.params, self.params) {
                        let (point, size) = (PARAMS_BINDING, size_of::<scene::Params>() as i32);
                        let buffer = Some(buffer);
                        gl.bind_buffer_range(glow::UNIFORM_BUFFER, point, buffer, offset, size);
                    }
                    for (unit, texture) in (0..).zip(&draw.textures) {
                        gl.active_texture(glow::TEXTURE0 + unit);
                        gl.bind_texture(glow::TEXTURE_2D, Some(*texture));
                    }
                    gl.draw_arrays(draw.mode, draw.first, draw.count);
                }
            }
        }
    }

    fn try_submit(&self) -> Result<FrameTime, BackendError> {
        let backend = self.backend;
        let context = &backend.context;
        let gl = &context.gl;
        context.make_current()?;
        let start = Instant::now();
        state::reset(context);
        self.initialise();
        // SAFETY: the context is current; a query exists only where timers count.
        let (cpu, wall) = unsafe {
            if let Some(query) = backend.timer {
                gl.begin_query(glow::TIME_ELAPSED, query);
            }
            self.draw_all();
            if backend.timer.is_some() {
                gl.end_query(glow::TIME_ELAPSED);
            }
            gl.flush();
            let cpu = start.elapsed();
            gl.finish();
            (cpu, start.elapsed())
        };
        context.check("drawing a scene")?;
        let gpu = backend.timer.and_then(|query| context.elapsed(query));
        Ok(FrameTime {
            cpu,
            gpu: gpu.map(Duration::from_nanos),
            wall,
        })
    }

    fn try_read_back(&self) -> Result<Frame, BackendError> {
        let backend = self.backend;
        backend.context.make_current()?;
        let mut reading = Reading {
            context: &backend.context,
            pool: &mut backend.pool.borrow_mut(),
            programs: &mut backend.programs.borrow_mut(),
            no_vertices: backend.no_vertices,
        };
        let mut frame = Frame::default();
        for index in &self.read {
            let attachment = self.attachments.get(*index);
            let known = attachment.and_then(|a| Some((a, backend.formats.get(&a.format)?)));
            let Some((attachment, support)) = known else {
                let message = format!("attachment {index} cannot be read");
                return Err(BackendError::Internal(message));
            };
            frame.images.extend(reading.images(&Source {
                name: &attachment.name,
                format: attachment.format,
                plan: support.read,
                depth: &support.limits.depth,
                surface: &attachment.surface,
            })?);
        }
        backend.context.check("reading a frame back")?;
        Ok(frame)
    }
}

impl Prepared for GlPrepared<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let result = self.try_submit();
        self.sound &= result.is_ok();
        self.submitted |= result.is_ok();
        result
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        if !self.submitted {
            return Err(BackendError::Internal(
                "a frame was to be read before it was drawn".to_owned(),
            ));
        }
        let result = self.try_read_back();
        if result.is_err() {
            self.sound = false;
            // What was made for reading may be what failed.
            let backend = self.backend;
            backend.pool.borrow_mut().delete_surfaces(&backend.context);
        }
        result
    }
}

impl Drop for GlPrepared<'_> {
    fn drop(&mut self) {
        let context = &self.backend.context;
        if context.make_current().is_err() {
            // All objects are gone with the context.
            return;
        }
        let mut pool = self.backend.pool.borrow_mut();
        for pass in self.passes.drain(..) {
            if self.sound {
                pool.put_target(context, pass.target);
            } else {
                pass.target.delete(context);
            }
        }
        for attachment in self.attachments.drain(..) {
            if self.sound {
                pool.put_surface(context, attachment.surface);
            } else {
                // Its storage may never have come to be.
                attachment.surface.delete(context);
            }
        }
        for (buffer, size) in [self.vertices.take(), self.params.take()]
            .into_iter()
            .flatten()
        {
            pool.put_buffer(context, buffer, size);
        }
    }
}

/// Replaces a colour texture's contents. The bytes cover it.
fn upload(context: &Context, format: TextureFormat, surface: &Surface, bytes: &[u8]) {
    let gl = &context.gl;
    let words = gl_format(format);
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
