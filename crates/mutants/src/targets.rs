//! Bugs of several attachments in one pass.

use crate::blend::OVER;
use crate::list::{CONFUSION, bugs};
use crate::plant::{Plant, draws, scene};
use etalon_scene::{BlendFactor, ColorTarget};

/// Changes the targets of draws with several attachments.
fn targets(bug: fn(&mut [ColorTarget])) -> Plant {
    draws(move |draw| {
        if draw.targets.len() > 1 {
            bug(&mut draw.targets);
        }
    })
}

/// Replaces a factor by its equivalent for a destination alpha of 1.
fn with_alpha_one(factor: &mut BlendFactor) {
    *factor = match *factor {
        BlendFactor::DstAlpha => BlendFactor::One,
        BlendFactor::OneMinusDstAlpha | BlendFactor::SrcAlphaSaturated => BlendFactor::Zero,
        other => other,
    };
}

bugs! {
    class "targets", "blend";
    source "lavapipe, v3d: one attachment's state for another";
    "all-from-the-first: All take the first's state." => targets(|t| t.fill(t[0]));
    "all-from-the-last: All take the last's state." => targets(|t| t.fill(t[t.len() - 1]));
    "second-from-the-first: The second takes the first's state." => targets(|t| t[1] = t[0]);
    "last-from-the-one-before: The last takes the state of the one before." =>
        targets(|t| t[t.len() - 1] = t[t.len() - 2]);
    "rotated: Each takes the state of the next." => targets(|t| t.rotate_left(1));
    "reversed: The first takes the last's state, and so on." => targets(<[_]>::reverse);
    "blend-from-the-first: All are blended as the first." =>
        targets(|t| { let blend = t[0].blend; t.iter_mut().for_each(|t| t.blend = blend); });
    "write-mask-from-the-first: All have the first's write mask." =>
        targets(|t| { let mask = t[0].write_mask; t.iter_mut().for_each(|t| t.write_mask = mask); });
    "write-masks-joined: A channel written to one attachment is written to all." =>
        targets(|t| {
            let mask = t.iter().fold(0, |mask, t| mask | t.write_mask);
            t.iter_mut().for_each(|t| t.write_mask = mask);
        });
    "fifth-lost: Nothing is drawn to the fifth attachment and those after it." =>
        targets(|t| t.iter_mut().skip(4).for_each(|t| t.write_mask = 0));
    "eighth-lost: Nothing is drawn to the eighth attachment." =>
        targets(|t| t.iter_mut().skip(7).for_each(|t| t.write_mask = 0));
    "fifth-from-the-first: The fifth and those after it take the states of the first four." =>
        targets(|t| (4..t.len()).for_each(|i| t[i] = t[i - 4]));
    "write-masks-of-four: The write masks of four attachments are kept; the others repeat them." =>
        targets(|t| (4..t.len()).for_each(|i| t[i].write_mask = t[i - 4].write_mask));
    "alpha-equation-from-the-first: All have the first's equation for alpha." =>
        targets(|t| {
            if let Some(first) = t[0].blend {
                let others = t.iter_mut().filter_map(|t| t.blend.as_mut());
                others.for_each(|b| b.alpha = first.alpha);
            }
        });
    "on-where-the-first-is-off: Blending is on or off for all as for the first." =>
        targets(|t| {
            let on = t.iter().find_map(|t| t.blend);
            let first = t[0].blend.is_some();
            for target in t { target.blend = if first { target.blend.or(on) } else { None }; }
        });
    "operations-from-the-first: All have the first's operations." =>
        targets(|t| {
            if let Some(first) = t[0].blend {
                for blend in t.iter_mut().filter_map(|t| t.blend.as_mut()) {
                    blend.color.operation = first.color.operation;
                    blend.alpha.operation = first.alpha.operation;
                }
            }
        });
    "first-alone-is-written: Only the first is written." =>
        targets(|t| t[1..].iter_mut().for_each(|t| t.write_mask = 0));
    source CONFUSION;
    "enables-inverted: Where some attachments are blended and others are not, the two are exchanged." =>
        draws(|draw| {
            let on = draw.targets.iter().filter(|t| t.blend.is_some()).count();
            if on > 0 && on < draw.targets.len() {
                for target in &mut draw.targets { target.blend = target.blend.is_none().then_some(OVER); }
            }
        }), source "wgpu: per-target enable arguments flipped";

    // Formats without alpha together with formats that have it.
    "alpha-missing-on-one-is-missing-on-all: Where one attachment has no alpha, all count as without." =>
        scene(|scene| {
            for pass in &mut scene.passes {
                let channels = |i: &usize| scene.attachments[*i].format.color_channels().len();
                if !pass.color.iter().any(|i| channels(i) < 4) { continue; }
                let targets = pass.draws.iter_mut().flat_map(|d| &mut d.targets);
                for blend in targets.filter_map(|t| t.blend.as_mut()) {
                    for component in [&mut blend.color, &mut blend.alpha] {
                        with_alpha_one(&mut component.src_factor);
                        with_alpha_one(&mut component.dst_factor);
                    }
                }
            }
        }), source "v3d: mixed-alpha targets changing the wrong one";
}
