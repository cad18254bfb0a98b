//! Clears of a pass, and contents that it discards.
//!
//! Load operations and clear commands differ only in when they are executed. The scissor test, masks and
//! rasterizer discard of the last draw would affect a clear, so each clear sets them; draws set their own. One
//! call clears one attachment. If the path asks for it, `glClear`, which clears all draw buffers, clears
//! several attachments together.

use crate::context::Context;
use crate::state;
use etalon_frame::PathClears;
use etalon_scene::{Clear, ClearTarget, Pass};
use glow::HasContext;

/// Clears of the pass's framebuffer that one or several calls execute.
pub(crate) struct ClearCall {
    targets: Vec<ClearTarget>,
    /// For each colour attachment of the pass, true if it holds integers.
    integers: Vec<bool>,
    rect: Option<[i32; 4]>,
    way: PathClears,
    /// True if depth and stencil are one attachment.
    packed: bool,
}

/// Returns clear commands, each with the index of the draw that it precedes. `integers` is true for each colour
/// attachment that holds integers.
pub(crate) fn commands<'c>(
    clears: impl Iterator<Item = &'c Clear>,
    integers: &[bool],
    way: PathClears,
    packed: bool,
) -> Vec<(usize, ClearCall)> {
    let mut calls: Vec<(usize, ClearCall)> = Vec::new();
    for clear in clears {
        let call = ClearCall {
            targets: vec![clear.target],
            integers: integers.to_vec(),
            rect: clear.rect.map(|r| r.map(|v| v as i32)),
            way,
            packed,
        };
        match calls.last_mut() {
            Some((before, last)) if *before == clear.before && last.takes(&call) => {
                last.targets.push(clear.target);
            }
            _ => calls.push((clear.before, call)),
        }
    }
    calls
}

impl ClearCall {
    /// Returns the clears that perform a pass's load operations.
    pub(crate) fn loads(
        pass: &Pass,
        integers: &[bool],
        way: PathClears,
        packed: bool,
    ) -> Vec<Self> {
        let clears = pass.loading_clears();
        let calls = commands(clears.iter(), integers, way, packed);
        calls.into_iter().map(|(_, call)| call).collect()
    }

    /// Returns true if one call can replace both clears: they clear the same texels of different attachments,
    /// with the same value and mask for colours.
    fn takes(&self, other: &Self) -> bool {
        let color = |target: &ClearTarget| match *target {
            ClearTarget::Color {
                location,
                value,
                write_mask,
            } => Some((location, (value, write_mask))),
            ClearTarget::DepthStencil { .. } => None,
        };
        let targets = || self.targets.iter().chain(&other.targets);
        let colors = || targets().filter_map(color);
        let mut locations: Vec<usize> = colors().map(|(location, _)| location).collect();
        locations.sort_unstable();
        locations.dedup();
        self.way == PathClears::Together
            && self.rect == other.rect
            && locations.len() == colors().count()
            && targets().count() - colors().count() <= 1
            && colors().all(|(_, how)| colors().all(|(_, first)| first == how))
            && colors().all(|(location, _)| self.integers.get(location) == Some(&false))
    }

    /// Returns true if `glClear` can clear the targets: it cannot clear integer attachments.
    fn is_plain(&self) -> bool {
        self.targets.iter().all(|target| match *target {
            ClearTarget::Color { location, .. } => self.integers.get(location) == Some(&false),
            ClearTarget::DepthStencil { .. } => true,
        })
    }

    /// Clears the bound framebuffer.
    pub(crate) fn apply(&self, context: &Context) {
        let gl = &context.gl;
        state::set(gl, glow::RASTERIZER_DISCARD, false);
        let together = self.way == PathClears::Together && self.is_plain();
        // A scissor rectangle that extends beyond the framebuffer on all sides changes nothing.
        let rect = self.rect.or(together.then_some([-9, -7, 0x4000, 0x4000]));
        state::set(gl, glow::SCISSOR_TEST, rect.is_some());
        // SAFETY: the context is current; the entry points are part of version 3, or known.
        unsafe {
            match (rect, context.entry_points.scissor_array) {
                // Clears obey the first of several rectangles (OpenGL 4.5, 14.9.2).
                (Some(rect), Some(scissors)) if together => {
                    let rects = [rect, [1, 0, 2, 1]];
                    scissors(0, 2, rects.as_ptr().cast());
                }
                (Some([x, y, w, h]), _) => gl.scissor(x, y, w, h),
                (None, _) => {}
            }
            if self.way == PathClears::Undefined {
                self.invalidate(context);
            }
            if together {
                self.clear_together(gl, context.caps.es);
            } else {
                for target in &self.targets {
                    self.clear(gl, target);
                }
            }
        }
    }

