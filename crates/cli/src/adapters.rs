//! Which adapters there are: software drivers from the data file, hardware found by enumeration, and
//! those that a user's own file describes.

pub(crate) mod cache;
mod candidate;
mod description;
mod found;
mod hidden;

use crate::failure::Failure;
use candidate::{Candidate, NoStart, Started};
use description::Description;
use etalon_record::AbsentAdapter;
use etalon_runner::{Launch, Worker};
pub(crate) use found::Found;
use found::{BACKENDS, enumerate};
use hidden::Hidden;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::thread;

/// The backends, GL's profiles and wgpu's APIs counted apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum BackendName {
    Cpu,
    Vulkan,
    Gl,
    GlEs,
    WgpuVulkan,
    WgpuGl,
}

/// What a worker is to open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Open {
    pub(crate) name: String,
    pub(crate) backend: BackendName,
    /// The device in the backend's own order; without it, the default one.
    pub(crate) device: Option<usize>,
    /// The EGL library; without it, the system's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) egl: Option<PathBuf>,
    /// Whether validation layers and debug output listen.
    #[serde(default)]
    pub(crate) validate: bool,
    /// What is planted in an adapter that no list names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) hidden: Option<Hidden>,
}

/// What is looked for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wanted<'a> {
    /// Only these; all where there are none.
    pub(crate) names: &'a [String],
    /// A user's own file of descriptions.
    pub(crate) file: Option<&'a Path>,
    /// Whether validation layers and debug output listen.
    pub(crate) validate: bool,
    /// Whether the drivers' shader caches on disk are switched off.
    pub(crate) cold: bool,
}

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

/// Where an adapter comes from, and what was set to reach it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Origin {
    /// `built-in`, `found` by enumeration, or the path of the user's file.
    pub(crate) described_in: String,
    /// Environment variables of its worker; `null` is one taken away.
    pub(crate) environment: BTreeMap<String, Option<String>>,
    /// The Vulkan driver's manifest, where one was chosen.
    pub(crate) manifest: Option<PathBuf>,
    /// The EGL library, where it is not the system's.
    pub(crate) egl: Option<PathBuf>,
    /// Folders in which libraries were looked for first.
    pub(crate) library_path: Vec<PathBuf>,
    /// The device's place in the backend's order, where one was chosen.
    pub(crate) device_index: Option<usize>,
}

/// Finds adapters and starts their workers; only those named, or all.
///
/// # Errors
/// When a name is nobody's, or the user's file is wrong or describes what is not there.
pub(crate) fn discover(wanted: &Wanted<'_>) -> Result<Adapters, Failure> {
    let mut adapters = Adapters {
        ready: Vec::new(),
        absent: Vec::new(),
        dead: Vec::new(),
        unasked: Vec::new(),
        origins: BTreeMap::new(),
    };
    let chosen = chosen(wanted, &mut adapters.absent)?;
    // Drivers start side by side: most of the time goes into loading them.
    let started: Vec<Result<Started, NoStart>> = thread::scope(|scope| {
        let handles: Vec<_> = chosen
            .iter()
            .map(|candidate| scope.spawn(|| candidate.start(wanted)))
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
            Err(NoStart::Unasked(absent)) if wanted.names.is_empty() => {
                adapters.unasked.push(absent);
            }
            Err(NoStart::Unasked(absent)) => adapters.absent.push(absent),
            Err(NoStart::Wrong(message)) => return Err(Failure::usage(message)),
        }
    }
    Ok(adapters)
}

/// The adapters to start. Devices are listed only where a name or none asks for them.
fn chosen(wanted: &Wanted<'_>, absent: &mut Vec<AbsentAdapter>) -> Result<Vec<Candidate>, Failure> {
    let mut candidates = described(wanted.file)?;
    for name in wanted.names {
        if let Some(hidden) = Hidden::named(name) {
            candidates.push(Candidate::hidden(name, hidden));
        }
    }
    let is_known =
        |candidates: &[Candidate], name: &str| candidates.iter().any(|c| c.name() == name);
    let all_known = wanted.names.iter().all(|name| is_known(&candidates, name));
    if wanted.names.is_empty() || !all_known {
        let taken = candidates.iter().map(|c| c.name().to_owned()).collect();
        candidates.extend(hardware(&taken, absent));
    }
    for name in wanted.names {
        if !is_known(&candidates, name) {
            let known: Vec<&str> = candidates.iter().map(Candidate::name).collect();
            return Err(Failure::usage(format!(
                "there is no adapter `{}`; known here are: {}",
                name.escape_default(),
                known.join(", ")
            )));
        }
    }
    if !wanted.names.is_empty() {
        absent.clear();
        candidates.retain(|c| wanted.names.iter().any(|name| name == c.name()));
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
    let found: Vec<Result<Vec<Found>, String>> = thread::scope(|scope| {
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
                for device in found::name(&taken, found) {
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

/// Drivers complain on standard error where the run-time folder is not set.
fn quiet() -> Option<(String, String)> {
    let name = "XDG_RUNTIME_DIR";
    match std::env::var_os(name) {
        Some(_) => None,
        None => Some((
            name.to_owned(),
            std::env::temp_dir().to_string_lossy().into_owned(),
        )),
    }
}
