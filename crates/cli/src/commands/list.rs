//! `etalon list` and `etalon schema`.

use crate::args::ListArguments;
use crate::commands::chosen;
use crate::failure::Failure;
use crate::output::{print, print_json};

/// Prints the ids of the chosen cases.
pub(crate) fn run(arguments: &ListArguments) -> Result<u8, Failure> {
    let cases = chosen(&arguments.selection)?;
    let mut text = String::new();
    for case in &cases {
        text.push_str(&case.id);
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
