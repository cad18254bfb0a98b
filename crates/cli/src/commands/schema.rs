//! `etalon schema`.

use crate::failure::Failure;
use crate::output::print_json;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Print instead the JSON schema of the open protocol, by which a program of your own draws scenes
    #[arg(long)]
    pub(crate) protocol: bool,
    /// Print instead the JSON schema of frame.json, which names the files of a frame for `etalon judge`
    #[arg(long, conflicts_with = "protocol")]
    pub(crate) frame: bool,
}

/// Prints the JSON schema of case files, of the protocol, or of the manifest of a frame.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let schema = if arguments.protocol {
        etalon_external::schema()
    } else if arguments.frame {
        etalon_external::files::schema()
    } else {
        etalon_case::schema()
    };
    print_json(&schema)?;
    Ok(0)
}
