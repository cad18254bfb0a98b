//! Queries side by side, and queries over several draws or passes.

use crate::list::{CONFUSION, List};
use crate::plant::{Plant, frames};
use etalon_scene::{Draw, Scene};

/// Changes the counts of a frame.
fn counts(bug: fn(&mut [u64])) -> Plant {
    frames(move |_, frame| bug(&mut frame.counters))
}

/// Changes the counts of a frame with several counters of the same kind.
fn alike(bug: fn(&mut [u64])) -> Plant {
    frames(move |scene, frame| {
        let mut kinds = scene.counters.windows(2);
        if scene.counters.len() > 1 && kinds.all(|pair| pair[0].kind == pair[1].kind) {
            bug(&mut frame.counters);
        }
    })
}

/// Removes each counter from one of several draws that it counts, given how many there are.
fn uncounted(scene: &mut Scene, which: fn(usize) -> usize) {
    for counter in 0..scene.counters.len() {
        let draws = scene.passes.iter_mut().flat_map(|p| &mut p.draws);
        let mut counted: Vec<_> = draws.filter(|d| d.counters.contains(&counter)).collect();
        let count = counted.len();
        if count > 1 {
            counted[which(count)].counters.retain(|c| *c != counter);
        }
    }
}

/// Removes the counters of draws that other passes count too.
fn counted_elsewhere(draws: &mut [Draw], others: &[etalon_scene::Pass]) {
    let others = others.iter().flat_map(|p| &p.draws);
    let known: Vec<usize> = others.flat_map(|d| d.counters.clone()).collect();
    for draw in draws.iter_mut().filter(|d| !d.shader.counts_runs()) {
        draw.counters.retain(|c| !known.contains(c));
    }
}

pub(super) fn add(list: &mut List) {
    list.bug("second-query-gets-the-first: Every query gets the value of the first one.")
        .source("SwiftShader: one query for all")
        .plant(counts(|counts| {
            counts.fill(counts.first().copied().unwrap_or_default())
        }));
    list.source(CONFUSION);
    list.bug("queries-in-reverse: Queries come back in reverse.")
        .plant(counts(<[_]>::reverse));
    list.bug("last-query-lost: Of several queries the last one stays 0.")
        .plant(counts(|counts| {
            if let [_, .., last] = counts {
                *last = 0;
            }
        }));
    list.bug("query-of-the-first-pass-alone: A query keeps the value of its first pass.")
        .passes(|asked, number, pass| counted_elsewhere(&mut pass.draws, &asked.passes[..number]));
    list.bug("query-of-the-last-pass-alone: A query keeps the value of its last pass.")
        .passes(|asked, number, pass| {
            counted_elsewhere(&mut pass.draws, &asked.passes[number + 1..]);
        });
    list.bug("every-count-is-the-last: Every counter has the last one's value.")
        .plant(alike(|counts| counts.fill(counts[counts.len() - 1])));
    list.bug("counts-shifted: Every counter has the value of the one before.")
        .plant(alike(|counts| counts.rotate_right(1)));
    list.bug("counts-not-reset: A counter goes on from the one before.")
        .plant(alike(|counts| {
            for number in 1..counts.len() {
                counts[number] += counts[number - 1];
            }
        }));
    list.bug("counter-ends-one-draw-early: A counter over several draws misses the last.")
        .scene(|scene| uncounted(scene, |count| count - 1));
    list.bug("counter-begins-one-draw-late: A counter over several draws misses the first.")
        .scene(|scene| uncounted(scene, |_| 0));
}
