//! Bugs of draws that read attachments of their own pass.

use crate::hooks::own_texel;
use crate::list::{CONFUSION, bugs};
use crate::plant::{Plant, scene};
use etalon_frame::Aspect;
use etalon_scene::{
    Draw, FrontFace, MeshSource, Pass, PassOperations, Scene, Shader, Splat, Viewport,
};

/// Changes passes in which draws read the pass, given the indices of these draws, the last one first.
fn reading(bug: fn(&mut Vec<Draw>, usize)) -> Plant {
    scene(move |scene| {
        for pass in scene.passes.iter_mut().filter(|p| p.clears.is_empty()) {
            for index in (0..pass.draws.len()).rev() {
                if pass.draws[index].reads_own(pass) {
                    bug(&mut pass.draws, index);
                }
            }
        }
    })
}

/// Changes the attachments that draws read of their pass: `bug` returns another one for the pass, the draw and
/// the attachment.
fn redirected(bug: fn(&mut Scene, &Pass, &Draw, usize) -> usize) -> Plant {
    scene(move |scene| {
        for number in 0..scene.passes.len() {
            let pass = scene.passes[number].clone();
            for (index, draw) in pass.draws.iter().enumerate() {
                for (t, texture) in draw.textures.iter().enumerate() {
                    if pass.attaches(*texture) {
                        let other = bug(scene, &pass, draw, *texture);
                        scene.passes[number].draws[index].textures[t] = other;
                    }
                }
            }
        }
    })
}

/// Returns a new attachment with the initial contents of another one.
fn untouched(scene: &mut Scene, index: usize) -> usize {
    let mut copy = scene.attachments[index].clone();
    copy.name.push_str(" before");
    scene.attachments.push(copy);
    scene.attachments.len() - 1
}

/// Returns passes with the same draws, in which the first draw that reads its pass reads a copy that was made
/// before it.
fn split(scene: &mut Scene, mut pass: Pass) -> Vec<Pass> {
    let Some(index) = pass.draws.iter().position(|draw| draw.reads_own(&pass)) else {
        return vec![pass];
    };
    let read = pass.draws[index].textures[0];
    let attachment = &scene.attachments[read];
    let (size, format) = (attachment.size, attachment.format);
    if !pass.clears.is_empty() || !format.is_color() || attachment.samples > 1 {
        return vec![pass];
    }
    let whole = MeshSource::Full {
        z: 0.0,
        value: Splat([0.0; 4]),
        winding: FrontFace::Ccw,
    };
    let Ok(mesh) = whole.expand(size) else {
        return vec![pass];
    };
    let copy = untouched(scene, read);
    let mut copied = Draw::new(Shader::TexelColor, mesh, Viewport::whole(size));
    copied.textures = vec![read];
    let mut rest = pass.clone();
    rest.operations = PassOperations::default();
    rest.draws.drain(..index);
    rest.draws[0].textures[0] = copy;
    pass.draws.truncate(index);
    pass.resolve.fill(None);
    let between = Pass {
        color: vec![copy],
        resolve: vec![None],
        draws: vec![copied],
        ..Pass::default()
    };
    vec![pass, between, rest]
}

bugs! {
    class "own-pass", "sequence";
    source "drivers that fetch from a texture while its tile is still in flight";
    "as-before-the-pass: A draw that reads its pass sees what was there before the first pass." =>
        redirected(|scene, _, _, index| untouched(scene, index));
    "depth-as-before-the-pass: A draw that reads the depth of its pass sees the depth before the first pass." =>
        redirected(|scene, _, draw, index| {
            match draw.aspect_read(scene.attachments[index].format) {
                Aspect::Depth => untouched(scene, index),
                Aspect::Color | Aspect::Stencil => index,
            }
        });
    "stencil-as-before-the-pass: A draw that reads the stencil of its pass sees the stencil before the first pass." =>
        redirected(|scene, _, draw, index| {
            match draw.aspect_read(scene.attachments[index].format) {
                Aspect::Stencil => untouched(scene, index),
                Aspect::Color | Aspect::Depth => index,
            }
        });
    "barrier-missed: A draw that reads its pass overtakes the draw before it." =>
        reading(|draws, index| if index > 0 { draws.swap(index - 1, index) });
    "after-its-own-write: A draw that reads its pass sees what it has written itself." =>
        reading(|draws, index| draws.insert(index, draws[index].clone()));
    "not-in-order: Primitives that overlap all read what was there before their draw." =>
        scene(|scene| scene.passes = std::mem::take(&mut scene.passes).into_iter().flat_map(|pass| split(scene, pass)).collect());
    source CONFUSION;
    "first-location: A draw that reads a colour of its pass reads the first one." =>
        redirected(|scene, pass, _, index| {
            if scene.attachments[index].format.is_color() { pass.color[0] } else { index }
        });
    "next-texel: A draw that reads its pass reads the texel to the right." =>
        own_texel(|([x, y], sample), _| ([x + 1, y], sample));
    "upside-down: A draw that reads its pass reads it upside down." =>
        own_texel(|([x, y], sample), [_, height]| ([x, height - 1 - y], sample));
    "first-sample: A draw that reads its pass reads the first sample for all." =>
        own_texel(|(texel, _), _| (texel, 0));
}
