//! Rounds that a real machine with busy neighbours took for the same work (see `examples/rounds.rs`).
//! During `drifting.csv` its clock slowed down in steps: the last rounds took a tenth longer than the
//! first. `steady.csv` is from a calmer minute.

use crate::{is_different, most};
use etalon_stats::{Conclusion, LEVEL, POWER, Samples, Why, compare, smallest_visible};
use oorandom::Rand64;

#[derive(Clone, Debug)]
struct Round {
    ruler: f64,
    frames: Vec<f64>,
}

const DRIFTING: &str = include_str!("../data/drifting.csv");
const STEADY: &str = include_str!("../data/steady.csv");

fn recorded(text: &str) -> Vec<Round> {
    let round = |line: &str| {
        let times: Vec<f64> = line.split(',').map(|t| t.parse().unwrap()).collect();
        let [before, after, frames @ ..] = times.as_slice() else {
            panic!("{line}");
        };
        Round {
            ruler: (before * after).sqrt(),
            frames: frames.to_vec(),
        }
    };
    let rounds: Vec<Round> = text.lines().map(round).collect();
    assert!(rounds.len() >= 40, "{}", rounds.len());
    rounds
}

/// The rounds as a bench whose frames took a factor longer.
fn bench(rounds: &[Round], factor: f64) -> Samples {
    let scaled = |r: &Round| r.frames.iter().map(|t| t * factor).collect();
    let frames: Vec<Vec<f64>> = rounds.iter().map(scaled).collect();
    let rulers: Vec<f64> = rounds.iter().map(|r| r.ruler).collect();
    Samples::new(&frames).unwrap().with_ruler(&rulers).unwrap()
}

/// Two benches of this many rounds each, drawn from all rounds without replacement.
fn drawn(rounds: &mut [Round], each: usize, random: &mut Rand64) -> (Vec<Round>, Vec<Round>) {
    for i in 0..2 * each {
        let with = random.rand_range(i as u64..rounds.len() as u64) as usize;
        rounds.swap(i, with);
    }
    (rounds[..each].to_vec(), rounds[each..2 * each].to_vec())
}

#[test]
fn a_clock_that_slowed_down_is_recognized() {
    let rounds = recorded(DRIFTING);
    let comparison = compare(&bench(&rounds[..30], 1.0), &bench(&rounds[30..], 1.0));
    assert_eq!(comparison.outcome, Conclusion::CannotTell(Why::Drift));
    assert!(comparison.ratio.low > 1.01, "{comparison:?}");
    assert!(comparison.ruled.unwrap().high < 1.04, "{comparison:?}");
    // The same for any two stretches of a dozen rounds.
    for first in (0..48).step_by(4) {
        for second in (0..48).step_by(4) {
            let before = bench(&rounds[first..first + 12], 1.0);
            let after = bench(&rounds[second..second + 12], 1.0);
            let outcome = compare(&before, &after).outcome;
            assert!(!is_different(outcome), "{first} {second} {outcome:?}");
        }
    }
}

#[test]
fn the_same_work_is_not_called_different() {
    for (text, each) in [(DRIFTING, 12), (STEADY, 12), (STEADY, 20)] {
        let mut rounds = recorded(text);
        let mut random = Rand64::new(1);
        let trials = 1_500;
        let (mut wrong, mut outside) = (0, 0);
        for _ in 0..trials {
            let (before, after) = drawn(&mut rounds, each, &mut random);
            let comparison = compare(&bench(&before, 1.0), &bench(&after, 1.0));
            wrong += u32::from(is_different(comparison.outcome));
            let ratio = comparison.ratio;
            outside += u32::from(ratio.low > 1.0 || ratio.high < 1.0);
        }
        println!("{each}: {wrong} of {trials}; {outside} without the minimum");
        assert!(wrong <= most(trials, LEVEL), "{wrong}");
        assert!(outside <= most(trials, LEVEL), "{outside}");
    }
}

#[test]
fn planted_changes_are_found_in_recorded_samples() {
    let mut rounds = recorded(STEADY);
    let mut random = Rand64::new(2);
    // Two percent is less than this recording could show in most trials; every statement about it must still
    // be right.
    for (change, seen_at_least) in [(1.02, 0), (1.05, 5), (1.10, 95)] {
        let (mut above, mut found) = (0, 0);
        for trial in 0..100 {
            let (before, after) = drawn(&mut rounds, 20, &mut random);
            let slower = trial % 2 == 0;
            let factor = if slower { change } else { 1.0 / change };
            let (before, after) = (bench(&before, 1.0), bench(&after, factor));
            let expected = if slower {
                Conclusion::Slower
            } else {
                Conclusion::Faster
            };
            let outcome = compare(&before, &after).outcome;
            assert!(outcome == expected || !is_different(outcome));
            if change > smallest_visible(&before, &after).unwrap() {
                above += 1;
                found += u32::from(outcome == expected);
            }
        }
        println!("{change}: {found} of {above}");
        let share = f64::from(found) / f64::from(above.max(1));
        assert!(above == 0 || share >= POWER, "{change}: {found} of {above}");
        assert!(above >= seen_at_least, "{change}: {above}");
    }
}
