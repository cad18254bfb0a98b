//! Comparisons of two runs: planted changes of every kind are found, and no others.

use crate::runs_made::{Two, one_adapter, record_all, rich};
use crate::synthetic::{self, adapter, header};
use etalon_frame::{Api, CounterKind, CounterOutcome, Story, ToldLine};
use etalon_record::{
    Expected, ProcessEnd, Reason, Record, Run, RunWriter, Shard, Verdict, selection_digest,
    shard_of,
};
use etalon_report::runs::{CaseChange, ChangeDirection, RunSide, diff, table, write_page};
use etalon_report::{ReportError, TableOptions};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// The change that a planted difference is reported as: its direction and what differs.
fn planted(change: impl FnOnce(&mut Record)) -> Option<CaseChange> {
    let two = Two::new();
    let old: Vec<Record> = (0..5).map(|i| rich(&format!("blend/f/case={i}"))).collect();
    let mut new = old.clone();
    change(&mut new[2]);
    record_all(&two.before(), &one_adapter(5), &old);
    record_all(&two.after(), &one_adapter(5), &new);
    let difference = two.diff();
    assert!(difference.only.is_empty() && difference.unpaired.is_empty());
    assert_eq!(difference.compared(), 5);
    assert!(difference.changes.len() <= 1, "none but the planted one");
    let changed = difference.changes.len() as u64;
    assert_eq!(difference.pairs[0].same, 5 - changed);
    // Only the changed case is listed; each method has a line about its times.
    let text = table(&difference, TableOptions::default());
    let page = two.page(&difference);
    let listed = |start: &str| text.lines().filter(|l| l.starts_with(start)).count();
    assert_eq!(
        ["✗ ", "✓ ", "≠ "].map(listed).iter().sum::<usize>(),
        changed as usize
    );
    assert_eq!(page.matches("class=\"chip").count(), changed as usize);
    if changed > 0 {
        assert!(text.contains("  gl:a  blend/f/case=2\n"), "{text}");
        assert!(page.contains("<code>blend/f/case=2</code>"));
    }
    difference.changes.into_iter().next()
}

fn kinds(change: Option<CaseChange>) -> (ChangeDirection, Vec<&'static str>) {
    let change = change.unwrap();
    assert_eq!(change.case, "blend/f/case=2");
    (change.direction, change.what)
}

#[test]
fn each_planted_change_is_found_with_its_kind() {
    let fail = planted(|r| r.verdict = Verdict::Fail);
    assert_eq!(
        kinds(fail),
        (ChangeDirection::Worse, vec!["verdict", "expectation"])
    );
    let pass = planted(|r| r.verdict = Verdict::Pass);
    assert_eq!(kinds(pass), (ChangeDirection::Other, vec!["verdict"]));
    let expected = planted(|r| {
        r.expected = Some(Expected {
            reason: "known".to_owned(),
        });
    });
    assert_eq!(
        kinds(expected),
        (ChangeDirection::Other, vec!["expectation"])
    );
    let texels = planted(|r| r.texels.imprecise = 4);
    assert_eq!(kinds(texels), (ChangeDirection::Other, vec!["texels"]));
    let mean = planted(|r| r.accuracy[0].mean = 0.250_000_1);
    assert_eq!(kinds(mean), (ChangeDirection::Other, vec!["accuracy"]));
    let count = planted(|r| r.counters[0].actual = 143);
    let detail = &count.as_ref().unwrap().details[0];
    assert_eq!((&detail.before, &detail.after), (&json!(144), &json!(143)));
    assert_eq!(kinds(count), (ChangeDirection::Other, vec!["counters"]));
    let distance = planted(|r| r.measured.as_mut().unwrap().distance.rmse = 0.02);
    assert_eq!(kinds(distance), (ChangeDirection::Other, vec!["distance"]));
    let cost = planted(|r| r.measured.as_mut().unwrap().fragments = Some(4097));
    assert_eq!(kinds(cost), (ChangeDirection::Other, vec!["cost"]));
    let repeats = planted(|r| r.repeats = vec![Verdict::Imprecise, Verdict::Pass]);
    assert_eq!(kinds(repeats), (ChangeDirection::Other, vec!["repeats"]));
    let order = planted(|r| r.after = vec!["blend/f/case=1x".to_owned()]);
    assert_eq!(kinds(order), (ChangeDirection::Other, vec!["order"]));
    let said = planted(|r| r.validation = vec!["VUID-2".to_owned()]);
    assert_eq!(kinds(said), (ChangeDirection::Other, vec!["validation"]));
    let lost = planted(|r| {
        r.process = Some(ProcessEnd {
            signal: Some(6),
            seconds: 1.0,
            ..ProcessEnd::default()
        });
    });
    assert_eq!(kinds(lost), (ChangeDirection::Other, vec!["process"]));
}

