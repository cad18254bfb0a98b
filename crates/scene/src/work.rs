//! The work of a scene, counted without drawing it.
//!
//! Rates need the amount of work that was timed. It follows from meshes, viewports and passes, so it need not
//! be derived from case names.

use crate::draw::Draw;
use crate::mesh::PrimitiveVertices;
use crate::pass::{Clear, Pass};
use crate::rasterization::{CullMode, FrontFace, PrimitiveTopology};
use crate::scene::Scene;
use crate::traffic::{self, Traffic};
use etalon_frame::Work;

impl Scene {
    /// Counts the work of one submission and of reading its frame back. Points, lines and outlines do not
    /// count as triangles, and clear commands of passes move no bytes.
    pub fn work(&self) -> Work {
        let (mut work, mut traffic) = (Work::default(), Vec::new());
        for pass in &self.passes {
            let size = self.pass_size(pass);
            work.cleared += cleared(pass, size);
            work.resolved += pass.resolve_targets().count() as u64 * area(size);
            let clears = pass.cleared().into_iter();
            traffic.extend(clears.map(|(index, aspect)| {
                traffic::cleared(&self.attachments[index], aspect) * area(size)
            }));
            let samples = u64::from(self.pass_samples(pass));
            traffic.extend(pass.resolve_targets().map(|index| {
                traffic::resolved(self.attachments[index].format, samples) * area(size)
            }));
            for draw in &pass.draws {
                let (triangles, texels) = drawn(draw, size);
                work.triangles += triangles;
                work.texels += texels;
                traffic.push(traffic::covered(&self.attachments, pass, draw) * texels);
            }
        }
        for attachment in self.read.iter().map(|index| &self.attachments[*index]) {
            let texels = area(attachment.size);
            work.read += texels;
            work.read_bytes += traffic::read_back(attachment).bytes * texels;
        }
        let traffic: Traffic = traffic.into_iter().sum();
        (work.bytes, work.operations) = (traffic.bytes, traffic.operations);
        work
    }
}

fn area(size: [u32; 2]) -> u64 {
    u64::from(size[0]) * u64::from(size[1])
}

/// Returns the number of texels that a pass clears; depth and stencil of one attachment are cleared together.
fn cleared(pass: &Pass, size: [u32; 2]) -> u64 {
    let mut loaded: Vec<usize> = pass.cleared().into_iter().map(|(index, _)| index).collect();
    loaded.dedup();
    let commands = pass.clears.iter();
    let rect = |clear: &Clear| clear.rect.map_or(area(size), |[_, _, w, h]| area([w, h]));
    loaded.len() as u64 * area(size) + commands.map(rect).sum::<u64>()
}

/// Returns the number of triangles of a draw, and the number of texels that they cover.
fn drawn(draw: &Draw, size: [u32; 2]) -> (u64, u64) {
    let filled = [
        PrimitiveTopology::TriangleList,
        PrimitiveTopology::TriangleStrip,
        PrimitiveTopology::TriangleFan,
    ];
    if !filled.contains(&draw.topology) {
        return (0, 0);
    }
    let window = WorkWindow::new(draw, size);
    let (mut triangles, mut texels) = (0, 0);
    for primitive in draw.primitives() {
        let PrimitiveVertices::Triangle(corners) = primitive else {
            continue;
        };
        triangles += 1;
        let corners = corners.map(|i| draw.mesh.vertices[i].position.map(f64::from));
        if !draw.rasterizer_discard && is_seen(draw, corners) {
            texels += window.covered(corners);
        }
    }
    (triangles, texels)
}

/// Returns true if a triangle is neither culled nor outside the visible depths.
fn is_seen(draw: &Draw, corners: [[f64; 4]; 3]) -> bool {
    if corners.iter().any(|c| c[3] <= 0.0) {
        return false;
    }
    let behind = corners.iter().all(|c| c[2] > c[3]);
    let before = corners.iter().all(|c| c[2] < 0.0);
    if !draw.depth_clamp && (behind || before) {
        return false;
    }
    let [a, b, c] = corners.map(|c| [c[0] / c[3], c[1] / c[3]]);
    let twice = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let ccw = (twice > 0.0) != draw.viewport.is_mirrored();
    let front = ccw == (draw.front_face == FrontFace::Ccw);
    match draw.cull {
        CullMode::None => true,
        CullMode::Front => !front,
        CullMode::Back => front,
        CullMode::FrontAndBack => false,
    }
}

/// The part of the attachments that a draw can reach.
struct WorkWindow {
    /// Left, top, width and height of the viewport; the height can be negative.
    rect: [f64; 4],
    /// Left, top, right and bottom of the intersection of viewport, scissor rectangle and attachments.
    bounds: [f64; 4],
}

impl WorkWindow {
    fn new(draw: &Draw, size: [u32; 2]) -> Self {
        let [x, y, w, h] = draw.viewport.area().map(f64::from);
        let mut bounds = [x, y, x + w, y + h];
        let mut cut = |with: [f64; 4]| {
            for (side, limit) in with.into_iter().enumerate() {
                bounds[side] = match side {
                    0 | 1 => bounds[side].max(limit),
                    _ => bounds[side].min(limit),
                };
            }
        };
        cut([0.0, 0.0, f64::from(size[0]), f64::from(size[1])]);
        if let Some(scissor) = draw.scissor {
            let [x, y, w, h] = scissor.map(f64::from);
            cut([x, y, x + w, y + h]);
        }
        Self {
            rect: draw.viewport.rect.map(f64::from),
            bounds,
        }
    }

