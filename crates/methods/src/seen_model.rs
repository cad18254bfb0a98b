//! What the camera of a scene of one's own sees.

use crate::grid::settle_each;
use crate::polygon::Polygon;
use crate::view::{Camera, Face, Lens, View};
use glam::{DMat4, DVec3};
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::{Error, StrDeserializer};

/// The shape of a model's pictures, in texels: that of the frames at which methods are timed.
const PICTURE: [u32; 2] = [256, 144];

/// The colour behind a model.
const BACKGROUND: [f64; 3] = [0.9, 0.9, 0.85];

/// A triangle of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelTriangle {
    /// Corners in the world, counter-clockwise as seen from the front.
    pub corners: [DVec3; 3],
    /// Straight red, green, blue and alpha as they are displayed, 0 to 1.
    pub color: [f64; 4],
    /// True if the triangle lets light through; otherwise it is opaque, whatever its alpha.
    pub transparent: bool,
    /// True if its back is seen too.
    pub double_sided: bool,
    /// The object that it belongs to; objects are sorted as a whole.
    pub object: usize,
}

/// What a model's camera sees, projected and settled.
#[derive(Debug)]
pub(crate) struct SeenModel {
    /// Width and height of the picture in texels.
    pub(crate) size: [u32; 2],
    /// Red, green and blue behind everything.
    pub(crate) background: [f64; 3],
    /// The opaque triangles.
    pub(crate) opaque: Vec<Polygon>,
    /// The transparent triangles, object by object.
    pub(crate) transparent: Vec<Vec<Polygon>>,
    /// The distances at which depths are 0 and 1.
    pub(crate) planes: [f64; 2],
}

impl SeenModel {
    /// Projects the triangles; `None` if no triangle is seen.
    pub(crate) fn new(triangles: &[ModelTriangle], camera: &Camera) -> Option<Self> {
        let planes = planes(triangles, camera)?;
        let view = View::of_camera(PICTURE, camera, planes);
        let (eye, forward) = (
            camera.world.w_axis.truncate(),
            -camera.world.z_axis.truncate(),
        );
        let mut owners: Vec<&ModelTriangle> = Vec::new();
        let mut polygons = Vec::new();
        for triangle in triangles {
            let mut face = Face {
                corners: triangle.corners.to_vec(),
                color: triangle.color,
            };
            let is_front = match camera.lens {
                Lens::Perspective(_) => face.looks_at(eye),
                Lens::Parallel(_) => face.looks_at(face.corners[0] - forward),
            };
            if !is_front {
                if !triangle.double_sided {
                    continue;
                }
                face.corners.reverse();
            }
            if !triangle.transparent {
                face.color[3] = 1.0;
            }
            let shown = view.see(&[face.lit()]);
            owners.extend(shown.iter().map(|_| triangle));
            polygons.extend(shown);
        }
        let mut seen = Self {
            size: PICTURE,
            background: BACKGROUND,
            opaque: Vec::new(),
            transparent: Vec::new(),
            planes,
        };
        let mut object = None;
        for (index, polygon) in settle_each(PICTURE, &polygons) {
            let owner = owners[index];
            if !owner.transparent {
                seen.opaque.push(polygon);
                continue;
            }
            if object != Some(owner.object) {
                object = Some(owner.object);
                seen.transparent.push(Vec::new());
            }
            if let Some(last) = seen.transparent.last_mut() {
                last.push(polygon);
            }
        }
        let some = !(seen.opaque.is_empty() && seen.transparent.is_empty());
        some.then_some(seen)
    }
}

/// Returns the distances of the camera's planes, moved to the nearest and the farthest corner if those are between them,
/// so that depths are as precise as they can be; `None` if no corner is between the planes.
fn planes(triangles: &[ModelTriangle], camera: &Camera) -> Option<[f64; 2]> {
    let to_eye: DMat4 = camera.world.inverse();
    let corners = triangles.iter().flat_map(|t| t.corners);
    let distances = corners.map(|corner| -to_eye.transform_point3(corner).z);
    let (low, high) = distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| {
        (low.min(d), high.max(d))
    });
    let [near, far] = camera.planes;
    let planes = [near.max(low * 0.999), far.min(high * 1.001)];
    (planes[0] < planes[1] && planes[1].is_finite()).then_some(planes)
}

/// Returns the method of this name.
pub(crate) fn named<'de, M: Deserialize<'de>>(method: &'de str) -> Option<M> {
    let name: StrDeserializer<'de, Error> = method.into_deserializer();
    M::deserialize(name).ok()
}
