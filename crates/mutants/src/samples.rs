//! Bugs of several samples per texel.

use crate::hooks::{
    alpha_covers, coverage_positions, depth_sample, sample_positions, second_source, shader_runs,
    stored_sample,
};
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{Plant, passes};
use etalon_frame::{Aspect, standard_sample_positions};
use etalon_reference::rules::AlphaToCoverage;
use etalon_scene::Multisample;

/// Changes the multisample state of draws with several samples, given their number.
fn states(bug: impl Fn(&mut Multisample, u32) + Send + Sync + 'static) -> Plant {
    passes(move |scene, number, pass| {
        let samples = scene.pass_samples(&scene.passes[number]);
        if samples > 1 {
            let states = pass.draws.iter_mut().map(|d| &mut d.multisample);
            states.for_each(|state| bug(state, samples));
        }
    })
}

fn masks(bug: impl Fn(u32, u32) -> u32 + Send + Sync + 'static) -> Plant {
    states(move |state, samples| state.mask = bug(state.mask, samples))
}

/// Changes the positions of samples if there are several.
fn placed(bug: impl Fn(&mut Vec<[u16; 2]>) + Send + Sync + 'static) -> Plant {
    sample_positions(move |mut positions: Vec<[u16; 2]>| {
        if positions.len() > 1 {
            bug(&mut positions);
        }
        positions
    })
}

/// Changes the position of each sample if there are several.
fn each_placed(bug: fn([u16; 2]) -> [u16; 2]) -> Plant {
    placed(move |positions| positions.iter_mut().for_each(|place| *place = bug(*place)))
}

fn share(alpha: f32, samples: usize) -> usize {
    (alpha.clamp(0.0, 1.0) * samples as f32).round() as usize
}

