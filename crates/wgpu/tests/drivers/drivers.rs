//! The drivers under wgpu. A missing driver is a failure: nothing would have been tested.

use etalon_backend::Backend;
use etalon_conformance::{LLVMPIPE, SOFTPIPE, TestedDriver, known, variables};
use etalon_wgpu::{Via, WgpuBackend, WgpuOptions, enumerate, open};
use std::fs;
use std::path::PathBuf;

const MANIFESTS: [&str; 3] = [
    "/usr/share/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/etc/vulkan/icd.d",
];

fn lavapipe_manifest() -> PathBuf {
    MANIFESTS
        .iter()
        .filter_map(|folder| fs::read_dir(folder).ok())
        .flatten()
        .flatten()
        .map(|entry| entry.path())
        .find(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("lvp_icd")
        })
        .unwrap_or_else(|| {
            panic!(
                "lavapipe is not installed (no lvp_icd*.json in {MANIFESTS:?}): \
                 apt-get install mesa-vulkan-drivers"
            )
        })
}

fn opened(name: &str, via: Via, validate: bool) -> WgpuBackend {
    let found = enumerate(via).unwrap_or_else(|e| panic!("{name} cannot be used: {e}"));
    let names: Vec<_> = found.iter().map(|info| info.name.as_str()).collect();
    let device = names.iter().position(|n| *n == name);
    let device = device.unwrap_or_else(|| panic!("{name} is not among the adapters {names:?}"));
    assert!(found[device].software, "{name} is a software driver");
    let options = WgpuOptions {
        via,
        device,
        validate,
        fault: None,
        record: false,
    };
    let backend = open(name, &options).unwrap_or_else(|e| panic!("{name} does not open: {e}"));
    assert_eq!(backend.adapter().name, name);
    backend
}

/// Validation errors of wgpu 30 over Vulkan: it offers DEPTH_BIAS_CLAMP but does not enable the device's
/// depthBiasClamp.
const MISTAKES_OF_WGPU: &[&str] = &["VUID-VkGraphicsPipelineCreateInfo-pDynamicStates-00754"];

pub(crate) fn lavapipe() -> TestedDriver<'static> {
    let manifest = lavapipe_manifest().to_string_lossy().into_owned();
    TestedDriver {
        known: known("wgpu:vulkan:lavapipe"),
        environment: vec![
            ("VK_DRIVER_FILES", manifest.clone()),
            ("VK_ICD_FILENAMES", manifest),
        ],
        open: |validate| Box::new(opened("wgpu:vulkan:lavapipe", Via::Vulkan, validate)),
        tolerated: MISTAKES_OF_WGPU,
    }
}

pub(crate) fn llvmpipe() -> TestedDriver<'static> {
    TestedDriver {
        known: known("wgpu:gl:llvmpipe"),
        environment: variables(LLVMPIPE),
        open: |validate| Box::new(opened("wgpu:gl:llvmpipe", Via::Gl, validate)),
        tolerated: MISTAKES_OF_WGPU,
    }
}

pub(crate) fn softpipe() -> TestedDriver<'static> {
    TestedDriver {
        known: known("wgpu:gl:softpipe"),
        environment: variables(SOFTPIPE),
        open: |validate| Box::new(opened("wgpu:gl:softpipe", Via::Gl, validate)),
        tolerated: MISTAKES_OF_WGPU,
    }
}
