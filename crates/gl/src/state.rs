//! Pipeline state. Every draw sets what is enabled and disabled, so that no cache can be stale.
//!
//! The parameters of disabled state stay as an earlier draw or [`reset`] set them. They must have no effect, so
//! `reset` chooses values whose effect would be visible: a driver that ignores the enable must not pass by
//! chance.

use crate::context::Context;
use crate::enums::{advanced_equation, compare, equations, logic_operation, mask, operation};
use crate::path::Variant;
use etalon_backend::BackendError;
use etalon_frame::{Feature, PathClip, PathViewport, Requirement};
use etalon_scene::{
    ColorTarget, CullMode, DepthBias, DepthState, Draw, FrontFace, Multisample, Path, PolygonMode,
    PrimitiveTopology, ProvokingVertex, RESTART, RESTART_16, SampleCoverage, StencilFace,
    StencilState, Viewport,
};
use glow::HasContext;

const DEPTH_BOUNDS_TEST: u32 = 0x8890;
const SAMPLE_SHADING: u32 = 0x8C36;
const FIRST_VERTEX_CONVENTION: u32 = 0x8E4D;
const LAST_VERTEX_CONVENTION: u32 = 0x8E4E;

/// The state of a draw, ready to be set.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawState {
    cull: Option<u32>,
    front_face: u32,
    polygon_mode: u32,
    /// The convention of the provoking vertex.
    provoking: u32,
    /// The capability that enables depth bias for the draw's polygon mode.
    offset: u32,
    /// True if the draw has polygons.
    polygons: bool,
    rasterizer_discard: bool,
    viewport: Viewport,
    viewports: PathViewport,
    /// The clip volume's origin, if it differs between draws.
    origin: Option<u32>,
    scissor: Option<[i32; 4]>,
    /// The bits of the clip distances that clip.
    clip_distances: u8,
    depth_bias: Option<DepthBias>,
    depth_clamp: bool,
    depth_bounds: Option<[f32; 2]>,
    depth: Option<DepthState>,
    stencil: Option<StencilState>,
    /// True if the pass writes neither depth nor stencil.
    read_only: bool,
    targets: Vec<ColorTarget>,
    logic: Option<u32>,
    multisample: Multisample,
    blend_constant: [f32; 4],
}

impl DrawState {
    /// Returns a draw's state, or an error if the context does not support it.
    pub(crate) fn new(
        context: &Context,
        draw: &Draw,
        read_only: bool,
        path: &Path,
        variant: Variant,
    ) -> Result<Self, BackendError> {
        if !viewport_fits(context, &draw.viewport) {
            let requirement = Requirement::Feature(Feature::ViewportOutside);
            return Err(BackendError::NotSupported(requirement));
        }
        let differ = draw.targets.windows(2).any(|pair| pair[0] != pair[1]);
        // Without clip control the shaders mirror y, which inverts every winding.
        let mirrored = variant.mirrored || !context.caps.clip_control;
        let ccw = (draw.front_face == FrontFace::Ccw) != mirrored;
        Ok(Self {
            cull: match draw.cull {
                CullMode::None => None,
                CullMode::Front => Some(glow::FRONT),
                CullMode::Back => Some(glow::BACK),
                CullMode::FrontAndBack => Some(glow::FRONT_AND_BACK),
            },
            front_face: if ccw { glow::CCW } else { glow::CW },
            polygon_mode: match draw.polygon_mode {
                PolygonMode::Fill => glow::FILL,
                PolygonMode::Line => glow::LINE,
            },
            provoking: match draw.provoking {
                Some(ProvokingVertex::First) => FIRST_VERTEX_CONVENTION,
                None | Some(ProvokingVertex::Last) => LAST_VERTEX_CONVENTION,
            },
            offset: match draw.polygon_mode {
                PolygonMode::Fill => glow::POLYGON_OFFSET_FILL,
                PolygonMode::Line => glow::POLYGON_OFFSET_LINE,
            },
            polygons: match draw.topology {
                PrimitiveTopology::PointList
                | PrimitiveTopology::LineList
                | PrimitiveTopology::LineStrip => false,
                PrimitiveTopology::TriangleList
                | PrimitiveTopology::TriangleStrip
                | PrimitiveTopology::TriangleFan => true,
            },
            rasterizer_discard: draw.rasterizer_discard,
            viewport: draw.viewport,
            viewports: path.viewport,
            origin: match path.clip {
                PathClip::Constant => None,
                PathClip::Toggled if variant.mirrored => Some(glow::LOWER_LEFT),
                PathClip::Toggled => Some(glow::UPPER_LEFT),
            },
            scissor: draw.scissor.map(scissor),
            clip_distances: draw.clipping_distances(),
            depth_bias: (draw.depth_bias != DepthBias::default()).then_some(draw.depth_bias),
            depth_clamp: draw.depth_clamp,
            depth_bounds: draw.depth_bounds,
            depth: draw.depth,
            stencil: draw.stencil,
            read_only,
            targets: if differ {
                draw.targets.clone()
            } else {
                draw.targets.iter().take(1).copied().collect()
            },
            logic: draw.logic.map(logic_operation),
            multisample: draw.multisample,
            blend_constant: draw.blend_constant,
        })
    }

