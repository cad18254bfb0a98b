//! Discovers adapters: software drivers from the built-in file, hardware by enumeration, others from the
//! user's file. Each worker starts immediately, since only an answer shows that a driver works.

use crate::backend_name::BackendName;
use crate::candidate::{Candidate, NoStart, Started};
use crate::description;
use crate::devices::{self, BACKENDS, HardwareDevice, enumerate};
use crate::error::AdapterError;
use crate::origin::Origin;
use crate::query::Query;
use etalon_backend::Fault;
use etalon_frame::AdapterName;
use etalon_frame::threads::each;
use etalon_glob::did_you_mean;
use etalon_record::AbsentAdapter;
use etalon_runner::{Launch, Worker};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The adapters that were found.
pub struct Adapters {
    /// Usable adapters, with running workers.
    pub ready: Vec<(Launch, Worker)>,
    /// Adapters that cannot be used, with reasons.
    pub absent: Vec<AbsentAdapter>,
    /// The absent adapters whose driver is installed, but crashes or hangs while it starts.
    pub dead: Vec<(BackendName, AbsentAdapter)>,
    /// Adapters that need a variable that is not set.
    pub not_enabled: Vec<AbsentAdapter>,
    /// The origin of each usable adapter, by name.
    pub origins: BTreeMap<String, Origin>,
}

/// Finds adapters and starts their workers. If somebody must open an adapter's page in a browser, `invite` gets the
/// adapter's name and the invitation.
///
/// # Errors
/// If a name is unknown, or the user's file is invalid or describes something that does not exist.
pub fn discover(
    query: &Query<'_>,
    invite: &(dyn Fn(&str, &str) + Sync),
) -> Result<Adapters, AdapterError> {
    let mut adapters = Adapters {
        ready: Vec::new(),
        absent: Vec::new(),
        dead: Vec::new(),
        not_enabled: Vec::new(),
        origins: BTreeMap::new(),
    };
    let chosen = chosen(query, &mut adapters.absent)?;
    // In parallel: most of the time goes into loading drivers.
    let started: Vec<Result<Started, NoStart>> = each(chosen.len(), &chosen, |candidate| {
        candidate.start(query, invite)
    });
    for result in started {
        match result {
            Ok(started) => {
                let name = started.launch.adapter.clone();
                adapters.origins.insert(name, started.origin);
                adapters.ready.push((started.launch, started.worker));
            }
            Err(NoStart::Absent(absent)) => adapters.absent.push(absent),
            Err(NoStart::Failed(backend, absent)) => {
                adapters.dead.push((backend, absent.clone()));
                adapters.absent.push(absent);
            }
            // An adapter requested by name is reported with the reason.
            Err(NoStart::NotEnabled(absent)) if query.names.is_empty() => {
                adapters.not_enabled.push(absent);
            }
            Err(NoStart::NotEnabled(absent)) => adapters.absent.push(absent),
            Err(NoStart::Wrong(error)) => return Err(error),
        }
    }
    Ok(adapters)
}

/// Returns the adapters to start. Enumerates devices only if no name is given, or if a name is missing from
/// the files.
fn chosen(
    query: &Query<'_>,
    absent: &mut Vec<AbsentAdapter>,
) -> Result<Vec<Candidate>, AdapterError> {
    let mut candidates = described(query.file)?;
    let is_known =
        |candidates: &[Candidate], name: &str| candidates.iter().any(|c| c.name() == name);
    let mut faults = Vec::new();
    for name in query.names {
        faults.push(Fault::in_name(name)?);
    }
    let all_known = query.names.iter().zip(&faults).all(|(name, fault)| {
        let driver = fault.map_or(name.as_str(), |(driver, _)| driver);
        is_known(&candidates, driver)
    });
    if query.names.is_empty() || !all_known {
        let taken = candidates.iter().map(|c| c.name().to_owned()).collect();
        candidates.extend(hardware(&taken, absent));
    }
    for (name, fault) in query.names.iter().zip(faults) {
        if let Some((driver, fault)) = fault
            && let Some(candidate) = candidates.iter().find(|c| c.name() == driver)
            && let Some(faulty) = candidate.with_fault(name, fault)
        {
            candidates.push(faulty);
        }
    }
    for name in query.names {
        if !is_known(&candidates, name) {
            let known: Vec<&str> = candidates.iter().map(Candidate::name).collect();
            return Err(AdapterError::Unknown {
                name: name.escape_default().to_string(),
                suggestion: suggestion(name, &known),
                known: known.into_iter().map(str::to_owned).collect(),
            });
        }
    }
    if query.without_browsers {
        candidates.retain(|c| c.backend() != BackendName::Webgpu);
    }
    if !query.names.is_empty() {
        absent.clear();
        candidates.retain(|c| query.names.iter().any(|name| name == c.name()));
    }
    Ok(candidates)
}

