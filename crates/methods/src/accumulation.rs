//! Accumulated rounding: the same colour blended over a background again and again.
//!
//! After `n` layers of alpha `a`, the background has the weight `(1 - a)^n` and the colour has the rest.
//! Each intermediate result is rounded when it is stored. A difference from the colour of less than half a
//! code over `a` therefore never disappears.

mod claims;
mod lessons;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;

use crate::error::{ParameterError, within};
use crate::method_scene::MethodScene;
use crate::polygon::{self, Polygon};
use crate::stage::{self, Stage};
use crate::truth::{TexelCoverage, Truth};
use etalon_frame::TextureFormat;
use etalon_scene::Shader;
use schemars::JsonSchema;
use serde::Deserialize;

/// The maximum number of layers.
const MOST: u32 = 1024;

/// The number of columns of colours and of rows of backgrounds; each is 2 texels wide.
const CELLS: u32 = 16;

/// Width and height of the picture. A few texels per pair of colour and background are enough.
const SIZE: [u32; 2] = [2 * CELLS, 2 * CELLS];

/// Layers over a background.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AccumulationWire {
    scene: AccumulationScene,
    method: AccumulationMethod,
    /// The number of layers, 1 to 1024.
    layers: u32,
    /// The alpha of the layers, above 0 and up to 1.
    alpha: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum AccumulationScene {
    /// Sixteen colours in columns over sixteen backgrounds in rows.
    Columns,
}

/// The format in which layers are blended, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
enum AccumulationMethod {
    /// `rgba8unorm`.
    #[serde(rename = "ordered-8-bit")]
    Bits8,
    /// `rgb10a2unorm`.
    #[serde(rename = "ordered-10-bit")]
    Bits10,
    /// `rgba16float`.
    #[serde(rename = "ordered-half")]
    Half,
    /// `rgba32float`.
    #[serde(rename = "ordered-float")]
    Float,
}

impl AccumulationMethod {
    fn format(self) -> TextureFormat {
        match self {
            Self::Bits8 => TextureFormat::Rgba8Unorm,
            Self::Bits10 => TextureFormat::Rgb10a2Unorm,
            Self::Half => TextureFormat::Rgba16Float,
            Self::Float => TextureFormat::Rgba32Float,
        }
    }
}

/// Returns the background of a row: a multiple of a fifteenth, which 8 and 10 bits store exactly or nearly
/// so.
fn background(row: u32) -> [f64; 4] {
    let v = |step: u32| f64::from((row * step + 2) % CELLS) / 15.0;
    [v(1), v(7), v(11), 1.0]
}

/// Returns the colour of a column.
fn color(column: u32, alpha: f64) -> [f64; 4] {
    let v = |step: u32, start: u32| (f64::from((column * step + start) % CELLS) + 0.3) / 16.0;
    [v(5, 0), v(3, 6), v(13, 11), alpha]
}

fn columns(alpha: f64) -> Vec<Polygon> {
    let [width, height] = SIZE.map(f64::from);
    let cell = width / f64::from(CELLS);
    let column = |i: u32| {
        let left = f64::from(i) * cell;
        Polygon::rect([left, 0.0, left + cell, height], 0.25, color(i, alpha))
    };
    (0..CELLS).map(column).collect()
}

fn rows() -> Vec<Polygon> {
    let [width, height] = SIZE.map(f64::from);
    let cell = height / f64::from(CELLS);
    let row = |i: u32| {
        let top = f64::from(i) * cell;
        Polygon::rect([0.0, top, width, top + cell], 0.75, background(i))
    };
    (0..CELLS).map(row).collect()
}

pub(crate) fn make(wire: &AccumulationWire) -> Result<MethodScene, ParameterError> {
    let AccumulationWire {
        scene: AccumulationScene::Columns,
        method,
        layers,
        alpha,
    } = *wire;
    within("layers", layers.into(), 1.0..=MOST.into())?;
    within("alpha", alpha, 1e-4..=1.0)?;
    let mut stage = Stage::new();
    let picture = stage.color("picture", method.format(), SIZE, [0.0, 0.0, 0.0, 1.0]);
    let back = rows();
    let front = columns(alpha);
    let mut draws = vec![stage::draw(Shader::FlatColor, polygon::mesh(SIZE, &back))];
    let polygons: Vec<Polygon> = (0..layers).flat_map(|_| front.iter().cloned()).collect();
    let mut layered = stage::draw(Shader::FlatColor, polygon::mesh(SIZE, &polygons));
    layered.targets[0].blend = stage::over();
    draws.push(layered);
    stage.pass(&[picture], None, draws);
    // One layer that lets through as much light as all layers of a colour together.
    let together = 1.0 - (1.0 - alpha).powf(layers.into());
    let seen = columns(together);
    let truth = Truth {
        size: SIZE,
        background: [0.0; 3],
        coverage: TexelCoverage::Center,
        surfaces: back.iter().chain(&seen).map(Polygon::surface).collect(),
    };
    Ok(MethodScene {
        scene: stage.read(&[picture]),
        truth,
    })
}