    /// Sets the state. State that the context lacks is off; the limits deny it.
    pub(crate) fn apply(&self, context: &Context) {
        self.apply_rasterization(context);
        self.apply_tests(context);
        self.apply_multisample(context);
        self.apply_targets(context);
    }

    /// Sets what clears and resolves change: the scissor test, masks and rasterizer discard.
    pub(crate) fn restore(&self, context: &Context) {
        let gl = &context.gl;
        if self.viewports != PathViewport::One {
            self.apply(context);
            return;
        }
        set(gl, glow::RASTERIZER_DISCARD, self.rasterizer_discard);
        set(gl, glow::SCISSOR_TEST, self.scissor.is_some());
        // SAFETY: the context is current; the entry points are part of version 3, and targets differ only if
        // the context supports it.
        unsafe {
            if let Some([x, y, w, h]) = self.scissor {
                gl.scissor(x, y, w, h);
            }
            self.set_color_masks(gl);
            gl.depth_mask(self.depth.is_some_and(|d| d.write) && !self.read_only);
            for (face, stencil) in [
                (glow::FRONT, self.stencil.map(|s| s.front)),
                (glow::BACK, self.stencil.map(|s| s.back)),
            ] {
                let bits = stencil
                    .filter(|_| !self.read_only)
                    .map_or(0, |s| s.write_mask);
                gl.stencil_mask_separate(face, u32::from(bits));
            }
        }
    }

    fn apply_rasterization(&self, context: &Context) {
        let gl = &context.gl;
        set(gl, glow::CULL_FACE, self.cull.is_some());
        set(gl, glow::RASTERIZER_DISCARD, self.rasterizer_discard);
        set(gl, glow::SCISSOR_TEST, self.scissor.is_some());
        self.apply_offset(context);
        // SAFETY: the context is current; entry points are part of version 3 or supported, and polygon modes
        // are set only in core profiles.
        unsafe {
            if let Some(face) = self.cull {
                gl.cull_face(face);
            }
            gl.front_face(self.front_face);
            if let Some(provoking_vertex) = context.entry_points.provoking_vertex {
                provoking_vertex(self.provoking);
            }
            if !context.caps.es {
                gl.polygon_mode(glow::FRONT_AND_BACK, self.polygon_mode);
            }
            match self.viewports {
                PathViewport::One => self.apply_viewport(context),
                PathViewport::WithCount => self.apply_viewports(context, 1),
                PathViewport::Array => self.apply_viewports(context, 2),
            }
            if let (Some(origin), Some(clip_control)) =
                (self.origin, context.entry_points.clip_control)
            {
                clip_control(glow::LOWER_LEFT, glow::NEGATIVE_ONE_TO_ONE);
                clip_control(origin, glow::ZERO_TO_ONE);
            }
        }
        if context.caps.depth_clamp {
            set(gl, glow::DEPTH_CLAMP, self.depth_clamp);
        }
        if context.caps.clip_distances {
            for number in 0..u8::BITS {
                let clips = self.clip_distances & (1 << number) != 0;
                set(gl, glow::CLIP_DISTANCE0 + number, clips);
            }
        }
    }

