//! The draw calls of a prepared scene.

use crate::attachment::Attachment;
use crate::clear::{ClearCall, discard};
use crate::context::Context;
use crate::own_pass::{self, OwnPassWay};
use crate::pool::PassFramebuffer;
use crate::program::{PARAMS_BINDING, STORAGE_BINDING};
use crate::query::QueryObject;
use crate::read::spoil;
use crate::state::{self, DrawState};
use crate::surface::Surface;
use crate::vertices::{self, Arguments, Fetched};
use etalon_backend::Blits;
use etalon_frame::{Aspect, PathEnd};
use etalon_scene::Enclosing;
use glow::HasContext;

const PARAMETER_BUFFER: u32 = 0x80EE;

/// The buffers that all draws share, with their sizes in bytes.
#[derive(Default)]
pub(crate) struct DrawBuffers {
    pub(crate) vertices: Option<(glow::Buffer, usize)>,
    pub(crate) indices: Option<(glow::Buffer, usize)>,
    pub(crate) params: Option<(glow::Buffer, usize)>,
    /// The arguments of indirect draws.
    pub(crate) arguments: Option<(glow::Buffer, usize)>,
    /// Zeros, bound as the number of draws during calls that do not read it.
    pub(crate) zeros: Option<(glow::Buffer, usize)>,
    /// The storage buffer in which shaders count.
    pub(crate) runs: Option<(glow::Buffer, usize)>,
    /// The scene's pool.
    pub(crate) pool: Option<(glow::Buffer, usize)>,
}

impl DrawBuffers {
    /// Returns all buffers.
    pub(crate) fn into_buffers(self) -> impl Iterator<Item = (glow::Buffer, usize)> {
        let buffers = [
            self.vertices,
            self.indices,
            self.params,
            self.arguments,
            self.zeros,
            self.runs,
            self.pool,
        ];
        buffers.into_iter().flatten()
    }
}

pub(crate) struct GlPass {
    pub(crate) target: PassFramebuffer,
    pub(crate) draws: Vec<DrawCall>,
    /// The clears of load operations.
    pub(crate) loads: Vec<ClearCall>,
    /// Clear commands in order, each with the index of the draw that it precedes.
    pub(crate) clears: Vec<(usize, ClearCall)>,
    /// True if state that does not change between draws is set only once.
    pub(crate) keeps_state: bool,
    /// The way in which draws read attachments of the pass; `None` if no draw does.
    pub(crate) reads: Option<OwnPassWay>,
    /// The attachment points that the pass discards at its end.
    pub(crate) discards: Vec<u32>,
    /// Multisampled attachments and their resolve targets.
    pub(crate) resolves: Vec<ResolveBlit>,
    /// The queries that begin before the pass, and the queries that end after it.
    pub(crate) queries: Enclosing<QueryObject>,
}

/// A resolve of an attachment to another.
pub(crate) struct ResolveBlit {
    pub(crate) from: usize,
    pub(crate) to: usize,
    /// The intermediate surface: parts are resolved to other positions in it, and moved from there. `None` if
    /// the attachment is resolved in one step.
    pub(crate) between: Option<Surface>,
}

pub(crate) struct DrawCall {
    pub(crate) program: glow::Program,
    /// The program of a second draw, which repeats the draw to the other of two layers.
    pub(crate) again: Option<glow::Program>,
    pub(crate) state: DrawState,
    /// State that is set before the draw's own.
    pub(crate) other: Option<DrawState>,
    /// The textures with their targets.
    pub(crate) textures: Vec<(u32, glow::Texture)>,
    /// True if the shader fetches stencil.
    pub(crate) fetches_stencil: bool,
    /// The sampler; `None` if texels are fetched.
    pub(crate) sampler: Option<glow::Sampler>,
    /// The queries that begin before the draw, and the queries that end after it.
    pub(crate) queries: Enclosing<QueryObject>,
    /// The offset of the counter in bytes, if the shader counts.
    pub(crate) runs: Option<i32>,
    /// True if the shader uses the pool.
    pub(crate) uses_pool: bool,
    /// The offset of the parameter block in bytes, if the shader has one.
    pub(crate) params: Option<i32>,
    pub(crate) mode: u32,
    pub(crate) fetched: Fetched,
    /// True if primitive restart is enabled although the draw has no indices.
    pub(crate) restarts_unindexed: bool,
    /// The arguments of an indirect draw.
    pub(crate) arguments: Option<Arguments>,
    /// True if calls without vertices and without instances precede the draw.
    pub(crate) after_empty: bool,
    /// True if the commands are flushed after the draw.
    pub(crate) flushed: bool,
}

