//! Scenes of edges.

use super::pieces::{DEPTH, DirectedLine, Piece};
use super::wire::{AntiAliasingScene, AntiAliasingWire};
use crate::error::{ParameterError, within};
use crate::polygon::Polygon;
use crate::seen_model::SeenModel;
use crate::stage::{DEPTHS, SIZE, Stage};
use crate::truth::{TexelCoverage, Truth};
use etalon_frame::TextureFormat;
use std::f64::consts::TAU;

/// A ground on texel borders, and pieces on it.
#[derive(Clone, Debug)]
pub(super) struct EdgeScene {
    /// Width and height of the picture in texels.
    pub(super) size: [u32; 2],
    /// Red, green and blue behind everything. If the ground covers the picture, it can only show in seams.
    pub(super) background: [f64; 3],
    /// The polygons below the pieces.
    pub(super) ground: Vec<Polygon>,
    /// The pieces in front of the ground.
    pub(super) front: Vec<Piece>,
    /// The visible ground, as pieces that fill the gaps between the front pieces.
    pub(super) back: Vec<Piece>,
    /// Polygons that hide each other by their depths: a scene of one's own, without ground and pieces.
    pub(super) solid: Vec<Polygon>,
}

const INK: [f64; 4] = [0.95, 0.95, 0.9, 1.0];
const PAPER: [f64; 4] = [0.15, 0.35, 0.6, 1.0];
const BEHIND: [f64; 3] = [0.0, 0.0, 0.0];

/// The whole picture.
pub(super) const ALL: [f64; 4] = [0.0, 0.0, SIZE[0] as f64, SIZE[1] as f64];

/// The format of pictures.
pub(super) const PICTURE: TextureFormat = TextureFormat::Rgba8Unorm;

impl EdgeScene {
    /// Returns the colour behind everything.
    pub(super) fn clear(&self) -> [f64; 4] {
        let [r, g, b] = self.background;
        [r, g, b, 1.0]
    }

    /// Returns the scene of a case.
    ///
    /// # Errors
    /// If a parameter is out of its range.
    pub(super) fn new(wire: &AntiAliasingWire) -> Result<Self, ParameterError> {
        Ok(match wire.scene {
            AntiAliasingScene::HalfPlanes => {
                half_planes(within("angle", wire.angle.unwrap_or(20.0), 0.0..=90.0)?)
            }
            AntiAliasingScene::ThinWedge => {
                thin_wedge(within("opening", wire.opening.unwrap_or(4.0), 0.25..=60.0)?)
            }
            AntiAliasingScene::CheckerFan => checker_fan(),
            AntiAliasingScene::WireTorus => wire_torus(),
        })
    }

    /// Returns the ground and the pieces on it.
    pub(super) fn polygons(&self) -> Vec<Polygon> {
        let mut polygons = self.ground.clone();
        polygons.extend(self.pieces());
        polygons
    }

    /// Returns the pieces on the ground, and the solid polygons.
    pub(super) fn pieces(&self) -> Vec<Polygon> {
        let pieces = self.front.iter().filter_map(Piece::polygon);
        pieces.chain(self.solid.iter().cloned()).collect()
    }

    /// Returns the scene that a model's camera sees.
    pub(super) fn of_model(seen: &SeenModel) -> Self {
        Self {
            size: seen.size,
            background: seen.background,
            ground: Vec::new(),
            front: Vec::new(),
            back: Vec::new(),
            solid: seen.opaque.clone(),
        }
    }

    /// Adds the depths of a picture, if there is need.
    pub(super) fn depths(&self, stage: &mut Stage, samples: u32) -> Option<usize> {
        let needed = self.needs_depth();
        needed.then(|| stage.depth("depth", DEPTHS, self.size, samples, 1.0))
    }

    /// Returns true if polygons hide each other by their depths, and not by their order.
    pub(super) fn needs_depth(&self) -> bool {
        !self.solid.is_empty()
    }

    /// Returns the truth.
    pub(super) fn truth(&self) -> Truth {
        Truth {
            size: self.size,
            background: self.background,
            coverage: TexelCoverage::Area,
            surfaces: self.polygons().iter().map(Polygon::surface).collect(),
        }
    }

    fn on_paper(front: Vec<Piece>, back: Vec<Piece>) -> Self {
        Self {
            size: SIZE,
            solid: Vec::new(),
            background: BEHIND,
            ground: vec![Polygon::rect(ALL, DEPTH, PAPER)],
            front,
            back,
        }
    }
}

fn piece(within: [f64; 4], lines: &[DirectedLine], color: [f64; 4]) -> Piece {
    Piece {
        within,
        lines: lines.to_vec(),
        color,
    }
}

