//! The catalogue of a run's cases, for its page: a description of each scene, with the rasterizer's picture.

use crate::processors::processors;
use crate::scene_text;
use etalon_backend::Backend;
use etalon_case::{Case, Library};
use etalon_cpu::CpuBackend;
use etalon_frame::Frame;
use etalon_frame::threads::each;
use etalon_report::{Catalogue, CatalogueCase, Thumbnails};
use std::collections::{BTreeSet, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The largest number of texels of a picture that is drawn.
const TEXELS: u64 = 1 << 20;

/// Returns the catalogue of cases. Cases that are not in the library have no template.
pub(crate) fn catalogue(library: &Library, cases: &[Case]) -> Catalogue {
    let mut catalogue = Catalogue::default();
    let ids: BTreeSet<&str> = cases.iter().map(|case| case.id.as_str()).collect();
    let mut files: HashMap<String, String> = HashMap::new();
    for (id, case) in library.named(&ids) {
        let stem = case.file().stem();
        if !catalogue.files.contains_key(stem) {
            let template = case.file().template();
            catalogue.files.insert(stem.to_owned(), template);
        }
        files.insert(id, stem.to_owned());
    }
    // Cases with large pictures are neighbours, so each thread takes one case at a time instead of a range.
    let thumbnails = Thumbnails::default();
    catalogue.cases = each(processors(), cases, |case| entry(case, &files, &thumbnails));
    for case in cases {
        for draw in case.scene.passes.iter().flat_map(|p| &p.draws) {
            catalogue
                .shaders
                .insert(draw.shader.name(), draw.shader.wgsl());
        }
    }
    catalogue
}

fn entry(case: &Case, files: &HashMap<String, String>, thumbnails: &Thumbnails) -> CatalogueCase {
    let picture = |frame: Frame| Some(thumbnails.uri(frame.images.first()?));
    let draws = case.scene.passes.iter().flat_map(|p| &p.draws);
    let shaders: BTreeSet<&'static str> = draws.map(|draw| draw.shader.name()).collect();
    CatalogueCase {
        id: case.id.clone(),
        file: files.get(&case.id).cloned().unwrap_or_default(),
        lines: scene_text::lines(&case.scene),
        shaders: shaders.into_iter().collect(),
        picture: reference(case).and_then(picture).unwrap_or_default(),
    }
}

/// Returns the rasterizer's picture; `None` if it is large or cannot be drawn.
fn reference(case: &Case) -> Option<Frame> {
    let texels = |a: &etalon_scene::Attachment| u64::from(a.size[0]) * u64::from(a.size[1]);
    let large = case.scene.attachments.iter().any(|a| texels(a) > TEXELS);
    if large { None } else { drawn(case) }
}

/// Returns the rasterizer's picture; `None` if it cannot be drawn.
pub(crate) fn drawn(case: &Case) -> Option<Frame> {
    let draw = || {
        let backend = CpuBackend::new("cpu");
        let mut prepared = backend.prepare(&case.scene).ok()?;
        prepared.submit().ok()?;
        prepared.read_back().ok()
    };
    // A panic while drawing a picture must not lose the run.
    catch_unwind(AssertUnwindSafe(draw)).ok().flatten()
}
