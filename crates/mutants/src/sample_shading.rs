//! Bugs of sample shading: the share of a texel's samples that have a shader run of their own.

use super::hooks::{shaded_at, shader_runs};
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws};
use etalon_scene::Draw;

pub(super) fn add(list: &mut List) {
    list.class("sample-shading", "multisample");
    states(list);
    runs(list);
    positions(list);
}

fn states(list: &mut List) {
    let rows: [Row<fn(&mut Draw)>; 5] = [
        ("ignored", "Sample shading is never enabled.", |draw| {
            draw.multisample.min_sample_shading = None;
        }),
        ("always", "Sample shading is always enabled.", |draw| {
            draw.multisample.min_sample_shading.get_or_insert(1.0);
        }),
        (
            "whole-share-alone",
            "A share below 1 does not enable it.",
            |draw| {
                let share = &mut draw.multisample.min_sample_shading;
                *share = share.filter(|share| *share >= 1.0);
            },
        ),
        ("halved", "Half of the share counts.", |draw| {
            if let Some(share) = &mut draw.multisample.min_sample_shading {
                *share *= 0.5;
            }
        }),
        (
            "off-under-a-mask",
            "A sample mask that leaves samples out disables it.",
            |draw| {
                if draw.multisample.mask & 0xf != 0xf {
                    draw.multisample.min_sample_shading = None;
                }
            },
        ),
    ];
    let source = "llvmpipe, zink: min_samples not part of the shader's key";
    list.rows(source, |bug: fn(&mut Draw)| draws(bug), &rows);
}

fn runs(list: &mut List) {
    type Bug = fn(f32, usize) -> usize;
    fn plant(bug: Bug) -> Plant {
        shader_runs(
            move |shader, state, samples| match state.min_sample_shading {
                _ if shader.runs_per_sample() => samples,
                Some(share) => bug(share, samples),
                None => 1,
            },
        )
    }
    fn exact(share: f32, samples: usize) -> usize {
        (share * samples as f32).ceil() as usize
    }
    let rows: [Row<Bug>; 7] = [
        (
            "rounded-down",
            "The number of runs is rounded down.",
            |share, n| (share * n as f32) as usize,
        ),
        (
            "rounded-to-nearest",
            "The number of runs is rounded to the nearest.",
            |share, n| (share * n as f32).round() as usize,
        ),
        ("one-run-less", "One run is missing.", |share, n| {
            exact(share, n) - usize::from(exact(share, n) > 1)
        }),
        ("one-run", "The shader runs once all the same.", |_, _| 1),
        (
            "two-runs-at-most",
            "More than two runs are lost.",
            |share, n| exact(share, n).min(2),
        ),
        (
            "four-runs-at-most",
            "More than four runs are lost.",
            |share, n| exact(share, n).min(4),
        ),
        (
            "of-four-samples",
            "The share is always taken of four samples.",
            |share, _| exact(share, 4),
        ),
    ];
    list.rows(CONFUSION, plant, &rows);
    const MORE: &str = "Vulkan: Sample Shading; OpenGL 4.6: 14.3.1.1: at least as many";
    let more: [Row<Bug>; 2] = [
        (
            "rounded-up-to-a-power-of-two",
            "The number of runs is a power of two.",
            |share, n| exact(share, n).next_power_of_two(),
        ),
        ("all-samples", "Any share is taken for 1.", |_, n| n),
    ];
    for (name, about, bug) in more {
        list.add(name, "Intel: all samples or one", about, plant(bug))
            .legal(MORE);
    }
}

fn positions(list: &mut List) {
    type Bug = fn(usize, usize) -> Option<usize>;
    fn plant(bug: Bug) -> Plant {
        shaded_at(move |state, first, samples| {
            state.min_sample_shading.and_then(|_| bug(first, samples))
        })
    }
    let rows: [Row<Bug>; 6] = [
        ("at-the-centre", "All runs lie at the centre.", |_, _| None),
        (
            "at-the-first",
            "All runs lie at the first sample.",
            |_, _| Some(0),
        ),
        ("at-the-last", "All runs lie at the last sample.", |_, n| {
            Some(n - 1)
        }),
        (
            "at-the-next",
            "Each run lies at the next sample.",
            |s, n| Some((s + 1) % n),
        ),
        ("in-reverse", "The runs lie in reverse order.", |s, n| {
            Some(n - 1 - s)
        }),
        ("at-each-second", "Two runs share a position.", |s, _| {
            Some(s & !1)
        }),
    ];
    list.rows(
        "lavapipe: FragCoord of the fragment, not of the sample",
        plant,
        &rows,
    );
    list.add(
        "at-the-sample-when-off",
        CONFUSION,
        "Without sample shading, the run lies at the first covered sample.",
        shaded_at(|_, first, _| Some(first)),
    );
}
