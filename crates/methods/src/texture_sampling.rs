//! Texture sampling: a ground of tiles that reaches the horizon, one tile per texel, without mipmaps.
//!
//! The ground is one rectangle that begins behind the eye. The driver clips it, divides by w and
//! interpolates texture coordinates; the truth has the corners of every tile.

use crate::error::{ParameterError, within};
use crate::method_scene::MethodScene;
use crate::noise::Noise;
use crate::polygon::Polygon;
use crate::stage::{SIZE, Stage, draw};
use crate::truth::{TexelCoverage, Truth};
use crate::view::{Face, View};
use etalon_frame::TextureFormat;
use etalon_scene::{
    AddressMode, AttachmentContents, Draw, FilterMode, Mesh, Sampler, Shader, Vertex,
};
use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

mod claims;
mod lessons;
#[cfg(test)]
mod tests;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;

/// A textured surface and how it is drawn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    scene: SceneName,
    method: MethodName,
    /// Tiles per unit of distance, 0.25 to 4; the eye is one unit above them.
    tiles: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum SceneName {
    /// A ground of tiles from behind the eye to far away.
    Ground,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum MethodName {
    /// The texel at the centre of the picture's texel.
    Nearest,
    /// The weighted mean of the four texels around it.
    Linear,
    /// Nearest texels at coordinates that are linear in the picture, in two triangles that begin at the
    /// nearest visible row.
    Affine,
    /// The mean of 2 by 2 nearest texels.
    #[serde(rename = "supersampling-2x2")]
    Supersampling2x2,
    /// The mean of 4 by 4 nearest texels, in two steps.
    #[serde(rename = "supersampling-4x4")]
    Supersampling4x4,
}

/// The colour of the sky.
const BACKGROUND: [f64; 3] = [0.55, 0.7, 0.9];

/// Half the ground's width.
const HALF_WIDTH: f64 = 12.0;

/// The z of the ground's ends: behind the eye, and in front of it.
const ENDS: [f64; 2] = [4.0, -28.0];

/// The z of the nearest visible row, or slightly nearer.
const NEAREST: f64 = -0.9;

/// Width and height of the texture, which repeats.
const TEXTURE: u32 = 8;

/// Returns the camera: one unit above the ground, tilted down.
fn view() -> View {
    let eye = DVec3::new(0.0, 1.0, 0.0);
    let target = eye + DVec3::new(0.0, -0.3, -1.0);
    View::perspective(SIZE, [eye, target], 60.0, [0.1, 100.0])
}

/// Returns the codes of the texture's texels: a checkerboard of stone.
fn tiles() -> Vec<[u32; 4]> {
    let mut noise = Noise::new(5);
    let places = (0..TEXTURE).flat_map(|row| (0..TEXTURE).map(move |column| (row, column)));
    let texel = |(row, column): (u32, u32)| {
        let base = if (row + column).is_multiple_of(2) {
            [0.85, 0.8, 0.7]
        } else {
            [0.3, 0.25, 0.25]
        };
        let tone = noise.between(0.8, 1.1);
        let code = |v: f64| (v * tone * 255.0).round() as u32;
        [code(base[0]), code(base[1]), code(base[2]), 255]
    };
    places.map(texel).collect()
}

/// Returns a point of the ground with its texture coordinates.
fn corner(x: f64, z: f64, tiles: f64) -> (DVec3, [f64; 2]) {
    let turns = [x + HALF_WIDTH, ENDS[0] - z].map(|v| v * tiles / f64::from(TEXTURE));
    (DVec3::new(x, 0.0, z), turns)
}

/// Returns the ground between two z as two triangles, in clip space or projected with w 1.
fn ground(ends: [f64; 2], tiles: f64, divided: bool) -> Mesh {
    let view = view();
    let [near, far] = ends;
    let vertex = |x: f64, z: f64| {
        let (point, uv) = corner(x, z, tiles);
        let [x, y, z, w] = view.clip_position(point);
        let by = if divided { w } else { 1.0 };
        Vertex {
            position: [x, y, z, w].map(|v| (v / by) as f32),
            color: [1.0; 4],
            uv: uv.map(|v| v as f32),
        }
    };
    let (left, right) = (-HALF_WIDTH, HALF_WIDTH);
    let [a, b, c, d] = [(left, near), (right, near), (right, far), (left, far)];
    Mesh {
        vertices: [a, b, c, a, c, d].map(|(x, z)| vertex(x, z)).to_vec(),
        indices: None,
    }
}

/// Returns the visible tiles.
fn seen(per_unit: f64) -> Vec<Polygon> {
    let count = |length: f64| (length * per_unit).ceil() as u32;
    let texels = tiles();
    let mut faces = Vec::new();
    for row in 0..count(ENDS[0] - ENDS[1]) {
        for column in 0..count(2.0 * HALF_WIDTH) {
            let texel = texels[((row % TEXTURE) * TEXTURE + column % TEXTURE) as usize];
            let x = |n: u32| (f64::from(n) / per_unit - HALF_WIDTH).min(HALF_WIDTH);
            let z = |n: u32| (ENDS[0] - f64::from(n) / per_unit).max(ENDS[1]);
            let point = |c: u32, r: u32| DVec3::new(x(c), 0.0, z(r));
            let (column_after, row_after) = (column + 1, row + 1);
            faces.push(Face {
                corners: vec![
                    point(column, row),
                    point(column_after, row),
                    point(column_after, row_after),
                    point(column, row_after),
                ],
                color: texel.map(|code| f64::from(code) / 255.0),
            });
        }
    }
    view().see(&faces)
}

/// Returns a draw of the ground with its texture.
fn textured(stage: &mut Stage, mesh: Mesh, filter: FilterMode) -> Draw {
    let contents = AttachmentContents::Texels(tiles().concat());
    let format = TextureFormat::Rgba8Unorm;
    let texture = stage.attachment("tiles", format, [TEXTURE; 2], 1, contents);
    let mut draw = draw(Shader::SampledColor, mesh);
    draw.textures = vec![texture];
    draw.sampler = Some(Sampler {
        filter,
        address: [AddressMode::Repeat; 2],
    });
    draw
}

/// Draws the scene by the method.
///
/// # Errors
/// If a parameter is out of its range.
pub(crate) fn make(wire: &Wire) -> Result<MethodScene, ParameterError> {
    let tiles = within("tiles", wire.tiles, 0.25..=4.0)?;
    let SceneName::Ground = wire.scene;
    let [r, g, b] = BACKGROUND;
    let clear = [r, g, b, 1.0];
    let mut stage = Stage::new();
    let picture = stage.color("picture", TextureFormat::Rgba8Unorm, SIZE, clear);
    let full_ground = ground(ENDS, tiles, false);
    let (mesh, filter, doublings) = match wire.method {
        MethodName::Nearest => (full_ground, FilterMode::Nearest, 0),
        MethodName::Linear => (full_ground, FilterMode::Linear, 0),
        MethodName::Affine => {
            let mesh = ground([NEAREST, ENDS[1]], tiles, true);
            (mesh, FilterMode::Nearest, 0)
        }
        MethodName::Supersampling2x2 => (full_ground, FilterMode::Nearest, 1),
        MethodName::Supersampling4x4 => (full_ground, FilterMode::Nearest, 2),
    };
    let draw = textured(&mut stage, mesh, filter);
    stage.supersampled(picture, clear, doublings, draw);
    Ok(MethodScene {
        scene: stage.read(&[picture]),
        truth: Truth {
            size: SIZE,
            background: BACKGROUND,
            coverage: TexelCoverage::Area,
            surfaces: seen(tiles).iter().map(Polygon::surface).collect(),
        },
    })
}
