//! The `etalon` binary: flags and wiring.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod adapters;
mod args;
mod commands;
mod failure;
mod faults;
mod output;
mod shard;
mod slower;
mod worker;

use args::{Arguments, Command};
use clap::Parser;
use failure::{Failure, USAGE};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            let code = if error.use_stderr() { USAGE } else { 0 };
            // Where even this cannot be printed, the exit code still speaks.
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    let outcome = match arguments.command {
        Command::Adapters(arguments) => commands::adapters::run(&arguments),
        Command::List(arguments) => commands::list::run(&arguments),
        Command::Schema => commands::list::schema(),
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Report(arguments) => commands::report::run(&arguments),
        Command::Merge(arguments) => commands::merge::run(&arguments),
        Command::Expectations(command) => commands::expectations::run(&command),
        Command::Bench(arguments) => commands::bench::run(&arguments),
        Command::Diff(arguments) => commands::diff::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
        Command::Mutants(arguments) => commands::mutants::run(&arguments),
        Command::Worker(arguments) => worker::run(&arguments),
    };
    match outcome {
        Ok(code) => ExitCode::from(code),
        // The reader has gone, as `head` does; there is nobody left to tell.
        Err(Failure::Closed) => ExitCode::SUCCESS,
        Err(Failure::Told { code, message }) => {
            eprintln!("etalon: {message}");
            ExitCode::from(code)
        }
    }
}
