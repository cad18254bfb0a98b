//! Bugs of dynamic state: a draw uses the pipeline's static value, or the value set for another draw.

use crate::fields::{BLEND, WRITE_MASK};
use crate::list::bugs;
use crate::plant::{Plant, draws, each, passes, set};
use etalon_scene::{ColorTarget, LogicOperation};

/// Changes the targets of each draw after the first in a pass, given the first draw's targets.
fn of_first(bug: fn(&mut ColorTarget, &ColorTarget)) -> Plant {
    passes(move |scene, number, pass| {
        for draw in pass.draws.iter_mut().skip(1) {
            let first = &scene.passes[number].draws[0].targets;
            draw.targets
                .iter_mut()
                .zip(first)
                .for_each(|(to, from)| bug(to, from));
        }
    })
}

bugs! {
    class "held", "paths";
    source "lavapipe, radv: dynamic state of EDS3 taken from the pipeline";
    "logic-of-the-pipeline: A dynamic logic operation is that of the pipeline." =>
        draws(|draw| draw.logic = draw.logic.map(|_| LogicOperation::Equivalent));
    "logic-enable-of-the-pipeline: Logic operations are on where the pipeline's are." =>
        draws(|draw| draw.logic = draw.logic.or(Some(LogicOperation::Equivalent))),
        when |draw| draw.targets.iter().all(|t| t.blend.is_none());
    "blend-of-the-pipeline: Blending is on where the pipeline has it on." => set(BLEND, None);
    "write-mask-of-the-pipeline: The write mask is that of the pipeline." => each(WRITE_MASK, |mask| *mask ^= 0b1111);
    "logic-of-the-first-draw: Draws of a pipeline share its first logic operation." =>
        passes(|scene, number, pass| {
            for draw in pass.draws.iter_mut().skip(1) {
                draw.logic = draw.logic.and(scene.passes[number].draws[0].logic);
            }
        });
    "equation-of-the-first-draw: Draws of a pipeline share its first blend equation." =>
        of_first(|t, first| t.blend = t.blend.and(first.blend));
    "blend-enable-of-the-first-draw: Draws of a pipeline blend if its first one does." =>
        of_first(|t, first| t.blend = first.blend.and(t.blend.or(first.blend)));
    "alpha-equation-of-colour: A dynamic equation of alpha is that of colour." =>
        of_first(|t, _| t.blend.iter_mut().for_each(|b| b.alpha = b.color));
    "write-mask-of-the-first-draw: Draws of a pipeline share its first write mask." =>
        of_first(|t, first| t.write_mask = first.write_mask);
}
