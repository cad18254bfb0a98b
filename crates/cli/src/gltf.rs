//! The scene of one's own that `--gltf` names.

use etalon_case::Library;
use etalon_record::ModelFile;
#[cfg(feature = "gltf")]
use std::{path::Path, sync::Arc};

/// The value of `--gltf`: a file that was read, with the cases that draw it.
#[derive(Clone, Debug)]
pub(crate) struct GltfScene {
    /// The cases: every question that the scene can answer, by every method.
    pub(crate) library: Library,
    /// The file, as a run records it.
    pub(crate) file: ModelFile,
}

/// Reads a file.
#[cfg(feature = "gltf")]
pub(crate) fn parse(path: &str) -> Result<GltfScene, String> {
    let path = Path::new(path);
    let read = etalon_model::read(path).map_err(|error| error.to_string())?;
    let name = name(path);
    let library = Library::of_model(&name, Arc::new(read.model)).map_err(|e| e.to_string())?;
    Ok(GltfScene {
        library,
        file: ModelFile {
            name,
            sha256: read.sha256,
        },
    })
}

#[cfg(not(feature = "gltf"))]
pub(crate) fn parse(_: &str) -> Result<GltfScene, String> {
    Err(crate::failure::left_out("gltf"))
}

/// Returns the part of ids that names the scene: the file's name without its ending, with `-` for what ids cannot hold.
#[cfg(feature = "gltf")]
fn name(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let part = |c: char| {
        if c.is_ascii_alphanumeric() || "-_.".contains(c) {
            c
        } else {
            '-'
        }
    };
    stem.chars().map(part).collect()
}

#[cfg(all(test, feature = "gltf"))]
mod tests {
    use super::*;

    #[test]
    fn a_scene_has_the_name_of_its_file() {
        let named = |path: &str| name(Path::new(path));
        assert_eq!(named("scenes/Glass Room (2).glb"), "Glass-Room--2-");
        assert_eq!(named("a.b.gltf"), "a.b");
    }
}
