//! Passes that lose the drawing of earlier passes, or their draws, attachments, resolves or promises; and
//! submissions after the first.

use crate::fields::{DEPTH, DEPTH_WRITE, STENCIL_OPERATIONS, STENCIL_WRITE_MASK};
use crate::list::{CONFUSION, bugs};
use crate::plant::{Plant, again, all_draws, passes, scene, setter};
use crate::read_only::read_only;
use etalon_frame::TextureFormat;
use etalon_scene::{Pass, Scene, StencilOperation};

const TILER: &str = "Mali, PowerVR, Turnip: contents that a tiler does not keep";

/// Returns true if two passes draw to a common attachment.
fn share(a: &Pass, b: &Pass) -> bool {
    let color = a.color.iter().any(|i| b.color.contains(i));
    color || a.depth_stencil.is_some() && a.depth_stencil == b.depth_stencil
}

/// Clears passes whose output a later pass discards. `lost` decides, given both passes and their distance.
fn lose(lost: impl Fn(&Pass, &Pass, usize) -> bool + Send + Sync + 'static) -> Plant {
    passes(move |asked, number, pass| {
        let mut later = (1..).zip(&asked.passes[number + 1..]);
        if later.any(|(distance, later)| lost(&asked.passes[number], later, distance)) {
            pass.draws.clear();
        }
    })
}

/// Clears some passes, given the earlier passes.
fn emptied(strikes: fn(&[Pass], &Pass) -> bool) -> Plant {
    passes(move |asked, number, pass| {
        if strikes(&asked.passes[..number], pass) {
            pass.draws.clear();
        }
    })
}

/// Changes each pass except the first, given the previous pass.
fn after(bug: impl Fn(&Pass, &mut Pass) + Send + Sync + 'static) -> Plant {
    passes(move |asked, number, pass| {
        if number > 0 {
            bug(&asked.passes[number - 1], pass);
        }
    })
}

/// Changes each pass except the last.
fn earlier(bug: impl Fn(&mut Pass) + Send + Sync + 'static) -> Plant {
    passes(move |asked, number, pass| {
        if number + 1 < asked.passes.len() {
            bug(pass);
        }
    })
}

/// Returns the formats, sizes and sample counts of attachments.
fn shape(
    scene: &Scene,
    indices: impl IntoIterator<Item = usize>,
) -> Vec<(TextureFormat, [u32; 2], u32)> {
    let attachments = indices.into_iter().map(|i| &scene.attachments[i]);
    attachments.map(|a| (a.format, a.size, a.samples)).collect()
}

