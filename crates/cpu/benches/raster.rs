//! What drawing costs: representative 16 by 16 cases, and a full screen blended sixteen times over.

use criterion::{Criterion, criterion_group, criterion_main};
use etalon_backend::Backend;
use etalon_case::{CaseFile, Library, Profile, Scene};
use etalon_cpu::CpuBackend;

const IDS: [&str; 3] = [
    "depth/compare/compare=less/format=depth24plus/write=true",
    "stencil/operations/depth_fail=invert/fail=replace/pass=increment-wrap",
    "blend/factors/dst=one-minus-src-alpha/operation=add/src=src-alpha",
];

fn overdraw() -> Scene {
    let part = r#"{"operation":"add","src_factor":"src-alpha","dst_factor":"one-minus-src-alpha"}"#;
    let draw = format!(
        r#"{{"mesh":{{"kind":"vertices","positions":[[-1,-1,0],[1,-1,0],[1,1,0],[-1,-1,0],[1,1,0],[-1,1,0]]}},
        "shader":"uniform_color","params":{{"color":[0.2,0.4,0.6,0.25]}},"blend":{{"color":{part},"alpha":{part}}}}}"#
    );
    let text = format!(
        r#"{{"about":"b","spec":["b"],"scene":{{"attachments":{{"color":{{"format":"rgba8unorm","size":[1280,720]}}}},
        "passes":[{{"color":["color"],"draws":[{}]}}],"read":["color"]}}}}"#,
        vec![draw; 16].join(",")
    );
    let file = CaseFile::parse("overdraw.json", &text).expect("the scene parses");
    let case = file.cases(Profile::Full).next().expect("one case").build();
    case.expect("the scene builds").scene
}

fn raster(c: &mut Criterion) {
    let library = Library::built_in().expect("built-in cases parse");
    let backend = CpuBackend::new("cpu");
    let mut bench = |name: &str, scene: &Scene, samples: usize| {
        let mut prepared = backend.prepare(scene).expect("the rasterizer prepares");
        let mut group = c.benchmark_group("submit");
        group.sample_size(samples);
        group.bench_function(name, |b| b.iter(|| prepared.submit()));
        group.finish();
    };
    for id in IDS {
        let reference = library.cases(Profile::Full).find(|case| case.id() == id);
        let reference = reference.unwrap_or_else(|| panic!("there is no case {id}"));
        let case = reference.build().expect("a built-in case builds");
        bench(id.split('=').next().unwrap_or(id), &case.scene, 100);
    }
    bench("1280x720, 16 blended quads", &overdraw(), 10);
}

criterion_group!(benches, raster);
criterion_main!(benches);
