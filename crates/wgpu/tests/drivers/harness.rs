//! Child processes with a driver's environment, and scenes out of JSON.

use etalon_backend::Backend;
use etalon_case::{CaseFile, Profile};
use etalon_frame::{Aspect, Feature, Frame, Image};
use etalon_scene::Scene;
use etalon_wgpu::{Options, Via, WgpuBackend, enumerate, open};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Set in a child, to the test that it is to run.
const CHILD: &str = "ETALON_WGPU_TEST_CHILD";
const VULKAN_MANIFESTS: [&str; 3] = [
    "/usr/share/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/etc/vulkan/icd.d",
];

#[derive(Clone, Copy)]
pub(crate) enum Driver {
    Lavapipe,
    /// Mesa's OpenGL with this rasterizer.
    Gallium(&'static str),
}

impl Driver {
    fn name(self) -> String {
        match self {
            Self::Lavapipe => "wgpu:vulkan:lavapipe".to_owned(),
            Self::Gallium(rasterizer) => format!("wgpu:gl:{rasterizer}"),
        }
    }

    fn via(self) -> Via {
        match self {
            Self::Lavapipe => Via::Vulkan,
            Self::Gallium(_) => Via::Gl,
        }
    }

    fn environment(self) -> Vec<(&'static str, String)> {
        match self {
            Self::Lavapipe => {
                let manifest = lavapipe_manifest().to_string_lossy().into_owned();
                vec![
                    ("VK_DRIVER_FILES", manifest.clone()),
                    ("VK_ICD_FILENAMES", manifest),
                ]
            }
            Self::Gallium(rasterizer) => vec![
                ("LIBGL_ALWAYS_SOFTWARE", "1".to_owned()),
                ("GALLIUM_DRIVER", rasterizer.to_owned()),
            ],
        }
    }
}

fn lavapipe_manifest() -> PathBuf {
    VULKAN_MANIFESTS
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
                "lavapipe is not installed (no lvp_icd*.json in {VULKAN_MANIFESTS:?}): \
                 apt-get install mesa-vulkan-drivers"
            )
        })
}

/// Runs `body` with the driver, in a child process in which `name` is the only test.
pub(crate) fn in_child(name: &str, driver: Driver, validate: bool, body: fn(&WgpuBackend)) {
    if std::env::var_os(CHILD).is_some_and(|child| child == name) {
        let backend = opened(driver, validate);
        body(&backend);
        return;
    }
    let exe = std::env::current_exe().expect("the test knows its file");
    let output = Command::new(exe)
        .args([name, "--exact", "--nocapture"])
        .env(CHILD, name)
        .env("XDG_RUNTIME_DIR", std::env::temp_dir())
        .envs(driver.environment())
        .output()
        .expect("the child starts");
    assert!(
        output.status.success(),
        "{name} failed with {}:\n{}{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
}

fn opened(driver: Driver, validate: bool) -> WgpuBackend {
    let via = driver.via();
    let name = driver.name();
    let found = enumerate(via).unwrap_or_else(|e| panic!("{name} cannot be used: {e}"));
    let names: Vec<_> = found.iter().map(|info| info.name.as_str()).collect();
    let device = names
        .iter()
        .position(|n| *n == name)
        .unwrap_or_else(|| panic!("{name} is not among the adapters {names:?}"));
    assert!(found[device].software, "{name} is a software driver");
    let options = Options {
        via,
        device,
        validate,
    };
    let backend = open(&name, &options).unwrap_or_else(|e| panic!("{name} does not open: {e}"));
    assert_eq!(backend.adapter().name, name);
    backend
}

/// The scene of a case file's text: `attachments`, `passes` and `read`.
pub(crate) fn scene(json: &str) -> Scene {
    let text = format!(r#"{{"about": "A test.", "spec": ["none"], "scene": {json}}}"#);
    let file = CaseFile::parse("t.json", &text).expect("the scene parses");
    let case = file.cases(Profile::Full).next().expect("there is one case");
    case.build().expect("the scene is possible").scene
}

/// The scene's frame, after two submits that must give the same.
pub(crate) fn drawn(backend: &WgpuBackend, scene: &Scene) -> Frame {
    let mut prepared = backend.prepare(scene).expect("the scene is prepared");
    let time = prepared.submit().expect("the scene is drawn");
    assert!(time.cpu <= time.wall);
    let first = prepared.read_back().expect("the frame comes back");
    prepared.submit().expect("the scene is drawn again");
    let second = prepared.read_back().expect("the frame comes back again");
    assert_eq!(first, second, "two submits give the same frame");
    for image in &first.images {
        assert_eq!(image.codes.len(), image.expected_len());
    }
    first
}

pub(crate) fn frame(backend: &WgpuBackend, json: &str) -> Frame {
    drawn(backend, &scene(json))
}

pub(crate) fn has(backend: &WgpuBackend, feature: Feature) -> bool {
    backend.limits().features.contains(&feature)
}

pub(crate) fn image<'a>(frame: &'a Frame, attachment: &str, aspect: Aspect) -> &'a Image {
    frame
        .images
        .iter()
        .find(|i| i.attachment == attachment && i.aspect == aspect)
        .unwrap_or_else(|| panic!("{attachment} has no {aspect}"))
}

/// The value of a single-channel texel.
pub(crate) fn value(image: &Image, x: u32, y: u32) -> f64 {
    let encoding = image.channels[0];
    let order = encoding.order_of_code(image.sample(x, y, 0)[0]);
    encoding.value_of_order(order)
}

/// Whether each texel is what `expected` tells for its column and row.
#[track_caller]
pub(crate) fn assert_texels<const N: usize>(
    image: &Image,
    expected: impl Fn(u32, u32) -> [u32; N],
) {
    for y in 0..image.size[1] {
        for x in 0..image.size[0] {
            let due = expected(x, y);
            let came = image.sample(x, y, 0);
            assert_eq!(came, due, "{} at column {x}, row {y}", image.attachment);
        }
    }
}
