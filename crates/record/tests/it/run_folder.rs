//! Run folders: written and read, cut off, resumed and replaced.

use etalon_frame::{
    Accuracy, AdapterInfo, Api, ApiVersion, Aspect, Band, ChannelEncoding, ChannelMismatch,
    CounterKind, CounterOutcome, DepthTest, Distance, Effect, ErrorKind, Event, Limits, Origin,
    Rejection, Requirement, SceneName, SizedDistance, Step, Story, TexelCounts, TextureFormat,
    ToldLine, ValueRange, WrongTexel,
};
use etalon_record::{
    AdapterRecord, Assertion, Bench, Clock, ComparedPair, Content, Cost, Dead, Denial, Estimate,
    ExitStatus, Expected, FORMAT, FailedRoundTrip, FolderKind, FrameFile, FrameImage, Fresh,
    Header, Hunt, MAX_LINE, MAX_WRONG_TEXELS, Measured, OutputFolder, Parameter, ProcessEnd,
    Provenance, Reason, Record, RecordError, Run, RunWriter, Seconds, Settings, Shard, SizedFrame,
    Times, Verdict, Versions, beside, read_cases, selection_digest,
};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

fn header() -> Header {
    Header {
        format: FORMAT,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            started: "2026-01-02T03:04:05Z".to_owned(),
            command: vec!["etalon".to_owned(), "run".to_owned()],
            ..Provenance::default()
        },
        cases: 3,
        settings: Settings::default(),
        adapters: vec![AdapterRecord {
            info: AdapterInfo {
                name: "gl:es:soft".to_owned(),
                backend: "gl".to_owned(),
                device: "d".to_owned(),
                driver: "Mesa".to_owned(),
                driver_version: "25".to_owned(),
                driver_id: "7".to_owned(),
                api_version: "3.2".to_owned(),
                software: true,
                ..AdapterInfo::default()
            },
            release: None,
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

/// Returns the name of the file that does not parse, the line and the message.
#[track_caller]
fn wrong_line(error: RecordError) -> (String, usize, String) {
    match error {
        RecordError::Parse {
            path,
            line,
            message,
            ..
        } => {
            let name = path.file_name().unwrap().to_str().unwrap();
            (name.to_owned(), line, message)
        }
        other => panic!("{other}"),
    }
}

/// Returns the line and the message of an error in `run.jsonl`.
#[track_caller]
fn wrong_in_run(folder: &Path) -> (usize, String) {
    let (name, line, message) = wrong_line(Run::read(folder).unwrap_err());
    assert_eq!(name, "run.jsonl");
    (line, message)
}

fn wrong_texel(attachment: String, x: u32, code: u32) -> WrongTexel {
    WrongTexel {
        x,
        y: 1,
        sample: 0,
        band: Band::Fail,
        channels: vec![ChannelMismatch {
            attachment,
            aspect: Aspect::Depth,
            channel: 0,
            encoding: ChannelEncoding::Unorm(16),
            low: 0,
            high: 7,
            actual: code,
        }],
    }
}

prop_compose! {
    fn story()(
        lines in prop::collection::vec((".*", ".{0,40}", ".*", prop::option::of(".*")), 0..4),
        events in prop::collection::vec((any::<[usize; 2]>(), ".*", any::<[f64; 2]>(), prop::option::of(".*")), 0..4),
        cut in any::<bool>(),
    ) -> Story {
        let line = |(at, operation, detail, citation)| ToldLine { at, operation, detail, citation };
        let event = |([pass, draw], compare, [low, high], citation): ([usize; 2], String, [f64; 2], Option<String>)| Event {
            scene: Some(SceneName::Variant(compare.clone())),
            origin: Origin::Draw { pass, draw, primitives: vec![0] },
            step: Step::DepthTest(DepthTest::Compared {
                compare,
                incoming: ValueRange { low, high },
                stored: ValueRange { low: f64::NEG_INFINITY, high: f64::INFINITY },
            }),
            effect: Effect::Rejects(Rejection::Depth),
            citation,
        };
        Story {
            ruling: None,
            alone: Vec::new(),
            events: events.into_iter().map(event).collect(),
            cut,
            told: lines.into_iter().map(line).collect(),
        }
    }
}

/// A number that JSON keeps to the last bit.
fn eighths(n: u64) -> f64 {
    (n % 4096) as f64 / 8.0
}

fn estimate(n: u64) -> Estimate {
    Estimate {
        median: eighths(n),
        interval: n.is_multiple_of(2).then_some([0.25, 0.5]),
    }
}

/// Frames of sizes: one that was drawn, and one that was not.
fn sized(f: &[u64; 7]) -> Vec<SizedFrame> {
    let drawn = SizedFrame {
        size: [1280, 720],
        time: None,
        distance: Some(SizedDistance {
            texels: f[1],
            rmse: eighths(f[2]),
            max: eighths(f[3]),
        }),
        reason: None,
    };
    let left_out = SizedFrame {
        size: [f[0] as u32, f[1] as u32],
        time: None,
        distance: None,
        reason: Some(if f[4].is_multiple_of(2) {
            Reason::LargeFrames(f[5])
        } else {
            Reason::LongFrames(eighths(f[5]))
        }),
    };
    [drawn, left_out]
        .into_iter()
        .take(f[6] as usize % 3)
        .collect()
}

/// Measurements, with and without the optional ones.
fn measured(f: &[u64; 7]) -> Measured {
    let even = |n: u64| n.is_multiple_of(2);
    Measured {
        question: format!("question {}", f[0]),
        scene: "scene".to_owned(),
        method: "method".to_owned(),
        parameter: even(f[1]).then(|| Parameter {
            name: "k".to_owned(),
            value: eighths(f[2]),
        }),
        distance: Distance {
            rmse: eighths(f[3]),
            max: 1.0,
            flip: 0.1,
            wrong: 0.25,
            truth_error: 0.0,
        },
        time: even(f[4]).then(|| Times {
            samples: f[5] as u32,
            wall: eighths(f[6]),
            cpu: 0.001,
            gpu: even(f[5]).then_some(0.002),
            interval: even(f[4]).then_some([0.25, 0.5]),
        }),
        sizes: sized(f),
        cost: even(f[2]).then(|| Cost {
            clock: if even(f[1]) {
                Clock::Device
            } else {
                Clock::Wall
            },
            fixed: estimate(f[3]),
            per_megapixel: estimate(f[4]),
            deviation: even(f[5]).then(|| eighths(f[0])),
        }),
        passes: f[0] as u32,
        draws: f[1] as u32,
        fragments: even(f[3]).then_some(f[2]),
        bytes: f[6],
        picture: even(f[6]).then(|| "pictures/a.png".to_owned()),
        truth_picture: even(f[0]).then(|| "pictures/truth.png".to_owned()),
    }
}

prop_compose! {
    fn record()(
        (case, adapter) in ("[a-z/=.0-9]{1,40}", ".{1,20}"),
        verdict in prop::sample::select(Verdict::ALL.to_vec()),
        improves in prop::option::of(prop::sample::select(Verdict::ALL.to_vec())),
        expected in prop::option::of(".*"),
        due_fail in any::<bool>(),
        message in ".*",
        counts in any::<[u64; 4]>(),
        figures in prop::collection::vec(any::<[u64; 7]>(), 0..3),
        wrong in prop::collection::vec((".{0,9}", any::<u32>(), any::<u32>()), 0..5),
        story in prop::option::of(story()),
        frame in prop::option::of("frames(/[a-z,.=_-]{1,9}[a-z]){0,2}/[a-z]{1,9}\\.json(\\.gz)?"),
        seconds in any::<[u32; 2]>(),
        (lost, said) in (
            prop::option::of((prop::option::of(any::<i32>()), ".*")),
            prop::collection::vec(".*", 0..3),
        ),
    ) -> Record {
        let error = message.strip_prefix('e').map(|rest| ErrorKind::Resource {
            object: rest.chars().take(20).collect(), code: improves.map(|v| v.name().to_owned()),
        });
        let denial = Denial {
            needed: Requirement::Samples(TextureFormat::Rgba8Unorm, 4), api: Api::OpenGl,
            version: ApiVersion::new(4, 6), citation: message.clone(),
        };
        let reasons = vec![
            Reason::Missing(denial.needed),
            Reason::Denied(denial),
            Reason::NotRequired(Api::Vulkan, ApiVersion::new(1, 3)),
            Reason::OutOfTime(0.5),
            Reason::NoAnswer(60.0),
            Reason::PartsDisagree(verdict, Verdict::Pass),
            Reason::Flaky { verdicts: vec![verdict], fresh: Fresh::Process },
            Reason::Difference {
                samples: counts[0], pair: ComparedPair::Attachments(message.clone(), String::new()),
                citation: String::new(),
            },
            Reason::FailedRoundTrips(vec![FailedRoundTrip {
                case: message.clone(), verdict, wrong: None, why: vec![Reason::Process(Box::default())],
            }]),
            Reason::Text(message),
        ];
        let assertion = |f: [u64; 7]| Assertion {
            aspect: Aspect::Stencil,
            channels: f[0], asserted: f[1], exact: f[2], codes: f[3],
            yardstick_exact: f[4], yardstick_codes: f[5], yardstick_asserted: f[6],
        };
        let accuracy = |f: &[u64; 7]| Accuracy {
            channels: f[0], mean: eighths(f[1]), max: eighths(f[2]), overflow: f[4],
            spread: vec![f[5], f[6]].try_into().unwrap(),
            ..Accuracy::none(Aspect::Depth, f[3].is_multiple_of(2).then_some(ChannelEncoding::Unorm(24)))
        };
        Record {
            process: lost.map(|(signal, stderr)| ProcessEnd {
                signal, exit: signal.map(|s| !s), stderr, seconds: 0.25,
                launcher: signal.map(|s| ExitStatus { signal: Some(s), exit: None }),
                limit: signal.map(f64::from), ..ProcessEnd::default()
            }),
            error,
            look: said.first().cloned(),
            example: said.last().cloned(),
            validation: said.clone(),
            after: said.clone(),
            blocked_by: said,
            repeats: improves.into_iter().collect(),
            case, adapter, verdict, improves, due_fail, reasons, story, frame,
            expected: expected.map(|reason| Expected { reason }),
            texels: TexelCounts { total: counts[0], wrong: counts[1], imprecise: counts[2], open: counts[3] },
            counters: vec![CounterOutcome {
                name: "passed".to_owned(),
                kind: CounterKind::SamplesPassed,
                low: counts[0],
                high: (counts[1] % 2 == 0).then_some(counts[2]),
                actual: counts[3],
                band: (counts[1] % 3 == 0).then_some(Band::Fail),
            }],
            accuracy: figures.iter().map(accuracy).collect(),
            measured: figures.first().map(measured),
            assertions: figures.into_iter().map(assertion).collect(),
            wrong: wrong.into_iter().map(|(a, x, c)| wrong_texel(a, x, c)).collect(),
            seconds: Seconds { draw: f64::from(seconds[0]) / 8.0, judge: f64::from(seconds[1]) / 8.0 },
        }
    }
}

proptest! {
    #[test]
    fn records_survive_json(record in record()) {
        let line = serde_json::to_string(&record).unwrap();
        prop_assert!(!line.contains('\n'));
        prop_assert_eq!(serde_json::from_str::<Record>(&line).unwrap(), record);
    }

    #[test]
    fn a_run_cut_anywhere_keeps_its_whole_records(
        records in prop::collection::vec(record(), 1..5), cut_index in any::<prop::sample::Index>()
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = RunWriter::create(folder.path(), &header()).unwrap();
        records.iter().for_each(|r| writer.append(r).unwrap());
        let path = folder.path().join("run.jsonl");
        let bytes = fs::read(&path).unwrap();
        let first = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
        let end = first + cut_index.index(bytes.len() - first);
        fs::write(&path, &bytes[..end]).unwrap();
        let run = Run::read(folder.path()).unwrap();
        let newlines = bytes[first..end].iter().filter(|b| **b == b'\n').count();
        // A record that lacks only its newline is complete.
        prop_assert!(run.records.len() == newlines || bytes[end] == b'\n');
        prop_assert_eq!(&run.records[..], &records[..run.records.len()]);
        let partial = bytes[end - 1] != b'\n' && bytes[end] != b'\n';
        prop_assert_eq!(run.truncated, partial);
    }

    #[test]
    fn a_run_cut_anywhere_resumes_and_ends_as_if_nothing_had_happened(
        records in prop::collection::vec(record(), 1..5),
        cut_index in any::<prop::sample::Index>(),
        zeros in 0_usize..3,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = RunWriter::create(folder.path(), &header()).unwrap();
        records.iter().for_each(|r| writer.append(r).unwrap());
        drop(writer);
        let path = folder.path().join("run.jsonl");
        let complete = fs::read(&path).unwrap();
        let first = complete.iter().position(|b| *b == b'\n').unwrap() + 1;
        let end = first + cut_index.index(complete.len() - first);
        // Some file systems leave zeros in place of what a power cut took.
        let mut cut = complete[..end].to_vec();
        cut.extend(vec![0; zeros]);
        fs::write(&path, cut).unwrap();
        let (mut writer, run) = RunWriter::resume(folder.path(), &header()).unwrap();
        prop_assert!(!run.truncated);
        records[run.records.len()..].iter().for_each(|r| writer.append(r).unwrap());
        prop_assert_eq!(fs::read(&path).unwrap(), complete);
    }
}

#[test]
fn only_the_same_run_is_resumed() {
    let folder = tempfile::tempdir().unwrap();
    drop(RunWriter::create(folder.path(), &header()).unwrap());
    let before = fs::read(folder.path().join("run.jsonl")).unwrap();
    let refused = |change: &dyn Fn(&mut Header)| {
        let mut other = header();
        change(&mut other);
        match RunWriter::resume(folder.path(), &other).unwrap_err() {
            RecordError::Another { reason, .. } => reason,
            other => panic!("{other}"),
        }
    };
    assert_eq!(
        refused(&|h| h.settings.selection = "1-0".to_owned()),
        "the selection of cases was unknown there and is 1-0 here"
    );
    assert_eq!(
        refused(&|h| h.settings.shard = Some(Shard { index: 2, count: 3 })),
        "it is not sharded and not shard 2/3"
    );
    assert_eq!(
        refused(&|h| h.settings.shuffle = Some(7)),
        "--shuffle was none there and is 7 here"
    );
    assert_eq!(
        refused(&|h| h.settings.validate = true),
        "--validate was false there and is true here"
    );
    assert_eq!(
        refused(&|h| h.adapters[0].info.driver_version = "26".to_owned()),
        "gl:es:soft was d, Mesa 25, 3.2 there and is d, Mesa 26, 3.2 here"
    );
    assert_eq!(
        refused(&|h| h.adapters[0].limits.sub_pixel_bits = 4),
        "the limits of gl:es:soft have changed"
    );
    assert_eq!(
        refused(&|h| h.adapters.clear()),
        "gl:es:soft was there and is not here"
    );
    assert_eq!(
        refused(&|h| h.provenance.etalon = "0.2.0".to_owned()),
        "the version of etalon was 0.1.0 there and is 0.2.0 here"
    );
    let mut later = header();
    later.provenance.started = "2027-01-01T00:00:00Z".to_owned();
    later.settings.timeout = Some(1.0);
    RunWriter::resume(folder.path(), &later).unwrap();
    assert_eq!(fs::read(folder.path().join("run.jsonl")).unwrap(), before);
}

#[test]
fn a_line_without_end_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let text = written(folder.path(), &[Verdict::Pass]);
    let long = "x".repeat(3 * MAX_LINE);
    fs::write(
        folder.path().join("run.jsonl"),
        format!("{text}{long}\n{long}"),
    )
    .unwrap();
    let message = format!("the line is longer than {MAX_LINE} bytes");
    assert_eq!(wrong_in_run(folder.path()), (3, message));
}

#[test]
fn a_list_of_cases_must_match_the_digest_in_the_header() {
    let folder = tempfile::tempdir().unwrap();
    let mut header = header();
    header.settings.selection = selection_digest(["a/1", "a/2"]);
    let writer = RunWriter::create(folder.path(), &header).unwrap();
    assert_eq!(read_cases(folder.path(), &header).unwrap(), None);
    writer.write_cases(["a/2", "a/1"]).unwrap();
    let ids = read_cases(folder.path(), &header).unwrap().unwrap();
    assert_eq!(ids, ["a/2", "a/1"]);
    writer.write_cases(["a/2"]).unwrap();
    let (name, line, message) = wrong_line(read_cases(folder.path(), &header).unwrap_err());
    assert_eq!((&*name, line), ("cases.txt", 1));
    assert_eq!(message, "these are not the cases that run.jsonl names");
}

fn written(folder: &Path, verdicts: &[Verdict]) -> String {
    let mut writer = RunWriter::create(folder, &header()).unwrap();
    for (i, verdict) in verdicts.iter().enumerate() {
        writer
            .append(&Record::new(format!("a/{i}"), "gl:es:soft", *verdict))
            .unwrap();
    }
    fs::read_to_string(folder.join("run.jsonl")).unwrap()
}

#[test]
fn a_written_run_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path(), &Verdict::ALL);
    let run = Run::read(folder.path()).unwrap();
    assert_eq!(run.header, header());
    let verdicts: Vec<Verdict> = run.records.iter().map(|r| r.verdict).collect();
    assert_eq!(verdicts, Verdict::ALL);
    assert!(!run.truncated);
    written(folder.path(), &[Verdict::Pass]);
    assert_eq!(Run::read(folder.path()).unwrap().missing(), 2);
}

