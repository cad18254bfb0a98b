//! `etalon completions`.

use crate::failure::Failure;
use crate::output::print;
use clap::{Args, Command};
use clap_complete::{Shell, generate};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Shell that the script is for
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

/// Prints a completion script for a shell.
pub(crate) fn run(arguments: &Arguments, command: &Command) -> Result<u8, Failure> {
    // The generators would include hidden commands.
    let listed = command.get_subcommands().filter(|c| !c.is_hide_set());
    let mut command = Command::new("etalon")
        .version(env!("ETALON_VERSION"))
        .subcommands(listed.cloned());
    let mut script = Vec::new();
    generate(arguments.shell, &mut command, "etalon", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(0)
}
