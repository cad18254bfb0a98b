//! Commands and flags.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Tells whether a graphics driver does per-fragment operations right: draws cases on every driver
/// that can be reached and judges each texel by what the specification allows.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 fine, 1 an unexpected bad verdict, 2 only improvements, 3 incomplete, \
                  4 nothing selected, 64 wrong usage or bad input."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// List the adapters that can be used, and why others cannot
    Adapters(AdaptersArguments),
    /// List cases, one id per line
    List(ListArguments),
    /// Print the JSON schema of case files
    Schema,
    /// Draw cases on adapters, judge every texel, write records and a report
    Run(RunArguments),
    /// Make the reports of run folders anew
    Report(ReportArguments),
    /// Tell the story of one texel, operation by operation, with rule and citation
    Explain(ExplainArguments),
    /// Plant bugs in the cpu rasterizer and tell which of them the cases see
    Mutants(MutantsArguments),
    /// Draw what a parent process asks for (used by etalon itself)
    #[command(hide = true)]
    Worker(WorkerArguments),
}

/// How results are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people.
    Text,
    /// For programs.
    Json,
}

#[derive(Debug, Args)]
pub(crate) struct AdaptersArguments {
    /// For people or for programs (a JSON array, one object per adapter that can be used)
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// How much of each family of cases is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CaseProfile {
    /// Of large families so many cases that every two values meet; of others all.
    Quick,
    /// All.
    Full,
}

impl From<CaseProfile> for etalon_case::Profile {
    fn from(profile: CaseProfile) -> Self {
        match profile {
            CaseProfile::Quick => Self::Quick,
            CaseProfile::Full => Self::Full,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct CaseArguments {
    /// Which cases: globs over ids in which `*` also matches `/`; a plain name stands for all below
    /// it; none for all
    #[arg(value_name = "GLOB")]
    pub(crate) globs: Vec<String>,
    /// Read case files from this folder instead of those built in
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// How much of each family of cases
    #[arg(long, value_enum, default_value = "quick")]
    pub(crate) profile: CaseProfile,
}

#[derive(Debug, Args)]
pub(crate) struct ListArguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
}

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
    /// Run on this adapter (repeat for several); without it, on all that are found
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    /// Where records and reports go
    #[arg(long, value_name = "DIR", default_value = "reports/latest")]
    pub(crate) out: PathBuf,
    /// Expectations to hold verdicts against, instead of those built in
    #[arg(long, value_name = "FILE")]
    pub(crate) expect: Option<PathBuf>,
    /// For people or for programs
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// Run folders
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    /// The case's id
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// Column and row, from the top left corner
    #[arg(long, value_name = "X,Y", value_parser = parse_texel)]
    pub(crate) texel: [u32; 2],
    /// Draw the case on this adapter and hold its texel against the story
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Read case files from this folder instead of those built in
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct MutantsArguments {
    /// Which planted bugs: globs over their names, as `blend/*`; none for all
    #[arg(value_name = "GLOB")]
    pub(crate) globs: Vec<String>,
    /// Print the names and what each does, and hunt nothing
    #[arg(long)]
    pub(crate) list: bool,
    /// Hunt with these cases alone: a glob over ids (repeat for several)
    #[arg(long = "case", value_name = "GLOB")]
    pub(crate) case_globs: Vec<String>,
    /// How much of each family of cases
    #[arg(long, value_enum, default_value = "quick")]
    pub(crate) profile: CaseProfile,
    /// Read case files from this folder instead of those built in
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Draw every case with every bug, instead of ending an area at a bug's first Fail there
    #[arg(long)]
    pub(crate) full: bool,
    /// Where mutants.json and mutants.html go
    #[arg(long, value_name = "DIR", default_value = "reports/mutants-latest")]
    pub(crate) out: PathBuf,
    /// For people or for programs
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct WorkerArguments {
    /// What to open, as JSON
    #[arg(long)]
    pub(crate) open: Option<String>,
    /// List the devices of a backend as JSON
    #[arg(long)]
    pub(crate) enumerate: Option<String>,
}

fn parse_texel(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "a texel is given as X,Y, two whole numbers".to_owned();
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let number = |t: &str| t.trim().parse().map_err(|_| wrong());
    Ok([number(x)?, number(y)?])
}
