//! Bench folders that are written, cut off and damaged.

use etalon_record::{
    BENCH_FORMAT, Bench, BenchHeader, BenchLine, BenchWriter, Done, Ended, Enough, FolderKind,
    OutputFolder, Picture, Provenance, Reason, RecordError, Round, ShaderCache, Time, Verdict,
};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn header() -> BenchHeader {
    let adapter = json!({
        "name": "cpu", "backend": "cpu", "device": "d", "driver": "etalon", "driver_version": "1",
        "api_version": "1", "software": true,
        "limits": { "api": "vulkan", "sub_pixel_bits": 8, "max_size": 1024,
            "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
    });
    BenchHeader {
        format: BENCH_FORMAT,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            started: "2026-01-01T00:00:00Z".to_owned(),
            command: vec!["etalon".to_owned(), "bench".to_owned()],
            ..Provenance::default()
        },
        profile: "quick".to_owned(),
        cases: 1,
        rounds: 3,
        shader_cache: ShaderCache::Cold,
        ruler: "counting".to_owned(),
        limits: Vec::new(),
        settings: Default::default(),
        adapters: vec![serde_json::from_value(adapter).unwrap()],
        absent: Vec::new(),
    }
}

fn picture(verdict: Verdict) -> BenchLine {
    BenchLine::Picture(Picture {
        case: "perf/a".to_owned(),
        adapter: "cpu".to_owned(),
        verdict,
        asserted: 1.0,
        reasons: Vec::new(),
        work: None,
        accuracy: Vec::new(),
    })
}

fn round(number: u32) -> Round {
    Round {
        case: "perf/a".to_owned(),
        adapter: "cpu".to_owned(),
        round: number,
        at: f64::from(number),
        ruler: [0.002, 0.008],
        prepare: 0.5,
        first: 0.25,
        warm_up: 4,
        wall: vec![0.1, 0.2],
        cpu: vec![0.05, 0.06],
        gpu: Vec::new(),
        clock: None,
        read_back: Vec::new(),
    }
}

fn written(folder: &Path, lines: &[BenchLine]) -> Result<Bench, RecordError> {
    let mut writer = BenchWriter::create(folder, &header()).unwrap();
    lines.iter().for_each(|l| writer.append(l).unwrap());
    Bench::read(folder)
}

#[test]
fn rounds_that_are_enough_are_not_missing() {
    let folder = tempfile::tempdir().unwrap();
    let done = |enough| {
        BenchLine::Done(Done {
            case: "perf/a".to_owned(),
            adapter: "cpu".to_owned(),
            enough,
        })
    };
    let first = [picture(Verdict::Pass), BenchLine::Round(round(0))];
    let open = written(folder.path(), &first).unwrap();
    assert!(open.missing() > 0 && open.records[0].is_open());
    for enough in [Enough::Within, Enough::Limit] {
        let lines = [first.as_slice(), &[done(enough)]].concat();
        let bench = written(folder.path(), &lines).unwrap();
        assert_eq!(bench.records[0].enough, Some(enough));
        assert_eq!((bench.missing(), bench.records[0].is_open()), (0, false));
        let more = [lines.as_slice(), &[BenchLine::Round(round(1))]].concat();
        assert!(written(folder.path(), &more).is_err());
    }
}

#[test]
fn a_written_bench_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("below/bench");
    let lines = [
        picture(Verdict::Pass),
        BenchLine::Round(round(0)),
        BenchLine::Round(Round {
            gpu: vec![0.01, 0.02],
            ..round(1)
        }),
    ];
    let bench = written(&path, &lines).unwrap();
    assert_eq!(FolderKind::of(&path), Some(FolderKind::Bench));
    assert_eq!(bench.header, header());
    assert!(!bench.truncated);
    assert_eq!(bench.missing(), 1);
    let record = bench.record("perf/a", "cpu").unwrap();
    assert_eq!(record.discarded(), 8);
    assert_eq!(record.samples(Time::Wall), [[0.1, 0.2], [0.1, 0.2]]);
    assert_eq!(record.samples(Time::Gpu), [[0.01, 0.02]]);
    assert_eq!(record.samples(Time::Prepare), [[0.5], [0.5]]);
    assert!(record.samples(Time::ReadBack).is_empty());
    assert_eq!(
        (
            record.rulers(Time::Wall).len(),
            record.rulers(Time::Gpu).len()
        ),
        (2, 1)
    );
    assert!((round(0).ruler_time() - 0.004).abs() < 1e-12);
}

#[test]
fn a_killed_bench_is_a_readable_prefix() {
    let folder = tempfile::tempdir().unwrap();
    let lines = [
        picture(Verdict::Pass),
        BenchLine::Round(round(0)),
        BenchLine::Round(round(1)),
    ];
    written(folder.path(), &lines).unwrap();
    let path = folder.path().join("bench.jsonl");
    let complete = fs::read(&path).unwrap();
    fs::write(&path, &complete[..complete.len() - 30]).unwrap();
    let bench = Bench::read(folder.path()).unwrap();
    assert!(bench.truncated);
    assert_eq!(bench.records[0].rounds.len(), 1);
    // A damaged line in the middle is an error.
    let mut more = complete[..complete.len() - 30].to_vec();
    more.push(b'\n');
    more.extend_from_slice(b"{}\n");
    fs::write(&path, more).unwrap();
    let (line, _) = wrong_line(Bench::read(folder.path()).unwrap_err());
    assert_eq!(line, 4);
}

/// Returns the line and the message of an error in `bench.jsonl`.
#[track_caller]
fn wrong_line(error: RecordError) -> (usize, String) {
    match error {
        RecordError::Parse {
            path,
            line,
            message,
            ..
        } if path.ends_with("bench.jsonl") => (line, message),
        other => panic!("{other}"),
    }
}

