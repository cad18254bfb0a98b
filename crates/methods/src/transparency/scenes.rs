//! Transparent scenes.

use super::wire::{TransparencyScene, TransparencyWire};
use crate::error::{ParameterError, within};
use crate::grid::settle_whole;
use crate::noise::Noise;
use crate::polygon::Polygon;
use crate::stage::SIZE;
use crate::truth::{TexelCoverage, Truth};

/// Polygons that are sorted as a whole.
#[derive(Clone, Debug)]
pub(super) struct Object {
    /// The object's faces, in drawing order.
    pub(super) polygons: Vec<Polygon>,
}

impl Object {
    /// Returns the mean depth of its corners.
    pub(super) fn depth(&self) -> f64 {
        let corners = || self.polygons.iter().flat_map(|p| &p.corners);
        corners().map(|c| c[2]).sum::<f64>() / corners().count() as f64
    }
}

/// A scene of opaque polygons and transparent objects, not sorted yet.
#[derive(Clone, Debug)]
pub(super) struct GlassScene {
    /// Width and height of the picture in texels.
    pub(super) size: [u32; 2],
    /// Red, green and blue behind everything.
    pub(super) background: [f64; 3],
    /// Opaque polygons.
    pub(super) opaque: Vec<Polygon>,
    /// Transparent objects, unsorted.
    pub(super) objects: Vec<Object>,
    /// The part of a texel that counts: its whole area if edges are part of the question.
    pub(super) coverage: TexelCoverage,
}

/// The greatest alpha of more than 64 layers.
const MANY_ALPHA: f64 = 0.25;

impl GlassScene {
    /// Returns the scene of a case.
    ///
    /// # Errors
    /// If a parameter is out of its range.
    pub(super) fn new(wire: &TransparencyWire) -> Result<Self, ParameterError> {
        let alpha = |default: f64| within("alpha", wire.alpha.unwrap_or(default), 0.01..=0.99);
        Ok(match wire.scene {
            TransparencyScene::Windows => windows(alpha(0.5)?),
            TransparencyScene::IntersectingPanes => {
                let angle = within("angle", wire.angle.unwrap_or(45.0), 0.0..=65.0)?;
                intersecting_panes(angle, alpha(0.5)?)
            }
            TransparencyScene::NestedGlass => nested_glass(alpha(0.4)?),
            TransparencyScene::ThinLayers => {
                let layers = wire.layers.unwrap_or(16);
                let alpha = alpha(0.1)?;
                // The weights of more opaque layers would add up to more than a half float holds.
                let most = if alpha > MANY_ALPHA { 64.0 } else { 256.0 };
                within("layers", f64::from(layers), 1.0..=most)?;
                thin_layers(layers, alpha)
            }
            TransparencyScene::Hair => hair(alpha(0.6)?),
            TransparencyScene::Smoke => smoke(alpha(0.2)?),
        })
    }

    /// Returns all transparent faces, object by object.
    pub(super) fn polygons(&self) -> impl Iterator<Item = &Polygon> {
        self.objects.iter().flat_map(|o| &o.polygons)
    }

    /// Returns the exact picture's scene: all surfaces, opaque and transparent.
    pub(super) fn truth(&self) -> Truth {
        Truth {
            size: self.size,
            background: self.background,
            coverage: self.coverage,
            surfaces: self
                .opaque
                .iter()
                .chain(self.polygons())
                .map(Polygon::surface)
                .collect(),
        }
    }
}

/// Six distinct colours.
const HUES: [[f64; 3]; 6] = [
    [0.85, 0.2, 0.15],
    [0.15, 0.65, 0.25],
    [0.2, 0.3, 0.85],
    [0.9, 0.75, 0.15],
    [0.7, 0.2, 0.65],
    [0.15, 0.7, 0.75],
];

/// Orange, the colour of opaque polygons.
const OPAQUE: [f64; 4] = [0.9, 0.5, 0.1, 1.0];

fn tinted([r, g, b]: [f64; 3], alpha: f64) -> [f64; 4] {
    [r, g, b, alpha]
}

/// Returns an object with a single polygon.
fn pane(polygon: Polygon) -> Object {
    Object {
        polygons: vec![polygon],
    }
}

