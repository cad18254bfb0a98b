//! Simulated benches: planted changes are found, and the same thing twice is not called different.

use crate::{is_different, most};
use etalon_stats::{
    CONFIDENCE, Conclusion, LEVEL, POWER, Samples, Why, compare, smallest_visible, summarize,
};
use oorandom::Rand64;

/// The noise of a machine's frame times; deviations and drifts are of the logarithm.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Noise {
    /// Deviation between rounds.
    round: f64,
    /// Deviation between frames of a round, each of which resembles the one before it.
    frame: f64,
    /// The share of frames that take up to several times as long.
    outliers: f64,
    /// The share of rounds in which a neighbour slows down everything, the ruler too.
    disturbed: f64,
    /// The slow-down of everything from the first round to the last, the ruler too.
    drift: f64,
    /// Deviation of a bench's own pace, the ruler's too.
    pace: f64,
    /// Deviation of the ruler.
    ruler: f64,
}

const QUIET: Noise = Noise {
    round: 0.002,
    frame: 0.004,
    outliers: 0.02,
    disturbed: 0.0,
    drift: 0.002,
    pace: 0.0,
    ruler: 0.001,
};

const USUAL: Noise = Noise {
    round: 0.01,
    frame: 0.03,
    outliers: 0.05,
    disturbed: 0.05,
    drift: 0.02,
    pace: 0.0,
    ruler: 0.004,
};

const LOUD: Noise = Noise {
    round: 0.03,
    frame: 0.08,
    outliers: 0.1,
    disturbed: 0.15,
    drift: 0.05,
    pace: 0.0,
    ruler: 0.02,
};

const FRAMES: usize = 7;

