//! Bugs of counters.

use crate::list::{SMALL, bugs};
use crate::permission::under;
use crate::plant::{Plant, frames, from_draw, passes};
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

bugs! {
    class "counter", "early-z";
    let precise = CounterKind::SamplesPassed;
    let any = CounterKind::AnySamplesPassed;
    let runs = CounterKind::ShaderRuns;
    "samples-one-more: One sample too many is counted." => counts(precise, |n| n + 1), source SMALL;
    "samples-one-less: One sample too few is counted, where there are any." =>
        counts(precise, |n| n.saturating_sub(1)), source SMALL;
    "samples-doubled: Every sample counts twice." => counts(precise, |n| n * 2);
    "samples-lost: No sample counts." => counts(precise, |_| 0);
    "samples-as-any: A precise count reports only whether any sample passed." => counts(precise, |n| n.min(1));
    "samples-in-8-bits: Counts run over at 128." => counts(precise, |n| n % 128);
    "samples-in-16-bits: Counts run over at 65,536." => counts(precise, |n| n % 65_536), area "size";
    "samples-below-2-20: Counts stay below 2^20." => counts(precise, |n| n.min((1 << 20) - 1)), area "size";
    "any-always: Some sample always passes." => counts(any, |_| 1);
    "any-never: No sample ever passes." => counts(any, |_| 0);
    "any-inverted: A query for any samples reports none." => counts(any, |n| 1 - n.min(1));
    "runs-lost: No run of a shader counts." =>
        counts(runs, |_| 0), source "softpipe: no run of a shader whose fragments fail";
    "runs-halved: Every second run counts." => counts(runs, |n| n / 2);
    "runs-one-less: One run too few counts." => counts(runs, |n| n.saturating_sub(1)), source SMALL;
    "runs-never-none: Where forced early tests reject all, the shader still runs once." =>
        counts(runs, |n| n.max(1)), source "softpipe: runs of fragments that forced early tests reject";
    "runs-doubled: Every run counts twice." =>
        counts(runs, |n| n * 2), permitted vec![under!(runs_once: false)];
    "counts-for-the-draw-before: A draw counts for the counters of the draw before it." =>
        from_draw(|before, draw| {
            if !before.counters.is_empty() && !draw.counters.is_empty() { draw.counters.clone_from(&before.counters); }
        }), source "state of the previous draw";
    "query-never-ends: A counter continues through later draws." =>
        passes(|scene, _, pass| {
            let mut running = BTreeSet::new();
            for draw in &mut pass.draws {
                let asked = draw.counters.clone();
                draw.counters.extend(running.iter().filter(|counter| !asked.contains(counter)));
                let queries = asked.into_iter();
                running.extend(queries.filter(|i| scene.counters[*i].kind.is_occlusion()));
            }
        }), source "state of the previous draw";
}
