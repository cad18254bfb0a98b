//! Runs made by hand.

use etalon_frame::AdapterInfo;
use etalon_history::{Adapter, FrameTimes, Kind, NewAdapter, NewRun, Outcome, parse_time};
use etalon_record::{Labels, Machine, Verdict};
use std::collections::BTreeMap;

/// An adapter of this name and version, without records.
pub(crate) fn adapter(name: &str, version: &str) -> NewAdapter {
    NewAdapter::new(Adapter {
        info: AdapterInfo {
            name: name.to_owned(),
            backend: name.split(':').next().unwrap().to_owned(),
            device: "a device".to_owned(),
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

/// An adapter whose cases have these verdicts: a letter each, `p`ass, `f`ail, `y` flaky, `n`ot supported; a dot for
/// no record.
pub(crate) fn with(name: &str, version: &str, verdicts: &str) -> NewAdapter {
    let mut made = adapter(name, version);
    for (index, letter) in verdicts.chars().enumerate() {
        let verdict = match letter {
            'p' => Verdict::Pass,
            'f' => Verdict::Fail,
            'y' => Verdict::Flaky,
            'n' => Verdict::NotSupported,
            _ => continue,
        };
        made.outcomes.insert(case(index), Outcome::new(verdict));
    }
    made
}

/// The id of a case by number.
pub(crate) fn case(index: usize) -> String {
    let area = ["depth", "stencil", "perf"][index % 3];
    format!("{area}/made/n={index}")
}

/// A run that began on this day, with a digest made of `number`.
pub(crate) fn run(number: u8, day: &str, adapters: Vec<NewAdapter>) -> NewRun {
    NewRun {
        digest: [number; 32],
        header: [number; 32],
        kind: Kind::Run,
        etalon: "0.1.0".to_owned(),
        commit: Some(format!("{number:040x}")),
        machine: Machine {
            os: "an OS".to_owned(),
            cpu: "a processor".to_owned(),
            cores: 2,
        },
        started: parse_time(day).unwrap(),
        released: None,
        profile: Some("quick".to_owned()),
        ruler: None,
        missing: 0,
        labels: Labels::new(),
        adapters,
    }
}

/// Frame times of some rounds.
pub(crate) fn times(wall: &[f32], ruler: f32) -> FrameTimes {
    FrameTimes {
        frames: 5 * wall.len() as u32,
        wall: wall.to_vec(),
        cpu: wall.iter().map(|t| t / 2.0).collect(),
        ruler: vec![ruler; wall.len()],
        ..FrameTimes::default()
    }
}

/// All records of a history's runs, by digest, timeline and case.
pub(crate) type Content = BTreeMap<([u8; 32], String, String), Outcome>;

/// The content that these runs have.
pub(crate) fn content(runs: &[NewRun]) -> Content {
    let mut content = Content::new();
    for run in runs {
        for adapter in &run.adapters {
            for (case, outcome) in &adapter.outcomes {
                let key = (run.digest, adapter.timeline.clone(), case.clone());
                content.insert(key, outcome.clone());
            }
        }
    }
    content
}
