//! Bugs of several samples per texel.

use super::hooks::{
    alpha_covers, depth_sample, sample_positions, second_source, shader_runs, stored_sample,
};
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, scene};
use etalon_frame::{Aspect, standard_sample_positions};
use etalon_scene::Draw;

pub(super) fn add(list: &mut List) {
    list.class("samples", "multisample");
    masks(list);
    positions(list);
    alpha(list);
    per_sample(list);
}

/// Changes draws to attachments of several samples, given their number.
fn draws(bug: fn(&mut Draw, u32)) -> Plant {
    scene(move |scene| {
        for at in 0..scene.passes.len() {
            let samples = scene.pass_samples(&scene.passes[at]);
            if samples > 1 {
                let draws = scene.passes[at].draws.iter_mut();
                draws.for_each(|d| bug(d, samples));
            }
        }
    })
}

fn masks(list: &mut List) {
    type Bug = fn(u32, u32) -> u32;
    fn masks(bug: Bug) -> Plant {
        scene(move |scene| {
            for at in 0..scene.passes.len() {
                let samples = scene.pass_samples(&scene.passes[at]);
                for draw in &mut scene.passes[at].draws {
                    if samples > 1 {
                        draw.multisample.mask = bug(draw.multisample.mask, samples);
                    }
                }
            }
        })
    }
    let rows: [Row<Bug>; 15] = [
        ("mask-ignored", "All samples are drawn.", |_, _| u32::MAX),
        (
            "mask-zero-as-all",
            "A mask of 0 draws all samples.",
            |mask, _| {
                if mask == 0 { u32::MAX } else { mask }
            },
        ),
        (
            "mask-first-bit-for-all",
            "The mask's first bit applies to all samples.",
            |mask, _| {
                if mask & 1 == 0 { 0 } else { u32::MAX }
            },
        ),
        (
            "mask-any-bit-for-all",
            "Any bit of the mask enables all samples.",
            |mask, n| {
                if mask & (u32::MAX >> (32 - n)) == 0 {
                    0
                } else {
                    u32::MAX
                }
            },
        ),
        (
            "mask-first-bit-alone",
            "Bits of the mask beyond the first are lost.",
            |mask, _| mask & 1,
        ),
        (
            "mask-in-2-bits",
            "Bits of the mask beyond the second are lost.",
            |mask, _| mask & 3,
        ),
        (
            "mask-in-4-bits",
            "Bits of the mask beyond the fourth are lost.",
            |mask, _| mask & 0xf,
        ),
        (
            "mask-in-8-bits",
            "Bits of the mask beyond the eighth are lost.",
            |mask, _| mask & 0xff,
        ),
        (
            "mask-one-up",
            "The mask's bits move to the next sample.",
            |mask, _| mask << 1,
        ),
        (
            "mask-one-down",
            "The mask's bits move to the sample before.",
            |mask, _| mask >> 1,
        ),
        (
            "mask-inverted",
            "The mask's bits mean their opposite.",
            |mask, _| !mask,
        ),
        (
            "mask-reversed",
            "The mask's first bit means the last sample.",
            |mask, n| mask.reverse_bits() >> (32 - n),
        ),
        (
            "first-missing",
            "The first sample is never drawn.",
            |mask, _| mask & !1,
        ),
        (
            "second-missing",
            "The second sample is never drawn.",
            |mask, _| mask & !2,
        ),
        (
            "last-missing",
            "The last sample is never drawn.",
            |mask, n| mask & !(1 << (n - 1)),
        ),
    ];
    list.rows(
        "wgpu, llvmpipe: sample mask hard-coded or ignored",
        masks,
        &rows,
    );
}

fn positions(list: &mut List) {
    type Bug = fn(Vec<[u16; 2]>) -> Vec<[u16; 2]>;
    fn plant(bug: Bug) -> Plant {
        sample_positions(move |all| if all.len() > 1 { bug(all) } else { all })
    }
    fn each(all: Vec<[u16; 2]>, bug: fn([u16; 2]) -> [u16; 2]) -> Vec<[u16; 2]> {
        all.into_iter().map(bug).collect()
    }
    let rows: [Row<Bug>; 10] = [
        (
            "all-at-the-centre",
            "All samples lie at the centre.",
            |all| each(all, |_| [128, 128]),
        ),
        (
            "all-at-the-corner",
            "All samples lie at the corner.",
            |all| each(all, |_| [0, 0]),
        ),
        ("rotated", "The positions are turned by a quarter.", |all| {
            each(all, |[x, y]| [256 - y, x])
        }),
        ("mirrored", "The positions are mirrored.", |all| {
            each(all, |[x, y]| [256 - x, y])
        }),
        ("upside-down", "The positions are upside down.", |all| {
            each(all, |[x, y]| [x, 256 - y])
        }),
        (
            "transposed",
            "Columns and rows of the positions are exchanged.",
            |all| each(all, |[x, y]| [y, x]),
        ),
        (
            "in-reverse-order",
            "The last sample lies where the first should.",
            |mut all| {
                all.reverse();
                all
            },
        ),
        (
            "first-two-exchanged",
            "The first two samples exchange their places.",
            |mut all| {
                all.swap(0, 1);
                all
            },
        ),
        (
            "one-sixteenth-right",
            "All samples lie a sixteenth too far right.",
            |all| each(all, |[x, y]| [x + 16, y]),
        ),
        (
            "of-two-samples",
            "Every pair of samples lies where two would.",
            |all| {
                let two = standard_sample_positions(2);
                (0..all.len()).map(|s| two[s % 2]).collect()
            },
        ),
    ];
    list.rows("sample positions rotated", plant, &rows);
}

