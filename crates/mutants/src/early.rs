//! Bugs of early fragment tests, discards and counters.

use super::hooks::kept;
use super::list::{CONFUSION, List, Row, SMALL};
use super::plant::{Plant, draws, from_draw};
use etalon_frame::{CounterKind, Frame};
use etalon_scene::{Draw, EarlyTests, Scene};

pub(super) fn add(list: &mut List) {
    list.class("early", "early-z");
    tests(list);
    discards(list);
    counters(list);
}

/// Tests that come at the wrong time.
fn tests(list: &mut List) {
    list.add(
        "forced-as-implicit",
        CONFUSION,
        "Forced early tests come late.",
        draws(|draw| {
            if draw.early_tests == EarlyTests::Forced {
                draw.early_tests = EarlyTests::Implicit;
            }
        }),
    );
    type When = fn(&Draw) -> bool;
    let early: [(&str, &'static str, &str, When); 5] = [
        (
            "tested-before-discard",
            "panfrost: early tests despite alpha test; Adreno, Mali: discard still touching depth and stencil",
            "Shaders that discard are tested early.",
            |draw| draw.shader.discards(),
        ),
        (
            "tested-before-written-depth",
            CONFUSION,
            "Shaders that write depth are tested early, with the fragment's own.",
            |draw| draw.shader.writes_depth(),
        ),
        (
            "tested-before-alpha-to-coverage",
            "ANGLE, turnip: early tests despite alpha to coverage",
            "Draws with alpha to coverage are tested early.",
            |draw| draw.multisample.alpha_to_coverage,
        ),
        (
            "tested-before-side-effects",
            "softpipe: late tests that come early",
            "Shaders that count their runs are tested early.",
            |draw| draw.shader.counts_runs(),
        ),
        (
            "promise-as-order",
            CONFUSION,
            "A layout qualifier on the written depth makes tests early, with the fragment's own depth.",
            |draw| draw.early_tests.is_conservative(),
        ),
    ];
    for (name, source, about, when) in early {
        list.add(
            name,
            source,
            about,
            draws(move |draw| {
                if when(draw) {
                    draw.early_tests = EarlyTests::Forced;
                }
            }),
        );
    }
    list.add(
        "forced-writes-nothing",
        CONFUSION,
        "Forced early tests store no depth.",
        draws(|draw| {
            if let (EarlyTests::Forced, Some(depth)) = (draw.early_tests, &mut draw.depth) {
                depth.write = false;
            }
        }),
    );
    list.add(
        "forced-skips-stencil",
        "v3d: early tests against stencil writes",
        "Forced early tests leave the stencil test out.",
        draws(|draw| {
            if draw.early_tests == EarlyTests::Forced {
                draw.stencil = None;
            }
        }),
    );
    list.add(
        "sticky-forced",
        "state left from the draw before",
        "A draw after one with forced early tests has them too.",
        from_draw(|before, draw| {
            if before.early_tests == EarlyTests::Forced {
                draw.early_tests = EarlyTests::Forced;
            }
        }),
    );
}

fn discards(list: &mut List) {
    type Keeps = fn(f32, f32) -> bool;
    let rows: [Row<Keeps>; 5] = [
        ("discard-off", "No fragment is discarded.", |_, _| true),
        (
            "discard-at-threshold",
            "A fragment whose alpha is the threshold is discarded.",
            |value, limit| value > limit,
        ),
        (
            "discard-inverted",
            "Fragments are discarded from the threshold on.",
            |value, limit| value < limit,
        ),
        (
            "discard-in-8-bits",
            "Alpha and threshold are compared as 8-bit codes.",
            |value, limit| (value * 255.0).round() >= (limit * 255.0).round(),
        ),
        (
            "discard-one-code-late",
            "The threshold lies one 8-bit code too low.",
            |value, limit| value >= limit - 1.0 / 255.0,
        ),
    ];
    list.class("discard", "texture");
    fn plant(bug: Keeps) -> Plant {
        kept(bug)
    }
    list.rows("a discard that is not done as written", plant, &rows);
    list.class("early", "early-z");
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
        "state left from the draw before",
        "A draw counts for the counters of the draw before it.",
        from_draw(|before, draw| {
            if !before.counters.is_empty() && !draw.counters.is_empty() {
                draw.counters.clone_from(&before.counters);
            }
        }),
    );
    list.add(
        "query-never-ends",
        "state left from the draw before",
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