/// Returns a suggestion for an unknown name: the adapters of the driver with this name, or similar names.
fn suggestion(name: &str, known: &[&str]) -> String {
    let of_driver = known
        .iter()
        .filter(|k| AdapterName::new(k).driver() == name);
    let of_driver: Vec<String> = of_driver.map(|k| format!("`{k}`")).collect();
    if of_driver.is_empty() {
        did_you_mean(name, known.iter().copied())
    } else {
        format!("; did you mean {}?", of_driver.join(" or "))
    }
}

/// Returns the built-in descriptions and the user's, which replace built-in ones with the same name.
fn described(file: Option<&Path>) -> Result<Vec<Candidate>, AdapterError> {
    let built_in = description::built_in()?;
    let mut candidates: Vec<Candidate> = built_in
        .into_iter()
        .map(|description| Candidate::described(description, None))
        .collect();
    let Some(file) = file else {
        return Ok(candidates);
    };
    for description in description::read(file)? {
        let candidate = Candidate::described(description, Some(file));
        match candidates.iter_mut().find(|c| c.name() == candidate.name()) {
            Some(place) => *place = candidate,
            None => candidates.push(candidate),
        }
    }
    Ok(candidates)
}

/// Returns the devices that backends enumerate, and adds the backends that fail to `absent`.
fn hardware(taken: &BTreeSet<String>, absent: &mut Vec<AbsentAdapter>) -> Vec<Candidate> {
    let found: Vec<Result<Vec<HardwareDevice>, String>> =
        each(BACKENDS.len(), BACKENDS, |(word, ..)| enumerate(word));
    let mut taken = taken.clone();
    let mut ready = Vec::new();
    for (&(_, prefix, backend), found) in BACKENDS.iter().zip(found) {
        match found {
            Ok(found) => {
                for device in devices::unique_names(&taken, found) {
                    taken.insert(device.name.clone());
                    ready.push(Candidate::enumerated(device, backend));
                }
            }
            Err(reason) => absent.push(AbsentAdapter {
                name: format!("{prefix}:*"),
                reason,
                remedy:
                    "find the driver that fails to list its devices, for instance with vulkaninfo \
                         or eglinfo"
                        .to_owned(),
            }),
        }
    }
    ready
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_driver_alone_suggests_its_adapters() {
        let known = ["cpu", "gl:softpipe", "gl:es:softpipe", "vulkan:lavapipe"];
        let both = "; did you mean `gl:softpipe` or `gl:es:softpipe`?";
        assert_eq!(suggestion("softpipe", &known), both);
        assert_eq!(
            suggestion("gl:softpip", &known),
            "; did you mean `gl:softpipe`?"
        );
    }

    #[test]
    fn a_fault_is_planted_or_refused() {
        let names = ["cpu:fault=abort".to_owned()];
        let query = Query {
            names: &names,
            ..Query::default()
        };
        let chosen = chosen(&query, &mut Vec::new());
        let chosen = chosen.map(|candidates| {
            candidates
                .iter()
                .map(|c| c.name().to_owned())
                .collect::<Vec<_>>()
        });
        match Fault::in_name(&names[0]) {
            Ok(_) => assert_eq!(chosen.unwrap(), names.to_vec()),
            Err(refused) => assert_eq!(chosen.unwrap_err().to_string(), refused.to_string()),
        }
    }
}
