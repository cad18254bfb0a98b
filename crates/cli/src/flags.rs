//! Flags shared by several commands.

use crate::gltf::GltfScene;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The format of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum OutputFormat {
    /// Tables for people.
    Text,
    /// JSON for programs.
    Json,
}

/// The flag for a file of additional adapters.
#[derive(Clone, Debug, Args)]
pub(crate) struct AdapterFileArguments {
    /// Add the adapters described in this JSON file, which has the format of the built-in adapters.json
    #[arg(long = "adapters", value_name = "FILE")]
    pub(crate) adapter_file: Option<PathBuf>,
}

/// The share of each family's cases that is selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CaseProfile {
    /// A covering array of each large family, which combines every pair of values; all cases of the others.
    Quick,
    /// All cases.
    Full,
}

impl CaseProfile {
    /// Returns the name on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Full => "full",
        }
    }
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
    /// Globs over case ids; `*` also matches `/`, and a plain name selects everything below it. Default:
    /// all cases (`run`: all but the areas `methods` and `perf`)
    #[arg(value_name = "GLOB")]
    pub(crate) globs: Vec<String>,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
    /// Draw the scene of this glTF file (.glb or .gltf) instead of the built-in ones, by the methods of every question that
    /// it can answer
    #[arg(long, value_name = "FILE", value_parser = crate::gltf::parse, conflicts_with = "cases")]
    pub(crate) gltf: Option<GltfScene>,
    /// Share of each family of cases
    #[arg(long, value_enum, default_value = "quick")]
    pub(crate) profile: CaseProfile,
}

/// Parses a time limit in seconds.
pub(crate) fn parse_timeout(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().unwrap_or(f64::NAN);
    if (0.1..=86_400.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("expected a number of seconds from 0.1 to 86400".to_owned())
    }
}
