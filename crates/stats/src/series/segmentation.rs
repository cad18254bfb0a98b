//! Where a series changes: finds weak changes first, then removes those without enough evidence.
//!
//! As in Hunter (Fleming et al. 2023), the divisive search of Matteson and James (2014) goes over windows of
//! a fixed length, so that two nearby changes do not hide each other in a long series, and takes all places
//! at a lenient level. Then the weakest change that fails the strict test between its neighbours is removed,
//! and its neighbours are tested again, until all pass. Changes that need more runs than a window to be
//! visible are searched for afterwards, in each stretch as a whole.

use super::divergence::best_place;
use super::stretch::{MIN_RUNS, STEP, ShiftTest, Sums};
use crate::compare::LEVEL;
use std::collections::BTreeSet;

/// The number of runs in a window.
pub(super) const WINDOW: usize = 50;
/// The level of weak changes.
const WEAK: f64 = 0.05;
/// The maximum number of rounds of search and removal; two or three suffice.
const ROUNDS: usize = 8;

/// Returns the places of all changes, ascending.
pub(super) fn places(sums: &Sums) -> Vec<usize> {
    let runs = sums.values().len();
    let mut found = BTreeSet::new();
    // From both ends, so that the reversed series has the same changes.
    for start in (0..runs).step_by(WINDOW / 2) {
        let end = (start + WINDOW).min(runs);
        split(sums, start, end, WEAK, &mut found);
        split(sums, runs - end, runs - start, WEAK, &mut found);
    }
    remove(sums, &mut found);
    for _ in 0..ROUNDS {
        let before = found.clone();
        let ends: Vec<usize> = found.iter().copied().chain([runs]).collect();
        let mut start = 0;
        for end in ends {
            split(sums, start, end, WEAK, &mut found);
            start = end;
        }
        remove(sums, &mut found);
        found = settle(sums, &found);
        remove(sums, &mut found);
        if found == before {
            break;
        }
    }
    found.into_iter().collect()
}

/// Returns the test of a change between its neighbours: for two levels, or on a line if a line fits better.
pub(super) fn test(sums: &Sums, from: usize, place: usize, to: usize) -> ShiftTest {
    if sums.is_rather_a_line(from, place, to) {
        sums.step_of_line(from, place, to)
    } else {
        sums.step(from, place, to)
    }
}

/// Divides a stretch and its parts as long as there are weak changes.
fn split(sums: &Sums, from: usize, to: usize, level: f64, found: &mut BTreeSet<usize>) {
    let Some(place) = best_place(&sums.values()[from..to], MIN_RUNS) else {
        return;
    };
    let place = from + place;
    // Neighbours correlate if a stretch contains further changes; the strict test corrects for that.
    if sums.plain_step(from, place, to).p() > level {
        return;
    }
    found.insert(place);
    split(sums, from, place, level, found);
    split(sums, place, to, level, found);
}

/// A change between its neighbours.
struct CandidateChange {
    place: usize,
    holds: bool,
    /// The size of the test's statistic.
    evidence: f64,
}

/// Removes the weakest change that fails its test, until all pass.
fn remove(sums: &Sums, found: &mut BTreeSet<usize>) {
    let runs = sums.values().len();
    let mut places: Vec<usize> = found.iter().copied().collect();
    let judged = |places: &[usize], index: usize| judge(sums, places, index, runs);
    let mut candidates: Vec<CandidateChange> = (0..places.len())
        .map(|index| judged(&places, index))
        .collect();
    loop {
        let failing = candidates.iter().enumerate().filter(|(_, c)| !c.holds);
        let weakest = failing.min_by(|(_, a), (_, b)| a.evidence.total_cmp(&b.evidence));
        let Some((weakest_index, _)) = weakest else {
            break;
        };
        candidates.remove(weakest_index);
        places.remove(weakest_index);
        // Changes too near to each other are tested against farther ones, so removing one can affect more
        // than two.
        let near =
            weakest_index.saturating_sub(MIN_RUNS)..places.len().min(weakest_index + MIN_RUNS);
        for (index, candidate) in near.clone().zip(&mut candidates[near]) {
            *candidate = judged(&places, index);
        }
    }
    *found = candidates.into_iter().map(|c| c.place).collect();
}

/// Tests a change between the nearest changes that are far enough from it. Out of changes that are too near
/// to each other, the one with the most evidence remains.
fn judge(sums: &Sums, places: &[usize], index: usize, runs: usize) -> CandidateChange {
    let place = places[index];
    let before = places[..index].iter().rev();
    let after = places[index + 1..].iter();
    let from = before
        .copied()
        .chain([0])
        .find(|other| place - other >= MIN_RUNS);
    let to = after
        .copied()
        .chain([runs])
        .find(|other| other - place >= MIN_RUNS);
    let (Some(from), Some(to)) = (from, to) else {
        return CandidateChange {
            place,
            holds: false,
            evidence: 0.0,
        };
    };
    let test = test(sums, from, place, to);
    let alone = places[..index].last().is_none_or(|other| *other == from)
        && places.get(index + 1).is_none_or(|other| *other == to);
    CandidateChange {
        place,
        holds: alone && test.shift.abs() >= STEP.ln() && test.p_of_any_place() <= LEVEL,
        evidence: test.shift.abs() / test.error,
    }
}

/// Moves each change to the place between its neighbours that fits best.
fn settle(sums: &Sums, found: &BTreeSet<usize>) -> BTreeSet<usize> {
    let runs = sums.values().len();
    let places: Vec<usize> = found.iter().copied().collect();
    let moved = places.iter().enumerate().map(|(index, place)| {
        let from = index.checked_sub(1).map_or(0, |before| places[before]);
        let to = places.get(index + 1).copied().unwrap_or(runs);
        if sums.is_rather_a_line(from, *place, to) {
            *place
        } else {
            sums.best_place(from, *place, to)
        }
    });
    moved.collect()
}
