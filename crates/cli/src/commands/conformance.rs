//! `etalon conformance`.

use crate::failure::{Failure, INCOMPLETE, UNEXPECTED};
use crate::flags::{AdapterFileArguments, OutputFormat};
use crate::output::{print, print_json};
use crate::reducing::start;
use clap::Args;
use etalon_conformance::{CheckResult, check_each, first_topic};
use etalon_frame::printable;
use etalon_runner::RemoteBackend;
use serde_json::{Value, json};
use std::panic;
use std::time::Duration;

/// The time that one scene of a check may take.
const TIMEOUT: Duration = Duration::from_secs(20);
/// The most characters of the message of a failed check.
const MOST_MESSAGE: usize = 400;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// The adapter to check
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// The results of all checks.
#[derive(Default)]
struct CheckResults {
    passed: Vec<&'static str>,
    /// The checks that need what the adapter does not have.
    skipped: Vec<&'static str>,
    /// The failed checks with their messages.
    failed: Vec<(&'static str, String)>,
}

/// Runs every check on an adapter, and says what to fix first.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let (launch, worker) = start(&arguments.adapter, arguments.file.adapter_file.as_deref())?;
    let backend = RemoteBackend::new(launch, worker, TIMEOUT);
    // A check fails by panicking; its message is printed below.
    panic::set_hook(Box::new(|_| {}));
    let mut results = CheckResults::default();
    check_each(&backend, |check, result| match result {
        Ok(CheckResult::Passed(_)) => results.passed.push(check.name),
        Ok(CheckResult::Skipped(_)) => results.skipped.push(check.name),
        Err(message) => {
            let message = printable(&message, MOST_MESSAGE);
            results.failed.push((check.name, message));
        }
    });
    drop(panic::take_hook());
    match arguments.format {
        OutputFormat::Text => print(&results.text(&arguments.adapter))?,
        OutputFormat::Json => print_json(&results.json(&arguments.adapter))?,
    }
    Ok(
        match (results.failed.is_empty(), results.passed.is_empty()) {
            (false, _) => UNEXPECTED,
            (true, true) => INCOMPLETE,
            (true, false) => 0,
        },
    )
}

impl CheckResults {
    fn names(&self) -> Vec<&'static str> {
        self.failed.iter().map(|(name, _)| *name).collect()
    }

    fn text(&self, adapter: &str) -> String {
        let [passed, skipped, failed] = [self.passed.len(), self.skipped.len(), self.failed.len()];
        let mut text = String::new();
        for (name, message) in &self.failed {
            text += &format!("fail  {name}\n      {message}\n");
        }
        text += &format!(
            "{adapter}: {passed} checks pass, {failed} fail, {skipped} need what it does not have\n"
        );
        match first_topic(&self.names()) {
            Some((topic, checks)) => {
                text += &format!("Fix first: {}. Expected: {}.\n", topic.name, topic.rule);
                text += &format!("It is the subject of {}.\n", checks.join(", "));
            }
            None => {
                if let Some((name, _)) = self.failed.first() {
                    text += &format!("Fix first: {name}\n");
                }
            }
        }
        text
    }

    fn json(&self, adapter: &str) -> Value {
        let failed = self.failed.iter();
        let failed: Vec<Value> = failed
            .map(|(name, message)| json!({ "check": name, "message": message }))
            .collect();
        let names = self.names();
        let topic = first_topic(&names);
        let first = topic.map(|(topic, checks)| {
            json!({ "topic": topic.name, "expected": topic.rule, "checks": checks })
        });
        json!({
            "adapter": adapter,
            "passed": self.passed,
            "skipped": self.skipped,
            "failed": failed,
            "fix_first": first,
        })
    }
}
