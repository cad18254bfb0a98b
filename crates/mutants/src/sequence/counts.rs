//! Concurrent queries, and queries over several draws or passes.

use crate::list::{CONFUSION, bugs};
use crate::plant::{Plant, frames, passes, scene};
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

/// Removes each counter from one of the draws that it counts, chosen by `which` from their number.
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

/// Removes counters from draws if draws of other passes have them too.
fn counted_elsewhere(draws: &mut [Draw], others: &[etalon_scene::Pass]) {
    let others = others.iter().flat_map(|p| &p.draws);
    let known: Vec<usize> = others.flat_map(|d| d.counters.clone()).collect();
    for draw in draws.iter_mut().filter(|d| !d.shader.counts_runs()) {
        draw.counters.retain(|c| !known.contains(c));
    }
}

bugs! {
    "second-query-gets-the-first: Every query gets the value of the first one." =>
        counts(|counts| counts.fill(counts.first().copied().unwrap_or_default())),
        source "SwiftShader: one query for all";
    source CONFUSION;
    "queries-in-reverse: Queries come back in reverse." => counts(<[_]>::reverse);
    "last-query-lost: Of several queries the last one stays 0." =>
        counts(|counts| if let [_, .., last] = counts { *last = 0 });
    "query-of-the-first-pass-alone: A query keeps the value of its first pass." =>
        passes(|asked, number, pass| counted_elsewhere(&mut pass.draws, &asked.passes[..number]));
    "query-of-the-last-pass-alone: A query keeps the value of its last pass." =>
        passes(|asked, number, pass| { counted_elsewhere(&mut pass.draws, &asked.passes[number + 1..]); });
    "every-count-is-the-last: Every counter has the last one's value." =>
        alike(|counts| counts.fill(counts[counts.len() - 1]));
    "counts-shifted: Every counter has the value of the one before." => alike(|counts| counts.rotate_right(1));
    "counts-not-reset: A counter goes on from the one before." =>
        alike(|counts| { for number in 1..counts.len() { counts[number] += counts[number - 1]; } });
    "counter-ends-one-draw-early: A counter over several draws misses the last." =>
        scene(|scene| uncounted(scene, |count| count - 1));
    "counter-begins-one-draw-late: A counter over several draws misses the first." =>
        scene(|scene| uncounted(scene, |_| 0));
}
