//! Drivers that get a call wrong: the fault sits between the backend and the driver, where the suite cannot see it, and
//! the cases of the area that the fault belongs to fail.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_backend::CallFault;
use etalon_record::{Run, Verdict};
use std::collections::BTreeSet;

const AREAS: [&str; 2] = ["size", "sequence"];

/// The names of the driver and of what fails with each fault, after a run of the quick cases of both areas over all of
/// them: the cases are judged once.
fn run(adapters: &[String], out: &std::path::Path) -> Run {
    let mut command = etalon(&["run", "size/*", "sequence/*"]);
    for adapter in adapters {
        command.args(["--adapter", adapter]);
    }
    command.arg("--out").arg(out).assert().code(1);
    Run::read(out).unwrap()
}

/// Every fault turns the run of a driver red, by a case of its area that the driver passes without it.
fn faults_are_found(driver: &str, faults: &[CallFault]) {
    let named = |fault: &CallFault| format!("{driver}:call-fault={}", fault.name());
    let mut adapters = vec![driver.to_owned()];
    adapters.extend(faults.iter().map(named));
    let out = tempfile::tempdir().unwrap();
    let run = run(&adapters, out.path());
    let failed = |adapter: &str| -> BTreeSet<&str> {
        let own = run.records.iter().filter(|r| r.adapter == adapter);
        let failed = own.filter(|r| r.verdict == Verdict::Fail && r.expected.is_none());
        failed.map(|r| r.case.as_str()).collect()
    };
    let without = failed(driver);
    let mut unseen = Vec::new();
    for fault in faults {
        let area = format!("{}/", fault.area());
        let with = failed(&named(fault));
        let mut seen = with.difference(&without).filter(|c| c.starts_with(&area));
        match seen.next() {
            None => unseen.push(fault.name()),
            // Alone as well, the case makes the run red.
            Some(case) => {
                let again = tempfile::tempdir().unwrap();
                let mut command = etalon(&["run", case, "--adapter", &named(fault), "--out"]);
                command.arg(again.path()).assert().code(1);
            }
        }
    }
    assert!(
        unseen.is_empty(),
        "{driver}: no case of {AREAS:?} fails with {unseen:?}"
    );
}

#[test]
fn every_fault_of_vulkan_calls_fails() {
    faults_are_found("vulkan:lavapipe", CallFault::ALL);
}

#[test]
fn every_fault_of_opengl_calls_fails() {
    let all = CallFault::ALL.iter().copied();
    let faults: Vec<_> = all.filter(|fault| !fault.is_vulkan_only()).collect();
    faults_are_found("gl:llvmpipe", &faults);
}

#[test]
fn faults_of_calls_have_names() {
    for name in [
        "gl:llvmpipe:call-fault=none",
        // OpenGL has no load operations, the rasterizer and WebGPU's backend have no place for a fault.
        "gl:llvmpipe:call-fault=load-clears",
        "cpu:call-fault=last-row",
        "wgpu:vulkan:lavapipe:call-fault=last-row",
    ] {
        etalon(&["run", "--adapter", name]).assert().code(64);
    }
}
