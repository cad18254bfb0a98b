//! `etalon reduce`.

use crate::failure::Failure;
use crate::flags::{AdapterFileArguments, Format, parse_timeout};
use crate::output::{summarize, summarize_json};
use crate::reducing::{Failing, smallest};
use crate::reduction::TIMEOUT;
use clap::Args;
use etalon_diagnose::Symptom;
use etalon_explore::{Reduction, keys, leaves, states};
use etalon_record::Record;
use etalon_report::ReducedCase;
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

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
    let file = arguments.file.adapter_file.as_deref();
    let cases = arguments.cases.as_ref();
    let Failing {
        name,
        candidate,
        launch,
        worker,
    } = Failing::find(&arguments.case, &arguments.adapter, cases, file)?;
    let document = candidate.document.clone();
    let timeout = Duration::from_secs_f64(arguments.timeout);
    let smallest = smallest(&arguments.case, candidate, &launch, worker, timeout)?;
    let report = Told {
        arguments,
        before: &document["scene"],
        reduction: &smallest.reduction,
        record: &smallest.record,
        first: &smallest.first,
        symptom: &smallest.symptom,
        seconds: smallest.seconds,
    };
    let path = arguments.out.join(format!("{name}.json"));
    let text = serde_json::to_string_pretty(&report.document())
        .map_err(|e| Failure::incomplete(format!("cannot write JSON: {e}")))?;
    fs::create_dir_all(&arguments.out)
        .and_then(|()| fs::write(&path, text + "\n"))
        .map_err(|e| Failure::incomplete(format!("cannot write {}: {e}", path.display())))?;
    match arguments.format {
        Format::Text => summarize(&report.text(&path.display().to_string())),
        Format::Json => summarize_json(&report.json(&path.display().to_string()))?,
    }
    Ok(0)
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

    fn reduced(&self) -> ReducedCase<'_> {
        ReducedCase {
            record: self.record,
            symptom: self.symptom,
            states: states(self.scene()),
        }
    }

    /// Returns the document with what it shows.
    fn document(&self) -> Value {
        let Arguments { case, adapter, .. } = self.arguments;
        let about = self
            .reduced()
            .about(&format!("Reduced from {case} on {adapter}."));
        let mut document = self.reduction.smallest.document.clone();
        document["about"] = json!(about);
        document
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
            self.reduced().states(),
            if self.record.verdict.is_violation() {
                "violated".to_owned()
            } else {
                self.record.verdict.to_string()
            },
            self.symptom,
            self.reduced().sentence(),
        );
        if let Some(clause) = self.reduced().clause() {
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
            "sentence": self.reduced().sentence(),
            "clause": self.reduced().clause(),
        })
    }
}
