//! Reads and writes expectations.

use crate::failure::Failure;
use crate::named_files::replace;
use crate::provenance;
use clap::Args;
use etalon_explore::fact_names;
use etalon_glob::{Glob, did_you_mean};
use etalon_record::{Entry, Expectations, RecordError};
use std::path::{Path, PathBuf};

/// Flags for expectations of the user's own.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ExpectArguments {
    /// Add these expectations to the built-in findings: a list, a finding, or a folder of findings; may be repeated
    #[arg(long, value_name = "PATH")]
    pub(crate) expect: Vec<PathBuf>,
    /// Ignore the built-in findings; expect only what --expect names
    #[arg(long)]
    pub(crate) expect_only: bool,
}

impl ExpectArguments {
    /// Returns the expectations that apply today, to a run with these labels on this machine. The user's come
    /// before the findings.
    pub(crate) fn read(&self, labels: &[String]) -> Result<Expectations, Failure> {
        let mut expectations = Expectations::default();
        for path in &self.expect {
            let more = Expectations::read(path).map_err(Failure::usage)?;
            check_needs(&more)?;
            expectations = expectations.and(more);
        }
        if !self.expect_only {
            expectations = expectations.and(findings()?);
        }
        Ok(counting(expectations, labels))
    }
}

/// Checks that draws can have the facts that findings need.
fn check_needs(expectations: &Expectations) -> Result<(), Failure> {
    let facts: Vec<String> = fact_names().collect();
    for known in expectations.all() {
        let can_be = |need: &&String| {
            Glob::new(need).is_ok_and(|need| facts.iter().any(|fact| need.is_match(fact)))
        };
        if let Some(need) = known.needs.iter().find(|need| !can_be(need)) {
            let near = did_you_mean(need, facts.iter().map(String::as_str));
            return Err(Failure::usage(format!(
                "{}: \"needs\": no draw has a fact `{need}`{near}; `etalon check --pairs` lists the facts",
                known.place()
            )));
        }
    }
    Ok(())
}

/// Returns the built-in findings that apply today on this machine.
pub(crate) fn built_in() -> Result<Expectations, Failure> {
    Ok(counting(findings()?, &[]))
}

/// Returns the built-in findings.
pub(crate) fn findings() -> Result<Expectations, Failure> {
    etalon_findings::findings().map_err(Failure::usage)
}

/// Returns the expectations that apply today, to a run with these labels on this machine.
pub(crate) fn counting(expectations: Expectations, labels: &[String]) -> Expectations {
    let machine = provenance::machine();
    expectations.of_run(&machine.cpu, labels).on(&today())
}

/// Returns the current day in UTC, such as `2027-01-31`.
pub(crate) fn today() -> String {
    provenance::now().chars().take(10).collect()
}

/// Writes entries to a file.
pub(crate) fn write(path: &Path, entries: &[Entry]) -> Result<(), Failure> {
    let text = Expectations::to_text(entries).map_err(Failure::usage)?;
    // An invalid file must not replace a valid one.
    Expectations::parse(&text, path).map_err(|error: RecordError| Failure::usage(error))?;
    replace(path, text.as_bytes())
}
