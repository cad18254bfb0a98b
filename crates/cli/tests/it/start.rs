//! `etalon` without arguments, and a machine without a graphics driver.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use assert_cmd::Command;
use std::fs;

fn stderr(command: &mut Command, code: i32) -> String {
    let assert = command.assert().code(code).stdout("");
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

#[test]
fn without_arguments_it_says_what_it_found_and_what_to_type() {
    let text = stderr(&mut etalon(&[]), 64);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 4, "{text}");
    let version = env!("CARGO_PKG_VERSION");
    let start = format!("etalon {version} found cpu, vulkan:lavapipe, ");
    assert!(lines[0].starts_with(&start), "{text}");
    assert!(lines[1].starts_with("etalon run "), "{text}");
    // Browsers take seconds to start.
    assert!(!text.contains("webgpu:"), "{text}");
}

#[test]
fn without_a_driver_it_says_how_to_get_one() {
    // Files that are not libraries come before the real ones on the path.
    let libraries = tempfile::tempdir().unwrap();
    for name in ["libvulkan.so.1", "libvulkan.so", "libEGL.so.1", "libEGL.so"] {
        fs::write(libraries.path().join(name), "").unwrap();
    }
    let mut start = etalon(&[]);
    start.env("LD_LIBRARY_PATH", libraries.path());
    let text = stderr(start.env("PATH", "/none"), 64);
    assert_eq!(text.lines().count(), 4, "{text}");
    for part in ["no graphics driver was found", "apt-get install"] {
        assert!(text.contains(part), "{text}");
    }
}