#[test]
fn damage_in_the_middle_names_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.jsonl");
    let text = written(folder.path(), &[Verdict::Pass; 3]);
    let lines: Vec<&str> = text.lines().collect();
    for damage in ["{\"case\":", "", "null", "\u{0}\u{0}"] {
        let broken = [lines[0], lines[1], damage, lines[3], ""].join("\n");
        fs::write(&path, broken).unwrap();
        assert_eq!(wrong_in_run(folder.path()).0, 3);
    }
}

#[test]
fn a_last_line_of_another_shape_is_an_error_and_a_cut_one_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.jsonl");
    let text = written(folder.path(), &[Verdict::Pass]);
    fs::write(&path, format!("{text}{{\"case\":\"a/1\",\"colour\":1}}\n")).unwrap();
    let (line, message) = wrong_in_run(folder.path());
    assert_eq!(line, 3);
    assert!(message.starts_with("unknown field `colour`"), "{message}");
    fs::write(&path, format!("{text}{{\"case\":\"a/1\",\"ad")).unwrap();
    let run = Run::read(folder.path()).unwrap();
    assert_eq!((run.records.len(), run.truncated), (1, true));
}

#[test]
fn folders_without_a_readable_header_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.jsonl");
    assert!(matches!(
        Run::read(folder.path()),
        Err(RecordError::NoRun { .. })
    ));
    fs::write(&path, "").unwrap();
    assert_eq!(wrong_in_run(folder.path()).0, 1);
    // A newer format may have other fields; the message says what to do.
    for newer in [FORMAT + 1, 99] {
        fs::write(&path, format!("{{\"format\":{newer},\"new\":true}}\n")).unwrap();
        let error = Run::read(folder.path()).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "{} is in format {newer}, but this etalon reads formats up to {FORMAT}; \
                 read it with the version that wrote it, or record the run again",
                path.display()
            )
        );
    }
}

