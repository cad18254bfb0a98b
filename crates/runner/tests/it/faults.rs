//! Runs of workers that crash, write garbage or report errors: every case gets exactly one record, and the
//! right one.

use crate::cases::cases;
use crate::worker::{FAULT, LAUNCHED, TO_OPEN, fail_starts, protocol, serve, starts};
use etalon_backend::{Backend, BackendError, FrameTime, Prepared, Unavailable};
use etalon_case::Library;
use etalon_cpu::CpuBackend;
use etalon_frame::{AdapterInfo, Feature, Frame, Limits, Requirement};
use etalon_record::{Expectations, Header, LossKind, Reason, Record, Run, Verdict};
use etalon_runner::{
    Launch, Launcher, Plan, RunEvent, RunOptions, RunSummary, START_TIMEOUT, StartError, Worker,
};
use etalon_scene::Scene;
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// The height of the scene that goes wrong.
const MARKED: u32 = 3;
/// The prefix of faults in scenes without passes (round trips) instead of the marked scene.
const TRIP: &str = "trip:";
const CASES: u32 = 9;

struct Faulty {
    inner: CpuBackend,
    fault: String,
}

struct FaultyScene<'a> {
    inner: Box<dyn Prepared + 'a>,
    fault: Option<&'a str>,
}

/// Fails if the fault, `<what>@<step>`, belongs to this step.
fn stumble(fault: Option<&str>, step: &str) -> Result<(), BackendError> {
    let Some((what, faulty_step)) = fault.and_then(|f| f.split_once('@')) else {
        return Ok(());
    };
    if faulty_step != step {
        return Ok(());
    }
    eprintln!("about to stumble");
    let word = || "planted".to_owned();
    match what {
        "abort" => std::process::abort(),
        "exit" => std::process::exit(7),
        "panic" => panic!("planted panic"),
        "garbage" => {
            protocol().write_all(&[0xff; 8]).unwrap();
            Ok(())
        }
        "half" => {
            // Announces a message of 16 bytes and sends 2 of them.
            protocol().write_all(&[16, 0, 0, 0, 1, 0]).unwrap();
            std::process::exit(0)
        }
        // The picture is changed afterwards.
        "wrong" => Ok(()),
        "lost" => Err(BackendError::lost(word())),
        "resource" => Err(BackendError::refused("a buffer", word())),
        "shader" => Err(BackendError::shader("flat_color", word())),
        "not-supported" => {
            let feature = Feature::SeparateStencilMasks;
            Err(BackendError::NotSupported(Requirement::Feature(feature)))
        }
        _ => panic!("no such fault: {what}"),
    }
}

impl Backend for Faulty {
    fn adapter(&self) -> &AdapterInfo {
        self.inner.adapter()
    }

    fn limits(&self) -> &Limits {
        self.inner.limits()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        let (marked, fault) = match self.fault.strip_prefix(TRIP) {
            Some(fault) => (scene.passes.is_empty(), fault),
            None => (scene.attachments[0].size[1] == MARKED, &*self.fault),
        };
        let fault = marked.then_some(fault);
        stumble(fault, "prepare")?;
        let inner = self.inner.prepare(scene)?;
        Ok(Box::new(FaultyScene { inner, fault }))
    }
}

impl Prepared for FaultyScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        stumble(self.fault, "submit")?;
        self.inner.submit()
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        stumble(self.fault, "read")?;
        let mut frame = self.inner.read_back()?;
        if self.fault == Some("wrong@read") {
            let codes = frame.images.iter_mut().flat_map(|i| &mut i.codes);
            codes.for_each(|code| *code ^= 1);
        }
        Ok(frame)
    }
}

impl Drop for FaultyScene<'_> {
    fn drop(&mut self) {
        let outcome = stumble(self.fault, "drop");
        assert!(outcome.is_ok(), "dropping cannot report an error");
    }
}

#[test]
#[ignore = "the worker's side, which the other tests start"]
fn worker() {
    let Ok(fault) = std::env::var(FAULT) else {
        return;
    };
    let open = || match fault.as_str() {
        "unavailable" => Err(Unavailable::new("the moon is full", "wait")),
        "panic" => panic!("planted panic"),
        _ => Ok(Box::new(Faulty {
            inner: CpuBackend::new("faulty"),
            fault,
        }) as Box<dyn Backend>),
    };
    serve(open);
}

fn launch(fault: &str) -> Launch {
    crate::worker::launch("faults::worker", "faulty", fault)
}

fn script(text: &str) -> Launch {
    Launch {
        adapter: "script".to_owned(),
        program: "/bin/sh".into(),
        arguments: vec!["-c".to_owned(), text.to_owned()],
        environment: Vec::new(),
        launcher: None,
        release: None,
        patience: START_TIMEOUT,
        alone: false,
    }
}