    /// Sets the viewport and the scissor rectangle of all viewports.
    ///
    /// # Safety
    /// The context is current.
    unsafe fn apply_viewport(&self, context: &Context) {
        let gl = &context.gl;
        // SAFETY: upheld by the caller.
        unsafe {
            let [x, y, w, h] = self.viewport.rect;
            match context.entry_points.viewport_indexed {
                Some(viewport) => viewport(0, x, y, w, h),
                None => gl.viewport(x as i32, y as i32, w as i32, h as i32),
            }
            let [near, far] = self.viewport.depth;
            if context.caps.es {
                gl.depth_range_f32(near, far);
            } else {
                gl.depth_range_f64(f64::from(near), f64::from(far));
            }
            if let Some([x, y, w, h]) = self.scissor {
                gl.scissor(x, y, w, h);
            }
        }
    }

    /// Sets the last of `count` viewports and scissor rectangles to the draw's, and the ones before it to
    /// others.
    ///
    /// # Safety
    /// The context is current.
    unsafe fn apply_viewports(&self, context: &Context, count: i32) {
        let functions = &context.entry_points;
        let (Some(viewports), Some(scissors), Some(ranges)) = (
            functions.viewport_array,
            functions.scissor_array,
            functions.depth_range_array,
        ) else {
            return;
        };
        let skipped = 2 - count as usize;
        let [x, y, w, h] = self.viewport.rect;
        let rects = [[1.0, 1.0, 3.0, 2.0], [x, y, w, h]];
        let [near, far] = self.viewport.depth.map(f64::from);
        let depths = [[0.125, 0.25], [near, far]];
        // SAFETY: upheld by the caller; each array has `count` elements left.
        unsafe {
            viewports(0, count, rects[skipped..].as_ptr().cast());
            ranges(0, count, depths[skipped..].as_ptr().cast());
            if let Some(rect) = self.scissor {
                let rects = [[1, 1, 2, 1], rect];
                scissors(0, count, rects[skipped..].as_ptr().cast());
            }
        }
    }

    /// Sets the depth bias. Only the capability of the draw's polygon mode enables it (OpenGL 4.6, 14.6.5),
    /// so the others stay unchanged. Points and lines are not polygons and no capability biases them, so all
    /// capabilities are set.
    fn apply_offset(&self, context: &Context) {
        let gl = &context.gl;
        let offset_of_mode = [self.offset];
        let capabilities: &[u32] = match (self.polygons, context.caps.es) {
            (true, _) => &offset_of_mode,
            (false, false) => &POLYGON_OFFSETS,
            (false, true) => &POLYGON_OFFSETS[..1],
        };
        for capability in capabilities {
            set(gl, *capability, self.depth_bias.is_some());
        }
        if let Some(DepthBias {
            constant,
            slope,
            clamp,
        }) = self.depth_bias
        {
            // SAFETY: the context is current; entry points are supported.
            unsafe { offset(context, constant as f32, slope, clamp) };
        }
    }

    fn apply_tests(&self, context: &Context) {
        let gl = &context.gl;
        if let Some(bounds) = context.entry_points.depth_bounds {
            set(gl, DEPTH_BOUNDS_TEST, self.depth_bounds.is_some());
            if let Some([low, high]) = self.depth_bounds {
                // SAFETY: the context is current and has the function.
                unsafe { bounds(f64::from(low), f64::from(high)) };
            }
        }
        set(gl, glow::DEPTH_TEST, self.depth.is_some());
        set(gl, glow::STENCIL_TEST, self.stencil.is_some());
        // SAFETY: the context is current; the entry points are part of version 3.
        unsafe {
            if let Some(depth) = self.depth {
                gl.depth_func(compare(depth.compare));
                gl.depth_mask(depth.write);
            }
            if let Some(stencil) = self.stencil {
                stencil_face(gl, glow::FRONT, stencil.front);
                stencil_face(gl, glow::BACK, stencil.back);
            }
            if self.read_only {
                gl.depth_mask(false);
                gl.stencil_mask(0);
            }
        }
    }