#[test]
fn blocking_a_case_is_worse_and_unblocking_it_is_better_only_if_it_passes() {
    let direction = |[before, after]: [Verdict; 2]| {
        let two = Two::new();
        let record = |verdict| [Record::new("blend/f/case=2", "gl:a", verdict)];
        record_all(&two.before(), &one_adapter(1), &record(before));
        record_all(&two.after(), &one_adapter(1), &record(after));
        two.diff().changes[0].direction
    };
    let blocked = Verdict::Blocked;
    for drawn in [Verdict::Pass, Verdict::Open, Verdict::Crash, Verdict::Fail] {
        assert_eq!(
            direction([drawn, blocked]),
            ChangeDirection::Worse,
            "{drawn}"
        );
        let back = match drawn {
            Verdict::Pass => ChangeDirection::Better,
            _ => ChangeDirection::Other,
        };
        assert_eq!(direction([blocked, drawn]), back, "{drawn}");
    }
}

#[test]
fn times_messages_and_stories_are_no_change() {
    let same = planted(|r| {
        r.seconds.draw = 3.0;
        r.measured.as_mut().unwrap().time.as_mut().unwrap().wall = 1.0;
        r.reasons = vec![Reason::Text("at 0x7ffd1234".to_owned())];
        r.story = Some(Story {
            told: vec![ToldLine {
                at: "pass 0".to_owned(),
                operation: "clear".to_owned(),
                detail: "in other words".to_owned(),
                citation: None,
            }],
            ..Story::default()
        });
    });
    assert_eq!(same, None);
}

/// A failing record with its frame, in its own run.
fn with_frame(folder: &Path, change: impl FnOnce(&mut etalon_record::FrameFile)) -> Record {
    let writer = RunWriter::create(folder, &one_adapter(1)).unwrap();
    let record = synthetic::record(&writer, "depth/f/case=1", "gl:a", Verdict::Fail, 7);
    let mut frame = Run::read_frame(folder, record.frame.as_deref().unwrap()).unwrap();
    change(&mut frame);
    record_all(folder, &one_adapter(1), std::slice::from_ref(&record));
    let writer = RunWriter::create(folder, &one_adapter(1)).unwrap();
    writer.frames().write_frame(&frame).unwrap();
    let mut writer = writer;
    writer.append(&record).unwrap();
    record
}

#[test]
fn frames_are_compared_texel_by_texel_and_shown() {
    let two = Two::new();
    with_frame(&two.before(), |_| {});
    with_frame(&two.after(), |frame| {
        // Two channels of one texel, and one of another, in the first image.
        let codes = &mut frame.images[0].actual;
        codes[4] ^= 0x10;
        codes[5] ^= 0x01;
        codes[8] ^= 0x04;
    });
    let difference = two.diff();
    let [change] = difference.changes.as_slice() else {
        panic!("{:?}", difference.changes)
    };
    assert_eq!(change.what, ["frame"]);
    assert_eq!(change.direction, ChangeDirection::Other);
    let images = &change.frame.as_ref().unwrap().images;
    assert_eq!((images[0].differ, images[0].largest), (2, 16));
    assert_eq!((images[1].differ, images[1].largest), (0, 0));
    let page = two.page(&difference);
    for label in ["before", "after", "difference"] {
        assert!(
            page.contains(&format!("<figcaption>{label}</figcaption>")),
            "{label}"
        );
    }
    assert!(page.contains("2 of 256 samples differ, by up to 16 codes"));
    let text = table(&difference, TableOptions::default());
    assert!(text.contains("2 of 256 samples differ"), "{text}");
}

