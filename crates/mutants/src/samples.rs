//! Bugs of several samples per texel.

use crate::hooks::{
    alpha_covers, depth_sample, sample_positions, second_source, shader_runs, stored_sample,
};
use crate::list::{CONFUSION, List};
use crate::plant::{Plant, passes};
use etalon_frame::{Aspect, standard_sample_positions};
use etalon_scene::Multisample;

pub(super) fn add(list: &mut List) {
    list.class("samples", "multisample");
    masks(list);
    positions(list);
    alpha(list);
    per_sample(list);
}

/// Changes the multisample state of draws to several samples, given their number.
fn states(bug: impl Fn(&mut Multisample, u32) + Send + Sync + 'static) -> Plant {
    passes(move |scene, number, pass| {
        let samples = scene.pass_samples(&scene.passes[number]);
        if samples > 1 {
            let states = pass.draws.iter_mut().map(|d| &mut d.multisample);
            states.for_each(|state| bug(state, samples));
        }
    })
}

fn masks(list: &mut List) {
    fn masks(bug: impl Fn(u32, u32) -> u32 + Send + Sync + 'static) -> Plant {
        states(move |state, samples| state.mask = bug(state.mask, samples))
    }
    list.source("wgpu, llvmpipe: sample mask hard-coded or ignored");
    list.bug("mask-ignored: All samples are drawn.")
        .plant(masks(|_, _| u32::MAX));
    list.bug("mask-zero-as-all: A mask of 0 draws all samples.")
        .plant(masks(|mask, _| if mask == 0 { u32::MAX } else { mask }));
    list.bug("mask-first-bit-for-all: The mask's first bit applies to all samples.")
        .plant(masks(|mask, _| if mask & 1 == 0 { 0 } else { u32::MAX }));
    list.bug("mask-any-bit-for-all: Any bit of the mask enables all samples.")
        .plant(masks(|mask, n| match mask & (u32::MAX >> (32 - n)) {
            0 => 0,
            _ => u32::MAX,
        }));
    list.bug("mask-first-bit-alone: Bits of the mask beyond the first are lost.")
        .plant(masks(|mask, _| mask & 1));
    for (bits, last) in [(2, "second"), (4, "fourth"), (8, "eighth")] {
        list.bug(format!(
            "mask-in-{bits}-bits: The mask's bits beyond the {last} are lost."
        ))
        .plant(masks(move |mask, _| mask & ((1 << bits) - 1)));
    }
    list.bug("mask-one-up: The mask's bits move to the next sample.")
        .plant(masks(|mask, _| mask << 1));
    list.bug("mask-one-down: The mask's bits move to the sample before.")
        .plant(masks(|mask, _| mask >> 1));
    list.bug("mask-inverted: The mask's bits mean their opposite.")
        .plant(masks(|mask, _| !mask));
    list.bug("mask-reversed: The mask's first bit means the last sample.")
        .plant(masks(|mask, n| mask.reverse_bits() >> (32 - n)));
    list.bug("first-missing: The first sample is never drawn.")
        .plant(masks(|mask, _| mask & !1));
    list.bug("second-missing: The second sample is never drawn.")
        .plant(masks(|mask, _| mask & !2));
    list.bug("last-missing: The last sample is never drawn.")
        .plant(masks(|mask, n| mask & !(1 << (n - 1))));
    list.source(CONFUSION);
}

fn positions(list: &mut List) {
    type Bug = fn(Vec<[u16; 2]>) -> Vec<[u16; 2]>;
    fn plant(bug: Bug) -> Plant {
        sample_positions(move |positions| {
            if positions.len() > 1 {
                bug(positions)
            } else {
                positions
            }
        })
    }
    fn each(positions: Vec<[u16; 2]>, bug: fn([u16; 2]) -> [u16; 2]) -> Vec<[u16; 2]> {
        positions.into_iter().map(bug).collect()
    }
    list.source("sample positions rotated");
    list.bug("all-at-the-centre: All samples lie at the centre.")
        .plant(plant(|positions| each(positions, |_| [128, 128])));
    list.bug("all-at-the-corner: All samples lie at the corner.")
        .plant(plant(|positions| each(positions, |_| [0, 0])));
    list.bug("rotated: The positions are turned by a quarter.")
        .plant(plant(|positions| each(positions, |[x, y]| [256 - y, x])));
    list.bug("mirrored: The positions are mirrored.")
        .plant(plant(|positions| each(positions, |[x, y]| [256 - x, y])));
    list.bug("upside-down: The positions are upside down.")
        .plant(plant(|positions| each(positions, |[x, y]| [x, 256 - y])));
    list.bug("transposed: Columns and rows of the positions are exchanged.")
        .plant(plant(|positions| each(positions, |[x, y]| [y, x])));
    list.bug("in-reverse-order: The last sample lies where the first should.")
        .plant(plant(|mut positions| {
            positions.reverse();
            positions
        }));
    list.bug("first-two-exchanged: The first two samples exchange their places.")
        .plant(plant(|mut positions| {
            positions.swap(0, 1);
            positions
        }));
    list.bug("one-sixteenth-right: All samples lie a sixteenth too far right.")
        .plant(plant(|positions| each(positions, |[x, y]| [x + 16, y])));
    list.bug("of-two-samples: Every pair of samples lies where two would.")
        .plant(plant(|positions| {
            let two = standard_sample_positions(2);
            (0..positions.len()).map(|s| two[s % 2]).collect()
        }));
    list.source(CONFUSION);
}

