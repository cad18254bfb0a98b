//! The cost of visibility: rooms behind rooms, seen through openings, with an expensive fragment shader.
//! All methods give the same picture.

mod claims;
mod lessons;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;

use crate::error::{ParameterError, within};
use crate::grid::settle;
use crate::method_scene::MethodScene;
use crate::polygon::{self, Polygon};
use crate::stage::{self, SIZE, Stage};
use crate::truth::{TexelCoverage, Truth};
use crate::view::{Face, View, cuboid};
use etalon_frame::TextureFormat;
use etalon_scene::{CompareFunction, Draw, EarlyTests, Mesh, Shader};
use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Steps of work per fragment.
const STEPS: f32 = 64.0;

/// The colour behind everything.
const BACKGROUND: [f64; 3] = [0.85, 0.9, 1.0];

/// The maximum number of rooms in a row.
const MOST: u32 = 32;

/// Rooms behind rooms.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VisibilityWire {
    scene: VisibilityScene,
    method: VisibilityMethod,
    /// The number of walls behind each other, 1 to 32, which is about the depth complexity.
    layers: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum VisibilityScene {
    /// Walls with openings, and boxes between them.
    Rooms,
}

/// The drawing order, and the tests that reject hidden surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum VisibilityMethod {
    /// Painter's order: back to front, without a depth buffer.
    NoTest,
    /// A depth test, triangles in no particular order.
    Unsorted,
    /// A depth test, near triangles first.
    FrontToBack,
    /// A first pass without colour writes all depths; a second pass draws the fragments of equal depth, in no
    /// particular order.
    DepthPrepass,
    /// Like `discard`, with tests that are forced to run before the shader.
    ForcedEarlyTest,
    /// Like `front-to-back`, with a shader that could discard.
    Discard,
    /// Like `front-to-back`, with a shader that writes the depth that the fragment has anyway.
    WrittenDepth,
}

/// Returns the faces back to front as seen from the eye: the farthest room first; within a room its far
/// wall, the boxes at the sides, the partitions, then the boxes in the middle.
fn rooms(eye: DVec3, layers: u32) -> Vec<Face> {
    let mut seen = Vec::new();
    for room in (0..layers).rev() {
        let dice = |salt: u32| {
            let hash = (room * 8 + salt + 1).wrapping_mul(0x9e37_79b1);
            f64::from(hash >> 16) / 65536.0
        };
        let back = -30.0 - 4.0 * f64::from(room);
        let hue = dice(0);
        let color = [
            0.35 + 0.55 * hue,
            0.45 + 0.3 * dice(1),
            0.9 - 0.55 * hue,
            1.0,
        ];
        let open = [2.4 * (dice(2) - 0.5), 2.0 * (dice(3) - 0.5)];
        seen.extend(wall(back, open, color));
        let front = back + 3.6;
        let block = |[x, y]: [f64; 2], salt: u32| {
            let half = 0.35 + 0.4 * dice(salt);
            let color = [0.9 - 0.6 * dice(salt), 0.35 + 0.5 * hue, 0.3, 1.0];
            let low = DVec3::new(x - half, y - half, back + 0.6);
            cuboid(
                low,
                DVec3::new(x + half, y + half, back + 0.8 + half),
                color,
            )
        };
        let partition = |x: f64| {
            let low = DVec3::new(x - 0.05, -1.6, back + 0.2);
            cuboid(low, DVec3::new(x + 0.05, 0.4 + dice(4), front), color)
        };
        let mut solid = |faces: Vec<Face>| seen.extend(behind_first(eye, faces));
        solid(block([-2.6, 2.0 * (dice(5) - 0.5)], 5));
        solid(block([2.6, 2.0 * (dice(6) - 0.5)], 6));
        solid(partition(-1.5));
        solid(partition(1.5));
        solid(block([0.6 * (dice(7) - 0.5), 0.6 * dice(3) - 1.9], 7));
    }
    seen
}

/// Returns a wall across the whole picture with an opening at x and y.
fn wall(z: f64, [x, y]: [f64; 2], color: [f64; 4]) -> Vec<Face> {
    const EDGE: f64 = 30.0;
    let [left, right, low, high] = [x - 1.2, x + 1.2, y - 1.1, y + 1.1];
    let part = |[left, right, low, high]: [f64; 4]| Face {
        corners: vec![
            DVec3::new(left, low, z),
            DVec3::new(right, low, z),
            DVec3::new(right, high, z),
            DVec3::new(left, high, z),
        ],
        color,
    };
    [
        [-EDGE, left, -EDGE, EDGE],
        [right, EDGE, -EDGE, EDGE],
        [left, right, -EDGE, low],
        [left, right, high, EDGE],
    ]
    .map(part)
    .to_vec()
}