#[test]
fn unreadable_frames_give_a_warning_and_stop_nothing() {
    let two = Two::new();
    let record = with_frame(&two.before(), |_| {});
    with_frame(&two.after(), |_| {});
    assert!(two.diff().changes.is_empty());
    let mut worse = record.clone();
    worse.texels.wrong += 1;
    worse.frame = Some("frames/x.json".to_owned());
    record_all(&two.after(), &one_adapter(1), &[worse]);
    let difference = two.diff();
    let error = difference.changes[0].frame_error.as_ref().unwrap();
    assert!(error.contains("frames/x.json"), "{error}");
    assert_eq!(
        difference.warnings,
        [format!(
            "1 pair of frames of changed cases could not be compared: {error}"
        )]
    );
    assert!(two.page(&difference).contains("No pictures"));
}

#[test]
fn the_same_run_twice_is_no_change() {
    let two = Two::new();
    synthetic::write(&two.before(), 1);
    let difference = diff(&two.before(), &two.before(), None).unwrap();
    assert!(difference.changes.is_empty() && difference.only.is_empty());
    assert!(difference.warnings.is_empty(), "{:?}", difference.warnings);
    assert!(!difference.facts.iter().any(|f| f.differs()));
    assert!(
        difference
            .pairs
            .iter()
            .all(|p| p.facts.iter().all(|f| !f.differs()))
    );
    assert_eq!(difference.pairs.len(), 8);
    assert_eq!(
        difference.compared(),
        Run::read(&two.before()).unwrap().records.len() as u64
    );
    assert!(!difference.worse() && !difference.only_better());
    let text = table(&difference, TableOptions::default());
    assert!(text.contains("0 worse, 0 better, 0 other"), "{text}");
    let folders = [two.before(), two.before()];
    let path = two.folder.path().join("d.html");
    write_page(&path, &difference, [&folders[0], &folders[1]]).unwrap();
    assert!(
        fs::read_to_string(path)
            .unwrap()
            .contains("Nothing changed")
    );
}

#[test]
fn a_case_in_one_run_only_is_worse_if_the_second_run_selected_it() {
    let ids = ["a/f/c=0", "a/f/c=1", "a/f/c=2"];
    let pass = |id: &&str| Record::new(*id, "gl:a", Verdict::Pass);
    let records: Vec<Record> = ids.iter().map(pass).collect();
    let mut header = one_adapter(3);
    header.settings.selection = selection_digest(ids);
    let two = Two::new();
    record_all(&two.before(), &header, &records);
    record_all(&two.after(), &header, &records[..1]);
    let difference = two.diff();
    assert!(difference.worse());
    assert_eq!(difference.lost(), 2);
    assert_eq!(
        difference.warnings,
        ["The second run is incomplete: 2 of 3 records are missing."]
    );
    let text = table(&difference, TableOptions::default());
    assert!(text.starts_with("! The second run is incomplete"), "{text}");
    assert!(
        text.contains("✗ before only  gl:a  2 cases of a/f"),
        "{text}"
    );
    assert!(
        two.page(&difference)
            .contains("The second run is incomplete")
    );

    // The other way round nothing is lost.
    let difference = diff(&two.after(), &two.before(), None).unwrap();
    assert_eq!((difference.lost(), difference.only.len()), (0, 2));
    assert!(difference.only.iter().all(|o| o.side == RunSide::After));

    // Nor if fewer cases were selected.
    let mut fewer = one_adapter(1);
    fewer.settings.selection = selection_digest(["a/f/c=0"]);
    record_all(&two.after(), &fewer, &records[..1]);
    let difference = two.diff();
    assert!(!difference.worse());
    assert_eq!(difference.only.len(), 2);
    assert_eq!(
        difference.warnings,
        [
            "The runs are of different selections of cases: a case that one of them does not select is no finding."
        ]
    );
}

/// A run of this selection and shard with a passing record of each of these cases.
fn selected(folder: &Path, selection: &[&str], shard: Option<Shard>, recorded: &[&str]) {
    let mut header = one_adapter(selection.len() as u64);
    header.settings.selection = selection_digest(selection.iter().copied());
    header.settings.shard = shard;
    let mut writer = RunWriter::create(folder, &header).unwrap();
    writer.write_cases(selection.iter().copied()).unwrap();
    for case in recorded {
        let record = Record::new(*case, "gl:a", Verdict::Pass);
        writer.append(&record).unwrap();
    }
}

