//! Counters side by side.

use super::super::list::{CONFUSION, List};
use super::super::plant::{Plant, scene};
use etalon_scene::Scene;

/// Changes the counts of a frame with several counters of the same kind.
fn counts(bug: fn(&mut [u64])) -> Plant {
    Plant::Frame(Box::new(move |scene, frame| {
        let mut kinds = scene.counters.windows(2);
        if scene.counters.len() > 1 && kinds.all(|pair| pair[0].kind == pair[1].kind) {
            bug(&mut frame.counters);
        }
    }))
}

/// Removes each counter from one of the draws that it counts, given how many there are.
fn uncounted(of: fn(usize) -> Option<usize>) -> Plant {
    scene(move |scene: &mut Scene| {
        for counter in 0..scene.counters.len() {
            let draws = scene.passes.iter_mut().flat_map(|p| &mut p.draws);
            let mut counted: Vec<_> = draws.filter(|d| d.counters.contains(&counter)).collect();
            if let Some(at) = of(counted.len()) {
                counted[at].counters.retain(|c| *c != counter);
            }
        }
    })
}

pub(super) fn add(list: &mut List) {
    list.add(
        "every-count-is-the-last",
        CONFUSION,
        "Every counter has the last one's value.",
        counts(|all| {
            let last = all[all.len() - 1];
            all.fill(last);
        }),
    );
    list.add(
        "counts-shifted",
        CONFUSION,
        "Every counter has the value of the one before.",
        counts(|all| all.rotate_right(1)),
    );
    list.add(
        "counts-not-reset",
        CONFUSION,
        "A counter goes on from the one before.",
        counts(|all| {
            for at in 1..all.len() {
                all[at] += all[at - 1];
            }
        }),
    );
    list.add(
        "counter-ends-one-draw-early",
        CONFUSION,
        "A counter over several draws misses the last.",
        uncounted(|n| (n > 1).then(|| n - 1)),
    );
    list.add(
        "counter-begins-one-draw-late",
        CONFUSION,
        "A counter over several draws misses the first.",
        uncounted(|n| (n > 1).then_some(0)),
    );
}
