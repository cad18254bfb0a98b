//! Discovery for commands: prints what the user must know about adapters, and lets an interruption end the
//! process.

use crate::failure::Failure;
use crate::interruption::OpeningGuard;
use crate::output::say;
use etalon_adapters::{Adapters, Query};

/// Finds adapters and starts their workers.
///
/// # Errors
/// If a name is unknown, or the user's file is invalid or describes something that does not exist.
pub(crate) fn discover(query: &Query<'_>) -> Result<Adapters, Failure> {
    let _opening = OpeningGuard::begin();
    let invite = |adapter: &str, invitation: &str| say!("{adapter}: {invitation}");
    etalon_adapters::discover(query, &invite).map_err(Failure::usage)
}

/// The hint for a machine on which only the rasterizer can draw.
const NO_DRIVER: &str = "no graphics driver was found, so only `cpu`, the suite's own rasterizer, draws. Mesa's software \
                         drivers need no GPU; on Debian and Ubuntu: apt-get install mesa-vulkan-drivers libvulkan1 libegl1 \
                         libgl1-mesa-dri libgl1 libgles2. For all drivers: etalon adapters --remedies";

/// Returns the hint for a machine without a driver; `None` if there is one.
pub(crate) fn no_driver(adapters: &Adapters) -> Option<&'static str> {
    let drawing = &adapters.ready;
    let only_cpu = drawing.iter().all(|(launch, _)| launch.adapter == "cpu");
    (only_cpu && adapters.dead.is_empty()).then_some(NO_DRIVER)
}

/// Prints the adapters that are absent, or how to get a driver if only the rasterizer is present.
///
/// # Errors
/// If an adapter that was named is absent.
pub(crate) fn refuse_absent(named: &[String], adapters: &Adapters) -> Result<(), Failure> {
    if !named.is_empty()
        && let Some(absent) = adapters.absent.first()
    {
        return Err(Failure::usage(format!(
            "adapter {} cannot be used: {}; {}",
            absent.name, absent.reason, absent.remedy
        )));
    }
    if named.is_empty()
        && let Some(hint) = no_driver(adapters)
    {
        say!("{hint}");
        return Ok(());
    }
    for absent in &adapters.absent {
        say!(
            "unavailable: {}: {}; {}",
            absent.name,
            absent.reason,
            absent.remedy
        );
    }
    Ok(())
}