    fn apply_multisample(&self, context: &Context) {
        let gl = &context.gl;
        let Multisample {
            mask,
            alpha_to_coverage,
            alpha_to_one,
            min_sample_shading,
            sample_coverage,
        } = self.multisample;
        set(gl, glow::SAMPLE_ALPHA_TO_COVERAGE, alpha_to_coverage);
        if context.caps.alpha_to_one {
            set(gl, glow::SAMPLE_ALPHA_TO_ONE, alpha_to_one);
        }
        if let Some(set_mask) = context.entry_points.sample_mask {
            set(gl, glow::SAMPLE_MASK, mask != u32::MAX);
            if mask != u32::MAX {
                // SAFETY: the context is current and has the function.
                unsafe { set_mask(0, mask) };
            }
        }
        set(gl, glow::SAMPLE_COVERAGE, sample_coverage.is_some());
        if let Some(SampleCoverage { value, invert }) = sample_coverage {
            // SAFETY: the context is current.
            unsafe { gl.sample_coverage(value, invert) };
        }
        if let Some(set_share) = context.entry_points.min_sample_shading {
            set(gl, SAMPLE_SHADING, min_sample_shading.is_some());
            if let Some(share) = min_sample_shading {
                // SAFETY: the context is current and has the function.
                unsafe { set_share(share) };
            }
        }
    }

    /// Returns the draw's advanced blend equation, if its first target has one.
    fn advanced(&self) -> Option<u32> {
        let mode = self.targets.first().and_then(|t| t.advanced);
        mode.map(advanced_equation)
    }

    /// Sets the advanced blend equation, if the draw has one.
    pub(crate) fn begin_advanced(&self, context: &Context) {
        let Some(equation) = self.advanced() else {
            return;
        };
        // SAFETY: the context is current and has the equation.
        unsafe { context.gl.blend_equation(equation) };
        if let (false, Some(barrier)) = (
            context.caps.coherent_blend,
            context.entry_points.blend_barrier,
        ) {
            // SAFETY: the context is current and has the function.
            unsafe { barrier() };
        }
    }

    /// Resets the advanced blend equation. With several targets or another shader, it would be an error even
    /// if blending is disabled (OpenGL ES 3.2, 15.1.5.3, Errors).
    pub(crate) fn end_advanced(&self, context: &Context) {
        if self.advanced().is_some() {
            // SAFETY: the context is current.
            unsafe { context.gl.blend_equation(glow::FUNC_ADD) };
        }
    }

    /// Sets the written channels of each target.
    ///
    /// # Safety
    /// The context is current; targets differ only if it supports that.
    unsafe fn set_color_masks(&self, gl: &glow::Context) {
        // SAFETY: upheld by the caller.
        unsafe {
            if let [target] = self.targets.as_slice() {
                let [r, g, b, a] = mask(target);
                gl.color_mask(r, g, b, a);
                return;
            }
            for (i, target) in (0..).zip(&self.targets) {
                let [r, g, b, a] = mask(target);
                gl.color_mask_draw_buffer(i, r, g, b, a);
            }
        }
    }

    fn apply_targets(&self, context: &Context) {
        let gl = &context.gl;
        if let Some(set_logic) = context.entry_points.logic_op {
            set(gl, glow::COLOR_LOGIC_OP, self.logic.is_some());
            if let Some(operation) = self.logic {
                // SAFETY: the context is current and has the function.
                unsafe { set_logic(operation) };
            }
        }
        // SAFETY: the context is current; the entry points are part of version 3, and targets differ only if
        // the context supports it.
        unsafe {
            let [r, g, b, a] = self.blend_constant;
            gl.blend_color(r, g, b, a);
            self.set_color_masks(gl);
            if let [target] = self.targets.as_slice() {
                set(gl, glow::BLEND, target.blends());
                match target.blend {
                    _ if self.advanced().is_some() => {}
                    Some(blend) => {
                        let (color, alpha) = equations(blend);
                        gl.blend_equation_separate(color.0, alpha.0);
                        gl.blend_func_separate(color.1, color.2, alpha.1, alpha.2);
                    }
                    // If a factor is the second source, Mesa refuses several targets even if blending is
                    // disabled. These factors would keep the destination.
                    None => gl.blend_func(glow::ZERO, glow::ONE),
                }
                return;
            }
            // This also applies to draw buffers beyond the targets, which the loop does not reach.
            gl.blend_func(glow::ZERO, glow::ONE);
            for (i, target) in (0..).zip(&self.targets) {
                match target.blend {
                    Some(blend) => {
                        gl.enable_draw_buffer(glow::BLEND, i);
                        let (color, alpha) = equations(blend);
                        gl.blend_equation_separate_draw_buffer(i, color.0, alpha.0);
                        gl.blend_func_separate_draw_buffer(i, color.1, color.2, alpha.1, alpha.2);
                    }
                    None => {
                        gl.disable_draw_buffer(glow::BLEND, i);
                        gl.blend_func_draw_buffer(i, glow::ZERO, glow::ONE);
                    }
                }
            }
        }
    }
}

