//! The way from a case that fails on an adapter to the smallest one that fails in the same way.

use crate::adapters::{Query, discover, refuse_absent};
use crate::cases::{find, library};
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::{AdapterFileArguments, Format, parse_timeout};
use crate::interruption::listen;
use crate::reduction::{DriverOracle, TIMEOUT, confirm, file_name};
use clap::Args;
use etalon_case::{Case, build};
use etalon_diagnose::Symptom;
use etalon_explore::{Candidate, MOST_DRAWS, Reduction};
use etalon_record::{Record, Verdict};
use etalon_runner::{Launch, Trials, Worker};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The processes in which a case is drawn at the start, and the drawings in each: a failure that depends on
/// either is no steady one.
const PROCESSES: usize = 4;
const DRAWINGS: usize = 3;
/// The processes of a case that does not end, each of which costs its time.
const HUNG: usize = 2;

/// A reduced case.
pub(crate) struct Smallest {
    pub(crate) reduction: Reduction,
    /// Its record.
    pub(crate) record: Record,
    /// The symptom of the case that was reduced.
    pub(crate) first: Symptom,
    /// The symptom of the reduced case.
    pub(crate) symptom: Symptom,
    /// The time of the reduction.
    pub(crate) seconds: f64,
}

/// Flags that name a failing case and its adapter.
#[derive(Debug, Args)]
pub(crate) struct FailingArguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Id of the case
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// Adapter on which the case fails
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Time limit of a case in seconds
    #[arg(long, value_name = "S", default_value = TIMEOUT, value_parser = parse_timeout)]
    timeout: f64,
    /// Format of the summary
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

impl FailingArguments {
    /// Returns the time limit of a case.
    pub(crate) fn timeout(&self) -> Duration {
        Duration::from_secs_f64(self.timeout)
    }

    /// Returns the file of adapters.
    pub(crate) fn adapter_file(&self) -> Option<&Path> {
        self.file.adapter_file.as_deref()
    }
}

/// A case to reduce, and the adapter on which it fails.
pub(crate) struct Failing {
    /// The name of its file, which is also its id.
    pub(crate) name: String,
    pub(crate) candidate: Candidate,
    pub(crate) launch: Launch,
    pub(crate) worker: Worker,
}

impl Failing {
    /// Finds a case by its id, and starts the adapter.
    pub(crate) fn find(arguments: &FailingArguments) -> Result<Self, Failure> {
        let FailingArguments {
            case: id, adapter, ..
        } = arguments;
        let library = library(arguments.cases.as_ref())?;
        let document = find(&library, id)?.document().map_err(Failure::usage)?;
        let name = file_name(id, adapter);
        let case = build(&name, &document).map_err(|e| {
            let message = format!("the scene of `{id}` cannot be written as a case file: {e}");
            Failure::usage(message)
        })?;
        let (launch, worker) = start(adapter, arguments.adapter_file())?;
        if let Some(missing) = worker.hello.limits.missing(&case.requirements()) {
            let message = format!("{adapter} does not support {missing}");
            return Err(Failure::usage(message));
        }
        Ok(Self {
            name,
            candidate: Candidate { document, case },
            launch,
            worker,
        })
    }
}

/// Reduces a case that fails in the same way every time. `id` is the id that the user gave.
pub(crate) fn smallest(
    id: &str,
    failing: Candidate,
    launch: &Launch,
    worker: Worker,
    timeout: Duration,
) -> Result<Smallest, Failure> {
    let name = &launch.adapter;
    let limits = worker.hello.limits.clone();
    let (worker, record, first) = steady(id, &failing.case, launch, worker, timeout)?;
    let begun = Instant::now();
    let stop = listen()?;
    let reduced = |worker: Worker, alone: Option<Launch>| {
        let trials = Trials::new(launch.clone(), worker, timeout);
        let mut judge = DriverOracle::new(trials, record.clone(), timeout, Some(stop));
        judge.alone = alone;
        let reduction = judge.reduce(failing.clone(), &limits, MOST_DRAWS);
        match judge.error {
            Some(error) => Err(Failure::incomplete(format!(
                "the worker of {name} could not be started again: {error}"
            ))),
            None => Ok((reduction, judge.record, judge.symptom)),
        }
    };
    let confirmed = |reduction: &Reduction, symptom: &Symptom| {
        confirm(launch, &reduction.smallest.case, symptom, timeout)
    };
    let (mut reduction, mut last, mut symptom) = reduced(worker, None)?;
    if confirmed(&reduction, &symptom).is_err() {
        let fresh = Worker::start(launch).map_err(Failure::incomplete)?;
        let draws = reduction.draws;
        (reduction, last, symptom) = reduced(fresh, Some(launch.clone()))?;
        reduction.draws += draws;
        confirmed(&reduction, &symptom).map_err(|message| {
            let code = UNEXPECTED;
            let message = format!("the reduced case of {id} {message}");
            Failure { code, message }
        })?;
    }
    let seconds = begun.elapsed().as_secs_f64();
    Ok(Smallest {
        reduction,
        record: last,
        first,
        symptom,
        seconds,
    })
}

