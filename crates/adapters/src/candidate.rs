//! Starts the worker of an adapter that might be usable.

use crate::backend_name::BackendName;
use crate::cache;
use crate::description::{Description, Resolved, Unresolved};
use crate::devices::HardwareDevice;
use crate::error::AdapterError;
use crate::guard::guard;
use crate::open::{FROM_INPUT, OpenRequest};
use crate::origin::Origin;
use crate::query::Query;
use crate::runtime_folder::default_runtime_folder;
use etalon_backend::Fault;
use etalon_frame::{AdapterInfo, Api};
use etalon_record::AbsentAdapter;
use etalon_runner::{Launch, Launcher, START_TIMEOUT, StartError, Worker};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The longest failed start after which the driver gets a second attempt.
const RETRY_LIMIT: Duration = Duration::from_secs(10);
/// The folders that the system's loader searches first.
const LIBRARY_PATH: &str = if cfg!(windows) {
    "PATH"
} else if cfg!(target_vendor = "apple") {
    "DYLD_LIBRARY_PATH"
} else {
    "LD_LIBRARY_PATH"
};
/// The remedy if no other is known.
const SEE_LOG: &str = "see the driver's own log";

/// An adapter that might be usable.
pub(crate) enum Candidate {
    /// An entry of this file; `None` is the built-in one.
    Described(Box<Description>, Option<PathBuf>),
    /// A device that a backend enumerated.
    Enumerated(Box<OpenRequest>),
}

/// A usable adapter.
pub(crate) struct Started {
    pub(crate) launch: Launch,
    pub(crate) worker: Worker,
    pub(crate) origin: Origin,
}

/// The reason why an adapter did not start.
pub(crate) enum NoStart {
    /// The adapter cannot be used.
    Absent(AbsentAdapter),
    /// The adapter's driver is installed, but crashes or hangs while it starts.
    Failed(BackendName, AbsentAdapter),
    /// A built-in entry needs a variable that is not set.
    NotEnabled(AbsentAdapter),
    /// The user's file describes something that does not exist.
    Wrong(AdapterError),
}

fn open(name: &str, backend: BackendName) -> OpenRequest {
    OpenRequest {
        name: name.to_owned(),
        backend,
        device: None,
        egl: None,
        browser: None,
        program: None,
        server: None,
        listen: None,
        validate: false,
        record: false,
        fault: None,
    }
}

impl Candidate {
    pub(crate) fn described(description: Description, file: Option<&Path>) -> Self {
        Self::Described(Box::new(description), file.map(Path::to_owned))
    }

    pub(crate) fn enumerated(device: HardwareDevice, backend: BackendName) -> Self {
        Self::Enumerated(Box::new(OpenRequest {
            device: Some(device.device),
            ..open(&device.name, backend)
        }))
    }

    /// Returns the adapter with a planted fault, under the given name; `None` if its backend cannot have this
    /// fault.
    pub(crate) fn with_fault(&self, name: &str, fault: Fault) -> Option<Self> {
        match self {
            Self::Described(description, file) if fits(fault, description.backend) => {
                let mut description = description.clone();
                name.clone_into(&mut description.name);
                description.fault = Some(fault);
                if description.remedy.is_empty() {
                    SEE_LOG.clone_into(&mut description.remedy);
                }
                Some(Self::Described(description, file.clone()))
            }
            Self::Enumerated(open) if fits(fault, open.backend) => {
                Some(Self::Enumerated(Box::new(OpenRequest {
                    name: name.to_owned(),
                    fault: Some(fault),
                    ..(**open).clone()
                })))
            }
            _ => None,
        }
    }

