//! Accumulation of jittered frames (Haeberli and Akeley 1990).

use super::scenes::{EdgeScene, PICTURE};
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{NEARER, Stage, add, both, depth, draw};
use etalon_frame::TextureFormat;
use etalon_scene::{BlendFactor, CompareFunction, Draw, Scene, Shader};

/// The format of sums.
const SUM: TextureFormat = TextureFormat::Rgba16Float;

/// Draws `count` frames, each moved by another part of a texel, and takes their mean. In each frame the pieces
/// are `speed` texels further to the right; the last frame shows them in their places.
pub(super) fn jittered(edges: &EdgeScene, count: u32, speed: f64) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, edges.size, edges.clear());
    let frame = stage.color("frame", PICTURE, edges.size, edges.clear());
    let sum = stage.color("sum", SUM, edges.size, [0.0; 4]);
    let depth_stencil = edges.depths(&mut stage, 1);
    let pieces = edges.pieces();
    for (number, [x, y]) in (1..).zip(offsets(count)) {
        let behind = f64::from(count - number) * speed;
        let pieces = pieces.iter().map(|piece| moved(piece, [x - behind, y]));
        let draw_all = |polygons: &[Polygon]| draw(Shader::FlatColor, mesh(edges.size, polygons));
        let draws = if edges.needs_depth() {
            let mut ground = draw_all(&still(edges));
            ground.depth = depth(CompareFunction::Always, true);
            let mut solid = draw_all(&pieces.collect::<Vec<_>>());
            solid.depth = NEARER;
            vec![ground, solid]
        } else {
            vec![draw_all(
                &still(edges).into_iter().chain(pieces).collect::<Vec<_>>(),
            )]
        };
        stage.pass(&[frame], depth_stencil, draws);
        let mut accumulate = copy(frame);
        accumulate.targets[0].blend = both(add(BlendFactor::Constant, BlendFactor::One));
        accumulate.blend_constant = [1.0 / count as f32; 4];
        stage.pass(&[sum], None, vec![accumulate]);
    }
    stage.pass(&[picture], None, vec![copy(sum)]);
    stage.read(&[picture])
}

/// Returns a draw that copies a texture.
fn copy(texture: usize) -> Draw {
    let mut copy = draw(Shader::TexelColor, cover());
    copy.textures = vec![texture];
    copy
}

/// Returns what does not move: the ground, or a background in its place. It covers the previous frame.
fn still(edges: &EdgeScene) -> Vec<Polygon> {
    if edges.ground.is_empty() {
        let [width, height] = edges.size.map(f64::from);
        return vec![Polygon::rect([0.0, 0.0, width, height], 1.0, edges.clear())];
    }
    edges.ground.clone()
}

/// Returns the polygon moved by a number of texels. Its texture coordinates hold the move, which is the same number of
/// texels in a frame of any size.
fn moved(polygon: &Polygon, [x, y]: [f64; 2]) -> Polygon {
    let mut moved = polygon.clone();
    moved.uv = vec![[x, y]; moved.corners.len()];
    for corner in &mut moved.corners {
        corner[0] += x;
        corner[1] += y;
    }
    moved
}

/// Returns offsets around 0, less than half a texel long on each axis. No two of them share a row or a column
/// of a grid of `count` by `count` cells; `count` is a power of two.
pub(super) fn offsets(count: u32) -> impl Iterator<Item = [f64; 2]> {
    let bits = count.trailing_zeros();
    let middle = move |cell: u32| (f64::from(cell) + 0.5) / f64::from(count) - 0.5;
    (0..count).map(move |column| {
        // The digits of the column in reverse spread its neighbours over the rows.
        let row = column.reverse_bits().checked_shr(32 - bits).unwrap_or(0);
        [middle(column), middle(row)]
    })
}