fn normal(random: &mut Rand64) -> f64 {
    let radius = (-2.0 * (1.0 - random.rand_float()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.rand_float()).cos()
}

fn chance(random: &mut Rand64, share: f64) -> bool {
    random.rand_float() < share
}

/// A bench of a frame that takes 3 ms times a factor when nothing disturbs it.
fn bench(random: &mut Rand64, noise: Noise, rounds: usize, factor: f64) -> Samples {
    let pace = noise.pace * normal(random);
    let mut samples = Vec::new();
    let mut rulers = Vec::new();
    for round in 0..rounds {
        let mut common = pace + noise.drift * round as f64 / rounds as f64;
        if chance(random, noise.disturbed) {
            common += 0.4 * random.rand_float();
        }
        let shift = common + noise.round * normal(random);
        let mut deviation = noise.frame * normal(random);
        let mut frames = Vec::new();
        for _ in 0..FRAMES {
            // Half of a frame's deviation comes from the frame before it.
            deviation = 0.5 * deviation + 0.75_f64.sqrt() * noise.frame * normal(random);
            let mut time = 0.003 * factor * (shift + deviation).exp();
            if chance(random, noise.outliers) {
                time *= 1.0 - (1.0 - random.rand_float()).ln();
            }
            frames.push(time);
        }
        samples.push(frames);
        rulers.push(0.002 * (common + noise.ruler * normal(random)).exp());
    }
    Samples::new(&samples).unwrap().with_ruler(&rulers).unwrap()
}

#[test]
fn the_same_thing_twice_is_seldom_called_different() {
    // Benches of different lengths, of machines whose noise varies from day to day, and of machines that
    // change their pace between benches.
    let paced = Noise {
        pace: 0.05,
        ..USUAL
    };
    let uneven = Noise {
        round: 0.04,
        ruler: 0.015,
        ..USUAL
    };
    let mut total = 0;
    let mut told_in_all = 0;
    for (seed, (first, second, rounds)) in [
        (QUIET, QUIET, (12, 12)),
        (USUAL, USUAL, (12, 12)),
        (LOUD, LOUD, (12, 12)),
        (LOUD, LOUD, (7, 7)),
        (LOUD, LOUD, (20, 9)),
        (USUAL, uneven, (12, 12)),
        (uneven, USUAL, (9, 15)),
        (paced, paced, (12, 12)),
    ]
    .into_iter()
    .enumerate()
    {
        let mut random = Rand64::new(seed as u128 + 1);
        let trials = 2_600;
        let (mut wrong, mut outside) = (0, 0);
        for _ in 0..trials {
            let before = bench(&mut random, first, rounds.0, 1.0);
            let after = bench(&mut random, second, rounds.1, 1.0);
            let comparison = compare(&before, &after);
            wrong += u32::from(is_different(comparison.outcome));
            let ratio = comparison.ratio;
            outside += u32::from(ratio.low > 1.0 || ratio.high < 1.0);
        }
        println!("{seed}: {wrong} of {trials}; {outside} without the minimum");
        assert!(wrong <= most(trials, LEVEL), "{seed}: {wrong} of {trials}");
        if first == second && first.pace == 0.0 {
            // The level holds only for the interval, and only if nothing but chance acts.
            assert!(
                outside <= most(trials, LEVEL),
                "{seed}: {outside} of {trials}"
            );
        }
        total += trials;
        told_in_all += wrong;
    }
    assert!(total >= 20_000);
    assert!(
        told_in_all <= most(total, LEVEL),
        "{told_in_all} of {total}"
    );
}

#[test]
fn planted_changes_above_the_smallest_visible_are_found() {
    let trials = 120;
    for (seed, (noise, change, seen_at_least)) in [
        (QUIET, 0.02, 0.4),
        (QUIET, 0.05, 1.0),
        (QUIET, 0.10, 1.0),
        (USUAL, 0.05, 0.0),
        (USUAL, 0.10, 0.4),
        (LOUD, 0.10, 0.0),
    ]
    .into_iter()
    .enumerate()
    {
        for slower in [true, false] {
            let factor = if slower {
                1.0 + change
            } else {
                1.0 / (1.0 + change)
            };
            let expected = if slower {
                Conclusion::Slower
            } else {
                Conclusion::Faster
            };
            let mut random = Rand64::new(seed as u128 + 100);
            let (mut above, mut found, mut below_found) = (0, 0, 0);
            for _ in 0..trials {
                let before = bench(&mut random, noise, 12, 1.0);
                let after = bench(&mut random, noise, 12, factor);
                let outcome = compare(&before, &after).outcome;
                let visible = smallest_visible(&before, &after).unwrap();
                if 1.0 + change > visible {
                    above += 1;
                    found += u32::from(outcome == expected);
                } else {
                    below_found += u32::from(outcome == expected);
                }
                // The direction is never wrong.
                assert!(
                    outcome == expected || !is_different(outcome),
                    "{noise:?} {factor}"
                );
            }
            println!(
                "{change} {slower}: {found} of {above}, below {below_found} of {}",
                trials - above
            );
            assert!(
                f64::from(above) >= seen_at_least * f64::from(trials),
                "{noise:?}: {above}"
            );
            assert!(
                f64::from(found) >= POWER * f64::from(above),
                "{noise:?}: {found} of {above}"
            );
        }
    }
}

#[test]
fn the_smallest_visible_change_is_neither_promised_too_small_nor_far_too_large() {
    for (seed, noise) in [QUIET, USUAL, LOUD].into_iter().enumerate() {
        let mut random = Rand64::new(seed as u128 + 200);
        let trials = 100;
        let (mut found, mut found_half, mut promised) = (0, 0, 0);
        for _ in 0..trials {
            let other = bench(&mut random, noise, 12, 1.0);
            let before = bench(&mut random, noise, 12, 1.0);
            // The same disturbances each time, around frames that take longer.
            let same = random;
            let after = |by: f64| bench(&mut same.clone(), noise, 12, by);
            let seen = |by: f64| {
                let outcome = compare(&before, &after(by)).outcome;
                u32::from(outcome == Conclusion::Slower)
            };
            let visible = smallest_visible(&before, &after(1.0)).unwrap();
            found += seen(visible);
            found_half += seen(1.0 + (visible - 1.0) / 2.0);
            promised += seen(summarize(&other).visible.unwrap());
            bench(&mut random, noise, 12, 1.0);
        }
        let share = |n: u32| f64::from(n) / f64::from(trials);
        println!("{seed}: {found}, {found_half}, {promised} of {trials}");
        assert!(share(found) >= POWER, "{noise:?}: {found}");
        assert!(share(found_half) <= 0.6, "{noise:?}: {found_half}");
        // What one bench predicts for two others holds a little less often: it cannot know about disturbances
        // that it did not have.
        assert!(share(promised) >= POWER - 0.1, "{noise:?}: {promised}");
    }
}

#[test]
fn a_machine_that_slows_down_as_a_whole_is_no_change() {
    let mut random = Rand64::new(7);
    let slow = |random: &mut Rand64, by: f64| {
        // The pace is the same for every round, so that only the ruler can tell.
        let noise = Noise { pace: 0.0, ..QUIET };
        let samples = bench(random, noise, 12, 1.0);
        let medians: Vec<[f64; 1]> = samples.medians().iter().map(|m| [m * by]).collect();
        let rulers: Vec<f64> = (0..12)
            .map(|_| 0.002 * by * (0.001 * normal(random)).exp())
            .collect();
        Samples::new(&medians).unwrap().with_ruler(&rulers).unwrap()
    };
    for by in [1.1, 1.3, 0.8] {
        let before = slow(&mut random, 1.0);
        let after = slow(&mut random, by);
        let comparison = compare(&before, &after);
        assert_eq!(comparison.outcome, Conclusion::CannotTell(Why::Drift));
        assert!((comparison.ratio.estimate / by - 1.0).abs() < 0.01);
        assert!((comparison.ruled.unwrap().estimate - 1.0).abs() < 0.01);
    }
}

#[test]
fn reasons_for_an_undecided_comparison_are_distinguished() {
    let mut random = Rand64::new(8);
    let few = bench(&mut random, QUIET, 6, 1.0);
    let slow = bench(&mut random, QUIET, 6, 3.0);
    let comparison = compare(&few, &slow);
    assert_eq!(
        comparison.outcome,
        Conclusion::CannotTell(Why::TooFewRounds)
    );
    assert_eq!(
        (comparison.ratio.low, comparison.ratio.high),
        (0.0, f64::INFINITY)
    );
    assert_eq!(smallest_visible(&few, &slow), None);
    assert_eq!(summarize(&few).interval, None);

    let steady: Vec<[f64; 1]> = (0..9).map(|i| [1.0 + 1e-4 * f64::from(i)]).collect();
    let steady = Samples::new(&steady).unwrap();
    assert_eq!(
        compare(&steady, &steady).outcome,
        Conclusion::CannotTell(Why::Small)
    );
    let loud = bench(&mut random, LOUD, 12, 1.0);
    let other = bench(&mut random, LOUD, 12, 1.02);
    assert_eq!(
        compare(&loud, &other).outcome,
        Conclusion::CannotTell(Why::Noise)
    );
}

#[test]
fn medians_are_in_their_intervals_as_often_as_stated() {
    for rounds in [7, 12, 25] {
        let mut random = Rand64::new(rounds as u128);
        // Without drift and neighbours the median is known.
        let noise = Noise {
            drift: 0.0,
            disturbed: 0.0,
            outliers: 0.0,
            ..USUAL
        };
        let trials = 1_000;
        let mut outside = 0;
        for _ in 0..trials {
            let samples: Vec<[f64; 1]> = (0..rounds)
                .map(|_| [0.003 * (noise.round * normal(&mut random)).exp()])
                .collect();
            let summary = summarize(&Samples::new(&samples).unwrap());
            let [low, high] = summary.interval.unwrap();
            assert!(low <= summary.median && summary.median <= high);
            outside += u32::from(!(low..=high).contains(&0.003));
        }
        println!("{rounds}: {outside}");
        // A percentile bootstrap of a few rounds is a little narrow: up to twice the stated share.
        let share = 2.0 * (1.0 - CONFIDENCE);
        assert!(
            outside <= most(trials, share),
            "{rounds}: {outside} of {trials}"
        );
    }
}

#[test]
fn a_summary_has_the_figures_of_its_samples() {
    let rounds: Vec<Vec<f64>> = (0..10)
        .map(|r| (0..5).map(|f| f64::from(1 + f + r)).collect())
        .collect();
    let summary = summarize(&Samples::new(&rounds).unwrap());
    assert_eq!(
        (summary.rounds, summary.samples, summary.min),
        (10, 50, 1.0)
    );
    // Rounds have the medians 3 to 12; the samples are symmetric about 7.5 as well.
    assert!(
        (summary.median - 7.5).abs() < 1e-9 && summary.p50 == 7.5,
        "{summary:?}"
    );
    assert!(summary.p95 > 11.0 && summary.p95 <= 14.0);
    assert_eq!(summarize(&Samples::new(&rounds).unwrap()), summary);
}

#[test]
fn an_unsteady_ruler_is_distinguished_from_one_that_moved() {
    let mut random = Rand64::new(9);
    let unsteady = Noise {
        ruler: 0.3,
        ..QUIET
    };
    let before = bench(&mut random, unsteady, 12, 1.0);
    let after = bench(&mut random, unsteady, 12, 1.1);
    let outcome = compare(&before, &after).outcome;
    assert_eq!(outcome, Conclusion::CannotTell(Why::Ruler));
}
