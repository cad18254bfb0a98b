//! An adapter that may be there, and starting it.

use super::backend_name::BackendName;
use super::cache;
use super::description::{Description, Resolved, Unresolved};
use super::devices::HardwareDevice;
use super::hidden::Hidden;
use super::open::Open;
use super::origin::Origin;
use super::query::Query;
use super::runtime_folder::quiet;
use etalon_backend::AdapterInfo;
use etalon_record::AbsentAdapter;
use etalon_runner::{Launch, StartError, Worker};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A driver that takes longer to fail is not tried again.
const TRIED_AGAIN: Duration = Duration::from_secs(10);
/// Where the system's loader looks for libraries first.
const LIBRARY_PATH: &str = "LD_LIBRARY_PATH";

/// An adapter that may be there.
pub(super) enum Candidate {
    /// An entry of a file; `None` is the built-in one.
    Described(Description, Option<PathBuf>),
    /// A device that a backend found.
    Found(Open),
    /// One that no list names.
    Hidden(Open),
}

/// An adapter that can be used.
pub(super) struct Started {
    pub(super) launch: Launch,
    pub(super) worker: Worker,
    pub(super) origin: Origin,
}

/// Why an adapter did not start.
pub(super) enum NoStart {
    /// It cannot be used.
    Absent(AbsentAdapter),
    /// Its driver is there and ends or hangs while it starts.
    Dead(BackendName, AbsentAdapter),
    /// A built-in entry wants a variable that is not set.
    Unasked(AbsentAdapter),
    /// The user's file describes what is not there.
    Wrong(String),
}

fn open(name: &str, backend: BackendName) -> Open {
    Open {
        name: name.to_owned(),
        backend,
        device: None,
        egl: None,
        validate: false,
        hidden: None,
    }
}

impl Candidate {
    pub(super) fn described(description: Description, file: Option<&Path>) -> Self {
        Self::Described(description, file.map(Path::to_owned))
    }

    pub(super) fn found(device: HardwareDevice, backend: BackendName) -> Self {
        Self::Found(Open {
            device: Some(device.device),
            ..open(&device.name, backend)
        })
    }

    pub(super) fn hidden(name: &str, hidden: Hidden) -> Self {
        Self::Hidden(Open {
            hidden: Some(hidden),
            ..open(name, BackendName::Cpu)
        })
    }

    pub(super) fn name(&self) -> &str {
        match self {
            Self::Described(description, _) => &description.name,
            Self::Found(open) | Self::Hidden(open) => &open.name,
        }
    }

    fn remedy(&self) -> &str {
        match self {
            Self::Described(description, _) => &description.remedy,
            Self::Found(_) | Self::Hidden(_) => "see the driver's own log",
        }
    }

    fn absent(&self, reason: impl ToString, remedy: &str) -> AbsentAdapter {
        AbsentAdapter {
            name: self.name().to_owned(),
            reason: reason.to_string(),
            remedy: remedy.to_owned(),
        }
    }

    /// Starts the worker and holds that the driver is the one that the description means.
    pub(super) fn start(&self, query: &Query<'_>) -> Result<Started, NoStart> {
        let resolved = self.resolve()?;
        let launch = self
            .launch(&resolved, query)
            .map_err(|reason| NoStart::Absent(self.absent(reason, self.remedy())))?;
        // A driver that does not start is tried once more before it is blamed, but not one that hangs.
        let begun = Instant::now();
        let started = match Worker::start(&launch) {
            Err(StartError::Broken(_)) if begun.elapsed() < TRIED_AGAIN => Worker::start(&launch),
            other => other,
        };
        let worker = started.map_err(|error| match error {
            StartError::Unavailable(u) => {
                // The file knows the packages better than the backend does, but nothing of validation.
                let own = query.validate || self.remedy().is_empty();
                let remedy = if own { &u.remedy } else { self.remedy() };
                NoStart::Absent(self.absent(&u.reason, remedy))
            }
            StartError::Broken(reason) => {
                let backend = self.open(&resolved, query.validate).backend;
                NoStart::Dead(backend, self.absent(reason, self.remedy()))
            }
        })?;
        if let Self::Described(
            Description {
                answers: Some(word),
                ..
            },
            _,
        ) = self
            && !answers(&worker.hello.info, word)
        {
            let info = &worker.hello.info;
            let reason = format!("another driver answers: {}, {}", info.device, info.driver);
            return Err(NoStart::Absent(self.absent(reason, self.remedy())));
        }
        let origin = self.origin(resolved, &launch);
        Ok(Started {
            launch,
            worker,
            origin,
        })
    }

