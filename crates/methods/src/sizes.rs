//! Scenes at the sizes of frames that people draw.
//!
//! A method's scene is made for a small picture. Its geometry is in clip space, so the same meshes fill a frame of
//! any size and shape; whatever is meant in texels is changed here. The truth is stretched in the same way, and each
//! texel of it is as exact as before.

use crate::method_scene::MethodScene;
use crate::truth::Truth;
use etalon_scene::{AttachmentContents, Draw, Mesh, Pool, Scene, Shader, SharedMesh};

/// A change of a picture's size.
#[derive(Clone, Copy, Debug)]
struct Resizing {
    from: [u32; 2],
    to: [u32; 2],
}

impl Resizing {
    /// Returns the factors across and down.
    fn factors(self) -> [f64; 2] {
        [0, 1].map(|i| f64::from(self.to[i]) / f64::from(self.from[i]))
    }

    /// Returns the size of an attachment as large as the picture, or doubled as often in both directions; `None` for
    /// other sizes: those of textures, which keep theirs.
    fn size(self, size: [u32; 2]) -> Option<[u32; 2]> {
        let doublings = (size[0] / self.from[0].max(1)).checked_ilog2()?;
        let doubled = self.from.map(|side| side << doublings);
        (size == doubled).then(|| self.to.map(|side| side << doublings))
    }
}

/// Returns a method's scene and truth for a frame of another size, which can have another aspect ratio.
pub fn at_size(scene: &Scene, truth: &Truth, size: [u32; 2]) -> MethodScene {
    let resizing = Resizing {
        from: truth.size,
        to: size,
    };
    let mut scene = scene.clone();
    let fetched = fetched(&scene);
    for (index, attachment) in scene.attachments.iter_mut().enumerate() {
        let is_texture = matches!(attachment.contents, AttachmentContents::Texels(_));
        let fetched_by = fetched.iter().find(|(i, _)| *i == index).map(|(_, s)| *s);
        if is_texture && fetched_by.is_none() {
            continue;
        }
        let Some(to) = resizing.size(attachment.size) else {
            continue;
        };
        if let AttachmentContents::Texels(codes) = &mut attachment.contents {
            let channels = attachment.format.color_channels().len();
            let is_noise = fetched_by == Some(Shader::Stochastic);
            *codes = filled(codes, channels, [attachment.size, to], is_noise);
        }
        attachment.size = to;
    }
    if let Some(pool) = &mut scene.pool {
        let per_texel = u64::from(pool.nodes).div_ceil(pool.texels().max(1));
        let texels = u64::from(size[0]) * u64::from(size[1]);
        *pool = Pool {
            size,
            nodes: u32::try_from(per_texel * texels).unwrap_or(u32::MAX),
            ..*pool
        };
    }
    let [across, down] = resizing.factors();
    for draw in scene.passes.iter_mut().flat_map(|pass| &mut pass.draws) {
        let [left, top, width, height] = draw.viewport.rect.map(f64::from);
        let rect = [left * across, top * down, width * across, height * down];
        draw.viewport.rect = rect.map(|v| v as f32);
        resize_parameters(draw, resizing);
    }
    let mut truth = truth.clone();
    truth.size = size;
    for [x, y, _] in truth.surfaces.iter_mut().flat_map(|s| &mut s.corners) {
        *x *= across;
        *y *= down;
    }
    MethodScene { scene, truth }
}

/// Returns the textures that shaders fetch at the position of a fragment, and the shaders.
fn fetched(scene: &Scene) -> Vec<(usize, Shader)> {
    let draws = scene.passes.iter().flat_map(|pass| &pass.draws);
    let fetching = draws.filter(|draw| !draw.shader.samples_texture());
    fetching
        .flat_map(|draw| draw.textures.iter().map(|t| (*t, draw.shader)))
        .collect()
}

/// Returns the codes of a texture of another size: stretched, or repeated if it holds noise, which is different from
/// texel to texel at every size.
fn filled(codes: &[u32], channels: usize, [from, to]: [[u32; 2]; 2], is_noise: bool) -> Vec<u32> {
    let place = |at: u32, axis: usize| {
        if is_noise {
            at % from[axis]
        } else {
            (u64::from(at) * u64::from(from[axis]) / u64::from(to[axis])) as u32
        }
    };
    let texels = (0..to[1]).flat_map(|y| (0..to[0]).map(move |x| [x, y]));
    texels
        .flat_map(|[x, y]| {
            let texel = (place(y, 1) * from[0] + place(x, 0)) as usize;
            codes[texel * channels..(texel + 1) * channels]
                .iter()
                .copied()
        })
        .collect()
}

