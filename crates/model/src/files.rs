//! The bytes that a file brings or names.

use crate::error::{ModelError, part};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::Document;
use gltf::buffer::Source;
use percent_encoding::percent_decode_str;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The maximum size of a file in bytes.
const MOST_BYTES: u64 = 1 << 30;

/// The bytes of a file's buffers, in their order.
#[derive(Debug)]
pub(crate) struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    /// Reads all buffers. `binary` is the part of a `.glb` that is not JSON, and `folder` holds the file.
    ///
    /// # Errors
    /// If a buffer is missing or too short.
    pub(crate) fn read(
        document: &Document,
        mut binary: Option<Vec<u8>>,
        folder: &Path,
    ) -> Result<Self, ModelError> {
        let buffers = document.buffers().map(|buffer| {
            let place = part("buffer", buffer.index(), None);
            let bytes = match buffer.source() {
                Source::Bin => binary.take().ok_or_else(|| {
                    ModelError::new(
                        &place,
                        "the file has no binary part; export it as .glb again",
                    )
                })?,
                Source::Uri(uri) => named(uri, folder).map_err(|m| ModelError::new(&place, m))?,
            };
            if bytes.len() < buffer.length() {
                let message = format!(
                    "it has {} bytes and should have {}; export the file again",
                    bytes.len(),
                    buffer.length()
                );
                return Err(ModelError::new(place, message));
            }
            Ok(bytes)
        });
        Ok(Self(buffers.collect::<Result<_, _>>()?))
    }

    /// Returns the bytes of a view; `None` if it is longer than its buffer.
    pub(crate) fn view(&self, view: &gltf::buffer::View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.0.get(view.buffer().index())?.get(view.offset()..end)
    }
}

/// Returns the bytes that a URI holds, or those of the file beside the scene that it names.
///
/// # Errors
/// With the reason and a remedy.
pub(crate) fn named(uri: &str, folder: &Path) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let coded = data.split_once(";base64,").map(|(_, coded)| coded);
        let bytes = coded.and_then(|coded| STANDARD.decode(coded).ok());
        return bytes.ok_or_else(|| "its data are no base64; export the file again".to_owned());
    }
    let name = percent_decode_str(uri).decode_utf8_lossy().into_owned();
    let relative = PathBuf::from(&name);
    let is_below = relative
        .components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !is_below {
        return Err(format!(
            "it names `{name}`, and only files beside the scene or in folders there are read; move the file there"
        ));
    }
    bytes_of(&folder.join(relative)).map_err(|reason| format!("`{name}` {reason}"))
}

/// Returns the bytes of a regular file; reading a pipe would block.
///
/// # Errors
/// With the reason and a remedy.
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let unreadable = |e: std::io::Error| format!("cannot be read: {e}");
    let about = fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() {
        return Err("is no regular file; name a .glb or .gltf file".to_owned());
    }
    if about.len() > MOST_BYTES {
        return Err(format!(
            "has {} bytes; at most {MOST_BYTES} are read",
            about.len()
        ));
    }
    fs::read(path).map_err(unreadable)
}