bugs! {
    source TILER;
    "pass-not-stored: What a pass drew is lost for the next one on the same attachments." =>
        lose(|pass, later, distance| distance == 1 && share(pass, later));
    for (words, name, least) in [("another pass", "while-away", 2), ("two other passes", "behind-two-passes", 3)] {
        "attachment-lost-{name}: What a pass drew is lost where its attachments come back behind {words}." =>
            lose(move |pass, later, distance| distance >= least && share(pass, later));
    }
    "depth-lost-for-the-next-pass: Depth is lost where another pass follows." =>
        earlier(|pass| pass.draws.iter_mut().for_each(setter(DEPTH_WRITE, false)));
    "stencil-lost-for-the-next-pass: Stencil is lost where another pass follows." =>
        earlier(|pass| pass.draws.iter_mut().for_each(setter(STENCIL_WRITE_MASK, 0)));
    "depth-and-stencil-lost-without-colour: Depth and stencil of a pass without colour are lost." =>
        emptied(|_, pass| pass.color.is_empty());
    "texture-as-first-sampled: A texture that was sampled keeps what it held then." =>
        emptied(|before, pass| {
            let draws = before.iter().flat_map(|p| &p.draws);
            let mut read = draws.flat_map(|d| &d.textures);
            read.any(|texture| pass.color.contains(texture))
        }), source "wgpu's GL, Zink: a cache that is not flushed";
    "texture-as-uploaded: What was drawn to a texture does not reach the next pass." =>
        lose(|pass, later, distance| {
            let mut read = later.draws.iter().flat_map(|d| &d.textures);
            distance == 1 && read.any(|t| pass.color.contains(t))
        }), source CONFUSION;
    source CONFUSION;
    "third-pass-dropped: The third pass on an attachment draws nothing." =>
        emptied(|before, pass| before.iter().filter(|b| share(b, pass)).count() == 2);
    "sixteenth-pass-dropped: Passes behind the fifteenth draw nothing." => emptied(|before, _| before.len() >= 15);
    "second-pass-lost: The second pass draws nothing." => emptied(|before, _| before.len() == 1);
    "first-draw-of-later-passes-lost: Every pass but the first loses its first draw." =>
        after(|_, pass| drop(pass.draws.drain(..1.min(pass.draws.len()))));
    "last-draw-of-earlier-passes-lost: Every pass but the last loses its last draw." =>
        earlier(|pass| drop(pass.draws.pop()));
    "second-draw-lost: The second draw of a pass is lost." =>
        passes(|_, _, pass| { if pass.draws.len() > 1 { pass.draws.remove(1); } });
    "passes-swapped: The first two passes on the same attachments change places." =>
        scene(|scene| {
            if let [first, second, ..] = &mut scene.passes[..]
                && first.color == second.color && first.depth_stencil == second.depth_stencil
            {
                std::mem::swap(&mut first.draws, &mut second.draws);
            }
        });
    "equal-state-draw-skipped-in-the-next-pass: A draw like the last one before is skipped." =>
        after(|before, pass| {
            if !pass.draws.is_empty() && before.draws.last() == pass.draws.first() { pass.draws.remove(0); }
        });
    "color-attachment-kept: A pass draws to the like colour attachments of the pass before." =>
        passes(|asked, number, pass| {
            let Some(before) = number.checked_sub(1).map(|n| &asked.passes[n].color) else { return; };
            let mut fetched = pass.draws.iter().flat_map(|d| &d.textures);
            let free = !fetched.any(|t| before.contains(t));
            if free && shape(asked, before.clone()) == shape(asked, pass.color.clone()) {
                pass.color.clone_from(before);
            }
        });
    "depth-attachment-kept: A pass tests the like depth attachment of the pass before." =>
        passes(|asked, number, pass| {
            let before = number.checked_sub(1).and_then(|n| asked.passes[n].depth_stencil);
            if before.is_some() && shape(asked, before) == shape(asked, pass.depth_stencil) {
                pass.depth_stencil = before;
            }
        });
    "framebuffer-not-switched-back: Of bindings A, B, A the third stays B." =>
        passes(|asked, number, pass| {
            let Some([first, before]) = asked.passes[..number].last_chunk() else { return; };
            let back = pass.color == first.color && pass.color != before.color;
            if back && shape(asked, before.color.clone()) == shape(asked, pass.color.clone()) {
                pass.color.clone_from(&before.color);
            }
        }), source "wgpu's GL: a cached framebuffer";
    source "ANGLE: read-only depth feedback loops";
    "read-only-stays: The pass behind a read-only one is read-only too." =>
        read_only(1, |draw| {
            setter(DEPTH_WRITE, false)(draw);
            setter(STENCIL_WRITE_MASK, 0)(draw);
        });
    "read-only-first-draw: The first draw behind a read-only pass does not write depth." =>
        after(|before, pass| {
            let draws = pass.draws.iter_mut().take(usize::from(before.depth_stencil_read_only));
            draws.for_each(setter(DEPTH_WRITE, false));
        });
    source CONFUSION;
    "read-only-untested: A read-only pass does not test." =>
        read_only(0, |draw| (draw.depth, draw.stencil) = (None, None));
    "read-only-stencil-kept: A pass after a read-only one does not write stencil." =>
        read_only(1, setter(STENCIL_OPERATIONS, StencilOperation::Keep));
    "depth-test-off-after-read-only: A pass after a read-only one does not test depth." =>
        read_only(1, setter(DEPTH, None));
    "depth-test-off-in-read-only: A read-only pass after another does not test depth." =>
        after(|_, pass| if pass.depth_stencil_read_only { pass.draws.iter_mut().for_each(setter(DEPTH, None)) });
    "resolve-first-target: Only the first target of a pass is resolved." =>
        passes(|_, _, pass| pass.resolve.iter_mut().skip(1).for_each(|r| *r = None));
    "resolve-second-target: Of several targets, the second is not resolved." =>
        passes(|_, _, pass| if let Some(second) = pass.resolve.get_mut(1) { *second = None });
    "resolve-once: A target that was resolved to is not resolved to again." =>
        passes(|asked, number, pass| {
            for target in &mut pass.resolve {
                let mut before = asked.passes[..number].iter();
                if before.any(|b| target.is_some() && b.resolve.contains(target)) { *target = None; }
            }
        });
    "later-resolves-lost: Only the first pass resolves." => after(|_, pass| pass.resolve.fill(None));
    "earlier-resolves-lost: Only the last pass resolves." => earlier(|pass| pass.resolve.fill(None));
    for (from, word) in [(2, "second"), (4, "fourth"), (64, "sixty-fourth")] {
        "draw-lost-from-the-{word}-submission: From the {word} submission on the last draw is lost." =>
            again(from, |scene| { scene.passes.last_mut().and_then(|pass| pass.draws.pop()); }),
            source "a ring of buffers that is used up";
    }
    "draw-twice-from-the-second-submission: From the second one on the last pass is drawn twice." =>
        again(2, |scene| scene.passes.extend(scene.passes.last().cloned()));
    "contents-stay-from-the-second-submission: From the second one on attachments keep their contents." =>
        again(2, |scene| scene.passes.extend(scene.passes.clone())), source "a clear that is skipped as redundant";
    "params-shared-from-the-second-submission: From the second one on all draws have the last's parameters." =>
        again(2, |scene| {
            if let Some(params) = all_draws(scene).last().map(|d| d.params) {
                all_draws(scene).for_each(|d| d.params = params);
            }
        }), source "a ring of uniform buffers that wraps";
}
