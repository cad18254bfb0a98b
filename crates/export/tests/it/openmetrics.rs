//! The samples of OpenMetrics, read back by the rules of its text format.

use crate::made::{HOSTILE, daily, exported, machine, middle, selected, time};
use crate::random::{runs, selections};
use etalon_export::{ExportFormat, RunChoice};
use etalon_history::{FrameTimes, Kind, NewRun};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;

/// A metric and its labels.
type Series = (String, BTreeMap<String, String>);
/// The samples of each series by time.
type Samples = BTreeMap<Series, BTreeMap<i64, f64>>;

/// Reads a name up to one of these characters.
fn name(text: &mut &str, end: char) -> String {
    let (name, rest) = text.split_once(end).unwrap();
    *text = rest;
    assert!(
        name.chars().all(|c| c.is_ascii_lowercase() || c == '_'),
        "{name}"
    );
    name.to_owned()
}

/// Reads a value in quotes.
fn quoted(text: &mut &str) -> String {
    let mut value = String::new();
    let mut chars = text.strip_prefix('"').unwrap().chars();
    loop {
        match chars.next().unwrap() {
            '"' => break,
            '\\' => value.push(match chars.next().unwrap() {
                'n' => '\n',
                escaped @ ('"' | '\\') => escaped,
                other => panic!("no escape: {other:?}"),
            }),
            '\n' => panic!("a line ends within a value"),
            other => value.push(other),
        }
    }
    *text = chars.as_str();
    value
}

/// Reads one sample.
fn sample(line: &str) -> (Series, i64, f64) {
    let mut rest = line;
    let metric = name(&mut rest, '{');
    let mut labels = BTreeMap::new();
    loop {
        let label = name(&mut rest, '=');
        let before = labels.insert(label, quoted(&mut rest));
        assert_eq!(before, None, "{line}");
        match rest.strip_prefix(',') {
            Some(more) => rest = more,
            None => break,
        }
    }
    let rest = rest.strip_prefix("} ").unwrap();
    let (value, timestamp) = rest.split_once(' ').unwrap();
    (
        (metric, labels),
        timestamp.parse().unwrap(),
        value.parse().unwrap(),
    )
}

/// Reads a file by Prometheus's rules: metrics follow their descriptions, samples of a series are together in
/// ascending time, and the last line ends the file.
fn read(text: &str) -> Samples {
    let lines: Vec<&str> = text.strip_suffix('\n').unwrap().split('\n').collect();
    let (last, lines) = lines.split_last().unwrap();
    assert_eq!(*last, "# EOF");
    let mut samples = Samples::new();
    let (mut described, mut before): (BTreeSet<&str>, Option<(Series, i64)>) = Default::default();
    let mut family = "";
    for line in lines {
        if let Some(about) = line.strip_prefix("# ") {
            let mut words = about.split(' ');
            let (keyword, metric) = (words.next().unwrap(), words.next().unwrap());
            assert!(["TYPE", "UNIT", "HELP"].contains(&keyword), "{line}");
            if keyword == "TYPE" {
                assert!(described.insert(metric), "{line}");
                assert_eq!(words.next(), Some("gauge"));
                family = metric;
            }
            if keyword == "UNIT" {
                let unit = words.next().unwrap();
                assert!(metric.ends_with(&format!("_{unit}")), "{line}");
            }
            assert_eq!(metric, family, "{line}");
            continue;
        }
        let (series, timestamp, value) = sample(line);
        assert_eq!(series.0, family, "{line}");
        assert!(value.is_finite(), "{line}");
        if let Some((_, earlier)) = before.as_ref().filter(|(same, _)| *same == series) {
            assert!(*earlier < timestamp, "{line}");
        } else {
            assert!(!samples.contains_key(&series), "apart: {line}");
        }
        samples
            .entry(series.clone())
            .or_default()
            .insert(timestamp, value);
        before = Some((series, timestamp));
    }
    samples
}