fn broken(launch: &Launch) -> String {
    match Worker::start(launch) {
        Err(StartError::Broken(text)) => text,
        Err(other) => panic!("not the driver's fault: {other}"),
        Ok(_) => panic!("started"),
    }
}

/// Puts a shell script in front of a worker; the script gets the worker's command as "$0" "$@".
fn behind(mut launch: Launch, script: &str) -> Launch {
    launch.launcher = Some(Launcher {
        prefix: ["/bin/sh", "-c", script].map(str::to_owned).to_vec(),
        open: TO_OPEN.to_owned(),
    });
    let launched = (LAUNCHED.to_owned(), Some("yes".to_owned()));
    launch.environment.push(launched);
    launch
}

#[test]
fn a_launcher_that_prints_or_starts_no_worker_is_not_taken_for_a_driver() {
    for (script, end) in [
        (
            "echo Welcome to the machine",
            ": the worker wrote garbage: `Welcome to the machine` in place of a greeting; a launcher must not print \
             anything itself: its standard output is the worker's",
        ),
        (
            "echo etalon worker 0.0.9, protocol 1; cat",
            ": start the same program there",
        ),
        (
            "echo no such host >&2; exit 255",
            ", and its launcher ended with exit status 255; stderr ends with: no such host",
        ),
        ("exit 0", ", and its launcher ended with exit status 0"),
        (
            "kill -SEGV $$",
            ", and its launcher died of signal 11 (SIGSEGV)",
        ),
    ] {
        match Worker::start(&behind(launch("none"), script)) {
            Err(StartError::Launcher(text)) => {
                let start = "no worker answers behind the launcher: ";
                assert!(text.starts_with(start), "{script}: {text}");
                assert!(text.ends_with(end), "{script}: {text}");
            }
            Err(other) => panic!("{script}: {other}"),
            Ok(_) => panic!("{script}: started"),
        }
    }
    let mut nowhere = behind(launch("none"), "");
    if let Some(launcher) = &mut nowhere.launcher {
        launcher.prefix = vec!["/nowhere/ssh".to_owned()];
    }
    match Worker::start(&nowhere) {
        Err(StartError::Launcher(text)) => assert!(text.contains("`/nowhere/ssh`"), "{text}"),
        _ => panic!("started"),
    }
    // After the greeting, the driver itself fails.
    match Worker::start(&behind(launch("panic"), PLAIN)) {
        Err(StartError::Broken(text)) => assert!(text.contains("planted panic"), "{text}"),
        _ => panic!("not broken"),
    }
}

/// A launcher that does nothing but start the worker.
const PLAIN: &str = r#""$0" "$@""#;

#[test]
fn a_launcher_hides_how_its_worker_ended() {
    let (records, _) = run(behind(launch("abort@submit"), PLAIN));
    let lost: Vec<_> = records.iter().filter_map(|r| r.process.as_ref()).collect();
    assert_eq!(lost.len(), 1);
    // A shell returns 128 plus the signal; other launchers return something else.
    assert_eq!((lost[0].signal, lost[0].exit), (None, None));
    let crashed = records.iter().find(|r| r.process.is_some()).unwrap();
    let launcher = crashed.process.as_ref().unwrap().launcher;
    assert!(
        launcher.is_some_and(|end| end.exit.is_some()),
        "{crashed:?}"
    );
    assert!(
        records
            .iter()
            .filter(|r| r.verdict == Verdict::Pass)
            .count()
            > 1
    );
}

#[test]
fn a_worker_that_does_not_greet_is_broken_and_says_how() {
    for (words, end) in [
        ("exit 0", "ended with exit status 0"),
        (
            "echo famous words >&2; exit 3",
            "ended with exit status 3; stderr ends with: famous words",
        ),
        ("kill -SEGV $$", "died of signal 11 (SIGSEGV)"),
    ] {
        let text = format!("the driver did not start: the worker {end}");
        assert_eq!(broken(&script(words)), text);
    }
    for garbage in [
        "printf 'Hello, I am no driver'",
        "printf '\\003\\0\\0\\0abc'",
        "printf '\\100\\0\\0\\0half'",
    ] {
        let text = broken(&script(garbage));
        let start = "the driver did not start: the worker wrote garbage: ";
        assert!(text.starts_with(start), "{text}");
    }
    let mut nowhere = script("");
    nowhere.program = "/nowhere/etalon".into();
    let text = broken(&nowhere);
    let start = "the worker cannot be started: ";
    assert!(text.starts_with(start), "{text}");
    let panic = broken(&launch("panic"));
    assert!(panic.contains("planted panic"), "{panic}");
}

#[test]
fn a_worker_that_closes_its_pipe_is_waited_for_a_limited_time() {
    let text = broken(&script("exec sleep 100 >&-"));
    assert_eq!(text, "the driver did not start: the worker closed its pipe");
}

