//! Discovery for commands: prints what the user must know about adapters, and lets an interruption end the
//! process.

use crate::failure::Failure;
use crate::interruption::OpeningGuard;
use crate::output::say;
use etalon_adapters::{Adapters, Query};
use etalon_record::AbsentAdapter;

/// Finds adapters and starts their workers.
///
/// # Errors
/// If a name is unknown, or the user's file is invalid or describes something that does not exist.
pub(crate) fn discover(query: &Query<'_>) -> Result<Adapters, Failure> {
    let _opening = OpeningGuard::begin();
    let invite = |adapter: &str, invitation: &str| say!("{adapter}: {invitation}");
    etalon_adapters::discover(query, &invite).map_err(Failure::usage)
}

/// Prints the adapters that are absent.
///
/// # Errors
/// If an adapter that was named is absent.
pub(crate) fn refuse_absent(named: &[String], absent: &[AbsentAdapter]) -> Result<(), Failure> {
    if !named.is_empty()
        && let Some(absent) = absent.first()
    {
        return Err(Failure::usage(format!(
            "adapter {} cannot be used: {}; {}",
            absent.name, absent.reason, absent.remedy
        )));
    }
    for absent in absent {
        say!(
            "unavailable: {}: {}; {}",
            absent.name,
            absent.reason,
            absent.remedy
        );
    }
    Ok(())
}
