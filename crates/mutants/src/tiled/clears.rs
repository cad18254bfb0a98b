//! Texels that a clear does not reach.

use super::super::hooks::code;
use super::super::list::{CONFUSION, List};
use super::super::memory::Area;
use super::super::plant::{Plant, stored};
use super::tiles::TILES;
use etalon_cpu::Surface;
use etalon_cpu::steps::Moment;
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_scene::{Attachment, Contents};

/// Gives the texels of one aspect other codes.
fn spoil(surface: &mut Surface, attachment: &Attachment, aspect: Aspect, area: Area) {
    let [left, top, right, bottom] = area;
    let format = attachment.format;
    let depth = format.depth_encodings().first();
    let encodings: Vec<ChannelEncoding> = match aspect {
        Aspect::Color => format.color_channels().to_vec(),
        Aspect::Depth => depth.copied().into_iter().collect(),
        Aspect::Stencil => Vec::new(),
    };
    for y in top..bottom.min(surface.height) {
        let row = y * surface.stride;
        let texels = row + left..row + right.min(surface.width).max(left);
        for (channel, encoding) in encodings.iter().enumerate() {
            let one = code(*encoding, 1.0);
            for sample in 0..surface.samples {
                let plane = &mut surface.planes[channel * surface.samples + sample];
                for code in &mut plane[texels.clone()] {
                    *code = if *code == 0 { one } else { 0 };
                }
            }
        }
        if aspect == Aspect::Stencil {
            for plane in &mut surface.stencil {
                for code in &mut plane[texels.clone()] {
                    *code = if *code == 0 { 255 } else { 0 };
                }
            }
        }
    }
}

/// Leaves an area of cleared attachments uncleared, given their size; `None` clears all.
fn uncleared(
    aspect: Aspect,
    area: impl Fn([usize; 2]) -> Option<Area> + Clone + Send + Sync + 'static,
) -> Plant {
    stored(move |moment, scene, stored| {
        if moment != Moment::Initial {
            return;
        }
        for (surface, attachment) in stored.surfaces.iter_mut().zip(&scene.attachments) {
            if matches!(attachment.contents, Contents::Texels(_))
                || !attachment.format.aspects().contains(&aspect)
            {
                continue;
            }
            if let Some(area) = area([surface.width, surface.height]) {
                spoil(surface, attachment, aspect, area);
            }
        }
    })
}

pub(super) fn add(list: &mut List) {
    for (aspect, name) in [
        (Aspect::Color, "color"),
        (Aspect::Depth, "depth"),
        (Aspect::Stencil, "stencil"),
    ] {
        for n in TILES {
            let side = n as usize;
            list.add(
                &format!("{name}-clear-leaves-second-tile-of-{n}"),
                CONFUSION,
                format!("The second tile of {n}×{n} in the first row keeps its old {name}."),
                uncleared(aspect, move |[width, _]| {
                    (width > side).then_some([side, 0, side * 2, side])
                }),
            );
            list.add(
                &format!("{name}-clear-leaves-last-tile-of-{n}"),
                CONFUSION,
                format!("Of several tiles of {n}×{n}, the last keeps its old {name}."),
                uncleared(aspect, move |[width, height]| {
                    let last = |length: usize| (length - 1) / side * side;
                    let several = width > side || height > side;
                    several.then_some([last(width), last(height), width, height])
                }),
            );
        }
        list.add(
            &format!("{name}-clear-only-first-64-columns"),
            CONFUSION,
            format!("Only the first 64 columns of {name} are cleared."),
            uncleared(aspect, |[width, height]| {
                (width > 64).then_some([64, 0, width, height])
            }),
        );
        list.add(
            &format!("{name}-clear-leaves-last-odd-row"),
            CONFUSION,
            format!("The last row of an odd height keeps its old {name}."),
            uncleared(aspect, |[width, height]| {
                (height % 2 == 1).then_some([0, height - 1, width, height])
            }),
        );
        list.add(
            &format!("{name}-clear-leaves-last-odd-column"),
            CONFUSION,
            format!("The last column of an odd width keeps its old {name}."),
            uncleared(aspect, |[width, height]| {
                (width % 2 == 1).then_some([width - 1, 0, width, height])
            }),
        );
    }
}
