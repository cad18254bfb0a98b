//! Random runs: few names, times and outcomes, so that runs share series, and any of them can be hostile.

use crate::made::{HOSTILE, adapter, run};
use etalon_export::RunChoice;
use etalon_frame::Aspect;
use etalon_history::{
    Asserted, FrameTimes, Kind, Measures, MethodMeasures, NewAdapter, NewRun, Outcome, parse_time,
};
use etalon_record::{Labels, Machine, Verdict};
use proptest::collection::{btree_map, vec};
use proptest::prelude::*;
use proptest::sample::select;
use std::collections::BTreeMap;

const NAMES: [&str; 4] = ["vulkan:lavapipe", "gl:es:x", HOSTILE, ""];
const CASES: [&str; 5] = [
    "depth/a/n=1",
    "perf/b,c",
    "perf/\"d\"\\e\n#",
    "methods/../é",
    "x",
];

fn outcome() -> impl Strategy<Value = Outcome> {
    let asserted = prop::option::of((0u64..4, 0u64..4));
    let method = prop::option::of((0.0f32..1.0, 0u32..4));
    (
        select(&Verdict::ALL[..]),
        prop::option::of("[a-z\"'\u{0}\n]{0,6}"),
        (any::<bool>(), any::<bool>()),
        asserted,
        method,
    )
        .prop_map(
            |(verdict, expected, (due_fail, inferred), asserted, method)| {
                let asserted = asserted.map(|(channels, asserted)| Asserted {
                    aspect: Aspect::Depth,
                    channels,
                    asserted: asserted.min(channels),
                    codes: 1,
                });
                let method = method.map(|(rmse, passes)| MethodMeasures {
                    rmse,
                    max: 2.0 * rmse,
                    flip: rmse / 3.0,
                    wrong: 1.0 - rmse,
                    passes,
                    draws: 1,
                    fragments: None,
                    bytes: 4096,
                });
                Outcome {
                    expected,
                    due_fail,
                    inferred,
                    measures: Measures {
                        asserted: asserted.into_iter().collect(),
                        method,
                        ..Measures::default()
                    },
                    ..Outcome::new(verdict)
                }
            },
        )
}

/// No time, the time of one round, or those of three.
fn rounds() -> impl Strategy<Value = Vec<f32>> {
    let time = 1e-6f32..10.0;
    prop_oneof![Just(Vec::new()), vec(time.clone(), 1..2), vec(time, 3..4)]
}

fn times() -> impl Strategy<Value = FrameTimes> {
    let parts = (rounds(), rounds(), rounds(), rounds(), rounds());
    (0u32..u32::MAX, parts).prop_map(|(frames, (wall, cpu, gpu, read_back, ruler))| FrameTimes {
        frames,
        wall,
        cpu,
        gpu,
        read_back,
        ruler,
        interval: None,
    })
}

fn part() -> impl Strategy<Value = NewAdapter> {
    let case = || select(&CASES[..]).prop_map(str::to_owned);
    (
        "[0-9.,\"\n]{0,4}",
        btree_map(case(), outcome(), 0..4),
        btree_map(case(), times(), 0..3),
    )
        .prop_map(|(version, outcomes, times)| NewAdapter {
            outcomes,
            times,
            ..adapter("", &version)
        })
}

/// Up to five runs. Some resume the run before.
pub(crate) fn runs() -> impl Strategy<Value = Vec<NewRun>> {
    let parts = btree_map(select(&NAMES[..]), part(), 0..3);
    let about = (
        select(&Kind::ALL[..]),
        1u8..5,
        prop::option::of(1u8..5),
        any::<bool>(),
        prop::option::of("[a-f0-9,\"\n]{0,3}"),
        prop::option::of("[a-z\"\\\\\n]{0,3}"),
        select(&[None, None, Some("a ruler"), Some(HOSTILE)][..]),
    );
    vec((parts, about, prop::bool::weighted(0.2)), 1..6).prop_map(|runs| {
        let mut made: Vec<NewRun> = Vec::new();
        for (number, (parts, about, resumes)) in (1..).zip(runs) {
            let (kind, day, released, machine, commit, label, ruler) = about;
            let time_on = |day: u8| parse_time(&format!("2026-01-0{day}")).unwrap();
            let named = |parts: BTreeMap<&str, NewAdapter>| -> Vec<NewAdapter> {
                let each = parts.into_iter().map(|(name, mut part)| {
                    name.clone_into(&mut part.timeline);
                    part.adapter.info.name = format!("{name}@1");
                    part
                });
                each.collect()
            };
            let header = made.last().map(|before| before.header);
            let labels = label.map(|value| (HOSTILE.to_owned(), value));
            let run = run(number, "2026-01-01", named(parts));
            made.push(NewRun {
                header: header.filter(|_| resumes).unwrap_or(run.header),
                kind,
                started: time_on(day),
                released: released.map(time_on),
                commit,
                labels: Labels::from_iter(labels),
                ruler: ruler.map(str::to_owned),
                profile: machine.then(|| "full".to_owned()),
                machine: Machine {
                    cores: u32::from(machine),
                    ..run.machine
                },
                ..run
            });
        }
        made
    })
}

/// Any selection of them.
pub(crate) fn selections() -> impl Strategy<Value = RunChoice> {
    let since = prop::option::weighted(0.3, 1u8..5);
    let last = prop::option::weighted(0.3, 1usize..4);
    (since, last).prop_map(|(day, last)| RunChoice {
        since: day.and_then(|day| parse_time(&format!("2026-01-0{day}"))),
        last,
    })
}
