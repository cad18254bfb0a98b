//! Which adapters there are: software drivers from the data file, hardware found by enumeration.

mod hidden;

use crate::failure::Failure;
use hidden::Hidden;
use etalon_record::AbsentAdapter;
use etalon_runner::{Launch, StartError, Worker};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
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
    /// What is planted in an adapter that no list names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) hidden: Option<Hidden>,
}

/// A device that a backend's enumeration found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Found {
    pub(crate) name: String,
    pub(crate) device: usize,
}

/// An entry of the data file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Description {
    name: String,
    backend: BackendName,
    /// Environment variables of the worker.
    #[serde(default)]
    environment: BTreeMap<String, String>,
    /// File names of Vulkan driver manifests, of which the first one found is used.
    #[serde(default)]
    manifests: Vec<String>,
    /// How to get the driver.
    #[serde(default)]
    remedy: String,
}

/// What discovery came to.
pub(crate) struct Adapters {
    /// Adapters that can be used, their workers up.
    pub(crate) ready: Vec<(Launch, Worker)>,
    /// Adapters that cannot, and why.
    pub(crate) absent: Vec<AbsentAdapter>,
}

/// Where Vulkan driver manifests lie, beside what the environment names.
const MANIFEST_FOLDERS: [&str; 6] = [
    "/etc/vulkan/icd.d",
    "/usr/local/etc/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/usr/share/vulkan/icd.d",
    "/usr/lib/chromium",
    "/usr/lib64/chromium",
];

/// Finds adapters and starts their workers; only those named, or all.
pub(crate) fn discover(names: &[String]) -> Result<Adapters, Failure> {
    let mut candidates = candidates()?;
    for name in names {
        if let Some(hidden) = Hidden::named(name)
            && !candidates.iter().any(|c| c.name() == name)
        {
            candidates.push(Candidate::hidden(name, hidden));
        }
    }
    let wanted = |name: &str| names.is_empty() || names.iter().any(|n| n == name);
    for name in names {
        if !candidates.iter().any(|c| c.name() == name) {
            let known: Vec<&str> = candidates.iter().map(Candidate::name).collect();
            return Err(Failure::usage(format!(
                "there is no adapter `{name}`; known here are: {}",
                known.join(", ")
            )));
        }
    }
    // Drivers start side by side: most of the time goes into loading them.
    let started: Vec<Result<(Launch, Worker), AbsentAdapter>> = thread::scope(|scope| {
        let handles: Vec<_> = candidates
            .iter()
            .filter(|c| wanted(c.name()))
            .map(|c| scope.spawn(|| c.start()))
            .collect();
        handles
            .into_iter()
            .filter_map(|handle| handle.join().ok())
            .collect()
    });
    let mut adapters = Adapters {
        ready: Vec::new(),
        absent: Vec::new(),
    };
    for result in started {
        match result {
            Ok(ready) => adapters.ready.push(ready),
            Err(absent) => adapters.absent.push(absent),
        }
    }
    Ok(adapters)
}

/// An adapter that may be there.
struct Candidate {
    open: Open,
    environment: BTreeMap<String, String>,
    manifests: Vec<String>,
    remedy: String,
}

fn candidates() -> Result<Vec<Candidate>, Failure> {
    let described: Vec<Description> = serde_json::from_str(include_str!("../adapters.json"))
        .map_err(|e| Failure::usage(format!("the built-in adapters.json: {e}")))?;
    let mut all: Vec<Candidate> = described
        .into_iter()
        .map(|d| Candidate {
            open: Open {
                name: d.name,
                backend: d.backend,
                device: None,
                hidden: None,
            },
            environment: d.environment,
            manifests: d.manifests,
            remedy: d.remedy,
        })
        .collect();
    let backends = [
        ("vulkan", BackendName::Vulkan),
        ("gl", BackendName::Gl),
        ("gl-es", BackendName::GlEs),
        ("wgpu-vulkan", BackendName::WgpuVulkan),
        ("wgpu-gl", BackendName::WgpuGl),
    ];
    let found: Vec<Vec<Found>> = thread::scope(|scope| {
        let handles: Vec<_> = backends
            .iter()
            .map(|(name, _)| scope.spawn(|| enumerate(name)))
            .collect();
        handles
            .into_iter()
            .map(|handle| handle.join().unwrap_or_default())
            .collect()
    });
    for ((_, backend), devices) in backends.into_iter().zip(found) {
        for device in devices {
            all.push(Candidate {
                open: Open {
                    name: device.name,
                    backend,
                    device: Some(device.device),
                    hidden: None,
                },
                environment: BTreeMap::new(),
                manifests: Vec::new(),
                remedy: "see the driver's own log".to_owned(),
            });
        }
    }
    Ok(all)
}

