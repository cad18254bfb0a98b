//! `etalon list`.

use crate::cases::chosen;
use crate::failure::Failure;
use crate::flags::CaseArguments;
use crate::output::print;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
}

/// Prints the ids of the selected cases.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let cases = chosen(&arguments.selection)?;
    let mut text = String::new();
    for case in &cases {
        text.push_str(&case.id);
        text.push('\n');
    }
    print(&text)?;
    Ok(0)
}
