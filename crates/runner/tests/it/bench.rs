//! Benches of workers that draw wrongly, crash or change their picture. No time is asserted, only the events
//! and their order.

use crate::cases::cases;
use crate::worker::{FAULT, NAME, fail_starts, launch, serve, starts};
use etalon_backend::{Backend, BackendError, FrameTime, Prepared};
use etalon_cpu::CpuBackend;
use etalon_frame::{AdapterInfo, Frame, Limits};
use etalon_record::{
    BENCH_FORMAT, Bench, BenchHeader, Expectations, LossKind, Provenance, Reason, ShaderCache,
    Verdict,
};
use etalon_runner::{BenchEvent, BenchPlan, BenchSummary, Launch, Worker};
use etalon_scene::Scene;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use tempfile::TempDir;

/// The height of the scene that goes wrong.
const MARKED: u32 = 2;
const CASES: u32 = 3;
const ROUNDS: u32 = 3;

struct Faulty {
    inner: CpuBackend,
    fault: String,
}

struct FaultyScene<'a> {
    inner: Box<dyn Prepared + 'a>,
    fault: &'a str,
    frames: u32,
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
        Ok(Box::new(FaultyScene {
            inner: self.inner.prepare(scene)?,
            fault: if marked { &self.fault } else { "" },
            frames: 0,
        }))
    }
}

impl Prepared for FaultyScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        self.frames += 1;
        // One frame is drawn for judging, several for timing.
        match (self.fault, self.frames) {
            ("dies", 2) | ("dies at once", 1) => std::process::abort(),
            ("lost", 2) => Err(BackendError::lost("planted")),
            _ => self.inner.submit(),
        }
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let mut frame = self.inner.read_back()?;
        if self.fault == "wrong" || (self.fault == "fickle" && self.frames > 1) {
            frame.images[0].codes[0] ^= 0x80;
        }
        Ok(frame)
    }
}

#[test]
#[ignore = "the worker's side, which the other tests start"]
fn worker() {
    let (Ok(name), Ok(fault)) = (std::env::var(NAME), std::env::var(FAULT)) else {
        return;
    };
    let inner = CpuBackend::new(&name);
    serve(|| Ok(Box::new(Faulty { inner, fault }) as Box<dyn Backend>));
}

fn adapter(name: &str, fault: &str) -> (Launch, Worker) {
    started(launch("bench::worker", name, fault))
}

fn started(launch: Launch) -> (Launch, Worker) {
    let worker = Worker::start(&launch).unwrap_or_else(|e| panic!("{e}"));
    (launch, worker)
}

/// Benches all cases. Returns the bench as it was read back, and the events as `what adapter case` in order.
fn bench(adapters: Vec<(Launch, Worker)>) -> (Bench, BenchSummary, Vec<String>) {
    let folder: TempDir = tempfile::tempdir().unwrap();
    let cases = cases(&folder.path().join("cases"), CASES);
    let out = folder.path().join("out");
    let header = BenchHeader {
        format: BENCH_FORMAT,
        provenance: Provenance {
            ..Provenance::default()
        },
        profile: "full".to_owned(),
        cases: cases.len() as u64,
        rounds: ROUNDS,
        shader_cache: ShaderCache::Warm,
        ruler: etalon_runner::ruler().to_owned(),
        limits: Vec::new(),
        settings: Default::default(),
        adapters: adapters.iter().map(|(_, w)| w.into()).collect(),
        absent: Vec::new(),
    };
    let plan = BenchPlan {
        stop: &AtomicBool::new(false),
        cases: &cases,
        adapters,
        budget: Duration::from_millis(2),
        timeout: std::time::Duration::from_secs(60),
        counter: None,
        resume: false,
        expectations: &Expectations::default(),
        folder: &out,
        header,
    };
    let mut events = Vec::new();
    let outcome = etalon_runner::bench(plan, &mut |event| {
        events.push(match event {
            BenchEvent::Judged { picture, .. } => {
                format!("judged {} {}", picture.adapter, picture.case)
            }
            BenchEvent::Counted { .. } => unreachable!("nothing is counted"),
            BenchEvent::Timed { case, adapter } => format!("timed {adapter} {case}"),
            BenchEvent::Done { done, spared } => {
                format!("done {} {} {spared}", done.adapter, done.case)
            }
            BenchEvent::Ended { ended, missing } => {
                format!("ended {} {} {missing}", ended.adapter, ended.case)
            }
        });
    })
    .unwrap();
    let bench = Bench::read(&out).unwrap();
    assert!(!bench.truncated);
    (bench, outcome, events)
}

