//! Bugs of counters.

use super::list::{CONFUSION, List, SMALL};
use super::plant::{Plant, from_draw};
use etalon_frame::{CounterKind, Frame};
use etalon_scene::Scene;

pub(super) fn add(list: &mut List) {
    list.class("counter", "early-z");
    counters(list);
}

/// Changes the counts of some kinds.
fn counts(
    kinds: impl Fn(CounterKind) -> bool + Send + Sync + 'static,
    bug: impl Fn(u64) -> u64 + Send + Sync + 'static,
) -> Plant {
    Plant::Frame(Box::new(move |scene: &Scene, frame: &mut Frame| {
        for (counter, count) in scene.counters.iter().zip(&mut frame.counters) {
            if kinds(counter.kind) {
                *count = bug(*count);
            }
        }
    }))
}

fn counters(list: &mut List) {
    list.class("counter", "early-z");
    let precise = |kind| kind == CounterKind::SamplesPassed;
    let any = |kind| kind == CounterKind::AnySamplesPassed;
    let runs = |kind| kind == CounterKind::ShaderRuns;
    list.add(
        "samples-one-more",
        SMALL,
        "One sample too many is counted.",
        counts(precise, |n| n + 1),
    );
    list.add(
        "samples-one-less",
        SMALL,
        "One sample too few is counted, where there are any.",
        counts(precise, |n| n.saturating_sub(1)),
    );
    list.add(
        "samples-doubled",
        CONFUSION,
        "Every sample counts twice.",
        counts(precise, |n| n * 2),
    );
    list.add(
        "samples-lost",
        CONFUSION,
        "No sample counts.",
        counts(precise, |_| 0),
    );
    list.add(
        "samples-as-any",
        CONFUSION,
        "A precise count reports only whether any sample passed.",
        counts(precise, |n| n.min(1)),
    );
    list.add(
        "samples-in-8-bits",
        CONFUSION,
        "Counts run over at 128.",
        counts(precise, |n| n % 128),
    );
    list.add(
        "any-always",
        CONFUSION,
        "Some sample always passes.",
        counts(any, |_| 1),
    );
    list.add(
        "any-never",
        CONFUSION,
        "No sample ever passes.",
        counts(any, |_| 0),
    );
    list.add(
        "any-inverted",
        CONFUSION,
        "A query for any samples reports none.",
        counts(any, |n| 1 - n.min(1)),
    );
    list.add(
        "runs-lost",
        "softpipe: no run of a shader whose fragments fail",
        "No run of a shader counts.",
        counts(runs, |_| 0),
    );
    list.add(
        "runs-halved",
        CONFUSION,
        "Every second run counts.",
        counts(runs, |n| n / 2),
    );
    list.add(
        "runs-one-less",
        SMALL,
        "One run too few counts.",
        counts(runs, |n| n.saturating_sub(1)),
    );
    list.add(
        "runs-never-none",
        "softpipe: runs of fragments that forced early tests reject",
        "Where no fragment passes forced early tests, the shader still runs once.",
        counts(runs, |n| n.max(1)),
    );
    list.add(
        "runs-doubled",
        CONFUSION,
        "Every run counts twice.",
        counts(runs, |n| n * 2),
    )
    .legal(
        "Vulkan: Fragment Shader Execution: a fragment may have several runs, whose stores and \
             atomics have the normal effect",
    );
    list.add(
        "counts-for-the-draw-before",
        "state of the previous draw",
        "A draw counts for the counters of the draw before it.",
        from_draw(|before, draw| {
            if !before.counters.is_empty() && !draw.counters.is_empty() {
                draw.counters.clone_from(&before.counters);
            }
        }),
    );
    list.add(
        "query-never-ends",
        "state of the previous draw",
        "A counter continues through later draws.",
        Plant::Scene(Box::new(|scene| {
            let scene_counters = scene.counters.clone();
            let occlusion = |i: &usize| scene_counters[*i].kind.is_occlusion();
            for pass in &mut scene.passes {
                let mut running: Vec<usize> = Vec::new();
                for draw in &mut pass.draws {
                    let own: Vec<usize> = draw.counters.iter().copied().filter(occlusion).collect();
                    for counter in &running {
                        if !draw.counters.contains(counter) {
                            draw.counters.push(*counter);
                        }
                    }
                    for counter in own {
                        if !running.contains(&counter) {
                            running.push(counter);
                        }
                    }
                }
            }
        })),
    );
}