    /// Clears by the call for all draw buffers, with only the targets left as draw buffers.
    ///
    /// # Safety
    /// The context is current, and the scissor is set.
    unsafe fn clear_together(&self, gl: &glow::Context, es: bool) {
        let mut buffers = vec![glow::NONE; self.integers.len().max(1)];
        let mut mask = 0;
        // SAFETY: upheld by the caller.
        unsafe {
            for target in &self.targets {
                match *target {
                    ClearTarget::Color {
                        location,
                        value: [r, g, b, a],
                        write_mask,
                    } => {
                        mask |= glow::COLOR_BUFFER_BIT;
                        buffers[location] = glow::COLOR_ATTACHMENT0 + location as u32;
                        gl.clear_color(r, g, b, a);
                        color_mask(gl, write_mask);
                    }
                    ClearTarget::DepthStencil {
                        depth,
                        stencil,
                        depth_write,
                        stencil_write_mask,
                    } => {
                        if let Some(depth) = depth {
                            mask |= glow::DEPTH_BUFFER_BIT;
                            if es {
                                gl.clear_depth_f32(depth);
                            } else {
                                gl.clear_depth_f64(f64::from(depth));
                            }
                        }
                        if let Some(stencil) = stencil {
                            mask |= glow::STENCIL_BUFFER_BIT;
                            gl.clear_stencil(i32::from(stencil));
                        }
                        gl.depth_mask(depth_write);
                        gl.stencil_mask(u32::from(stencil_write_mask));
                    }
                }
            }
            let every_buffer: Vec<u32> = (glow::COLOR_ATTACHMENT0..)
                .take(self.integers.len())
                .collect();
            let some = mask & glow::COLOR_BUFFER_BIT != 0 && buffers != every_buffer;
            if some {
                gl.draw_buffers(&buffers);
            }
            gl.clear(mask);
            if some {
                gl.draw_buffers(&every_buffer);
            }
        }
    }

    /// Leaves undefined what the clear will overwrite, unless a mask keeps a part of it.
    ///
    /// # Safety
    /// The context is current and has the invalidation functions.
    unsafe fn invalidate(&self, context: &Context) {
        if self.targets.iter().any(ClearTarget::is_masked) {
            return;
        }
        let mut points = Vec::new();
        for target in &self.targets {
            match *target {
                ClearTarget::Color { location, .. } => {
                    points.push(glow::COLOR_ATTACHMENT0 + location as u32);
                }
                ClearTarget::DepthStencil { depth, stencil, .. } => {
                    points.extend(depth_stencil_points(
                        depth.is_some(),
                        stencil.is_some(),
                        self.packed,
                    ));
                }
            }
        }
        // SAFETY: upheld by the caller.
        unsafe {
            match self.rect {
                None => context
                    .gl
                    .invalidate_framebuffer(glow::FRAMEBUFFER, &points),
                Some([x, y, w, h]) => {
                    context
                        .gl
                        .invalidate_sub_framebuffer(glow::FRAMEBUFFER, &points, x, y, w, h)
                }
            }
        }
    }

    /// Clears one attachment.
    ///
    /// # Safety
    /// The context is current, and the scissor is set.
    unsafe fn clear(&self, gl: &glow::Context, target: &ClearTarget) {
        // SAFETY: upheld by the caller.
        unsafe {
            match *target {
                ClearTarget::Color {
                    location,
                    value,
                    write_mask,
                } => {
                    color_mask(gl, write_mask);
                    let buffer = location as u32;
                    if self.integers.get(location) == Some(&true) {
                        let value = value.map(|v| v as u32);
                        gl.clear_buffer_u32_slice(glow::COLOR, buffer, &value);
                    } else {
                        gl.clear_buffer_f32_slice(glow::COLOR, buffer, &value);
                    }
                }
                ClearTarget::DepthStencil {
                    depth,
                    stencil,
                    depth_write,
                    stencil_write_mask,
                } => {
                    gl.depth_mask(depth_write);
                    gl.stencil_mask(u32::from(stencil_write_mask));
                    match (depth, stencil.map(i32::from)) {
                        (Some(depth), Some(stencil)) => {
                            gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, depth, stencil);
                        }
                        (Some(depth), None) => {
                            gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[depth]);
                        }
                        (None, Some(stencil)) => {
                            gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[stencil]);
                        }
                        (None, None) => {}
                    }
                }
            }
        }
    }
}

/// Sets the colour write mask.
///
/// # Safety
/// The context is current.
unsafe fn color_mask(gl: &glow::Context, write_mask: u8) {
    let [r, g, b, a] = [1, 2, 4, 8].map(|bit| write_mask & bit != 0);
    // SAFETY: upheld by the caller.
    unsafe { gl.color_mask(r, g, b, a) };
}

/// Returns the attachment points of depth, stencil, or both. `packed` is true if they are one attachment.
fn depth_stencil_points(depth: bool, stencil: bool, packed: bool) -> Vec<u32> {
    if depth && stencil && packed {
        return vec![glow::DEPTH_STENCIL_ATTACHMENT];
    }
    let depth = depth.then_some(glow::DEPTH_ATTACHMENT);
    let stencil = stencil.then_some(glow::STENCIL_ATTACHMENT);
    depth.into_iter().chain(stencil).collect()
}

/// Returns the attachment points that a pass discards. `packed` is true if depth and stencil are one
/// attachment.
pub(crate) fn discards(pass: &Pass, packed: bool) -> Vec<u32> {
    use etalon_frame::Aspect;
    let discarded = pass.discarded();
    let has = |index: usize, aspect| discarded.contains(&(index, aspect));
    let colors = pass.color.iter().zip(glow::COLOR_ATTACHMENT0..);
    let mut points: Vec<u32> = colors
        .filter(|(index, _)| has(**index, Aspect::Color))
        .map(|(_, point)| point)
        .collect();
    if let Some(index) = pass.depth_stencil {
        let (depth, stencil) = (has(index, Aspect::Depth), has(index, Aspect::Stencil));
        points.extend(depth_stencil_points(depth, stencil, packed));
    }
    points
}

/// Discards attachments of the bound framebuffer. Without the function they keep their contents, which is
/// also allowed.
pub(crate) fn discard(context: &Context, points: &[u32]) {
    if context.caps.invalidate && !points.is_empty() {
        // SAFETY: the context is current and has the function.
        unsafe {
            context.gl.invalidate_framebuffer(glow::FRAMEBUFFER, points);
        }
    }
}