fn alpha(list: &mut List) {
    type Bug = fn(f32, usize, usize) -> bool;
    fn share(alpha: f32, samples: usize) -> usize {
        (alpha.clamp(0.0, 1.0) * samples as f32).round() as usize
    }
    let rows: [Row<Bug>; 6] = [
        (
            "alpha-to-coverage-ignored",
            "Alpha removes no samples.",
            |_, _, _| true,
        ),
        (
            "alpha-to-coverage-inverted",
            "Alpha 1 covers nothing.",
            |a, s, n| s < share(1.0 - a, n),
        ),
        (
            "alpha-to-coverage-one-less",
            "Alpha covers one sample too few.",
            |a, s, n| s + 1 < share(a, n),
        ),
        (
            "alpha-to-coverage-one-more",
            "Alpha covers one sample too many.",
            |a, s, n| s < share(a, n) + 1,
        ),
        (
            "alpha-to-coverage-never",
            "Alpha to coverage draws nothing.",
            |_, _, _| false,
        ),
        (
            "alpha-to-coverage-for-zero-alone",
            "Only alpha 0 removes samples.",
            |a, _, _| a > 0.0,
        ),
    ];
    let source = "dEQP sees alpha to coverage ignored in 2 of 32 cases";
    list.rows(source, alpha_covers, &rows[..5]);
    const OPEN: &str = "Vulkan: Multisample Coverage: between 0 and 1 the algorithm is \
                        implementation-dependent; only fewer samples for less alpha is intended";
    let (name, about, bug) = rows[5];
    list.add(
        name,
        "an alpha test for alpha to coverage",
        about,
        alpha_covers(bug),
    )
    .legal(OPEN);
    list.add(
        "alpha-to-coverage-from-the-last",
        CONFUSION,
        "Alpha covers the last samples and not the first.",
        alpha_covers(|a, s, n| n - 1 - s < share(a, n)),
    )
    .legal(OPEN);
    type DrawBug = fn(&mut Draw, u32);
    let states: [Row<DrawBug>; 5] = [
        (
            "alpha-to-coverage-always",
            "Alpha removes samples although alpha to coverage is off.",
            |d, _| {
                d.multisample.alpha_to_coverage = true;
            },
        ),
        (
            "alpha-to-coverage-without-mask",
            "Alpha to coverage replaces the mask.",
            |d, _| {
                if d.multisample.alpha_to_coverage {
                    d.multisample.mask = u32::MAX;
                }
            },
        ),
        (
            "alpha-to-one-ignored",
            "Alpha does not become 1.",
            |d, _| {
                d.multisample.alpha_to_one = false;
            },
        ),
        (
            "alpha-to-one-always",
            "Alpha becomes 1 although alpha to one is off.",
            |d, _| {
                d.multisample.alpha_to_one = true;
            },
        ),
        (
            "alpha-to-one-before-coverage",
            "Alpha is 1 before it covers.",
            |d, _| {
                d.multisample.alpha_to_coverage &= !d.multisample.alpha_to_one;
            },
        ),
    ];
    list.rows("ANGLE, turnip: alpha to coverage", draws, &states);
    list.add(
        "alpha-to-one-without-second-source",
        "i965: alpha-to-one missing the second source",
        "The second source keeps its alpha.",
        second_source(|_, second| second),
    );
    list.add(
        "alpha-to-one-for-all-channels",
        CONFUSION,
        "All channels of the second source become 1.",
        second_source(
            |state, second| {
                if state.alpha_to_one { [1.0; 4] } else { second }
            },
        ),
    );
}

fn per_sample(list: &mut List) {
    list.add(
        "shaded-once",
        "per-sample shading run once",
        "A shader that asks for the sample runs once per texel.",
        shader_runs(|_, state, n| state.least_runs(n as u32) as usize),
    );
    for (aspect, name) in [
        (Aspect::Color, "blend"),
        (Aspect::Depth, "depth-test"),
        (Aspect::Stencil, "stencil-test"),
    ] {
        list.add(
            &format!("{name}-sees-the-first"),
            "one stored value for all samples",
            format!("The {name} of every sample reads the first one's value."),
            stored_sample(move |a, s| if a == aspect { 0 } else { s }),
        );
    }
    for (name, about, bug) in [
        (
            "depth-of-the-first",
            "Every sample takes the depth at the first's position.",
            (|_, _| 0) as fn(usize, usize) -> usize,
        ),
        (
            "depth-of-the-last",
            "Every sample takes the depth at the last's position.",
            |_, n| n - 1,
        ),
        (
            "depth-of-the-next",
            "Every sample takes the depth at the next one's position.",
            |s, n| (s + 1) % n,
        ),
    ] {
        list.add(
            name,
            "llvmpipe: one sample's depth for all",
            about,
            depth_sample(bug),
        );
    }
}