    fn resolve(&self) -> Result<Resolved, NoStart> {
        let Self::Described(description, file) = self else {
            return Ok(Resolved::default());
        };
        let folder = file
            .as_deref()
            .and_then(Path::parent)
            .unwrap_or(Path::new(""));
        // The loader of a worker that starts elsewhere would not find what is relative.
        let folder = std::path::absolute(folder.join(".")).unwrap_or_else(|_| folder.to_owned());
        let variable = |name: &str| std::env::var(name).ok();
        description.resolve(&folder, &variable).map_err(|why| {
            let remedy = match (&why, description.remedy.as_str()) {
                (Unresolved::Variable(name), "") => format!("set {name}"),
                (Unresolved::Form(_) | Unresolved::Missing(_), "") => {
                    "correct the entry".to_owned()
                }
                (_, remedy) => remedy.to_owned(),
            };
            match (file, &why) {
                (Some(file), _) => NoStart::Wrong(format!(
                    "{}: entry `{}`: {why}; {remedy}",
                    file.display(),
                    description.name
                )),
                (None, Unresolved::Variable(_)) => NoStart::Unasked(self.absent(why, &remedy)),
                (None, _) => NoStart::Absent(self.absent(why, &remedy)),
            }
        })
    }

    fn open(&self, resolved: &Resolved, validate: bool) -> Open {
        let mut open = match self {
            Self::Described(description, _) => Open {
                device: description.device,
                egl: resolved.egl.clone(),
                ..open(&description.name, description.backend)
            },
            Self::Found(open) | Self::Hidden(open) => open.clone(),
        };
        open.validate = validate;
        open
    }

    fn launch(&self, resolved: &Resolved, query: &Query<'_>) -> Result<Launch, String> {
        let program =
            std::env::current_exe().map_err(|e| format!("etalon cannot find itself: {e}"))?;
        let mut environment = resolved.environment.clone();
        if let Some(manifest) = &resolved.manifest {
            let manifest = manifest.to_string_lossy().into_owned();
            // The loader before 1.3.207 knows the second name only.
            for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
                environment.push((name.to_owned(), Some(manifest.clone())));
            }
            // The user's choice among drivers, which is not made here.
            for name in ["VK_LOADER_DRIVERS_SELECT", "VK_LOADER_DRIVERS_DISABLE"] {
                environment.push((name.to_owned(), None));
            }
        }
        if !resolved.library_path.is_empty() {
            let before = std::env::var_os(LIBRARY_PATH).unwrap_or_default();
            let before = std::env::split_paths(&before).filter(|p| !p.as_os_str().is_empty());
            let folders = resolved.library_path.iter().cloned().chain(before);
            let path = std::env::join_paths(folders).map_err(|e| e.to_string())?;
            let path = path.to_string_lossy().into_owned();
            environment.push((LIBRARY_PATH.to_owned(), Some(path)));
        }
        if query.cold {
            environment.extend(cache::off());
        }
        environment.extend(quiet().map(|(name, value)| (name, Some(value))));
        let open = serde_json::to_string(&self.open(resolved, query.validate))
            .map_err(|e| e.to_string())?;
        Ok(Launch {
            adapter: self.name().to_owned(),
            program,
            arguments: vec!["worker".to_owned(), "--open".to_owned(), open],
            environment,
        })
    }

    fn origin(&self, resolved: Resolved, launch: &Launch) -> Origin {
        let (described_in, device_index) = match self {
            Self::Described(description, None) => ("built-in".to_owned(), description.device),
            Self::Described(description, Some(file)) => {
                (file.display().to_string(), description.device)
            }
            Self::Found(open) => ("found".to_owned(), open.device),
            Self::Hidden(_) => ("hidden".to_owned(), None),
        };
        Origin {
            described_in,
            environment: launch.environment.iter().cloned().collect(),
            manifest: resolved.manifest,
            egl: resolved.egl,
            library_path: resolved.library_path,
            device_index,
        }
    }
}

/// Whether device or driver name themselves by the word, whatever its case.
fn answers(info: &AdapterInfo, word: &str) -> bool {
    let word = word.to_lowercase();
    [&info.device, &info.driver, &info.driver_version]
        .iter()
        .any(|text| text.to_lowercase().contains(&word))
}