/// Asks a backend for hardware, in a process of its own: a driver may crash while it is listed.
fn enumerate(backend: &str) -> Vec<Found> {
    let Ok(program) = std::env::current_exe() else {
        return Vec::new();
    };
    let output = Command::new(program)
        .args(["worker", "--enumerate", backend])
        .envs(quiet())
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output();
    output
        .ok()
        .and_then(|o| serde_json::from_slice(&o.stdout).ok())
        .unwrap_or_default()
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

impl Candidate {
    /// An adapter that no list names.
    fn hidden(name: &str, hidden: Hidden) -> Self {
        Self {
            open: Open {
                name: name.to_owned(),
                backend: BackendName::Cpu,
                device: None,
                hidden: Some(hidden),
            },
            environment: BTreeMap::new(),
            manifests: Vec::new(),
            remedy: String::new(),
        }
    }

    fn name(&self) -> &str {
        &self.open.name
    }

    fn start(&self) -> Result<(Launch, Worker), AbsentAdapter> {
        let absent = |reason: String, remedy: &str| AbsentAdapter {
            name: self.open.name.clone(),
            reason,
            remedy: remedy.to_owned(),
        };
        let launch = self
            .launch()
            .map_err(|reason| absent(reason, &self.remedy))?;
        match Worker::start(&launch) {
            Ok(worker) => Ok((launch, worker)),
            Err(StartError::Unavailable(u)) => {
                // The data file knows the packages better than the backend does.
                let remedy = if self.remedy.is_empty() {
                    &u.remedy
                } else {
                    &self.remedy
                };
                Err(absent(u.reason, remedy))
            }
            Err(StartError::Broken(reason)) => Err(absent(reason, &self.remedy)),
        }
    }

    fn launch(&self) -> Result<Launch, String> {
        let program =
            std::env::current_exe().map_err(|e| format!("etalon cannot find itself: {e}"))?;
        let mut environment: Vec<(String, Option<String>)> = self
            .environment
            .iter()
            .map(|(name, value)| (name.clone(), Some(value.clone())))
            .collect();
        if !self.manifests.is_empty() {
            let manifest = self.manifest()?.to_string_lossy().into_owned();
            // The loader before 1.3.207 knows the second name only.
            for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
                environment.push((name.to_owned(), Some(manifest.clone())));
            }
        }
        environment.extend(quiet().map(|(name, value)| (name, Some(value))));
        let open = serde_json::to_string(&self.open).map_err(|e| e.to_string())?;
        Ok(Launch {
            adapter: self.open.name.clone(),
            program,
            arguments: vec!["worker".to_owned(), "--open".to_owned(), open],
            environment,
        })
    }

    /// The first manifest that exists: in the folder the user's data variable names, then in the
    /// system's.
    fn manifest(&self) -> Result<PathBuf, String> {
        let home = std::env::var_os("XDG_DATA_HOME")
            .map(PathBuf::from)
            .or_else(|| std::env::var_os("HOME").map(|h| PathBuf::from(h).join(".local/share")))
            .map(|data| data.join("vulkan/icd.d"));
        let folders = home
            .into_iter()
            .chain(MANIFEST_FOLDERS.iter().map(PathBuf::from));
        for folder in folders {
            for name in &self.manifests {
                let path = folder.join(name);
                if Path::is_file(&path) {
                    return Ok(path);
                }
            }
        }
        Err(format!(
            "no Vulkan driver manifest {} found",
            self.manifests.first().map_or("", String::as_str)
        ))
    }
}
