//! What `etalon` prints without arguments: what it found, and what to type.

use crate::discovery::{discover, no_driver};
use crate::failure::{Failure, USAGE};
use crate::output::say;
use etalon_adapters::Query;

/// Prints four lines.
pub(crate) fn run() -> Result<u8, Failure> {
    // Browsers take seconds to start.
    let adapters = discover(&Query {
        without_browsers: true,
        ..Query::default()
    })?;
    let version = env!("CARGO_PKG_VERSION");
    match no_driver(&adapters) {
        Some(hint) => say!("etalon {version}: {hint}"),
        None => {
            let names = adapters.ready.iter().map(|(launch, _)| &*launch.adapter);
            let names: Vec<&str> = names.collect();
            say!("etalon {version} found {}", names.join(", "));
        }
    }
    say!(
        "etalon run                            draws the quick profile on all of them, and writes a report"
    );
    say!("etalon run 'depth/*' --adapter cpu    draws one area on one of them");
    say!("etalon --help                         lists the commands");
    Ok(USAGE)
}