/// Returns the faces of a convex solid, first the faces that face away from the eye.
fn behind_first(eye: DVec3, faces: Vec<Face>) -> Vec<Face> {
    let (front, mut ordered): (Vec<Face>, Vec<Face>) =
        faces.into_iter().partition(|face| face.looks_at(eye));
    ordered.extend(front);
    ordered
}

/// Returns a fixed pseudo-random order.
fn shuffled(polygons: &[Polygon]) -> Vec<Polygon> {
    let key = |i: usize| (i as u32).wrapping_mul(0x9e37_79b1) >> 4;
    let mut order: Vec<usize> = (0..polygons.len()).collect();
    order.sort_by_key(|i| key(*i));
    order.into_iter().map(|i| polygons[i].clone()).collect()
}

fn shade(shader: Shader, mesh: Mesh, compare: CompareFunction) -> Draw {
    let mut draw = stage::draw(shader, mesh);
    draw.params.back_color = [STEPS, 0.0, 0.0, 0.0];
    draw.depth = stage::depth(compare, compare != CompareFunction::Equal);
    draw
}

fn draws(method: VisibilityMethod, back_to_front: &[Polygon]) -> Vec<Draw> {
    let mesh = |polygons: &[Polygon]| polygon::mesh(SIZE, polygons);
    let unsorted = || mesh(&shuffled(back_to_front));
    let front_to_back = || {
        let polygons: Vec<Polygon> = back_to_front.iter().rev().cloned().collect();
        mesh(&polygons)
    };
    let less = CompareFunction::Less;
    match method {
        VisibilityMethod::NoTest => {
            let mut draw = shade(Shader::ExpensiveColor, mesh(back_to_front), less);
            draw.depth = None;
            vec![draw]
        }
        VisibilityMethod::Unsorted => vec![shade(Shader::ExpensiveColor, unsorted(), less)],
        VisibilityMethod::FrontToBack => vec![shade(Shader::ExpensiveColor, front_to_back(), less)],
        VisibilityMethod::DepthPrepass => {
            let mut depth = stage::draw(Shader::FlatColor, unsorted());
            depth.depth = stage::depth(less, true);
            depth.targets[0].write_mask = 0;
            let equal = CompareFunction::Equal;
            vec![depth, shade(Shader::ExpensiveColor, unsorted(), equal)]
        }
        VisibilityMethod::ForcedEarlyTest => {
            let mut draw = shade(Shader::ExpensiveDiscard, front_to_back(), less);
            draw.early_tests = EarlyTests::Forced;
            vec![draw]
        }
        VisibilityMethod::Discard => vec![shade(Shader::ExpensiveDiscard, front_to_back(), less)],
        VisibilityMethod::WrittenDepth => {
            vec![shade(Shader::ExpensiveDepth, front_to_back(), less)]
        }
    }
}

/// Returns the triangles of the rooms, back to front.
fn triangles(layers: u32) -> Vec<Polygon> {
    let eye = DVec3::new(0.25, 0.3, 0.0);
    let target = DVec3::new(0.1, -0.1, -30.0);
    let far = 34.0 + 4.0 * f64::from(layers);
    let view = View::perspective(SIZE, [eye, target], 11.0, [10.0, far]);
    settle(SIZE, &view.see(&rooms(eye, layers)))
}

pub(crate) fn make(wire: &VisibilityWire) -> Result<MethodScene, ParameterError> {
    let VisibilityWire {
        scene: VisibilityScene::Rooms,
        method,
        layers,
    } = *wire;
    within("layers", layers.into(), 1.0..=MOST.into())?;
    let triangles = triangles(layers);
    let mut stage = Stage::new();
    let background = [BACKGROUND[0], BACKGROUND[1], BACKGROUND[2], 1.0];
    let picture = stage.color("picture", TextureFormat::Rgba8Unorm, SIZE, background);
    let depth = (method != VisibilityMethod::NoTest)
        .then(|| stage.depth("depth", TextureFormat::Depth24Plus, SIZE, 1, 1.0));
    stage.pass(&[picture], depth, draws(method, &triangles));
    let truth = Truth {
        size: SIZE,
        background: BACKGROUND,
        coverage: TexelCoverage::Center,
        surfaces: triangles.iter().map(Polygon::surface).collect(),
    };
    Ok(MethodScene {
        scene: stage.read(&[picture]),
        truth,
    })
}
