//! Bugs of sample shading: the share of a texel's samples that have a shader run of their own.

use crate::fields::Places;
use crate::hooks::{shaded_at, shader_runs};
use crate::list::{CONFUSION, List};
use crate::plant::Plant;

const SHARE: Places<Option<f32>> = |d| vec![&mut d.multisample.min_sample_shading];

pub(super) fn add(list: &mut List) {
    list.class("sample-shading", "multisample");
    states(list);
    runs(list);
    positions(list);
}

fn states(list: &mut List) {
    list.source("llvmpipe, zink: min_samples not part of the shader's key");
    list.bug("ignored: Sample shading is never enabled.")
        .set(SHARE, None);
    list.bug("always: Sample shading is always enabled.")
        .each(SHARE, |share| *share = share.or(Some(1.0)));
    list.bug("whole-share-alone: A share below 1 does not enable it.")
        .each(SHARE, |share| *share = share.filter(|share| *share >= 1.0));
    list.bug("halved: Half of the share counts.")
        .each(SHARE, |share| *share = share.map(|share| share * 0.5));
    list.bug("off-under-a-mask: A sample mask that leaves samples out disables it.")
        .when(|draw| draw.multisample.mask & 0xf != 0xf)
        .set(SHARE, None);
    list.source(CONFUSION);
}

fn runs(list: &mut List) {
    fn plant(bug: fn(f32, usize) -> usize) -> Plant {
        shader_runs(move |shader, state, n| match state.min_sample_shading {
            _ if shader.runs_per_sample() => n,
            Some(share) => bug(share, n),
            None => 1,
        })
    }
    fn exact(share: f32, samples: usize) -> usize {
        (share * samples as f32).ceil() as usize
    }
    list.bug("rounded-down: The number of runs is rounded down.")
        .plant(plant(|share, n| (share * n as f32) as usize));
    list.bug("rounded-to-nearest: The number of runs is rounded to the nearest.")
        .plant(plant(|share, n| (share * n as f32).round() as usize));
    list.bug("one-run-less: One run is missing.")
        .plant(plant(|share, n| {
            exact(share, n) - usize::from(exact(share, n) > 1)
        }));
    list.bug("one-run: The shader runs once all the same.")
        .plant(plant(|_, _| 1));
    list.bug("two-runs-at-most: More than two runs are lost.")
        .plant(plant(|share, n| exact(share, n).min(2)));
    list.bug("four-runs-at-most: More than four runs are lost.")
        .plant(plant(|share, n| exact(share, n).min(4)));
    list.bug("of-four-samples: The share is always taken of four samples.")
        .plant(plant(|share, _| exact(share, 4)));
    const MORE: &str = "Vulkan: Sample Shading; OpenGL 4.6: 14.3.1.1: at least as many";
    list.source("Intel: all samples or one");
    list.bug("rounded-up-to-a-power-of-two: The number of runs is a power of two.")
        .legal(MORE)
        .plant(plant(|share, n| exact(share, n).next_power_of_two()));
    list.bug("all-samples: Any share is taken for 1.")
        .legal(MORE)
        .plant(plant(|_, n| n));
    list.source(CONFUSION);
}

fn positions(list: &mut List) {
    fn plant(bug: fn(usize, usize) -> Option<usize>) -> Plant {
        shaded_at(move |state, first, samples| {
            state.min_sample_shading.and_then(|_| bug(first, samples))
        })
    }
    list.source("lavapipe: FragCoord of the fragment, not of the sample");
    list.bug("at-the-centre: All runs lie at the centre.")
        .plant(plant(|_, _| None));
    list.bug("at-the-first: All runs lie at the first sample.")
        .plant(plant(|_, _| Some(0)));
    list.bug("at-the-last: All runs lie at the last sample.")
        .plant(plant(|_, n| Some(n - 1)));
    list.bug("at-the-next: Each run lies at the next sample.")
        .plant(plant(|s, n| Some((s + 1) % n)));
    list.bug("in-reverse: The runs lie in reverse order.")
        .plant(plant(|s, n| Some(n - 1 - s)));
    list.bug("at-each-second: Two runs share a position.")
        .plant(plant(|s, _| Some(s & !1)));
    list.source(CONFUSION);
    list.bug(
        "at-the-sample-when-off: Without sample shading, the run lies at the first covered sample.",
    )
    .plant(shaded_at(|_, first, _| Some(first)));
}
