//! The catalogue of a run's cases, for its page: a description of each scene, with the rasterizer's picture.

use crate::cases::{build_named, library};
use crate::failure::Failure;
use crate::processors::processors;
use crate::scene_text;
use etalon_backend::Backend;
use etalon_case::{Case, Library};
use etalon_cpu::CpuBackend;
use etalon_frame::Frame;
use etalon_frame::threads::each;
use etalon_record::{AdapterRecord, Header, Run};
use etalon_report::{Catalogue, CatalogueCase, Thumbnails};
use std::collections::{BTreeSet, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// The largest number of texels of a picture.
const TEXELS: u64 = 1 << 20;

/// The rasterizer's pictures of cases. A picture that the run draws is not drawn again for the page.
#[derive(Default)]
pub(crate) struct CataloguePictures {
    thumbnails: Thumbnails,
    /// `data:` URLs by the case's id.
    taken: Mutex<HashMap<String, String>>,
}

impl CataloguePictures {
    /// Takes the picture if the rasterizer drew it, without a planted fault.
    pub(crate) fn take(&self, adapter: &AdapterRecord, case: &Case, frame: &Frame) {
        // A file of adapters may give the name to any driver.
        let is_reference = adapter.info.name == "cpu" && adapter.info.backend == "cpu";
        if is_reference && !is_large(case) {
            let uri = self.uri(frame);
            let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
            taken.insert(case.id.clone(), uri);
        }
    }

    /// Returns the picture of a case; empty if it is large or cannot be drawn.
    fn of(&self, case: &Case) -> String {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let picture = taken.remove(&case.id);
        drop(taken);
        let case = Some(case).filter(|case| !is_large(case));
        let draw = || case.and_then(drawn).map(|frame| self.uri(&frame));
        picture.or_else(draw).unwrap_or_default()
    }

    fn uri(&self, frame: &Frame) -> String {
        let image = frame.images.first();
        image.map_or_else(String::new, |image| self.thumbnails.uri(image))
    }
}

/// Returns true if a run draws built-in cases: the case files of a `--cases` folder need not be there any more.
pub(crate) fn draws_built_in(header: &Header) -> bool {
    let names_folder = |word: &String| word == "--cases" || word.starts_with("--cases=");
    !header.provenance.command.iter().any(names_folder)
}

/// Returns the catalogue of a recorded run's cases, from the built-in case files or those of a folder.
///
/// # Errors
/// If the case files cannot be read.
pub(crate) fn catalogue_of(run: &Run, cases: Option<&PathBuf>) -> Result<Catalogue, Failure> {
    let library = library(cases)?;
    let drawn: BTreeSet<&str> = run.records.iter().map(|r| r.case.as_str()).collect();
    let cases = build_named(&library, &drawn)?;
    Ok(catalogue(&library, &cases, &CataloguePictures::default()))
}

/// Returns the catalogue of cases. Cases that are not in the library have no template.
pub(crate) fn catalogue(
    library: &Library,
    cases: &[Case],
    pictures: &CataloguePictures,
) -> Catalogue {
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
    catalogue.cases = each(processors(), cases, |case| entry(case, &files, pictures));
    for case in cases {
        for draw in case.scene.passes.iter().flat_map(|p| &p.draws) {
            catalogue
                .shaders
                .insert(draw.shader.name(), draw.shader.wgsl());
        }
    }
    catalogue
}

fn entry(
    case: &Case,
    files: &HashMap<String, String>,
    pictures: &CataloguePictures,
) -> CatalogueCase {
    let draws = case.scene.passes.iter().flat_map(|p| &p.draws);
    let shaders: BTreeSet<&'static str> = draws.map(|draw| draw.shader.name()).collect();
    CatalogueCase {
        id: case.id.clone(),
        file: files.get(&case.id).cloned().unwrap_or_default(),
        lines: scene_text::lines(&case.scene),
        shaders: shaders.into_iter().collect(),
        picture: pictures.of(case),
    }
}

/// Returns true if a case has too many texels for a picture.
fn is_large(case: &Case) -> bool {
    let texels = |a: &etalon_scene::Attachment| u64::from(a.size[0]) * u64::from(a.size[1]);
    case.scene.attachments.iter().any(|a| texels(a) > TEXELS)
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

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_case::Profile;
    use etalon_frame::AdapterInfo;

    fn adapter(name: &str, backend: &str) -> AdapterRecord {
        AdapterRecord {
            info: AdapterInfo {
                name: name.to_owned(),
                backend: backend.to_owned(),
                software: true,
                ..AdapterInfo::default()
            },
            release: None,
            limits: CpuBackend::new("cpu").limits().clone(),
        }
    }

    #[test]
    fn only_the_faultless_rasterizer_gives_the_picture_of_a_case() {
        let library = Library::built_in();
        let mut cases = library.cases(Profile::Quick);
        let case = cases.find(|case| case.id().starts_with("depth/"));
        let case = case.unwrap().build().unwrap();
        let expected = CataloguePictures::default().of(&case);
        let mut wrong = drawn(&case).unwrap();
        wrong.images[0].codes.fill(0);
        for (name, backend) in [
            ("gl:softpipe", "gl"),
            ("cpu", "gl"),
            ("cpu:fault=color", "cpu"),
        ] {
            let pictures = CataloguePictures::default();
            pictures.take(&adapter(name, backend), &case, &wrong);
            assert_eq!(pictures.of(&case), expected, "{name} {backend}");
        }
        let pictures = CataloguePictures::default();
        pictures.take(&adapter("cpu", "cpu"), &case, &wrong);
        // Proves that a frame that is taken is not drawn again.
        assert_ne!(pictures.of(&case), expected);
    }
}
