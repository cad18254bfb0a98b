//! Bugs of states that a driver gets right alone and wrong together, and of passes that lack draws or colour.

use crate::fields::{FACES, Field, fields};
use crate::list::List;
use crate::plant::{from_draw, passes};
use etalon_scene::{CullMode, Draw, LoadOperation, Pass, Scene, Shader};

/// The bit of alpha in a write mask.
const ALPHA: u8 = 0b1000;

pub(super) fn add(list: &mut List) {
    list.class("combination", "multisample");
    coverage(list);
    colorless(list);
    empty(list);
    targets(list);
    tests(list);
    discarded(list);
}

/// Adds a bug that switches alpha to coverage off in some draws.
fn uncovered(
    list: &mut List,
    text: &str,
    source: &'static str,
    strikes: fn(&Scene, &Pass, &Draw) -> bool,
) {
    list.bug(text)
        .source(source)
        .plant(passes(move |scene, _, pass| {
            let asked = pass.clone();
            for draw in &mut pass.draws {
                draw.multisample.alpha_to_coverage &= !strikes(scene, &asked, draw);
            }
        }));
}

fn coverage(list: &mut List) {
    uncovered(
        list,
        "coverage-beside-masked-alpha: Alpha covers nothing where the first target masks alpha.",
        "radeonsi: the export of an output follows its write mask",
        |_, _, draw| {
            draw.targets
                .first()
                .is_some_and(|t| t.write_mask & ALPHA == 0)
        },
    );
    uncovered(
        list,
        "coverage-beside-written-depth: Alpha covers nothing where the shader writes depth.",
        "radeonsi on gfx11: alpha left the export where depth was exported",
        |_, _, draw| draw.shader.writes_depth(),
    );
    uncovered(
        list,
        "coverage-of-formats-without-alpha: Alpha covers nothing where the first target has none.",
        "the format's alpha in the place of the shader's",
        |scene, pass, _| {
            let first = pass.color.first().map(|index| &scene.attachments[*index]);
            first.is_some_and(|a| a.format.color_channels().len() < 4)
        },
    );
    uncovered(
        list,
        "coverage-of-one-target: Alpha covers nothing in passes with several targets.",
        "Dawn, radeonsi: coverage and several targets",
        |_, pass, _| pass.color.len() > 1,
    );
}

fn colorless(list: &mut List) {
    list.source("radv: no shader where nothing is exported");
    let shaderless = |discards: bool| {
        passes(move |_, _, pass| {
            if pass.color.is_empty() {
                let draws = pass.draws.iter_mut();
                let struck = draws.filter(|d| {
                    if discards {
                        d.shader.discards()
                    } else {
                        d.shader.writes_depth()
                    }
                });
                for draw in struck {
                    draw.shader = Shader::VertexOnly;
                    draw.textures.clear();
                }
            }
        })
    };
    list.bug("colorless-discard-lost: Without colour, no shader discards.")
        .area("early-z")
        .plant(shaderless(true));
    list.bug("colorless-depth-lost: Without colour, no shader writes depth.")
        .area("early-z")
        .plant(shaderless(false));
}

fn empty(list: &mut List) {
    list.source("Dawn, Qualcomm: passes without draws do not resolve");
    list.bug("empty-resolve-lost: Passes without draws resolve no colour.")
        .area("sequence")
        .passes(|_, _, pass| {
            if pass.draws.is_empty() {
                pass.resolve.fill(None);
            }
        });
    list.bug("empty-depth-resolve-lost: Passes without draws resolve neither depth nor stencil.")
        .area("sequence")
        .passes(|_, _, pass| {
            if pass.draws.is_empty() {
                pass.depth_stencil_resolve = None;
            }
        });
    list.bug("empty-resolve-before-clear: Passes without draws resolve what was there before their clears.")
        .area("sequence")
        .scene(|scene| {
            let mut all = Vec::new();
            for pass in std::mem::take(&mut scene.passes) {
                let resolves = pass.resolve_targets().next().is_some();
                if pass.draws.is_empty() && resolves {
                    let early = Pass {
                        operations: Default::default(),
                        clears: Vec::new(),
                        ..pass.clone()
                    };
                    let late = Pass {
                        resolve: vec![None; pass.color.len()],
                        depth_stencil_resolve: None,
                        ..pass
                    };
                    all.extend([early, late]);
                } else {
                    all.push(pass);
                }
            }
            scene.passes = all;
        });
}

fn targets(list: &mut List) {
    list.source("wgpu over OpenGL: targets cleared before they were chosen");
    list.bug("load-of-the-first: All targets have the first one's load operation.")
        .area("sequence")
        .passes(|_, _, pass| {
            if let Some(first) = pass.operations.color.first().copied() {
                pass.operations.color.fill(first);
            }
        });
    list.bug(
        "load-of-one: Of several targets that a pass clears on load, the last alone is cleared.",
    )
    .area("sequence")
    .passes(|_, _, pass| {
        let cleared = |load: LoadOperation<_>| load != LoadOperation::Load;
        let mut clears = pass.operations.color.iter_mut();
        let last = clears.rfind(|o| cleared(o.load));
        if last.is_some() {
            clears.for_each(|o| o.load = LoadOperation::Load);
        }
    });
}

fn tests(list: &mut List) {
    list.bug("mask-lost-under-depth: A colour mask does not hold beside a depth test.")
        .area("blend")
        .source("Adreno, Mali: colour masks beside depth tests")
        .when(|draw| draw.depth.is_some())
        .draws(|draw| {
            let masked = draw.targets.iter_mut().filter(|t| t.write_mask != 0);
            masked.for_each(|t| t.write_mask = 0b1111);
        });
    list.bug("stencil-reference-outside-mask: Nothing is written where the reference has no bit of the mask.")
        .area("stencil")
        .source("ANGLE: took the mask and the reference together for a mask of 0")
        .each(FACES, |face| {
            if face.reference & face.write_mask == 0 {
                face.write_mask = 0;
            }
        });
    list.bug("viewport-middle-held: The middle of a viewport is moved into the attachment.")
        .area("scissor")
        .source("guard bands around the middle of the viewport")
        .passes(|scene, number, pass| {
            let size = scene
                .pass_size(&scene.passes[number])
                .map(|side| side as f32);
            for draw in &mut pass.draws {
                let [x, y, width, height] = &mut draw.viewport.rect;
                *x = (*x + *width / 2.0).clamp(0.0, size[0]) - *width / 2.0;
                *y = (*y + *height / 2.0).clamp(0.0, size[1]) - *height / 2.0;
            }
        });
}

/// State that a draw of which nothing is left leaves to the next.
fn discarded(list: &mut List) {
    list.source("Adreno: state of a draw with rasterizer discard");
    let is_discarded = |draw: &Draw| draw.rasterizer_discard || draw.cull == CullMode::FrontAndBack;
    let changed = [
        "viewport-rect",
        "viewport-depth",
        "scissor",
        "blend",
        "write-mask",
        "stencil-test",
    ];
    let struck = |field: &Field| field.in_sequences && changed.contains(&field.name.as_str());
    for field in fields().into_iter().filter(struck) {
        let (name, words, take) = (&field.name, field.words(), field.take.clone());
        list.bug(format!(
            "discarded-leaves-{name}: After a draw that is discarded whole, the {words} is its own."
        ))
        .area("sequence")
        .plant(from_draw(move |before, draw| {
            if is_discarded(before) && !is_discarded(draw) {
                take(before, draw);
            }
        }));
    }
}
