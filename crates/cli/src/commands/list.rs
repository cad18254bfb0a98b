//! `etalon list`.

use crate::cases::{chosen, chosen_ids, leave_measured, left_out};
use crate::failure::Failure;
use crate::flags::{CaseArguments, OutputFormat};
use crate::output::{print, print_json, say};
use clap::Args;
use etalon_case::Case;
use serde_json::{Map, Value, json};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
    /// Output format; JSON has the purpose, axes and requirements of each case
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Prints the ids of the cases that `run` would draw, and the numbers of cases that it would leave out.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let Arguments { selection, format } = arguments;
    if *format == OutputFormat::Json {
        let mut cases = chosen(selection)?;
        let measured = leave_measured(&mut cases, selection, |case| case.measured);
        print_json(&cases.iter().map(facts).collect::<Vec<_>>())?;
        let ids: Vec<String> = cases.into_iter().map(|case| case.id).collect();
        tell_left_out(selection, measured, &ids)?;
        return Ok(0);
    }
    let mut cases = chosen_ids(selection)?;
    let measured = leave_measured(&mut cases, selection, |(_, measured)| *measured);
    let ids: Vec<String> = cases.into_iter().map(|(id, _)| id).collect();
    print(&format!("{}\n", ids.join("\n")))?;
    tell_left_out(selection, measured, &ids)?;
    Ok(0)
}

/// Prints how many cases are left out.
fn tell_left_out(
    selection: &CaseArguments,
    measured: usize,
    ids: &[String],
) -> Result<(), Failure> {
    if measured > 0 {
        say!(
            "left out: {measured} cases that are measured; a glob that names them lists and draws them"
        );
    }
    let by_profile = left_out(selection, ids)?;
    if by_profile > 0 {
        say!("left out: {by_profile} cases that --profile full has");
    }
    Ok(())
}

/// Returns the facts about a case that need no drawing.
fn facts(case: &Case) -> Value {
    let parts = case.parts();
    let axes: Map<String, Value> = parts
        .axes()
        .map(|(axis, value)| (axis.to_owned(), value.into()))
        .collect();
    let features: Vec<String> = case
        .requirements()
        .iter()
        .map(ToString::to_string)
        .collect();
    json!({
        "id": case.id,
        "area": parts.area(),
        "file": parts.file(),
        "about": case.about,
        "spec": case.spec,
        "axes": axes,
        "features": features,
    })
}
