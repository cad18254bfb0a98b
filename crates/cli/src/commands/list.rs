//! `etalon list` and `etalon schema`.

use crate::args::ListArguments;
use crate::commands::library;
use crate::failure::Failure;
use crate::output::{print, print_json};

/// Prints the ids of the chosen cases.
pub(crate) fn run(arguments: &ListArguments) -> Result<u8, Failure> {
    let library = library(arguments.selection.cases.as_ref())?;
    let globs = &arguments.selection.globs;
    let selection = etalon_runner::select(&library, globs).map_err(Failure::usage)?;
    if selection.cases.is_empty() {
        return Err(Failure::nothing(format!(
            "no case matches {}; `etalon list` names them all",
            globs.join(" ")
        )));
    }
    let mut text = String::new();
    for case in &selection.cases {
        text.push_str(&case.id());
        text.push('\n');
    }
    print(&text)?;
    Ok(0)
}

/// Prints the JSON schema of case files.
pub(crate) fn schema() -> Result<u8, Failure> {
    print_json(&etalon_case::schema())?;
    Ok(0)
}
