//! Depth precision: pairs of surfaces that nearly touch, at many distances.
//!
//! The near and the far surface of a pair alternate in being drawn first, so that a depth buffer that
//! stores equal depths for both is wrong in half of the texels. Vertices are in clip space, with the
//! distance as w. Their four coordinates are rounded to 32 bits, as a vertex shader's output is, and the
//! driver divides.

mod claims;
mod lessons;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;

use crate::error::{ParameterError, within};
use crate::method_scene::MethodScene;
use crate::polygon::{self, Polygon};
use crate::seen_model::{SeenModel, named};
use crate::stage::{self, SIZE, Stage};
use crate::truth::{FlatSurface, TexelCoverage, Truth};
use crate::view::{distance, window_depth};
use etalon_frame::TextureFormat;
use etalon_scene::{CompareFunction, DepthBias, Draw, Shader};
use schemars::JsonSchema;
use serde::Deserialize;

/// The distance of the far plane.
const FAR: f64 = 1000.0;

/// The colour behind everything.
const BACKGROUND: [f64; 3] = [0.2, 0.3, 0.4];

/// Two surfaces that nearly touch.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DepthPrecisionWire {
    scene: DepthPrecisionScene,
    method: DepthPrecisionMethod,
    /// In `planes`, the distance from the nearer to the farther plane. In `slanted` and `decal`, the
    /// fraction of the distance by which the front surface is nearer.
    gap: f64,
    /// Distance of the near plane; the far plane is at 1000.
    #[serde(default = "usual_near")]
    near: f64,
}

fn usual_near() -> f64 {
    0.1
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum DepthPrecisionScene {
    /// Pairs of planes that face the viewer, at distances from 2 to 900.
    Planes,
    /// Two planes that lead away from the viewer, from 10 to 500.
    Slanted,
    /// A plane that leads away, with a decal on it without a gap, and a lid above both.
    Decal,
}

/// The depth buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum DepthPrecisionMethod {
    /// 16 bits, normalized.
    Depth16,
    /// At least 24 bits.
    Depth24,
    /// A 32-bit float.
    Depth32float,
    /// A 32-bit float that is 1 at the near and 0 at the far plane.
    ReversedDepth,
    /// At least 24 bits, and a far plane at infinity.
    InfiniteDepth,
    /// A 32-bit float that is 1 at the near plane and 0 at infinity.
    InfiniteReversedDepth,
    /// At least 24 bits of a depth that grows linearly with the distance.
    LinearDepth,
    /// At least 24 bits of a depth that grows with the logarithm of the distance.
    LogarithmicDepth,
    /// At least 24 bits, and a near plane ten times as far away.
    LargerNear,
    /// At least 24 bits, and decals pulled towards the viewer by one step and one slope.
    PolygonOffset,
}

/// The corners of a polygon in the picture, with the inverse of their distance instead of a depth: the inverse is
/// linear in the picture on a flat surface.
#[derive(Clone, Debug)]
struct Distant {
    corners: Vec<[f64; 3]>,
    color: [f64; 4],
    /// True if the surface is a decal on another surface.
    is_decal: bool,
}

impl Distant {
    /// Returns an upright rectangle whose top and bottom edges have these distances.
    fn new([left, top, right, bottom]: [f64; 4], distances: [f64; 2], color: [f64; 4]) -> Self {
        let [upper, lower] = distances.map(|d| 1.0 / d);
        Self {
            corners: vec![
                [left, top, upper],
                [left, bottom, lower],
                [right, bottom, lower],
                [right, top, upper],
            ],
            color,
            is_decal: false,
        }
    }

    fn surface(&self) -> FlatSurface {
        let corners = self
            .corners
            .iter()
            .map(|[x, y, inverse]| [*x, *y, -inverse]);
        Polygon::new(corners.collect(), self.color).surface()
    }
}

/// Returns the surfaces in drawing order; where two touch, the later one is in front.
fn surfaces(wire: &DepthPrecisionWire) -> Vec<Distant> {
    match wire.scene {
        DepthPrecisionScene::Planes => planes(wire.gap),
        DepthPrecisionScene::Slanted => slanted(wire.gap),
        DepthPrecisionScene::Decal => decal(wire.gap),
    }
}

const RIGHT: [f64; 4] = [0.25, 0.8, 0.35, 1.0];
const WRONG: [f64; 4] = [0.85, 0.15, 0.2, 1.0];

