//! Drivers that get a call wrong: the fault is between the backend and the driver, where the suite cannot see
//! it. The cases of the fault's area must fail.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use crate::sample;
use etalon_backend::CallFault;
use etalon_frame::Api;
use etalon_record::{Run, Verdict};
use std::collections::{BTreeMap, BTreeSet};

/// Runs cases on an adapter. Returns the names of the failing ones, and whether a finding expects the
/// failure.
fn failed<'a>(
    adapter: &str,
    cases: impl IntoIterator<Item = &'a str>,
    code: i32,
) -> BTreeMap<String, bool> {
    let out = tempfile::tempdir().unwrap();
    // A planted fault occurs in every process.
    let mut command = etalon(&["run", "--recheck", "off", "--adapter", adapter]);
    command.args(cases).arg("--out").arg(out.path());
    command.assert().code(code);
    let records = Run::read(out.path()).unwrap().records;
    let failed = records.into_iter().filter(|r| r.verdict == Verdict::Fail);
    failed.map(|r| (r.case, r.expected.is_some())).collect()
}

/// Returns the faults of an API's calls. A fault that several APIs can have is planted in one of them, a
/// different one for each fault, or in all with `ETALON_TESTS=all`.
fn faults_in(api: Api) -> impl Iterator<Item = CallFault> + Clone {
    let all = CallFault::ALL.iter().copied().enumerate();
    let chosen = all.filter(move |(index, fault)| {
        let apis = [Api::Vulkan, Api::OpenGl, Api::WebGpu].into_iter();
        let apis = Vec::from_iter(apis.filter(|api| fault.is_in(*api)));
        apis.contains(&api) && (sample::all() || apis[index % apis.len()] == api)
    });
    chosen.map(|(_, fault)| fault)
}

/// Every fault turns the run of a driver red, by a case that passes without the fault.
fn faults_are_found(driver: &str, faults: impl Iterator<Item = CallFault> + Clone) {
    let cases: BTreeSet<&str> = faults.clone().map(CallFault::cases).collect();
    let without = failed(driver, cases, 0);
    let expected = without.values().all(|expected| *expected);
    assert!(expected, "{driver} without a fault: {without:?}");
    for fault in faults {
        let (name, cases) = (fault.name(), fault.cases());
        let with = failed(&format!("{driver}:call-fault={name}"), [cases], 1);
        assert!(
            with.keys().any(|case| !without.contains_key(case)),
            "{driver}: no case of {cases} fails with {name} alone"
        );
    }
}

#[test]
fn every_fault_of_vulkan_calls_fails() {
    // lavapipe's multiview is wrong even without a fault.
    let view_first = |fault: &CallFault| *fault == CallFault::ViewFirst;
    let vulkan = faults_in(Api::Vulkan);
    faults_are_found("vulkan:lavapipe", vulkan.clone().filter(|f| !view_first(f)));
    faults_are_found("vulkan:swiftshader", vulkan.filter(view_first));
}

#[test]
fn every_fault_of_opengl_calls_fails() {
    faults_are_found("gl:llvmpipe", faults_in(Api::OpenGl));
}

#[test]
fn every_fault_of_webgpu_lists_fails() {
    let of_lists = faults_in(Api::WebGpu);
    faults_are_found("wgpu:vulkan:lavapipe", of_lists.clone());
    // Each fault starts a browser, whose executor reads the same lists.
    let whole = of_lists.clone().count();
    let few = sample::count("faults in a browser", whole / 4, whole);
    let in_browser = of_lists.step_by(whole / few).take(few);
    faults_are_found("webgpu:chromium", in_browser);
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
