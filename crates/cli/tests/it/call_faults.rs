//! Drivers that get a call wrong: the fault is between the backend and the driver, where the suite cannot see
//! it. The cases of the fault's area must fail.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_backend::CallFault;
use etalon_frame::Api;
use etalon_record::{Run, Verdict};
use std::collections::{BTreeMap, BTreeSet};

/// The number of parts of the cases. One part shows most faults.
const PARTS: u32 = 6;

/// Runs a part of some cases on an adapter. Returns the names of the failing ones, and whether a finding expects
/// the failure.
fn failed<'a>(
    adapter: &str,
    cases: impl IntoIterator<Item = &'a str>,
    part: u32,
) -> BTreeMap<String, bool> {
    let out = tempfile::tempdir().unwrap();
    // A planted fault occurs in every process.
    let mut command = etalon(&["run", "--recheck", "off", "--adapter", adapter]);
    let shard = format!("{part}/{PARTS}");
    command.args(["--shard", &shard]).args(cases);
    let assert = command.arg("--out").arg(out.path()).assert();
    let records = Run::read(out.path()).unwrap().records;
    let failed = records.into_iter().filter(|r| r.verdict == Verdict::Fail);
    let failed: BTreeMap<String, bool> = failed.map(|r| (r.case, r.expected.is_some())).collect();
    let is_red = failed.values().any(|expected| !expected);
    assert.code(i32::from(is_red));
    failed
}

/// Every fault turns the run of a driver red, by a case that passes without the fault.
fn faults_are_found(driver: &str, faults: impl Iterator<Item = CallFault>) {
    let mut hidden: Vec<CallFault> = faults.collect();
    for part in 1..=PARTS {
        if hidden.is_empty() {
            return;
        }
        let cases: BTreeSet<&str> = hidden.iter().map(|fault| fault.cases()).collect();
        let without = failed(driver, cases, part);
        let expected = without.values().all(|expected| *expected);
        assert!(expected, "{driver} without a fault: {without:?}");
        hidden.retain(|fault| {
            let adapter = format!("{driver}:call-fault={}", fault.name());
            let with = failed(&adapter, [fault.cases()], part);
            with.keys().all(|case| without.contains_key(case))
        });
    }
    let names: Vec<&str> = hidden.iter().map(|fault| fault.name()).collect();
    assert!(names.is_empty(), "{driver}: no case fails with {names:?}");
}

#[test]
fn every_fault_of_vulkan_calls_fails() {
    // lavapipe's multiview is wrong even without a fault.
    let view_first = |fault: &CallFault| *fault == CallFault::ViewFirst;
    let faults = CallFault::ALL.iter().copied();
    let vulkan = faults.filter(|fault| fault.is_in(Api::Vulkan));
    faults_are_found("vulkan:lavapipe", vulkan.clone().filter(|f| !view_first(f)));
    faults_are_found("vulkan:swiftshader", vulkan.filter(view_first));
}

#[test]
fn every_fault_of_opengl_calls_fails() {
    let faults = CallFault::ALL.iter().copied();
    faults_are_found(
        "gl:llvmpipe",
        faults.filter(|fault| fault.is_in(Api::OpenGl)),
    );
}

#[test]
fn every_fault_of_webgpu_lists_fails() {
    let faults = CallFault::ALL.iter().copied();
    let of_lists = faults.filter(|fault| fault.is_in(Api::WebGpu));
    faults_are_found("wgpu:vulkan:lavapipe", of_lists.clone());
    faults_are_found("webgpu:chromium", of_lists);
}

#[test]
fn faults_of_calls_have_names() {
    for name in [
        "gl:llvmpipe:call-fault=none",
        // OpenGL has no load operations.
        "gl:llvmpipe:call-fault=load-clears",
        // Vulkan's clip volume has one origin.
        "vulkan:lavapipe:call-fault=clip-origin-kept",
        // The rasterizer cannot have a fault in a call, and a list of calls cannot have this one.
        "cpu:call-fault=last-row",
        "wgpu:vulkan:lavapipe:call-fault=last-row",
        "webgpu:chromium:call-fault=last-row",
    ] {
        etalon(&["run", "--adapter", name]).assert().code(64);
    }
}
