//! Bugs of dynamic state: what a pipeline holds acts, or what was set for another draw.

use super::list::{List, Row};
use super::plant::{Plant, draws, scene};
use etalon_scene::{BlendState, ColorTarget, Draw, LogicOperation, Scene};

pub(super) fn add(list: &mut List) {
    list.class("held", "paths");
    type Bug = fn(&mut Draw);
    let rows: [Row<Bug>; 4] = [
        (
            "logic-of-the-pipeline",
            "A dynamic logic operation is that of the pipeline.",
            |draw| draw.logic = draw.logic.map(|_| LogicOperation::Equivalent),
        ),
        (
            "logic-enable-of-the-pipeline",
            "Logic operations are on where the pipeline has them on.",
            |draw| {
                let blends = draw.targets.iter().any(|t| t.blend.is_some());
                if draw.logic.is_none() && !blends {
                    draw.logic = Some(LogicOperation::Equivalent);
                }
            },
        ),
        (
            "blend-of-the-pipeline",
            "Blending is on where the pipeline has it on.",
            |draw| draw.targets.iter_mut().for_each(|t| t.blend = None),
        ),
        (
            "write-mask-of-the-pipeline",
            "The write mask is that of the pipeline.",
            |draw| draw.targets.iter_mut().for_each(|t| t.write_mask ^= 0b1111),
        ),
    ];
    const SHIPPED: &str = "lavapipe, radv: dynamic state of EDS3 taken from the pipeline";
    list.rows(SHIPPED, |bug: Bug| draws(bug), &rows);
    let rows: [Row<fn(&mut Scene)>; 5] = [
        (
            "logic-of-the-first-draw",
            "Draws that share a pipeline share its first logic operation.",
            |scene| {
                of_first(scene, |draw, first| {
                    draw.logic = draw.logic.and(first.logic)
                })
            },
        ),
        (
            "equation-of-the-first-draw",
            "Draws that share a pipeline share its first blend equation.",
            |scene| {
                of_first(scene, |draw, first| {
                    targets(draw, first, |t, f| t.blend = t.blend.and(f.blend));
                });
            },
        ),
        (
            "blend-enable-of-the-first-draw",
            "Draws that share a pipeline blend if its first draw does.",
            |scene| {
                of_first(scene, |draw, first| {
                    targets(draw, first, |t, f| {
                        t.blend = f.blend.and(t.blend.or(f.blend))
                    });
                });
            },
        ),
        (
            "alpha-equation-of-colour",
            "A dynamic equation of alpha is that of colour.",
            |scene| {
                of_first(scene, |draw, first| {
                    targets(draw, first, |t, _| {
                        t.blend = t.blend.map(|b| BlendState {
                            alpha: b.color,
                            ..b
                        });
                    });
                });
            },
        ),
        (
            "write-mask-of-the-first-draw",
            "Draws that share a pipeline share its first write mask.",
            |scene| {
                of_first(scene, |draw, first| {
                    targets(draw, first, |t, f| t.write_mask = f.write_mask);
                });
            },
        ),
    ];
    list.rows(
        SHIPPED,
        |bug: fn(&mut Scene)| -> Plant { scene(bug) },
        &rows,
    );
}

/// Changes each draw of a pass after the first, given that one.
fn of_first(scene: &mut Scene, bug: impl Fn(&mut Draw, &Draw)) {
    for pass in &mut scene.passes {
        if let Some((first, rest)) = pass.draws.split_first_mut() {
            rest.iter_mut().for_each(|draw| bug(draw, first));
        }
    }
}

/// Changes the targets of a draw, given those of another.
fn targets(draw: &mut Draw, first: &Draw, bug: impl Fn(&mut ColorTarget, &ColorTarget)) {
    for (target, of_first) in draw.targets.iter_mut().zip(&first.targets) {
        bug(target, of_first);
    }
}
