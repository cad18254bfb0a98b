//! `etalon reduce`.

use crate::failure::Failure;
use crate::flags::OutputFormat;
use crate::interruption::listen;
use crate::named_files::NamedFiles;
use crate::out_folder::apart;
use crate::output::{print_json, summarize};
use crate::reducing::{Failing, FailingArguments};
use clap::Args;
use etalon_diagnose::Symptom;
use etalon_explore::{Reduction, keys, leaves, states};
use etalon_record::Record;
use etalon_report::ReducedCase;
use etalon_runner::smallest;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) failing: FailingArguments,
    /// Folder for the reduced case file; `--cases` accepts it
    #[arg(long, value_name = "DIR", default_value = "reports/reduced")]
    pub(crate) out: PathBuf,
    /// Replace the file of the same name
    #[arg(long)]
    pub(crate) force: bool,
}

/// Reduces a case that fails on an adapter, and writes the result as a case file.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let failing = &arguments.failing;
    apart(&arguments.out, failing.cases.as_deref())?;
    let Failing {
        name,
        candidate,
        launch,
        worker,
    } = Failing::find(failing)?;
    let name = format!("{name}.json");
    let out = NamedFiles {
        folder: &arguments.out,
        force: arguments.force,
    };
    out.check([&name])?;
    let path = arguments.out.join(&name);
    let document = candidate.document.clone();
    let timeout = failing.timeout();
    let smallest = smallest(
        &failing.case,
        candidate,
        &launch,
        worker,
        timeout,
        listen()?,
    )?;
    let report = ToldReduction {
        arguments,
        before: &document["scene"],
        reduction: &smallest.reduction,
        record: &smallest.record,
        first: &smallest.first,
        symptom: &smallest.symptom,
        seconds: smallest.seconds,
    };
    let text = serde_json::to_string_pretty(&report.document())
        .map_err(|e| Failure::incomplete(format!("cannot write JSON: {e}")))?;
    out.write(&[(name, (text + "\n").into_bytes())])?;
    match arguments.failing.format {
        OutputFormat::Text => summarize(&report.text(&path.display().to_string())),
        OutputFormat::Json => print_json(&report.json(&path.display().to_string()))?,
    }
    Ok(0)
}

/// A reduction, for text and JSON.
struct ToldReduction<'a> {
    arguments: &'a Arguments,
    before: &'a Value,
    reduction: &'a Reduction,
    record: &'a Record,
    /// The symptom of the case that was reduced.
    first: &'a Symptom,
    symptom: &'a Symptom,
    seconds: f64,
}

impl ToldReduction<'_> {
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

    /// Returns the document with a description of what it shows.
    fn document(&self) -> Value {
        let FailingArguments { case, adapter, .. } = &self.arguments.failing;
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
            self.arguments.failing.case,
            self.arguments.failing.adapter,
            share(keys),
            share(leaves),
            self.reduction.draws,
            self.seconds,
            if self.reduction.finished {
                ""
            } else {
                ", stopped at a limit: it might be reducible further"
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
            "case": self.arguments.failing.case,
            "adapter": self.arguments.failing.adapter,
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
