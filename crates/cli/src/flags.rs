//! Flags that several commands take.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

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
