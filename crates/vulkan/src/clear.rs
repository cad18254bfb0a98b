//! Clears of a pass: load and store operations, and clear commands between draws.

use crate::device::Device;
use crate::error::internal;
use crate::image::DRAWN_LAYERS;
use ash::vk;
use etalon_backend::BackendError;
use etalon_frame::PathLayers;
use etalon_scene::{Clear, ClearTarget, LoadOperation, Operations, StoreOperation};

/// The load and store operation of one aspect.
#[derive(Clone)]
pub(crate) struct Ends {
    pub(crate) load: vk::AttachmentLoadOp,
    pub(crate) store: vk::AttachmentStoreOp,
    /// The clear value; read only if the load operation clears.
    pub(crate) value: vk::ClearValue,
}

impl Ends {
    /// Returns the operations, with a clear value made by `value`.
    pub(crate) fn new<V: Copy>(
        operations: Operations<V>,
        value: impl Fn(V) -> vk::ClearValue,
    ) -> Self {
        let (load, value) = match operations.load {
            LoadOperation::Load => (vk::AttachmentLoadOp::LOAD, vk::ClearValue::default()),
            LoadOperation::Clear(v) => (vk::AttachmentLoadOp::CLEAR, value(v)),
        };
        let store = match operations.store {
            StoreOperation::Store => vk::AttachmentStoreOp::STORE,
            StoreOperation::Discard => vk::AttachmentStoreOp::DONT_CARE,
        };
        Self { load, store, value }
    }

    /// Replaces a load operation that clears by one that leaves the contents undefined.
    pub(crate) fn leave_undefined(&mut self) {
        if self.load == vk::AttachmentLoadOp::CLEAR {
            self.load = vk::AttachmentLoadOp::DONT_CARE;
        }
    }

    /// Returns the operations that keep the contents.
    pub(crate) fn kept() -> Self {
        Self {
            load: vk::AttachmentLoadOp::LOAD,
            store: vk::AttachmentStoreOp::STORE,
            value: vk::ClearValue::default(),
        }
    }
}

/// A clear command: a set of attachments and the rectangles to clear in each.
pub(crate) struct ClearPlan {
    attachments: Vec<vk::ClearAttachment>,
    rects: Vec<vk::ClearRect>,
    /// The scene's clear targets that the attachments were made from.
    targets: Vec<ClearTarget>,
}

impl ClearPlan {
    /// Returns the command, or `None` if the clear is outside the render area. `integer` is true if the
    /// colour attachment holds integers.
    pub(crate) fn new(
        clear: &Clear,
        integer: bool,
        layers: PathLayers,
        size: [u32; 2],
        area: vk::Rect2D,
    ) -> Result<Option<Self>, BackendError> {
        let attachment = match clear.target {
            ClearTarget::Color {
                location, value, ..
            } => vk::ClearAttachment {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                color_attachment: u32::try_from(location)
                    .map_err(|_| internal("too many colour attachments"))?,
                clear_value: vk::ClearValue {
                    color: color_value(value, integer),
                },
            },
            ClearTarget::DepthStencil { depth, stencil, .. } => {
                let mut aspects = vk::ImageAspectFlags::empty();
                if depth.is_some() {
                    aspects |= vk::ImageAspectFlags::DEPTH;
                }
                if stencil.is_some() {
                    aspects |= vk::ImageAspectFlags::STENCIL;
                }
                vk::ClearAttachment {
                    aspect_mask: aspects,
                    color_attachment: 0,
                    clear_value: depth_stencil_value(
                        depth.unwrap_or_default(),
                        stencil.unwrap_or_default(),
                    ),
                }
            }
        };
        let [x, y, width, height] = clear.rect.unwrap_or([0, 0, size[0], size[1]]);
        let offset = |v: u32| i32::try_from(v).map_err(|_| internal("a rectangle lies outside"));
        let rect = vk::Rect2D {
            offset: vk::Offset2D {
                x: offset(x)?,
                y: offset(y)?,
            },
            extent: vk::Extent2D { width, height },
        };
        let (base_array_layer, layer_count) = match layers {
            // Layer 0 of the command is the view's first layer
            // (VUID-vkCmdClearAttachments-baseArrayLayer-00018).
            PathLayers::One | PathLayers::Multiview => (0, 1),
            PathLayers::Written => (DRAWN_LAYERS[0], DRAWN_LAYERS.len() as u32),
        };
        Ok(intersection(rect, area).map(|rect| Self {
            attachments: vec![attachment],
            rects: vec![vk::ClearRect {
                rect,
                base_array_layer,
                layer_count,
            }],
            targets: vec![clear.target],
        }))
    }

    /// Merges another command into this one if they have the same rectangles, or the same attachments and
    /// values. Returns false if they cannot be merged.
    pub(crate) fn takes(&mut self, other: &Self) -> bool {
        let rect = |rect: &vk::ClearRect| (rect.rect.offset, rect.rect.extent);
        let overlaps = |a: &vk::ClearAttachment| {
            other.attachments.iter().any(|b| {
                a.aspect_mask.intersects(b.aspect_mask) && a.color_attachment == b.color_attachment
            })
        };
        if self.rects.iter().map(rect).eq(other.rects.iter().map(rect)) {
            if self.attachments.iter().any(overlaps) {
                return false;
            }
            self.attachments.extend(&other.attachments);
            self.targets.extend(&other.targets);
        } else if self.targets == other.targets {
            self.rects.extend(&other.rects);
        } else {
            return false;
        }
        true
    }

    /// Records the command.
    ///
    /// # Safety
    /// `commands` is inside the render pass that the command was planned for.
    pub(crate) unsafe fn record(&self, device: &Device, commands: vk::CommandBuffer) {
        // SAFETY: upheld by the caller; the rectangle is inside the render area, and masked clears are
        // denied.
        unsafe {
            device
                .raw
                .cmd_clear_attachments(commands, &self.attachments, &self.rects);
        }
    }
}

/// Returns the rectangle that two rectangles share, if they overlap.
pub(crate) fn intersection(a: vk::Rect2D, b: vk::Rect2D) -> Option<vk::Rect2D> {
    let shared = |a: (i32, u32), b: (i32, u32)| {
        let end = |(start, length): (i32, u32)| i64::from(start) + i64::from(length);
        let start = a.0.max(b.0);
        let length = end(a).min(end(b)) - i64::from(start);
        u32::try_from(length)
            .ok()
            .filter(|l| *l > 0)
            .map(|l| (start, l))
    };
    let (x, width) = shared((a.offset.x, a.extent.width), (b.offset.x, b.extent.width))?;
    let (y, height) = shared((a.offset.y, a.extent.height), (b.offset.y, b.extent.height))?;
    Some(vk::Rect2D {
        offset: vk::Offset2D { x, y },
        extent: vk::Extent2D { width, height },
    })
}

/// Returns the clear value of a colour attachment, which holds integers if `integer` is true.
pub(crate) fn color_value(color: [f32; 4], integer: bool) -> vk::ClearColorValue {
    if integer {
        vk::ClearColorValue {
            uint32: color.map(|c| c as u32),
        }
    } else {
        vk::ClearColorValue { float32: color }
    }
}

/// Returns the clear value of a depth-stencil attachment.
pub(crate) fn depth_stencil_value(depth: f32, stencil: u8) -> vk::ClearValue {
    vk::ClearValue {
        depth_stencil: vk::ClearDepthStencilValue {
            depth,
            stencil: u32::from(stencil),
        },
    }
}