#[test]
fn runs_of_every_older_format_are_read_but_not_resumed() {
    let samples = [
        (1, include_str!("../../../report/tests/data/methods.jsonl")),
        (2, include_str!("../data/format-2.jsonl")),
        (3, include_str!("../data/format-3.jsonl")),
        (4, include_str!("../data/format-4.jsonl")),
        (5, include_str!("../data/format-5.jsonl")),
        (6, include_str!("../data/format-6.jsonl")),
    ];
    assert_eq!(samples.len() as u32, FORMAT - 1, "a sample of each");
    for (format, text) in samples {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("run.jsonl"), text).unwrap();
        let run = Run::read(folder.path()).unwrap();
        assert_eq!(run.header.format, format);
        assert_eq!(run.records.len(), text.lines().count() - 1);
        assert!(!run.truncated);
        for adapter in &run.header.adapters {
            let unknown = ApiVersion::default();
            assert_eq!(adapter.limits.version == unknown, format < 3);
        }
        for story in run.records.iter().filter_map(|r| r.story.as_ref()) {
            assert_eq!(story.told.is_empty(), format > 3);
            assert_eq!(story.events.is_empty(), format < 4);
        }
        let stories = run.records.iter().filter(|r| r.story.is_some()).count();
        assert!(format < 3 || stories > 0, "a story");
        assert!(run.records.iter().all(|r| r.example.is_none()));
        assert!(run.records.iter().all(|r| r.blocked_by.is_empty()));
        let with_reasons = || run.records.iter().filter(|r| !r.reasons.is_empty());
        assert!(format < 5 || with_reasons().count() > 0, "a reason");
        for record in with_reasons() {
            let is_message =
                matches!(&record.reasons[..], [Reason::Text(text)] if !text.is_empty());
            assert_eq!(is_message, format < 6, "{:?}", record.reasons);
        }
        // Records of this format must not follow a header of another.
        let mut now = run.header.clone();
        now.format = FORMAT;
        match RunWriter::resume(folder.path(), &now).unwrap_err() {
            RecordError::Another { reason, .. } => assert_eq!(
                reason,
                format!("its format is {format}, and {FORMAT} is written now")
            ),
            other => panic!("{other}"),
        }
    }
}