bugs! {
    class "samples", "multisample";
    source "wgpu, llvmpipe: sample mask hard-coded or ignored";
    "mask-ignored: All samples are drawn." => masks(|_, _| u32::MAX);
    "mask-zero-as-all: A mask of 0 draws all samples." => masks(|mask, _| if mask == 0 { u32::MAX } else { mask });
    "mask-first-bit-for-all: The mask's first bit applies to all samples." =>
        masks(|mask, _| if mask & 1 == 0 { 0 } else { u32::MAX });
    "mask-any-bit-for-all: Any bit of the mask enables all samples." =>
        masks(|mask, n| match mask & (u32::MAX >> (32 - n)) { 0 => 0, _ => u32::MAX, });
    "mask-first-bit-alone: Bits of the mask beyond the first are lost." => masks(|mask, _| mask & 1);
    for (bits, last) in [(2, "second"), (4, "fourth"), (8, "eighth")] {
        "mask-in-{bits}-bits: The mask's bits beyond the {last} are lost." =>
            masks(move |mask, _| mask & ((1 << bits) - 1));
    }
    "mask-one-up: The mask's bits move to the next sample." => masks(|mask, _| mask << 1);
    "mask-one-down: The mask's bits move to the sample before." => masks(|mask, _| mask >> 1);
    "mask-inverted: The mask's bits mean their opposite." => masks(|mask, _| !mask);
    "mask-reversed: The mask's first bit means the last sample." => masks(|mask, n| mask.reverse_bits() >> (32 - n));
    "first-missing: The first sample is never drawn." => masks(|mask, _| mask & !1);
    "second-missing: The second sample is never drawn." => masks(|mask, _| mask & !2);
    "last-missing: The last sample is never drawn." => masks(|mask, n| mask & !(1 << (n - 1)));
    source "sample positions rotated";
    "all-at-the-centre: All samples lie at the centre." => each_placed(|_| [128, 128]);
    "all-at-the-corner: All samples lie at the corner." => each_placed(|_| [0, 0]);
    "rotated: The positions are turned by a quarter." => each_placed(|[x, y]| [256 - y, x]);
    "mirrored: The positions are mirrored." => each_placed(|[x, y]| [256 - x, y]);
    "upside-down: The positions are upside down." => each_placed(|[x, y]| [x, 256 - y]);
    "transposed: Columns and rows of the positions are exchanged." =>
        each_placed(|[x, y]| [y, x]);
    "nearer-the-centre: The positions are halfway to the centre." =>
        each_placed(|[x, y]| [x.midpoint(128), y.midpoint(128)]), source "sample patterns of vendors", permitted vec![under!(covers_at_positions: false), under!(inputs_at_samples: false)];
    "covered-elsewhere: Coverage is tested halfway to the centre." =>
        coverage_positions(|mut positions: Vec<[u16; 2]>| {
            let several = positions.len() > 1;
            for place in positions.iter_mut().filter(|_| several) { *place = place.map(|v| v.midpoint(128)); }
            positions
        }), source "sample patterns of vendors",
        permitted vec![under!(covers_at_positions: false)];
    "in-reverse-order: The last sample lies where the first should." => placed(|positions| positions.reverse());
    "first-two-exchanged: The first two samples exchange their places." => placed(|positions| positions.swap(0, 1));
    "one-sixteenth-right: All samples lie a sixteenth too far right." =>
        each_placed(|[x, y]| [x + 16, y]);
    "of-two-samples: Every pair of samples lies where two would." =>
        placed(|positions| {
            let two = standard_sample_positions(2).into_iter().cycle();
            positions.iter_mut().zip(two).for_each(|(place, of_two)| *place = of_two);
        });
    source "dEQP sees alpha to coverage ignored in 2 of 32 cases";
    "alpha-to-coverage-ignored: Alpha removes no samples." => alpha_covers(|_, _, _| true),
        permitted vec![under!(alpha_to_coverage: AlphaToCoverage::Any), under!(colorless_alpha_to_coverage: AlphaToCoverage::Opaque | AlphaToCoverage::Any)];
    "alpha-to-coverage-inverted: Alpha 1 covers nothing." => alpha_covers(|a, s, n| s < share(1.0 - a, n)),
        permitted vec![under!(alpha_to_coverage: AlphaToCoverage::Any), under!(colorless_alpha_to_coverage: AlphaToCoverage::Any), under!(covers_one_sample: true)];
    "alpha-to-coverage-one-less: Alpha covers one sample too few." => alpha_covers(|a, s, n| s + 1 < share(a, n));
    "alpha-to-coverage-one-more: Alpha covers one sample too many." => alpha_covers(|a, s, n| s < share(a, n) + 1);
    "alpha-to-coverage-never: Alpha to coverage draws nothing." => alpha_covers(|_, _, _| false),
        permitted vec![under!(alpha_to_coverage: AlphaToCoverage::Any), under!(colorless_alpha_to_coverage: AlphaToCoverage::Any), under!(covers_one_sample: true)];
    source CONFUSION;
    "alpha-to-coverage-for-zero-alone: Only alpha 0 removes samples." =>
        alpha_covers(|a, _, _| a > 0.0), source "an alpha test for alpha to coverage", permitted vec![under!(alpha_to_coverage: _)];
    "alpha-to-coverage-from-the-last: Alpha covers the last samples and not the first." =>
        alpha_covers(|a, s, n| n - 1 - s < share(a, n)), permitted vec![under!(alpha_to_coverage: _)];
    source "ANGLE, turnip: alpha to coverage";
    "alpha-to-coverage-always: Alpha removes samples although alpha to coverage is off." =>
        states(|d, _| d.alpha_to_coverage = true);
    "alpha-to-coverage-without-mask: Alpha to coverage replaces the mask." =>
        states(|d, _| if d.alpha_to_coverage { d.mask = u32::MAX });
    "alpha-to-one-ignored: Alpha does not become 1." => states(|d, _| d.alpha_to_one = false);
    "alpha-to-one-always: Alpha becomes 1 although alpha to one is off." => states(|d, _| d.alpha_to_one = true);
    "alpha-to-one-before-coverage: Alpha is 1 before it covers." =>
        states(|d, _| d.alpha_to_coverage &= !d.alpha_to_one);
    source CONFUSION;
    "alpha-to-one-for-all-channels: All channels of the second source become 1." =>
        second_source(|state, second| { if state.alpha_to_one { [1.0; 4] } else { second } });
    "shaded-once: A shader that asks for the sample runs once per texel." =>
        shader_runs(|_, state, n| state.least_runs(n as u32) as usize), source "per-sample shading run once";
    for (aspect, name) in [(Aspect::Color, "blend"), (Aspect::Depth, "depth-test"), (Aspect::Stencil, "stencil-test")] {
        "{name}-sees-the-first: The {name} of every sample reads the first one's value." =>
            stored_sample(move |a, s| if a == aspect { 0 } else { s }), source "one stored value for all samples";
    }
    for (name, place as fn(usize, usize) -> usize) in [
        ("first", |_, _| 0), ("last", |_, n| n - 1), ("next", |s, n| (s + 1) % n),
    ] {
        "depth-of-the-{name}: Every sample takes the depth at the {name} one's place." =>
            depth_sample(place), source "llvmpipe: one sample's depth for all";
    }
}
