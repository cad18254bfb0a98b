//! Resolves after a pass. Resolve commands move parts of the attachment to other places of an intermediate
//! image, and copies bring the parts to their places in the resolve target.

use crate::device::Device;
use crate::image_state::{COLOR, ImageState, TRANSFER_DST, TRANSFER_SRC, UNDEFINED};
use crate::plan::{AttachmentPlan, MovedResolve};
use ash::vk;
use etalon_backend::Blits;
use etalon_frame::{Aspect, PathEnd};

impl MovedResolve {
    /// Records the commands and the copies.
    ///
    /// # Safety
    /// `commands` is being recorded, outside a pass. Both attachments are in the layout of colour
    /// attachments, and nothing else uses the intermediate image.
    pub(crate) unsafe fn record(
        &self,
        device: &Device,
        commands: vk::CommandBuffer,
        attachments: &[AttachmentPlan],
    ) {
        let (Some(from), Some(to)) = (attachments.get(self.from), attachments.get(self.to)) else {
            return;
        };
        let api = &device.raw;
        let color = vk::ImageAspectFlags::COLOR;
        let between = |before: ImageState, after: ImageState| {
            to.barrier(before, after)
                .image(self.image)
                .subresource_range(self.place.range(color))
        };
        let change = |barriers: &[vk::ImageMemoryBarrier2<'_>]| {
            let info = vk::DependencyInfo::default().image_memory_barriers(barriers);
            // SAFETY: upheld by the caller.
            unsafe { api.cmd_pipeline_barrier2(commands, &info) };
        };
        let pieces = Blits::new(PathEnd::BlitPart, to.size)
            .map(|blits| blits.pieces(Aspect::Color))
            .unwrap_or_default();
        let extent = |[width, height]: [u32; 2]| vk::Extent3D {
            width,
            height,
            depth: 1,
        };
        let resolved = pieces.iter().map(|piece| vk::ImageResolve {
            src_subresource: from.place.layers(color),
            src_offset: from.place.offset(piece.to[0], piece.to[1]),
            dst_subresource: self.place.layers(color),
            dst_offset: self.place.offset(piece.from[0], piece.from[1]),
            extent: extent(piece.size),
        });
        let resolved: Vec<_> = resolved.collect();
        let copied = pieces.iter().map(|piece| vk::ImageCopy {
            src_subresource: self.place.layers(color),
            src_offset: self.place.offset(piece.from[0], piece.from[1]),
            dst_subresource: to.place.layers(color),
            dst_offset: to.place.offset(piece.to[0], piece.to[1]),
            extent: extent(piece.size),
        });
        let copied: Vec<_> = copied.collect();
        let (source, target) = (TRANSFER_SRC.layout, TRANSFER_DST.layout);
        change(&[
            from.barrier(COLOR, TRANSFER_SRC),
            between(UNDEFINED, TRANSFER_DST),
            to.barrier(COLOR, TRANSFER_DST),
        ]);
        // The cleared values show if the driver loses a resolve.
        let zeros = vk::ClearColorValue::default();
        let ranges = [self.place.range(color)];
        // SAFETY: upheld by the caller; the images are in these layouts and contain the parts.
        unsafe {
            api.cmd_clear_color_image(commands, self.image, target, &zeros, &ranges);
            change(&[between(TRANSFER_DST, TRANSFER_DST)]);
            api.cmd_resolve_image(commands, from.image, source, self.image, target, &resolved);
            change(&[between(TRANSFER_DST, TRANSFER_SRC)]);
            api.cmd_copy_image(commands, self.image, source, to.image, target, &copied);
        }
        change(&[
            from.barrier(TRANSFER_SRC, COLOR),
            to.barrier(TRANSFER_DST, COLOR),
        ]);
    }
}