#[test]
fn redundant_numbers_are_left_out_of_a_record() {
    let mut record = Record::new("a/b", "cpu", Verdict::Pass);
    record.texels.total = 16;
    record.assertions = vec![Assertion {
        aspect: Aspect::Color,
        channels: 64,
        asserted: 64,
        exact: 60,
        codes: 68,
        yardstick_exact: 64,
        yardstick_codes: 64,
        yardstick_asserted: 64,
    }];
    let expected = r#"{"case":"a/b","adapter":"cpu","verdict":"pass","texels":{"total":16},"assertions":[{"aspect":"color","channels":64,"exact":60,"codes":68}]}"#;
    assert_eq!(serde_json::to_string(&record).unwrap(), expected);
    assert_eq!(serde_json::from_str::<Record>(expected).unwrap(), record);
}

#[test]
fn a_new_run_replaces_the_old_one_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let frames = folder.path().join("frames");
    fs::create_dir(&frames).unwrap();
    fs::write(frames.join("mine"), "").unwrap();
    let refused = RunWriter::create(folder.path(), &header()).unwrap_err();
    assert!(matches!(refused, RecordError::Foreign { .. }), "{refused}");
    assert!(frames.join("mine").exists(), "not a run folder before");
    fs::remove_dir_all(&frames).unwrap();
    written(folder.path(), &[Verdict::Pass]);
    let out = OutputFolder::open(folder.path()).unwrap();
    for name in ["frames/gl/a/b.json.gz", "index.html", "results/a.csv"] {
        out.write(name, b"ours").unwrap();
    }
    fs::write(folder.path().join("notes.txt"), "").unwrap();
    // A file of somebody else in a folder of ours would be lost among the new ones.
    let mine = frames.join("gl/mine.json.gz");
    fs::write(&mine, "").unwrap();
    let before = fs::read(folder.path().join("run.jsonl")).unwrap();
    let refused = RunWriter::create(folder.path(), &header()).unwrap_err();
    assert!(matches!(refused, RecordError::NotOurs { .. }), "{refused}");
    assert_eq!(fs::read(folder.path().join("run.jsonl")).unwrap(), before);
    assert!(frames.join("gl/a/b.json.gz").exists());
    fs::remove_file(mine).unwrap();
    written(folder.path(), &[Verdict::Pass]);
    assert!(!frames.exists() && !folder.path().join("index.html").exists());
    assert!(!folder.path().join("results/a.csv").exists());
    assert!(folder.path().join("notes.txt").exists());
}