/// Draws all passes.
pub(crate) fn draw_all(
    context: &Context,
    vertex_array: glow::VertexArray,
    inputs: &DrawBuffers,
    passes: &[GlPass],
    attachments: &[Attachment],
) {
    let gl = &context.gl;
    // SAFETY: the context is current and owns all objects.
    unsafe {
        gl.bind_vertex_array(Some(vertex_array));
        gl.bind_buffer(
            glow::ARRAY_BUFFER,
            inputs.vertices.map(|(buffer, _)| buffer),
        );
        // The vertex array stores this binding.
        let indices = inputs.indices.map(|(buffer, _)| buffer);
        gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, indices);
        if inputs.vertices.is_some() {
            vertices::set_pointers(context, 0);
        }
    }
    let mut closed = false;
    // The state that is currently set, if a draw set it, and whether clears and resolves changed some of it.
    let mut set: Option<&DrawState> = None;
    let mut touched = false;
    for pass in passes {
        if std::mem::take(&mut closed) {
            state::reset(context);
            set = None;
        }
        if inputs.indices.is_some() {
            state::set_restart(context);
        }
        // SAFETY: the context owns the framebuffer.
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(pass.target.framebuffer)) };
        pass.queries.begun.iter().for_each(|q| q.begin(context));
        for clear in &pass.loads {
            clear.apply(context);
            touched = true;
        }
        let mut clears = pass.clears.iter().peekable();
        for (index, draw) in pass.draws.iter().enumerate() {
            while let Some((_, clear)) = clears.next_if(|(before, _)| *before <= index) {
                clear.apply(context);
                touched = true;
            }
            let is_set = pass.keeps_state && set == Some(&draw.state);
            if is_set && touched {
                draw.state.restore(context);
            }
            if let Some(way) = pass.reads {
                own_pass::barrier(context, way);
            }
            draw_one(context, inputs, draw, is_set);
            (set, touched) = (Some(&draw.state), false);
        }
        for (_, clear) in clears {
            clear.apply(context);
            touched = true;
        }
        for ResolveBlit { from, to, between } in &pass.resolves {
            if let (Some(from), Some(to)) = (attachments.get(*from), attachments.get(*to)) {
                // Blits are subject to the scissor test.
                if pass.keeps_state && between.is_none() {
                    state::set(gl, glow::SCISSOR_TEST, false);
                    touched = true;
                } else {
                    state::reset(context);
                    closed = true;
                }
                match between {
                    None => resolve(context, &from.surface, &to.surface),
                    Some(between) => move_resolved(context, from, between, to),
                }
            }
        }
        if !pass.discards.is_empty() {
            // SAFETY: as above. A resolve bound other framebuffers.
            unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(pass.target.framebuffer)) };
            discard(context, &pass.discards);
        }
        pass.queries.ended.iter().for_each(|q| q.end(context));
    }
}