#[test]
fn impossible_lines_are_refused_with_file_and_line() {
    let pass = || picture(Verdict::Pass);
    let lines_with = |change: &dyn Fn(&mut Round)| {
        let mut round = round(0);
        change(&mut round);
        vec![pass(), BenchLine::Round(round)]
    };
    let ended = || {
        BenchLine::Ended(Ended {
            case: "perf/a".to_owned(),
            adapter: "cpu".to_owned(),
            verdict: Verdict::Crash,
            reasons: Vec::new(),
        })
    };
    let elsewhere = || match pass() {
        BenchLine::Picture(p) => BenchLine::Picture(Picture {
            adapter: "gl".to_owned(),
            ..p
        }),
        other => other,
    };
    for (lines, line_number, message) in [
        (
            vec![BenchLine::Round(round(0))],
            2,
            r#"no picture of "perf/a" on "cpu" was judged before this"#,
        ),
        (
            vec![picture(Verdict::Fail), BenchLine::Round(round(0))],
            3,
            r#""perf/a" on "cpu" has the verdict fail and so no frame times"#,
        ),
        (
            vec![picture(Verdict::Open), BenchLine::Round(round(0))],
            3,
            r#""perf/a" on "cpu" has the verdict open and so no frame times"#,
        ),
        (
            vec![pass(), pass()],
            3,
            r#"a second picture of "perf/a" on "cpu""#,
        ),
        (vec![elsewhere()], 2, r#"the header names no adapter "gl""#),
        (
            vec![pass(), BenchLine::Round(round(1))],
            3,
            "round 1 instead of round 0",
        ),
        (
            vec![pass(), ended(), BenchLine::Round(round(0))],
            4,
            r#""perf/a" on "cpu" already ended before this line"#,
        ),
        (lines_with(&|r| r.wall[1] = 0.0), 3, "a time of 0 s"),
        (lines_with(&|r| r.ruler[0] = -1.0), 3, "a time of -1 s"),
        (
            lines_with(&|r| r.cpu.truncate(1)),
            3,
            "2 wall times, 1 cpu times and 0 gpu times of the same frames",
        ),
        (
            lines_with(&|r| r.gpu.push(0.1)),
            3,
            "2 wall times, 2 cpu times and 1 gpu times of the same frames",
        ),
        (
            lines_with(&|r| r.wall.clear()),
            3,
            "a round without a sample",
        ),
        (
            lines_with(&|r| r.at = -1.0),
            3,
            "a round that began at -1 s",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let error = written(folder.path(), &lines).unwrap_err();
        assert_eq!(wrong_line(error), (line_number, message.to_owned()));
    }
}

#[test]
fn the_messages_of_earlier_formats_are_read_as_text() {
    let line = r#"{"picture":{"case":"perf/a","adapter":"cpu","verdict":"fail","asserted":1.0,"message":"9 samples"}}"#;
    let BenchLine::Picture(picture) = serde_json::from_str(line).unwrap() else {
        panic!("a picture");
    };
    assert_eq!(picture.reasons, [Reason::Text("9 samples".to_owned())]);
    let line =
        r#"{"ended":{"case":"perf/a","adapter":"cpu","verdict":"crash","message":"signal 11"}}"#;
    let BenchLine::Ended(ended) = serde_json::from_str(line).unwrap() else {
        panic!("an end");
    };
    assert_eq!(ended.reasons, [Reason::Text("signal 11".to_owned())]);
}

#[test]
fn unknown_keys_and_other_formats_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.jsonl");
    let mut line: Value = serde_json::to_value(header()).unwrap();
    line["format"] = json!(99);
    fs::write(&path, line.to_string()).unwrap();
    let error = Bench::read(folder.path()).unwrap_err();
    assert!(
        matches!(error, RecordError::Format { found: 99, .. }),
        "{error}"
    );
    line["format"] = json!(BENCH_FORMAT);
    line["more"] = json!(1);
    fs::write(&path, line.to_string()).unwrap();
    let (number, message) = wrong_line(Bench::read(folder.path()).unwrap_err());
    assert_eq!(number, 1);
    assert!(message.starts_with("unknown field `more`"), "{message}");
}

#[test]
fn a_bench_replaces_a_bench_and_no_run() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(
        Bench::read(folder.path()),
        Err(RecordError::NoBench { .. })
    ));
    written(folder.path(), &[picture(Verdict::Pass)]).unwrap();
    fs::write(folder.path().join("bencher.json"), "{}").unwrap();
    fs::write(folder.path().join("mine.txt"), "").unwrap();
    let refused = BenchWriter::create(folder.path(), &header()).unwrap_err();
    assert!(matches!(refused, RecordError::NotOurs { .. }), "{refused}");
    fs::remove_file(folder.path().join("bencher.json")).unwrap();
    let out = OutputFolder::open(folder.path()).unwrap();
    out.write("bencher.json", b"{}").unwrap();
    drop(BenchWriter::create(folder.path(), &header()).unwrap());
    let bench = Bench::read(folder.path()).unwrap();
    assert!(bench.records.is_empty());
    assert!(
        !folder.path().join("bencher.json").exists() && folder.path().join("mine.txt").exists()
    );

    let run = tempfile::tempdir().unwrap();
    fs::write(run.path().join("run.jsonl"), "{\"etalon\":\"0\"}\n").unwrap();
    assert_eq!(FolderKind::of(run.path()), Some(FolderKind::Run));
    let error = BenchWriter::create(run.path(), &header()).unwrap_err();
    assert!(matches!(error, RecordError::Holds { .. }), "{error}");
}
