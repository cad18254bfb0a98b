//! `etalon list`.

use crate::cases::chosen_ids;
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
    let mut text = String::new();
    for id in chosen_ids(&arguments.selection)? {
        text.push_str(&id);
        text.push('\n');
    }
    print(&text)?;
    Ok(0)
}
