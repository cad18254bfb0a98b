//! Shadow volumes (Crow 1977; Heidmann 1991): a point is in shadow if, between it and a point that is
//! certainly lit, more sides of volumes lead in than out.
//!
//! The picture is seen along z, and light falls at a slant, so that a card's shadow on a plane behind it is
//! the card moved. Cards are on whole texels and light moves them by whole texels, so the edges of all
//! shadows are half a texel away from all centres.

use super::shown::{ShownEffect, except, opaque, test};
use crate::grid::settle;
use crate::polygon::{self, Polygon};
use crate::stage::{self, SIZE};
use crate::truth::FlatSurface;
use crate::view::clip;
use etalon_scene::{CompareFunction, Draw, Shader, StencilOperation, StencilState};
use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// The sides of volumes that are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum ShadowMethod {
    /// Sides in front of the visible surface, from the near plane on, which should be outside all volumes
    /// (Heidmann 1991).
    #[serde(rename = "shadow-volume-depth-pass")]
    DepthPass,
    /// Sides behind the visible surface; the volumes are closed at both ends (Carmack 2000; Everitt and
    /// Kilgard 2002).
    #[serde(rename = "shadow-volume-depth-fail")]
    DepthFail,
}

/// A rectangle that faces the viewer: left, top, right and bottom in texels.
#[derive(Clone, Copy, Debug)]
struct Card {
    area: [f64; 4],
    z: f64,
    color: [f64; 4],
}

const CARDS: [Card; 4] = [
    Card {
        area: [18.0, 10.0, 56.0, 40.0],
        z: 0.1,
        color: [0.9, 0.6, 0.3, 1.0],
    },
    Card {
        area: [66.0, 34.0, 106.0, 66.0],
        z: 0.3,
        color: [0.4, 0.7, 0.9, 1.0],
    },
    Card {
        area: [22.0, 66.0, 84.0, 104.0],
        z: 0.5,
        color: [0.5, 0.8, 0.4, 1.0],
    },
    // The wall. Its own shadow is not visible.
    Card {
        area: [0.0, 0.0, 128.0, 128.0],
        z: 0.9,
        color: [0.8, 0.8, 0.7, 1.0],
    },
];

/// The number of texels by which light moves right and down from z 0 to z 1: 5 and 4 per tenth.
const LIGHT: [f64; 2] = [50.0, 40.0];

/// The end of volumes: behind the wall, and in front of the far plane at 1.
const END: f64 = 0.97;

/// The distance between a volume and its card, so that they do not touch.
const BEHIND: f64 = 0.004;

/// The brightness in a shadow.
const SHADE: f64 = 0.5;

impl Card {
    /// Returns the corners of the shadow at another depth, counter-clockwise as seen.
    fn shadow(&self, z: f64) -> [DVec3; 4] {
        let [left, top, right, bottom] = self.shadow_area(z);
        [[left, top], [left, bottom], [right, bottom], [right, top]]
            .map(|[x, y]| DVec3::new(x, y, z))
    }

    fn shadow_area(&self, z: f64) -> [f64; 4] {
        let [dx, dy] = LIGHT.map(|l| l * (z - self.z));
        let [left, top, right, bottom] = self.area;
        [left + dx, top + dy, right + dx, bottom + dy]
    }

    /// Returns the faces of the closed volume in the card's shadow, seen from outside.
    fn volume(&self) -> Vec<Vec<DVec3>> {
        let [from, to] = [self.z + BEHIND, END].map(|z| self.shadow(z));
        let mut faces = vec![from.to_vec(), to.iter().rev().copied().collect()];
        faces.extend((0..4).map(|i| {
            let next = (i + 1) % 4;
            vec![from[i], to[i], to[next], from[next]]
        }));
        faces
    }
}

/// Returns the window depth: 0 at the near plane, where the eye is, and 1 at the far plane, at z 1.
fn window_depth(z: f64, eye: f64) -> f64 {
    (z - eye) / (1.0 - eye)
}

/// Projects faces, clipped to the near plane and to the picture.
fn seen(faces: &[Vec<DVec3>], eye: f64, color: [f64; 4]) -> Vec<Polygon> {
    let [width, height] = SIZE.map(f64::from);
    let polygon = |face: &Vec<DVec3>| {
        let mut left = clip(face, |p| p.z - eye);
        left = clip(&left, |p| p.x);
        left = clip(&left, |p| width - p.x);
        left = clip(&left, |p| p.y);
        left = clip(&left, |p| height - p.y);
        let corners = left.iter().map(|p| [p.x, p.y, window_depth(p.z, eye)]);
        (left.len() >= 3).then(|| Polygon::new(corners.collect(), color))
    };
    let polygons: Vec<Polygon> = faces.iter().filter_map(polygon).collect();
    settle(SIZE, &polygons)
}

/// Returns a draw that counts the sides of a volume in the stencil.
fn count(method: ShadowMethod, volume: &[Polygon]) -> Draw {
    let mut draw = stage::draw(Shader::FlatColor, polygon::mesh(SIZE, volume));
    draw.depth = stage::depth(CompareFunction::Less, false);
    draw.targets[0].write_mask = 0;
    let [mut front, mut back] = [test(CompareFunction::Always, 0); 2];
    let [more, less] = [
        StencilOperation::IncrementWrap,
        StencilOperation::DecrementWrap,
    ];
    match method {
        ShadowMethod::DepthPass => {
            front.pass_op = more;
            back.pass_op = less;
        }
        ShadowMethod::DepthFail => {
            front.depth_fail_op = less;
            back.depth_fail_op = more;
        }
    }
    draw.stencil = Some(StencilState { front, back });
    draw
}

/// Returns a draw that darkens texels whose count is not 0.
fn darken() -> Draw {
    let mut draw = stage::draw(Shader::UniformColor, polygon::cover());
    draw.params.color = [0.0, 0.0, 0.0, 1.0 - SHADE as f32];
    draw.targets[0].blend = stage::over();
    draw.stencil = except(0);
    draw
}

/// Returns the cards behind the near plane, each followed by the shadows on it.
fn surfaces(eye: f64) -> Vec<FlatSurface> {
    let mut surfaces = Vec::new();
    for on in CARDS.iter().filter(|card| card.z > eye) {
        let depth = window_depth(on.z, eye);
        surfaces.push(Polygon::rect(on.area, depth, on.color).surface());
        let [r, g, b, a] = on.color;
        let dark = [r * SHADE, g * SHADE, b * SHADE, a];
        for caster in CARDS.iter().filter(|card| card.z < on.z) {
            let [left, top, right, bottom] = caster.shadow_area(on.z);
            let area = [
                left.max(on.area[0]),
                top.max(on.area[1]),
                right.min(on.area[2]),
                bottom.min(on.area[3]),
            ];
            if area[0] < area[2] && area[1] < area[3] {
                surfaces.push(Polygon::rect(area, depth, dark).surface());
            }
        }
    }
    surfaces
}

pub(super) fn show(method: ShadowMethod, eye: f64) -> ShownEffect {
    let visible = CARDS.iter().filter(|card| card.z > eye);
    let rect = |card: &Card| Polygon::rect(card.area, window_depth(card.z, eye), card.color);
    let cards: Vec<Polygon> = visible.map(rect).collect();
    let volumes = CARDS[..3].iter().flat_map(|card| {
        let faces = card.volume();
        seen(&faces, eye, [0.0; 4])
    });
    let volumes: Vec<Polygon> = volumes.collect();
    ShownEffect {
        background: [0.0; 3],
        draws: vec![opaque(&cards), count(method, &volumes), darken()],
        surfaces: surfaces(eye),
    }
}