#[test]
fn a_folder_of_an_earlier_version_loses_what_its_records_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut writer = RunWriter::create(folder.path(), &header()).unwrap();
    let mut record = Record::new("a/b", "cpu", Verdict::Fail);
    record.frame = Some("frames/cpu/a/b.json".to_owned());
    writer.append(&record).unwrap();
    fs::remove_file(path(".files")).unwrap();
    let ours = ["frames/cpu/a/b.json", "index.html", "cases/a.js"];
    let mine = ["found/c.json", "notes.txt"];
    for name in ours.iter().chain(&mine) {
        fs::create_dir_all(path(name).parent().unwrap()).unwrap();
        let script = if *name == "cases/a.js" {
            "etalonArea("
        } else {
            ""
        };
        fs::write(path(name), script).unwrap();
    }
    RunWriter::create(folder.path(), &header()).unwrap();
    for name in ours {
        assert!(!path(name).exists(), "{name}");
    }
    for name in mine {
        assert!(path(name).exists(), "{name}");
    }
}

#[test]
fn frames_read_back_and_stay_in_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let writer = RunWriter::create(folder.path(), &header()).unwrap();
    let frame = FrameFile {
        case: "depth/a/b=1".to_owned(),
        adapter: "gl:es:soft".to_owned(),
        about: "about".to_owned(),
        spec: vec!["s".to_owned()],
        images: vec![FrameImage {
            attachment: "depth".to_owned(),
            aspect: Aspect::Depth,
            size: [2, 1],
            samples: 1,
            channels: vec![ChannelEncoding::Unorm(16)],
            low: vec![0, 1],
            high: vec![0, 1],
            actual: vec![0, 2],
            wrong: vec![FrameImage::FINE, FrameImage::FAIL],
        }],
    };
    assert!(frame.images[0].is_whole());
    let path = writer.frames().write_frame(&frame).unwrap();
    assert_eq!(path, "frames/gl_es_soft/depth/a,b=1.json.gz");
    assert_eq!(Run::read_frame(folder.path(), &path).unwrap(), frame);
    for outside in ["", "..", "../x", "/etc/hostname", "frames/../../x"] {
        assert!(matches!(
            Run::read_frame(folder.path(), outside),
            Err(RecordError::Outside { .. })
        ));
    }
    fs::write(folder.path().join(&path), "{").unwrap();
    match Run::read_frame(folder.path(), &path).unwrap_err() {
        RecordError::Frame { path: named, .. } => assert_eq!(named, folder.path().join(&path)),
        other => panic!("{other}"),
    }
    // As earlier versions wrote them.
    let text = serde_json::to_vec(&frame).unwrap();
    fs::write(folder.path().join("plain.json"), text).unwrap();
    assert_eq!(Run::read_frame(folder.path(), "plain.json").unwrap(), frame);
    fs::write(folder.path().join("plain.json"), "{").unwrap();
    let (name, line, _) = wrong_line(Run::read_frame(folder.path(), "plain.json").unwrap_err());
    assert_eq!((&*name, line), ("plain.json", 1));
}

