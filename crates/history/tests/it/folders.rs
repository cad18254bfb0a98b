//! Folders that `etalon run`, `bench` and `bisect` wrote.

use etalon_frame::{AdapterInfo, Api, ApiVersion, Limits};
use etalon_history::{
    FrameTimes, History, HistoryError, Kind, NewRun, ReleaseDates, Writer, read_runs,
};
use etalon_record::{
    AdapterRecord, Bench, Header, Measured, Provenance, Record, Release, Run, Times, Verdict,
};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::Write;
use std::path::Path;

fn read(path: &Path) -> Result<Vec<NewRun>, HistoryError> {
    read_runs(path, &ReleaseDates::default())
}

fn header(cases: u64) -> Header {
    Header {
        format: 3,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            commit: Some("abc".to_owned()),
            started: "2026-11-23T06:09:58Z".to_owned(),
            command: vec!["etalon".to_owned()],
            ..Provenance::default()
        },
        cases,
        settings: Default::default(),
        adapters: vec![AdapterRecord {
            info: AdapterInfo {
                name: "vulkan:a@2".to_owned(),
                backend: "vulkan".to_owned(),
                device: "device".to_owned(),
                driver: "driver".to_owned(),
                driver_version: "1.2.3".to_owned(),
                api_version: "1.3".to_owned(),
                software: true,
                ..AdapterInfo::default()
            },
            release: Some(Release {
                line: "a".to_owned(),
                version: "2".to_owned(),
            }),
            limits: Limits {
                version: ApiVersion::new(3, 2),
                sub_pixel_bits: 8,
                max_size: 4096,
                max_color_attachments: 8,
                sample_positions: [(1, vec![[128, 128]])].into(),
                ..Limits::nothing(Api::OpenGlEs)
            },
        }],
        absent: Vec::new(),
    }
}

fn lines(header: &Header, records: &[Record]) -> String {
    let mut text = serde_json::to_string(header).unwrap() + "\n";
    for record in records {
        text += &serde_json::to_string(record).unwrap();
        text.push('\n');
    }
    text
}

fn records() -> Vec<Record> {
    let mut measured = Record::new("methods/q/s/method=m", "vulkan:a@2", Verdict::Measured);
    measured.measured = Some(Measured {
        question: "q".to_owned(),
        scene: "s".to_owned(),
        method: "m".to_owned(),
        parameter: None,
        distance: Default::default(),
        time: Some(Times {
            samples: 9,
            wall: 0.25,
            cpu: 0.125,
            gpu: None,
            interval: Some([0.2, 0.3]),
        }),
        sizes: Vec::new(),
        cost: None,
        passes: 1,
        draws: 2,
        fragments: None,
        bytes: 64,
        picture: None,
        truth_picture: None,
    });
    vec![
        Record::new("depth/a", "vulkan:a@2", Verdict::Pass),
        measured,
    ]
}

#[test]
fn a_run_is_the_same_packed_or_not_and_by_any_name() {
    let folder = tempfile::tempdir().unwrap();
    let text = lines(&header(2), &records());
    fs::write(folder.path().join("run.jsonl"), &text).unwrap();
    let renamed = folder.path().join("night");
    let mut packed = GzEncoder::new(fs::File::create(&renamed).unwrap(), Compression::fast());
    packed.write_all(text.as_bytes()).unwrap();
    packed.finish().unwrap();
    let runs = read(folder.path()).unwrap();
    assert_eq!(runs, read(&renamed).unwrap());
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    fs::rename(&renamed, inner.join("run.jsonl.gz")).unwrap();
    assert_eq!(runs, read(&inner).unwrap());

    let [run] = &runs[..] else { panic!("{runs:?}") };
    assert_eq!((run.kind, run.missing), (Kind::Run, 0));
    let [part] = &run.adapters[..] else {
        panic!("{run:?}")
    };
    // An adapter of a run keeps its name, whatever release it has.
    assert_eq!(part.timeline, "vulkan:a@2");
    assert_eq!(
        (part.adapter.line.as_str(), part.adapter.shown_version()),
        ("a", "2")
    );
    assert_eq!(part.outcomes["depth/a"].verdict, Verdict::Pass);
    let expected = FrameTimes {
        frames: 9,
        wall: vec![0.25],
        cpu: vec![0.125],
        interval: Some([0.2, 0.3]),
        ..FrameTimes::default()
    };
    assert_eq!(part.times.len(), 1);
    assert_eq!(part.times["methods/q/s/method=m"], expected);
    let method = part.outcomes["methods/q/s/method=m"]
        .measures
        .method
        .unwrap();
    assert_eq!((method.passes, method.draws, method.bytes), (1, 2, 64));
}

