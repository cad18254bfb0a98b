//! Added runs are read back.

use crate::made::{adapter, case, run, times, with};
use etalon_history::{
    Added, History, Kind, Outcome, RunId, SeriesKey, TimeStep, TriageEntry, TriageState,
    TriageSubject, Writer,
};
use etalon_record::{Machine, Time, Verdict, parse_labels};

/// The verdicts of a case over the runs, by time: letters as of [`with`].
fn verdicts(history: &History, case: &str, timeline: &str) -> String {
    let found = history.case_history(case, Some(timeline)).unwrap();
    let points = found.iter().flat_map(|h| &h.points);
    let letter = |verdict| match verdict {
        Verdict::Pass => 'p',
        Verdict::Fail => 'f',
        Verdict::Flaky => 'y',
        _ => '?',
    };
    points
        .map(|p| letter(history.outcome(p.outcome).unwrap().verdict))
        .collect()
}

#[test]
fn a_case_has_its_verdicts_in_the_order_of_time_whatever_the_order_of_adding() {
    let days = ["2026-01-01", "2026-01-02", "2026-01-03", "2026-01-04"];
    let rows = ["pf.p", "pfpp", "fp.p", "fp.y"];
    for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/etalon.db");
        let mut writer = Writer::open(&path).unwrap();
        for index in order {
            let made = run(
                index as u8,
                days[index],
                vec![with("cpu", "1", rows[index])],
            );
            assert!(matches!(writer.add(&made).unwrap(), Added::New(_)));
        }
        let history = History::open_read(&path).unwrap();
        for (index, expected) in ["ppff", "ffpp", "p", "pppy"].into_iter().enumerate() {
            assert_eq!(
                verdicts(&history, &case(index), "cpu"),
                expected,
                "{order:?}"
            );
        }
        assert_eq!(verdicts(&history, "depth/none", "cpu"), "");
        assert_eq!(verdicts(&history, &case(0), "gl:none"), "");
        let digests: Vec<u8> = history.runs().iter().map(|r| r.digest[0]).collect();
        assert_eq!(digests, [0, 1, 2, 3]);
    }
}

#[test]
fn the_same_run_twice_adds_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let made = run(1, "2026-01-01", vec![with("cpu", "1", "ppf")]);
    assert_eq!(writer.add(&made).unwrap(), Added::New(RunId::from(1)));
    let before = std::fs::read(&path).unwrap();
    // Other labels do not make it another run.
    let mut again = made.clone();
    again.labels = parse_labels(&["branch=main"]).unwrap();
    for same in [&made, &again] {
        assert_eq!(writer.add(same).unwrap(), Added::Already(RunId::from(1)));
        let mut other = Writer::open(&path).unwrap();
        assert_eq!(other.add(same).unwrap(), Added::Already(RunId::from(1)));
    }
    assert_eq!(std::fs::read(&path).unwrap(), before);
}

#[test]
fn a_run_has_its_facts_and_labels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut made = run(1, "2026-01-01", vec![with("vulkan:a", "25.0", "p")]);
    made.kind = Kind::Bench;
    made.ruler = Some("a ruler".to_owned());
    made.missing = 3;
    made.released = made.started.checked_sub(1000);
    let hostile = [
        "a\u{1b}[31m=\n\0'\"; DROP TABLE run; --",
        "ü=",
        "empty key\t=x",
    ];
    made.labels = parse_labels(&hostile).unwrap();
    Writer::open(&path).unwrap().add(&made).unwrap();
    let history = History::open_read(&path).unwrap();
    let [info] = history.runs() else {
        panic!("{:?}", history.runs());
    };
    assert_eq!(info.labels, made.labels);
    assert_eq!(info.commit, made.commit);
    assert_eq!((info.kind, info.missing), (Kind::Bench, 3));
    assert_eq!(
        (info.time(), info.started),
        (made.started - 1000, made.started)
    );
    assert_eq!(info.ruler.as_deref(), Some("a ruler"));
    assert_eq!(history.machine(info.machine), Some(&made.machine));
    let [part] = history.adapters(info.id) else {
        panic!("{:?}", history.adapters(info.id));
    };
    assert_eq!(*part.adapter, made.adapters[0].adapter);
    assert_eq!((&*part.timeline, part.records), ("vulkan:a", 1));
}