#[test]
fn a_case_that_both_runs_select_and_the_second_lacks_is_worse() {
    let two = Two::new();
    selected(&two.before(), &["a", "b", "c"], None, &["a", "b", "c"]);
    // The second run selects other cases, too, and lacks one that both select.
    selected(&two.after(), &["a", "b", "d"], None, &["a", "d"]);
    let difference = two.diff();
    let worse: Vec<(&str, bool)> = difference
        .only
        .iter()
        .map(|o| (o.case.as_str(), o.worse))
        .collect();
    assert_eq!(worse, [("b", true), ("c", false), ("d", false)]);
    assert!(difference.worse());
    // A shard must not draw a case of another shard.
    let index = 3 - shard_of("b", 2);
    let shard = Some(Shard { index, count: 2 });
    selected(&two.after(), &["a", "b", "d"], shard, &[]);
    let of_b = two.diff().only.into_iter().find(|o| o.case == "b").unwrap();
    assert!(!of_b.worse);
}

#[test]
fn an_undecided_case_is_not_green() {
    let two = Two::new();
    selected(&two.before(), &["a", "b"], None, &["a", "b"]);
    record_all(
        &two.after(),
        &one_adapter(1),
        &[Record::new("a", "gl:a", Verdict::Pass)],
    );
    let difference = two.diff();
    assert!(!difference.worse());
    let untold = "1 record of the first run alone, as the selections of cases are not known";
    assert_eq!(difference.untold, [untold]);
    let page = two.page(&difference);
    assert!(!page.contains("state good"), "{page}");
    assert!(page.contains("Nothing is shown to be worse"));
    let text = table(&difference, TableOptions::default());
    let line =
        format!("Of 1 record: 0 worse, 0 better, 0 other, 1 the same; cannot tell: {untold}.");
    assert!(text.lines().any(|l| l.trim() == line), "{text}");
    selected(&two.after(), &["a", "b"], None, &["a", "b"]);
    assert!(two.page(&two.diff()).contains("state good"));
}

#[test]
fn an_adapter_that_vanished_is_worse_and_one_that_came_is_not() {
    let two = Two::new();
    let run = |folder: &Path, names: &[&str]| {
        let adapters = names.iter().map(|name| adapter(name, Api::OpenGl));
        let header = header(1, adapters.collect());
        let records = names
            .iter()
            .map(|name| Record::new("a/b", *name, Verdict::Pass));
        record_all(folder, &header, &records.collect::<Vec<_>>());
    };
    run(&two.before(), &["gl:x", "gl:y"]);
    run(&two.after(), &["gl:x"]);
    let difference = two.diff();
    assert!(difference.worse() && !difference.only_better());
    assert!(two.page(&difference).contains("vanished: gl:y"));
    assert!(!two.page(&difference).contains("state good"));
    assert!(table(&difference, TableOptions::default()).contains("vanished: gl:y"));
    let named = diff(&two.before(), &two.after(), Some(["gl:x", "gl:x"])).unwrap();
    assert!(!named.worse(), "the other was left out on purpose");
    let back = diff(&two.after(), &two.before(), None).unwrap();
    assert!(!back.worse());
}

#[test]
fn a_run_that_was_cut_off_gives_a_warning() {
    let two = Two::new();
    let records: Vec<Record> = (0..3).map(|i| rich(&format!("a/{i}"))).collect();
    record_all(&two.before(), &one_adapter(3), &records);
    record_all(&two.after(), &one_adapter(3), &records);
    let path = two.after().join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 9]).unwrap();
    let difference = two.diff();
    assert_eq!(
        difference.warnings,
        ["The second run is incomplete: 1 of 3 records are missing."]
    );
    assert_eq!(difference.lost(), 1);
    // A line that is damaged in the middle prevents the comparison.
    fs::write(&path, text.replacen("\"case\"", "\"cas\"", 1)).unwrap();
    let error = diff(&two.before(), &two.after(), None)
        .unwrap_err()
        .to_string();
    assert!(error.contains("run.jsonl:2: "), "{error}");
}