#[test]
fn an_unavailable_adapter_says_why() {
    match Worker::start(&launch("unavailable")) {
        Err(StartError::Unavailable(u)) => {
            assert_eq!(u, Unavailable::new("the moon is full", "wait"));
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("started"),
    }
}

/// Runs all cases on one worker. Returns the records, in order.
fn run(launch: Launch) -> (Vec<Record>, RunSummary) {
    run_with(launch, 1, &[])
}

/// Runs all cases on this many workers, round trips first. Returns the records, in the order of the cases.
fn run_with(launch: Launch, jobs: usize, libraries: &[&Library]) -> (Vec<Record>, RunSummary) {
    let folder = tempfile::tempdir().unwrap();
    let cases = cases(&folder.path().join("cases"), CASES);
    let round_trips = etalon_judge::round_trips(libraries, &cases).unwrap();
    assert_eq!(
        round_trips.len(),
        libraries.len(),
        "all cases draw to one format"
    );
    let worker = Worker::start(&launch).unwrap_or_else(|e| panic!("{e}"));
    let out = folder.path().join("out");
    let plan = Plan {
        cases: &cases,
        round_trips: &round_trips,
        header: Header::new(vec![(&worker).into()], cases.len() as u64),
        adapters: vec![(launch, worker)],
        dead: Vec::new(),
        options: RunOptions {
            // A recheck starts additional workers, which these tests count.
            recheck: 0,
            timeout: Duration::from_secs(10),
            jobs,
            ..RunOptions::default()
        },
        expectations: &Expectations::default(),
        folder: &out,
        selection: None,
        resume: false,
        stop: &AtomicBool::new(false),
        drawn: &|_, _, _| {},
    };
    let records = Mutex::new(Vec::new());
    let summary = etalon_runner::run(plan, &|event| {
        if let RunEvent::Recorded(record) = event {
            records.lock().unwrap().push(*record);
        }
    });
    let mut run = Run::read(&out).unwrap();
    assert_eq!(run.missing(), 0);
    let mut records = records.into_inner().unwrap();
    if jobs > 1 {
        let place = |r: &Record| cases.iter().position(|c| c.id == r.case);
        run.records.sort_by_key(place);
        records.sort_by_key(place);
    }
    assert_eq!(records, run.records);
    let ids: Vec<&str> = run.records.iter().map(|r| r.case.as_str()).collect();
    let expected: Vec<&str> = cases.iter().map(|c| c.id.as_str()).collect();
    assert_eq!(ids, expected, "one record per case");
    (run.records, summary.unwrap())
}

/// Runs all cases. Returns the marked case's record; all others pass.
fn only_marked(launch: Launch, verdict: Verdict) -> Record {
    let fault = format!("{:?}", launch.environment);
    let (records, summary) = run(launch);
    for (i, record) in records.iter().enumerate() {
        let expected = if i + 1 == MARKED as usize {
            verdict
        } else {
            Verdict::Pass
        };
        assert_eq!(record.verdict, expected, "{fault}: {record:?}");
    }
    assert_eq!(summary.records, u64::from(CASES));
    assert_eq!(summary.unexpected, u64::from(verdict.is_bad()), "{fault}");
    records[MARKED as usize - 1].clone()
}

/// Returns the text of a record's only reason.
fn text(record: &Record) -> &str {
    match &record.reasons[..] {
        [Reason::Text(text)] => text,
        others => panic!("{others:?}"),
    }
}

#[test]
fn a_worker_without_a_fault_passes() {
    only_marked(launch("none"), Verdict::Pass);
}

#[test]
fn a_death_costs_one_case_and_names_its_cause() {
    for step in ["prepare", "submit", "read", "drop"] {
        let record = only_marked(launch(&format!("abort@{step}")), Verdict::Crash);
        let end = record.process.unwrap();
        assert_eq!((end.kind, end.signal), (LossKind::Died, Some(6)));
        assert!(end.stderr.contains("about to stumble"), "{end:?}");
        let record = only_marked(launch(&format!("exit@{step}")), Verdict::Crash);
        assert_eq!(record.process.unwrap().exit, Some(7));
    }
}

#[test]
fn garbage_on_the_pipe_costs_one_case() {
    for fault in ["garbage@prepare", "garbage@read", "half@submit"] {
        let record = only_marked(launch(fault), Verdict::Crash);
        assert_eq!(record.process.unwrap().kind, LossKind::Garbage);
    }
}

#[test]
fn an_error_that_a_backend_reports_becomes_the_verdict() {
    for step in ["prepare", "submit", "read"] {
        for (what, verdict) in [
            ("lost", Verdict::DeviceLost),
            ("resource", Verdict::ResourceError),
            ("shader", Verdict::InternalError),
            ("not-supported", Verdict::NotSupported),
        ] {
            let record = only_marked(launch(&format!("{what}@{step}")), verdict);
            let word = match verdict {
                Verdict::NotSupported => "separate-stencil-masks",
                _ => "planted",
            };
            assert!(text(&record).contains(word), "{record:?}");
        }
    }
}

#[test]
fn a_panic_is_our_own_error_and_no_crash_of_the_driver() {
    for step in ["prepare", "submit", "read", "drop"] {
        let record = only_marked(launch(&format!("panic@{step}")), Verdict::InternalError);
        assert!(text(&record).contains("planted panic"), "{record:?}");
    }
}

#[test]
fn answers_stay_with_their_cases_when_a_start_fails_once_or_twice() {
    for failing in ["2", "2 3"] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("starts");
        let mut launch = launch("abort@submit");
        fail_starts(&mut launch, &file, failing);
        only_marked(launch, Verdict::Crash);
        assert_eq!(starts(&file), 2 + failing.split(' ').count());
    }
}

