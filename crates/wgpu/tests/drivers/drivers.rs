//! The drivers under wgpu. A missing driver is a failure: nothing would have been tested.

use etalon_backend::Backend;
use etalon_conformance::{
    COUNTING_SHADERS, Driver, FOUR_SAMPLES, LLVMPIPE, SOFTPIPE, SOFTPIPE_DEFECTS, variables,
};
use etalon_wgpu::{Options, Via, WgpuBackend, enumerate, open};
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
    let options = Options {
        via,
        device,
        validate,
        read_fault: None,
    };
    let backend = open(name, &options).unwrap_or_else(|e| panic!("{name} does not open: {e}"));
    assert_eq!(backend.adapter().name, name);
    backend
}

/// Mistakes of wgpu 30 over Vulkan: it offers DEPTH_BIAS_CLAMP and does not enable the device's
/// depthBiasClamp.
const MISTAKES_OF_WGPU: &[&str] = &["VUID-VkGraphicsPipelineCreateInfo-pDynamicStates-00754"];

pub(crate) fn lavapipe() -> Driver<'static> {
    let manifest = lavapipe_manifest().to_string_lossy().into_owned();
    Driver {
        environment: vec![
            ("VK_DRIVER_FILES", manifest.clone()),
            ("VK_ICD_FILENAMES", manifest),
        ],
        open: |validate| Box::new(opened("wgpu:vulkan:lavapipe", Via::Vulkan, validate)),
        lacks: &["feature", "format", "4 samples"],
        defects: Vec::new(),
        tolerated: MISTAKES_OF_WGPU,
    }
}

pub(crate) fn llvmpipe() -> Driver<'static> {
    Driver {
        environment: variables(LLVMPIPE),
        open: |validate| Box::new(opened("wgpu:gl:llvmpipe", Via::Gl, validate)),
        lacks: &["feature", "format", "drawing", "blending", "4 samples"],
        defects: vec![RESTART, SIGNED, FACTORS, SAMPLES],
        tolerated: MISTAKES_OF_WGPU,
    }
}

pub(crate) fn softpipe() -> Driver<'static> {
    let defects = [
        RESTART,
        SIGNED,
        SAMPLES,
        (COUNTING_SHADERS, UNTRANSLATED),
        ("integers::integers_are_drawn_through_the_write_mask", CLEAR),
        ("targets::the_second_source_is_a_factor", SECOND),
        ("targets::the_second_source_weighs_one_side", SECOND),
        ("targets::later_draws_have_one_source", SECOND),
    ];
    Driver {
        environment: variables(SOFTPIPE),
        open: |validate| Box::new(opened("wgpu:gl:softpipe", Via::Gl, validate)),
        lacks: &["feature", "format", "drawing", "blending", "4 samples"],
        defects: [SOFTPIPE_DEFECTS, &defects].concat(),
        tolerated: MISTAKES_OF_WGPU,
    }
}

/// wgpu's OpenGL never enables the restart of primitives.
const RESTART: (&str, &str) = ("raster::strips_begin_again", "strips that are joined");
const SIGNED: (&str, &str) = (
    "formats::uploads_come_back",
    "negative codes of rgba8snorm that come back as 0",
);
/// wgpu's OpenGL leaves the factors of a draw with two sources behind, and Mesa refuses later draws to
/// several targets with GL_INVALID_OPERATION.
const FACTORS: (&str, &str) = (
    "targets::later_draws_have_one_source",
    "factors of a second source that outlive their draw",
);
/// wgpu 30 offers four samples over OpenGL, also where the driver has one, and makes no texture of which
/// a shader could read them.
const SAMPLES: (&str, &str) = (FOUR_SAMPLES, "textures of four samples that stay empty");
const UNTRANSLATED: &str = "storage buffers that wgpu does not translate to GLSL 330";
const CLEAR: &str = "a clear that is lost to the draws of its pass";
const SECOND: &str = "a second source that comes as the first";