#[test]
fn adapters_are_matched_by_name_as_the_only_ones_or_as_named() {
    let run = |folder: &Path, names: &[&str], verdict: Verdict| {
        let adapters = names.iter().map(|n| adapter(n, Api::OpenGl)).collect();
        let records: Vec<_> = names
            .iter()
            .map(|n| Record::new("a/b", *n, verdict))
            .collect();
        record_all(folder, &header(1, adapters), &records);
    };
    let two = Two::new();
    run(&two.before(), &["gl:x"], Verdict::Pass);
    run(&two.after(), &["vulkan:y"], Verdict::Fail);
    let difference = two.diff();
    assert_eq!(difference.pairs[0].adapter, ["gl:x", "vulkan:y"]);
    assert_eq!(difference.count(ChangeDirection::Worse), 1);
    assert!(table(&difference, TableOptions::default()).contains("gl:x → vulkan:y"));

    run(&two.after(), &["vulkan:y", "gl:x", "gl:z"], Verdict::Fail);
    let difference = two.diff();
    assert_eq!(difference.pairs.len(), 1);
    assert_eq!(difference.pairs[0].adapter, ["gl:x", "gl:x"]);
    assert_eq!(difference.unpaired.len(), 2);
    assert!(
        difference
            .unpaired
            .iter()
            .all(|u| u.side == RunSide::After && u.records == 1)
    );

    let named = |names| diff(&two.before(), &two.after(), Some(names));
    let difference = named(["gl:x", "gl:z"]).unwrap();
    assert_eq!(difference.pairs[0].adapter, ["gl:x", "gl:z"]);
    match named(["gl:x", "gl:q"]).unwrap_err() {
        ReportError::NoAdapter {
            path,
            adapter,
            known,
        } => {
            assert_eq!((path, &*adapter), (two.after(), "gl:q"));
            assert_eq!(known, "vulkan:y, gl:x, gl:z");
        }
        other => panic!("{other}"),
    }

    run(&two.after(), &["vulkan:y", "gl:z"], Verdict::Fail);
    let error = diff(&two.before(), &two.after(), None).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the runs have no adapter of the same name: gl:x before, vulkan:y, gl:z after; name the two to compare \
         with --adapter-before and --adapter-after"
    );
}

#[test]
fn headers_are_shown_side_by_side() {
    let two = Two::new();
    let mut new = one_adapter(1);
    new.provenance.commit = Some("9999999".to_owned());
    new.provenance.machine.cores = 8;
    new.settings.repeat = Some(3);
    new.adapters[0].info.driver_version = "26.1".to_owned();
    new.adapters[0].limits.features.clear();
    record_all(&two.before(), &one_adapter(1), &[rich("a/b")]);
    record_all(&two.after(), &new, &[rich("a/b")]);
    let difference = two.diff();
    let differ: Vec<_> = difference
        .facts
        .iter()
        .filter(|f| f.differs())
        .map(|f| f.name)
        .collect();
    assert_eq!(differ, ["commit", "cores", "settings"]);
    let differ: Vec<_> = difference.pairs[0]
        .facts
        .iter()
        .filter(|f| f.differs())
        .collect();
    let names: Vec<_> = differ.iter().map(|f| f.name).collect();
    assert_eq!(names, ["driver", "features that only one has"]);
    assert_eq!(differ[0].after, "Mesa 26.1");
    assert_eq!(
        difference.warnings,
        ["The machines differ, so times do not compare the drivers."]
    );
    let text = table(&difference, TableOptions::default());
    assert!(text.contains("commit: 0123abc → 9999999"), "{text}");
    assert!(
        text.contains("gl:a driver: Mesa 25.0.7 → Mesa 26.1"),
        "{text}"
    );
}

