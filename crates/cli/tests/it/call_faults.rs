//! Drivers that get a call wrong: the fault sits between the backend and the driver, where the suite cannot see it, and
//! the cases of the area that the fault belongs to fail.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_backend::CallFault;
use etalon_record::{Run, Verdict};
use std::collections::BTreeSet;

/// The quick cases that are made for what a fault breaks: all of an area would take minutes for each.
fn cases(fault: CallFault) -> &'static str {
    match fault {
        CallFault::OnlyFirst64
        | CallFault::LastRow
        | CallFault::LastColumn
        | CallFault::SecondTile => "size/spanning/*",
        CallFault::ScissorEdge => "size/tiles/sizes/by=scissor/*",
        CallFault::Draw256 => "size/tiles/draws/*",
        CallFault::Indices65535 => "size/primitives/past-16-bits/*",
        CallFault::Vertices4096 => "size/primitives/points/*",
        CallFault::Lines500 => "size/primitives/{lines,points}/*",
        CallFault::BaseVertex | CallFault::FirstIndex => "size/offsets/indexed/*",
        CallFault::FirstInstance | CallFault::SecondInstance => "size/instances/*",
        CallFault::CompareKept => "sequence/state/depth-compare/*",
        CallFault::DepthWriteKept => "sequence/state/depth-write/*",
        CallFault::CullKept => "sequence/state/cull/*",
        CallFault::StencilReferenceKept => "sequence/state/stencil-*reference/*",
        CallFault::BlendConstantKept => "sequence/state/blend-constant/*",
        CallFault::ViewportKept => "sequence/state/viewport-rect/*",
        CallFault::ScissorKept => "sequence/state/scissor/*",
        CallFault::LaterPassDraw => "sequence/depth-left/*",
        CallFault::AfterReadOnly => "sequence/read-only-between/*",
        CallFault::LoadClears => "sequence/stored-and-loaded/*",
        CallFault::ClearSkipped | CallFault::StencilWithDepth => "sequence/cleared-*/*",
        CallFault::EqualClearSkipped => "sequence/again/*",
        CallFault::ClearRect => "sequence/cleared-{by-command,in-parts}/*",
        CallFault::ResolveFirst => "sequence/resolve-several/*",
        CallFault::LoadColorIgnored => "paths/write-masks/*/start=load-operation",
        CallFault::LoadDepthIgnored => "paths/depth-test/pass=*/start=load-operation/*",
        CallFault::LoadStencilIgnored => "paths/stencil/*/start=load-operation/*",
        CallFault::StoreDropped => "paths/two-passes/*/pass=render-pass/*",
        // OpenGL reads through attachments too, and sees what it drew unless it is copied first.
        CallFault::LayerDropped => "paths/{srgb,integers}/*/target=array-layer",
        CallFault::LevelDropped => "paths/{srgb,blend-float}/*/target=mip-level",
        CallFault::FaceDropped => "paths/{blend-float,integers}/end=copy/*/target=cube-face",
        CallFault::ClipOriginKept => "paths/renderbuffer/clip=toggled/*",
        CallFault::RestartIgnored => "paths/{lines,strip}/*/draws=restart/*",
        CallFault::ResolveSecondDropped | CallFault::ResolveSecondFromFirst => {
            "paths/resolve/pass=dynamic-rendering/*"
        }
        CallFault::StaticForDynamic => "paths/cull/*/state=dynamic/*",
        CallFault::StaticIgnored => "paths/cull/*/state=static/*",
        CallFault::SecondaryFirstDraw => "paths/strip/commands=secondary/*",
        CallFault::ViewportFirst => "paths/viewport/*/viewport=array",
        CallFault::IndexOffset => "paths/strip/*/draws=base-vertex/*",
        CallFault::BlitColumn => "paths/depth-ends/end=blit/*",
        CallFault::QueryFirst | CallFault::QueryEarly => "sequence/queries-*/*",
    }
}

/// Runs cases on an adapter. Returns the names of those that fail.
fn failed<'a>(adapter: &str, cases: impl IntoIterator<Item = &'a str>, code: i32) -> Vec<String> {
    let out = tempfile::tempdir().unwrap();
    // A planted fault is there each time.
    let mut command = etalon(&["run", "--recheck", "off", "--adapter", adapter]);
    command.args(cases).arg("--out").arg(out.path());
    command.assert().code(code);
    let records = Run::read(out.path()).unwrap().records;
    let unexpected = |verdict, known: bool| verdict == Verdict::Fail && !known;
    let all = records.into_iter();
    let failed = all.filter(|r| unexpected(r.verdict, r.expected.is_some()));
    failed.map(|r| r.case).collect()
}

/// Every fault turns the run of a driver red, by a case that the driver passes without it.
fn faults_are_found(driver: &str, faults: impl Iterator<Item = CallFault> + Clone) {
    let all: BTreeSet<&str> = faults.clone().map(cases).collect();
    assert_eq!(failed(driver, all, 0), [""; 0], "{driver} without a fault");
    for fault in faults {
        let cases = cases(fault);
        let name = fault.name();
        assert!(cases.starts_with(fault.area()), "{name}");
        let with = failed(&format!("{driver}:call-fault={name}"), [cases], 1);
        assert!(
            !with.is_empty(),
            "{driver}: no case of {cases} fails with {name}"
        );
    }
}

#[test]
fn every_fault_of_vulkan_calls_fails() {
    let all = CallFault::ALL.iter().copied();
    faults_are_found("vulkan:lavapipe", all.filter(|fault| fault.is_in_vulkan()));
}

#[test]
fn every_fault_of_opengl_calls_fails() {
    let all = CallFault::ALL.iter().copied();
    faults_are_found("gl:llvmpipe", all.filter(|fault| fault.is_in_opengl()));
}

#[test]
fn faults_of_calls_have_names() {
    for name in [
        "gl:llvmpipe:call-fault=none",
        // OpenGL has no load operations.
        "gl:llvmpipe:call-fault=load-clears",
        // Vulkan's clip volume has one origin.
        "vulkan:lavapipe:call-fault=clip-origin-kept",
        // Neither the rasterizer nor WebGPU's backend has a place for a fault.
        "cpu:call-fault=last-row",
        "wgpu:vulkan:lavapipe:call-fault=last-row",
    ] {
        etalon(&["run", "--adapter", name]).assert().code(64);
    }
}