fn half_planes(angle: f64) -> EdgeScene {
    let (sin, cos) = angle.to_radians().sin_cos();
    let (mut front, mut back) = (Vec::new(), Vec::new());
    for i in 0..16_u32 {
        let [left, top] = [i % 4, i / 4].map(|v| f64::from(v) * 32.0);
        // Halfway between the sixteenths of a texel at which samples are.
        let offset = (f64::from(i) + 0.5) / 16.0;
        let middle = [left + 16.0 - sin * offset, top + 16.0 + cos * offset];
        let edge = DirectedLine::new(middle, [-sin, cos]);
        let cell = [left, top, left + 32.0, top + 32.0];
        front.push(piece(cell, &[edge], INK));
        back.push(piece(cell, &[edge.reversed()], PAPER));
    }
    EdgeScene::on_paper(front, back)
}

fn thin_wedge(opening: f64) -> EdgeScene {
    let (mut front, mut back) = (Vec::new(), Vec::new());
    for (i, direction) in [3.0, -1.5, 5.0, 0.5].into_iter().enumerate() {
        let top = i as f64 * 32.0;
        let cell = [0.0, top, 128.0, top + 32.0];
        let tip = [6.3, top + 15.7];
        let [above, below] = [-opening / 2.0, opening / 2.0]
            .map(|turn: f64| (direction + turn).to_radians().sin_cos());
        let upper = DirectedLine::new(tip, [-above.0, above.1]);
        let lower = DirectedLine::new(tip, [below.0, -below.1]);
        front.push(piece(cell, &[upper, lower], INK));
        back.push(piece(cell, &[upper.reversed()], PAPER));
        back.push(piece(cell, &[upper, lower.reversed()], PAPER));
    }
    EdgeScene::on_paper(front, back)
}

/// Sectors of the fan; an even number, so that neighbours differ.
const SECTORS: u32 = 24;

fn checker_fan() -> EdgeScene {
    let center = [64.3, 63.8];
    let ray = |i: u32| (TAU * f64::from(i) / f64::from(SECTORS) + 0.1).sin_cos();
    let (mut front, mut back) = (Vec::new(), Vec::new());
    for i in 0..SECTORS {
        let (from, to) = (ray(i), ray(i + 1));
        let sides = [
            DirectedLine::new(center, [-from.0, from.1]),
            DirectedLine::new(center, [to.0, -to.1]),
        ];
        let middle = [from.1 + to.1, from.0 + to.0];
        let chord = |radius: f64| {
            let end = [center[0] + radius * from.1, center[1] + radius * from.0];
            DirectedLine::new(end, middle)
        };
        let rings = [
            vec![chord(16.0).reversed()],
            vec![chord(16.0), chord(38.0).reversed()],
            vec![chord(38.0)],
        ];
        for (ring, chords) in (0..).zip(rings) {
            let lines = [&sides[..], &chords].concat();
            if (i + ring) % 2 == 0 {
                front.push(piece(ALL, &lines, INK));
            } else {
                back.push(piece(ALL, &lines, PAPER));
            }
        }
    }
    EdgeScene::on_paper(front, back)
}

/// Steps around the torus and around its tube.
const STEPS: [u32; 2] = [18, 8];

/// The width of wires, in texels.
const WIRE: f64 = 1.25;

fn wire_torus() -> EdgeScene {
    let point = |i: u32, j: u32| {
        let [around, tube] = [(i, STEPS[0]), (j, STEPS[1])];
        let (s, c) = (TAU * f64::from(around.0) / f64::from(around.1) + 0.05).sin_cos();
        let (t, d) = (TAU * f64::from(tube.0) / f64::from(tube.1) + 0.2).sin_cos();
        let radius = 1.0 + 0.4 * d;
        let [x, y, z] = [radius * c, radius * s, 0.4 * t];
        // Turns it about the horizontal axis, then views it from a distance of 5.
        let (tilt_sin, tilt_cos) = 0.9_f64.sin_cos();
        let [y, z] = [y * tilt_cos - z * tilt_sin, y * tilt_sin + z * tilt_cos];
        let scale = 190.0 / (5.0 + z);
        [64.0 + x * scale, 64.0 + y * scale]
    };
    let mut front = Vec::new();
    for (i, j) in (0..STEPS[0]).flat_map(|i| (0..STEPS[1]).map(move |j| (i, j))) {
        let from = point(i, j);
        front.push(wire(from, point(i + 1, j)));
        front.push(wire(from, point(i, j + 1)));
    }
    EdgeScene {
        size: SIZE,
        solid: Vec::new(),
        background: [PAPER[0], PAPER[1], PAPER[2]],
        ground: Vec::new(),
        front,
        back: Vec::new(),
    }
}

fn wire(from: [f64; 2], to: [f64; 2]) -> Piece {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    let across = [-along[1] / length, along[0] / length];
    let beside = |sign: f64| {
        let shift = across.map(|v| v * WIRE / 2.0 * sign);
        let point = [from[0] + shift[0], from[1] + shift[1]];
        DirectedLine::new(point, across.map(|v| -v * sign))
    };
    let lines = [
        beside(1.0),
        beside(-1.0),
        DirectedLine::new(from, along).marked_as_end(),
        DirectedLine::new(to, along.map(|v| -v)).marked_as_end(),
    ];
    piece(ALL, &lines, INK)
}