#[test]
fn times_are_shown_and_decide_nothing() {
    let two = Two::new();
    let records: Vec<Record> = (0..3).map(|i| rich(&format!("a/{i}"))).collect();
    let mut slow = records.clone();
    for record in &mut slow {
        record.seconds.draw *= 3.0;
        record
            .measured
            .as_mut()
            .unwrap()
            .time
            .as_mut()
            .unwrap()
            .wall *= 2.0;
    }
    record_all(&two.before(), &one_adapter(3), &records);
    record_all(&two.after(), &one_adapter(3), &slow);
    let difference = two.diff();
    assert!(!difference.worse() && difference.changes.is_empty());
    let time = &difference.times[0];
    assert_eq!((time.area.as_str(), time.cases), ("a", 3));
    assert!((time.sum[1] / time.sum[0] - 3.0).abs() < 1e-9);
    assert!((time.median[0] - 0.01).abs() < 1e-12);
    assert_eq!(difference.methods.len(), 3);
    let text = table(&difference, TableOptions::default());
    assert!(text.contains("×3.00") && text.contains("×2.00"), "{text}");
    assert!(text.contains("Only `etalon bench`"), "{text}");
    assert!(
        two.page(&difference)
            .contains("Only <code>etalon bench</code>")
    );
}

#[test]
fn runs_of_methods_are_compared() {
    let two = Two::new();
    let records = synthetic::methods::write(&two.before());
    synthetic::methods::write(&two.after());
    let difference = two.diff();
    assert!(difference.changes.is_empty());
    assert_eq!(difference.compared(), records as u64);
    assert!(
        difference.methods.len() > 20,
        "{}",
        difference.methods.len()
    );
    let text = table(&difference, TableOptions::default());
    assert!(text.contains("that changed less"), "{text}");
    assert!(two.page(&difference).contains("Frame times of methods"));
}

#[test]
fn the_json_has_stable_names() {
    let two = Two::new();
    let old = rich("a/f/c=1");
    let mut new = old.clone();
    new.verdict = Verdict::Fail;
    new.texels.wrong = 2;
    record_all(&two.before(), &one_adapter(1), &[old]);
    record_all(&two.after(), &one_adapter(1), &[new]);
    let json: Value = serde_json::to_value(two.diff()).unwrap();
    assert_eq!(json["kind"], "runs");
    let change = &json["changes"][0];
    assert_eq!(change["direction"], "worse");
    assert_eq!(change["verdict"], json!(["imprecise", "fail"]));
    assert_eq!(change["unexpected"], json!([false, true]));
    assert_eq!(change["adapter"], json!(["gl:a", "gl:a"]));
    let detail = json!({ "what": "texels", "name": "wrong", "before": 0, "after": 2 });
    assert_eq!(change["details"][0], detail);
    let pair = &json["pairs"][0];
    assert_eq!(
        pair["transitions"],
        json!([{ "verdict": ["imprecise", "fail"], "records": 1 }])
    );
    for key in [
        "adapter", "facts", "compared", "same", "worse", "better", "other", "only", "asserted",
    ] {
        assert!(!pair[key].is_null(), "{key}");
    }
    for key in [
        "warnings", "untold", "facts", "unpaired", "only", "times", "methods",
    ] {
        assert!(json[key].is_array(), "{key}");
    }
}

#[test]
fn hostile_names_stay_text() {
    let hostile = "\"><script>alert(1)</script><i class='x' onload=\"y\">&amp;\u{1b}[2J\u{7}";
    let two = Two::new();
    let mut header = header(
        2,
        vec![adapter(hostile, Api::OpenGl), adapter("b", Api::OpenGl)],
    );
    header.provenance.started = hostile.to_owned();
    header.provenance.command = vec![hostile.to_owned()];
    let id = format!("{hostile}/f/c={hostile}");
    let mut old = Record::new(&id, hostile, Verdict::Pass);
    old.counters = vec![CounterOutcome {
        name: hostile.to_owned(),
        kind: CounterKind::SamplesPassed,
        low: 0,
        high: None,
        actual: 1,
        band: None,
    }];
    let mut new = old.clone();
    new.verdict = Verdict::Fail;
    new.reasons = vec![Reason::Text(hostile.to_owned())];
    new.frame = Some("frames/<i class='x'>.json".to_owned());
    new.counters[0].actual = 2;
    let gone = Record::new(hostile, hostile, Verdict::Pass);
    old.frame = Some("frames/<i class='x'>.json.gz".to_owned());
    record_all(&two.before(), &header, &[old, gone]);
    header.provenance.commit = Some(hostile.to_owned());
    record_all(&two.after(), &header, &[new]);
    let difference = two.diff();
    assert_eq!(difference.changes.len(), 1);
    let page = two.page(&difference);
    assert!(!page.contains("<script") && !page.contains("<i class='x'"));
    assert!(!page.contains("http://") && !page.contains("https://"));
    let text = table(&difference, TableOptions::default());
    assert!(!text.contains(['\u{1b}', '\u{7}']), "{text:?}");
}

