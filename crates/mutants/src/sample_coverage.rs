//! Bugs of sample coverage: a share of the samples, or its inverse.

use super::hooks::sample_drawn;
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws};
use etalon_scene::{Draw, Multisample, SampleCoverage};

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
    let rows: [Row<fn(&mut Draw)>; 5] = [
        ("ignored", "Sample coverage is never enabled.", |draw| {
            draw.multisample.sample_coverage = None;
        }),
        ("inversion-ignored", "Inversion does nothing.", |draw| {
            if let Some(share) = &mut draw.multisample.sample_coverage {
                share.invert = false;
            }
        }),
        ("always-inverted", "Every share is inverted.", |draw| {
            if let Some(share) = &mut draw.multisample.sample_coverage {
                share.invert = true;
            }
        }),
        (
            "inverts-the-value",
            "Inversion takes 1 less the value, and covers the first samples as ever.",
            |draw| {
                if let Some(share) = &mut draw.multisample.sample_coverage
                    && share.invert
                {
                    *share = SampleCoverage {
                        value: 1.0 - share.value,
                        invert: false,
                    };
                }
            },
        ),
        (
            "lost-under-alpha-to-coverage",
            "Alpha to coverage replaces sample coverage.",
            |draw| {
                if draw.multisample.alpha_to_coverage {
                    draw.multisample.sample_coverage = None;
                }
            },
        ),
    ];
    let source = "Gallium lowers sample coverage to a mask, inversion included";
    list.rows(source, |bug: fn(&mut Draw)| draws(bug), &rows);
    list.add(
        "replaces-alpha-to-coverage",
        CONFUSION,
        "Sample coverage replaces alpha to coverage.",
        draws(|draw| {
            draw.multisample.alpha_to_coverage &= draw.multisample.sample_coverage.is_none();
        }),
    );
}

fn values(list: &mut List) {
    let rows: [Row<Share>; 6] = [
        (
            "negative-as-all",
            "A value below 0 wraps to all samples.",
            |v, s, n| v < 0.0 || s < count(v, n),
        ),
        (
            "above-one-wraps",
            "A value above 1 loses its whole part.",
            |v, s, n| s < count(if v > 1.0 { v.fract() } else { v }, n),
        ),
        (
            "zero-covers-one",
            "A share covers at least one.",
            |v, s, n| s < count(v, n).max(1),
        ),
        (
            "whole-lacks-one",
            "A share of 1 leaves the last sample out.",
            |v, s, n| s < count(v, n).min(n - 1),
        ),
        ("never", "No share covers anything.", |_, _, _| false),
        ("one-less", "A share covers one too few.", |v, s, n| {
            s + 1 < count(v, n)
        }),
    ];
    list.rows(CONFUSION, shares, &rows);
    const OPEN: &str = "OpenGL 4.6: 14.9.3: between 0 and 1 no algorithm is required; only a number \
                        in proportion is intended";
    let open: [Row<Share>; 3] = [
        (
            "half-as-whole",
            "A share of a half covers all.",
            |v, _, _| v >= 0.5,
        ),
        (
            "truncated",
            "The number of samples is truncated.",
            |v, s, n| s < (v.clamp(0.0, 1.0) * n as f32) as usize,
        ),
        (
            "from-the-last",
            "A share covers the last samples.",
            |v, s, n| n - 1 - s < count(v, n),
        ),
    ];
    for (name, about, bug) in open {
        list.add(name, CONFUSION, about, shares(bug)).legal(OPEN);
    }
}

fn combinations(list: &mut List) {
    let rows: [Row<Combined>; 5] = [
        (
            "or-mask",
            "A sample is drawn that either the share or the mask lets through.",
            |covered, invert, mask| (covered != invert) || mask,
        ),
        (
            "replaces-the-mask",
            "The sample mask is lost under sample coverage.",
            |covered, invert, _| covered != invert,
        ),
        (
            "replaced-by-the-mask",
            "A mask that leaves samples out replaces the share.",
            |_, _, mask| mask,
        ),
        (
            "inversion-takes-the-mask-along",
            "Inversion applies to the share and the mask together.",
            |covered, invert, mask| (covered && mask) != invert,
        ),
        (
            "exclusive-with-the-mask",
            "A sample is drawn that one of share and mask lets through.",
            |covered, invert, mask| (covered != invert) != mask,
        ),
    ];
    list.rows(
        "freedreno: sample mask and coverage in one register",
        combined,
        &rows,
    );
}

fn single(list: &mut List) {
    type Bug = fn(&Multisample) -> bool;
    fn plant(bug: Bug) -> Plant {
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
    let rows: [Row<Bug>; 3] = [
        (
            "of-one-sample",
            "A share of less than a half draws nothing to one sample.",
            |state| {
                let share = state.sample_coverage;
                share.is_none_or(|share| (share.value >= 0.5) != share.invert)
            },
        ),
        (
            "of-one-sample-at-zero",
            "A share of 0 draws nothing to one sample.",
            |state| state.sample_coverage.is_none_or(|share| share.value > 0.0),
        ),
        (
            "of-one-sample-inverted",
            "An inverted share draws nothing to one sample.",
            |state| state.sample_coverage.is_none_or(|share| !share.invert),
        ),
    ];
    list.rows("sample mask applied without several samples", plant, &rows);
}
