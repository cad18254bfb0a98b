//! Workers that die, lie or give up: every case gets exactly one record, and the right one.
//!
//! A worker is this test's own executable: the ignored test `worker` serves a backend that fails as
//! its environment says. libtest prints to standard output, so the protocol goes to descriptor 3.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use etalon_backend::{AdapterInfo, Backend, BackendError, FrameTime, Prepared, Unavailable};
use etalon_case::{Case, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Feature, Frame, Limits, Requirement};
use etalon_record::{Expectations, FORMAT, Header, Machine, Record, Run, Verdict};
use etalon_runner::{Event, Launch, Options, Plan, RunSummary, StartError, Worker};
use etalon_scene::Scene;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, Write};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// What goes wrong: `<what>@<step>`, or a word for [`worker`] itself.
const FAULT: &str = "ETALON_TEST_FAULT";
/// A file that gets one line per start; numbers after it are starts that fail.
const STARTS: &str = "ETALON_TEST_STARTS";
/// The height of the scene that goes wrong.
const MARKED: u32 = 3;
const CASES: usize = 9;

struct Faulty {
    inner: CpuBackend,
    fault: String,
}

struct FaultyScene<'a> {
    inner: Box<dyn Prepared + 'a>,
    fault: Option<&'a str>,
}

fn protocol() -> File {
    OpenOptions::new()
        .write(true)
        .open("/proc/self/fd/3")
        .unwrap()
}

/// Does what the fault says, if it belongs to this step.
fn stumble(fault: Option<&str>, step: &str) -> Result<(), BackendError> {
    let Some((what, at)) = fault.and_then(|f| f.split_once('@')) else {
        return Ok(());
    };
    if at != step {
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
            // A message of 16 bytes of which 2 come.
            protocol().write_all(&[16, 0, 0, 0, 1, 0]).unwrap();
            std::process::exit(0)
        }
        "lost" => Err(BackendError::DeviceLost(word())),
        "resource" => Err(BackendError::Resource {
            what: "a buffer".to_owned(),
            message: word(),
        }),
        "shader" => Err(BackendError::Shader {
            shader: "flat_color".to_owned(),
            message: word(),
        }),
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
        let marked = scene.attachments[0].size[1] == MARKED;
        let fault = marked.then_some(self.fault.as_str());
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
        self.inner.read_back()
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
    if let Ok(starts) = std::env::var(STARTS) {
        let (path, failing) = starts.split_once(' ').unwrap();
        let mut file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(path)
            .unwrap();
        file.write_all(b"started\n").unwrap();
        let number = fs::read_to_string(path).unwrap().lines().count();
        if failing.split(' ').any(|f| f.parse() == Ok(number)) {
            std::process::exit(9);
        }
    }
    let open = || match fault.as_str() {
        "unavailable" => Err(Unavailable::new("the moon is full", "wait")),
        "panic" => panic!("planted panic"),
        _ => Ok(Box::new(Faulty {
            inner: CpuBackend::new("faulty"),
            fault,
        }) as Box<dyn Backend>),
    };
    let input = BufReader::new(io::stdin());
    etalon_runner::serve(open, input, &mut protocol()).unwrap();
}

fn launch(fault: &str) -> Launch {
    let program = std::env::current_exe().unwrap();
    let script = r#"exec "$0" worker --exact --ignored --nocapture 3>&1 1>&2"#;
    Launch {
        adapter: "faulty".to_owned(),
        program: "/bin/sh".into(),
        arguments: vec![
            "-c".to_owned(),
            script.to_owned(),
            program.to_str().unwrap().to_owned(),
        ],
        environment: vec![(FAULT.to_owned(), Some(fault.to_owned()))],
    }
}

fn script(text: &str) -> Launch {
    Launch {
        adapter: "script".to_owned(),
        program: "/bin/sh".into(),
        arguments: vec!["-c".to_owned(), text.to_owned()],
        environment: Vec::new(),
    }
}

fn broken(launch: &Launch) -> String {
    match Worker::start(launch) {
        Err(StartError::Broken(text)) => text,
        Err(StartError::Unavailable(u)) => panic!("said that it is unavailable: {u}"),
        Ok(_) => panic!("started"),
    }
}

