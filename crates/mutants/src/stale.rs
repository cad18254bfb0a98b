//! Stale fields: of the case before, of the draw before, and the default where a pass begins.

use crate::fields::fields;
use crate::list::List;
use crate::plant::{from_case, from_draw};
use etalon_scene::{ColorTarget, Draw, Viewport};

/// Adds the class `sticky`: each field as the case or the draw before had it.
pub(super) fn sticky(list: &mut List) {
    for kind in ["case", "draw"] {
        for field in fields() {
            let Some(area) = field.area else { continue };
            let (name, words) = (&field.name, field.words());
            let text = if field.when_off {
                format!(
                    "{name}-when-off-from-the-{kind}-before: A draw whose {words} is off takes that of \
                     the {kind} before."
                )
            } else {
                format!(
                    "{name}-from-the-{kind}-before: A draw takes the {words} of the {kind} before."
                )
            };
            let take = move |before: &Draw, draw: &mut Draw| (field.take)(before, draw);
            list.class("sticky", area);
            list.source("lavapipe, ANGLE: stale state");
            list.bug(text).plant(match kind {
                "case" => from_case(take),
                _ => from_draw(take),
            });
        }
    }
}

/// Fields that do not act by default: what they belong to is off.
const PARAMETERS: [&str; 5] = [
    "depth-compare",
    "depth-write",
    "stencil-operations",
    "stencil-reference",
    "stencil-write-mask",
];

/// Adds the fields that a change of the pass resets.
pub(super) fn reset(list: &mut List) {
    for field in fields() {
        let acts = !PARAMETERS.contains(&&*field.name);
        if field.area.is_none() || field.when_off || !acts {
            continue;
        }
        let (name, words) = (&field.name, field.words());
        list.bug(format!(
            "{name}-reset-in-the-next-pass: The first draw of every pass but the first has the default \
             {words}."
        ))
        .passes(move |asked, number, pass| {
            let size = asked.pass_size(&asked.passes[number]);
            if let Some(first) = pass.draws.first_mut().filter(|_| number > 0) {
                let mut plain = Draw::new(first.shader, first.mesh.clone(), Viewport::whole(size));
                plain.targets = vec![ColorTarget::default(); first.targets.len()];
                (field.take)(&plain, first);
            }
        });
    }
}

/// Adds the fields that one draw leaves to the next, each by itself: a driver that tracks changes
/// forgets one of them.
pub(super) fn stays(list: &mut List) {
    for field in fields().into_iter().filter(|field| field.in_sequences) {
        let (name, words) = (field.name.clone(), field.words());
        let (here, there) = (field.take.clone(), field.take);
        list.bug(format!(
            "{name}-stays-in-a-pass: Within a pass, a draw takes the {words} of the draw before."
        ))
        .passes(move |asked, number, pass| {
            let before = &asked.passes[number].draws;
            for (before, draw) in before.iter().zip(pass.draws.iter_mut().skip(1)) {
                here(before, draw);
            }
        });
        list.bug(format!(
            "{name}-stays-over-passes: The first draw of a pass takes the {words} of the last draw \
             before it."
        ))
        .passes(move |asked, number, pass| {
            let before = asked.passes[..number].iter().flat_map(|p| &p.draws);
            if let (Some(before), Some(draw)) = (before.last(), pass.draws.first_mut()) {
                there(before, draw);
            }
        });
    }
}