fn alpha(list: &mut List) {
    fn share(alpha: f32, samples: usize) -> usize {
        (alpha.clamp(0.0, 1.0) * samples as f32).round() as usize
    }
    list.source("dEQP sees alpha to coverage ignored in 2 of 32 cases");
    list.bug("alpha-to-coverage-ignored: Alpha removes no samples.")
        .plant(alpha_covers(|_, _, _| true));
    list.bug("alpha-to-coverage-inverted: Alpha 1 covers nothing.")
        .plant(alpha_covers(|a, s, n| s < share(1.0 - a, n)));
    list.bug("alpha-to-coverage-one-less: Alpha covers one sample too few.")
        .plant(alpha_covers(|a, s, n| s + 1 < share(a, n)));
    list.bug("alpha-to-coverage-one-more: Alpha covers one sample too many.")
        .plant(alpha_covers(|a, s, n| s < share(a, n) + 1));
    list.bug("alpha-to-coverage-never: Alpha to coverage draws nothing.")
        .plant(alpha_covers(|_, _, _| false));
    list.source(CONFUSION);
    const OPEN: &str = "Vulkan: Multisample Coverage: between 0 and 1 the algorithm is \
                        implementation-dependent; only fewer samples for less alpha is intended";
    list.bug("alpha-to-coverage-for-zero-alone: Only alpha 0 removes samples.")
        .source("an alpha test for alpha to coverage")
        .legal(OPEN)
        .plant(alpha_covers(|a, _, _| a > 0.0));
    list.bug("alpha-to-coverage-from-the-last: Alpha covers the last samples and not the first.")
        .legal(OPEN)
        .plant(alpha_covers(|a, s, n| n - 1 - s < share(a, n)));
    list.source("ANGLE, turnip: alpha to coverage");
    list.bug("alpha-to-coverage-always: Alpha removes samples although alpha to coverage is off.")
        .plant(states(|d, _| d.alpha_to_coverage = true));
    list.bug("alpha-to-coverage-without-mask: Alpha to coverage replaces the mask.")
        .plant(states(|d, _| {
            if d.alpha_to_coverage {
                d.mask = u32::MAX;
            }
        }));
    list.bug("alpha-to-one-ignored: Alpha does not become 1.")
        .plant(states(|d, _| d.alpha_to_one = false));
    list.bug("alpha-to-one-always: Alpha becomes 1 although alpha to one is off.")
        .plant(states(|d, _| d.alpha_to_one = true));
    list.bug("alpha-to-one-before-coverage: Alpha is 1 before it covers.")
        .plant(states(|d, _| d.alpha_to_coverage &= !d.alpha_to_one));
    list.source(CONFUSION);
    list.bug("alpha-to-one-for-all-channels: All channels of the second source become 1.")
        .plant(second_source(|state, second| {
            if state.alpha_to_one { [1.0; 4] } else { second }
        }));
}

fn per_sample(list: &mut List) {
    list.bug("shaded-once: A shader that asks for the sample runs once per texel.")
        .source("per-sample shading run once")
        .plant(shader_runs(|_, state, n| {
            state.least_runs(n as u32) as usize
        }));
    for (aspect, name) in [
        (Aspect::Color, "blend"),
        (Aspect::Depth, "depth-test"),
        (Aspect::Stencil, "stencil-test"),
    ] {
        list.bug(format!(
            "{name}-sees-the-first: The {name} of every sample reads the first one's value."
        ))
        .source("one stored value for all samples")
        .plant(stored_sample(move |a, s| if a == aspect { 0 } else { s }));
    }
    type Place = fn(usize, usize) -> usize;
    let places: [(&str, Place); 3] = [
        ("first", |_, _| 0),
        ("last", |_, n| n - 1),
        ("next", |s, n| (s + 1) % n),
    ];
    for (name, place) in places {
        list.bug(format!(
            "depth-of-the-{name}: Every sample takes the depth at the {name} one's place."
        ))
        .source("llvmpipe: one sample's depth for all")
        .plant(depth_sample(place));
    }
}
