//! The attachments of a scene and their initial contents.

use crate::context::Context;
use crate::pool::PassFramebuffer;
use crate::surface::{Surface, upload};
use etalon_frame::TextureFormat;
use glow::HasContext;

pub(crate) struct Attachment {
    pub(crate) name: String,
    pub(crate) format: TextureFormat,
    pub(crate) surface: Surface,
    /// The framebuffer with all layers, if passes have several.
    pub(crate) layers: Option<PassFramebuffer>,
    /// The framebuffer of the last pass that draws to it, or else the surface's, and its attachment point
    /// there.
    pub(crate) drawn: (glow::Framebuffer, u32),
    pub(crate) initial: SubmitContents,
}

/// The initial contents of an attachment at each submit.
pub(crate) enum SubmitContents {
    /// Uploaded once. No pass draws to it.
    Uploaded,
    Upload(Vec<u8>),
    Color([f32; 4]),
    Integers([u32; 4]),
    DepthStencil(f32, u8),
}

impl Attachment {
    /// Returns the framebuffer whose clears set the initial contents. It has all layers, if passes have
    /// several.
    fn cleared(&self) -> glow::Framebuffer {
        let layers = self.layers.as_ref().map(|target| target.framebuffer);
        layers.unwrap_or(self.surface.framebuffer)
    }
}

/// Sets the initial contents of all attachments. `state::reset` must have opened masks and scissor.
pub(crate) fn set_initial_contents(context: &Context, attachments: &[Attachment]) {
    let gl = &context.gl;
    for attachment in attachments {
        let surface = &attachment.surface;
        let format = attachment.format;
        // SAFETY: the context is current and owns all objects.
        unsafe {
            match &attachment.initial {
                SubmitContents::Uploaded => {}
                SubmitContents::Upload(bytes) => upload(context, format, surface, bytes),
                SubmitContents::Color(color) => {
                    gl.bind_framebuffer(glow::FRAMEBUFFER, Some(attachment.cleared()));
                    gl.clear_buffer_f32_slice(glow::COLOR, 0, color);
                }
                SubmitContents::Integers(color) => {
                    gl.bind_framebuffer(glow::FRAMEBUFFER, Some(attachment.cleared()));
                    gl.clear_buffer_u32_slice(glow::COLOR, 0, color);
                }
                SubmitContents::DepthStencil(depth, stencil) => {
                    gl.bind_framebuffer(glow::FRAMEBUFFER, Some(attachment.cleared()));
                    let stencil = i32::from(*stencil);
                    match (format.has_depth(), format.has_stencil()) {
                        (true, true) => {
                            gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, *depth, stencil);
                        }
                        (true, false) => gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[*depth]),
                        _ => gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[stencil]),
                    }
                }
            }
        }
    }
}