fn planes(gap: f64) -> Vec<Distant> {
    let distances = [2.0, 5.0, 12.0, 30.0, 70.0, 160.0, 380.0, 900.0];
    let mut quads = Vec::new();
    for (i, distance) in distances.into_iter().enumerate() {
        let left = 16.0 * i as f64;
        // A plane beyond the far plane would be invisible.
        let behind = (distance + gap).min(FAR);
        let pair = |top: f64| {
            let area = [left, top, left + 16.0, top + 64.0];
            let near = Distant::new(area, [distance; 2], RIGHT);
            [near, Distant::new(area, [behind; 2], WRONG)]
        };
        quads.extend(pair(0.0));
        let [near, far] = pair(64.0);
        quads.extend([far, near]);
    }
    quads
}

/// The distances at the top and at the bottom of a plane that leads away.
const LEADING: [f64; 2] = [500.0, 10.0];

fn slanted(gap: f64) -> Vec<Distant> {
    let nearer = LEADING.map(|d| d * (1.0 - gap));
    let pair = |left: f64| {
        let area = [left, 0.0, left + 64.0, 128.0];
        let above = Distant::new(area, nearer, RIGHT);
        [above, Distant::new(area, LEADING, WRONG)]
    };
    let [above, below] = pair(64.0);
    let mut quads = pair(0.0).to_vec();
    quads.extend([below, above]);
    quads
}

fn decal(gap: f64) -> Vec<Distant> {
    // The distance of the plane at a row. Its inverse is linear in the row.
    let distance_at = |row: f64| {
        let [top, bottom] = LEADING.map(f64::recip);
        (top + (bottom - top) * row / 128.0).recip()
    };
    let on_plane = |[left, top, right, bottom]: [f64; 4], lift: f64, color: [f64; 4]| {
        let distances = [top, bottom].map(|row| distance_at(row) * (1.0 - lift));
        Distant::new([left, top, right, bottom], distances, color)
    };
    let plane = on_plane([0.0, 0.0, 128.0, 128.0], 0.0, [0.55, 0.5, 0.45, 1.0]);
    let lid = on_plane([64.0, 0.0, 120.0, 128.0], gap, RIGHT);
    let mut decal = plane.clone();
    // The decal is turned, so that it shares no edge with the plane and its rounding differs.
    let turned = [[30.0, 10.0], [18.0, 100.0], [98.0, 118.0], [110.0, 28.0]];
    decal.corners = turned.map(|[x, y]| [x, y, distance_at(y).recip()]).to_vec();
    decal.color = [0.9, 0.8, 0.2, 1.0];
    decal.is_decal = true;
    vec![lid, plane, decal]
}

/// The depth buffer of a method.
struct DepthBuffer {
    format: TextureFormat,
    near: f64,
    /// The distance of the far plane, or infinity.
    far: f64,
    /// The distance of the far plane, which methods without one leave out.
    last: f64,
    reversed: bool,
    shader: Shader,
    bias: DepthBias,
}

impl DepthBuffer {
    /// Returns the depth buffer of a scene between two planes.
    fn new(method: DepthPrecisionMethod, [near, far]: [f64; 2]) -> Self {
        let usual = Self {
            format: TextureFormat::Depth24Plus,
            near,
            far,
            last: far,
            reversed: false,
            shader: Shader::FlatColor,
            bias: DepthBias::default(),
        };
        match method {
            DepthPrecisionMethod::Depth24 => usual,
            DepthPrecisionMethod::Depth16 => Self {
                format: TextureFormat::Depth16Unorm,
                ..usual
            },
            DepthPrecisionMethod::Depth32float => Self {
                format: TextureFormat::Depth32Float,
                ..usual
            },
            DepthPrecisionMethod::ReversedDepth => Self {
                format: TextureFormat::Depth32Float,
                reversed: true,
                ..usual
            },
            DepthPrecisionMethod::InfiniteDepth => Self {
                far: f64::INFINITY,
                ..usual
            },
            DepthPrecisionMethod::InfiniteReversedDepth => Self {
                format: TextureFormat::Depth32Float,
                far: f64::INFINITY,
                reversed: true,
                ..usual
            },
            DepthPrecisionMethod::LinearDepth => Self {
                shader: Shader::LinearDepth,
                ..usual
            },
            DepthPrecisionMethod::LogarithmicDepth => Self {
                shader: Shader::LogarithmicDepth,
                ..usual
            },
            DepthPrecisionMethod::LargerNear => Self {
                near: near * 10.0,
                ..usual
            },
            DepthPrecisionMethod::PolygonOffset => Self {
                bias: DepthBias {
                    constant: -1,
                    slope: -1.0,
                    clamp: 0.0,
                },
                ..usual
            },
        }
    }

