//! Mesh edges that pass so near a sample that a driver may cover it or not.
//!
//! An edge inside a mesh of one colour can be anywhere; it is reported only if the sample has several legal
//! outcomes because of it. In multisampled textures edges near samples cannot be avoided, so only
//! single-sampled pictures are checked.

use etalon_frame::LegalSet;
use etalon_scene::{Draw, PolygonMode, PrimitiveTopology, PrimitiveVertices, Scene};

/// The distance in texels below which an edge can pass on either side of a sample. A driver can snap both
/// vertices to its sub-pixel grid, which has at least 16 positions per texel and axis.
const NEAR: f64 = 1.0 / 16.0;
/// The largest side of a picture that is checked, in texels.
const MAX_SIZE: u32 = 256;
/// The largest number of primitives of a draw that are checked.
const MAX_PRIMITIVES: usize = 4096;

/// An edge that leaves the outcome of a near sample open.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Near {
    /// The indices of the pass and the draw.
    pub(crate) draw: [usize; 2],
    pub(crate) texel: [u32; 2],
    /// The distance between edge and centre in texels.
    pub(crate) distance: f64,
}

/// Returns the edge that passes nearest to the centre of a texel with several legal outcomes, if any passes too
/// near.
pub(crate) fn nearest(scene: &Scene, legal: &LegalSet) -> Option<Near> {
    let mut found: Option<Near> = None;
    for (p, pass) in scene.passes.iter().enumerate() {
        let size = scene.pass_size(pass);
        if size[0] > MAX_SIZE || size[1] > MAX_SIZE || scene.pass_samples(pass) > 1 {
            continue;
        }
        for (d, draw) in pass.draws.iter().enumerate() {
            for [a, b] in edges(draw) {
                each_near(a, b, size, |texel, distance| {
                    let nearer = found.as_ref().is_none_or(|f| distance < f.distance);
                    if nearer && is_undecided(legal, size, texel) {
                        found = Some(Near {
                            draw: [p, d],
                            texel,
                            distance,
                        });
                    }
                });
            }
        }
    }
    found
}

/// Returns true if a draw rasterizes points, lines or outlines.
pub(crate) fn draws_outlines(draw: &Draw) -> bool {
    let triangles = [
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleFan,
    ];
    draw.polygon_mode != PolygonMode::Fill || !triangles.contains(&draw.topology)
}

/// Returns the edges of a draw's filled triangles in texels; skips triangles with a vertex behind the viewer.
fn edges(draw: &Draw) -> Vec<[[f64; 2]; 2]> {
    if draws_outlines(draw) || draw.rasterizer_discard {
        return Vec::new();
    }
    let [left, top, width, height] = draw.viewport.rect.map(f64::from);
    let place = |vertex: usize| -> Option<[f64; 2]> {
        let [x, y, _, w] = draw.mesh.vertices.get(vertex)?.position.map(f64::from);
        (w > 0.0).then(|| {
            [
                left + (x / w + 1.0) / 2.0 * width,
                top + (1.0 - y / w) / 2.0 * height,
            ]
        })
    };
    let mut edges = Vec::new();
    for primitive in draw.primitives().into_iter().take(MAX_PRIMITIVES) {
        let PrimitiveVertices::Triangle(corners) = primitive else {
            continue;
        };
        if let [Some(a), Some(b), Some(c)] = corners.map(place) {
            edges.extend([[a, b], [b, c], [c, a]]);
        }
    }
    edges
}

/// Calls a function with each texel whose centre is near the edge, and the distance.
fn each_near(a: [f64; 2], b: [f64; 2], size: [u32; 2], mut tell: impl FnMut([u32; 2], f64)) {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length = dx * dx + dy * dy;
    if length == 0.0 {
        return;
    }
    let clamp = |v: f64, most: u32| v.clamp(0.0, f64::from(most)) as u32;
    let rows = clamp(a[1].min(b[1]) - 1.0, size[1])..clamp(a[1].max(b[1]) + 2.0, size[1]);
    for y in rows {
        // The part of the edge inside the row, with a margin.
        let channel = |row: f64| {
            if dy == 0.0 {
                0.0
            } else {
                ((row - a[1]) / dy).clamp(0.0, 1.0)
            }
        };
        let (mut from, mut to) = (channel(f64::from(y) - 0.5), channel(f64::from(y) + 1.5));
        if dy == 0.0 {
            (from, to) = (0.0, 1.0);
        }
        let (left, right) = (a[0] + from * dx, a[0] + to * dx);
        for x in clamp(left.min(right) - 1.0, size[0])..clamp(left.max(right) + 2.0, size[0]) {
            let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let t = (((px - a[0]) * dx + (py - a[1]) * dy) / length).clamp(0.0, 1.0);
            let distance = (a[0] + t * dx - px).hypot(a[1] + t * dy - py);
            if distance < NEAR {
                tell([x, y], distance);
            }
        }
    }
}

/// Returns true if a texel has several legal outcomes.
fn is_undecided(legal: &LegalSet, size: [u32; 2], [x, y]: [u32; 2]) -> bool {
    let mut groups = legal
        .groups
        .iter()
        .filter(|group| group.size == size && group.samples == 1);
    groups.any(|group| {
        let set = group.sample(x, y, 0);
        set.worlds.len() > 1 || set.is_open()
    })
}
