//! Bugs that leave each frame legal and make it differ from another one.

use crate::list::{List, SMALL};
use crate::plant::{Plant, nudge};
use etalon_frame::{Aspect, Frame};
use etalon_scene::{Contents, Draw, Scene};
use std::sync::atomic::{AtomicUsize, Ordering};

pub(super) fn add(list: &mut List) {
    list.class("invariance", "order");
    let frames = AtomicUsize::new(0);
    list.bug("flickers: Every second frame is one step brighter or nearer.")
        .source(SMALL)
        .plant(frame(move |_| {
            frames.fetch_add(1, Ordering::Relaxed) % 2 == 1
        }));
    list.bug("scissor-moves-values: Under a small scissor rectangle, values are one step off.")
        .source(SMALL)
        .plant(frame(|scene| {
            let whole = |d: &Draw| d.scissor.is_none_or(|[_, _, w, h]| w >= 16 && h >= 16);
            !draws(scene).all(whole)
        }));
    list.bug("write-mask-moves-values: Under a partial write mask, values are one step off.")
        .source(SMALL)
        .plant(frame(|scene| {
            let all = |d: &Draw| d.targets.iter().all(|t| t.write_mask == 0xf);
            !draws(scene).all(all)
        }));
    list.bug("contents-move-values: Over a background that is not black, values are one step off.")
        .source(SMALL)
        .plant(frame(|scene| {
            let black = |c: &Contents| !matches!(c, Contents::Color(v) if *v != [0.0; 4]);
            !scene.attachments.iter().all(|a| black(&a.contents))
        }));
    list.bug("second-attachment-differs: The second colour attachment is one step off.")
        .source(SMALL)
        .plant(Plant::Frame(Box::new(
            |scene: &Scene, frame: &mut Frame| {
                let seconds: Vec<&str> = scene
                    .passes
                    .iter()
                    .filter_map(|pass| pass.color.get(1))
                    .map(|index| scene.attachments[*index].name.as_str())
                    .collect();
                for image in &mut frame.images {
                    if seconds.contains(&image.attachment.as_str()) {
                        let encodings = image.channels.clone();
                        step(&mut image.codes, &encodings);
                    }
                }
            },
        )));
    list.bug("order-moves-depth: Where the first draw is the farthest, depths are one step off.")
        .source(SMALL)
        .plant(Plant::Frame(Box::new(
            |scene: &Scene, frame: &mut Frame| {
                let depth = |d: &Draw| d.mesh.vertices.first().map_or(0.0, |v| v.position[2]);
                let mut all = draws(scene).map(depth);
                let first = all.next().unwrap_or(0.0);
                if all.any(|z| z < first) {
                    for image in &mut frame.images {
                        if image.aspect == Aspect::Depth {
                            let encodings = image.channels.clone();
                            step(&mut image.codes, &encodings);
                        }
                    }
                }
            },
        )));
}

fn draws(scene: &Scene) -> impl Iterator<Item = &Draw> {
    scene.passes.iter().flat_map(|pass| &pass.draws)
}

/// Raises all colours and depths between the ends by one step, if asked to.
fn frame(when: impl Fn(&Scene) -> bool + Send + Sync + 'static) -> Plant {
    Plant::Frame(Box::new(move |scene, frame| {
        if !when(scene) {
            return;
        }
        for image in &mut frame.images {
            if image.aspect != Aspect::Stencil {
                let encodings = image.channels.clone();
                step(&mut image.codes, &encodings);
            }
        }
    }))
}

fn step(codes: &mut [u32], encodings: &[etalon_frame::ChannelEncoding]) {
    for texel in codes.chunks_exact_mut(encodings.len()) {
        for (code, encoding) in texel.iter_mut().zip(encodings) {
            let order = encoding.order_of_code(*code);
            let one = encoding.order_of_code(encoding.nearest_code(1.0));
            if order > 0 && order < one {
                *code = nudge(*encoding, *code, 1);
            }
        }
    }
}
