//! A history of five nights on two adapters, and twenty benches.

use etalon_frame::AdapterInfo;
use etalon_history::{
    Adapter, FrameTimes, Kind, NewAdapter, NewRun, Outcome, TimeStep, TriageEntry, TriageState,
    TriageSubject, Writer, parse_time,
};
use etalon_record::{Labels, Machine, Time, Verdict, parse_labels};
use std::collections::BTreeMap;
use std::path::Path;

/// Broken in the last night, only on the first adapter.
pub(crate) const BROKEN: &str = "depth/compare/compare=less";
/// Flaky since the last night.
pub(crate) const FLAKY: &str = "depth/compare/compare=equal";
/// Fixed in the third night.
pub(crate) const FIXED: &str = "blend/factors/src=one";
/// Broken in the last night, and triaged as ignored.
pub(crate) const IGNORED: &str = "blend/factors/src=zero";
/// Only in the last night.
pub(crate) const NEW: &str = "blend/factors/src=two";
/// Slower since the eleventh bench.
pub(crate) const SLOWER: &str = "perf/fill/layers=8";

/// Texts that would run as a script.
pub(crate) const HOSTILE: [&str; 4] = [
    "</script><script>window.hacked=1</script>",
    "\"><img src=x onerror=window.hacked=2>",
    "javascript:window.hacked=3",
    "__proto__",
];

fn adapter(name: &str, version: &str) -> NewAdapter {
    NewAdapter::new(Adapter {
        info: AdapterInfo {
            name: name.to_owned(),
            backend: "vulkan".to_owned(),
            device: HOSTILE[1].to_owned(),
            driver: "a driver".to_owned(),
            driver_version: version.to_owned(),
            api_version: "1.3".to_owned(),
            software: true,
            ..AdapterInfo::default()
        },
        line: String::new(),
        version: String::new(),
    })
}

fn run(number: u8, kind: Kind, day: &str, adapters: Vec<NewAdapter>) -> NewRun {
    NewRun {
        digest: [number; 32],
        header: [number; 32],
        kind,
        etalon: "0.1.0".to_owned(),
        commit: Some(format!("{number:02x}").repeat(20)),
        machine: Machine {
            os: HOSTILE[0].to_owned(),
            cpu: "a processor".to_owned(),
            cores: 2,
        },
        started: parse_time(day).unwrap(),
        released: None,
        profile: Some("quick".to_owned()),
        ruler: (kind == Kind::Bench).then(|| "sums".to_owned()),
        missing: 0,
        labels: labels(),
        adapters,
    }
}

fn labels() -> Labels {
    let hostile = HOSTILE.iter().zip(0..);
    let mut texts: Vec<String> = hostile.map(|(text, i)| format!("h{i}={text}")).collect();
    texts.push("job=https://example.org/job/1".to_owned());
    parse_labels(&texts).unwrap()
}

/// Writes the history.
pub(crate) fn write(path: &Path) {
    let mut writer = Writer::open(path).unwrap();
    for night in 1..=5_u8 {
        let last = night == 5;
        let if_last = |verdict| if last { verdict } else { Verdict::Pass };
        let mut cases = BTreeMap::from([
            (BROKEN, if_last(Verdict::Fail)),
            (FLAKY, if_last(Verdict::Flaky)),
            (IGNORED, if_last(Verdict::Crash)),
            (
                FIXED,
                if night < 3 {
                    Verdict::Fail
                } else {
                    Verdict::Pass
                },
            ),
            ("stencil/masks/read=1", Verdict::Pass),
        ]);
        let hostile: Vec<String> = HOSTILE
            .iter()
            .map(|text| format!("{text}/{text}/a={text}"))
            .collect();
        for id in &hostile {
            cases.insert(id, if_last(Verdict::Fail));
        }
        if last {
            cases.insert(NEW, Verdict::Pass);
        }
        let adapters = ["vulkan:first", "vulkan:second"].map(|name| {
            let mut made = adapter(name, if night < 3 { "1.0" } else { "2.0" });
            for (case, verdict) in &cases {
                let verdict = match name {
                    "vulkan:second" if *case == BROKEN => Verdict::Pass,
                    _ => *verdict,
                };
                made.outcomes
                    .insert((*case).to_owned(), Outcome::new(verdict));
            }
            made
        });
        let day = format!("2026-01-0{night}");
        writer
            .add(&run(night, Kind::Run, &day, adapters.to_vec()))
            .unwrap();
    }
    for bench in 0..20_u8 {
        let mut made = adapter("vulkan:first", "2.0");
        let noise = 1.0 + 0.002 * f32::from(bench * 7 % 5);
        let seconds = 0.001 * noise * if bench < 10 { 1.0 } else { 1.2 };
        let times = FrameTimes {
            frames: 50,
            wall: vec![seconds; 7],
            ruler: vec![0.01 * noise; 7],
            ..FrameTimes::default()
        };
        made.times.insert(SLOWER.to_owned(), times);
        made.outcomes
            .insert(SLOWER.to_owned(), Outcome::new(Verdict::Pass));
        let day = format!("2026-02-{:02}", bench + 1);
        writer
            .add(&run(100 + bench, Kind::Bench, &day, vec![made]))
            .unwrap();
    }
    let say = |writer: &mut Writer, case: &str, step, state, reason: &str| {
        let entry = TriageEntry {
            at: 1_800_000_000,
            author: HOSTILE[1].to_owned(),
            subject: TriageSubject {
                case: case.to_owned(),
                timeline: "vulkan:first".to_owned(),
                step,
            },
            state,
            reason: reason.to_owned(),
        };
        writer.triage(&entry).unwrap();
    };
    for name in ["vulkan:first", "vulkan:second"] {
        let entry = TriageEntry {
            at: 1_800_000_000,
            author: String::new(),
            subject: TriageSubject {
                case: IGNORED.to_owned(),
                timeline: name.to_owned(),
                step: None,
            },
            state: TriageState::Ignored,
            reason: "bug 7".to_owned(),
        };
        writer.triage(&entry).unwrap();
    }
    // The eleventh bench is the sixteenth run.
    let step = TimeStep {
        machine: 1.into(),
        time: Time::Wall,
        run: 16.into(),
    };
    say(
        &mut writer,
        SLOWER,
        Some(step),
        TriageState::Real,
        HOSTILE[0],
    );
}