#[test]
fn a_half_written_run_says_what_it_lacks_and_has_the_header_of_the_whole_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.jsonl");
    let text = lines(&header(2), &records());
    fs::write(&path, &text[..text.len() - 20]).unwrap();
    let half = read(folder.path()).unwrap().remove(0);
    fs::write(&path, &text).unwrap();
    let complete = read(folder.path()).unwrap().remove(0);
    assert_eq!((half.missing, complete.missing), (1, 0));
    assert_eq!(half.header, complete.header);
    assert_ne!(half.digest, complete.digest);
}

#[test]
fn damage_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.jsonl");
    let mut other = records();
    other[1].adapter = "gl:none".to_owned();
    let mut timeless = header(2);
    timeless.provenance.started = "soon".to_owned();
    for (text, expected) in [
        (
            lines(&header(2), &other),
            "run.jsonl:3: the header names no adapter \"gl:none\"",
        ),
        (
            lines(&timeless, &records()),
            "run.jsonl:1: \"soon\" is not a time",
        ),
        (
            lines(&header(2), &records()).replace("\"pass\"", "\"well\""),
            "run.jsonl:2: ",
        ),
        ("{}\n".to_owned(), "holds no run.jsonl"),
        ("".to_owned(), "holds no run.jsonl"),
        ("\u{1f}\u{8b} no gzip".to_owned(), "holds no run.jsonl"),
        (
            lines(&header(2), &[]).replace("\"format\":3", "\"format\":99"),
            "format 99",
        ),
    ] {
        fs::write(&path, text).unwrap();
        let error = read(folder.path()).unwrap_err().to_string();
        assert!(error.contains(expected) && !error.contains('\n'), "{error}");
    }
    fs::write(&path, b"\x1f\x8b\x08 damaged").unwrap();
    assert!(read(folder.path()).is_err());
    fs::remove_file(&path).unwrap();
    for none in [folder.path().to_owned(), folder.path().join("none")] {
        let error = read(&none).unwrap_err().to_string();
        assert!(error.contains(none.to_str().unwrap()), "{error}");
    }
}

#[test]
fn releases_of_a_line_are_runs_of_one_timeline_by_their_dates() {
    let text = r#"{"format":1,"etalon":"0.1.0","machine":{"os":"","cpu":"","cores":1},"started":"2026-11-23T06:09:58Z","command":["etalon"],"line":"swift","releases":[{"version":"103.0.0","adapter":"vulkan:swift@103.0.0","driver":"Swift"},{"version":"106.0.2","adapter":"vulkan:swift@106.0.2","driver":"Swift"},{"version":"110.0.1","adapter":"vulkan:swift@110.0.1","driver":"Swift"}]}
{"case":"depth/a","verdicts":["fail","fail","pass"],"finding":"a-bug"}
{"case":"depth/b","verdicts":["pass",null,"pass"]}
"#;
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("versions.jsonl"), text).unwrap();
    let dates = r#"{"swift": {"103.0.0": "2022-06-21", "106.0.2": "2022-09-27"}}"#;
    let dates = ReleaseDates::parse(Path::new("dates"), dates).unwrap();
    let mut runs = read_runs(folder.path(), &dates).unwrap();
    assert_eq!(runs.len(), 3);
    // Although added newest first, they are ordered by date; one without a date is placed at its drawing
    // time.
    runs.reverse();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    for run in &runs {
        writer.add(run).unwrap();
    }
    let history = History::open_read(&path).unwrap();
    let points_of = |case: &str| {
        let found = history.case_history(case, Some("vulkan:swift")).unwrap();
        let points = found[0].points.iter().map(|p| {
            let outcome = history.outcome(p.outcome).unwrap();
            let version = p.adapter(&history).adapter.shown_version().to_owned();
            (
                version,
                outcome.verdict,
                outcome.inferred,
                outcome.expected.clone(),
            )
        });
        points.collect::<Vec<_>>()
    };
    let known = Some("a-bug".to_owned());
    assert_eq!(
        points_of("depth/a"),
        [
            ("103.0.0".to_owned(), Verdict::Fail, false, known.clone()),
            ("106.0.2".to_owned(), Verdict::Fail, false, known),
            ("110.0.1".to_owned(), Verdict::Pass, false, None),
        ]
    );
    assert_eq!(
        points_of("depth/b")[1],
        ("106.0.2".to_owned(), Verdict::Pass, true, None)
    );
}

