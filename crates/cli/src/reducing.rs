//! A case that fails on an adapter, as a user names both.

use crate::cases::{find, library};
use crate::discovery::{discover, refuse_absent};
use crate::failure::{Failure, INCOMPLETE, NOTHING, UNEXPECTED, USAGE};
use crate::flags::{AdapterFileArguments, OutputFormat, parse_timeout};
use clap::Args;
use etalon_adapters::Query;
use etalon_case::build;
use etalon_explore::Candidate;
use etalon_report::message;
use etalon_runner::{Launch, ReductionError, Unconfirmed, Worker};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The default time limit of a case in seconds.
pub(crate) const TIMEOUT: &str = "20";

/// Returns the name of a reduced case's file, which is also its id. Characters that ids cannot have become
/// `-`.
pub(crate) fn file_name(case: &str, adapter: &str) -> String {
    let word = |text: &str| -> String {
        let letters = text.chars();
        letters
            .map(|c| {
                if c.is_ascii_alphanumeric() || "-_.+".contains(c) {
                    c
                } else {
                    '-'
                }
            })
            .collect()
    };
    format!("{}.{}", word(case), word(adapter))
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
    pub(crate) format: OutputFormat,
}

impl FailingArguments {
    /// Returns the time limit of a case.
    pub(crate) fn timeout(&self) -> Duration {
        Duration::from_secs_f64(self.timeout)
    }

    /// Returns the name of the reduced case's file, which is also its id.
    pub(crate) fn name(&self) -> String {
        file_name(&self.case, &self.adapter)
    }

    /// Finds the case.
    pub(crate) fn candidate(&self) -> Result<Candidate, Failure> {
        let id = &self.case;
        let library = library(self.cases.as_ref())?;
        let document = find(&library, id)?.document().map_err(Failure::usage)?;
        let case = build(&self.name(), &document).map_err(|e| {
            let message = format!("the scene of `{id}` cannot be written as a case file: {e}");
            Failure::usage(message)
        })?;
        Ok(Candidate { document, case })
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
        let candidate = arguments.candidate()?;
        let adapter = &arguments.adapter;
        let (launch, worker) = start(adapter, arguments.adapter_file())?;
        let limits = &worker.hello.limits;
        if let Some(missing) = limits.missing(&candidate.case.requirements()) {
            let message = format!("{adapter} does not support {missing}");
            return Err(Failure::usage(message));
        }
        Ok(Self {
            name: arguments.name(),
            candidate,
            launch,
            worker,
        })
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
    refuse_absent(names, &adapters)?;
    let mut ready = adapters.ready.into_iter();
    ready
        .next()
        .ok_or_else(|| Failure::usage(format!("adapter {} cannot be used", names.join(", "))))
}

impl From<ReductionError> for Failure {
    fn from(error: ReductionError) -> Self {
        let code = match error {
            ReductionError::Start(_)
            | ReductionError::Lost(_)
            | ReductionError::Unconfirmed {
                why: Unconfirmed::Start(_),
                ..
            } => INCOMPLETE,
            ReductionError::NotSupported { .. } => USAGE,
            ReductionError::Passes { .. } => NOTHING,
            ReductionError::Flaky { .. } | ReductionError::Unconfirmed { .. } => UNEXPECTED,
        };
        let why = match &error {
            ReductionError::NotSupported { record, .. } => message(record),
            ReductionError::Passes { record, .. } => match message(record).as_str() {
                "" => record.verdict.to_string(),
                words => format!("{}, {words}", record.verdict),
            },
            _ => String::new(),
        };
        let message = match why.as_str() {
            "" => error.to_string(),
            why => format!("{error} ({why})"),
        };
        Self { code, message }
    }
}