#[test]
fn a_worker_that_never_comes_back_leaves_a_record_for_every_case() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("starts");
    let mut launch = launch("abort@submit");
    fail_starts(&mut launch, &file, "2 3 4 5 6 7 8 9");
    let (records, summary) = run(launch);
    for (i, record) in records.iter().enumerate() {
        let number = i as u32 + 1;
        let expected = if number < MARKED {
            Verdict::Pass
        } else {
            Verdict::Crash
        };
        assert_eq!(record.verdict, expected, "{record:?}");
        if number > MARKED {
            let end = record.process.as_ref().unwrap();
            assert_eq!(end.kind, LossKind::NotStarted, "{record:?}");
            // Standard error has the output of the test itself.
            let error = "the worker could not be started again: the driver did not start: the worker ended with \
                         exit status 9; ";
            assert!(end.error.starts_with(error), "{record:?}");
        }
    }
    assert_eq!(summary.unexpected, u64::from(CASES + 1 - MARKED));
    assert_eq!(starts(&file), 4, "three failed starts are enough");
}

#[test]
fn cases_whose_round_trip_fails_are_not_drawn_however_it_fails() {
    let library = Library::built_in();
    for (fault, verdict) in [
        ("wrong@read", Verdict::Fail),
        ("abort@submit", Verdict::Crash),
        ("exit@read", Verdict::Crash),
        ("garbage@prepare", Verdict::Crash),
        ("panic@submit", Verdict::InternalError),
        ("lost@submit", Verdict::DeviceLost),
        ("resource@prepare", Verdict::ResourceError),
    ] {
        for jobs in [1, 4] {
            let (records, summary) = run_with(launch(&format!("{TRIP}{fault}")), jobs, &[library]);
            for record in &records {
                assert_eq!(record.verdict, Verdict::Blocked, "{fault}: {record:?}");
                let trip = "capabilities/round-trip/format=rgba8unorm";
                assert_eq!(record.blocked_by, [trip]);
                let [Reason::FailedRoundTrips(failed)] = &record.reasons[..] else {
                    panic!("{record:?}");
                };
                assert_eq!(failed[0].verdict, verdict, "{record:?}");
                let wrong = failed[0].wrong.as_ref().map(|w| (w.x, w.y));
                let is_wrong = verdict == Verdict::Fail;
                assert_eq!(wrong, is_wrong.then_some((0, 0)), "{record:?}");
                assert_eq!(failed[0].why.is_empty(), is_wrong, "{record:?}");
            }
            assert_eq!(summary.records, u64::from(CASES), "the round trip has none");
            assert_eq!(summary.unexpected, u64::from(CASES), "{fault}");
            assert!(!summary.interrupted);
        }
    }
}

#[test]
fn a_round_trip_that_succeeds_or_is_not_supported_blocks_nothing() {
    let library = Library::built_in();
    for fault in ["none", "not-supported@prepare"] {
        for jobs in [1, 4] {
            let (records, summary) = run_with(launch(&format!("{TRIP}{fault}")), jobs, &[library]);
            let drawn = |r: &Record| r.verdict == Verdict::Pass;
            assert!(records.iter().all(drawn), "{fault}: {records:?}");
            assert_eq!(summary.unexpected, 0);
        }
    }
}

#[test]
fn a_driver_that_dies_in_its_round_trip_and_never_comes_back_leaves_every_record() {
    let library = Library::built_in();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("starts");
    let mut launch = launch(&format!("{TRIP}abort@submit"));
    fail_starts(&mut launch, &file, "2 3 4 5 6 7 8 9");
    let (records, summary) = run_with(launch, 4, &[library]);
    let blocked = |r: &Record| r.verdict == Verdict::Blocked;
    assert!(records.iter().all(blocked), "{records:?}");
    assert_eq!(summary.unexpected, u64::from(CASES));
    assert_eq!(starts(&file), 1, "what is blocked starts no worker");
}
