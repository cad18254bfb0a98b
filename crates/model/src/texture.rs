//! Textures: their means over triangles.

use crate::color::linear;
use crate::error::{ModelError, part};
use crate::files::{Buffers, named};
use gltf::Document;
use gltf::image::Source;
use gltf::texture::WrappingMode;
use image::{ImageReader, Limits};
use std::collections::BTreeSet;
use std::io::Cursor;
use std::path::Path;

/// The largest side of an image in texels.
const LONGEST: u32 = 8192;

/// A texture with linear colours, halved until one texel is left.
#[derive(Debug)]
pub(crate) struct Texture {
    /// The largest level first.
    levels: Vec<Level>,
    wrap: [WrappingMode; 2],
}

#[derive(Debug)]
struct Level {
    size: [u32; 2],
    texels: Vec<[f32; 4]>,
}

/// Reads the textures of base colours, in the order of the file; `None` in place of others, which nothing draws.
///
/// # Errors
/// If an image cannot be read.
pub(crate) fn read(
    document: &Document,
    buffers: &Buffers,
    folder: &Path,
) -> Result<Vec<Option<Texture>>, ModelError> {
    let base = |material: gltf::Material<'_>| {
        let texture = material.pbr_metallic_roughness().base_color_texture()?;
        Some(texture.texture().index())
    };
    let used: BTreeSet<usize> = document.materials().filter_map(base).collect();
    let texture = |texture: gltf::Texture<'_>| {
        let image = texture.source();
        let place = part("image", image.index(), image.name());
        let wrong = |message: String| ModelError::new(place.clone(), message);
        let bytes = match image.source() {
            Source::View { view, .. } => {
                let bytes = buffers.view(&view).map(<[u8]>::to_vec);
                bytes.ok_or_else(|| {
                    wrong("it reaches beyond its buffer; export the file again".into())
                })?
            }
            Source::Uri { uri, .. } => named(uri, folder).map_err(wrong)?,
        };
        let sampler = texture.sampler();
        let wrap = [sampler.wrap_s(), sampler.wrap_t()];
        decoded(&bytes, wrap).map_err(|reason| {
            wrong(format!(
                "{reason}; PNG and JPEG of up to {LONGEST} texels a side are read"
            ))
        })
    };
    let each = document
        .textures()
        .map(|t| used.contains(&t.index()).then(|| texture(t)).transpose());
    each.collect()
}

fn decoded(bytes: &[u8], wrap: [WrappingMode; 2]) -> Result<Texture, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| e.to_string())?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LONGEST);
    limits.max_image_height = Some(LONGEST);
    reader.limits(limits);
    let image = reader.decode().map_err(|e| e.to_string())?.into_rgba8();
    let linear: [f32; 256] = std::array::from_fn(|code| linear(code as f64 / 255.0) as f32);
    let texel = |texel: &image::Rgba<u8>| {
        let [r, g, b, a] = texel.0;
        let [r, g, b] = [r, g, b].map(|code| linear[usize::from(code)]);
        [r, g, b, f32::from(a) / 255.0]
    };
    let mut level = Level {
        size: [image.width(), image.height()],
        texels: image.pixels().map(texel).collect(),
    };
    let mut levels = Vec::new();
    while level.size != [1, 1] {
        let half = level.halved();
        levels.push(std::mem::replace(&mut level, half));
    }
    levels.push(level);
    Ok(Texture { levels, wrap })
}

impl Level {
    /// Returns the means of two by two texels.
    fn halved(&self) -> Self {
        let size = self.size.map(|side| (side / 2).max(1));
        let at = |x: u32, y: u32| {
            let [x, y] = [x.min(self.size[0] - 1), y.min(self.size[1] - 1)];
            self.texels[(y * self.size[0] + x) as usize]
        };
        let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [2 * x, 2 * y]));
        let mean = |[x, y]: [u32; 2]| {
            let four = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            std::array::from_fn(|c| four.iter().map(|texel| texel[c]).sum::<f32>() / 4.0)
        };
        Self {
            size,
            texels: texels.map(mean).collect(),
        }
    }
}

/// The number of parts of a triangle's side between which its mean is taken.
const PARTS: u32 = 4;

impl Texture {
    /// Returns true if two of its texels differ.
    pub(crate) fn varies(&self) -> bool {
        self.levels[0].texels.windows(2).any(|two| two[0] != two[1])
    }

    /// Returns the mean colour over a triangle with these texture coordinates, about: of 16 points, on a level whose
    /// texels are as far apart as they are.
    pub(crate) fn mean(&self, [a, b, c]: [[f64; 2]; 3]) -> [f64; 4] {
        let [width, height] = self.levels[0].size.map(f64::from);
        let [u, v] = [b, c].map(|p| [(p[0] - a[0]) * width, (p[1] - a[1]) * height]);
        let texels = (u[0] * v[1] - u[1] * v[0]).abs() / 2.0 / f64::from(PARTS * PARTS);
        let level = (texels.max(1.0).log2() / 2.0).ceil() as usize;
        let level = &self.levels[level.min(self.levels.len() - 1)];
        let mut sum = [0.0; 4];
        let mut add = |weights: [f64; 2]| {
            let along = |axis: usize| {
                a[axis] + (b[axis] - a[axis]) * weights[0] + (c[axis] - a[axis]) * weights[1]
            };
            let texel = self.texel(level, [along(0), along(1)]);
            for (sum, channel) in sum.iter_mut().zip(texel) {
                *sum += f64::from(channel) / f64::from(PARTS * PARTS);
            }
        };
        let part = f64::from(PARTS).recip();
        for (i, j) in (0..PARTS).flat_map(|i| (0..PARTS - i).map(move |j| (i, j))) {
            let [i, j] = [i, j].map(f64::from);
            add([(i + 1.0 / 3.0) * part, (j + 1.0 / 3.0) * part]);
            // The triangle that points the other way, if it is inside.
            if i + j + 2.0 <= f64::from(PARTS) {
                add([(i + 2.0 / 3.0) * part, (j + 2.0 / 3.0) * part]);
            }
        }
        sum
    }

    fn texel(&self, level: &Level, at: [f64; 2]) -> [f32; 4] {
        let place = |axis: usize| {
            let turns = match self.wrap[axis] {
                WrappingMode::Repeat => at[axis].rem_euclid(1.0),
                WrappingMode::ClampToEdge => at[axis].clamp(0.0, 1.0),
                WrappingMode::MirroredRepeat => 1.0 - (at[axis].rem_euclid(2.0) - 1.0).abs(),
            };
            let side = level.size[axis];
            ((turns * f64::from(side)) as u32).min(side - 1)
        };
        level.texels[(place(1) * level.size[0] + place(0)) as usize]
    }
}
