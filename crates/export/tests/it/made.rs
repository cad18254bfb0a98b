//! Runs made by hand, the history that holds them, and the files of a folder.

use etalon_export::{ExportFormat, RunChoice, export};
use etalon_frame::{AdapterInfo, Aspect};
use etalon_history::{
    Adapter, Asserted, FrameTimes, History, Kind, MethodMeasures, NewAdapter, NewRun, Outcome,
    Writer, parse_time,
};
use etalon_record::{Labels, Machine, Verdict};
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

/// A name that would leave a folder, end a quoted value, or begin a line.
pub(crate) const HOSTILE: &str = "../a\"b\\c\n/é";

/// Every format.
pub(crate) const FORMATS: [ExportFormat; 4] = [
    ExportFormat::Parquet,
    ExportFormat::OpenMetrics,
    ExportFormat::Bencher,
    ExportFormat::ActionBenchmark,
];

/// An adapter of this name and version, without records.
pub(crate) fn adapter(name: &str, version: &str) -> NewAdapter {
    NewAdapter::new(Adapter {
        info: AdapterInfo {
            name: name.to_owned(),
            backend: "vulkan".to_owned(),
            driver: "a driver".to_owned(),
            driver_version: version.to_owned(),
            software: true,
            ..AdapterInfo::default()
        },
        line: String::new(),
        version: String::new(),
    })
}

/// A run that began on this day, with a digest made of `number`.
pub(crate) fn run(number: u8, day: &str, adapters: Vec<NewAdapter>) -> NewRun {
    NewRun {
        digest: [number; 32],
        header: [number; 32],
        kind: Kind::Run,
        etalon: "0.1.0".to_owned(),
        commit: None,
        machine: Machine {
            os: HOSTILE.to_owned(),
            cpu: "a processor".to_owned(),
            cores: 2,
        },
        started: parse_time(day).unwrap(),
        released: None,
        profile: Some("quick".to_owned()),
        ruler: None,
        missing: 0,
        labels: Labels::from([("branch".to_owned(), HOSTILE.to_owned())]),
        adapters,
    }
}

/// Wall times of some rounds, and nothing else.
pub(crate) fn wall(rounds: &[f32]) -> FrameTimes {
    FrameTimes {
        frames: 5,
        wall: rounds.to_vec(),
        ..FrameTimes::default()
    }
}

/// A run a day, of one adapter with two records and a time.
pub(crate) fn daily(days: &[&str]) -> Vec<NewRun> {
    let made = (1..).zip(days).map(|(number, day)| {
        let mut made = adapter(HOSTILE, &format!("{number}.0"));
        let case = format!("perf/{HOSTILE}");
        let mut fail = Outcome::new(Verdict::Fail);
        fail.expected = Some("known \"bug\"".to_owned());
        fail.measures.asserted = vec![Asserted {
            aspect: Aspect::Color,
            channels: 8,
            asserted: 2,
            codes: 4,
        }];
        made.outcomes.insert(case.clone(), fail);
        let mut pass = Outcome::new(Verdict::Pass);
        pass.measures.method = Some(MethodMeasures {
            rmse: 0.5,
            max: 0.75,
            flip: 0.25,
            wrong: 0.125,
            passes: 1,
            draws: 2,
            fragments: None,
            bytes: 3,
        });
        made.outcomes.insert("depth/a".to_owned(), pass);
        made.times.insert(case, wall(&[0.5]));
        run(number, day, vec![made])
    });
    made.collect()
}

/// A history of these runs.
pub(crate) fn history(dir: &Path, runs: &[NewRun]) -> History {
    let path = dir.join("h.db");
    let mut writer = Writer::open(&path).unwrap();
    for run in runs {
        writer.add(run).unwrap();
    }
    drop(writer);
    History::open_read(&path).unwrap()
}

/// Exports the selected ones of these runs. Returns the folder, and the guard that removes it.
pub(crate) fn exported(
    runs: &[NewRun],
    format: ExportFormat,
    selection: &RunChoice,
) -> (PathBuf, tempfile::TempDir) {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let history = history(dir.path(), runs);
    let written = export(&history, format, selection, &out).unwrap();
    assert_eq!(files(&out).len() as u64, written.files, "{format:?}");
    (out, dir)
}

/// The time of a run.
pub(crate) fn time(run: &NewRun) -> i64 {
    run.released.unwrap_or(run.started)
}

/// The selected runs in the order of their times. Of runs with the same header only the last added one
/// counts.
pub(crate) fn selected<'r>(runs: &'r [NewRun], selection: &RunChoice) -> Vec<&'r NewRun> {
    let last: HashMap<[u8; 32], usize> = runs.iter().map(|r| r.header).zip(0..).collect();
    let mut kept: Vec<&NewRun> = runs
        .iter()
        .enumerate()
        .filter(|(index, run)| last[&run.header] == *index)
        .map(|(_, run)| run)
        .filter(|run| selection.since.is_none_or(|since| time(run) >= since))
        .collect();
    kept.sort_by_key(|run| time(run));
    let most = selection.last.unwrap_or(usize::MAX);
    kept.split_off(kept.len().saturating_sub(most))
}

/// A machine in words.
pub(crate) fn machine(run: &NewRun) -> String {
    let Machine { os, cpu, cores } = &run.machine;
    format!("{os}, {cpu}, {cores} cores")
}

/// The middle of an odd number of times; `None` of none.
pub(crate) fn middle(rounds: &[f32]) -> Option<f64> {
    assert!(rounds.is_empty() || rounds.len() % 2 == 1, "{rounds:?}");
    let mut sorted = rounds.to_vec();
    sorted.sort_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).copied().map(f64::from)
}

/// The files of a folder and their content.
pub(crate) fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut content = BTreeMap::new();
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            content.extend(files(&path));
        } else {
            content.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    content
}
