//! Cut-outs: textures with holes, on cards of grass.

use crate::error::{ParameterError, within};
use crate::hashed_plane::{cells_per_texel, place};
use crate::method_scene::MethodScene;
use crate::noise::Noise;
use crate::polygon::{Polygon, mesh};
use crate::stage::{SIZE, Stage, depth, draw, over};
use crate::truth::{FlatSurface, Paint, StraightTexture, TexelCoverage, Truth};
use etalon_frame::TextureFormat;
use etalon_scene::{
    AddressMode, AttachmentContents, CompareFunction, Draw, FilterMode, Params, Sampler, Scene,
    Shader,
};
use schemars::JsonSchema;
use serde::Deserialize;

mod claims;
mod lessons;
#[cfg(test)]
mod tests;

pub(crate) use claims::CLAIMS;
pub(crate) use lessons::LESSONS;

/// Cards of grass and how they are drawn.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    /// The scene.
    pub(crate) scene: SceneName,
    /// The method.
    pub(crate) method: MethodName,
    /// The texture's content beyond its border, which the cards reach.
    #[serde(default = "clamp")]
    pub(crate) address: AddressMode,
    /// The size of a texture's texel in texels of the picture, 0.25 to 4.
    pub(crate) scale: Option<f64>,
    /// The alpha below which a fragment is discarded, 0.01 to 0.99.
    pub(crate) cutoff: Option<f64>,
}

/// The scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SceneName {
    /// Rows of pairs of crossed cards, each with the same texture of blades.
    Grass,
}

/// The method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum MethodName {
    /// Opaque if the filtered alpha reaches `cutoff`, otherwise discarded.
    Discard,
    /// Blended card by card, farthest first, by the mean depth of the corners.
    BlendSorted,
    /// Opaque if the filtered alpha is at least a hash of the place on the card (Wyman and McGuire 2017).
    Hashed,
    /// Opaque in some of four samples; their number follows alpha.
    AlphaToCoverage,
    /// Like `alpha-to-coverage`, with alpha sharpened around `cutoff` to the width of a texel (Golus 2017).
    AlphaToCoverageSharpened,
}

fn clamp() -> AddressMode {
    AddressMode::ClampToEdge
}

/// Draws the scene by the method.
///
/// # Errors
/// If a parameter is out of its range.
pub(crate) fn make(wire: &Wire) -> Result<MethodScene, ParameterError> {
    let scale = within("scale", wire.scale.unwrap_or(1.0), 0.25..=4.0)?;
    let cutoff = within("cutoff", wire.cutoff.unwrap_or(0.5), 0.01..=0.99)?;
    let SceneName::Grass = wire.scene;
    let cards = cards(scale);
    let scene = match wire.method {
        MethodName::Discard => discard(&cards, wire.address, cutoff),
        MethodName::BlendSorted => blend_sorted(&cards, wire.address),
        MethodName::Hashed => hashed(&cards, wire.address),
        MethodName::AlphaToCoverage => {
            let draw =
                |stage: &mut Stage| textured(stage, Shader::SampledColor, &cards, wire.address);
            alpha_to_coverage(draw)
        }
        MethodName::AlphaToCoverageSharpened => alpha_to_coverage(|stage| {
            let mut draw = textured(stage, Shader::SharpenedSample, &cards, wire.address);
            draw.params = at_cutoff(cutoff);
            draw
        }),
    };
    Ok(MethodScene {
        scene,
        truth: truth(&cards),
    })
}

/// Red, green and blue behind the grass.
const BACKGROUND: [f64; 3] = [0.6, 0.75, 0.9];

const PICTURE: TextureFormat = TextureFormat::Rgba8Unorm;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// Width and height of the texture.
const TEXTURE: u32 = 32;

/// Blades on it.
const BLADES: u32 = 7;

/// Returns the texture's codes: blades on a full row of roots, transparent at the top. Transparent texels
/// have the colour of the blades, so that filtering brings in no other colour.
fn grass() -> Vec<[u32; 4]> {
    let mut noise = Noise::new(7);
    let side = f64::from(TEXTURE);
    let blades: Vec<[f64; 4]> = (0..BLADES)
        .map(|i| {
            let root = side * (f64::from(i) + 0.5) / f64::from(BLADES);
            let bend = noise.between(-4.0, 4.0);
            [
                root,
                bend,
                noise.between(0.6, 0.92),
                noise.between(1.3, 2.2),
            ]
        })
        .collect();
    let mut texels = Vec::new();
    for (row, column) in (0..TEXTURE).flat_map(|r| (0..TEXTURE).map(move |c| (r, c))) {
        let (x, up) = (f64::from(column) + 0.5, 1.0 - (f64::from(row) + 0.5) / side);
        let blade = |[root, bend, height, width]: &[f64; 4]| {
            let middle = root + bend * up * up;
            let half = width * (1.0 - up / height);
            let below_tip = (height - up) * side;
            let inside = (half - (x - middle).abs()).min(below_tip);
            (inside + 0.5).clamp(0.0, 1.0)
        };
        // The lowest rows are full from side to side.
        let roots = (1.5 - f64::from(TEXTURE - 1 - row) / 2.0).clamp(0.0, 1.0);
        let alpha = blades.iter().map(blade).fold(roots, f64::max);
        let color = [0.15 + 0.45 * up, 0.4 + 0.5 * up, 0.1, alpha];
        texels.push(color.map(|v| (v * 255.0).round() as u32));
    }
    texels
}

