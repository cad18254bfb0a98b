//! Bugs of counters.

use crate::list::{List, SMALL};
use crate::plant::{Plant, frames, from_draw};
use etalon_frame::CounterKind;
use std::collections::BTreeSet;

/// Changes the counts of one kind.
fn counts(kind: CounterKind, bug: fn(u64) -> u64) -> Plant {
    frames(move |scene, frame| {
        for (counter, count) in scene.counters.iter().zip(&mut frame.counters) {
            if counter.kind == kind {
                *count = bug(*count);
            }
        }
    })
}

pub(super) fn add(list: &mut List) {
    list.class("counter", "early-z");
    let precise = CounterKind::SamplesPassed;
    let any = CounterKind::AnySamplesPassed;
    let runs = CounterKind::ShaderRuns;
    list.bug("samples-one-more: One sample too many is counted.")
        .source(SMALL)
        .plant(counts(precise, |n| n + 1));
    list.bug("samples-one-less: One sample too few is counted, where there are any.")
        .source(SMALL)
        .plant(counts(precise, |n| n.saturating_sub(1)));
    list.bug("samples-doubled: Every sample counts twice.")
        .plant(counts(precise, |n| n * 2));
    list.bug("samples-lost: No sample counts.")
        .plant(counts(precise, |_| 0));
    list.bug("samples-as-any: A precise count reports only whether any sample passed.")
        .plant(counts(precise, |n| n.min(1)));
    list.bug("samples-in-8-bits: Counts run over at 128.")
        .plant(counts(precise, |n| n % 128));
    list.bug("any-always: Some sample always passes.")
        .plant(counts(any, |_| 1));
    list.bug("any-never: No sample ever passes.")
        .plant(counts(any, |_| 0));
    list.bug("any-inverted: A query for any samples reports none.")
        .plant(counts(any, |n| 1 - n.min(1)));
    list.bug("runs-lost: No run of a shader counts.")
        .source("softpipe: no run of a shader whose fragments fail")
        .plant(counts(runs, |_| 0));
    list.bug("runs-halved: Every second run counts.")
        .plant(counts(runs, |n| n / 2));
    list.bug("runs-one-less: One run too few counts.")
        .source(SMALL)
        .plant(counts(runs, |n| n.saturating_sub(1)));
    list.bug("runs-never-none: Where forced early tests reject all, the shader still runs once.")
        .source("softpipe: runs of fragments that forced early tests reject")
        .plant(counts(runs, |n| n.max(1)));
    list.bug("runs-doubled: Every run counts twice.")
        .legal(
            "Vulkan: Fragment Shader Execution: a fragment may have several runs, whose stores and \
             atomics have the normal effect",
        )
        .plant(counts(runs, |n| n * 2));
    list.bug("counts-for-the-draw-before: A draw counts for the counters of the draw before it.")
        .source("state of the previous draw")
        .plant(from_draw(|before, draw| {
            if !before.counters.is_empty() && !draw.counters.is_empty() {
                draw.counters.clone_from(&before.counters);
            }
        }));
    list.bug("query-never-ends: A counter continues through later draws.")
        .source("state of the previous draw")
        .passes(|scene, _, pass| {
            let mut running = BTreeSet::new();
            for draw in &mut pass.draws {
                let asked = draw.counters.clone();
                draw.counters
                    .extend(running.iter().filter(|counter| !asked.contains(counter)));
                let queries = asked.into_iter();
                running.extend(queries.filter(|i| scene.counters[*i].kind.is_occlusion()));
            }
        });
}
