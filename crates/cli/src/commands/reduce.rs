//! `etalon reduce`.

use crate::adapters::{Query, discover, refuse_absent};
use crate::cases::{find, library};
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::{AdapterFileArguments, Format, parse_timeout};
use crate::interruption::listen;
use crate::output::{summarize, summarize_json};
use crate::reduction::{DriverOracle, Shown, TIMEOUT, confirm, file_name};
use clap::Args;
use etalon_case::{Case, build};
use etalon_explore::{Candidate, Reduction, keys, leaves, states};
use etalon_record::{Record, Symptom, Verdict};
use etalon_runner::{Launch, Trials, Worker};
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// The processes in which a case is drawn at the start, and the drawings in each: a failure that depends on
/// either is no steady one.
const PROCESSES: usize = 4;
const DRAWINGS: usize = 3;
/// The processes of a case that does not end, each of which costs its time.
const HUNG: usize = 2;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Id of the case
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// The adapter on which it fails
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    /// Folder into which the reduced case file is written; `--cases` takes it
    #[arg(long, value_name = "DIR", default_value = "reports/reduced")]
    pub(crate) out: PathBuf,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Seconds that a case may take
    #[arg(long, value_name = "S", default_value = TIMEOUT, value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// Form of the summary
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Reduces a case that fails on an adapter, and writes what is left as a case file.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let library = library(arguments.cases.as_ref())?;
    let found = find(&library, &arguments.case)?;
    let document = found.document().map_err(Failure::usage)?;
    let id = file_name(&arguments.case, &arguments.adapter);
    let case = build(&id, &document).map_err(|e| {
        let message = format!(
            "the scene of `{}` cannot be written as a case file: {e}",
            arguments.case
        );
        Failure::usage(message)
    })?;
    let (launch, worker) = start(arguments)?;
    let name = &arguments.adapter;
    let limits = worker.hello.limits.clone();
    if let Some(missing) = limits.missing(&case.requirements()) {
        return Err(Failure::usage(format!("{name} does not support {missing}")));
    }
    let timeout = Duration::from_secs_f64(arguments.timeout);
    let steady = repeat(&launch, worker, &case, timeout)?;
    let (worker, record, symptom) = match steady {
        Outcome::Steady(steady) => *steady,
        Outcome::Passes(verdict) => {
            return Err(Failure::nothing(format!(
                "{} does not fail on {name}, drawn alone: {verdict}; there is nothing to reduce",
                arguments.case
            )));
        }
        Outcome::Flaky(message) => {
            return Err(Failure {
                code: UNEXPECTED,
                message: format!(
                    "{} is flaky on {name}: {message}; only a steady failure can be reduced",
                    arguments.case
                ),
            });
        }
    };
    let begun = Instant::now();
    let trials = Trials::new(launch.clone(), worker, timeout);
    let mut judge = DriverOracle::new(trials, record, timeout, Some(listen()?));
    let failing = Candidate {
        document: document.clone(),
        case,
    };
    let reduction = judge.reduce(failing, &limits);
    let seconds = begun.elapsed().as_secs_f64();
    if let Some(error) = judge.error {
        return Err(Failure::incomplete(format!(
            "the worker of {name} could not be started again: {error}"
        )));
    }
    confirm(&launch, &reduction.smallest.case, &judge.symptom, timeout).map_err(|message| {
        let code = UNEXPECTED;
        let message = format!("the reduced case of {} {message}", arguments.case);
        Failure { code, message }
    })?;
    let told = Told {
        arguments,
        before: &document["scene"],
        reduction: &reduction,
        record: &judge.record,
        first: &symptom,
        symptom: &judge.symptom,
        seconds,
    };
    let path = arguments.out.join(format!("{id}.json"));
    let text = serde_json::to_string_pretty(&told.document())
        .map_err(|e| Failure::incomplete(format!("cannot write JSON: {e}")))?;
    fs::create_dir_all(&arguments.out)
        .and_then(|()| fs::write(&path, text + "\n"))
        .map_err(|e| Failure::incomplete(format!("cannot write {}: {e}", path.display())))?;
    match arguments.format {
        Format::Text => summarize(&told.text(&path.display().to_string())),
        Format::Json => summarize_json(&told.json(&path.display().to_string()))?,
    }
    Ok(0)
}

