//! The triangles of a primitive.

use crate::accessor::items;
use crate::color::displayed;
use crate::error::ModelError;
use crate::files::Buffers;
use crate::texture::Texture;
use etalon_methods::{MOST_TRIANGLES, ModelTriangle};
use glam::{DMat4, DVec3};
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

/// Adds the triangles of a primitive, moved to their place in the world. Points and lines are left out.
///
/// # Errors
/// If the primitive cannot be read, or if there are too many triangles.
pub(crate) fn add(
    primitive: &Primitive<'_>,
    to_world: &DMat4,
    object: usize,
    buffers: &Buffers,
    textures: &[Option<Texture>],
    triangles: &mut Vec<ModelTriangle>,
) -> Result<(), ModelError> {
    let wrong =
        |message: &str| ModelError::new(format!("primitive {}", primitive.index()), message);
    let attribute = |semantic| primitive.get(&semantic);
    let Some(positions) = attribute(Semantic::Positions) else {
        return Err(wrong("it has no positions; export it without compression"));
    };
    let positions: Vec<[f64; 3]> = items(&positions, buffers)?;
    let corners: Vec<DVec3> = positions
        .into_iter()
        .map(|p| to_world.transform_point3(DVec3::from(p)))
        .collect();
    if !corners.iter().all(|corner| corner.is_finite()) {
        return Err(wrong(
            "a position is no finite number; export the file again",
        ));
    }
    let paint = VertexPaint::new(primitive, buffers, textures)?;
    let indices: Vec<usize> = match primitive.indices() {
        Some(accessor) => {
            let indices: Vec<[f64; 1]> = items(&accessor, buffers)?;
            indices.into_iter().map(|[i]| i as usize).collect()
        }
        None => (0..corners.len()).collect(),
    };
    let least = [corners.len(), paint.vertices()].into_iter().min();
    if indices.iter().any(|i| Some(*i) >= least) {
        return Err(wrong(
            "an index names a vertex that it does not have; export the file again",
        ));
    }
    let faces: Vec<[usize; 3]> = match primitive.mode() {
        Mode::Triangles => {
            let (faces, _) = indices.as_chunks();
            faces.to_vec()
        }
        Mode::TriangleStrip => {
            let turned = |(i, w): (usize, &[usize])| match i % 2 {
                0 => [w[0], w[1], w[2]],
                _ => [w[1], w[0], w[2]],
            };
            indices.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => {
            let fan = indices.iter().skip(1).zip(indices.iter().skip(2));
            fan.map(|(a, b)| [indices[0], *a, *b]).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    };
    if triangles.len() + faces.len() > MOST_TRIANGLES {
        return Err(wrong(&format!(
            "the scene has more than {MOST_TRIANGLES} triangles with it; decimate it, or leave out what its camera does not see"
        )));
    }
    let material = primitive.material();
    // A mirrored object shows its triangles the other way round.
    let is_mirrored = to_world.determinant() < 0.0;
    for face in faces {
        let (mut color, mut corners) = (paint.color(face), face.map(|i| corners[i]));
        if is_mirrored {
            corners.swap(1, 2);
        }
        let transparent = match material.alpha_mode() {
            AlphaMode::Opaque => false,
            AlphaMode::Blend => true,
            AlphaMode::Mask => {
                if color[3] < f64::from(material.alpha_cutoff().unwrap_or(0.5)) {
                    continue;
                }
                color[3] = 1.0;
                false
            }
        };
        triangles.push(ModelTriangle {
            corners,
            color,
            transparent,
            double_sided: material.double_sided(),
            object,
        });
    }
    Ok(())
}

/// What a primitive's vertices are painted with.
struct VertexPaint<'a> {
    factor: [f64; 4],
    /// Linear red, green, blue and alpha of each vertex.
    colors: Option<Vec<[f64; 4]>>,
    texture: Option<(&'a Texture, Vec<[f64; 2]>)>,
}

impl<'a> VertexPaint<'a> {
    fn new(
        primitive: &Primitive<'_>,
        buffers: &Buffers,
        textures: &'a [Option<Texture>],
    ) -> Result<Self, ModelError> {
        let base = primitive.material().pbr_metallic_roughness();
        let colors = match primitive.get(&Semantic::Colors(0)) {
            None => None,
            Some(accessor) if accessor.dimensions() == gltf::accessor::Dimensions::Vec3 => {
                let colors: Vec<[f64; 3]> = items(&accessor, buffers)?;
                Some(colors.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
            }
            Some(accessor) => Some(items(&accessor, buffers)?),
        };
        let texture = base.base_color_texture().and_then(|info| {
            let uv = primitive.get(&Semantic::TexCoords(info.tex_coord()))?;
            Some((textures.get(info.texture().index())?.as_ref()?, uv))
        });
        let texture = match texture {
            None => None,
            Some((texture, uv)) => Some((texture, items(&uv, buffers)?)),
        };
        Ok(Self {
            factor: base.base_color_factor().map(f64::from),
            colors,
            texture,
        })
    }

    /// Returns the number of vertices that have all of it.
    fn vertices(&self) -> usize {
        let colors = self.colors.as_ref().map_or(usize::MAX, Vec::len);
        let uv = self.texture.as_ref().map_or(usize::MAX, |(_, uv)| uv.len());
        colors.min(uv)
    }

    /// Returns the mean colour of a triangle as it is displayed, and its alpha.
    fn color(&self, face: [usize; 3]) -> [f64; 4] {
        let mut color = self.factor;
        let mut multiply = |by: [f64; 4]| {
            for (channel, by) in color.iter_mut().zip(by) {
                *channel *= by;
            }
        };
        if let Some(colors) = &self.colors {
            multiply(std::array::from_fn(|c| {
                face.iter().map(|i| colors[*i][c]).sum::<f64>() / 3.0
            }));
        }
        if let Some((texture, uv)) = &self.texture {
            multiply(texture.mean(face.map(|i| uv[i])));
        }
        let clamped = |v: f64| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) };
        let [r, g, b, a] = color.map(clamped);
        [displayed(r), displayed(g), displayed(b), a]
    }
}
