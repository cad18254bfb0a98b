//! The cost of judging single cases of 16 by 16 texels, a sample of all such cases, and growing pictures and
//! meshes. Measures both legal sets, and the comparison of a frame with them.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use etalon_backend::Backend;
use etalon_case::{Case, CaseFile, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Api, compare};
use etalon_reference::judgements;
use etalon_scene::Scene;
use std::hint::black_box;

const IDS: [&str; 3] = [
    "depth/compare/compare=less/format=depth24plus/write=true",
    "stencil/operations/depth_fail=invert/fail=replace/pass=increment-wrap",
    "blend/factors/dst=one-minus-src-alpha/operation=add/src=src-alpha",
];

/// The step between the cases of 16 by 16 texels that are judged together.
const STEP: usize = 41;

fn case(library: &Library, id: &str) -> Case {
    let reference = library.cases(Profile::Full).find(|case| case.id() == id);
    let reference = reference.unwrap_or_else(|| panic!("there is no case {id}"));
    reference.build().expect("a built-in case builds")
}

fn judge(c: &mut Criterion) {
    let library = Library::built_in();
    let backend = CpuBackend::new("cpu");
    for id in IDS {
        let scene = case(library, id).scene;
        let mut group = c.benchmark_group(id.split('=').next().unwrap_or(id));
        for api in [Api::Vulkan, Api::WebGpu] {
            let mut limits = backend.limits().clone();
            limits.api = api;
            group.bench_function(format!("judgements/{api}"), |b| {
                b.iter(|| judgements(black_box(&scene), &limits));
            });
        }
        let mut prepared = backend.prepare(&scene).expect("the rasterizer prepares");
        prepared.submit().expect("the rasterizer draws");
        let frame = prepared.read_back().expect("the rasterizer reads back");
        let judgement = judgements(&scene, backend.limits()).remove(0);
        let compare = || compare(&frame, &judgement.legal, &judgement.yardstick, 64);
        let found = compare().expect("the frame is the scene's");
        assert_eq!(found.texels.wrong, 0, "a wrong frame has no time");
        group.bench_function("compare", |b| b.iter(compare));
        group.finish();
    }
}

/// Returns the scenes of cases whose attachments have at most 16 by 16 texels.
fn small(library: &Library) -> Vec<Scene> {
    let cases = library.cases(Profile::Full);
    let built = cases
        .step_by(STEP)
        .map(|case| case.build().expect("built-in cases build"));
    let correct = built.filter(|case| !case.measured);
    let small = |scene: &Scene| {
        scene
            .attachments
            .iter()
            .all(|a| a.size[0].max(a.size[1]) <= 16)
    };
    correct.map(|case| case.scene).filter(small).collect()
}

fn all_cases(c: &mut Criterion) {
    let library = Library::built_in();
    let limits = CpuBackend::new("cpu").limits().clone();
    let scenes = small(library);
    let mut group = c.benchmark_group("cases of 16 by 16 texels");
    group.throughput(Throughput::Elements(scenes.len() as u64));
    group.bench_function("judgements", |b| {
        b.iter(|| {
            for scene in &scenes {
                black_box(judgements(scene, &limits));
            }
        });
    });
    group.finish();
}

fn scene(text: &str) -> Scene {
    let file = CaseFile::parse("bench.json", text).expect("the case parses");
    let case = file.cases(Profile::Full).next().expect("one case");
    case.build().expect("the case builds").scene
}

fn growing(c: &mut Criterion) {
    let limits = CpuBackend::new("cpu").limits().clone();
    let mut group = c.benchmark_group("constant cells");
    group.sample_size(10);
    for [width, height] in [[64_u32, 64], [480, 270], [1920, 1080]] {
        let scene = scene(&format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
                "attachments":{{"color":{{"format":"rgba8unorm","size":[{width},{height}]}}}},
                "passes":[{{"color":["color"],"draws":[
                    {{"mesh":{{"kind":"columns","values":[0,0.25,0.5,0.75,1]}},"shader":"flat_color"}}]}}],
                "read":["color"]}}}}"#
        ));
        group.throughput(Throughput::Elements(u64::from(width * height)));
        group.bench_function(
            BenchmarkId::from_parameter(format!("{width}x{height}")),
            |b| {
                b.iter(|| judgements(&scene, &limits));
            },
        );
    }
    group.finish();
    let mut group = c.benchmark_group("triangles");
    group.sample_size(10);
    for cells in [50, 150, 500] {
        let scene = scene(&format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
                "attachments":{{"color":{{"format":"rgba8unorm","size":[500,500]}}}},
                "passes":[{{"color":["color"],"draws":[
                    {{"mesh":{{"kind":"grid","cells":[{cells},{cells}],"value":0.5}},"shader":"flat_color"}}]}}],
                "read":["color"]}}}}"#
        ));
        let triangles = 2 * cells * cells;
        group.throughput(Throughput::Elements(triangles));
        group.bench_function(BenchmarkId::from_parameter(triangles), |b| {
            b.iter(|| judgements(&scene, &limits));
        });
    }
    group.finish();
}

criterion_group!(benches, judge, all_cases, growing);
criterion_main!(benches);