fn start(arguments: &Arguments) -> Result<(Launch, Worker), Failure> {
    let names = std::slice::from_ref(&arguments.adapter);
    let adapters = discover(&Query {
        names,
        file: arguments.file.adapter_file.as_deref(),
        ..Query::default()
    })?;
    refuse_absent(names, &adapters.absent)?;
    let mut ready = adapters.ready.into_iter();
    ready
        .next()
        .ok_or_else(|| Failure::usage(format!("adapter {} cannot be used", arguments.adapter)))
}

/// What repeated drawings of a case show.
enum Outcome {
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
) -> Result<Outcome, Failure> {
    let mut records: Vec<Record> = Vec::new();
    let mut worker = Some(first);
    let mut warm = None;
    let mut processes = 0;
    let hung = |records: &[Record]| records.iter().any(|r| r.verdict == Verdict::Timeout);
    while processes < if hung(&records) { HUNG } else { PROCESSES } {
        processes += 1;
        let mut own = match worker.take() {
            Some(worker) => worker,
            None => Worker::start(launch).map_err(Failure::incomplete)?,
        };
        let mut ended = false;
        for _ in 0..DRAWINGS {
            let (record, ends) = own.record(case, timeout);
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
            warm.get_or_insert(own);
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
        None => Outcome::Passes(match record.message.as_str() {
            "" => record.verdict.to_string(),
            message => format!("{}, {message}", record.verdict),
        }),
        Some(way) if ways.len() == drawings => {
            let same = |other: &&Symptom| way.covers(other) && other.covers(way);
            match ways.iter().find(|other| !same(other)) {
                None => Outcome::Steady(Box::new((worker, record, way.clone()))),
                Some(other) => Outcome::Flaky(format!("it fails by {way} and by {other}")),
            }
        }
        Some(_) => Outcome::Flaky(format!(
            "it fails in {} of {drawings} drawings, in {processes} processes",
            ways.len()
        )),
    })
}

/// A reduction, for people and programs.
struct Told<'a> {
    arguments: &'a Arguments,
    before: &'a Value,
    reduction: &'a Reduction,
    record: &'a Record,
    /// The symptom of the case that was reduced.
    first: &'a Symptom,
    symptom: &'a Symptom,
    seconds: f64,
}

impl Told<'_> {
    fn scene(&self) -> &Value {
        &self.reduction.smallest.document["scene"]
    }

    fn shown(&self) -> Shown<'_> {
        Shown {
            document: &self.reduction.smallest.document,
            record: self.record,
            symptom: self.symptom,
        }
    }

    /// Returns the document with what it shows.
    fn document(&self) -> Value {
        let Arguments { case, adapter, .. } = self.arguments;
        self.shown()
            .described(&format!("Reduced from {case} on {adapter}."))
    }

    fn text(&self, path: &str) -> String {
        let share = |count: fn(&Value) -> usize| {
            let (before, after) = (count(self.before), count(self.scene()));
            let dropped = 100.0 * (1.0 - after as f64 / before.max(1) as f64);
            format!("{after} of {before} ({dropped:.1} % less)")
        };
        let mut text = format!(
            "{} on {}\n  keys: {}\n  values: {}\n  draws: {} in {:.1} s{}\n  states: {}\n  {}: {}\n  {}\n",
            self.arguments.case,
            self.arguments.adapter,
            share(keys),
            share(leaves),
            self.reduction.draws,
            self.seconds,
            if self.reduction.finished {
                ""
            } else {
                ", a limit: more may be left to reduce"
            },
            self.shown().states(),
            match self.record.verdict.is_violation() {
                true => "violated".to_owned(),
                false => self.record.verdict.to_string(),
            },
            self.symptom,
            self.shown().sentence(),
        );
        if let Some(clause) = self.shown().clause() {
            text.push_str(&format!("  [{clause}]\n"));
        }
        text.push_str(&format!("Case file: {path}\n"));
        text
    }

    fn json(&self, path: &str) -> Value {
        let count = |count: fn(&Value) -> usize| json!([count(self.before), count(self.scene())]);
        json!({
            "case": self.arguments.case,
            "adapter": self.arguments.adapter,
            "file": path,
            "keys": count(keys),
            "values": count(leaves),
            "draws": self.reduction.draws,
            "finished": self.reduction.finished,
            "seconds": self.seconds,
            "states": states(self.scene()),
            "first_violation": self.first.to_string(),
            "violation": self.symptom.to_string(),
            "sentence": self.shown().sentence(),
            "clause": self.shown().clause(),
        })
    }
}
