//! Frame times of three 16×16 cases, five cases of `perf`, sixteen blended full-screen quads, and a million
//! small triangles: dispatch, fill rate and setup. Two memory benchmarks give the limit that memory sets.

use criterion::{Criterion, criterion_group, criterion_main};
use etalon_backend::Backend;
use etalon_case::{CaseFile, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_scene::Scene;
use std::hint::black_box;

/// Cases of 16 by 16 texels.
const SMALL: [&str; 3] = [
    "depth/compare/compare=less/format=depth24plus/write=true",
    "stencil/operations/depth_fail=invert/fail=replace/pass=increment-wrap",
    "blend/factors/dst=one-minus-src-alpha/operation=add/src=src-alpha",
];

/// Large cases, which are drawn in tiles.
const LARGE: [&str; 5] = [
    "perf/triangles-100k/size=1280x720",
    "perf/multisample-triangles-100k/size=1280x720",
    "perf/culling/cull=back/size=1280x720",
    "perf/state-changes/size=1280x720",
    "perf/blended-layers/size=1280x720",
];

fn scene_of(text: &str) -> Scene {
    let file = CaseFile::parse("bench.json", text).expect("the scene parses");
    let case = file.cases(Profile::Full).next().expect("one case").build();
    case.expect("the scene builds").scene
}

/// Returns a million triangles with a depth test, one per cell of 2 by 1 texels; each reaches 2.5 by 1.5 texels. They cover 1280 by 720 texels twice.
fn small_triangles() -> Scene {
    let mut scene = scene_of(
        r#"{"about":"b","spec":["b"],"scene":{"attachments":{"color":{"format":"rgba8unorm","size":[1280,720]},
        "depth":{"format":"depth32float","clear":1}},
        "passes":[{"color":["color"],"depth_stencil":"depth","draws":[{"mesh":{"kind":"cover"},"shader":"flat_color",
        "depth":{"compare":"less-equal","write":true}}]}],"read":["color"]}}"#,
    );
    let mesh = &mut scene.passes[0].draws[0].mesh;
    let first = mesh.vertices[0];
    mesh.indices = None;
    mesh.vertices = (0..1_000_000_u32)
        .flat_map(|i| {
            let (x, y) = ((i % 640) as f32 * 2.0, (i / 640 % 720) as f32);
            let corner = |dx: f32, dy: f32| {
                let mut vertex = first;
                let clip = |v: f32, size: f32| v / size * 2.0 - 1.0;
                vertex.position = [clip(x + dx, 1280.0), -clip(y + dy, 720.0), 0.5, 1.0];
                vertex
            };
            [corner(0.0, 0.0), corner(0.0, 1.5), corner(2.5, 0.0)]
        })
        .collect();
    scene
}

fn overdraw([width, height]: [u32; 2]) -> Scene {
    let part = r#"{"operation":"add","src_factor":"src-alpha","dst_factor":"one-minus-src-alpha"}"#;
    let draw = format!(
        r#"{{"mesh":{{"kind":"vertices","positions":[[-1,-1,0],[1,-1,0],[1,1,0],[-1,-1,0],[1,1,0],[-1,1,0]]}},
        "shader":"uniform_color","params":{{"color":[0.2,0.4,0.6,0.25]}},"blend":{{"color":{part},"alpha":{part}}}}}"#
    );
    scene_of(&format!(
        r#"{{"about":"b","spec":["b"],"scene":{{"attachments":{{"color":{{"format":"rgba8unorm","size":[{width},{height}]}}}},
        "passes":[{{"color":["color"],"draws":[{}]}}],"read":["color"]}}}}"#,
        vec![draw; 16].join(",")
    ))
}

fn raster(c: &mut Criterion) {
    let library = Library::built_in();
    let backend = CpuBackend::new("cpu");
    let mut bench = |name: &str, scene: &Scene, samples: usize| {
        let mut prepared = backend.prepare(scene).expect("the rasterizer prepares");
        let mut group = c.benchmark_group("submit");
        group.sample_size(samples);
        group.bench_function(name, |b| b.iter(|| prepared.submit()));
        group.finish();
    };
    let case = |id: &str| {
        let case = library.cases(Profile::Full).find(|case| case.id() == id);
        let case = case.unwrap_or_else(|| panic!("there is no case {id}"));
        case.build().expect("a scene_of-in case builds")
    };
    for id in SMALL {
        bench(id.split('=').next().unwrap_or(id), &case(id).scene, 100);
    }
    for id in LARGE {
        bench(id, &case(id).scene, 20);
    }
    bench("128x128, 16 blended quads", &overdraw([128, 128]), 50);
    bench("1280x720, 16 blended quads", &overdraw([1280, 720]), 10);
    bench("1280x720, 1000000 small triangles", &small_triangles(), 10);
}

/// Benchmarks setting and copying 1280 by 720 texels of four bytes on one thread, the limit that memory sets.
fn memory(c: &mut Criterion) {
    let (from, mut to) = (vec![1_u32; 1280 * 720], vec![0_u32; 1280 * 720]);
    let mut group = c.benchmark_group("memory");
    group.bench_function("set 1280x720", |b| {
        b.iter(|| black_box(&mut to).fill(black_box(7)))
    });
    group.bench_function("copy 1280x720", |b| {
        b.iter(|| black_box(&mut to).copy_from_slice(black_box(&from)));
    });
    group.finish();
}

criterion_group!(benches, raster, memory);
criterion_main!(benches);
