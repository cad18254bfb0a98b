//! Frames in files: a manifest, and a file for each aspect or sample. `ci/adapters/frames.md` is the page for authors.

use crate::npy::{self, Array};
use etalon_backend::codes::{pack_all, texel_bytes};
use etalon_backend::texels::AspectForm;
use etalon_frame::{Aspect, ChannelEncoding, Frame, Image};
use png::{BitDepth, ColorType, Decoder};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::io::Cursor;

/// The name of the manifest in a frame's folder.
pub const MANIFEST: &str = "frame.json";

/// Returns a file in the manifest's folder. It can refuse a file with more bytes than this number.
pub type ReadFile<'a> = dyn Fn(&str, u64) -> Result<Vec<u8>, String> + 'a;

/// The manifest: what the files of a folder hold.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// The id of the case.
    pub case: String,
    /// The frame of the case's scene, and one for each of its variants.
    pub frames: Vec<FrameFiles>,
}

/// A frame.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrameFiles {
    /// The name of the case's variant; absent for the case's own scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// All aspects of the attachments that the scene reads back.
    pub images: Vec<ImageFiles>,
    /// The values of the scene's counters, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub counters: Vec<u64>,
}

/// The files of an aspect.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImageFiles {
    /// The attachment's name.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// Files below the folder, whose names end in `.npy`, `.png` or `.raw`: one, or one for each sample.
    pub files: Vec<String>,
}

/// Returns the JSON schema of a manifest.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Manifest).into()
}

/// Returns the frame whose files a manifest names.
///
/// # Errors
/// If the files are not those of a scene that reads these aspects and this number of counters.
pub fn frame(
    forms: &[AspectForm],
    counters: usize,
    named: &FrameFiles,
    read: &ReadFile<'_>,
) -> Result<Frame, String> {
    let came = named.counters.len();
    if came != counters {
        return Err(format!(
            "\"counters\" has {came} values, the scene has {counters} counters"
        ));
    }
    let known = |files: &&ImageFiles| {
        let same = |form: &&AspectForm| form.is(&files.attachment, files.aspect);
        forms.iter().filter(same).count() == 1
    };
    if let Some(other) = named.images.iter().find(|files| !known(files)) {
        let (aspect, attachment) = (other.aspect, &other.attachment);
        return Err(format!("the scene does not read {aspect} of {attachment}"));
    }
    let images = forms.iter().map(|form| {
        let of_form = |files: &&ImageFiles| form.is(&files.attachment, files.aspect);
        let mut files = named.images.iter().filter(of_form);
        match (files.next(), files.next()) {
            (Some(files), None) => image(form, &files.files, read),
            (None, _) => Err(format!("{form} is missing")),
            _ => Err(format!("{form} is there twice")),
        }
    });
    Ok(Frame {
        images: images.collect::<Result<_, _>>()?,
        counters: named.counters.clone(),
    })
}

fn image(form: &AspectForm, files: &[String], read: &ReadFile<'_>) -> Result<Image, String> {
    // A compressed picture that is larger than its texels and a header is no picture of them.
    let most = form.all_bytes() as u64 * 2 + (1 << 16);
    let texels = |file: &String, form: &AspectForm| {
        let content = read(file, most)?;
        texels(form, file, content).map_err(|why| format!("{file}: {why}"))
    };
    if let [file] = files {
        return form.image(&texels(file, form)?);
    }
    if files.len() != form.samples as usize {
        return Err(format!(
            "{form} has {} files: name one, or one for each of {} samples",
            files.len(),
            form.samples
        ));
    }
    let single = AspectForm {
        samples: 1,
        ..form.clone()
    };
    let planes = files.iter().map(|file| texels(file, &single));
    let planes = planes.collect::<Result<Vec<_>, _>>()?;
    let size = texel_bytes(form.layout());
    let mut bytes = Vec::with_capacity(form.all_bytes());
    for texel in 0..single.all_samples() {
        for plane in &planes {
            bytes.extend(
                plane
                    .get(texel * size..(texel + 1) * size)
                    .unwrap_or_default(),
            );
        }
    }
    form.image(&bytes)
}

/// Returns the bytes of the texels in a file.
fn texels(form: &AspectForm, name: &str, content: Vec<u8>) -> Result<Vec<u8>, String> {
    match name.rsplit('.').next() {
        Some("raw") => Ok(content),
        Some("npy") => of_array(form, &npy::read(&content)?),
        Some("png") => of_picture(form, &content),
        _ => Err("its name must end in .npy, .png or .raw".to_owned()),
    }
}

