//! Bugs of sequences: one state that a draw or a pass leaves to the next, contents that an attachment loses
//! between passes, queries that get each other's values, and submissions after the first.
//!
//! A state stays by itself, not with its neighbours: a driver that tracks changes forgets one of them.

mod clears;
mod passes;

use super::list::List;
use super::plant::scene;
use etalon_scene::{BlendComponent, BlendState, Draw, Scene, StencilFace};

const STALE: &str = "lavapipe, ANGLE, wgpu: a change that is not tracked";

type Stay = fn(&Draw, &mut Draw);

pub(super) fn add(list: &mut List) {
    list.class("sequence", "sequence");
    for (name, stay) in STATES {
        list.add(
            &format!("{name}-stays-in-a-pass"),
            STALE,
            format!("The {name} of the draw before stays within a pass."),
            scene(move |scene| stays(scene, stay, Place::Draw)),
        );
        list.add(
            &format!("{name}-stays-over-passes"),
            STALE,
            format!("The {name} of the last draw stays for the first one of the next pass."),
            scene(move |scene| stays(scene, stay, Place::Pass)),
        );
    }
    passes::add(list);
    clears::add(list);
}

/// The place where a state stays.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// Between draws of one pass.
    Draw,
    /// From the last draw of a pass to the first of the next.
    Pass,
}

/// Lets a state stay, as the scene asked for it.
fn stays(scene: &mut Scene, stay: Stay, place: Place) {
    let mut before: Option<Draw> = None;
    for pass in &mut scene.passes {
        for (i, draw) in pass.draws.iter_mut().enumerate() {
            let here = if i == 0 { Place::Pass } else { Place::Draw };
            let asked = draw.clone();
            if let Some(before) = before.as_ref().filter(|_| here == place) {
                stay(before, draw);
            }
            before = Some(asked);
        }
    }
}

fn blends(before: &Draw, draw: &mut Draw, stay: fn(BlendState, &mut BlendState)) {
    for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
        if let (Some(blend), Some(before)) = (&mut target.blend, before.blend) {
            stay(before, blend);
        }
    }
}

fn fronts(before: &Draw, draw: &mut Draw, stay: fn(StencilFace, &mut StencilFace)) {
    if let (Some(stencil), Some(before)) = (&mut draw.stencil, before.stencil) {
        stay(before.front, &mut stencil.front);
    }
}

fn backs(before: &Draw, draw: &mut Draw, stay: fn(StencilFace, &mut StencilFace)) {
    if let (Some(stencil), Some(before)) = (&mut draw.stencil, before.stencil) {
        stay(before.back, &mut stencil.back);
    }
}

fn both(before: &Draw, draw: &mut Draw, stay: fn(StencilFace, &mut StencilFace)) {
    fronts(before, draw, stay);
    backs(before, draw, stay);
}

fn operation(before: BlendComponent, component: &mut BlendComponent) {
    component.operation = before.operation;
}

fn src_factor(before: BlendComponent, component: &mut BlendComponent) {
    component.src_factor = before.src_factor;
}

fn dst_factor(before: BlendComponent, component: &mut BlendComponent) {
    component.dst_factor = before.dst_factor;
}

