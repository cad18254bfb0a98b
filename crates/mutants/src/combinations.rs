//! Bugs of states that a driver handles correctly alone but not together, and of passes without draws or
//! without colour.

use crate::fields::{FACES, FIELDS};
use crate::list::bugs;
use crate::plant::{Plant, draws, each, from_draw, passes, scene};
use etalon_scene::{CullMode, Draw, LoadOperation, Pass, Scene, Shader};

/// The bit of alpha in a write mask.
const ALPHA: u8 = 0b1000;

/// Disables alpha to coverage in some draws.
fn uncovered(strikes: fn(&Scene, &Pass, &Draw) -> bool) -> Plant {
    passes(move |scene, number, pass| {
        for draw in &mut pass.draws {
            draw.multisample.alpha_to_coverage &= !strikes(scene, &scene.passes[number], draw);
        }
    })
}

/// Removes the fragment shader of some draws in passes without colour.
fn shaderless(strikes: fn(Shader) -> bool) -> Plant {
    passes(move |_, _, pass| {
        let colorless = pass.color.is_empty();
        for draw in pass
            .draws
            .iter_mut()
            .filter(|d| colorless && strikes(d.shader))
        {
            draw.shader = Shader::VertexOnly;
            draw.textures.clear();
        }
    })
}

/// Returns true for draws that are discarded entirely.
fn is_discarded(draw: &Draw) -> bool {
    draw.rasterizer_discard || draw.cull == CullMode::FrontAndBack
}

bugs! {
    class "combination", "multisample";
    "coverage-beside-masked-alpha: Alpha covers nothing where the first target masks alpha." =>
        uncovered(|_, _, draw| draw.targets.first().is_some_and(|t| t.write_mask & ALPHA == 0)),
        source "radeonsi: the export of an output follows its write mask";
    "coverage-beside-written-depth: Alpha covers nothing where the shader writes depth." =>
        uncovered(|_, _, draw| draw.shader.writes_depth()),
        source "radeonsi on gfx11: alpha left the export where depth was exported";
    "coverage-of-formats-without-alpha: Alpha covers nothing where the first target has none." =>
        uncovered(|scene, pass, _| {
            let first = pass.color.first().map(|index| &scene.attachments[*index]);
            first.is_some_and(|a| a.format.color_channels().len() < 4)
        }), source "the format's alpha in the place of the shader's";
    "coverage-of-one-target: Alpha covers nothing in passes with several targets." =>
        uncovered(|_, pass, _| pass.color.len() > 1), source "Dawn, radeonsi: coverage and several targets";
    source "radv: no shader where nothing is exported";
    "colorless-discard-lost: Without colour, no shader discards." => shaderless(Shader::discards), area "early-z";
    "colorless-depth-lost: Without colour, no shader writes depth." => shaderless(Shader::writes_depth), area "early-z";
    source "Dawn, Qualcomm: passes without draws do not resolve";
    "empty-resolve-lost: Passes without draws resolve no colour." =>
        passes(|_, _, pass| if pass.draws.is_empty() { pass.resolve.fill(None) }), area "sequence";
    "empty-depth-resolve-lost: Passes without draws resolve neither depth nor stencil." =>
        passes(|_, _, pass| if pass.draws.is_empty() { pass.depth_stencil_resolve = None }), area "sequence";
    "empty-resolve-before-clear: Passes without draws resolve what was there before their clears." =>
        scene(|scene| scene.passes = std::mem::take(&mut scene.passes).into_iter().flat_map(|pass| {
            if !pass.draws.is_empty() || pass.resolve_targets().next().is_none() { return vec![pass]; }
            let early = Pass { operations: Default::default(), clears: Vec::new(), ..pass.clone() };
            let late = Pass { resolve: vec![None; pass.color.len()], depth_stencil_resolve: None, ..pass };
            vec![early, late]
        }).collect()), area "sequence";
    source "wgpu over OpenGL: targets cleared before they were chosen";
    "load-of-the-first: All targets have the first one's load operation." =>
        passes(|_, _, pass| {
            if let Some(first) = pass.operations.color.first().copied() { pass.operations.color.fill(first); }
        }), area "sequence";
    "load-of-one: Of several targets that a pass clears on load, the last alone is cleared." =>
        passes(|_, _, pass| {
            let cleared = |load: LoadOperation<_>| load != LoadOperation::Load;
            let mut clears = pass.operations.color.iter_mut();
            let last = clears.rfind(|o| cleared(o.load));
            if last.is_some() { clears.for_each(|o| o.load = LoadOperation::Load); }
        }), area "sequence";
    "mask-lost-under-depth: A colour mask does not hold beside a depth test." =>
        draws(|draw| {
            let masked = draw.targets.iter_mut().filter(|t| t.write_mask != 0);
            masked.for_each(|t| t.write_mask = 0b1111);
        }), area "blend", source "Adreno, Mali: colour masks beside depth tests", when |draw| draw.depth.is_some();
    "stencil-reference-outside-mask: Nothing is written where the reference has no bit of the mask." =>
        each(FACES, |face| if face.reference & face.write_mask == 0 { face.write_mask = 0 }),
        area "stencil", source "ANGLE: took the mask and the reference together for a mask of 0";
    "viewport-middle-held: The middle of a viewport is moved into the attachment." =>
        passes(|scene, number, pass| {
            let size = scene.pass_size(&scene.passes[number]).map(|side| side as f32);
            for draw in &mut pass.draws {
                let [x, y, width, height] = &mut draw.viewport.rect;
                *x = (*x + *width / 2.0).clamp(0.0, size[0]) - *width / 2.0;
                *y = (*y + *height / 2.0).clamp(0.0, size[1]) - *height / 2.0;
            }
        }), area "scissor", source "guard bands around the middle of the viewport";

    // State that an entirely discarded draw leaves to the next draw.
    source "Adreno: state of a draw with rasterizer discard";
    let changed = ["viewport-rect", "viewport-depth", "scissor", "blend", "write-mask", "stencil-test"];
    let struck = FIELDS.iter().filter(|field| field.in_sequences() && changed.contains(&field.name));
    for field in struck {
        let (name, words, take) = (field.name, field.words(), field.take);
        "discarded-leaves-{name}: After a draw that is discarded whole, the {words} is its own." =>
            from_draw(move |before, draw| if is_discarded(before) && !is_discarded(draw) { take(before, draw) }),
            area "sequence";
    }
}