/// The items of an aspect in an array.
struct Items {
    /// The letters of NumPy that the type can have, the usual one first.
    letters: &'static str,
    bytes: usize,
    per_texel: usize,
}

impl Items {
    fn of(form: &AspectForm) -> Self {
        let layout = form.layout();
        let width = layout.first().map_or(0, |(_, width)| *width);
        let whole = width.is_multiple_of(8) && layout.iter().all(|(_, other)| *other == width);
        if !whole {
            let bytes = texel_bytes(layout);
            return Self {
                letters: "u",
                bytes,
                per_texel: 1,
            };
        }
        Self {
            letters: match form.channels().first() {
                Some(encoding) if encoding.is_float() => "fu",
                Some(ChannelEncoding::Snorm(_)) => "iu",
                _ => "u",
            },
            bytes: width as usize / 8,
            per_texel: layout.len(),
        }
    }

    /// Returns the type as NumPy writes it.
    fn kind(&self) -> String {
        let order = if self.bytes == 1 { '|' } else { '<' };
        format!("{order}{}{}", &self.letters[..1], self.bytes)
    }

    /// Returns the usual shape of an array.
    fn shape(&self, form: &AspectForm) -> Vec<usize> {
        let [width, height] = form.size.map(|n| n as usize);
        let inner = [form.samples as usize, self.per_texel];
        let inner = inner.into_iter().filter(|n| *n > 1);
        [height, width].into_iter().chain(inner).collect()
    }
}

fn of_array(form: &AspectForm, array: &Array<'_>) -> Result<Vec<u8>, String> {
    let items = Items::of(form);
    let expected = items.shape(form);
    let fits = match array.kind.as_bytes() {
        [b'<' | b'|', letter, size @ ..] => {
            let letter = char::from(*letter);
            items.letters.contains(letter) && *size == *items.bytes.to_string().as_bytes()
        }
        _ => false,
    };
    // Dimensions of length 1 say nothing.
    let told =
        |shape: &[usize]| -> Vec<usize> { shape.iter().copied().filter(|n| *n != 1).collect() };
    if !fits || told(&array.shape) != told(&expected) {
        return Err(format!(
            "it is an array of {} with shape {:?}, but {form} ({}) has {} with shape {expected:?}",
            array.kind,
            array.shape,
            form.format,
            items.kind()
        ));
    }
    Ok(array.items.to_vec())
}

/// Returns the `.npy` file of an aspect's texels.
pub fn array_file(form: &AspectForm, bytes: &[u8]) -> Vec<u8> {
    let items = Items::of(form);
    Array {
        kind: items.kind(),
        shape: items.shape(form),
        items: bytes,
    }
    .file()
}

fn of_picture(form: &AspectForm, content: &[u8]) -> Result<Vec<u8>, String> {
    let damaged = |error: png::DecodingError| format!("it is no PNG, or a damaged one: {error}");
    let mut reader = Decoder::new(Cursor::new(content))
        .read_info()
        .map_err(damaged)?;
    let info = reader.info();
    let (size, came) = ([info.width, info.height], (info.color_type, info.bit_depth));
    let bits = match came.1 {
        BitDepth::Eight => 8,
        BitDepth::Sixteen => 16,
        _ => 0,
    };
    let colors = match form.layout().len() {
        1 => ColorType::Grayscale,
        2 => ColorType::GrayscaleAlpha,
        _ => ColorType::Rgba,
    };
    let same = |(_, width): &(u32, u32)| *width == bits;
    let float = form.channels().iter().any(|encoding| encoding.is_float());
    if float || !form.layout().iter().all(same) && bits != 0 {
        return Err(format!(
            "a PNG of {bits} bits does not hold {} of {}: write .npy",
            form.aspect, form.format
        ));
    }
    if came.0 != colors || bits == 0 {
        return Err(format!(
            "it has {:?} of {:?} bits, but {} needs {colors:?}: save it as such, or as .npy",
            came.0, came.1, form.format
        ));
    }
    if size != form.size || form.samples != 1 {
        let [width, height] = form.size;
        return Err(format!(
            "it has {} by {} texels, but one sample of {} has {width} by {height}",
            size[0], size[1], form.attachment
        ));
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    reader.next_frame(&mut bytes).map_err(damaged)?;
    let size = bits as usize / 8;
    let codes: Vec<u32> = bytes
        .chunks(size)
        .map(|code| {
            code.iter()
                .fold(0, |code, byte| code << 8 | u32::from(*byte))
        })
        .collect();
    Ok(pack_all(form.layout(), &codes))
}
