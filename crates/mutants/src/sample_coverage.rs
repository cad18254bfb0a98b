//! Bugs of sample coverage: a share of the samples, or its inverse.

use crate::fields::SAMPLE_COVERAGE;
use crate::hooks::sample_drawn;
use crate::list::{CONFUSION, List};
use crate::plant::Plant;
use etalon_scene::{Multisample, SampleCoverage};

/// Decides whether a value covers a sample, given its index and the number of samples.
type Share = fn(f32, usize, usize) -> bool;

/// Decides whether a sample is drawn: whether the share covers it, before any inversion, whether the
/// share is inverted, and whether the mask has its bit.
type Combined = fn(bool, bool, bool) -> bool;

/// The number of samples that a value covers.
fn count(value: f32, samples: usize) -> usize {
    (value.clamp(0.0, 1.0) * samples as f32).round() as usize
}

fn in_mask(state: &Multisample, sample: usize) -> bool {
    state.mask & (1 << sample) != 0
}

/// Replaces the conversion of a share to samples.
fn shares(bug: Share) -> Plant {
    sample_drawn(move |state, sample, samples| {
        let covered = match state.sample_coverage {
            Some(share) if samples > 1 => bug(share.value, sample, samples) != share.invert,
            _ => true,
        };
        covered && in_mask(state, sample)
    })
}

/// Replaces the combination of share, inversion and mask.
fn combined(bug: Combined) -> Plant {
    sample_drawn(move |state, sample, samples| {
        let mask = in_mask(state, sample);
        match state.sample_coverage {
            Some(SampleCoverage { value, invert }) if samples > 1 => {
                bug(sample < count(value, samples), invert, mask)
            }
            _ => mask,
        }
    })
}

pub(super) fn add(list: &mut List) {
    list.class("sample-coverage", "multisample");
    states(list);
    values(list);
    combinations(list);
    single(list);
}

fn states(list: &mut List) {
    list.source("Gallium lowers sample coverage to a mask, inversion included");
    list.bug("ignored: Sample coverage is never enabled.")
        .draws(|draw| draw.multisample.sample_coverage = None);
    list.bug("inversion-ignored: Inversion does nothing.")
        .each(SAMPLE_COVERAGE, |share| share.invert = false);
    list.bug("always-inverted: Every share is inverted.")
        .each(SAMPLE_COVERAGE, |share| share.invert = true);
    list.bug("inverts-the-value: Inversion covers the first samples, by 1 less the value.")
        .each(SAMPLE_COVERAGE, |share| {
            if std::mem::take(&mut share.invert) {
                share.value = 1.0 - share.value;
            }
        });
    list.bug("lost-under-alpha-to-coverage: Alpha to coverage replaces sample coverage.")
        .when(|draw| draw.multisample.alpha_to_coverage)
        .draws(|draw| draw.multisample.sample_coverage = None);
    list.source(CONFUSION);
    list.bug("replaces-alpha-to-coverage: Sample coverage replaces alpha to coverage.")
        .draws(|draw| {
            draw.multisample.alpha_to_coverage &= draw.multisample.sample_coverage.is_none()
        });
}

fn values(list: &mut List) {
    list.bug("negative-as-all: A value below 0 wraps to all samples.")
        .plant(shares(|v, s, n| v < 0.0 || s < count(v, n)));
    list.bug("above-one-wraps: A value above 1 loses its whole part.")
        .plant(shares(|v, s, n| {
            s < count(if v > 1.0 { v.fract() } else { v }, n)
        }));
    list.bug("zero-covers-one: A share covers at least one.")
        .plant(shares(|v, s, n| s < count(v, n).max(1)));
    list.bug("whole-lacks-one: A share of 1 leaves the last sample out.")
        .plant(shares(|v, s, n| s < count(v, n).min(n - 1)));
    list.bug("never: No share covers anything.")
        .plant(shares(|_, _, _| false));
    list.bug("one-less: A share covers one too few.")
        .plant(shares(|v, s, n| s + 1 < count(v, n)));
    const OPEN: &str = "OpenGL 4.6: 14.9.3: between 0 and 1 no algorithm is required; only a number \
                        in proportion is intended";
    list.bug("half-as-whole: A share of a half covers all.")
        .legal(OPEN)
        .plant(shares(|v, _, _| v >= 0.5));
    list.bug("truncated: The number of samples is truncated.")
        .legal(OPEN)
        .plant(shares(|v, s, n| {
            s < (v.clamp(0.0, 1.0) * n as f32) as usize
        }));
    list.bug("from-the-last: A share covers the last samples.")
        .legal(OPEN)
        .plant(shares(|v, s, n| n - 1 - s < count(v, n)));
}

fn combinations(list: &mut List) {
    list.source("freedreno: sample mask and coverage in one register");
    list.bug("or-mask: A sample is drawn that either the share or the mask lets through.")
        .plant(combined(|covered, invert, mask| {
            (covered != invert) || mask
        }));
    list.bug("replaces-the-mask: The sample mask is lost under sample coverage.")
        .plant(combined(|covered, invert, _| covered != invert));
    list.bug("replaced-by-the-mask: A mask that leaves samples out replaces the share.")
        .plant(combined(|_, _, mask| mask));
    list.bug("inversion-takes-the-mask-along: Inversion applies to share and mask together.")
        .plant(combined(|covered, invert, mask| {
            (covered && mask) != invert
        }));
    list.bug("exclusive-with-the-mask: A sample is drawn that one of share and mask lets through.")
        .plant(combined(|covered, invert, mask| {
            (covered != invert) != mask
        }));
    list.source(CONFUSION);
}

fn single(list: &mut List) {
    fn plant(bug: fn(&Multisample) -> bool) -> Plant {
        sample_drawn(move |state, sample, samples| {
            let covered = match state.sample_coverage {
                Some(share) if samples > 1 => {
                    (sample < count(share.value, samples)) != share.invert
                }
                _ => bug(state),
            };
            covered && in_mask(state, sample)
        })
    }
    list.source("sample mask applied without several samples");
    list.bug("of-one-sample: A share of less than a half draws nothing to one sample.")
        .plant(plant(|state| {
            let share = state.sample_coverage;
            share.is_none_or(|share| (share.value >= 0.5) != share.invert)
        }));
    list.bug("of-one-sample-at-zero: A share of 0 draws nothing to one sample.")
        .plant(plant(|state| {
            state.sample_coverage.is_none_or(|share| share.value > 0.0)
        }));
    list.bug("of-one-sample-inverted: An inverted share draws nothing to one sample.")
        .plant(plant(|state| {
            state.sample_coverage.is_none_or(|share| !share.invert)
        }));
    list.source(CONFUSION);
}
