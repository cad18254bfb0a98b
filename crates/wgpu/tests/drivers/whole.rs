//! Every quick case, and what validation says of all that is drawn here.

use crate::scenes::{
    depth_formats_store_what_is_written, passes_keep_contents, stencil_without_depth,
    uploads_keep_their_orientation,
};
use crate::{capabilities, counting, samples, sampling};
use etalon_backend::Backend;
use etalon_case::{Library, Profile};
use etalon_wgpu::WgpuBackend;

fn run_all(backend: &WgpuBackend) {
    let library = Library::built_in().expect("the built-in cases parse");
    let mut ran = 0;
    for case in library.cases(Profile::Quick) {
        let case = case.build().expect("a built-in case builds");
        let requirements = case.scene.requirements();
        if backend.limits().missing(&requirements).is_some() {
            continue;
        }
        let result = backend.prepare(&case.scene).and_then(|mut prepared| {
            prepared.submit()?;
            prepared.read_back()
        });
        let frame = result.unwrap_or_else(|error| panic!("{}: {error}", case.id));
        let aspects = |i: &usize| case.scene.attachments[*i].format.aspects().len();
        let due: usize = case.scene.read.iter().map(aspects).sum();
        assert_eq!(frame.images.len(), due, "{}", case.id);
        let counters = case.scene.counters.len();
        assert_eq!(frame.counters.len(), counters, "{}", case.id);
        ran += 1;
    }
    assert!(ran > 0, "no case ran");
}

pub(crate) fn every_built_in_case_runs(backend: &WgpuBackend) {
    run_all(backend);
    assert!(backend.messages().is_empty(), "nobody asked for messages");
}

pub(crate) fn validation_is_clean(backend: &WgpuBackend) {
    run_all(backend);
    passes_keep_contents(backend);
    uploads_keep_their_orientation(backend);
    depth_formats_store_what_is_written(backend);
    stencil_without_depth(backend);
    capabilities::all(backend);
    samples::all(backend);
    counting::all(backend);
    sampling::all(backend);
    let messages = backend.messages();
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}
