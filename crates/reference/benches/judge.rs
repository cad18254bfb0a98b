//! The cost of judging one case of 16 by 16 texels: both legal sets, and a frame compared with them.

use criterion::{Criterion, criterion_group, criterion_main};
use etalon_backend::Backend;
use etalon_case::{Case, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Api, compare};
use etalon_reference::judgements;
use std::hint::black_box;

const IDS: [&str; 3] = [
    "depth/compare/compare=less/format=depth24plus/write=true",
    "stencil/operations/depth_fail=invert/fail=replace/pass=increment-wrap",
    "blend/factors/dst=one-minus-src-alpha/operation=add/src=src-alpha",
];

fn case(library: &Library, id: &str) -> Case {
    let reference = library.cases(Profile::Full).find(|case| case.id() == id);
    let reference = reference.unwrap_or_else(|| panic!("there is no case {id}"));
    reference.build().expect("a built-in case builds")
}

fn judge(c: &mut Criterion) {
    let library = Library::built_in().expect("built-in cases parse");
    let backend = CpuBackend::new("cpu");
    for id in IDS {
        let scene = case(&library, id).scene;
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

criterion_group!(benches, judge);
criterion_main!(benches);