    pub(crate) fn backend(&self) -> BackendName {
        match self {
            Self::Described(description, _) => description.backend,
            Self::Enumerated(open) => open.backend,
        }
    }

    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Described(description, _) => &description.name,
            Self::Enumerated(open) => &open.name,
        }
    }

    fn remedy(&self) -> &str {
        match self {
            Self::Described(description, _) => &description.remedy,
            Self::Enumerated(_) => SEE_LOG,
        }
    }

    fn absent(&self, reason: impl ToString, remedy: &str) -> AbsentAdapter {
        AbsentAdapter {
            name: self.name().to_owned(),
            reason: reason.to_string(),
            remedy: remedy.to_owned(),
        }
    }

    /// Starts the worker and checks that the driver is the one described.
    pub(crate) fn start(
        &self,
        query: &Query<'_>,
        invite: &dyn Fn(&str, &str),
    ) -> Result<Started, NoStart> {
        let resolved = self.resolve()?;
        let launch = self
            .launch(&resolved, query)
            .map_err(|reason| NoStart::Absent(self.absent(reason, self.remedy())))?;
        if let Some(listen) = &resolved.listen {
            invite(self.name(), &listen.invitation());
        }
        // A driver that fails quickly gets a second attempt; one that hangs does not.
        let begun = Instant::now();
        let started = match Worker::start(&launch) {
            Err(StartError::Broken(_)) if begun.elapsed() < RETRY_LIMIT => Worker::start(&launch),
            other => other,
        };
        let worker = started.map_err(|error| match error {
            StartError::Unavailable(u) => {
                // The file names packages, but not the packages of validation layers. At this point, the
                // server is already installed.
                let starts_itself =
                    query.validate || self.remedy().is_empty() || resolved.server.is_some();
                let remedy = if starts_itself {
                    &u.remedy
                } else {
                    self.remedy()
                };
                NoStart::Absent(self.absent(&u.reason, remedy))
            }
            StartError::Launcher(reason) => {
                let file = match self {
                    Self::Described(_, Some(file)) => file.display().to_string(),
                    _ => "the built-in adapters.json".to_owned(),
                };
                NoStart::Wrong(AdapterError::UnusableEntry {
                    file,
                    name: self.name().to_owned(),
                    reason,
                })
            }
            StartError::Broken(reason) => {
                let backend = self.open(&resolved, query).backend;
                NoStart::Failed(backend, self.absent(reason, self.remedy()))
            }
        })?;
        if let Self::Described(description, _) = self
            && let Some(word) = &description.answers
            && !answers(&worker.hello.info, word)
        {
            let info = &worker.hello.info;
            let reason = format!(
                "another driver answers: {}, {}; its name should contain `{word}`, the `answers` of its description",
                info.device, info.driver
            );
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
        // A relative path would depend on the worker's current folder.
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
                (Some(file), _) => NoStart::Wrong(AdapterError::UnusableEntry {
                    file: file.display().to_string(),
                    name: description.name.clone(),
                    reason: format!("{why}; {remedy}"),
                }),
                (None, Unresolved::Variable(_)) => NoStart::NotEnabled(self.absent(why, &remedy)),
                (None, _) => NoStart::Absent(self.absent(why, &remedy)),
            }
        })
    }

    fn open(&self, resolved: &Resolved, query: &Query<'_>) -> OpenRequest {
        let mut open = match self {
            Self::Described(description, _) => OpenRequest {
                device: description.device,
                egl: resolved.egl.clone(),
                browser: resolved.browser.clone(),
                program: resolved.drawing.clone(),
                server: resolved.server.clone(),
                listen: resolved.listen.clone(),
                fault: description.fault,
                ..open(&description.name, description.backend)
            },
            Self::Enumerated(open) => (**open).clone(),
        };
        open.validate = query.validate;
        open.record = query.record;
        open
    }

    fn launch(&self, resolved: &Resolved, query: &Query<'_>) -> Result<Launch, String> {
        let program = match &resolved.program {
            Some(program) => program.clone(),
            None => std::env::current_exe()
                .map_err(|e| format!("cannot find the program file of etalon: {e}"))?,
        };
        let mut environment = resolved.environment.clone();
        if let Some(manifest) = &resolved.manifest {
            let manifest = manifest.to_string_lossy().into_owned();
            // Loaders before 1.3.207 know only the second name.
            for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
                environment.push((name.to_owned(), Some(manifest.clone())));
            }
            // The user's own choice of drivers must not apply here.
            for name in ["VK_LOADER_DRIVERS_SELECT", "VK_LOADER_DRIVERS_DISABLE"] {
                environment.push((name.to_owned(), None));
            }
        }
        if !resolved.library_path.is_empty() {
            let here = resolved.launcher.is_empty();
            let before = std::env::var_os(LIBRARY_PATH)
                .filter(|_| here)
                .unwrap_or_default();
            let before = std::env::split_paths(&before).filter(|p| !p.as_os_str().is_empty());
            let folders = resolved.library_path.iter().cloned().chain(before);
            let path = std::env::join_paths(folders).map_err(|e| e.to_string())?;
            let path = path.to_string_lossy().into_owned();
            environment.push((LIBRARY_PATH.to_owned(), Some(path)));
        }
        if query.cold {
            environment.extend(cache::disable());
        }
        environment.extend(default_runtime_folder().map(|(name, value)| (name, Some(value))));
        let open = serde_json::to_string(&self.open(resolved, query)).map_err(|e| e.to_string())?;
        let launcher = (!resolved.launcher.is_empty()).then(|| Launcher {
            prefix: guarded(&resolved.launcher),
            open: open.clone(),
        });
        let open = launcher.as_ref().map_or(open, |_| FROM_INPUT.to_owned());
        Ok(Launch {
            adapter: self.name().to_owned(),
            program,
            arguments: vec!["worker".to_owned(), "--open".to_owned(), open],
            environment,
            launcher,
            release: match self {
                Self::Described(description, _) => description.release(),
                Self::Enumerated(_) => None,
            },
            patience: match resolved.listen {
                Some(_) => etalon_browser::WAITING + START_TIMEOUT,
                None => query.start_timeout.unwrap_or(START_TIMEOUT),
            },
            alone: resolved.listen.is_some(),
        })
    }

    fn origin(&self, resolved: Resolved, launch: &Launch) -> Origin {
        let (described_in, device_index) = match self {
            Self::Described(description, None) => ("built-in".to_owned(), description.device),
            Self::Described(description, Some(file)) => {
                (file.display().to_string(), description.device)
            }
            Self::Enumerated(open) => ("found".to_owned(), open.device),
        };
        Origin {
            described_in,
            launcher: resolved.launcher,
            environment: launch.environment.iter().cloned().collect(),
            manifest: resolved.manifest,
            egl: resolved.egl,
            library_path: resolved.library_path,
            device_index,
        }
    }
}

