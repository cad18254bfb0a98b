//! Commands and flags.

use clap::{Args, Parser, Subcommand, ValueEnum};
use etalon_record::Shard;
use std::path::PathBuf;

/// Tells whether a graphics driver does per-fragment operations right: draws cases on every driver
/// that can be reached and judges each texel by what the specification allows.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 fine, 1 an unexpected bad verdict or something worse in diff, 2 only improvements, 3 incomplete, \
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
    /// Make the reports of run and bench folders anew
    Report(ReportArguments),
    /// Make one run of several, shards or adapters, and prove that nothing is missing
    Merge(MergeArguments),
    /// Exchange expectations with deqp-runner
    #[command(subcommand)]
    Expectations(ExpectationsCommand),
    /// Time the frames of cases whose pictures are right, interleaved over adapters
    Bench(BenchArguments),
    /// Say what changed from one run or bench to another: verdicts, pixels, times
    Diff(DiffArguments),
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

/// Which adapters there are.
#[derive(Clone, Debug, Args)]
pub(crate) struct AdapterFileArguments {
    /// Also know the adapters that this JSON file describes, in the form of the built-in adapters.json
    #[arg(long = "adapters", value_name = "FILE")]
    pub(crate) adapter_file: Option<PathBuf>,
}

/// What the drivers' shader caches on disk hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CacheState {
    /// Nothing, and nothing is kept: every process compiles everything.
    Cold,
    /// What earlier processes left.
    Warm,
}

#[derive(Debug, Args)]
pub(crate) struct AdaptersArguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
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

#[derive(Clone, Debug, Args)]
pub(crate) struct CaseArguments {
    /// Which cases: globs over ids in which `*` also matches `/`; a plain name stands for all below
    /// it; none for all (`run`: for all but the areas `methods` and `perf`, which want to be named)
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
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Where records and reports go
    #[arg(long, value_name = "DIR", default_value = "reports/latest")]
    pub(crate) out: PathBuf,
    /// Go on with the run that the folder holds: draw what is missing
    #[arg(long, conflicts_with = "force")]
    pub(crate) resume: bool,
    /// Replace the run that the folder holds
    #[arg(long)]
    pub(crate) force: bool,
    /// Expectations to hold verdicts against, instead of those built in
    #[arg(long, value_name = "FILE")]
    pub(crate) expect: Option<PathBuf>,
    /// Write what this run showed into the expectations file: what was unexpected is expected from now
    /// on, what is better goes. Refused where the variable CI is set
    #[arg(long)]
    pub(crate) bless: bool,
    /// Draw part M of N, chosen by a hash of the id; without it, the part that GitLab, Bazel, Slurm or a
    /// Kubernetes indexed job asks for in its variables; 1/1 for all
    #[arg(long, value_name = "M/N", value_parser = crate::shard::parse)]
    pub(crate) shard: Option<Shard>,
    /// Seconds that one case may take before its process is given up (methods and perf: four times that)
    #[arg(long, value_name = "S", default_value = "60", value_parser = parse_timeout)]
    pub(crate) timeout: f64,
    /// MiB of memory that one worker may hold before it is given up
    #[arg(long, value_name = "MIB", default_value = "4096", value_parser = clap::value_parser!(u64).range(64..=1 << 20))]
    pub(crate) memory: u64,
    /// How many workers draw at the same time; without it, one per processor
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Draw each case so many times, each time in a fresh process; verdicts that differ make it flaky
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) repeat: u32,
    /// Draw the cases in the order of this seed; a case that fails only after others names them
    #[arg(long, value_name = "SEED")]
    pub(crate) shuffle: Option<u64>,
    /// Whether the drivers' shader caches on disk may be used
    #[arg(long, value_enum, default_value = "warm")]
    pub(crate) shader_cache: CacheState,
    /// Have validation layers and GL debug output listen; a case of which they say something is an error
    #[arg(long)]
    pub(crate) validate: bool,
    /// For people or for programs
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct BenchArguments {
    #[command(flatten)]
    pub(crate) selection: CaseArguments,
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Time this adapter (repeat for several); without it, all that are found
    #[arg(long = "adapter", value_name = "NAME")]
    pub(crate) adapters: Vec<String>,
    /// Where samples and reports go
    #[arg(long, value_name = "DIR", default_value = "reports/bench-latest")]
    pub(crate) out: PathBuf,
    /// How often each case is prepared and timed anew, in new processes; fewer than 7 tell no difference
    #[arg(long, value_name = "N", default_value = "12", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) rounds: u32,
    /// How long the timed frames of a case take on an adapter in each round, about
    #[arg(long, value_name = "S", default_value = "0.1", value_parser = parse_seconds)]
    pub(crate) seconds: f64,
    /// Switch off the drivers' shader caches on disk, so that each round's first frame compiles everything
    #[arg(long)]
    pub(crate) cold: bool,
    /// For people or for programs
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// Run and bench folders
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
}

