//! A mirror: the scene is drawn a second time, upside down, in the stencil area of the mirror.

use super::shown::{ShownEffect, mark, only, opaque};
use crate::grid::settle;
use crate::polygon::Polygon;
use crate::stage::{self, SIZE};
use crate::truth::FlatSurface;
use crate::view::{Face, View, clip, cuboid};
use etalon_scene::CompareFunction;
use glam::{DMat4, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

/// The method for the reflection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum MirrorMethod {
    /// Draws the reflection only inside the stencil area of the mirror.
    #[serde(rename = "mirror")]
    Masked,
    /// Draws the reflection everywhere, so that it also shows outside the mirror.
    #[serde(rename = "mirror-unmasked")]
    Unmasked,
}

/// Half the mirror's width and depth.
const HALF: [f64; 2] = [1.2, 1.5];

/// Returns a rectangle of the ground.
fn ground([left, right, back, front]: [f64; 4], color: [f64; 4]) -> Face {
    Face {
        corners: vec![
            DVec3::new(left, 0.0, front),
            DVec3::new(right, 0.0, front),
            DVec3::new(right, 0.0, back),
            DVec3::new(left, 0.0, back),
        ],
        color,
    }
}

fn frame() -> Vec<Face> {
    const BORDER: f64 = 0.12;
    let [x, z] = HALF;
    let [far_x, far_z] = [x + BORDER, z + BORDER];
    [
        [-far_x, far_x, -far_z, -z],
        [-far_x, far_x, z, far_z],
        [-far_x, -x, -z, z],
        [x, far_x, -z, z],
    ]
    .map(|area| ground(area, [0.5, 0.35, 0.2, 1.0]))
    .to_vec()
}

fn boxes(shift: f64) -> Vec<Face> {
    let moved_box = |low: [f64; 3], high: [f64; 3], color: [f64; 4]| {
        let offset = DVec3::new(shift, 0.0, 0.0);
        cuboid(offset + DVec3::from(low), offset + DVec3::from(high), color)
    };
    let lower = moved_box([-0.45, 0.1, -0.4], [0.45, 0.6, 0.4], [0.9, 0.45, 0.35, 1.0]);
    let upper = moved_box([-0.2, 0.65, -0.2], [0.3, 0.95, 0.2], [0.4, 0.6, 0.9, 1.0]);
    [lower, upper].concat()
}

/// Returns the parts of a triangle that are inside the `inside` triangles, which do not overlap.
fn parts(triangle: &Polygon, inside: &[Polygon]) -> Vec<FlatSurface> {
    let part = |area: &Polygon| {
        let [a, b, c] = [0, 1, 2].map(|i| DVec3::from(area.corners[i]));
        let side = |from: DVec3, to: DVec3, p: DVec3| {
            (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x)
        };
        let sign = side(a, b, c).signum();
        let mut left: Vec<DVec3> = triangle.corners.iter().map(|p| DVec3::from(*p)).collect();
        for [from, to] in [[a, b], [b, c], [c, a]] {
            left = clip(&left, |p| sign * side(from, to, p));
        }
        let corners = left.iter().map(DVec3::to_array).collect();
        (left.len() >= 3).then(|| Polygon::new(corners, triangle.color).surface())
    };
    inside.iter().filter_map(part).collect()
}

pub(super) fn show(method: MirrorMethod, shift: f64) -> ShownEffect {
    let eye = DVec3::new(0.0, 4.0, 4.5);
    let target = DVec3::new(0.5, -0.1, 0.0);
    let view = View::perspective(SIZE, [eye, target], 44.0, [1.0, 20.0]);
    let seen = |faces: &[Face]| settle(SIZE, &view.see(faces));
    let [x, z] = HALF;
    let mirror = seen(&[ground([-x, x, -z, z], [0.75, 0.85, 0.95, 0.3])]);
    let frame = seen(&frame());
    let real = seen(&boxes(shift));
    let turned = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let reflected: Vec<Face> = boxes(shift).iter().map(|f| f.moved(&turned)).collect();
    let reflected = seen(&reflected);

    let masked = method == MirrorMethod::Masked;
    let mut area = opaque(&mirror);
    area.depth = None;
    area.targets[0].write_mask = 0;
    area.stencil = mark(1);
    let mut image = opaque(&reflected);
    let mut glass = opaque(&mirror);
    // The mirror image is behind the mirror and must not hide the mirror's surface.
    glass.depth = stage::depth(CompareFunction::Always, true);
    glass.targets[0].blend = stage::over();
    let mut draws = vec![opaque(&frame)];
    if masked {
        image.stencil = only(1);
        draws.push(area);
    }
    draws.extend([image, glass, opaque(&real)]);

    let mut surfaces: Vec<FlatSurface> = reflected.iter().flat_map(|t| parts(t, &mirror)).collect();
    let others = [frame, mirror, real].concat();
    surfaces.extend(others.iter().map(Polygon::surface));
    ShownEffect {
        background: [0.3, 0.4, 0.45],
        draws,
        surfaces,
    }
}
