//! Depth shown by formulas that have one right result: as grey, as distance and as fog. Also, two pictures
//! that dissolve into each other.

mod lessons;

pub(crate) use lessons::LESSONS;

use crate::error::{ParameterError, within};
use crate::method_scene::MethodScene;
use crate::polygon::{self, Polygon};
use crate::stage::{self, SIZE, Stage};
use crate::truth::{FlatSurface, Paint, TexelCoverage, Truth};
use crate::view::window_depth;
use etalon_frame::TextureFormat;
use etalon_scene::{AttachmentContents, BlendFactor, CompareFunction, Shader};
use schemars::JsonSchema;
use serde::Deserialize;

/// The distance of the far plane.
const FAR: f64 = 1000.0;

/// The colour of fog.
const FOG: [f64; 3] = [0.75, 0.8, 0.9];

/// Cells per picture that dissolves, across and down.
const CELLS: u32 = 16;

/// A scene of depth or of a dissolve.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "scene", rename_all = "kebab-case", deny_unknown_fields)]
pub enum DepthShownWire {
    /// Planes at a slant, from 12 to 900.
    Slanted {
        /// Depth shown as a colour.
        method: DepthMethod,
        /// The distance of the near plane, 0.0001 to 10; the far plane is at 1000. A nearer plane moves all
        /// depths closer to 1, so that they say less about the distance.
        near: f64,
    },
    /// Two pictures; the second is blended over the first.
    Pictures {
        /// The method.
        method: DissolveMethod,
        /// The weight of the second picture, 0 to 1.
        t: f64,
    },
}

/// Depth shown as a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DepthMethod {
    /// The window depth as grey.
    Grey,
    /// The distance as grey, 0 at the near plane and 1 at the far plane.
    Linearized,
    /// The surface's colour, which fades to the colour of fog with the distance.
    Fog,
}

/// The mixing of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DissolveMethod {
    /// The blend constant is the weight of the second picture, and 1 minus the constant that of the first.
    Dissolve,
}

pub(crate) fn make(wire: &DepthShownWire) -> Result<MethodScene, ParameterError> {
    match *wire {
        DepthShownWire::Slanted { method, near } => {
            within("near", near, 1e-4..=10.0)?;
            Ok(slanted(method, near))
        }
        DepthShownWire::Pictures {
            method: DissolveMethod::Dissolve,
            t,
        } => {
            within("t", t, 0.0..=1.0)?;
            Ok(dissolve(t))
        }
    }
}

/// Returns planes that do not meet. Each is defined by its left, top, right and bottom, the distances at
/// three corners counter-clockwise from the top left, and a colour. The inverse of the distance is linear
/// in the picture, so that the distance of the last corner follows from the others.
fn planes(near: f64) -> Vec<Polygon> {
    let plane = |[left, top, right, bottom]: [f64; 4], distances: [f64; 3], color: [f64; 3]| {
        let [a, b, c] = distances.map(|d| window_depth(d, [near, FAR]));
        let [red, green, blue] = color;
        let corners = vec![
            [left, top, a],
            [left, bottom, b],
            [right, bottom, c],
            [right, top, a + c - b],
        ];
        Polygon::new(corners, [red, green, blue, 1.0])
    };
    vec![
        plane(
            [0.0, 0.0, 128.0, 128.0],
            [900.0, 150.0, 150.0],
            [0.4, 0.5, 0.3],
        ),
        plane(
            [8.0, 16.0, 48.0, 120.0],
            [140.0, 100.0, 30.0],
            [0.8, 0.3, 0.2],
        ),
        plane(
            [40.0, 40.0, 120.0, 64.0],
            [25.0, 25.0, 90.0],
            [0.2, 0.3, 0.8],
        ),
        plane(
            [64.0, 72.0, 116.0, 124.0],
            [80.0, 12.0, 18.0],
            [0.9, 0.8, 0.2],
        ),
    ]
}