/// Six overlapping panes at constant depths, and an opaque bar between two of them.
fn windows(alpha: f64) -> GlassScene {
    // Nearest first.
    let rects = [
        ([8.0, 16.0, 56.0, 96.0], 0.3),
        ([72.0, 8.0, 120.0, 88.0], 0.4),
        ([40.0, 24.0, 88.0, 112.0], 0.5),
        ([56.0, 48.0, 112.0, 104.0], 0.6),
        ([24.0, 40.0, 72.0, 120.0], 0.7),
        ([16.0, 8.0, 104.0, 32.0], 0.8),
    ];
    let order = [2, 5, 0, 3, 1, 4];
    let pane_at = |i: usize| {
        pane(Polygon::rect(
            rects[i].0,
            rects[i].1,
            tinted(HUES[i], alpha),
        ))
    };
    GlassScene {
        size: SIZE,
        background: [0.9, 0.9, 0.85],
        opaque: vec![Polygon::rect([32.0, 56.0, 96.0, 80.0], 0.65, OPAQUE)],
        objects: order.map(pane_at).to_vec(),
        coverage: TexelCoverage::Center,
    }
}

/// The width in texels across which a pane at 45 degrees passes through the whole range of depths.
const DEPTH_RANGE: f64 = 320.0;

/// Three panes. Two are turned, and pass through the others.
fn intersecting_panes(angle: f64, alpha: f64) -> GlassScene {
    let slope = angle.to_radians().tan() / DEPTH_RANGE;
    let turned = |rect, depth: f64, slope: f64, hue| {
        let mut polygon = Polygon::rect(rect, depth, tinted(hue, alpha));
        for corner in &mut polygon.corners {
            corner[2] += (corner[0] - 64.0) * slope;
        }
        pane(polygon)
    };
    GlassScene {
        size: SIZE,
        background: [0.9, 0.9, 0.85],
        opaque: Vec::new(),
        objects: vec![
            turned([16.0, 40.0, 112.0, 96.0], 0.5, 0.0, HUES[3]),
            turned([8.0, 8.0, 104.0, 104.0], 0.4, slope, HUES[0]),
            turned([24.0, 24.0, 120.0, 120.0], 0.6, -slope, HUES[2]),
        ],
        coverage: TexelCoverage::Center,
    }
}

/// Returns a box that is open to the viewer: its front face, with its back face and sides seen through it.
fn glass_box(front: [f64; 4], near: f64, back: [f64; 4], far: f64, color: [f64; 4]) -> Object {
    let corners = |[left, top, right, bottom]: [f64; 4], depth: f64| {
        [
            [left, top, depth],
            [left, bottom, depth],
            [right, bottom, depth],
            [right, top, depth],
        ]
    };
    let (f, b) = (corners(front, near), corners(back, far));
    let mut polygons = vec![Polygon::new(f.to_vec(), color)];
    for i in 0..4 {
        let next = (i + 1) % 4;
        // Upright and level sides differ, as if lit.
        let shade = if i % 2 == 0 { 0.8 } else { 0.6 };
        let [red, green, blue, alpha] = color;
        let shaded = [red * shade, green * shade, blue * shade, alpha];
        polygons.push(Polygon::new(vec![f[i], f[next], b[next], b[i]], shaded));
    }
    polygons.push(Polygon::new(b.to_vec(), color));
    Object { polygons }
}

/// Three boxes of glass around an opaque square. No edge between two sides passes through a texel's centre, as the
/// test `no_edge_comes_near_a_centre_unless_coverage_is_by_area` shows.
fn nested_glass(alpha: f64) -> GlassScene {
    let outer = glass_box(
        [8.0, 8.0, 120.0, 120.0],
        0.2,
        [36.0, 32.0, 100.0, 88.0],
        0.8,
        tinted(HUES[5], alpha),
    );
    let middle = glass_box(
        [32.0, 28.0, 96.0, 92.0],
        0.34,
        [44.0, 38.0, 88.0, 82.0],
        0.65,
        tinted(HUES[4], alpha),
    );
    let inner = glass_box(
        [50.0, 44.0, 78.0, 76.0],
        0.45,
        [54.0, 50.0, 74.0, 70.0],
        0.56,
        tinted(HUES[1], alpha),
    );
    GlassScene {
        size: SIZE,
        background: [0.9, 0.9, 0.85],
        opaque: vec![Polygon::rect([58.0, 54.0, 70.0, 66.0], 0.5, OPAQUE)],
        objects: vec![outer, inner, middle],
        coverage: TexelCoverage::Center,
    }
}