/// Each state, and the copy of it from the draw before.
const STATES: [(&str, Stay); 64] = [
    ("indices", |before, draw| {
        draw.mesh.indices.clone_from(&before.mesh.indices);
    }),
    ("topology", |before, draw| {
        draw.topology = before.topology;
    }),
    ("shader", |before, draw| {
        if before.shader.textures() == draw.shader.textures()
            && before.shader.counts_runs() == draw.shader.counts_runs()
        {
            draw.shader = before.shader;
        }
    }),
    ("params-color", |before, draw| {
        draw.params.color = before.params.color;
    }),
    ("params-back-color", |before, draw| {
        draw.params.back_color = before.params.back_color;
    }),
    ("textures", |before, draw| {
        if before.textures.len() == draw.textures.len() {
            draw.textures.clone_from(&before.textures);
        }
    }),
    ("sampler-filter", |before, draw| {
        if let (Some(sampler), Some(before)) = (&mut draw.sampler, before.sampler) {
            sampler.filter = before.filter;
        }
    }),
    ("sampler-address-across", |before, draw| {
        if let (Some(sampler), Some(before)) = (&mut draw.sampler, before.sampler) {
            sampler.address[0] = before.address[0];
        }
    }),
    ("sampler-address-down", |before, draw| {
        if let (Some(sampler), Some(before)) = (&mut draw.sampler, before.sampler) {
            sampler.address[1] = before.address[1];
        }
    }),
    ("counters", |before, draw| {
        if before.shader.counts_runs() == draw.shader.counts_runs() {
            draw.counters.clone_from(&before.counters);
        }
    }),
    ("early-tests", |before, draw| {
        if !before.early_tests.is_conservative() || draw.shader.writes_depth() {
            draw.early_tests = before.early_tests;
        }
    }),
    ("cull", |before, draw| {
        draw.cull = before.cull;
    }),
    ("front-face", |before, draw| {
        draw.front_face = before.front_face;
    }),
    ("polygon-mode", |before, draw| {
        draw.polygon_mode = before.polygon_mode;
    }),
    ("rasterizer-discard", |before, draw| {
        draw.rasterizer_discard = before.rasterizer_discard;
    }),
    ("scissor", |before, draw| {
        draw.scissor = before.scissor;
    }),
    ("depth-clamp", |before, draw| {
        draw.depth_clamp = before.depth_clamp;
    }),
    ("depth-bounds", |before, draw| {
        draw.depth_bounds = before.depth_bounds;
    }),
    ("depth-test", |before, draw| {
        draw.depth = before.depth;
    }),
    ("stencil-test", |before, draw| {
        draw.stencil = before.stencil;
    }),
    ("logic", |before, draw| {
        draw.logic = before.logic;
    }),
    ("blend-constant", |before, draw| {
        draw.blend_constant = before.blend_constant;
    }),
    ("viewport-rect", |before, draw| {
        draw.viewport.rect = before.viewport.rect;
    }),
    ("viewport-depth", |before, draw| {
        draw.viewport.depth = before.viewport.depth;
    }),
    ("depth-bias-constant", |before, draw| {
        draw.depth_bias.constant = before.depth_bias.constant;
    }),
    ("depth-bias-slope", |before, draw| {
        draw.depth_bias.slope = before.depth_bias.slope;
    }),
    ("depth-bias-clamp", |before, draw| {
        draw.depth_bias.clamp = before.depth_bias.clamp;
    }),
    ("depth-compare", |before, draw| {
        if let (Some(depth), Some(before)) = (&mut draw.depth, before.depth) {
            depth.compare = before.compare;
        }
    }),
    ("depth-write", |before, draw| {
        if let (Some(depth), Some(before)) = (&mut draw.depth, before.depth) {
            depth.write = before.write;
        }
    }),
    ("stencil-front-compare", |before, draw| {
        fronts(before, draw, |before, face| face.compare = before.compare);
    }),
    ("stencil-front-fail-op", |before, draw| {
        fronts(before, draw, |before, face| face.fail_op = before.fail_op);
    }),
    ("stencil-front-depth-fail-op", |before, draw| {
        fronts(before, draw, |before, face| {
            face.depth_fail_op = before.depth_fail_op
        });
    }),
    ("stencil-front-pass-op", |before, draw| {
        fronts(before, draw, |before, face| face.pass_op = before.pass_op);
    }),
    ("stencil-front-reference", |before, draw| {
        fronts(before, draw, |before, face| {
            face.reference = before.reference
        });
    }),
    ("stencil-front-read-mask", |before, draw| {
        fronts(before, draw, |before, face| {
            face.read_mask = before.read_mask
        });
    }),
    ("stencil-front-write-mask", |before, draw| {
        fronts(before, draw, |before, face| {
            face.write_mask = before.write_mask
        });
    }),
    ("stencil-back-compare", |before, draw| {
        backs(before, draw, |before, face| face.compare = before.compare);
    }),
    ("stencil-back-fail-op", |before, draw| {
        backs(before, draw, |before, face| face.fail_op = before.fail_op);
    }),
    ("stencil-back-depth-fail-op", |before, draw| {
        backs(before, draw, |before, face| {
            face.depth_fail_op = before.depth_fail_op
        });
    }),
    ("stencil-back-pass-op", |before, draw| {
        backs(before, draw, |before, face| face.pass_op = before.pass_op);
    }),
    ("stencil-back-reference", |before, draw| {
        backs(before, draw, |before, face| {
            face.reference = before.reference
        });
    }),
    ("stencil-back-read-mask", |before, draw| {
        backs(before, draw, |before, face| {
            face.read_mask = before.read_mask
        });
    }),
    ("stencil-back-write-mask", |before, draw| {
        backs(before, draw, |before, face| {
            face.write_mask = before.write_mask
        });
    }),
    ("stencil-reference", |before, draw| {
        both(before, draw, |before, face| {
            face.reference = before.reference
        });
    }),
    ("stencil-read-mask", |before, draw| {
        both(before, draw, |before, face| {
            face.read_mask = before.read_mask
        });
    }),
    ("stencil-write-mask", |before, draw| {
        both(before, draw, |before, face| {
            face.write_mask = before.write_mask
        });
    }),
    ("blend", |before, draw| {
        for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
            target.blend = before.blend;
        }
    }),
    ("blend-color-operation", |before, draw| {
        blends(before, draw, |before, blend| {
            operation(before.color, &mut blend.color)
        });
    }),
    ("blend-color-src-factor", |before, draw| {
        blends(before, draw, |before, blend| {
            src_factor(before.color, &mut blend.color)
        });
    }),
    ("blend-color-dst-factor", |before, draw| {
        blends(before, draw, |before, blend| {
            dst_factor(before.color, &mut blend.color)
        });
    }),
    ("blend-alpha-operation", |before, draw| {
        blends(before, draw, |before, blend| {
            operation(before.alpha, &mut blend.alpha)
        });
    }),
    ("blend-alpha-src-factor", |before, draw| {
        blends(before, draw, |before, blend| {
            src_factor(before.alpha, &mut blend.alpha)
        });
    }),
    ("blend-alpha-dst-factor", |before, draw| {
        blends(before, draw, |before, blend| {
            dst_factor(before.alpha, &mut blend.alpha)
        });
    }),
    ("advanced-blend", |before, draw| {
        for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
            target.advanced = before.advanced;
        }
    }),
    ("write-mask", |before, draw| {
        for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
            target.write_mask = before.write_mask;
        }
    }),
    ("blend-second-target", |before, draw| {
        if let (Some(target), Some(before)) = (draw.targets.get_mut(1), before.targets.get(1)) {
            target.blend = before.blend;
        }
    }),
    ("write-mask-second-target", |before, draw| {
        if let (Some(target), Some(before)) = (draw.targets.get_mut(1), before.targets.get(1)) {
            target.write_mask = before.write_mask;
        }
    }),
    ("sample-mask", |before, draw| {
        draw.multisample.mask = before.multisample.mask;
    }),
    ("alpha-to-coverage", |before, draw| {
        draw.multisample.alpha_to_coverage = before.multisample.alpha_to_coverage;
    }),
    ("alpha-to-one", |before, draw| {
        draw.multisample.alpha_to_one = before.multisample.alpha_to_one;
    }),
    ("sample-shading", |before, draw| {
        draw.multisample.min_sample_shading = before.multisample.min_sample_shading;
    }),
    ("sample-coverage", |before, draw| {
        draw.multisample.sample_coverage = before.multisample.sample_coverage;
    }),
    ("sample-coverage-value", |before, draw| {
        if let (Some(coverage), Some(before)) = (
            &mut draw.multisample.sample_coverage,
            before.multisample.sample_coverage,
        ) {
            coverage.value = before.value;
        }
    }),
    ("sample-coverage-invert", |before, draw| {
        if let (Some(coverage), Some(before)) = (
            &mut draw.multisample.sample_coverage,
            before.multisample.sample_coverage,
        ) {
            coverage.invert = before.invert;
        }
    }),
];