/// The capabilities that enable depth bias, filled polygons first. ES has only that one.
const POLYGON_OFFSETS: [u32; 3] = [
    glow::POLYGON_OFFSET_FILL,
    glow::POLYGON_OFFSET_LINE,
    glow::POLYGON_OFFSET_POINT,
];

/// Sets the parameters of the depth bias.
///
/// # Safety
/// The context is current.
unsafe fn offset(context: &Context, constant: f32, slope: f32, clamp: f32) {
    // SAFETY: upheld by the caller, and the entry point is supported.
    unsafe {
        match context.entry_points.polygon_offset_clamp {
            // Without a clamp, the older function is used; it sets the clamp to 0.
            Some(offset) if clamp != 0.0 => offset(slope, constant, clamp),
            _ => context.gl.polygon_offset(slope, constant),
        }
    }
}

/// Enables or disables a capability that the context has.
pub(crate) fn set(gl: &glow::Context, capability: u32, on: bool) {
    // SAFETY: the context is current.
    unsafe {
        if on {
            gl.enable(capability);
        } else {
            gl.disable(capability);
        }
    }
}

/// Returns true if GL does not clamp a viewport to its largest size (OpenGL 4.6, 13.8.1). An attachment is not larger.
fn viewport_fits(context: &Context, viewport: &Viewport) -> bool {
    let [_, _, w, h] = viewport.rect;
    let [most_w, most_h] = context.caps.max_viewport;
    w <= most_w as f32 && h <= most_h as f32
}

/// Returns the scissor rectangle in signed integers, which GL takes.
fn scissor(rect: [u32; 4]) -> [i32; 4] {
    let [x, y, w, h] = rect.map(|v| i32::try_from(v).unwrap_or(i32::MAX));
    [x, y, w.min(i32::MAX - x), h.min(i32::MAX - y)]
}

/// Enables primitive restart at the largest index.
pub(crate) fn set_restart(context: &Context) {
    let gl = &context.gl;
    if context.caps.fixed_restart {
        set(gl, glow::PRIMITIVE_RESTART_FIXED_INDEX, true);
    } else if let Some(index) = context.entry_points.primitive_restart_index {
        set(gl, glow::PRIMITIVE_RESTART, true);
        // SAFETY: the context is current and has the function.
        unsafe { index(RESTART) };
    }
}

/// Enables primitive restart for a draw without indices, on which it must have no effect. If the context lets
/// the restart index be set, it is the number of a vertex that is drawn.
pub(crate) fn set_restart_unindexed(context: &Context, vertex: u32) {
    let gl = &context.gl;
    match context.entry_points.primitive_restart_index {
        Some(index) if !context.caps.es => {
            // The fixed index would take precedence over this index.
            set(gl, glow::PRIMITIVE_RESTART_FIXED_INDEX, false);
            set(gl, glow::PRIMITIVE_RESTART, true);
            // SAFETY: the context is current and has the function.
            unsafe { index(vertex) };
        }
        _ => set_restart(context),
    }
}

/// Undoes [`set_restart_unindexed`].
pub(crate) fn unset_restart_unindexed(context: &Context) {
    if !context.caps.es {
        set(&context.gl, glow::PRIMITIVE_RESTART, false);
    }
    set_restart(context);
}

/// Sets primitive restart for one draw with indices of a type: enabled at the type's largest index, or
/// disabled, so that this index is a vertex.
pub(crate) fn set_restart_of(context: &Context, kind: u32, on: bool) {
    let gl = &context.gl;
    if context.caps.fixed_restart {
        set(gl, glow::PRIMITIVE_RESTART_FIXED_INDEX, on);
    } else if let Some(index) = context.entry_points.primitive_restart_index {
        set(gl, glow::PRIMITIVE_RESTART, on);
        let largest = match kind {
            glow::UNSIGNED_SHORT => u32::from(RESTART_16),
            _ => RESTART,
        };
        // SAFETY: the context is current and has the function.
        unsafe { index(largest) };
    }
}

