//! Passes that lose draws, attachments or resolves, or what they promise.

use super::super::list::{CONFUSION, List};
use super::super::plant::{Plant, scene};
use etalon_scene::{Draw, Pass, Scene, StencilOperation};

/// Changes each pass but the first, given the unchanged pass before it.
fn after(bug: impl Fn(&Pass, &mut Pass) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let asked = scene.passes.clone();
        for (before, pass) in asked.iter().zip(scene.passes.iter_mut().skip(1)) {
            bug(before, pass);
        }
    })
}

/// True if attachments have the same format, size and samples.
fn alike(scene: &Scene, a: &[usize], b: &[usize]) -> bool {
    let like = |i: usize| {
        let attachment = &scene.attachments[i];
        (attachment.format, attachment.size, attachment.samples)
    };
    a.iter().map(|i| like(*i)).eq(b.iter().map(|i| like(*i)))
}

fn without_stencil_writes(draw: &mut Draw) {
    if let Some(stencil) = &mut draw.stencil {
        for face in [&mut stencil.front, &mut stencil.back] {
            face.fail_op = StencilOperation::Keep;
            face.depth_fail_op = StencilOperation::Keep;
            face.pass_op = StencilOperation::Keep;
        }
    }
}

pub(super) fn add(list: &mut List) {
    lost(list);
    attachments(list);
    read_only(list);
    resolves(list);
}

fn lost(list: &mut List) {
    list.add(
        "first-draw-of-later-passes-lost",
        CONFUSION,
        "Every pass but the first loses its first draw.",
        after(|_, pass| {
            if !pass.draws.is_empty() {
                pass.draws.remove(0);
            }
        }),
    );
    list.add(
        "last-draw-of-earlier-passes-lost",
        CONFUSION,
        "Every pass but the last loses its last draw.",
        scene(|scene| {
            let earlier = scene.passes.len().saturating_sub(1);
            for pass in &mut scene.passes[..earlier] {
                pass.draws.pop();
            }
        }),
    );
    list.add(
        "second-pass-lost",
        CONFUSION,
        "The second pass draws nothing.",
        scene(|scene| {
            if let Some(pass) = scene.passes.get_mut(1) {
                pass.draws.clear();
            }
        }),
    );
    list.add(
        "second-draw-lost",
        CONFUSION,
        "The second draw of a pass is lost.",
        scene(|scene| {
            for pass in &mut scene.passes {
                if pass.draws.len() > 1 {
                    pass.draws.remove(1);
                }
            }
        }),
    );
    list.add(
        "passes-swapped",
        CONFUSION,
        "The first two passes on the same attachments change places.",
        scene(|scene| {
            if let [first, second, ..] = &mut scene.passes[..]
                && first.color == second.color
                && first.depth_stencil == second.depth_stencil
            {
                std::mem::swap(&mut first.draws, &mut second.draws);
            }
        }),
    );
    list.add(
        "equal-state-draw-skipped-in-the-next-pass",
        CONFUSION,
        "The first draw of a pass is skipped if it equals the last one of the pass before.",
        after(|before, pass| {
            if !pass.draws.is_empty() && before.draws.last() == pass.draws.first() {
                pass.draws.remove(0);
            }
        }),
    );
}

fn attachments(list: &mut List) {
    list.add(
        "color-attachment-kept",
        CONFUSION,
        "A pass draws to the colour attachments of the pass before, if they are alike.",
        scene(|scene| {
            for at in (1..scene.passes.len()).rev() {
                let before = scene.passes[at - 1].color.clone();
                let fetched = scene.passes[at].draws.iter().flat_map(|d| &d.textures);
                let free = !fetched.into_iter().any(|t| before.contains(t));
                if free && alike(scene, &before, &scene.passes[at].color) {
                    scene.passes[at].color = before;
                }
            }
        }),
    );
    list.add(
        "depth-attachment-kept",
        CONFUSION,
        "A pass tests the depth attachment of the pass before, if it is alike.",
        scene(|scene| {
            for at in (1..scene.passes.len()).rev() {
                let before = scene.passes[at - 1].depth_stencil;
                let own = scene.passes[at].depth_stencil;
                if let (Some(before), Some(own)) = (before, own)
                    && alike(scene, &[before], &[own])
                {
                    scene.passes[at].depth_stencil = Some(before);
                }
            }
        }),
    );
    list.add(
        "texture-as-it-began",
        CONFUSION,
        "A texture that earlier passes drew is read as it began.",
        super::contents::textures_as_they_began(),
    );
}

fn read_only(list: &mut List) {
    list.add(
        "read-only-stencil-kept",
        CONFUSION,
        "A pass after a read-only one does not write stencil.",
        after(|before, pass| {
            if before.depth_stencil_read_only {
                pass.draws.iter_mut().for_each(without_stencil_writes);
            }
        }),
    );
    list.add(
        "depth-test-off-after-read-only",
        CONFUSION,
        "A pass after a read-only one does not test depth.",
        after(|before, pass| {
            if before.depth_stencil_read_only {
                pass.draws.iter_mut().for_each(|draw| draw.depth = None);
            }
        }),
    );
    list.add(
        "depth-test-off-in-read-only",
        CONFUSION,
        "A read-only pass after another does not test depth.",
        after(|_, pass| {
            if pass.depth_stencil_read_only {
                pass.draws.iter_mut().for_each(|draw| draw.depth = None);
            }
        }),
    );
}

fn resolves(list: &mut List) {
    list.add(
        "later-resolves-lost",
        CONFUSION,
        "Only the first pass resolves.",
        after(|_, pass| pass.resolve.iter_mut().for_each(|r| *r = None)),
    );
    list.add(
        "earlier-resolves-lost",
        CONFUSION,
        "Only the last pass resolves.",
        scene(|scene| {
            let earlier = scene.passes.len().saturating_sub(1);
            for pass in &mut scene.passes[..earlier] {
                pass.resolve.iter_mut().for_each(|r| *r = None);
            }
        }),
    );
}