#[test]
fn recorded_runs_of_the_repository_can_be_added() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports");
    let mut added = 0;
    for kept in [
        "versions/softpipe.jsonl.gz",
        "methods/run.jsonl.gz",
        "early-and-order",
    ] {
        let runs = read(&root.join(kept)).unwrap();
        added += runs.len();
        for run in runs {
            assert_eq!(run.missing, 0, "{kept}");
            assert!(
                run.adapters.iter().all(|a| !a.outcomes.is_empty()),
                "{kept}"
            );
        }
    }
    assert!(added >= 6, "{added}");
}

#[test]
fn benches_are_read_into_a_history_as_the_record_crate_reads_them() {
    // A round's medians are next to its ruler.
    let picture =
        r#"{"picture":{"case":"perf/a","adapter":"vulkan:a@2","verdict":"pass","asserted":1.0}}"#;
    let other = picture.replace("perf/a", "depth/a");
    let round = |case: &str, n: u32| {
        format!(
            r#"{{"round":{{"case":"{case}","adapter":"vulkan:a@2","round":{n},"at":0.5,"ruler":[1.0,4.0],"prepare":1.0,"first":1.0,"warm_up":2,"wall":[3.0,1.0,2.0],"cpu":[0.5,0.5,0.5]}}}}"#
        )
    };
    let run = header(2);
    let head = serde_json::json!({
        "format": 1, "etalon": "0.1.0", "machine": run.provenance.machine, "started": run.provenance.started, "command": run.provenance.command,
        "profile": "quick", "cases": 2, "rounds": 2, "shader_cache": "warm", "ruler": "sums", "adapters": run.adapters,
        "absent": [],
    });
    let text = [
        head.to_string(),
        picture.to_owned(),
        other,
        round("perf/a", 0),
        round("depth/a", 0),
        round("perf/a", 1),
        round("depth/a", 1),
    ];
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bench.jsonl"), text.join("\n") + "\n").unwrap();
    let bench = read(folder.path()).unwrap().remove(0);
    assert_eq!((bench.kind, bench.missing), (Kind::Bench, 0));
    assert_eq!(bench.ruler.as_deref(), Some("sums"));
    let part = &bench.adapters[0];
    assert_eq!(part.outcomes.len(), 2);
    assert_eq!(part.times.len(), 1, "times of other areas are not kept");
    let expected = FrameTimes {
        frames: 6,
        wall: vec![2.0, 2.0],
        cpu: vec![0.5, 0.5],
        ruler: vec![2.0, 2.0],
        ..FrameTimes::default()
    };
    assert_eq!(part.times["perf/a"], expected);
    assert_eq!(Bench::read(folder.path()).unwrap().records.len(), 2);
    assert!(Run::read(folder.path()).is_err());
}

#[cfg(unix)]
#[test]
fn no_run_is_read_through_a_link_in_a_folder_and_no_pipe_is_waited_for() {
    let work = tempfile::tempdir().unwrap();
    let elsewhere = work.path().join("elsewhere");
    for name in ["run.jsonl", "run.jsonl.gz"] {
        let folder = work.path().join(format!("folder-{name}"));
        fs::create_dir(&folder).unwrap();
        fs::write(&elsewhere, "{\"format\":3}\n").unwrap();
        std::os::unix::fs::symlink(&elsewhere, folder.join(name)).unwrap();
        let said = read(&folder).unwrap_err().to_string();
        assert!(said.contains("is a link") && said.contains(name), "{said}");
    }
    let pipe = work.path().join("pipe");
    let status = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(status.unwrap().success());
    let refused = read(&pipe).unwrap_err();
    assert!(matches!(refused, HistoryError::NoRun { .. }), "{refused}");
    for opened in [Writer::open(&pipe).err(), History::open_read(&pipe).err()] {
        assert!(
            matches!(opened, Some(HistoryError::Other { .. })),
            "{opened:?}"
        );
    }
}