fn series<const N: usize>(metric: &str, labels: [(&str, &str); N]) -> Series {
    let labels = labels.map(|(name, value)| (name.to_owned(), value.to_owned()));
    (metric.to_owned(), labels.into())
}

/// The samples that these runs make.
fn expected_samples(runs: &[&NewRun]) -> Samples {
    let mut samples = Samples::new();
    // Of two samples at one time, the later replaces the other.
    let mut records = BTreeMap::new();
    let mut times: BTreeMap<_, BTreeMap<i64, &FrameTimes>> = BTreeMap::new();
    for run in runs {
        for part in &run.adapters {
            let key = (part.timeline.clone(), machine(run));
            if run.kind != Kind::Bench {
                records.insert((key.clone(), time(run)), &part.outcomes);
            }
            for (case, of_case) in &part.times {
                let ruler = run.ruler.as_deref();
                let of_series = times.entry((key.clone(), case, ruler)).or_default();
                of_series.insert(time(run), of_case);
            }
        }
    }
    for (((adapter, machine), timestamp), outcomes) in records {
        for (case, outcome) in outcomes {
            let unexpected = outcome.unexpected().to_string();
            let series = series(
                "etalon_records",
                [
                    ("adapter", &adapter),
                    ("machine", &machine),
                    ("area", case.split('/').next().unwrap()),
                    ("verdict", outcome.verdict.name()),
                    ("unexpected", &unexpected),
                ],
            );
            *samples
                .entry(series)
                .or_default()
                .entry(timestamp)
                .or_default() += 1.0;
        }
    }
    for (((adapter, machine), case, ruler), by_time) in times {
        let mut take = |metric: &str, time: Option<&str>, timestamp: i64, rounds: &[f32]| {
            let labels = [
                ("adapter", Some(&*adapter)),
                ("machine", Some(&machine)),
                ("case", Some(case)),
                ("ruler", ruler),
                ("time", time),
            ];
            let labels = labels
                .into_iter()
                .filter_map(|(name, value)| value.map(|value| (name.to_owned(), value.to_owned())));
            if let Some(median) = middle(rounds) {
                let series = (metric.to_owned(), labels.collect());
                samples.entry(series).or_default().insert(timestamp, median);
            }
        };
        for (timestamp, times) in by_time {
            take("etalon_frame_seconds", Some("wall"), timestamp, &times.wall);
            take("etalon_frame_seconds", Some("cpu"), timestamp, &times.cpu);
            take("etalon_frame_seconds", Some("gpu"), timestamp, &times.gpu);
            let read_back = &times.read_back;
            take(
                "etalon_frame_seconds",
                Some("read-back"),
                timestamp,
                read_back,
            );
            take("etalon_ruler_seconds", None, timestamp, &times.ruler);
        }
    }
    samples
}

#[test]
fn exported_samples_have_the_values_of_a_known_history() {
    let everything = RunChoice::default();
    let (out, _dir) = exported(
        &daily(&["2026-01-01"]),
        ExportFormat::OpenMetrics,
        &everything,
    );
    let text = fs::read_to_string(out.join("history.om")).unwrap();
    let samples = read(&text);
    assert_eq!(samples.len(), 3);
    let machine = format!("{HOSTILE}, a processor, 2 cores");
    let case = format!("perf/{HOSTILE}");
    let labels = [
        ("adapter", HOSTILE),
        ("machine", &machine),
        ("case", &case),
        ("time", "wall"),
    ];
    let of_frames = &samples[&series("etalon_frame_seconds", labels)];
    assert_eq!(*of_frames, BTreeMap::from([(1_767_225_600, 0.5)]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn exported_samples_are_those_that_were_added(runs in runs(), selection in selections()) {
        let chosen = selected(&runs, &selection);
        prop_assume!(!chosen.is_empty());
        let (out, _dir) = exported(&runs, ExportFormat::OpenMetrics, &selection);
        let text = fs::read_to_string(out.join("history.om")).unwrap();
        prop_assert_eq!(read(&text), expected_samples(&chosen));
    }
}
