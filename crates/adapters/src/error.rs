//! Errors of descriptions and of discovery.

use etalon_backend::FaultNameError;
use std::io;
use thiserror::Error;

/// The reason why adapters cannot be described or found.
#[derive(Debug, Error)]
pub enum AdapterError {
    /// A file of descriptions cannot be read.
    #[error(
        "{file}: {source}; --adapters takes a JSON file with the format of crates/adapters/adapters.json"
    )]
    Unreadable {
        /// The path of the file.
        file: String,
        /// The system's error.
        source: io::Error,
    },
    /// A file is too long.
    #[error("{file}: longer than 1 MiB")]
    TooLong {
        /// The path of the file.
        file: String,
    },
    /// A file is not text.
    #[error("{file}: not UTF-8: {source}")]
    NotText {
        /// The path of the file.
        file: String,
        /// The first fault.
        source: std::string::FromUtf8Error,
    },
    /// A file is not a list of descriptions.
    #[error(
        "{file}: {source}; a file of adapters is a JSON array of objects with name and backend"
    )]
    NotAList {
        /// The path of the file.
        file: String,
        /// The parser's error.
        source: serde_json::Error,
    },
    /// A file has too many entries.
    #[error("{file}: {entries} entries, at most {limit} are allowed; split the file")]
    TooManyEntries {
        /// The path of the file.
        file: String,
        /// The number of entries.
        entries: usize,
        /// The largest number of entries.
        limit: usize,
    },
    /// An entry is wrong on every machine.
    #[error("{file}: entry {number} (`{name}`): {reason}")]
    WrongEntry {
        /// The path of the file.
        file: String,
        /// The number of the entry, counted from 1.
        number: usize,
        /// The entry's name.
        name: String,
        /// The reason why the entry is refused.
        reason: String,
    },
    /// An entry describes something that does not exist on this machine.
    #[error("{file}: entry `{name}`: {reason}")]
    UnusableEntry {
        /// The path of the file.
        file: String,
        /// The entry's name.
        name: String,
        /// The reason why the entry is refused.
        reason: String,
    },
    /// Two releases of a line have one version.
    #[error(
        "{file}: `{}` and `{}` are both version {version} of {line}; give one of them a line of its own",
        names[0],
        names[1]
    )]
    SameVersion {
        /// The path of the file.
        file: String,
        /// The names of the two adapters.
        names: [String; 2],
        /// The version that both releases state.
        version: String,
        /// The name of the driver whose releases they are.
        line: String,
    },
    /// A line has fewer than two releases.
    #[error(
        "{file}: {} of the line `{line}`, and a search needs two; its lines are: {}",
        if *releases == 0 { "no release" } else { "one release" },
        if lines.is_empty() {
            "none; --adapters takes a file whose entries have `line` and `version`".to_owned()
        } else {
            lines.join(", ")
        }
    )]
    TooFewReleases {
        /// The path of the file.
        file: String,
        /// The name of the driver whose releases they are.
        line: String,
        /// The number of its releases.
        releases: usize,
        /// The lines of the file.
        lines: Vec<String>,
    },
    /// A name ends in a fault that cannot be planted.
    #[error(transparent)]
    FaultName(#[from] FaultNameError),
    /// No adapter has a name.
    #[error("there is no adapter `{name}`{suggestion}; known are: {}", known.join(", "))]
    Unknown {
        /// The name that no adapter has.
        name: String,
        /// Similar names, as [`etalon_glob::did_you_mean`] suggests them.
        suggestion: String,
        /// The names of all adapters.
        known: Vec<String>,
    },
}