    /// Returns the window depth of a distance.
    fn depth(&self, distance: f64) -> f64 {
        let nearness = self.near / distance;
        match (self.far.is_infinite(), self.reversed) {
            (true, true) => nearness,
            (true, false) => 1.0 - nearness,
            // Near and far are exchanged, so that distant points have small depths, for which floats are
            // precise.
            (false, true) => window_depth(distance, [self.far, self.near]),
            (false, false) => window_depth(distance, [self.near, self.far]),
        }
    }

    fn polygon(&self, surface: &Distant) -> Polygon {
        let corners = surface.corners.iter();
        let corners = corners.map(|[x, y, inverse]| [*x, *y, self.depth(inverse.recip())]);
        let mut polygon = Polygon::new(corners.collect(), surface.color);
        polygon.w = surface.corners.iter().map(|c| c[2].recip()).collect();
        polygon
    }

    fn draw(&self, size: [u32; 2], polygons: &[Polygon], is_decal: bool) -> Draw {
        let mut draw = stage::draw(self.shader, polygon::mesh(size, polygons));
        // Surfaces that round to the far plane must still be drawn.
        let compare = if self.reversed {
            CompareFunction::GreaterEqual
        } else {
            CompareFunction::LessEqual
        };
        draw.depth = stage::depth(compare, true);
        if is_decal {
            draw.depth_bias = self.bias;
        }
        let octaves = (self.last / self.near).log2();
        draw.params.color = [self.near, self.last, octaves.recip(), 0.0].map(|v| v as f32);
        draw
    }
}

pub(crate) fn make(wire: &DepthPrecisionWire) -> Result<MethodScene, ParameterError> {
    let most = match wire.scene {
        DepthPrecisionScene::Planes => 100.0,
        DepthPrecisionScene::Slanted | DepthPrecisionScene::Decal => 0.5,
    };
    within("gap", wire.gap, 1e-9..=most)?;
    within("near", wire.near, 1e-6..=50.0)?;
    let offset = wire.method == DepthPrecisionMethod::PolygonOffset;
    if offset && wire.scene != DepthPrecisionScene::Decal {
        let message = "`polygon-offset` is for the scene `decal`";
        return Err(ParameterError::new("method", message));
    }
    let buffer = DepthBuffer::new(wire.method, [wire.near, FAR]);
    let (surfaces, size) = (surfaces(wire), SIZE);
    Ok(drawn(&surfaces, &buffer, size, BACKGROUND))
}

/// The methods that draw a model. They need no decals.
pub(crate) const MODEL_METHODS: [&str; 9] = [
    "depth16",
    "depth24",
    "depth32float",
    "reversed-depth",
    "infinite-depth",
    "infinite-reversed-depth",
    "linear-depth",
    "logarithmic-depth",
    "larger-near",
];

/// Draws what a model's camera sees between these planes by the method of this name; `None` if there is no such method.
pub(crate) fn of_model(
    seen: &SeenModel,
    [near, far]: [f64; 2],
    method: &str,
) -> Option<MethodScene> {
    let method = MODEL_METHODS.contains(&method).then(|| named(method))??;
    let far = if far.is_finite() { far } else { seen.planes[1] };
    let surfaces: Vec<Distant> = seen
        .opaque
        .iter()
        .map(|polygon| Distant {
            corners: polygon
                .corners
                .iter()
                .map(|[x, y, z]| [*x, *y, distance(*z, seen.planes).recip()])
                .collect(),
            color: polygon.color,
            is_decal: false,
        })
        .collect();
    let buffer = DepthBuffer::new(method, [near, far]);
    Some(drawn(&surfaces, &buffer, seen.size, seen.background))
}

fn drawn(
    surfaces: &[Distant],
    buffer: &DepthBuffer,
    size: [u32; 2],
    background: [f64; 3],
) -> MethodScene {
    let mut stage = Stage::new();
    let [r, g, b] = background;
    let picture = stage.color("picture", TextureFormat::Rgba8Unorm, size, [r, g, b, 1.0]);
    let clear = if buffer.reversed { 0.0 } else { 1.0 };
    let depth = stage.depth("depth", buffer.format, size, 1, clear);
    let draws = [false, true].into_iter().filter_map(|is_decal| {
        let some = surfaces.iter().filter(|s| s.is_decal == is_decal);
        let polygons: Vec<Polygon> = some.map(|s| buffer.polygon(s)).collect();
        (!polygons.is_empty()).then(|| buffer.draw(size, &polygons, is_decal))
    });
    stage.pass(&[picture], Some(depth), draws.collect());
    let truth = Truth {
        size,
        background,
        coverage: TexelCoverage::Center,
        surfaces: surfaces.iter().map(Distant::surface).collect(),
    };
    MethodScene {
        scene: stage.read(&[picture]),
        truth,
    }
}
