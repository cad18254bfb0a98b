//! A whole file.

use crate::error::ModelError;
use crate::files::{Buffers, bytes_of};
use crate::nodes::Nodes;
use crate::texture;
use etalon_methods::Model;
use gltf::{Document, Gltf};
use sha2::{Digest, Sha256};
use std::path::Path;

/// A scene that was read.
#[derive(Debug)]
pub struct ReadModel {
    /// The scene.
    pub model: Model,
    /// The SHA-256 of the file in hexadecimal digits, without those of the files that it names.
    pub sha256: String,
}

/// Reads a `.glb` or `.gltf` file, and the files that it names beside it.
///
/// # Errors
/// With the part of the file that is wrong and a remedy.
pub fn read(path: &Path) -> Result<ReadModel, ModelError> {
    let file = path.display().to_string();
    let bytes = bytes_of(path).map_err(|reason| ModelError {
        place: file.clone(),
        message: reason,
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let model = parse(&bytes, folder).map_err(|error| error.within(&file))?;
    Ok(ReadModel {
        model,
        sha256: format!("{:x}", Sha256::digest(&bytes)),
    })
}

/// Returns the document of a file, in which all indices are valid, and the part of a `.glb` that is not JSON.
fn validated(bytes: &[u8]) -> Result<(Document, Option<Vec<u8>>), String> {
    let Gltf { document, blob } =
        Gltf::from_slice_without_validation(bytes).map_err(|e| e.to_string())?;
    let json = document.into_json();
    // The validation of `gltf` 1.4.1 looks for the bounds of positions before it has checked where they are.
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut attributes = primitives.flat_map(|primitive| primitive.attributes.values());
    if attributes.any(|accessor| accessor.value() >= json.accessors.len()) {
        return Err("an attribute names an accessor that is missing".to_owned());
    }
    // Nor does it ask whether an image has data, and in a view a type, before it takes them.
    let has_data = |image: &gltf::json::Image| match image.buffer_view {
        Some(_) => image.mime_type.is_some(),
        None => image.uri.is_some(),
    };
    if let Some(image) = json.images.iter().position(|image| !has_data(image)) {
        return Err(format!("image {image} lacks its data or their type"));
    }
    let document = Document::from_json(json).map_err(|e| e.to_string())?;
    Ok((document, blob))
}

/// Parses the bytes of a file. `folder` holds the files that it names.
pub(crate) fn parse(bytes: &[u8], folder: &Path) -> Result<Model, ModelError> {
    let (document, blob) = validated(bytes).map_err(|reason| {
        let message = format!(
            "it is not valid glTF 2.0, or needs an extension that is not read: {reason}; export it as .glb without compression"
        );
        ModelError::new("the file", message)
    })?;
    let buffers = Buffers::read(&document, blob, folder)?;
    let textures = texture::read(&document, &buffers, folder)?;
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| {
        ModelError::new("the file", "it has no scene; export one with the meshes")
    })?;
    let nodes = Nodes::read(&scene, &buffers, &textures)?;
    let triangles = nodes.triangles();
    if triangles.is_empty() {
        let message = "it has no triangle; export a scene with meshes";
        return Err(ModelError::new("the scene", message));
    }
    Ok(Model::new(&triangles, nodes.camera)?)
}
