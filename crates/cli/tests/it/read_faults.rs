//! Drivers whose read-back is broken: the fault is inside the backend, where a probe would see it too, and
//! the run must be red.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Run, Verdict};
use std::collections::BTreeSet;

/// Single-sampled and multisampled formats, without cases that this driver is known to draw wrong.
const CASES: [&str; 3] = [
    "capabilities/draw/format={rgba8unorm,rgb10a2unorm,rgba16float}/samples={1,4}",
    "capabilities/draw-depth-stencil/format=depth32float-stencil8/samples={1,4}",
    "capabilities/clear/format=rgba8unorm/samples={1,4}",
];

/// Runs the cases. Returns the names of the unsupported ones, and of the ones that failed or were not drawn
/// because their round trip failed.
fn run(adapter: &str, code: i32) -> (BTreeSet<String>, BTreeSet<String>) {
    let out = tempfile::tempdir().unwrap();
    // A planted fault occurs in every process.
    let mut command = etalon(&["run", "--recheck", "off"]);
    command.args(CASES);
    command.args(["--profile", "full", "--adapter", adapter, "--out"]);
    command.arg(out.path()).assert().code(code);
    let run = Run::read(out.path()).unwrap();
    assert!(!run.records.is_empty(), "{adapter}");
    let cases_with = |verdicts: &[Verdict]| {
        let records = run.records.iter();
        let records = records.filter(|r| verdicts.contains(&r.verdict));
        records.map(|r| r.case.clone()).collect()
    };
    let wrong = [Verdict::Fail, Verdict::Blocked];
    (cases_with(&[Verdict::NotSupported]), cases_with(&wrong))
}

/// Every fault turns the run of a driver red, and makes no supported case unsupported.
fn faults_are_found(driver: &str) {
    let (lacking, failed) = run(driver, 0);
    assert!(failed.is_empty(), "{driver}: {failed:?}");
    for fault in [
        "off-by-one",
        "wrong-block",
        "zero-channel",
        "swapped-samples",
    ] {
        let (still_lacking, failed) = run(&format!("{driver}:read-fault={fault}"), 1);
        assert_eq!(lacking, still_lacking, "{driver} with {fault}");
        let several = failed.iter().any(|case| case.ends_with("samples=4"));
        let single = failed.iter().any(|case| case.ends_with("samples=1"));
        assert!(several, "{driver} with {fault}: {failed:?}");
        assert_eq!(
            single,
            fault != "swapped-samples",
            "{driver} with {fault}: {failed:?}"
        );
    }
}

#[test]
fn a_broken_read_back_of_vulkan_fails() {
    faults_are_found("vulkan:lavapipe");
}

#[test]
fn a_broken_read_back_of_opengl_fails() {
    faults_are_found("gl:llvmpipe");
}

#[test]
fn a_broken_read_back_of_opengl_es_fails() {
    faults_are_found("gl:es:llvmpipe");
}

#[test]
fn a_broken_read_back_of_wgpu_fails() {
    faults_are_found("wgpu:vulkan:lavapipe");
}

#[test]
fn faults_have_names() {
    etalon(&["run", "--adapter", "gl:llvmpipe:read-fault=none"])
        .assert()
        .code(64);
    // The rasterizer has no driver's read path.
    etalon(&["run", "--adapter", "cpu:read-fault=off-by-one"])
        .assert()
        .code(64);
}