#[test]
fn long_records_are_shortened_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = RunWriter::create(folder.path(), &header()).unwrap();
    let event = Event {
        scene: None,
        origin: Origin::Pass(0),
        step: Step::ClearElsewhere,
        effect: Effect::None,
        citation: Some("c".repeat(500)),
    };
    let lengths = [(100, 50, 10, 0), (1, 50, 500, 0), (64, 400, 500, 300_000)];
    for (i, (texels, name, lines, message)) in lengths.into_iter().enumerate() {
        let mut record = Record::new(format!("a/{i}"), "gl:es:soft", Verdict::Fail);
        let texel = |x| wrong_texel("n".repeat(name), x, 9);
        record.wrong = (0..texels).map(texel).collect();
        record.story = Some(Story {
            events: vec![event.clone(); lines],
            ..Story::default()
        });
        record.reasons = vec![Reason::Text("ü".repeat(message) + "end")];
        writer.append(&record).unwrap();
    }
    let text = fs::read_to_string(folder.path().join("run.jsonl")).unwrap();
    assert!(text.lines().all(|l| l.len() < MAX_LINE));
    let run = Run::read(folder.path()).unwrap();
    let story = |i: usize| run.records[i].story.as_ref().map_or(0, |s| s.events.len());
    assert_eq!(
        (run.records[0].wrong.len(), story(0)),
        (MAX_WRONG_TEXELS, 10)
    );
    assert_eq!(run.records[1].wrong.len(), 1);
    assert!((10..500).contains(&story(1)), "{}", story(1));
    assert_eq!((run.records[2].wrong.len(), story(2)), (1, 0));
    let [Reason::Text(cut)] = &run.records[2].reasons[..] else {
        panic!("{:?}", run.records[2].reasons);
    };
    assert!(cut.starts_with("[cut] ü") && cut.ends_with("üend"));

    let mut hopeless = Record::new("c".repeat(MAX_LINE), "gl:es:soft", Verdict::Fail);
    hopeless.reasons = vec![Reason::Text("m".to_owned())];
    assert!(matches!(
        writer.append(&hopeless),
        Err(RecordError::TooLong { .. })
    ));
}

