//! Bugs that leave each frame legal but different from another frame.

use crate::list::{SMALL, bugs};
use crate::plant::{Plant, frames, nudge};
use etalon_frame::{Aspect, Image};
use etalon_scene::{AttachmentContents, Draw, Scene};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Raises all values that are not at an end of their range by one step, in some images of some scenes.
fn steps(
    when: impl Fn(&Scene) -> bool + Send + Sync + 'static,
    which: fn(&Scene, &Image) -> bool,
) -> Plant {
    frames(move |scene, frame| {
        let strikes = when(scene);
        let images = frame.images.iter_mut();
        for image in images.filter(|image| strikes && which(scene, image)) {
            let encodings = image.channels.iter().cycle();
            for (code, encoding) in image.codes.iter_mut().zip(encodings) {
                let order = encoding.order_of_code(*code);
                let largest = encoding.order_of_code(encoding.nearest_code(1.0));
                if order > 0 && order < largest {
                    *code = nudge(*encoding, *code, 1);
                }
            }
        }
    })
}

/// Raises all colours and depths of some scenes.
fn scenes(when: impl Fn(&Scene) -> bool + Send + Sync + 'static) -> Plant {
    steps(when, |_, image| image.aspect != Aspect::Stencil)
}

fn draws(scene: &Scene) -> impl Iterator<Item = &Draw> {
    scene.passes.iter().flat_map(|pass| &pass.draws)
}

bugs! {
    class "invariance", "order";
    source SMALL;
    let read = AtomicUsize::new(0);
    "flickers: Every second frame is one step brighter or nearer." =>
        scenes(move |_| read.fetch_add(1, Ordering::Relaxed) % 2 == 1);
    "scissor-moves-values: Under a small scissor rectangle, values are one step off." =>
        scenes(|scene| {
            let small = |[_, _, w, h]: [u32; 4]| w < 16 || h < 16;
            draws(scene).any(|d| d.scissor.is_some_and(small))
        });
    "write-mask-moves-values: Under a partial write mask, values are one step off." =>
        scenes(|scene| {
            let mut targets = draws(scene).flat_map(|d| &d.targets);
            targets.any(|t| t.write_mask != 0xf)
        });
    "contents-move-values: Over a background that is not black, values are one step off." =>
        scenes(|scene| {
            let light = |c: &AttachmentContents| matches!(c, AttachmentContents::Color(v) if *v != [0.0; 4]);
            scene.attachments.iter().any(|a| light(&a.contents))
        });
    "second-attachment-differs: The second colour attachment is one step off." =>
        steps(
            |_| true,
            |scene, image| {
                let mut seconds = scene.passes.iter().filter_map(|pass| pass.color.get(1));
                seconds.any(|index| scene.attachments[*index].name == image.attachment)
            },
        );
    let nearer = |scene: &Scene| {
        let depth = |d: &Draw| d.mesh.vertices.first().map_or(0.0, |v| v.position[2]);
        let mut depths = draws(scene).map(depth);
        let first = depths.next().unwrap_or(0.0);
        depths.any(|z| z < first)
    };
    "order-moves-depth: Where the first draw is the farthest, depths are one step off." =>
        steps(nearer, |_, image| image.aspect == Aspect::Depth);
}
