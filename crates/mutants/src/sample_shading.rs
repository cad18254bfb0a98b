//! Bugs of sample shading: the fraction of a texel's samples that have their own shader run.

use crate::fields::FieldPlaces;
use crate::hooks::{shaded_at, shader_runs};
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{Plant, each, set};
use etalon_reference::rules::FragCoord;

const SHARE: FieldPlaces<Option<f32>> = |d| vec![&mut d.multisample.min_sample_shading];

/// Replaces the number of runs under sample shading.
fn runs(bug: fn(f32, usize) -> usize) -> Plant {
    shader_runs(move |shader, state, n| match state.min_sample_shading {
        _ if shader.runs_per_sample() => n,
        Some(share) => bug(share, n),
        None => 1,
    })
}

fn exact(share: f32, samples: usize) -> usize {
    (share * samples as f32).ceil() as usize
}

/// Replaces the sample at whose position a run of sample shading takes its inputs.
fn placed(bug: fn(usize, usize) -> Option<usize>) -> Plant {
    shaded_at(move |state, first, samples| {
        state.min_sample_shading.and_then(|_| bug(first, samples))
    })
}

bugs! {
    class "sample-shading", "multisample";
    source "llvmpipe, zink: min_samples not part of the shader's key";
    "ignored: Sample shading is never enabled." => set(SHARE, None);
    "always: Sample shading is always enabled." => each(SHARE, |share| *share = share.or(Some(1.0)));
    "whole-share-alone: A share below 1 does not enable it." =>
        each(SHARE, |share| *share = share.filter(|share| *share >= 1.0));
    "halved: Half of the share counts." => each(SHARE, |share| *share = share.map(|share| share * 0.5));
    "off-under-a-mask: A sample mask that leaves samples out disables it." =>
        set(SHARE, None), when |draw| draw.multisample.mask & 0xf != 0xf;
    source CONFUSION;
    "rounded-down: The number of runs is rounded down." => runs(|share, n| (share * n as f32) as usize);
    "rounded-to-nearest: The number of runs is rounded to the nearest." =>
        runs(|share, n| (share * n as f32).round() as usize);
    "one-run-less: One run is missing." => runs(|share, n| exact(share, n) - usize::from(exact(share, n) > 1));
    "one-run: The shader runs once all the same." => runs(|_, _| 1);
    "two-runs-at-most: More than two runs are lost." => runs(|share, n| exact(share, n).min(2));
    "four-runs-at-most: More than four runs are lost." => runs(|share, n| exact(share, n).min(4));
    "of-four-samples: The share is always taken of four samples." => runs(|share, _| exact(share, 4));
    source "Intel: all samples or one";
    "rounded-up-to-a-power-of-two: The number of runs is a power of two." =>
        runs(|share, n| exact(share, n).next_power_of_two()), permitted vec![under!(runs_by_share: _)];
    "all-samples: Any share is taken for 1." => runs(|_, n| n), permitted vec![under!(runs_by_share: _)];
    source "lavapipe: FragCoord of the fragment, not of the sample";
    "at-the-centre: All runs lie at the centre." => placed(|_, _| None), permitted vec![under!(frag_coord: FragCoord::Inputs), under!(inputs_at_samples: false)];
    "at-the-first: All runs lie at the first sample." => placed(|_, _| Some(0));
    "at-the-last: All runs lie at the last sample." => placed(|_, n| Some(n - 1));
    "at-the-next: Each run lies at the next sample." => placed(|s, n| Some((s + 1) % n));
    "in-reverse: The runs lie in reverse order." => placed(|s, n| Some(n - 1 - s));
    "at-each-second: Two runs share a position." => placed(|s, _| Some(s & !1));
    source CONFUSION;
    "at-the-sample-when-off: Without sample shading, the run lies at the first covered sample." =>
        shaded_at(|_, first, _| Some(first));
}