#[test]
fn adapters_take_turns_case_after_case_and_round_after_round() {
    let names = ["a", "b", "c"];
    let (bench, outcome, events) = bench(names.map(|n| adapter(n, "")).into());
    let turns = |what: &str| -> Vec<String> {
        let heights = 1..=CASES;
        heights
            .flat_map(|h| names.map(|n| format!("{what} {n} fill/height={h}")))
            .collect()
    };
    let mut expected = turns("judged");
    for _ in 0..ROUNDS {
        expected.extend(turns("timed"));
    }
    assert_eq!(events, expected);
    let nine = u64::from(CASES) * 3;
    let all_fine = BenchSummary {
        pictures: nine,
        timed: nine,
        unexpected: 0,
    };
    assert_eq!(outcome, all_fine);
    assert_eq!(bench.missing(), 0);
    assert_eq!(bench.records.len() as u64, nine);
    for record in &bench.records {
        assert_eq!(record.picture.verdict, Verdict::Pass, "{record:?}");
        assert_eq!(record.picture.asserted, 1.0);
        assert_eq!(record.ended, None);
        let numbers: Vec<u32> = record.rounds.iter().map(|r| r.round).collect();
        assert_eq!(numbers, [0, 1, 2]);
        for round in &record.rounds {
            assert!(round.warm_up >= 2, "{round:?}");
            assert!((3..=25).contains(&round.wall.len()), "{round:?}");
            assert_eq!(round.cpu.len(), round.wall.len());
            // The rasterizer has no timestamps.
            assert_eq!(round.gpu, [0.0; 0]);
            assert!((1..=3).contains(&round.read_back.len()), "{round:?}");
        }
    }
    // Measurements follow the clock.
    let rounds = |n: usize| bench.records.iter().map(move |r| r.rounds[n].at);
    let times: Vec<f64> = (0..ROUNDS as usize).flat_map(rounds).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
}

/// Benches a faulty adapter together with a good one. Returns the record of the marked case; all others must
/// be complete.
fn marked(fault: &str) -> (etalon_record::BenchRecord, BenchSummary) {
    let (bench, outcome, _) = bench(vec![adapter("faulty", fault), adapter("good", "")]);
    let mut found = None;
    for record in bench.records {
        let picture = &record.picture;
        if picture.adapter == "faulty" && picture.case == format!("fill/height={MARKED}") {
            found = Some(record);
            continue;
        }
        assert_eq!(picture.verdict, Verdict::Pass, "{fault}: {picture:?}");
        assert_eq!(record.rounds.len() as u32, ROUNDS, "{fault}: {picture:?}");
        assert_eq!(record.ended, None, "{fault}");
    }
    (found.unwrap(), outcome)
}

/// Returns true if a process died of an abort.
fn died(reasons: &[Reason]) -> bool {
    let aborted = |reason: &Reason| matches!(reason, Reason::Process(end) if end.signal == Some(6));
    reasons.iter().any(aborted)
}

#[test]
fn a_wrong_picture_is_not_timed() {
    let (record, outcome) = marked("wrong");
    assert_eq!(record.picture.verdict, Verdict::Fail);
    let first = |reason: &Reason| matches!(reason, Reason::FirstWrong { at: [0, 0], .. });
    assert!(record.picture.reasons.iter().any(first), "{record:?}");
    assert_eq!(record.rounds, []);
    assert_eq!((outcome.timed, outcome.unexpected), (5, 1));
}

#[test]
fn a_worker_that_dies_while_it_is_judged_costs_one_case() {
    let (record, outcome) = marked("dies at once");
    assert_eq!(record.picture.verdict, Verdict::Crash);
    assert!(died(&record.picture.reasons), "{record:?}");
    assert_eq!(record.rounds, []);
    assert_eq!((outcome.timed, outcome.unexpected), (5, 1));
}

