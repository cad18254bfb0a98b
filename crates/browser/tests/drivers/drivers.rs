//! The browsers. A missing one is a failure: nothing would have been tested.

use etalon_backend::{Backend, Fault};
use etalon_browser::{Browser, BrowserBackend, BrowserOptions, PageSource, open};
use etalon_conformance::{TestedDriver, Value, known};
use etalon_frame::{Api, TextureFormat};
use etalon_keeper::keep;
use std::io::{BufReader, stdin};
use std::process::Command;

/// The browsers as `etalon` starts them.
const ADAPTERS: &str = include_str!("../../../adapters/adapters.json");

/// The software driver below Firefox and Deno.
const LAVAPIPE: &str = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json";
/// The software driver below Dawn in Node: that of Chromium.
const SWIFTSHADER: &str = "/usr/lib/chromium/vk_swiftshader_icd.json";

/// The process that keeps a browser; only the tests start it.
#[test]
#[ignore = "a process of the other tests"]
fn keeper() {
    keep(BufReader::new(stdin()), None).expect("the browser is kept");
}

/// Returns the browser of an adapter.
pub(crate) fn browser(name: &str) -> Browser {
    let adapters: Vec<Value> = serde_json::from_str(ADAPTERS).expect("the built-in file is JSON");
    let entry = adapters.iter().find(|entry| entry["name"] == name);
    let entry = entry.unwrap_or_else(|| panic!("{name} is not built in"));
    let profile = entry.get("profile").cloned().unwrap_or_default();
    Browser {
        command: serde_json::from_value(entry["browser"].clone()).expect("words"),
        profile: serde_json::from_value::<Option<_>>(profile)
            .expect("files")
            .unwrap_or_default(),
    }
}

/// Opens the browser of an adapter.
pub(crate) fn opened(name: &str, validate: bool, fault: Option<Fault>) -> BrowserBackend {
    started(name, browser(name), validate, fault)
}

/// Opens a browser.
fn started(name: &str, browser: Browser, validate: bool, fault: Option<Fault>) -> BrowserBackend {
    let program = std::env::current_exe().expect("this program has a path");
    let mut keeper = Command::new(program);
    keeper.args(["--exact", "drivers::keeper", "--ignored", "--nocapture"]);
    let options = BrowserOptions {
        source: PageSource::Started(browser, keeper),
        validate,
        fault,
        record: false,
    };
    let backend = open(name, options).unwrap_or_else(|e| {
        panic!("{name} cannot be used: {e}: apt-get install chromium firefox-esr, or ci/adapters/webgpu")
    });
    assert!(backend.adapter().software, "{name} draws in software");
    backend
}

pub(crate) fn chromium() -> TestedDriver<'static> {
    TestedDriver {
        known: known("webgpu:chromium"),
        environment: Vec::new(),
        open: |validate| Box::new(opened("webgpu:chromium", validate, None)),
        tolerated: &[],
    }
}

/// Chromium, whose page asks for a device in compatibility mode.
pub(crate) fn compatibility() -> TestedDriver<'static> {
    TestedDriver {
        known: known("webgpu:compatibility"),
        environment: Vec::new(),
        open: |validate| {
            let mut browser = browser("webgpu:chromium");
            for word in &mut browser.command {
                *word = word.replace("{url}", "{url}?compatibility");
            }
            let backend = started("webgpu:chromium", browser, validate, None);
            assert!(backend.adapter().api_version.contains("compatibility"));
            Box::new(backend)
        },
        tolerated: &[],
    }
}

pub(crate) fn firefox() -> TestedDriver<'static> {
    TestedDriver {
        known: known("webgpu:firefox"),
        environment: over(LAVAPIPE),
        open: |validate| Box::new(opened("webgpu:firefox", validate, None)),
        tolerated: &[],
    }
}

pub(crate) fn dawn() -> TestedDriver<'static> {
    TestedDriver {
        known: known("webgpu:dawn"),
        environment: over(SWIFTSHADER),
        open: |validate| Box::new(opened("webgpu:dawn", validate, None)),
        tolerated: &[],
    }
}

pub(crate) fn deno() -> TestedDriver<'static> {
    TestedDriver {
        known: known("webgpu:deno"),
        environment: over(LAVAPIPE),
        open: |validate| Box::new(opened("webgpu:deno", validate, None)),
        tolerated: &[],
    }
}

/// Returns the variables that choose a Vulkan driver by its manifest.
fn over(manifest: &str) -> Vec<(&'static str, String)> {
    ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"]
        .map(|name| (name, manifest.to_owned()))
        .to_vec()
}

/// Facts that the drivers' descriptions do not give.
pub(crate) fn offers(backend: &dyn Backend) {
    let limits = backend.limits();
    assert_eq!(limits.api, Api::WebGpu);
    assert_eq!(limits.formats[&TextureFormat::Rgba8Unorm].samples, [1, 4]);
    assert_eq!(limits.formats[&TextureFormat::Rgba8Uint].samples, [1]);
    assert!(!backend.adapter().driver_version.is_empty());
}
