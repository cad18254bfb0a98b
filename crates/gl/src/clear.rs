//! Clears of a pass, and contents that it discards.
//!
//! OpenGL has one kind of clear: load operations and commands differ in their moment alone. The scissor
//! test, masks and rasterizer discard of the last draw would affect it, so each clear sets them; draws set
//! their own.

use crate::context::Context;
use crate::state;
use etalon_scene::{Clear, ClearTarget, LoadOperation, Pass};
use glow::HasContext;

/// A clear, ready to be executed on the pass's framebuffer.
pub(crate) struct ClearCall {
    target: ClearTarget,
    /// True for a colour attachment of integers.
    integer: bool,
    rect: Option<[i32; 4]>,
}

impl ClearCall {
    /// Returns a clear command. `integers` tells for each colour attachment if it holds integers.
    pub(crate) fn new(clear: &Clear, integers: &[bool]) -> Self {
        Self {
            target: clear.target,
            integer: match clear.target {
                ClearTarget::Color { location, .. } => {
                    integers.get(location).copied().unwrap_or_default()
                }
                ClearTarget::DepthStencil { .. } => false,
            },
            rect: clear.rect.map(|r| r.map(|v| v as i32)),
        }
    }

    /// Returns the clears that a pass's load operations stand for.
    pub(crate) fn loads(pass: &Pass, integers: &[bool]) -> Vec<Self> {
        let mut targets = Vec::new();
        for location in 0..pass.color.len() {
            if let LoadOperation::Clear(value) = pass.color_operations(location).load {
                targets.push(ClearTarget::Color {
                    location,
                    value,
                    write_mask: 0b1111,
                });
            }
        }
        let depth = pass.operations.depth.load.clear_value();
        let stencil = pass.operations.stencil.load.clear_value();
        if depth.is_some() || stencil.is_some() {
            targets.push(ClearTarget::DepthStencil {
                depth,
                stencil,
                depth_write: true,
                stencil_write_mask: 0xff,
            });
        }
        let whole = |target| Clear {
            before: 0,
            target,
            rect: None,
        };
        let each = targets.into_iter();
        each.map(|target| Self::new(&whole(target), integers))
            .collect()
    }

    /// Clears the bound framebuffer.
    pub(crate) fn apply(&self, context: &Context) {
        let gl = &context.gl;
        state::set(gl, glow::RASTERIZER_DISCARD, false);
        state::set(gl, glow::SCISSOR_TEST, self.rect.is_some());
        // SAFETY: the context is current; the entry points are of version 3.
        unsafe {
            if let Some([x, y, w, h]) = self.rect {
                gl.scissor(x, y, w, h);
            }
            match self.target {
                ClearTarget::Color {
                    location,
                    value,
                    write_mask,
                } => {
                    let [r, g, b, a] = [1, 2, 4, 8].map(|bit| write_mask & bit != 0);
                    gl.color_mask(r, g, b, a);
                    let buffer = location as u32;
                    if self.integer {
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
        match (has(index, Aspect::Depth), has(index, Aspect::Stencil)) {
            (true, true) if packed => points.push(glow::DEPTH_STENCIL_ATTACHMENT),
            (depth, stencil) => {
                points.extend(depth.then_some(glow::DEPTH_ATTACHMENT));
                points.extend(stencil.then_some(glow::STENCIL_ATTACHMENT));
            }
        }
    }
    points
}

/// Discards attachments of the bound framebuffer. Without the function they stay as they are, which is one
/// of the contents that they may have.
pub(crate) fn discard(context: &Context, points: &[u32]) {
    if context.caps.invalidate && !points.is_empty() {
        // SAFETY: the context is current and has the function.
        unsafe {
            context.gl.invalidate_framebuffer(glow::FRAMEBUFFER, points);
        }
    }
}
