//! The scenes, shaders and reference pictures of a run's cases, in one script per area next to the page.
//!
//! A browser lets a page from the file system read its neighbours only by running them as scripts. Each file
//! is therefore a call of one function with one value. The page's policy allows its own script to load these
//! files and forbids all other loading.

use crate::error::ReportError;
use crate::files::Destination;
use crate::lists::Interner;
use crate::picture::enlarged;
use etalon_frame::CaseId;
use etalon_frame::Frame;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// The folder of the scripts in a run folder.
pub(crate) const CATALOGUE: &str = "cases";
/// The maximum number of bytes of one area's pictures. Pictures beyond this limit are left out.
const PICTURE_BYTES: usize = 1_000_000;

/// A case, with its scene, shaders and reference picture.
#[derive(Clone, Debug)]
pub struct CatalogueCase {
    /// The id, `axis=value` parts included.
    pub id: String,
    /// The path of its file below the folder of cases, without `.json`.
    pub file: String,
    /// The scene in words, line by line.
    pub lines: Vec<String>,
    /// The names of the shaders of its draws, each once; keys of [`Catalogue::shaders`].
    pub shaders: Vec<&'static str>,
    /// The reference picture as a `data:` URL; empty if the case has no picture.
    pub picture: String,
}

/// The cases to write.
#[derive(Debug, Default)]
pub struct Catalogue {
    /// The text that the cases of a file share, by its path without `.json`.
    pub files: BTreeMap<String, Value>,
    /// WGSL by the shader's name.
    pub shaders: BTreeMap<&'static str, &'static str>,
    /// The cases; each area of them has a script of its own.
    pub cases: Vec<CatalogueCase>,
}

/// The file of one area. Each text, picture and list is in it once; the cases refer to them by index.
#[derive(Serialize, Default)]
struct CatalogueArea<'a> {
    files: BTreeMap<&'a str, &'a Value>,
    shaders: BTreeMap<&'a str, &'a str>,
    lines: Interner<&'a str>,
    pictures: Interner<&'a str>,
    /// Lists of lines.
    scenes: Interner<Vec<usize>>,
    /// Lists of shaders.
    used: Interner<&'a [&'static str]>,
    /// The indices of the scene, the picture (-1 for none) and the list of shaders, by file and then by the
    /// rest of the id.
    cases: BTreeMap<&'a str, BTreeMap<&'a str, (usize, i64, usize)>>,
}

/// Returns a picture of a frame's first image as a PNG file, enlarged.
pub fn reference_png(frame: &Frame) -> Option<Vec<u8>> {
    frame.images.first().and_then(enlarged)
}

/// Writes `cases/<area>.js` for each area. Returns area and path of each.
///
/// # Errors
/// Returns an error if a script cannot be written.
pub(crate) fn write_scripts(
    to: &dyn Destination,
    catalogue: &Catalogue,
) -> Result<Vec<(String, String)>, ReportError> {
    let mut areas: BTreeMap<&str, Vec<&CatalogueCase>> = BTreeMap::new();
    for case in &catalogue.cases {
        areas
            .entry(CaseId::new(&case.id).area())
            .or_default()
            .push(case);
    }
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    areas.retain(|name, _| !name.is_empty() && name.chars().all(plain));
    let write = |(name, cases): (&str, Vec<&CatalogueCase>)| {
        let json =
            serde_json::to_string(&area(catalogue, &cases)).unwrap_or_else(|_| "null".to_owned());
        let path = format!("{CATALOGUE}/{name}.js");
        to.write(&path, format!("etalonArea({name:?}, {json});\n").as_bytes())?;
        Ok((name.to_owned(), path))
    };
    areas.into_iter().map(write).collect()
}

fn area<'a>(catalogue: &'a Catalogue, cases: &[&'a CatalogueCase]) -> CatalogueArea<'a> {
    let mut area = CatalogueArea::default();
    let mut bytes = 0;
    for case in cases {
        let scene = case.lines.iter().map(|line| area.lines.place(line));
        let scene = scene.collect();
        let picture = &*case.picture;
        let new = if area.pictures.has(&picture) {
            0
        } else {
            picture.len()
        };
        let picture = if picture.is_empty() || bytes + new > PICTURE_BYTES {
            -1
        } else {
            bytes += new;
            area.pictures.place(picture) as i64
        };
        for name in &case.shaders {
            let text = catalogue.shaders.get(name).copied();
            area.shaders.insert(name, text.unwrap_or_default());
        }
        if let Some((name, text)) = catalogue.files.get_key_value(&case.file) {
            area.files.insert(name, text);
        }
        let variant = case.id.strip_prefix(&case.file).unwrap_or(&case.id);
        let place = (
            area.scenes.place(scene),
            picture,
            area.used.place(&case.shaders),
        );
        let file = area.cases.entry(&case.file).or_default();
        file.insert(variant, place);
    }
    area
}
