//! The cost of case files: parsing the built-in files, naming all cases, and building all scenes.

use criterion::{Criterion, criterion_group, criterion_main};
use etalon_case::{Library, Profile};

fn expand(c: &mut Criterion) {
    let library = Library::built_in();
    let count = library.cases(Profile::Full).count();
    let mut group = c.benchmark_group("library");
    group.sample_size(10);
    group.bench_function("parse", |b| b.iter(Library::built_in));
    group.bench_function(format!("ids of {count} cases"), |b| {
        b.iter(|| {
            library
                .cases(Profile::Full)
                .map(|case| case.id().len())
                .sum::<usize>()
        });
    });
    group.bench_function(format!("build {count} cases"), |b| {
        b.iter(|| {
            library
                .cases(Profile::Full)
                .filter(|case| case.build().is_ok())
                .count()
        });
    });
    group.finish();
}

criterion_group!(benches, expand);
criterion_main!(benches);