    /// Returns the number of texels whose centres are inside a triangle. Its left and upper edges are inside,
    /// so that triangles that share an edge count its centres once.
    fn covered(&self, corners: [[f64; 4]; 3]) -> u64 {
        let [left, top, width, height] = self.rect;
        let points = corners.map(|c| {
            let x = left + (c[0] / c[3] + 1.0) / 2.0 * width;
            let y = top + (1.0 - c[1] / c[3]) / 2.0 * height;
            [x, y]
        });
        let [least_x, least_y, most_x, most_y] = self.bounds;
        let ys = points.map(|p| p[1]);
        let first = ys.into_iter().fold(f64::INFINITY, f64::min).max(least_y);
        let end = ys.into_iter().fold(f64::NEG_INFINITY, f64::max).min(most_y);
        let mut texels = 0;
        for row in centre(first)..centre(end) {
            let y = row as f64 + 0.5;
            let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
            for i in 0..3 {
                let [a, b] = [points[i], points[(i + 1) % 3]];
                if (a[1] <= y) != (b[1] <= y) {
                    let x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                    from = from.min(x);
                    to = to.max(x);
                }
            }
            let (from, to) = (from.max(least_x), to.min(most_x));
            texels += (centre(to) - centre(from)).max(0) as u64;
        }
        texels
    }
}

/// Returns the index of the first texel whose centre is not before a coordinate.
fn centre(coordinate: f64) -> i64 {
    (coordinate - 0.5).ceil() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::{Attachment, AttachmentContents};
    use crate::mesh_source::{MeshSource, Splat};
    use crate::pass::{LoadOperation, Operations, PassOperations};
    use crate::query_scope::QueryScope;
    use crate::rasterization::Viewport;
    use crate::shader::Shader;
    use etalon_frame::TextureFormat;

    const SIZE: [u32; 2] = [32, 16];

    fn draw(mesh: &MeshSource) -> Draw {
        let mesh = mesh.expand(SIZE).expect("it expands");
        Draw::new(Shader::FlatColor, mesh, Viewport::whole(SIZE))
    }

    fn grid(cells: [u32; 2]) -> Draw {
        draw(&MeshSource::Grid {
            cells,
            z: 0.5,
            value: Splat::default(),
        })
    }

    fn stack(layers: usize) -> Draw {
        draw(&MeshSource::Stack {
            z: vec![0.5; layers],
            values: vec![Splat::default()],
        })
    }

    fn scene(passes: Vec<Pass>) -> Scene {
        let attachment = |name: &str, samples| Attachment {
            name: name.to_owned(),
            format: TextureFormat::Rgba8Unorm,
            size: SIZE,
            samples,
            contents: AttachmentContents::Color([0.0; 4]),
        };
        Scene {
            attachments: vec![attachment("color", 4), attachment("resolved", 1)],
            passes,
            read: vec![1],
            counters: Vec::new(),
            query_scope: QueryScope::Draw,
            pool: None,
            path: Default::default(),
        }
    }

    #[test]
    fn layers_cover_every_texel_once_each() {
        assert_eq!(drawn(&stack(5), SIZE), (5, 5 * 32 * 16));
        let mut cut = stack(3);
        cut.scissor = Some([4, 2, 8, 3]);
        assert_eq!(drawn(&cut, SIZE), (3, 3 * 24));
        let mut part = stack(1);
        part.viewport.rect = [0.0, 12.0, 8.0, -8.0];
        assert_eq!(drawn(&part, SIZE), (1, 64));
    }

    #[test]
    fn triangles_that_share_edges_cover_each_texel_once() {
        for cells in [[1, 1], [16, 16], [8, 4], [32, 16], [5, 3]] {
            let (triangles, texels) = drawn(&grid(cells), SIZE);
            assert_eq!(triangles, u64::from(2 * cells[0] * cells[1]));
            assert_eq!(texels, 32 * 16, "{cells:?}");
        }
    }

    #[test]
    fn culled_and_clipped_primitives_cover_nothing() {
        let mut draw = grid([8, 4]);
        draw.cull = CullMode::Back;
        let ccw = drawn(&draw, SIZE);
        draw.front_face = FrontFace::Cw;
        let cw = drawn(&draw, SIZE);
        assert_eq!([ccw.0, cw.0], [64, 64]);
        assert_eq!([ccw.1, cw.1].iter().sum::<u64>(), 32 * 16);
        assert!(ccw.1 == 0 || cw.1 == 0);
        let mut far = stack(2);
        for vertex in &mut far.mesh.vertices {
            vertex.position[2] = 2.0;
        }
        assert_eq!(drawn(&far, SIZE), (2, 0));
        far.depth_clamp = true;
        assert_eq!(drawn(&far, SIZE), (2, 2 * 32 * 16));
    }

    #[test]
    fn clears_and_resolves_count_their_attachments() {
        let clear = Operations {
            load: LoadOperation::Clear([0.0; 4]),
            ..Operations::default()
        };
        let pass = Pass {
            color: vec![0],
            resolve: vec![Some(1)],
            operations: PassOperations {
                color: vec![clear],
                ..PassOperations::default()
            },
            draws: vec![stack(2)],
            ..Pass::default()
        };
        let texels = 32 * 16;
        let work = scene(vec![pass.clone(), pass]).work();
        let expected = Work {
            triangles: 4,
            texels: 4 * texels,
            cleared: 2 * texels,
            resolved: 2 * texels,
            read: texels,
            // Each pass draws two layers of four samples, clears four samples, and resolves them to one.
            bytes: 2 * texels * 4 * (2 * 4 + 4 + 5),
            operations: 2 * texels * 4 * (2 * 4 + 9),
            read_bytes: texels * 2 * 4,
        };
        assert_eq!(work, expected);
    }
}
