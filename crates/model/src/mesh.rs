//! The triangles of a primitive.

use crate::accessor::items;
use crate::color::displayed;
use crate::error::ModelError;
use crate::files::Buffers;
use crate::texture::Texture;
use etalon_methods::ModelTriangle;
use glam::{DMat4, DVec3};
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

/// The difference of a triangle's linear vertex colours from which on it is cut into pieces.
const GRADIENT: f64 = 0.125;

/// The difference of displayed colours that a piece may lose.
const LOSS: f64 = 1.0 / 64.0;

/// The triangles of a primitive in the world, and what they are painted with.
#[derive(Debug)]
pub(crate) struct PaintedMesh<'a> {
    corners: Vec<DVec3>,
    /// The corners of each triangle, counter-clockwise as seen from the front.
    faces: Vec<[usize; 3]>,
    paint: VertexPaint<'a>,
    alpha: PaintedAlpha,
    is_double_sided: bool,
    /// The number of its object.
    object: usize,
}

#[derive(Debug)]
enum PaintedAlpha {
    Opaque,
    Blended,
    /// Alphas below it are holes.
    Cut(f64),
}

impl<'a> PaintedMesh<'a> {
    /// Reads a primitive and moves it to its place in the world. Points and lines are left out.
    ///
    /// # Errors
    /// If the primitive cannot be read.
    pub(crate) fn read(
        primitive: &Primitive<'_>,
        to_world: &DMat4,
        object: usize,
        buffers: &Buffers,
        textures: &'a [Option<Texture>],
    ) -> Result<Self, ModelError> {
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
        let mut faces: Vec<[usize; 3]> = match primitive.mode() {
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
        let material = primitive.material();
        // A mirrored object shows its triangles the other way round.
        if to_world.determinant() < 0.0 {
            faces.iter_mut().for_each(|face| face.swap(1, 2));
        }
        Ok(Self {
            corners,
            faces,
            paint,
            alpha: match material.alpha_mode() {
                AlphaMode::Opaque => PaintedAlpha::Opaque,
                AlphaMode::Blend => PaintedAlpha::Blended,
                AlphaMode::Mask => PaintedAlpha::Cut(material.alpha_cutoff().unwrap_or(0.5).into()),
            },
            is_double_sided: material.double_sided(),
            object,
        })
    }

    /// Returns the number of triangles.
    pub(crate) fn faces(&self) -> usize {
        self.faces.len()
    }

    /// Returns true if a triangle has parts of other colours than the whole.
    pub(crate) fn varies(&self) -> bool {
        self.paint
            .texture
            .as_ref()
            .is_some_and(|(texture, _)| texture.varies())
            || self.faces.iter().any(|face| self.paint.is_gradient(*face))
    }

    /// Returns true if pieces lose colours that those of `finest` parts have, a multiple of `parts`.
    pub(crate) fn loses_colors(&self, parts: usize, finest: usize) -> bool {
        self.faces.iter().any(|face| {
            pieces(parts).any(|piece| {
                let color = self.paint.color(*face, piece);
                pieces(finest / parts).any(|within| {
                    let finer = self
                        .paint
                        .color(*face, within.map(|corner| mixed(piece, corner)));
                    (0..4).any(|c| (finer[c] - color[c]).abs() > LOSS)
                })
            })
        })
    }

    /// Adds the triangles, the sides of each cut into a number of parts, so that each has `parts`² pieces of one colour.
    /// Pieces on both sides of an edge have the same corners there.
    pub(crate) fn add_to(&self, triangles: &mut Vec<ModelTriangle>, parts: usize) {
        for face in &self.faces {
            let corners = face.map(|i| self.corners[i]);
            for weights in pieces(parts) {
                let mut color = self.paint.color(*face, weights);
                if let PaintedAlpha::Cut(least) = self.alpha {
                    if color[3] < least {
                        continue;
                    }
                    color[3] = 1.0;
                }
                triangles.push(ModelTriangle {
                    corners: weights
                        .map(|[a, b, c]| corners[0] * a + corners[1] * b + corners[2] * c),
                    color,
                    transparent: matches!(self.alpha, PaintedAlpha::Blended),
                    double_sided: self.is_double_sided,
                    object: self.object,
                });
            }
        }
    }
}

/// The shares of a triangle's three corners in a corner of a piece.
type CornerShares = [f64; 3];

/// Returns the pieces of a triangle whose sides are cut into a number of parts, each turned as the whole is.
fn pieces(parts: usize) -> impl Iterator<Item = [CornerShares; 3]> {
    let at = move |i: usize, j: usize| [parts - i - j, i, j].map(|k| k as f64 / parts as f64);
    let places = (0..parts).flat_map(move |i| (0..parts - i).map(move |j| (i, j)));
    places.flat_map(move |(i, j)| {
        let upright = [at(i, j), at(i + 1, j), at(i, j + 1)];
        let turned = (i + j + 2 <= parts).then(|| [at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]);
        [Some(upright), turned].into_iter().flatten()
    })
}

/// What a primitive's vertices are painted with.
#[derive(Debug)]
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

    /// Returns true if the vertex colours of a triangle are too far apart for a mean.
    fn is_gradient(&self, face: [usize; 3]) -> bool {
        self.colors.as_ref().is_some_and(|colors| {
            let [a, b, c] = face.map(|i| colors[i]);
            (0..4).any(|k| (a[k] - b[k]).abs().max((b[k] - c[k]).abs()) > GRADIENT)
        })
    }

    /// Returns the mean colour of a piece of a triangle as it is displayed, and its alpha.
    fn color(&self, face: [usize; 3], piece: [CornerShares; 3]) -> [f64; 4] {
        let mut color = self.factor;
        let mut multiply = |by: [f64; 4]| {
            for (channel, by) in color.iter_mut().zip(by) {
                *channel *= by;
            }
        };
        if let Some(colors) = &self.colors {
            let middle = [0, 1, 2].map(|k| piece.iter().map(|corner| corner[k]).sum::<f64>() / 3.0);
            multiply(mixed(face.map(|i| colors[i]), middle));
        }
        if let Some((texture, uv)) = &self.texture {
            let uv = face.map(|i| uv[i]);
            multiply(texture.mean(piece.map(|corner| mixed(uv, corner))));
        }
        let clamped = |v: f64| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) };
        let [r, g, b, a] = color.map(clamped);
        [displayed(r), displayed(g), displayed(b), a]
    }
}

/// Returns the values of a triangle's corners, mixed by their shares.
fn mixed<const N: usize>(corners: [[f64; N]; 3], shares: CornerShares) -> [f64; N] {
    std::array::from_fn(|k| {
        corners
            .iter()
            .zip(shares)
            .map(|(corner, share)| corner[k] * share)
            .sum()
    })
}