#[test]
fn a_worker_that_does_not_greet_is_broken_and_says_how() {
    let quiet = broken(&script("exit 0"));
    assert!(quiet.contains("exit status: 0"), "{quiet}");
    let words = broken(&script("echo famous words >&2; exit 3"));
    assert!(words.contains("exit status: 3"), "{words}");
    assert!(words.contains("famous words"), "{words}");
    let killed = broken(&script("kill -SEGV $$"));
    assert!(
        killed.contains("signal 11 (segmentation fault)"),
        "{killed}"
    );
    for garbage in [
        "printf 'Hello, I am no driver'",
        "printf '\\003\\0\\0\\0abc'",
    ] {
        let text = broken(&script(garbage));
        assert!(text.contains("garbage"), "{text}");
    }
    let half = broken(&script("printf '\\100\\0\\0\\0half'"));
    assert!(half.contains("garbage"), "{half}");
    let mut nowhere = script("");
    nowhere.program = "/nowhere/etalon".into();
    let text = broken(&nowhere);
    assert!(text.contains("cannot be started"), "{text}");
    let panic = broken(&launch("panic"));
    assert!(panic.contains("planted panic"), "{panic}");
}

#[test]
fn a_worker_that_closes_its_pipe_is_not_waited_for_for_ever() {
    let text = broken(&script("exec sleep 100 >&-"));
    assert!(text.contains("closed its pipe"), "{text}");
}

#[test]
fn an_adapter_that_is_not_there_says_why() {
    match Worker::start(&launch("unavailable")) {
        Err(StartError::Unavailable(u)) => {
            assert_eq!(u, Unavailable::new("the moon is full", "wait"));
        }
        Err(StartError::Broken(text)) => panic!("broken: {text}"),
        Ok(_) => panic!("started"),
    }
}

/// Cases whose heights count up from 1.
fn cases(folder: &Path) -> Vec<Case> {
    let heights: Vec<String> = (1..=CASES).map(|n| n.to_string()).collect();
    let text = r#"{
        "about": "An attachment is filled.", "spec": ["none"], "axes": { "height": [HEIGHTS] },
        "scene": {
            "attachments": { "color": { "format": "rgba8unorm", "size": [4, "$height"] } },
            "passes": [{ "color": ["color"], "draws": [
                { "mesh": { "kind": "full" }, "shader": "uniform_color", "params": { "color": [1, 0, 0, 1] } }
            ] }],
            "read": ["color"]
        }
    }"#
    .replace("HEIGHTS", &heights.join(","));
    fs::create_dir_all(folder.join("cases")).unwrap();
    fs::write(folder.join("cases/fill.json"), text).unwrap();
    let library = Library::from_folder(&folder.join("cases")).unwrap();
    library
        .cases(Profile::Full)
        .map(|c| c.build().unwrap())
        .collect()
}

/// Runs all cases on one worker; what was recorded, in order.
fn run(launch: Launch) -> (Vec<Record>, RunSummary) {
    let folder = tempfile::tempdir().unwrap();
    let cases = cases(folder.path());
    let worker = Worker::start(&launch).unwrap_or_else(|e| panic!("{e}"));
    let out = folder.path().join("out");
    let plan = Plan {
        cases: &cases,
        header: Header {
            format: FORMAT,
            etalon: String::new(),
            commit: None,
            machine: Machine::default(),
            started: String::new(),
            command: Vec::new(),
            cases: cases.len() as u64,
            settings: Default::default(),
            adapters: vec![(&worker).into()],
            absent: Vec::new(),
        },
        adapters: vec![(launch, worker)],
        dead: Vec::new(),
        options: Options {
            // A second look starts workers of its own, which these tests count.
            look_again: false,
            timeout: Duration::from_secs(10),
            ..Options::default()
        },
        expectations: &Expectations::default(),
        folder: &out,
        selection: None,
        resume: false,
        stop: &AtomicBool::new(false),
    };
    let told = Mutex::new(Vec::new());
    let outcome = etalon_runner::run(plan, &|event| {
        if let Event::Recorded(record) = event {
            told.lock().unwrap().push(*record);
        }
    });
    let run = Run::read(&out).unwrap();
    assert_eq!(run.missing(), 0);
    assert_eq!(told.into_inner().unwrap(), run.records);
    let ids: Vec<&str> = run.records.iter().map(|r| r.case.as_str()).collect();
    let due: Vec<&str> = cases.iter().map(|c| c.id.as_str()).collect();
    assert_eq!(ids, due, "one record per case");
    (run.records, outcome.unwrap())
}