#[test]
fn large_differences_stay_small() {
    let two = Two::new();
    synthetic::write(&two.before(), 1);
    synthetic::write(&two.after(), 1);
    let run = Run::read(&two.after()).unwrap();
    let mut writer = RunWriter::create(&two.after(), &run.header).unwrap();
    for (i, record) in run.records.iter().enumerate() {
        let mut record = record.clone();
        if i % 2 == 0 {
            record.verdict = Verdict::ALL[i / 2 % Verdict::ALL.len()];
        }
        writer.append(&record).unwrap();
    }
    let difference = two.diff();
    assert!(
        difference.changes.len() > 1000,
        "{}",
        difference.changes.len()
    );
    let sum: u64 = ChangeDirection::ALL
        .iter()
        .map(|d| difference.count(*d))
        .sum();
    assert_eq!(sum, difference.changes.len() as u64);
    let order: Vec<_> = difference.changes.iter().map(|c| c.direction).collect();
    assert!(order.is_sorted());
    let page = two.page(&difference);
    assert!(page.len() < 8 << 20, "{}", page.len());
    let text = table(&difference, TableOptions::default());
    assert!(text.lines().count() < 400, "{}", text.lines().count());
    for width in [40, 80] {
        let narrow = table(&difference, TableOptions { width, color: true });
        assert!(narrow.contains("\u{1b}[31m"));
    }
}

fn any_record() -> impl Strategy<Value = Record> {
    let verdict = prop::sample::select(Verdict::ALL.to_vec());
    let parts = (
        0..12_u8,
        0..3_u8,
        verdict,
        any::<[bool; 3]>(),
        0..300_u64,
        any::<f64>(),
    );
    parts.prop_map(
        |(case, on, verdict, [expected, due_fail, rich_one], wrong, mean)| {
            let id = format!("a/f/c={case}");
            let mut record = if rich_one {
                rich(&id)
            } else {
                Record::new(&id, "", verdict)
            };
            record.adapter = format!("gl:{on}");
            record.verdict = verdict;
            record.due_fail = due_fail;
            record.expected = expected.then(|| Expected {
                reason: "known".to_owned(),
            });
            record.texels.wrong = wrong;
            if let (Some(a), true) = (record.accuracy.first_mut(), mean.is_finite()) {
                a.mean = mean;
            }
            record
        },
    )
}

fn any_run() -> impl Strategy<Value = Vec<Record>> {
    prop::collection::vec(any_record(), 0..30)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Comparing any run with itself gives no change; any two runs give figures that add up, a page and a
    /// text.
    #[test]
    fn any_two_runs_can_be_compared(old in any_run(), new in any_run()) {
        let two = Two::new();
        record_all(&two.before(), &one_adapter(12), &old);
        record_all(&two.after(), &one_adapter(12), &new);
        let unchanged = diff(&two.before(), &two.before(), None).unwrap();
        prop_assert!(unchanged.changes.is_empty() && unchanged.only.is_empty() && unchanged.unpaired.is_empty());
        prop_assert!(!unchanged.worse() && !unchanged.only_better());
        let difference = two.diff();
        for pair in &difference.pairs {
            prop_assert_eq!(pair.compared, pair.same + pair.worse + pair.better + pair.other);
        }
        let better_back = diff(&two.after(), &two.before(), None).unwrap();
        prop_assert_eq!(difference.changes.len(), better_back.changes.len());
        prop_assert_eq!(difference.compared(), better_back.compared());
        let text = table(&difference, TableOptions::default());
        prop_assert!(text.ends_with('\n'));
        prop_assert!(two.page(&difference).contains("</html>"));
    }
}
