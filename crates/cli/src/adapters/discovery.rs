//! Finding adapters and starting their workers: software drivers from the data file, hardware by enumeration, and
//! those that a user's own file describes.

use super::backend_name::BackendName;
use super::candidate::{Candidate, NoStart, Started};
use super::description;
use super::devices::{self, BACKENDS, HardwareDevice, enumerate};
use super::hidden::Hidden;
use super::origin::Origin;
use super::query::Query;
use crate::failure::Failure;
use etalon_record::AbsentAdapter;
use etalon_runner::{Launch, Worker};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::thread;

/// What discovery came to.
pub(crate) struct Adapters {
    /// Adapters that can be used, their workers up.
    pub(crate) ready: Vec<(Launch, Worker)>,
    /// Adapters that cannot, and why.
    pub(crate) absent: Vec<AbsentAdapter>,
    /// Those of them whose driver is there and ends or hangs while it starts, with their backends.
    pub(crate) dead: Vec<(BackendName, AbsentAdapter)>,
    /// Adapters that are there only where a variable names them, and does not.
    pub(crate) unasked: Vec<AbsentAdapter>,
    /// How each usable adapter is reached, by its name.
    pub(crate) origins: BTreeMap<String, Origin>,
}

/// Finds adapters and starts their workers; only those named, or all.
///
/// # Errors
/// When a name is nobody's, or the user's file is wrong or describes what is not there.
pub(crate) fn discover(query: &Query<'_>) -> Result<Adapters, Failure> {
    let mut adapters = Adapters {
        ready: Vec::new(),
        absent: Vec::new(),
        dead: Vec::new(),
        unasked: Vec::new(),
        origins: BTreeMap::new(),
    };
    let chosen = chosen(query, &mut adapters.absent)?;
    // Drivers start side by side: most of the time goes into loading them.
    let started: Vec<Result<Started, NoStart>> = thread::scope(|scope| {
        let handles: Vec<_> = chosen
            .iter()
            .map(|candidate| scope.spawn(|| candidate.start(query)))
            .collect();
        handles
            .into_iter()
            .filter_map(|handle| handle.join().ok())
            .collect()
    });
    for result in started {
        match result {
            Ok(started) => {
                let name = started.launch.adapter.clone();
                adapters.origins.insert(name, started.origin);
                adapters.ready.push((started.launch, started.worker));
            }
            Err(NoStart::Absent(absent)) => adapters.absent.push(absent),
            Err(NoStart::Dead(backend, absent)) => {
                adapters.dead.push((backend, absent.clone()));
                adapters.absent.push(absent);
            }
            // Whoever names it is told why it cannot be had.
            Err(NoStart::Unasked(absent)) if query.names.is_empty() => {
                adapters.unasked.push(absent);
            }
            Err(NoStart::Unasked(absent)) => adapters.absent.push(absent),
            Err(NoStart::Wrong(message)) => return Err(Failure::usage(message)),
        }
    }
    Ok(adapters)
}

/// The adapters to start. Devices are listed only where a name or none asks for them.
fn chosen(query: &Query<'_>, absent: &mut Vec<AbsentAdapter>) -> Result<Vec<Candidate>, Failure> {
    let mut candidates = described(query.file)?;
    for name in query.names {
        if let Some(hidden) = Hidden::named(name) {
            candidates.push(Candidate::hidden(name, hidden));
        }
    }
    let is_known =
        |candidates: &[Candidate], name: &str| candidates.iter().any(|c| c.name() == name);
    let all_known = query.names.iter().all(|name| is_known(&candidates, name));
    if query.names.is_empty() || !all_known {
        let taken = candidates.iter().map(|c| c.name().to_owned()).collect();
        candidates.extend(hardware(&taken, absent));
    }
    for name in query.names {
        if !is_known(&candidates, name) {
            let known: Vec<&str> = candidates.iter().map(Candidate::name).collect();
            return Err(Failure::usage(format!(
                "there is no adapter `{}`; known here are: {}",
                name.escape_default(),
                known.join(", ")
            )));
        }
    }
    if !query.names.is_empty() {
        absent.clear();
        candidates.retain(|c| query.names.iter().any(|name| name == c.name()));
    }
    Ok(candidates)
}

/// The built-in descriptions and the user's, whose entries take the place of built-in ones of the same
/// name.
fn described(file: Option<&Path>) -> Result<Vec<Candidate>, Failure> {
    let built_in = description::built_in()?;
    let mut all: Vec<Candidate> = built_in
        .into_iter()
        .map(|description| Candidate::described(description, None))
        .collect();
    let Some(file) = file else {
        return Ok(all);
    };
    for description in description::read(file)? {
        let own = Candidate::described(description, Some(file));
        match all.iter_mut().find(|c| c.name() == own.name()) {
            Some(place) => *place = own,
            None => all.push(own),
        }
    }
    Ok(all)
}

/// The devices that backends find, and those backends whose search ended badly.
fn hardware(taken: &BTreeSet<String>, absent: &mut Vec<AbsentAdapter>) -> Vec<Candidate> {
    let found: Vec<Result<Vec<HardwareDevice>, String>> = thread::scope(|scope| {
        let handles: Vec<_> = BACKENDS
            .iter()
            .map(|(word, ..)| scope.spawn(|| enumerate(word)))
            .collect();
        handles
            .into_iter()
            .map(|handle| handle.join().unwrap_or_else(|_| Ok(Vec::new())))
            .collect()
    });
    let mut taken = taken.clone();
    let mut all = Vec::new();
    for ((_, prefix, backend), found) in BACKENDS.into_iter().zip(found) {
        match found {
            Ok(found) => {
                for device in devices::name(&taken, found) {
                    taken.insert(device.name.clone());
                    all.push(Candidate::found(device, backend));
                }
            }
            Err(reason) => absent.push(AbsentAdapter {
                name: format!("{prefix}:*"),
                reason,
                remedy:
                    "look for a driver that fails while its devices are listed, as vulkaninfo or \
                         eglinfo do"
                        .to_owned(),
            }),
        }
    }
    all
}

/// Refuses to go on without an adapter that was named; of others that are absent it tells.
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
        eprintln!(
            "not here: {}: {}; {}",
            absent.name, absent.reason, absent.remedy
        );
    }
    Ok(())
}