fn slanted(method: DepthMethod, near: f64) -> MethodScene {
    let polygons = planes(near);
    let shader = match method {
        DepthMethod::Grey => Shader::DepthGrey,
        DepthMethod::Linearized => Shader::DepthLinearized,
        DepthMethod::Fog => Shader::Fog,
    };
    let mut draw = stage::draw(shader, polygon::mesh(SIZE, &polygons));
    // Surfaces that round to the far plane must still be drawn.
    draw.depth = stage::depth(CompareFunction::LessEqual, true);
    draw.params.color = [near as f32, FAR as f32, 0.0, 0.0];
    draw.params.back_color = [FOG[0], FOG[1], FOG[2], 1.0].map(|v| v as f32);
    let mut stage = Stage::new();
    let format = TextureFormat::Rgba8Unorm;
    let picture = stage.color("picture", format, SIZE, [0.0, 0.0, 0.0, 1.0]);
    let depth = stage.depth("depth", TextureFormat::Depth32Float, SIZE, 1, 1.0);
    stage.pass(&[picture], Some(depth), vec![draw]);
    let surface = |polygon: &Polygon| {
        let [red, green, blue, _] = polygon.color;
        FlatSurface {
            corners: polygon.corners.clone(),
            paint: match method {
                DepthMethod::Grey => Paint::Depth,
                DepthMethod::Linearized => Paint::Distance { near, far: FAR },
                DepthMethod::Fog => Paint::Fog {
                    color: [red, green, blue],
                    fog: FOG,
                    near,
                    far: FAR,
                },
            },
        }
    };
    let surfaces = polygons.iter().map(surface).collect();
    made(stage, picture, surfaces)
}

/// Returns a scene with this picture and its surfaces, over black.
fn made(stage: Stage, picture: usize, surfaces: Vec<FlatSurface>) -> MethodScene {
    MethodScene {
        scene: stage.read(&[picture]),
        truth: Truth {
            size: SIZE,
            background: [0.0; 3],
            coverage: TexelCoverage::Center,
            surfaces,
        },
    }
}

/// Returns the codes of a picture's cell: of a sunset, or of a board.
fn cell(picture: usize, x: u32, y: u32) -> [u32; 3] {
    match picture {
        0 => [255 - y * 8, 60 + y * 9, 20 + x * 14],
        _ => match (x + y) % 2 {
            0 => [17 * x, 255 - 17 * y, 128],
            _ => [y * 3, x * 5, 255 - 17 * x],
        },
    }
}

fn dissolve(t: f64) -> MethodScene {
    let texels_of_cell = SIZE[0] / CELLS;
    let mut stage = Stage::new();
    let format = TextureFormat::Rgba8Unorm;
    let picture = stage.color("picture", format, SIZE, [0.0, 0.0, 0.0, 1.0]);
    let mut draws = Vec::new();
    let mut surfaces = Vec::new();
    for (i, name) in ["first", "second"].into_iter().enumerate() {
        let codes = |texel: u32| {
            let [x, y] = [texel % SIZE[0], texel / SIZE[0]].map(|c| c / texels_of_cell);
            let [r, g, b] = cell(i, x, y);
            [r, g, b, 255]
        };
        let codes = (0..SIZE[0] * SIZE[1]).flat_map(codes).collect();
        let texture = stage.attachment(name, format, SIZE, 1, AttachmentContents::Texels(codes));
        let mut draw = stage::draw(Shader::TexelColor, polygon::cover());
        draw.textures = vec![texture];
        if i == 1 {
            let mix = stage::add(BlendFactor::Constant, BlendFactor::OneMinusConstant);
            draw.targets[0].blend = stage::both(mix);
            draw.blend_constant = [t as f32; 4];
        }
        draws.push(draw);
        let alpha = if i == 1 { t } else { 1.0 };
        for (x, y) in (0..CELLS).flat_map(|y| (0..CELLS).map(move |x| (x, y))) {
            let [r, g, b] = cell(i, x, y).map(|code| f64::from(code) / 255.0);
            let [left, top] = [x, y].map(|c| f64::from(c * texels_of_cell));
            let side = f64::from(texels_of_cell);
            let area = [left, top, left + side, top + side];
            let depth = 0.5 - 0.25 * i as f64;
            surfaces.push(Polygon::rect(area, depth, [r, g, b, alpha]).surface());
        }
    }
    stage.pass(&[picture], None, draws);
    made(stage, picture, surfaces)
}
