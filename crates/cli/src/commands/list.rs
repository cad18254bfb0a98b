//! `etalon list`.

use crate::cases::{chosen, chosen_ids};
use crate::failure::Failure;
use crate::flags::{CaseArguments, Format};
use crate::output::{print, print_json};
use clap::Args;
use etalon_case::Case;
use serde_json::{Map, Value, json};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
    /// Output format; JSON has the purpose, axes and requirements of each case
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Prints the ids of the selected cases.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    if arguments.format == Format::Json {
        let cases = chosen(&arguments.selection)?;
        print_json(&cases.iter().map(facts).collect::<Vec<_>>())?;
        return Ok(0);
    }
    let mut text = String::new();
    for id in chosen_ids(&arguments.selection)? {
        text.push_str(&id);
        text.push('\n');
    }
    print(&text)?;
    Ok(0)
}

/// Returns what is known of a case without drawing it.
fn facts(case: &Case) -> Value {
    let parts = case.id.split('/').filter_map(|part| part.split_once('='));
    let axes: Map<String, Value> = parts
        .map(|(axis, value)| (axis.to_owned(), value.into()))
        .collect();
    let file: Vec<&str> = case
        .id
        .split('/')
        .take_while(|part| !part.contains('='))
        .collect();
    let features: Vec<String> = case
        .requirements()
        .iter()
        .map(ToString::to_string)
        .collect();
    json!({
        "id": case.id,
        "area": case.area(),
        "file": file.join("/"),
        "about": case.about,
        "spec": case.spec,
        "axes": axes,
        "features": features,
    })
}
