//! State that persists: of the previous case, and of the previous draw.

use super::list::List;
use super::plant::{Plant, from_case, from_draw};
use etalon_scene::{DepthBias, Draw};

type Leftover = fn(&Draw, &mut Draw);

/// The state that persists, the area that must catch it, and the copy from the previous draw.
pub(super) const LEFTOVERS: [(&str, &str, Leftover); 36] = [
    ("depth-test", "depth", |before, draw| {
        draw.depth = before.depth
    }),
    ("depth-compare", "depth", |before, draw| {
        if let (Some(depth), Some(before)) = (&mut draw.depth, before.depth) {
            depth.compare = before.compare;
        }
    }),
    ("depth-write", "depth", |before, draw| {
        if let (Some(depth), Some(before)) = (&mut draw.depth, before.depth) {
            depth.write = before.write;
        }
    }),
    ("depth-test-when-off", "depth", |before, draw| {
        draw.depth = draw.depth.or(before.depth);
    }),
    ("stencil", "stencil", |before, draw| {
        draw.stencil = before.stencil
    }),
    ("stencil-when-off", "stencil", |before, draw| {
        draw.stencil = draw.stencil.or(before.stencil);
    }),
    ("stencil-reference", "stencil", |before, draw| {
        if let (Some(stencil), Some(before)) = (&mut draw.stencil, before.stencil) {
            stencil.front.reference = before.front.reference;
            stencil.back.reference = before.back.reference;
        }
    }),
    ("stencil-write-mask", "stencil", |before, draw| {
        if let (Some(stencil), Some(before)) = (&mut draw.stencil, before.stencil) {
            stencil.front.write_mask = before.front.write_mask;
            stencil.back.write_mask = before.back.write_mask;
        }
    }),
    ("stencil-operations", "stencil", |before, draw| {
        if let (Some(stencil), Some(before)) = (&mut draw.stencil, before.stencil) {
            for (face, before) in [
                (&mut stencil.front, before.front),
                (&mut stencil.back, before.back),
            ] {
                face.fail_op = before.fail_op;
                face.depth_fail_op = before.depth_fail_op;
                face.pass_op = before.pass_op;
            }
        }
    }),
    ("blend", "blend", |before, draw| {
        for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
            target.blend = before.blend;
        }
    }),
    ("blend-when-off", "blend", |before, draw| {
        for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
            target.blend = target.blend.or(before.blend);
        }
    }),
    ("advanced-blend", "blend", |before, draw| {
        for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
            target.advanced = before.advanced;
        }
    }),
    ("blend-constant", "blend", |before, draw| {
        draw.blend_constant = before.blend_constant;
    }),
    ("write-mask", "blend", |before, draw| {
        for (target, before) in draw.targets.iter_mut().zip(&before.targets) {
            target.write_mask = before.write_mask;
        }
    }),
    ("cull", "cull", |before, draw| {
        draw.cull = before.cull;
        draw.front_face = before.front_face;
    }),
    ("logic", "blend", |before, draw| draw.logic = before.logic),
    ("logic-when-off", "blend", |before, draw| {
        draw.logic = draw.logic.or(before.logic);
    }),
    ("second-target", "blend", |before, draw| {
        if let (Some(target), Some(before)) = (draw.targets.get_mut(1), before.targets.get(1)) {
            *target = *before;
        }
    }),
    ("depth-bias", "depth", |before, draw| {
        draw.depth_bias = before.depth_bias;
    }),
    ("depth-bias-when-off", "depth", |before, draw| {
        if draw.depth_bias == DepthBias::default() {
            draw.depth_bias = before.depth_bias;
        }
    }),
    ("depth-clamp", "depth", |before, draw| {
        draw.depth_clamp = before.depth_clamp;
    }),
    ("depth-bounds", "depth", |before, draw| {
        draw.depth_bounds = before.depth_bounds;
    }),
    ("depth-bounds-when-off", "depth", |before, draw| {
        draw.depth_bounds = draw.depth_bounds.or(before.depth_bounds);
    }),
    ("depth-range", "depth", |before, draw| {
        draw.viewport.depth = before.viewport.depth;
    }),
    ("viewport", "scissor", |before, draw| {
        draw.viewport.rect = before.viewport.rect;
    }),
    ("scissor", "scissor", |before, draw| {
        draw.scissor = before.scissor;
    }),
    ("scissor-when-off", "scissor", |before, draw| {
        draw.scissor = draw.scissor.or(before.scissor);
    }),
    ("sample-mask", "multisample", |before, draw| {
        draw.multisample.mask = before.multisample.mask;
    }),
    ("alpha-to-coverage", "multisample", |before, draw| {
        draw.multisample.alpha_to_coverage = before.multisample.alpha_to_coverage;
    }),
    ("alpha-to-one", "multisample", |before, draw| {
        draw.multisample.alpha_to_one = before.multisample.alpha_to_one;
    }),
    ("min-sample-shading", "multisample", |before, draw| {
        draw.multisample.min_sample_shading = before.multisample.min_sample_shading;
    }),
    ("sample-coverage", "multisample", |before, draw| {
        draw.multisample.sample_coverage = before.multisample.sample_coverage;
    }),
    ("sample-coverage-when-off", "multisample", |before, draw| {
        let state = &mut draw.multisample;
        state.sample_coverage = state.sample_coverage.or(before.multisample.sample_coverage);
    }),
    ("polygon-mode", "cull", |before, draw| {
        draw.polygon_mode = before.polygon_mode;
    }),
    ("rasterizer-discard", "cull", |before, draw| {
        draw.rasterizer_discard = before.rasterizer_discard;
    }),
    ("topology", "cull", |before, draw| {
        draw.topology = before.topology;
    }),
];

pub(super) fn add(list: &mut List) {
    type Sticks = fn(Leftover) -> Plant;
    let kinds: [(&str, Sticks); 2] = [
        ("case", |take| from_case(take)),
        ("draw", |take| from_draw(take)),
    ];
    for (kind, plant) in kinds {
        for (what, area, take) in LEFTOVERS {
            list.class("sticky", area);
            list.add(
                &format!("{what}-from-the-{kind}-before"),
                "lavapipe, ANGLE: stale state",
                format!("The {what} of the previous {kind} persists."),
                plant(take),
            );
        }
    }
}