/// Lists of deqp-runner in and out.
#[derive(Debug, Subcommand)]
pub(crate) enum ExpectationsCommand {
    /// Add what deqp-runner's lists expect to an expectations file
    Import(ImportArguments),
    /// Write what is expected of an adapter as deqp-runner's lists: fails.txt, flakes.txt, skips.txt
    Export(ExportArguments),
}

#[derive(Debug, Args)]
pub(crate) struct ImportArguments {
    /// A list of failures: lines `name,status` (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) fails: Vec<PathBuf>,
    /// A list of flaky cases: a regular expression per line (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) flakes: Vec<PathBuf>,
    /// A list of cases not to be drawn: a regular expression per line (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) skips: Vec<PathBuf>,
    /// A results.csv, whose bad verdicts are expected from now on (repeat for several)
    #[arg(long, value_name = "FILE")]
    pub(crate) results: Vec<PathBuf>,
    /// The adapters that the entries are about: a glob over names
    #[arg(long, value_name = "GLOB")]
    pub(crate) adapter: String,
    /// Their driver: a glob over driver and version
    #[arg(long, value_name = "GLOB", default_value = "*")]
    pub(crate) driver: String,
    /// The driver's versions, as `>=22.3, <25.1`
    #[arg(long, value_name = "RANGE")]
    pub(crate) version: Option<String>,
    /// Why the verdicts are accepted
    #[arg(long, value_name = "TEXT")]
    pub(crate) reason: String,
    /// Where that is shown
    #[arg(long, value_name = "TEXT")]
    pub(crate) evidence: String,
    /// A bug report's address
    #[arg(long, value_name = "URL")]
    pub(crate) link: Option<String>,
    /// The last day on which the entries count, as 2027-01-31
    #[arg(long, value_name = "DAY")]
    pub(crate) expires: Option<String>,
    /// The expectations file to add to; it is made where it does not exist
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Read case files from this folder instead of those built in
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// The adapter that the lists are for
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: String,
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Expectations to write, instead of those built in
    #[arg(long, value_name = "FILE")]
    pub(crate) expect: Option<PathBuf>,
    /// The folder that the lists go to
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Read case files from this folder instead of those built in
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArguments {
    /// Run folders of one selection of cases
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Where the merged run goes
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Replace the run that the folder holds
    #[arg(long)]
    pub(crate) force: bool,
    /// For people or for programs
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Which time of a bench is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DiffTime {
    /// A frame until the device was done.
    Wall,
    /// A frame until the last call that submits work returned.
    Cpu,
    /// A frame between GPU timestamps.
    Gpu,
    /// Reading a frame back.
    ReadBack,
    /// Preparing the scene.
    Prepare,
    /// The first frame after preparing.
    First,
}

#[derive(Debug, Args)]
pub(crate) struct DiffArguments {
    /// The run or bench folder to compare with
    #[arg(value_name = "BEFORE")]
    pub(crate) before: PathBuf,
    /// The run or bench folder to judge
    #[arg(value_name = "AFTER")]
    pub(crate) after: PathBuf,
    /// Of runs: hold this adapter of the first against that of the second; without both, adapters of the
    /// same name, or the only one of each
    #[arg(long, value_name = "NAME", requires = "adapter_after")]
    pub(crate) adapter_before: Option<String>,
    /// Of runs: the adapter of the second
    #[arg(long, value_name = "NAME", requires = "adapter_before")]
    pub(crate) adapter_after: Option<String>,
    /// Of benches: which time (wall, where none is named)
    #[arg(long, value_enum)]
    pub(crate) time: Option<DiffTime>,
    /// Also write a page here
    #[arg(long, value_name = "FILE.html")]
    pub(crate) out: Option<PathBuf>,
    /// For people or for programs
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
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

fn parse_timeout(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().unwrap_or(f64::NAN);
    if (0.1..=86_400.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("seconds lie between 0.1 and 86400".to_owned())
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().unwrap_or(f64::NAN);
    if (0.001..=30.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("seconds lie between 0.001 and 30".to_owned())
    }
}

fn parse_texel(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "a texel is given as X,Y, two whole numbers".to_owned();
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let number = |t: &str| t.trim().parse().map_err(|_| wrong());
    Ok([number(x)?, number(y)?])
}