#[test]
fn pictures_are_read_only_below_the_folder() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("run");
    fs::create_dir_all(folder.join("pictures")).unwrap();
    let png = b"\x89PNG\r\n\x1a\nand so on";
    fs::write(outer.path().join("secret.png"), png).unwrap();
    fs::write(folder.join("pictures/a.png"), png).unwrap();
    fs::write(folder.join("pictures/b.png"), "GIF89a").unwrap();
    let read = |path: &str, most| Run::read_picture(&folder, path, most);
    assert_eq!(
        read("pictures/a.png", 17).unwrap().as_deref(),
        Some(&png[..])
    );
    assert_eq!(read("pictures/a.png", 16).unwrap(), None, "too long");
    assert_eq!(read("pictures/b.png", 100).unwrap(), None, "no PNG");
    for path in [
        "../secret.png",
        "/etc/passwd",
        "",
        "pictures/../../secret.png",
    ] {
        let error = read(path, 100).unwrap_err();
        assert!(
            matches!(error, RecordError::Outside { .. }),
            "{path}: {error}"
        );
    }
    assert!(matches!(
        read("pictures/none.png", 9).unwrap_err(),
        RecordError::Io { .. }
    ));
}

#[test]
fn blank_lines_and_a_byte_order_mark_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path(), &[Verdict::Pass, Verdict::Fail]);
    let path = folder.path().join("run.jsonl");
    let plain = Run::read(folder.path()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, format!("\u{feff}{text}\n \r\n\n")).unwrap();
    assert_eq!(Run::read(folder.path()).unwrap(), plain);
    let (mut writer, resumed) = RunWriter::resume(folder.path(), &plain.header).unwrap();
    assert_eq!(resumed, plain);
    let more = Record::new("depth/more", "gl:es:soft", Verdict::Pass);
    writer.append(&more).unwrap();
    let read = Run::read(folder.path()).unwrap();
    assert_eq!(read.records.len(), plain.records.len() + 1);
    assert_eq!(read.records.last(), Some(&more));
}