fn stencil_face(gl: &glow::Context, face: u32, state: StencilFace) {
    // SAFETY: the context is current.
    unsafe {
        gl.stencil_func_separate(
            face,
            compare(state.compare),
            i32::from(state.reference),
            u32::from(state.read_mask),
        );
        gl.stencil_op_separate(
            face,
            operation(state.fail_op),
            operation(state.depth_fail_op),
            operation(state.pass_op),
        );
        gl.stencil_mask_separate(face, u32::from(state.write_mask));
    }
}

/// Sets the state that no scene changes, and resets the state that scenes change, so that it does not affect
/// clears and uploads.
pub(crate) fn reset(context: &Context) {
    let gl = &context.gl;
    // SAFETY: the context is current; state of one profile is set only in that profile.
    unsafe {
        for capability in [
            glow::SCISSOR_TEST,
            glow::DITHER,
            glow::BLEND,
            glow::CULL_FACE,
            glow::DEPTH_TEST,
            glow::STENCIL_TEST,
            glow::POLYGON_OFFSET_FILL,
            glow::SAMPLE_ALPHA_TO_COVERAGE,
            glow::SAMPLE_COVERAGE,
            glow::RASTERIZER_DISCARD,
        ] {
            gl.disable(capability);
        }
        let caps = &context.caps;
        for (known, capability) in [
            (caps.depth_clamp, glow::DEPTH_CLAMP),
            (caps.alpha_to_one, glow::SAMPLE_ALPHA_TO_ONE),
            (caps.fixed_restart, glow::PRIMITIVE_RESTART_FIXED_INDEX),
            (
                context.entry_points.sample_mask.is_some(),
                glow::SAMPLE_MASK,
            ),
            (
                context.entry_points.depth_bounds.is_some(),
                DEPTH_BOUNDS_TEST,
            ),
            (
                context.entry_points.min_sample_shading.is_some(),
                SAMPLE_SHADING,
            ),
        ] {
            if known {
                gl.disable(capability);
            }
        }
        if !context.caps.es {
            for capability in [
                glow::COLOR_LOGIC_OP,
                glow::POLYGON_OFFSET_LINE,
                glow::POLYGON_OFFSET_POINT,
                glow::PROGRAM_POINT_SIZE,
                glow::PRIMITIVE_RESTART,
            ] {
                gl.disable(capability);
            }
            gl.enable(glow::MULTISAMPLE);
            // After this, only the attachments' formats decide, as in ES.
            gl.enable(glow::FRAMEBUFFER_SRGB);
            gl.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
        }
        gl.line_width(1.0);
        if let Some(clamp_color) = context.entry_points.clamp_color {
            // Otherwise negative values of signed normalized formats are read as 0.
            clamp_color(glow::CLAMP_READ_COLOR, 0);
        }
        gl.color_mask(true, true, true, true);
        gl.depth_mask(true);
        gl.stencil_mask(0xff);
        if context.caps.es {
            gl.depth_range_f32(0.0, 1.0);
        } else {
            gl.depth_range_f64(0.0, 1.0);
        }
        gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
        gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
        // Only the first texture of a draw is ever sampled.
        gl.bind_sampler(0, None);
    }
    set_idle_parameters(context);
    context.set_clip_control();
}

/// Sets the parameters of all disabled state to values whose effect would be visible.
fn set_idle_parameters(context: &Context) {
    let gl = &context.gl;
    let entry_points = &context.entry_points;
    // SAFETY: the context is current and has the functions.
    unsafe {
        gl.cull_face(glow::FRONT_AND_BACK);
        gl.scissor(0, 0, 0, 0);
        gl.depth_func(glow::NEVER);
        gl.stencil_func(glow::NEVER, 0, 0xff);
        gl.stencil_op(glow::INVERT, glow::INVERT, glow::INVERT);
        gl.blend_func(glow::ZERO, glow::ONE);
        gl.sample_coverage(0.0, false);
        offset(context, 1e6, 0.0, 0.0);
        if let Some(set_mask) = entry_points.sample_mask {
            set_mask(0, 0);
        }
        if let Some(set_share) = entry_points.min_sample_shading {
            set_share(1.0);
        }
        if let Some(set_logic) = entry_points.logic_op {
            set_logic(glow::CLEAR);
        }
        if let Some(bounds) = entry_points.depth_bounds {
            // No depth that a case stores is inside these bounds.
            bounds(0.999_999, 0.999_999_5);
        }
    }
}
