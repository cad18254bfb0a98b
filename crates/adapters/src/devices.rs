//! Enumeration of hardware devices. Each backend enumerates in its own process, since drivers can crash or
//! hang.

use crate::backend_name::BackendName;
use crate::names::sanitized;
use crate::runtime_folder::default_runtime_folder;
use etalon_process::ProcessGroup;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// The time limit of an enumeration.
const LIMIT: Duration = Duration::from_secs(60);
/// The maximum size of a list of devices in bytes.
const MAX_BYTES: u64 = 1 << 20;

/// A device that a backend enumerated. Its name need not be unique.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HardwareDevice {
    /// The backend's prefix and the driver's name: `vulkan:radv`.
    pub name: String,
    /// The index of the device in the backend's order.
    pub device: usize,
}

/// The backends that enumerate devices: argument of the worker, prefix of names, backend.
pub(crate) const BACKENDS: &[(&str, &str, BackendName)] = &[
    ("vulkan", "vulkan", BackendName::Vulkan),
    ("gl", "gl", BackendName::Gl),
    ("gl-es", "gl:es", BackendName::GlEs),
    ("wgpu-vulkan", "wgpu:vulkan", BackendName::WgpuVulkan),
    ("wgpu-gl", "wgpu:gl", BackendName::WgpuGl),
    #[cfg(windows)]
    ("wgpu-dx12", "wgpu:dx12", BackendName::WgpuDx12),
    #[cfg(target_vendor = "apple")]
    ("wgpu-metal", "wgpu:metal", BackendName::WgpuMetal),
];

/// Hardware drivers that have findings. A machine without the hardware does not make these findings dead.
const KNOWN_DRIVERS: [&str; 1] = ["nvidia"];

/// Returns the names of the hardware adapters that have findings.
pub fn hardware_names() -> impl Iterator<Item = String> {
    BACKENDS.iter().flat_map(|(_, prefix, _)| {
        KNOWN_DRIVERS
            .iter()
            .map(move |driver| format!("{prefix}:{driver}"))
    })
}

/// Enumerates the devices of a backend in a new process.
///
/// # Errors
/// If the process fails; the message says how it ended.
pub(crate) fn enumerate(backend: &str) -> Result<Vec<HardwareDevice>, String> {
    let program = std::env::current_exe()
        .map_err(|e| format!("cannot find the program file of etalon: {e}"))?;
    let mut command = Command::new(program);
    command
        .args(["worker", "--enumerate", backend])
        .envs(default_runtime_folder())
        // The end of this pipe shows that this process ended.
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null());
    let (mut child, group) = ProcessGroup::start(&mut command)
        .map_err(|e| format!("cannot start the process that lists devices: {e}"))?;
    let input = child.stdin.take();
    let mut pipe = child.stdout.take();
    let (sender, receiver) = channel();
    let reading = thread::Builder::new().spawn(move || {
        let mut bytes = Vec::new();
        if let Some(pipe) = &mut pipe {
            // If the pipe breaks, the text does not parse.
            let _ = pipe.take(MAX_BYTES).read_to_end(&mut bytes);
        }
        // After the time limit there is no receiver.
        let _ = sender.send(bytes);
    });
    let end = |child: &mut Child| {
        // Killing fails if the process has already ended.
        group.kill();
        let _ = child.kill();
        let _ = child.wait();
    };
    if let Err(e) = reading {
        end(&mut child);
        return Err(format!("cannot read the list of devices: {e}"));
    }
    let Ok(bytes) = receiver.recv_timeout(LIMIT) else {
        end(&mut child);
        return Err(format!(
            "listing devices took more than {} s",
            LIMIT.as_secs()
        ));
    };
    let status = match child.wait() {
        Ok(status) => status,
        Err(e) => {
            end(&mut child);
            return Err(format!(
                "cannot wait for the process that lists devices: {e}"
            ));
        }
    };
    group.kill();
    drop(input);
    if !status.success() {
        return Err(format!(
            "the process that lists devices ended with {status}"
        ));
    }
    serde_json::from_slice(&bytes).map_err(|e| format!("listing devices gave an invalid list: {e}"))
}

/// Makes the names of devices unique: the second of a name gets `-2`, the third `-3`. `taken` are the names of
/// described adapters.
pub(crate) fn unique_names(
    taken: &BTreeSet<String>,
    found: Vec<HardwareDevice>,
) -> Vec<HardwareDevice> {
    let mut taken = taken.clone();
    found
        .into_iter()
        .map(|found| {
            let base = sanitized(&found.name);
            let name = (1_usize..)
                .map(|n| match n {
                    1 => base.clone(),
                    n => format!("{base}-{n}"),
                })
                .find(|name| !taken.contains(name))
                .expect("there are more numbers than names");
            taken.insert(name.clone());
            HardwareDevice { name, ..found }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::names::is_name;

    fn named(taken: &[&str], found: &[&str]) -> Vec<String> {
        let taken = taken.iter().map(|n| (*n).to_owned()).collect();
        let found = found
            .iter()
            .enumerate()
            .map(|(device, name)| HardwareDevice {
                name: (*name).to_owned(),
                device,
            });
        let named = unique_names(&taken, found.collect());
        for (device, found) in named.iter().enumerate() {
            assert_eq!(found.device, device);
            assert!(is_name(&found.name), "{}", found.name);
        }
        named.into_iter().map(|f| f.name).collect()
    }

    #[test]
    fn devices_of_one_driver_are_numbered() {
        let same = ["vulkan:radv", "vulkan:nvidia", "vulkan:radv", "vulkan:radv"];
        assert_eq!(
            named(&["cpu"], &same),
            [
                "vulkan:radv",
                "vulkan:nvidia",
                "vulkan:radv-2",
                "vulkan:radv-3"
            ]
        );
    }

    #[test]
    fn no_two_names_are_the_same() {
        // A driver can have the name that another driver's second device would get.
        let found = ["gl:a", "gl:a-2", "gl:a", "gl:zink", "gl:a", "gl:a-2"];
        let names = named(&["gl:zink", "gl:a-3"], &found);
        assert_eq!(
            names,
            [
                "gl:a",
                "gl:a-2",
                "gl:a-4",
                "gl:zink-2",
                "gl:a-5",
                "gl:a-2-2"
            ]
        );
    }

    #[test]
    fn names_of_drivers_become_plain_and_distinct() {
        let long = format!("vulkan:{}", "x".repeat(200));
        let names = named(&[], &["gl:<b>&", "", &long, &long, "-v", "gl:\u{1b}é"]);
        assert_eq!(names[0], "gl:-b--");
        assert_eq!(names[1], "gpu");
        assert_eq!(names[3], format!("{}-2", names[2]));
        assert_eq!(names[4], "gpu-2");
        assert_eq!(names[5], "gl:--");
    }
}
