//! Folders of frames that somebody else drew.

use crate::cases::find;
use crate::failure::Failure;
use etalon_backend::texels::AspectForm;
use etalon_case::{Case, Library};
use etalon_external::files::{self, FrameFiles, MANIFEST, Manifest};
use etalon_frame::Frame;
use etalon_record::open_below;
use etalon_scene::Scene;
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The largest manifest in bytes.
const MOST_MANIFEST: u64 = 1 << 20;
/// The number of folders inside each other in which manifests are searched.
const DEEPEST: usize = 40;

/// A manifest, and its path below the folder.
pub(crate) struct FoundManifest {
    path: PathBuf,
    pub(crate) manifest: Manifest,
}

/// Returns the manifests in a folder and the folders below, by case.
pub(crate) fn manifests(folder: &Path) -> Result<BTreeMap<String, FoundManifest>, Failure> {
    let mut paths = Vec::new();
    search(folder, Path::new(""), DEEPEST, &mut paths)?;
    let mut found: BTreeMap<String, FoundManifest> = BTreeMap::new();
    for path in paths {
        let wrong = |why: String| {
            let path = folder.join(&path);
            Failure::usage(format!("{}: {why}", path.display()))
        };
        let text = read(folder, &path, MOST_MANIFEST).map_err(Failure::usage)?;
        let manifest: Manifest =
            serde_json::from_slice(&text).map_err(|error| wrong(error.to_string()))?;
        if let Some(other) = found.get(&manifest.case) {
            let other = folder.join(&other.path);
            let case = &manifest.case;
            return Err(wrong(format!("{case} is also in {}", other.display())));
        }
        let id = manifest.case.clone();
        found.insert(id, FoundManifest { path, manifest });
    }
    Ok(found)
}

/// Adds the paths of manifests, without following links.
fn search(
    top: &Path,
    below: &Path,
    deepest: usize,
    paths: &mut Vec<PathBuf>,
) -> Result<(), Failure> {
    let folder = top.join(below);
    let fail = |error| Failure::of_file("read", &folder, &error);
    for entry in fs::read_dir(&folder).map_err(fail)? {
        let entry = entry.map_err(fail)?;
        let kind = entry.file_type().map_err(fail)?;
        let path = below.join(entry.file_name());
        if kind.is_dir() && deepest > 0 {
            search(top, &path, deepest - 1, paths)?;
        } else if kind.is_file() && entry.file_name() == MANIFEST {
            paths.push(path);
        }
    }
    Ok(())
}

/// Reads a file below a folder.
fn read(folder: &Path, path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let shown = folder.join(path);
    let name = path.to_str().ok_or("its path is not UTF-8")?;
    let file = open_below(folder, name).map_err(|error| error.to_string())?;
    let mut content = Vec::new();
    file.take(most + 1)
        .read_to_end(&mut content)
        .map_err(|error| format!("cannot read {}: {error}", shown.display()))?;
    if content.len() as u64 > most {
        return Err(format!("{} has more than {most} bytes", shown.display()));
    }
    Ok(content)
}

impl FoundManifest {
    /// Returns the case.
    pub(crate) fn case(&self, library: &Library, folder: &Path) -> Result<Case, Failure> {
        let case = find(library, &self.manifest.case).and_then(|case| {
            let built = case.build();
            built.map_err(Failure::usage)
        });
        case.map_err(|why| self.wrong(folder, &why.message))
    }

    /// Returns the frames of a case's scenes, in their order.
    pub(crate) fn frames(&self, folder: &Path, case: &Case) -> Result<Vec<Frame>, Failure> {
        let names = std::iter::once(None).chain(case.variants.iter().map(|v| Some(&v.name)));
        let named = &self.manifest.frames;
        let known = |frame: &&FrameFiles| names.clone().any(|name| name == frame.variant.as_ref());
        if let Some(name) = named
            .iter()
            .find(|f| !known(f))
            .and_then(|f| f.variant.as_ref())
        {
            return Err(self.wrong(folder, &format!("the case has no variant `{name}`")));
        }
        let frames = names.clone().zip(case.scenes()).map(|(name, scene)| {
            let mut frames = named.iter().filter(|f| f.variant.as_ref() == name);
            let frame = match (frames.next(), frames.next()) {
                (Some(frame), None) => self.frame(folder, scene, frame),
                (None, _) => Err("it is missing".to_owned()),
                _ => Err("it is there twice".to_owned()),
            };
            frame.map_err(|why| match name {
                None => self.wrong(folder, &format!("the frame of the case's scene: {why}")),
                Some(name) => self.wrong(folder, &format!("the frame of variant `{name}`: {why}")),
            })
        });
        frames.collect()
    }

    fn frame(&self, folder: &Path, scene: &Scene, named: &FrameFiles) -> Result<Frame, String> {
        let beside = |name: &str, most: u64| read(folder, &self.path.with_file_name(name), most);
        let forms = AspectForm::of_scene(scene);
        files::frame(&forms, scene.counters.len(), named, &beside)
    }

    fn wrong(&self, folder: &Path, why: &str) -> Failure {
        let path = folder.join(&self.path);
        Failure::usage(format!("{}: {why}", path.display()))
    }
}
