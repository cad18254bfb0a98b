//! Stale fields: values of the previous case or draw, or the default when a pass begins.

use crate::fields::{FIELDS, Take};
use crate::list::{MutantList, rows};
use crate::plant::{Plant, from_case, from_draw, passes};
use etalon_scene::{ColorTarget, Draw, Viewport};

/// Adds the class `sticky`: each field has the value of the previous case or draw.
pub(super) fn sticky(list: &mut MutantList) {
    type Before = fn(Take) -> Plant;
    let kinds: [(&str, Before); 2] = [("case", from_case), ("draw", from_draw)];
    for (kind, before) in kinds {
        for field in FIELDS.iter().filter(|field| field.in_cases()) {
            let (name, words) = (field.name, field.words());
            rows! { list;
                class "sticky", field.area;
                source "lavapipe, ANGLE: stale state";
                "{name}-from-the-{kind}-before: A draw takes the {words} of the {kind} before." => before(field.take);
            }
            if let Some(take) = field.take_when_off {
                rows! { list;
                    "{name}-when-off-from-the-{kind}-before: A draw whose {words} is off takes that of the {kind} \
                     before." =>
                        before(take);
                }
            }
        }
    }
}

/// Fields without effect by default, because what they parametrize is off.
const PARAMETERS: [&str; 5] = [
    "depth-compare",
    "depth-write",
    "stencil-operations",
    "stencil-reference",
    "stencil-write-mask",
];

/// Adds the fields that a new pass resets.
pub(super) fn reset(list: &mut MutantList) {
    let acts = |name| !PARAMETERS.contains(&name);
    for field in FIELDS.iter().filter(|f| f.in_cases() && acts(f.name)) {
        let (name, words, take) = (field.name, field.words(), field.take);
        rows! { list;
            "{name}-reset-in-the-next-pass: The first draw of every pass but the first has the default {words}." =>
                passes(move |asked, number, pass| {
                    let size = asked.pass_size(&asked.passes[number]);
                    if let Some(first) = pass.draws.first_mut().filter(|_| number > 0) {
                        let mut plain = Draw::new(first.shader, first.mesh.clone(), Viewport::whole(size));
                        plain.targets = vec![ColorTarget::default(); first.targets.len()];
                        take(&plain, first);
                    }
                });
        }
    }
}

/// Adds bugs that each keep one field of the draw before, as a driver does whose state tracking misses a
/// change.
pub(super) fn stays(list: &mut MutantList) {
    for field in FIELDS.iter().filter(|field| field.in_sequences()) {
        let (name, words, take) = (field.name, field.words(), field.take);
        rows! { list;
            "{name}-stays-in-a-pass: Within a pass, a draw takes the {words} of the draw before." =>
                passes(move |asked, number, pass| {
                    let before = asked.passes[number].draws.iter();
                    before.zip(pass.draws.iter_mut().skip(1)).for_each(|(before, draw)| take(before, draw));
                });
            "{name}-stays-over-passes: The first draw of a pass takes the {words} of the last draw before it." =>
                passes(move |asked, number, pass| {
                    let before = asked.passes[..number].iter().flat_map(|p| &p.draws);
                    if let (Some(before), Some(draw)) = (before.last(), pass.draws.first_mut()) {
                        take(before, draw);
                    }
                });
        }
    }
}