/// Draws, and sets the draw's state first unless `is_set` is true.
fn draw_one(context: &Context, inputs: &DrawBuffers, draw: &DrawCall, is_set: bool) {
    let gl = &context.gl;
    if let Some(other) = &draw.other {
        other.apply(context);
    }
    if !is_set {
        draw.state.apply(context);
    }
    // SAFETY: the context is current and owns all objects; vertices, indices and blocks were counted when the
    // buffers were filled.
    unsafe {
        gl.use_program(Some(draw.program));
        if let (Some(offset), Some((buffer, _))) = (draw.params, inputs.params) {
            let (point, size) = (PARAMS_BINDING, size_of::<etalon_scene::Params>() as i32);
            gl.bind_buffer_range(glow::UNIFORM_BUFFER, point, Some(buffer), offset, size);
        }
        for (unit, (target, texture)) in (0..).zip(&draw.textures) {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_texture(*target, Some(*texture));
            gl.bind_sampler(unit, draw.sampler);
        }
        let mode = |mode: u32| {
            for (target, _) in draw.textures.iter().filter(|_| draw.fetches_stencil) {
                gl.tex_parameter_i32(*target, glow::DEPTH_STENCIL_TEXTURE_MODE, mode as i32);
            }
        };
        mode(glow::STENCIL_INDEX);
        let storage = match (draw.runs, draw.uses_pool) {
            (Some(offset), _) => inputs.runs.map(|(b, _)| (b, offset, size_of::<u32>())),
            (None, true) => inputs.pool.map(|(buffer, size)| (buffer, 0, size)),
            (None, false) => None,
        };
        if let Some((buffer, offset, size)) = storage {
            gl.bind_buffer_range(
                glow::SHADER_STORAGE_BUFFER,
                u32::from(STORAGE_BINDING),
                Some(buffer),
                offset,
                size as i32,
            );
        }
        draw.queries.begun.iter().for_each(|q| q.begin(context));
        let arguments = draw.arguments.zip(inputs.arguments);
        if let Some((_, (buffer, _))) = arguments {
            gl.bind_buffer(glow::DRAW_INDIRECT_BUFFER, Some(buffer));
        }
        let place = arguments.map(|(place, _)| place);
        let counted = place.is_some_and(Arguments::is_counted);
        let numbers = if counted {
            inputs.arguments
        } else {
            inputs.zeros
        };
        if let Some((buffer, _)) = numbers.filter(|_| place.is_some()) {
            gl.bind_buffer(PARAMETER_BUFFER, Some(buffer));
        }
        draw.state.begin_advanced(context);
        if draw.restarts_unindexed {
            state::set_restart_unindexed(context, draw.fetched.second_vertex());
        }
        if draw.after_empty {
            draw.fetched.draw_empty(context, draw.mode);
        }
        draw.fetched.draw(context, draw.mode, place);
        if let Some(again) = draw.again {
            gl.use_program(Some(again));
            draw.fetched.draw(context, draw.mode, place);
        }
        if draw.restarts_unindexed {
            state::unset_restart_unindexed(context);
        }
        draw.state.end_advanced(context);
        mode(glow::DEPTH_COMPONENT);
        if numbers.is_some() {
            // Mesa takes the number of draws from a bound buffer for all indirect draws.
            gl.bind_buffer(PARAMETER_BUFFER, None);
        }
        draw.queries.ended.iter().for_each(|q| q.end(context));
        if storage.is_some() {
            // The next draw might use the same counter, or read the pool.
            gl.memory_barrier(glow::SHADER_STORAGE_BARRIER_BIT);
        }
        if draw.flushed {
            gl.flush();
        }
    }
}

/// Resolves a colour surface to another of the same size and format.
fn resolve(context: &Context, from: &Surface, to: &Surface) {
    let gl = &context.gl;
    let [w, h] = from.size().map(|side| side as i32);
    // SAFETY: the context is current and owns the framebuffers.
    unsafe {
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(from.framebuffer));
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to.framebuffer));
        let (mask, filter) = (glow::COLOR_BUFFER_BIT, glow::NEAREST);
        gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, mask, filter);
    }
}

/// Resolves the parts of a colour attachment to other positions in an intermediate surface, and copies each
/// part to its position in the target attachment.
fn move_resolved(context: &Context, from: &Attachment, between: &Surface, to: &Attachment) {
    let pieces = Blits::new(PathEnd::BlitPart, to.surface.size());
    let pieces = pieces.map(|blits| blits.pieces(Aspect::Color));
    let pieces = pieces.unwrap_or_default();
    // The spoiled values show if the driver loses a resolve.
    spoil(context, to.format, between);
    for piece in &pieces {
        let (source, target) = (&from.surface, between);
        copy_part(
            context,
            (source, piece.to),
            (target, piece.from),
            piece.size,
        );
    }
    for piece in &pieces {
        let (source, target) = (between, &to.surface);
        copy_part(
            context,
            (source, piece.from),
            (target, piece.to),
            piece.size,
        );
    }
}

/// Copies the colours of a part of a surface to a position in another.
fn copy_part(
    context: &Context,
    (from, start): (&Surface, [u32; 2]),
    (to, place): (&Surface, [u32; 2]),
    size: [u32; 2],
) {
    let gl = &context.gl;
    let corners = |[x, y]: [u32; 2]| {
        let number = |place: u32| place as i32;
        [x, y, x + size[0], y + size[1]].map(number)
    };
    let ([left, top, right, bottom], [to_left, to_top, to_right, to_bottom]) =
        (corners(start), corners(place));
    // SAFETY: the context is current and owns the framebuffers.
    unsafe {
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(from.framebuffer));
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to.framebuffer));
        let (mask, filter) = (glow::COLOR_BUFFER_BIT, glow::NEAREST);
        gl.blit_framebuffer(
            left, top, right, bottom, to_left, to_top, to_right, to_bottom, mask, filter,
        );
    }
}
