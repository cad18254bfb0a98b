//! Bugs of sample coverage: a fraction of the samples, possibly inverted.

use crate::fields::SAMPLE_COVERAGE;
use crate::hooks::sample_drawn;
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{Plant, draws, each};
use etalon_scene::{Multisample, SampleCoverage};

/// Returns the number of samples that a value covers.
fn count(value: f32, samples: usize) -> usize {
    (value.clamp(0.0, 1.0) * samples as f32).round() as usize
}

fn in_mask(state: &Multisample, sample: usize) -> bool {
    state.mask & (1 << sample) != 0
}

/// Replaces the test of a sample if there are several: whether the value covers it before inversion,
/// whether the coverage is inverted, and whether the mask has its bit.
fn tested(
    covers: fn(f32, usize, usize) -> bool,
    bug: fn(bool, bool, bool) -> bool,
    single: fn(SampleCoverage) -> bool,
) -> Plant {
    sample_drawn(move |state, sample, samples| {
        let mask = in_mask(state, sample);
        match state.sample_coverage {
            Some(share) if samples > 1 => {
                bug(covers(share.value, sample, samples), share.invert, mask)
            }
            Some(share) => single(share) && mask,
            None => mask,
        }
    })
}

/// Replaces the conversion of a value to covered samples, given the sample's index and the number of
/// samples.
fn shares(bug: fn(f32, usize, usize) -> bool) -> Plant {
    tested(
        bug,
        |covered, invert, mask| (covered != invert) && mask,
        |_| true,
    )
}

/// Replaces the combination of coverage, inversion and mask.
fn combined(bug: fn(bool, bool, bool) -> bool) -> Plant {
    tested(|v, s, n| s < count(v, n), bug, |_| true)
}

/// Makes the value decide whether a single sample is drawn.
fn of_one(bug: fn(SampleCoverage) -> bool) -> Plant {
    tested(
        |v, s, n| s < count(v, n),
        |covered, invert, mask| (covered != invert) && mask,
        bug,
    )
}

bugs! {
    class "sample-coverage", "multisample";
    source "Gallium lowers sample coverage to a mask, inversion included";
    "ignored: Sample coverage is never enabled." => draws(|draw| draw.multisample.sample_coverage = None);
    "inversion-ignored: Inversion does nothing." => each(SAMPLE_COVERAGE, |share| share.invert = false);
    "always-inverted: Every share is inverted." => each(SAMPLE_COVERAGE, |share| share.invert = true);
    "inverts-the-value: Inversion covers the first samples, by 1 less the value." =>
        each(SAMPLE_COVERAGE, |share| if std::mem::take(&mut share.invert) { share.value = 1.0 - share.value });
    "lost-under-alpha-to-coverage: Alpha to coverage replaces sample coverage." =>
        draws(|draw| draw.multisample.sample_coverage = None), when |draw| draw.multisample.alpha_to_coverage;
    source CONFUSION;
    "replaces-alpha-to-coverage: Sample coverage replaces alpha to coverage." =>
        draws(|draw| draw.multisample.alpha_to_coverage &= draw.multisample.sample_coverage.is_none());
    "negative-as-all: A value below 0 wraps to all samples." => shares(|v, s, n| v < 0.0 || s < count(v, n));
    "above-one-wraps: A value above 1 loses its whole part." =>
        shares(|v, s, n| s < count(if v > 1.0 { v.fract() } else { v }, n));
    "zero-covers-one: A share covers at least one." => shares(|v, s, n| s < count(v, n).max(1));
    "whole-lacks-one: A share of 1 leaves the last sample out." => shares(|v, s, n| s < count(v, n).min(n - 1));
    "never: No share covers anything." => shares(|_, _, _| false);
    "one-less: A share covers one too few." => shares(|v, s, n| s + 1 < count(v, n));
    "half-as-whole: A share of a half covers all." => shares(|v, _, _| v >= 0.5), permitted vec![under!(sample_coverage: _)];
    "truncated: The number of samples is truncated." =>
        shares(|v, s, n| s < (v.clamp(0.0, 1.0) * n as f32) as usize), permitted vec![under!(sample_coverage: _)];
    "from-the-last: A share covers the last samples." => shares(|v, s, n| n - 1 - s < count(v, n)), permitted vec![under!(sample_coverage: _)];
    source "freedreno: sample mask and coverage in one register";
    "or-mask: A sample is drawn that either the share or the mask lets through." =>
        combined(|covered, invert, mask| (covered != invert) || mask);
    "replaces-the-mask: The sample mask is lost under sample coverage." =>
        combined(|covered, invert, _| covered != invert);
    "replaced-by-the-mask: A mask that leaves samples out replaces the share." => combined(|_, _, mask| mask);
    "inversion-takes-the-mask-along: Inversion applies to share and mask together." =>
        combined(|covered, invert, mask| (covered && mask) != invert);
    "exclusive-with-the-mask: A sample is drawn that one of share and mask lets through." =>
        combined(|covered, invert, mask| (covered != invert) != mask);
    source "sample mask applied without several samples";
    "of-one-sample: A share of less than a half draws nothing to one sample." =>
        of_one(|share| (share.value >= 0.5) != share.invert);
    "of-one-sample-at-zero: A share of 0 draws nothing to one sample." => of_one(|share| share.value > 0.0);
    "of-one-sample-inverted: An inverted share draws nothing to one sample." => of_one(|share| !share.invert);
}