/// The marked case's record; all others passed.
fn only_marked(launch: Launch, verdict: Verdict) -> Record {
    let fault = format!("{:?}", launch.environment);
    let (records, outcome) = run(launch);
    for (i, record) in records.iter().enumerate() {
        let due = match i + 1 == MARKED as usize {
            true => verdict,
            false => Verdict::Pass,
        };
        assert_eq!(record.verdict, due, "{fault}: {record:?}");
    }
    assert_eq!(outcome.records, CASES as u64);
    assert_eq!(outcome.unexpected, u64::from(verdict.is_bad()), "{fault}");
    records[MARKED as usize - 1].clone()
}

#[test]
fn nothing_goes_wrong_by_itself() {
    only_marked(launch("none"), Verdict::Pass);
}

#[test]
fn a_death_costs_one_case_and_names_its_cause() {
    for step in ["prepare", "submit", "read", "drop"] {
        let record = only_marked(launch(&format!("abort@{step}")), Verdict::Crash);
        assert!(record.message.contains("signal 6 (abort)"), "{record:?}");
        assert!(record.message.contains("about to stumble"), "{record:?}");
        let record = only_marked(launch(&format!("exit@{step}")), Verdict::Crash);
        assert!(record.message.contains("exit status: 7"), "{record:?}");
    }
}

#[test]
fn garbage_on_the_pipe_costs_one_case() {
    for fault in ["garbage@prepare", "garbage@read", "half@submit"] {
        let record = only_marked(launch(fault), Verdict::Crash);
        assert!(record.message.contains("garbage"), "{record:?}");
    }
}

#[test]
fn what_a_backend_reports_becomes_the_verdict() {
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
            assert!(record.message.contains(word), "{record:?}");
        }
    }
}

#[test]
fn a_panic_is_our_own_error_and_no_crash_of_the_driver() {
    for step in ["prepare", "submit", "read", "drop"] {
        let record = only_marked(launch(&format!("panic@{step}")), Verdict::InternalError);
        assert!(record.message.contains("planted panic"), "{record:?}");
    }
}

#[test]
fn answers_stay_with_their_cases_when_a_start_fails_once_or_twice() {
    for failing in ["2", "2 3"] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("starts");
        let mut launch = launch("abort@submit");
        let starts = format!("{} {failing}", file.display());
        launch.environment.push((STARTS.to_owned(), Some(starts)));
        only_marked(launch, Verdict::Crash);
        let started = fs::read_to_string(file).unwrap().lines().count();
        assert_eq!(started, 2 + failing.split(' ').count());
    }
}

#[test]
fn a_worker_that_never_comes_back_leaves_a_record_for_every_case() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("starts");
    let mut launch = launch("abort@submit");
    let starts = format!("{} 2 3 4 5 6 7 8 9", file.display());
    launch.environment.push((STARTS.to_owned(), Some(starts)));
    let (records, outcome) = run(launch);
    for (i, record) in records.iter().enumerate() {
        let number = i as u32 + 1;
        let due = if number < MARKED {
            Verdict::Pass
        } else {
            Verdict::Crash
        };
        assert_eq!(record.verdict, due, "{record:?}");
        if number > MARKED {
            let again = "could not be started again";
            assert!(record.message.contains(again), "{record:?}");
            assert!(record.message.contains("exit status: 9"), "{record:?}");
        }
    }
    assert_eq!(outcome.unexpected, CASES as u64 + 1 - u64::from(MARKED));
    let started = fs::read_to_string(file).unwrap().lines().count();
    assert_eq!(started, 4, "three vain starts are enough");
}