#[test]
fn a_worker_that_dies_while_it_is_timed_costs_one_case() {
    for (fault, verdict) in [("dies", Verdict::Crash), ("lost", Verdict::DeviceLost)] {
        let (record, outcome) = marked(fault);
        assert_eq!(record.picture.verdict, Verdict::Pass);
        assert_eq!(record.rounds, []);
        let ended = record.ended.unwrap();
        assert_eq!(ended.verdict, verdict);
        assert_eq!(died(&ended.reasons), fault == "dies", "{ended:?}");
        assert!(!ended.reasons.is_empty());
        assert_eq!((outcome.timed, outcome.unexpected), (6, 1));
    }
}

#[test]
fn a_worker_that_never_comes_back_costs_its_adapter_alone() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("starts");
    let mut launch = launch("bench::worker", "faulty", "dies at once");
    fail_starts(&mut launch, &file, "2 3 4 5 6 7 8 9");
    let (bench, outcome, _) = bench(vec![started(launch), adapter("good", "")]);
    for height in 1..=CASES {
        let case = format!("fill/height={height}");
        let good = bench.record(&case, "good").unwrap();
        assert_eq!((good.rounds.len() as u32, &good.ended), (ROUNDS, &None));
        let faulty = bench.record(&case, "faulty").unwrap();
        assert_eq!(faulty.rounds, []);
        let (verdict, reasons) = match &faulty.ended {
            Some(ended) => (ended.verdict, &ended.reasons),
            None => (faulty.picture.verdict, &faulty.picture.reasons),
        };
        assert_eq!(verdict, Verdict::Crash);
        if height == MARKED {
            assert!(died(reasons), "{reasons:?}");
        } else {
            let [Reason::Process(end)] = &reasons[..] else {
                panic!("{height}: {reasons:?}");
            };
            assert_eq!(end.kind, LossKind::NotStarted, "{height}");
        }
        assert_eq!(faulty.ended.is_some(), height < MARKED);
    }
    assert_eq!((outcome.timed, outcome.unexpected), (4, 3));
    assert_eq!(starts(&file), 4, "three failed starts are enough");
}

#[test]
fn a_picture_that_changes_is_flaky() {
    let (record, outcome) = marked("fickle");
    assert_eq!(record.picture.verdict, Verdict::Pass);
    assert_eq!(record.rounds.len(), 1);
    let ended = record.ended.unwrap();
    assert_eq!(ended.verdict, Verdict::Flaky);
    let changed = |r: &Reason| matches!(r, Reason::ChangedPicture(c) if c.contains("Invariance"));
    assert!(ended.reasons.iter().any(changed), "{ended:?}");
    assert_eq!(outcome.unexpected, 1);
}

#[test]
fn an_unwritable_folder_is_an_error_before_anything_is_timed() {
    let folder = tempfile::tempdir().unwrap();
    let cases = cases(folder.path(), CASES);
    let blocked = folder.path().join("fill.json");
    let lone_adapter = adapter("a", "");
    let plan = BenchPlan {
        stop: &AtomicBool::new(false),
        cases: &cases,
        budget: Duration::from_millis(1),
        timeout: std::time::Duration::from_secs(60),
        counter: None,
        resume: false,
        expectations: &Expectations::default(),
        folder: &blocked,
        header: BenchHeader {
            format: BENCH_FORMAT,
            provenance: Provenance {
                ..Provenance::default()
            },
            profile: "full".to_owned(),
            cases: cases.len() as u64,
            rounds: 1,
            shader_cache: ShaderCache::Warm,
            ruler: String::new(),
            limits: Vec::new(),
            settings: Default::default(),
            adapters: vec![(&lone_adapter.1).into()],
            absent: Vec::new(),
        },
        adapters: vec![lone_adapter],
    };
    let outcome = etalon_runner::bench(plan, &mut |event| panic!("{event:?}"));
    assert!(
        matches!(outcome, Err(etalon_runner::BenchError::Folder(_))),
        "{outcome:?}"
    );
}
