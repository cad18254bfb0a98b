//! The `etalon` binary. Each command is a file in `commands` with its flags and its steps; the other files
//! hold what several commands share.

#![deny(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a write that fails must not panic"
)]
#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod blessing;
mod built_program;
mod cases;
mod catalogue;
mod check;
mod command_line;
mod commands;
mod counted;
mod dead;
mod discovery;
mod earlier;
mod expectations;
mod failure;
mod failure_groups;
#[cfg(feature = "faults")]
mod faulty;
mod flags;
mod frame_folders;
mod frame_limits;
mod gltf;
mod group_text;
#[cfg(feature = "history")]
mod history_file;
mod idle;
mod interruption;
mod known_look;
mod labels;
mod legal_worlds;
mod match_text;
mod named_files;
mod news;
mod out_folder;
mod output;
mod processors;
mod progress;
mod provenance;
#[cfg(feature = "mutants")]
mod quick_choice;
mod recorded_frame;
mod reducing;
mod saved_recording;
mod saved_run;
mod scene_text;
mod shard;
mod sizes;
mod start;
mod timed;
mod worker;
mod worth;

use clap::{CommandFactory, Parser};
use command_line::{Command, CommandLine};
use failure::{Failure, INCOMPLETE, USAGE};
use output::say;
use std::io::ErrorKind;
use std::process::ExitCode;

#[cfg(not(feature = "faults"))]
const _: () = assert!(
    size_of::<Option<etalon_backend::Fault>>() == 0,
    "another package of this build enables planted faults: build etalon alone"
);

fn main() -> ExitCode {
    etalon_process::report_large_files();
    if std::env::args_os().len() <= 1 {
        return exit(start::run());
    }
    let command_line = match CommandLine::try_parse() {
        Ok(command_line) => command_line,
        Err(error) => {
            return ExitCode::from(answer(&error));
        }
    };
    let outcome = match command_line.command {
        Command::Adapters(arguments) => commands::adapters::run(&arguments),
        Command::List(arguments) => commands::list::run(&arguments),
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Show(arguments) => commands::show::run(&arguments),
        Command::Schema(arguments) => commands::schema::run(&arguments),
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Export(arguments) => commands::export::run(&arguments),
        Command::Judge(arguments) => commands::judge::run(&arguments),
        Command::Report(arguments) => commands::report::run(&arguments),
        Command::Merge(arguments) => commands::merge::run(&arguments),
        Command::Expectations(command) => commands::expectations::run(&command),
        Command::Bench(arguments) => commands::bench::run(&arguments),
        Command::Diff(arguments) => commands::diff::run(&arguments),
        #[cfg(feature = "history")]
        Command::History(command) => commands::history::run(&command),
        Command::Site(arguments) => commands::site::run(&arguments),
        Command::Preflight(arguments) => commands::preflight::run(&arguments),
        Command::Conformance(arguments) => commands::conformance::run(&arguments),
        Command::Bisect(arguments) => commands::bisect::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
        Command::Reduce(arguments) => commands::reduce::run(&arguments),
        Command::Bundle(arguments) => commands::bundle::run(&arguments),
        Command::Fuzz(arguments) => commands::fuzz::run(&arguments),
        #[cfg(feature = "mutants")]
        Command::Mutants(arguments) => commands::mutants::run(&arguments),
        Command::Completions(arguments) => {
            commands::completions::run(&arguments, &CommandLine::command())
        }
        Command::Man(arguments) => commands::man::run(&arguments, CommandLine::command()),
        Command::Worker(arguments) => worker::run(&arguments),
    };
    exit(outcome)
}

/// Prints the message of a failure, and returns the exit code.
fn exit(outcome: Result<u8, Failure>) -> ExitCode {
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(Failure { code, message }) => {
            say!("etalon: {message}");
            ExitCode::from(code)
        }
    }
}

/// Prints help, the version or a usage error. Returns the exit code.
fn answer(error: &clap::Error) -> u8 {
    match error.print() {
        _ if error.use_stderr() => USAGE,
        Err(error) if error.kind() != ErrorKind::BrokenPipe => INCOMPLETE,
        _ => 0,
    }
}