/// Draws a case several times in several processes. Returns a worker, a record and the symptom if it fails in the same
/// way every time.
pub(crate) fn steady(
    id: &str,
    case: &Case,
    launch: &Launch,
    worker: Worker,
    timeout: Duration,
) -> Result<(Worker, Record, Symptom), Failure> {
    let name = &launch.adapter;
    match repeat(launch, worker, case, timeout)? {
        Repetitions::Steady(steady) => Ok(*steady),
        Repetitions::Passes(verdict) => Err(Failure::nothing(format!(
            "{id} does not fail on {name}, drawn alone: {verdict}; there is nothing to reduce"
        ))),
        Repetitions::Flaky(message) => Err(Failure {
            code: UNEXPECTED,
            message: format!(
                "{id} is flaky on {name}: {message}; only a steady failure can be reduced"
            ),
        }),
    }
}

/// Starts the worker of an adapter.
pub(crate) fn start(adapter: &String, file: Option<&Path>) -> Result<(Launch, Worker), Failure> {
    started(Query {
        names: std::slice::from_ref(adapter),
        file,
        ..Query::default()
    })
}

/// Starts the worker of the first adapter that a query finds.
pub(crate) fn started(query: Query<'_>) -> Result<(Launch, Worker), Failure> {
    let names = query.names;
    let adapters = discover(&query)?;
    refuse_absent(names, &adapters.absent)?;
    let mut ready = adapters.ready.into_iter();
    ready
        .next()
        .ok_or_else(|| Failure::usage(format!("adapter {} cannot be used", names.join(", "))))
}

/// The outcome of repeated drawings of a case.
enum Repetitions {
    /// It fails in the same way every time.
    Steady(Box<(Worker, Record, Symptom)>),
    /// It never fails.
    Passes(String),
    /// It fails sometimes, or in several ways.
    Flaky(String),
}

/// Draws a case several times in several processes, each time alone; once in each that it ends.
fn repeat(
    launch: &Launch,
    first: Worker,
    case: &Case,
    timeout: Duration,
) -> Result<Repetitions, Failure> {
    let mut records: Vec<Record> = Vec::new();
    let mut worker = Some(first);
    let mut warm = None;
    let mut processes = 0;
    let hung = |records: &[Record]| records.iter().any(|r| r.verdict == Verdict::Timeout);
    while processes < if hung(&records) { HUNG } else { PROCESSES } {
        processes += 1;
        let mut running = match worker.take() {
            Some(worker) => worker,
            None => Worker::start(launch).map_err(Failure::incomplete)?,
        };
        let mut ended = false;
        for _ in 0..DRAWINGS {
            let (record, ends) = running.record(case, timeout);
            if record.verdict == Verdict::NotSupported {
                let (name, message) = (&launch.adapter, record.message);
                return Err(Failure::usage(format!("{name} does not support {message}")));
            }
            records.push(record);
            ended = ends;
            if ended {
                break;
            }
        }
        if !ended {
            warm.get_or_insert(running);
        }
    }
    let worker = match warm {
        Some(worker) => worker,
        None => Worker::start(launch).map_err(Failure::incomplete)?,
    };
    let drawings = records.len();
    let failing = |r: &&Record| r.verdict.is_bad() && r.verdict != Verdict::Open;
    let ways: Vec<Symptom> = records.iter().filter(failing).map(Symptom::of).collect();
    let Some(record) = records.into_iter().next() else {
        return Err(Failure::incomplete("nothing was drawn"));
    };
    Ok(match ways.first() {
        None => Repetitions::Passes(match record.message.as_str() {
            "" => record.verdict.to_string(),
            message => format!("{}, {message}", record.verdict),
        }),
        Some(way) if ways.len() == drawings => {
            let same = |other: &&Symptom| way.covers(other) && other.covers(way);
            match ways.iter().find(|other| !same(other)) {
                None => Repetitions::Steady(Box::new((worker, record, way.clone()))),
                Some(other) => Repetitions::Flaky(format!("it fails by {way} and by {other}")),
            }
        }
        Some(_) => Repetitions::Flaky(format!(
            "it fails in {} of {drawings} drawings, in {processes} processes",
            ways.len()
        )),
    })
}
