//! Drivers that are installed but do not start.

use crate::backend_name::BackendName;
use crate::discovery::Adapters;
use etalon_frame::{AdapterInfo, Api, Limits};
use etalon_record::{AbsentAdapter, AdapterRecord};

/// Takes the drivers that do not start out of `adapters.dead` and `adapters.absent`. Returns each as a record without
/// limits, with the reason.
pub fn take_unstarted(adapters: &mut Adapters) -> Vec<(AdapterRecord, String)> {
    let record = |(backend, absent): (BackendName, AbsentAdapter)| {
        let (backend, api) = match backend {
            // The rasterizer always starts.
            BackendName::Cpu => ("cpu", Api::Vulkan),
            BackendName::Vulkan => ("vulkan", Api::Vulkan),
            BackendName::Gl => ("gl", Api::OpenGl),
            BackendName::GlEs => ("gl", Api::OpenGlEs),
            BackendName::WgpuVulkan
            | BackendName::WgpuGl
            | BackendName::WgpuDx12
            | BackendName::WgpuMetal => ("wgpu", Api::WebGpu),
            BackendName::Webgpu => ("webgpu", Api::WebGpu),
            // Only a program that has started says which rules bind it.
            BackendName::External => ("external", Api::Vulkan),
        };
        let adapter = AdapterRecord {
            info: AdapterInfo {
                name: absent.name,
                backend: backend.to_owned(),
                software: false,
                ..AdapterInfo::default()
            },
            release: None,
            limits: Limits::nothing(api),
        };
        (adapter, absent.reason)
    };
    let dead: Vec<(AdapterRecord, String)> = adapters.dead.drain(..).map(record).collect();
    let is_dead = |name: &str| dead.iter().any(|(adapter, _)| adapter.info.name == name);
    adapters.absent.retain(|absent| !is_dead(&absent.name));
    dead
}