/// Returns crossed cards in rows; lower rows are nearer.
fn cards(scale: f64) -> Vec<Polygon> {
    let side = f64::from(TEXTURE) * scale;
    let count = (f64::from(SIZE[0]) / side).ceil().max(1.0) as u32;
    let mut noise = Noise::new(11);
    let mut cards = Vec::new();
    for (row, column) in (0..count).flat_map(|r| (0..count).map(move |c| (r, c))) {
        let [left, top] = [column, row].map(|v| f64::from(v) * side);
        let depth = 0.9 - 0.8 * (f64::from(row) + noise.next() * 0.5 + 0.25) / f64::from(count);
        let tilt = 0.1 / f64::from(count);
        // Of two cards that cross at a right angle, one appears wider than the other, and they lean back in
        // opposite directions. Their borders are on texel borders.
        let narrow = [left + side * 0.25, top, left + side * 0.75, top + side];
        let wide = [left, top, left + side, top + side];
        cards.push(card(narrow, [depth - tilt, depth + tilt]));
        cards.push(card(wide, [depth + tilt, depth - tilt]));
    }
    cards
}

/// Returns a card with one depth at its left edge and another at its right edge.
fn card(rect: [f64; 4], [left, right]: [f64; 2]) -> Polygon {
    let mut card = Polygon::rect(rect, left, [1.0; 4]);
    for corner in &mut card.corners[2..] {
        corner[2] = right;
    }
    card.uv = vec![[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    card
}

/// Returns the cards with their texture clamped at its border, whatever the sampler does, because this is
/// the texture as painted.
fn truth(cards: &[Polygon]) -> Truth {
    let texture = StraightTexture {
        size: [TEXTURE; 2],
        texels: grass()
            .iter()
            .map(|t| t.map(|code| f64::from(code) / 255.0))
            .collect(),
        address: [AddressMode::ClampToEdge; 2],
    };
    let surface = |card: &Polygon| FlatSurface {
        corners: card.corners.clone(),
        paint: Paint::Texture {
            texture: texture.clone(),
            uv: card.uv.clone(),
        },
    };
    Truth {
        size: SIZE,
        background: BACKGROUND,
        coverage: TexelCoverage::Area,
        surfaces: cards.iter().map(surface).collect(),
    }
}

fn clear() -> [f64; 4] {
    let [r, g, b] = BACKGROUND;
    [r, g, b, 1.0]
}

/// Adds the texture, and returns a draw of the cards with it.
fn textured(stage: &mut Stage, shader: Shader, cards: &[Polygon], address: AddressMode) -> Draw {
    let contents = AttachmentContents::Texels(grass().concat());
    let texture = stage.attachment(
        "grass",
        TextureFormat::Rgba8Unorm,
        [TEXTURE; 2],
        1,
        contents,
    );
    let mut draw = draw(shader, mesh(SIZE, cards));
    draw.textures = vec![texture];
    draw.sampler = Some(Sampler {
        filter: FilterMode::Linear,
        address: [address; 2],
    });
    draw
}

/// Returns parameters with a cutoff of alpha.
fn at_cutoff(cutoff: f64) -> Params {
    Params {
        color: [0.0, 0.0, 0.0, cutoff as f32],
        back_color: [0.0; 4],
    }
}

fn discard(cards: &[Polygon], address: AddressMode, cutoff: f64) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear());
    let depth_stencil = stage.depth("depth", DEPTH, SIZE, 1, 1.0);
    let mut draw = textured(&mut stage, Shader::SampledDiscard, cards, address);
    draw.params = at_cutoff(cutoff);
    draw.depth = depth(CompareFunction::Less, true);
    stage.pass(&[picture], Some(depth_stencil), vec![draw]);
    stage.read(&[picture])
}

fn hashed(cards: &[Polygon], address: AddressMode) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear());
    let depth_stencil = stage.depth("depth", DEPTH, SIZE, 1, 1.0);
    let placed: Vec<Polygon> = (0..).zip(cards).map(placed).collect();
    let mut draw = textured(&mut stage, Shader::HashedSample, &placed, address);
    draw.params = cells_per_texel(SIZE);
    draw.depth = depth(CompareFunction::Less, true);
    stage.pass(&[picture], Some(depth_stencil), vec![draw]);
    stage.read(&[picture])
}

/// Returns the card with its size and its own place in the hashed plane as its colour, in widths of the picture.
fn placed((number, card): (usize, &Polygon)) -> Polygon {
    let [near, far] = [card.corners[0], card.corners[2]];
    let [width, height] = [0, 1].map(|axis| (far[axis] - near[axis]) / f64::from(SIZE[axis]));
    let [column, row] = place(number);
    Polygon {
        color: [width, height, column, row],
        ..card.clone()
    }
}

/// Returns the cards, farthest first.
fn sorted(cards: &[Polygon]) -> Vec<Polygon> {
    let mut sorted = cards.to_vec();
    let depth = |card: &Polygon| card.corners.iter().map(|c| c[2]).sum::<f64>();
    sorted.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    sorted
}

fn blend_sorted(cards: &[Polygon], address: AddressMode) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear());
    let mut draw = textured(&mut stage, Shader::SampledColor, &sorted(cards), address);
    draw.targets[0].blend = over();
    stage.pass(&[picture], None, vec![draw]);
    stage.read(&[picture])
}

/// Covers a number of samples that follows the alpha of a draw.
fn alpha_to_coverage(cards: impl Fn(&mut Stage) -> Draw) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear());
    let contents = AttachmentContents::Color(clear().map(|c| c as f32));
    let samples = stage.attachment("samples", PICTURE, SIZE, 4, contents);
    let depth_stencil = stage.depth("depth", DEPTH, SIZE, 4, 1.0);
    let mut draw = cards(&mut stage);
    draw.depth = depth(CompareFunction::Less, true);
    draw.multisample.alpha_to_coverage = true;
    stage.resolving_pass(
        &[samples],
        vec![Some(picture)],
        Some(depth_stencil),
        vec![draw],
    );
    stage.read(&[picture])
}
