//! Commands.

use crate::commands::{
    adapters, bench, diff, expectations, explain, list, merge, mutants, report, run,
};
use crate::worker;
use clap::{Parser, Subcommand};

/// Tells whether a graphics driver does per-fragment operations right: draws cases on every driver
/// that can be reached and judges each texel by what the specification allows.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 fine, 1 an unexpected bad verdict or something worse in diff, 2 only improvements, 3 incomplete, \
                  4 nothing selected, 64 wrong usage or bad input."
)]
pub(crate) struct CommandLine {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// List the adapters that can be used, and why others cannot
    Adapters(adapters::Arguments),
    /// List cases, one id per line
    List(list::Arguments),
    /// Print the JSON schema of case files
    Schema,
    /// Draw cases on adapters, judge every texel, write records and a report
    Run(run::Arguments),
    /// Make the reports of run and bench folders anew
    Report(report::Arguments),
    /// Make one run of several, shards or adapters, and prove that nothing is missing
    Merge(merge::Arguments),
    /// Exchange expectations with deqp-runner
    #[command(subcommand)]
    Expectations(expectations::Command),
    /// Time the frames of cases whose pictures are right, interleaved over adapters
    Bench(bench::Arguments),
    /// Say what changed from one run or bench to another: verdicts, pixels, times
    Diff(diff::Arguments),
    /// Tell the story of one texel, operation by operation, with rule and citation
    Explain(explain::Arguments),
    /// Plant bugs in the cpu rasterizer and tell which of them the cases see
    Mutants(mutants::Arguments),
    /// Draw what a parent process asks for (used by etalon itself)
    #[command(hide = true)]
    Worker(worker::Arguments),
}
