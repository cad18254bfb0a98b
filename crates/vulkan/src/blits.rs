//! Blits that move or filter the texels of an attachment through an intermediate image, before the host reads
//! them.

use crate::device::Device;
use crate::format;
use crate::image::ImagePlace;
use crate::image_state::{ImageState, TRANSFER_DST, TRANSFER_SRC, UNDEFINED};
use crate::plan::AttachmentPlan;
use ash::vk;
use etalon_backend::{Blit, Blits};
use etalon_frame::Aspect;

/// Records the blits of an attachment to the intermediate image `between`, and from there the copies, or the
/// filtered blit, to `copy`. One sequence of barriers and commands.
///
/// # Safety
/// `commands` is being recorded. The attachment has the layout of a transfer source, `copy` that of a
/// transfer destination, and nothing else uses `between`.
pub(crate) unsafe fn record(
    device: &Device,
    commands: vk::CommandBuffer,
    attachment: &AttachmentPlan,
    between: vk::Image,
    copy: vk::Image,
) {
    let api = &device.raw;
    let size = attachment.size;
    let aspects = attachment.aspects;
    let change = |from: ImageState, to: ImageState| {
        let barriers = [attachment
            .barrier(from, to)
            .image(between)
            .subresource_range(ImagePlace::default().range(aspects))];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: upheld by the caller.
        unsafe { api.cmd_pipeline_barrier2(commands, &info) };
    };
    change(UNDEFINED, TRANSFER_DST);
    // The cleared values show if the driver loses a blit.
    let ranges = [ImagePlace::default().range(aspects)];
    // SAFETY: upheld by the caller; `between` has the layout of a transfer destination.
    unsafe {
        if aspects == vk::ImageAspectFlags::COLOR {
            let zeros = vk::ClearColorValue::default();
            api.cmd_clear_color_image(commands, between, TRANSFER_DST.layout, &zeros, &ranges);
        } else {
            let value = vk::ClearDepthStencilValue {
                depth: 0.3,
                stencil: 77,
            };
            let layout = TRANSFER_DST.layout;
            api.cmd_clear_depth_stencil_image(commands, between, layout, &value, &ranges);
        }
    }
    change(TRANSFER_DST, TRANSFER_DST);
    let named = [Aspect::Color, Aspect::Depth, Aspect::Stencil];
    let has = |aspect: &Aspect| aspects.contains(format::aspect_flag(*aspect));
    let each: Vec<Aspect> = named.into_iter().filter(has).collect();
    let moved = Blits::new(attachment.end, size);
    let blits = match moved {
        Some(blits) => blits.blits(&each),
        None => columns(&each, size),
    };
    let regions = |blits: &[Blit], source: ImagePlace| -> Vec<vk::ImageBlit> {
        blits.iter().map(|blit| region(blit, source)).collect()
    };
    let blit = |from, to, regions: &[vk::ImageBlit], filter| {
        // SAFETY: upheld by the caller; both images contain the rectangles.
        unsafe {
            api.cmd_blit_image(
                commands,
                from,
                TRANSFER_SRC.layout,
                to,
                TRANSFER_DST.layout,
                regions,
                filter,
            );
        }
    };
    let first = regions(&blits, attachment.place);
    blit(attachment.image, between, &first, vk::Filter::NEAREST);
    change(TRANSFER_DST, TRANSFER_SRC);
    let Some(moved) = moved else {
        let narrowed = [Blit {
            aspects: each,
            from: [[0, 0], [2 * size[0], size[1]]],
            to: [[0, 0], size],
        }];
        let narrowed = regions(&narrowed, ImagePlace::default());
        return blit(between, copy, &narrowed, vk::Filter::LINEAR);
    };
    let place = ImagePlace::default();
    let mut copies = Vec::new();
    for aspect in each {
        let layers = place.layers(format::aspect_flag(aspect));
        copies.extend(moved.pieces(aspect).into_iter().map(|piece| vk::ImageCopy {
            src_subresource: layers,
            src_offset: place.offset(piece.from[0], piece.from[1]),
            dst_subresource: layers,
            dst_offset: place.offset(piece.to[0], piece.to[1]),
            extent: vk::Extent3D {
                width: piece.size[0],
                height: piece.size[1],
                depth: 1,
            },
        }));
    }
    // SAFETY: upheld by the caller; both images contain the rectangles.
    unsafe {
        api.cmd_copy_image(
            commands,
            between,
            TRANSFER_SRC.layout,
            copy,
            TRANSFER_DST.layout,
            &copies,
        );
    }
}

/// Returns the blits that spread the columns over an image twice as wide, to every second column.
fn columns(aspects: &[Aspect], [width, height]: [u32; 2]) -> Vec<Blit> {
    let column = |x: u32| [[x, 0], [x + 1, height]];
    (0..width)
        .map(|x| Blit {
            aspects: aspects.to_vec(),
            from: column(x),
            to: column(2 * x),
        })
        .collect()
}

/// Returns a blit from a part of an image to the first level and layer of another image.
fn region(blit: &Blit, source: ImagePlace) -> vk::ImageBlit {
    let aspects = blit.aspects.iter();
    let mask = aspects.fold(vk::ImageAspectFlags::empty(), |mask, aspect| {
        mask | format::aspect_flag(*aspect)
    });
    let corners = |place: ImagePlace, [from, to]: [[u32; 2]; 2]| {
        let end = place.offset(to[0], to[1]);
        [
            place.offset(from[0], from[1]),
            vk::Offset3D {
                z: end.z + 1,
                ..end
            },
        ]
    };
    let target = ImagePlace::default();
    vk::ImageBlit {
        src_subresource: source.layers(mask),
        src_offsets: corners(source, blit.from),
        dst_subresource: target.layers(mask),
        dst_offsets: corners(target, blit.to),
    }
}