/// Changes the parameters and vertices of a draw that are meant in texels.
fn resize_parameters(draw: &mut Draw, resizing: Resizing) {
    let size = resizing.to.map(|side| side as f32);
    if draw.shader.uses_pool() {
        draw.params.color[..2].copy_from_slice(&size);
    }
    match draw.shader {
        Shader::Fxaa => draw.params.color[..2].copy_from_slice(&size.map(f32::recip)),
        Shader::HashedColor | Shader::HashedSample => draw.params.color[..2].copy_from_slice(&size),
        Shader::EdgeAlpha => measure_distances(&mut draw.mesh, size),
        Shader::FlatColor => jitter(&mut draw.mesh, resizing),
        _ => {}
    }
}

/// Moves the vertices of jittered frames, whose texture coordinates hold the move in texels (`anti_aliasing::jittered`), by
/// as many texels of the other size. No other mesh without a texture has texture coordinates.
fn jitter(mesh: &mut SharedMesh, Resizing { from, to }: Resizing) {
    if mesh.vertices.iter().all(|vertex| vertex.uv == [0.0; 2]) {
        return;
    }
    for vertex in &mut mesh.vertices {
        let [x, y, _, w] = vertex.position;
        // Clip space is two units wide, and its y points up.
        let step = |axis: usize| (2.0 / to[axis] as f32 - 2.0 / from[axis] as f32) * w;
        vertex.position[0] = x + vertex.uv[0] * step(0);
        vertex.position[1] = y - vertex.uv[1] * step(1);
    }
}

/// Changes the distances from an edge that the first texture coordinates hold, triangle by triangle, so that they are
/// in texels of a picture of this size: over a triangle they grow by 1 for each texel.
fn measure_distances(mesh: &mut Mesh, [width, height]: [f32; 2]) {
    for triangle in mesh.vertices.chunks_exact_mut(3) {
        let point = |i: usize| {
            let [x, y, ..] = triangle[i].position.map(f64::from);
            [x * f64::from(width) / 2.0, y * f64::from(height) / 2.0]
        };
        let value = |i: usize| f64::from(triangle[i].uv[0]);
        let [origin, first, second] = [0, 1, 2].map(point);
        let [a, b] = [first, second].map(|p| [p[0] - origin[0], p[1] - origin[1]]);
        let [u, v] = [1, 2].map(|i| value(i) - value(0));
        let area = a[0] * b[1] - a[1] * b[0];
        let slope = [(u * b[1] - v * a[1]) / area, (v * a[0] - u * b[0]) / area];
        let steepness = slope[0].hypot(slope[1]);
        // Over a triangle without area nothing is drawn.
        if steepness.is_normal() {
            for vertex in triangle {
                vertex.uv[0] = (f64::from(vertex.uv[0]) / steepness) as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_repeated_and_pictures_are_stretched() {
        let codes = [1, 2, 3, 4];
        let sizes = [[2, 2], [4, 2]];
        assert_eq!(filled(&codes, 1, sizes, true), [1, 2, 1, 2, 3, 4, 3, 4]);
        assert_eq!(filled(&codes, 1, sizes, false), [1, 1, 2, 2, 3, 3, 4, 4]);
        let two = filled(&codes, 2, [[2, 1], [3, 1]], true);
        assert_eq!(two, [1, 2, 3, 4, 1, 2]);
    }

    #[test]
    fn a_jittered_vertex_moves_by_as_many_texels_at_every_size() {
        let vertex = etalon_scene::Vertex {
            // The middle of a picture of 8 by 8 texels, moved by half a texel to the right and a quarter down.
            position: [0.125, -0.0625, 0.5, 1.0],
            color: [1.0; 4],
            uv: [0.5, 0.25],
        };
        let mut mesh = SharedMesh::from(Mesh {
            vertices: vec![vertex],
            indices: None,
        });
        let resizing = Resizing {
            from: [8, 8],
            to: [64, 32],
        };
        jitter(&mut mesh, resizing);
        let [x, y, ..] = mesh.vertices[0].position;
        assert_eq!([x * 32.0, y * 16.0], [0.5, -0.25]);
    }

    #[test]
    fn distances_from_an_edge_are_in_texels_at_every_size() {
        let vertex = |[x, y]: [f32; 2], distance: f32| etalon_scene::Vertex {
            position: [x, y, 0.5, 1.0],
            color: [1.0; 4],
            uv: [distance, 0.0],
        };
        // The distance from the left border of a picture of 8 by 8 texels, and of 80 by 16.
        let vertices = vec![
            vertex([-1.0, -1.0], 0.0),
            vertex([1.0, -1.0], 8.0),
            vertex([-1.0, 1.0], 0.0),
        ];
        let mut mesh = Mesh {
            vertices,
            indices: None,
        };
        measure_distances(&mut mesh, [80.0, 16.0]);
        let distances: Vec<f32> = mesh.vertices.iter().map(|v| v.uv[0]).collect();
        assert_eq!(distances, [0.0, 80.0, 0.0]);
    }
}