/// Returns the numbers below `count`, each once, in a mixed order.
fn mixed(count: u32) -> impl Iterator<Item = u32> {
    // The steps are prime, so one that does not divide the count shares no factor with it.
    let shares_no_factor = |step: &u32| !count.is_multiple_of(*step);
    let step = [5, 7, 11, 13].into_iter().find(shares_no_factor);
    let step = step.unwrap_or(1);
    (0..count).map(move |i| (i * step + 1) % count)
}

/// Many panes of nearly the same size, one behind the other.
fn thin_layers(layers: u32, alpha: f64) -> GlassScene {
    let layer = |i: u32| {
        let inset = |step: u32, over: u32| f64::from(4 + step * i % over);
        let rect = [
            inset(7, 20),
            inset(11, 20),
            128.0 - inset(5, 18),
            128.0 - inset(13, 18),
        ];
        let depth = 0.15 + 0.7 * (f64::from(i) + 0.5) / f64::from(layers);
        pane(Polygon::rect(
            rect,
            depth,
            tinted(HUES[i as usize % 6], alpha),
        ))
    };
    GlassScene {
        size: SIZE,
        background: [0.95, 0.95, 0.9],
        opaque: Vec::new(),
        objects: mixed(layers).map(layer).collect(),
        coverage: TexelCoverage::Center,
    }
}

/// The number of strips of hair.
const STRIPS: u32 = 128;

/// Strips that are 1 to 2 texels wide. Their edges are another question: they pass through no texel's centre, where the
/// truth is.
fn hair(alpha: f64) -> GlassScene {
    let mut noise = Noise::new(4);
    let mut strip = || {
        let root = noise.between(40.0, 84.0);
        let tip = root + (root - 62.0) * 0.7 + noise.between(-12.0, 12.0);
        let (top, bottom) = (noise.between(4.0, 16.0), noise.between(96.0, 124.0));
        let width = noise.between(1.0, 2.0);
        let near = noise.between(0.2, 0.8);
        let far = near + noise.between(-0.06, 0.06);
        let light = noise.between(0.4, 1.0);
        let corners = vec![
            [root, top, near],
            [tip, bottom, far],
            [tip + width, bottom, far],
            [root + width, top, near],
        ];
        let color = [0.8 * light, 0.5 * light, 0.25 * light, alpha];
        pane(settle_whole(SIZE, &Polygon::new(corners, color)))
    };
    GlassScene {
        size: SIZE,
        background: [0.75, 0.85, 0.95],
        opaque: Vec::new(),
        objects: (0..STRIPS).map(|_| strip()).collect(),
        coverage: TexelCoverage::Center,
    }
}

/// The number of quads of smoke.
const PUFFS: u32 = 12;

/// Large quads in front of and behind an opaque rectangle.
fn smoke(alpha: f64) -> GlassScene {
    let mut noise = Noise::new(12);
    let mut place = || (noise.between(4.0, 48.0).round(), noise.between(0.25, 0.95));
    let mut puffs = Vec::new();
    for i in 0..PUFFS {
        let ((left, light), (top, warmth)) = (place(), place());
        let (width, height) = (place().0, place().0);
        let depth = 0.2 + 0.05 * f64::from(i);
        let rect = [
            left,
            top,
            left + 52.0 + width / 2.0,
            top + 52.0 + height / 2.0,
        ];
        let rect = rect.map(|v| v.round());
        let color = [light, light * (0.8 + 0.2 * warmth), light * warmth, alpha];
        puffs.push(pane(Polygon::rect(rect, depth, color)));
    }
    GlassScene {
        size: SIZE,
        background: [0.25, 0.35, 0.55],
        opaque: vec![Polygon::rect([44.0, 36.0, 84.0, 92.0], 0.525, OPAQUE)],
        objects: mixed(PUFFS).map(|i| puffs[i as usize].clone()).collect(),
        coverage: TexelCoverage::Center,
    }
}