#[test]
fn a_resumed_run_replaces_its_first_part() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let part = run(1, "2026-01-01", vec![with("cpu", "1", "p")]);
    let mut complete = run(2, "2026-01-01", vec![with("cpu", "1", "pf")]);
    complete.header = part.header;
    writer.add(&part).unwrap();
    writer.add(&complete).unwrap();
    let history = History::open_read(&path).unwrap();
    let [first, second] = history.runs() else {
        panic!("{:?}", history.runs());
    };
    assert_eq!(first.resumed, Some(second.id));
    assert_eq!(second.resumed, None);
    let mut records = 0;
    history
        .each_record::<etalon_history::HistoryError>(|run, _, _, _| {
            assert_eq!(run.id, second.id);
            records += 1;
            Ok(())
        })
        .unwrap();
    assert_eq!(records, 2);
}

#[test]
fn a_run_with_one_timeline_twice_is_refused_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let twice = vec![with("cpu", "1", "p"), with("cpu", "2", "f")];
    let error = writer.add(&run(1, "2026-01-01", twice)).unwrap_err();
    assert!(error.to_string().contains("\"cpu\" twice"), "{error}");
    assert!(History::open_read(&path).unwrap().runs().is_empty());
}

#[test]
fn times_form_a_series_for_each_machine() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let bench = |number: u8, day: &str, cpu: &str, wall: &[f32]| {
        let mut part = adapter("cpu", "1");
        part.outcomes
            .insert("perf/a".to_owned(), Outcome::new(Verdict::Pass));
        part.times.insert("perf/a".to_owned(), times(wall, 0.25));
        let mut made = run(number, day, vec![part]);
        made.machine = Machine {
            cpu: cpu.to_owned(),
            ..Machine::default()
        };
        made
    };
    let benches = [
        bench(1, "2026-01-03", "fast", &[3.0, 2.0]),
        bench(2, "2026-01-02", "slow", &[9.0]),
        bench(3, "2026-01-01", "fast", &[1.0]),
    ];
    for made in &benches {
        writer.add(made).unwrap();
    }
    let history = History::open_read(&path).unwrap();
    let keys = history.series_keys().unwrap();
    assert_eq!(keys.len(), 2, "{keys:?}");
    let series = |cpu: &str| {
        let is_of = |k: &&SeriesKey| history.machine(k.machine).unwrap().cpu == cpu;
        let key = keys.iter().find(is_of).unwrap();
        history.series(key).unwrap()
    };
    let fast = series("fast");
    assert_eq!(fast.len(), 2);
    assert_eq!(fast[0].times, benches[2].adapters[0].times["perf/a"]);
    assert_eq!(fast[1].times, benches[0].adapters[0].times["perf/a"]);
    assert_eq!(fast[1].times.median(Time::Wall), Some(2.5));
    assert_eq!(fast[1].times.ruler_median(), Some(0.25));
    assert_eq!(series("slow").len(), 1);
}

#[test]
fn the_last_triage_entry_about_a_subject_counts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let made = run(1, "2026-01-01", vec![with("cpu", "1", "p")]);
    writer.add(&made).unwrap();
    let history = History::open_read(&path).unwrap();
    let verdict = TriageSubject {
        case: case(0),
        timeline: "cpu".to_owned(),
        step: None,
    };
    let step = TriageSubject {
        step: Some(TimeStep {
            machine: history.runs()[0].machine,
            time: Time::Wall,
            run: history.runs()[0].id,
        }),
        ..verdict.clone()
    };
    let entry = |subject: &TriageSubject, state, reason: &str| TriageEntry {
        at: 7,
        author: "a person".to_owned(),
        subject: subject.clone(),
        state,
        reason: reason.to_owned(),
    };
    let entries = [
        entry(&verdict, TriageState::Real, ""),
        entry(&step, TriageState::Ignored, "the machine's; \"'\n"),
        entry(&verdict, TriageState::Fixed, "since 2"),
    ];
    for entry in &entries {
        writer.triage(entry).unwrap();
    }
    // An open history sees the current log, since the log belongs to no run.
    assert_eq!(history.triage_log().unwrap(), entries);
    let states = history.triage_states().unwrap();
    assert_eq!(states[&verdict], entries[2]);
    assert_eq!(states[&step], entries[1]);
}