/// Returns the words of a launcher behind those of a guard, which ends what the launcher starts.
fn guarded(launcher: &[String]) -> Vec<String> {
    let guard = guard(true).ok().filter(|_| cfg!(unix));
    let words = guard.iter().flat_map(|guard| {
        let program = std::iter::once(guard.get_program());
        program.chain(guard.get_args())
    });
    let words = words.map(|word| word.to_string_lossy().into_owned());
    words.chain(launcher.iter().cloned()).collect()
}

/// Returns true if a backend can have a fault.
fn fits(fault: Fault, backend: BackendName) -> bool {
    fault.fits(match backend {
        BackendName::Cpu => None,
        BackendName::Vulkan => Some(Api::Vulkan),
        BackendName::Gl | BackendName::GlEs => Some(Api::OpenGl),
        BackendName::WgpuVulkan
        | BackendName::WgpuGl
        | BackendName::WgpuDx12
        | BackendName::WgpuMetal
        | BackendName::Webgpu => Some(Api::WebGpu),
        BackendName::External => return false,
    })
}

/// Returns true if the name of the device or driver contains the word, ignoring case.
fn answers(info: &AdapterInfo, word: &str) -> bool {
    let word = word.to_lowercase();
    [&info.device, &info.driver, &info.driver_version]
        .iter()
        .any(|text| text.to_lowercase().contains(&word))
}
