//! The command line: one subcommand per file of `commands`.

#[cfg(feature = "history")]
use crate::commands::history;
#[cfg(feature = "mutants")]
use crate::commands::mutants;
use crate::commands::{
    adapters, bench, bisect, bundle, check, completions, conformance, diff, expectations, explain,
    export, fuzz, judge, list, man, merge, preflight, reduce, report, run, schema, show, site,
};
use crate::worker;
use clap::{Parser, Subcommand};

/// Tests whether graphics drivers perform per-fragment operations correctly: draws cases on every driver
/// found and judges each texel by the values that the specification allows.
#[derive(Debug, Parser)]
#[command(
    version = env!("ETALON_VERSION"),
    arg_required_else_help = true,
    after_help = "Exit codes: 0 success, 1 unexpected bad verdicts or something worse in diff, 2 improvements only, 3 incomplete, \
                  4 nothing selected, 64 wrong usage or bad input."
)]
pub(crate) struct CommandLine {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// List the adapters that can be used, and why others cannot be
    Adapters(adapters::Arguments),
    /// List case ids, one per line
    List(list::Arguments),
    /// Check case files without a driver: report errors, unused parts, and what the cases assert and how
    /// sharply
    Check(check::Arguments),
    /// Show a case: its purpose, scene, JSON, shaders and picture
    Show(show::Arguments),
    /// Print the JSON schema of case files, of the open protocol, or of frames in files
    Schema(schema::Arguments),
    /// Draw cases on adapters, judge every texel, write records and reports
    Run(run::Arguments),
    /// Write cases for programs in any language: scene, shaders, least and largest legal values
    Export(export::Arguments),
    /// Judge frames that another program drew, from files; write records and reports
    Judge(judge::Arguments),
    /// Rebuild the reports of run and bench folders
    Report(report::Arguments),
    /// Build a static site from the pages of recorded folders
    Site(site::Arguments),
    /// Combine shards, or runs on several adapters, into one run, and list what is missing
    Merge(merge::Arguments),
    /// Import and export expectations in the formats of deqp-runner
    #[command(subcommand)]
    Expectations(expectations::Conversion),
    /// Measure frame times of cases whose pictures are correct, interleaved over adapters
    Bench(bench::Arguments),
    /// Compare two runs or two benches: verdicts, pixels, times
    Diff(diff::Arguments),
    /// Keep runs, benches and releases over time in one file, and report what changed and when
    #[cfg(feature = "history")]
    #[command(subcommand)]
    History(history::HistoryCommand),
    /// Say which known bugs an adapter shows, and which formats and states it draws right
    Preflight(preflight::Arguments),
    /// Check an adapter with scenes whose pictures are exact, and say what its author should fix first
    Conformance(conformance::Arguments),
    /// Find the releases of a driver that draw cases wrong
    Bisect(bisect::Arguments),
    /// Explain one texel, operation by operation, with rules and citations
    Explain(explain::Arguments),
    /// Reduce a failing case to the smallest one that fails in the same way
    Reduce(reduce::Arguments),
    /// Write a program that shows a bug without the suite, and a report
    Bundle(bundle::Arguments),
    /// Draw random scenes on adapters, and reduce the failing ones
    Fuzz(fuzz::Arguments),
    /// Plant bugs in the cpu rasterizer and report which ones the cases catch
    #[cfg(feature = "mutants")]
    Mutants(mutants::Arguments),
    /// Print a completion script for a shell
    Completions(completions::Arguments),
    /// Print or write manual pages
    Man(man::Arguments),
    /// Draw scenes for a parent process (used by etalon itself)
    #[command(hide = true)]
    Worker(worker::Arguments),
}