#[test]
fn a_broken_header_is_no_damaged_record() {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path(), &[Verdict::Pass]);
    let path = folder.path().join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[5..]).unwrap();
    let damage = || match Run::read(folder.path()).unwrap_err() {
        RecordError::Parse { line, remedy, .. } => (line, remedy),
        other => panic!("{other}"),
    };
    let (line, remedy) = damage();
    assert_eq!(line, 1);
    assert!(remedy.starts_with("the file cannot be read without its header; "));
    fs::write(&path, text.replacen("\"verdict\"", "\"verdct\"", 1)).unwrap();
    assert_eq!(damage(), (2, "remove the line, or record the run again"));
}

#[test]
fn an_unknown_key_is_refused_anywhere_in_a_header() {
    let folder = tempfile::tempdir().unwrap();
    RunWriter::create(folder.path(), &header()).unwrap();
    let path = folder.path().join("run.jsonl");
    let line = fs::read_to_string(&path).unwrap();
    let parsed: serde_json::Value = serde_json::from_str(&line).unwrap();
    for place in [
        "",
        "/machine",
        "/settings",
        "/adapters/0",
        "/adapters/0/limits",
    ] {
        let mut changed = parsed.clone();
        changed.pointer_mut(place).unwrap()["later"] = true.into();
        fs::write(&path, format!("{changed}\n")).unwrap();
        let (line, message) = wrong_in_run(folder.path());
        assert_eq!(line, 1, "{place}");
        assert!(message.starts_with("unknown field `later`"), "{message}");
    }
    for key in ["etalon", "machine", "started", "command"] {
        let mut changed = parsed.clone();
        changed.as_object_mut().unwrap().remove(key);
        fs::write(&path, format!("{changed}\n")).unwrap();
        let missing = (1, format!("missing field `{key}`"));
        assert_eq!(wrong_in_run(folder.path()), missing);
    }
}

/// A link in a folder from somebody else can lead to any file of the machine.
#[cfg(unix)]
#[test]
fn no_file_of_a_folder_is_read_through_a_link() {
    type Reading = fn(&Path) -> Option<RecordError>;
    // The list of random scenes is only written.
    let readings: [(&str, Reading); 7] = [
        ("run.jsonl", |folder| Run::read(folder).err()),
        ("bench.jsonl", |folder| Bench::read(folder).err()),
        ("versions.jsonl", |folder| Versions::read(folder).err()),
        ("mutants.json", |folder| Hunt::read(folder).err()),
        ("cases.txt", |folder| read_cases(folder, &header()).err()),
        ("dead-expectations.json", |folder| Dead::read(folder).err()),
        ("beside.json", |folder| beside::read(folder).err()),
    ];
    let work = tempfile::tempdir().unwrap();
    let secret = work.path().join("secret");
    let mut recognized = 0;
    for (name, read) in readings {
        let folder = work.path().join(format!("folder-{name}"));
        fs::create_dir(&folder).unwrap();
        let path = folder.join(name);
        std::os::unix::fs::symlink(&secret, &path).unwrap();
        for text in [None, Some("{\"format\":1,\"etalon\":\"1\"}\n")] {
            if let Some(text) = text {
                fs::write(&secret, text).unwrap();
            }
            let message = format!(
                "{} is a link or no regular file, so it is not read; put the file itself there",
                path.display()
            );
            assert_eq!(read(&folder).unwrap().to_string(), message);
        }
        // If the name marks a folder of etalon, writing into the folder is refused, and the error names the link.
        if let Some(kind) = FolderKind::of(&folder) {
            recognized += 1;
            assert_eq!(kind.file(), name);
            let refused = Content::writable(&folder).unwrap_err();
            assert!(matches!(refused, RecordError::Link { .. }), "{refused}");
        }
        fs::remove_file(&secret).unwrap();
    }
    assert_eq!(recognized, 4, "run, bench, versions and hunt");
}
