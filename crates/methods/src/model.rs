//! Scenes of one's own: triangles in the world, and the camera that sees them.

use crate::error::ParameterError;
use crate::grid::settle_each;
use crate::method_scene::MethodScene;
use crate::polygon::Polygon;
use crate::view::{Camera, Face, Lens, View};
use crate::{anti_aliasing, depth_precision, transparency};
use glam::{DMat4, DVec3};
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::{Error, StrDeserializer};

/// The shape of a model's pictures, in texels: that of the frames at which methods are timed.
const PICTURE: [u32; 2] = [256, 144];

/// The colour behind a model.
const BACKGROUND: [f64; 3] = [0.9, 0.9, 0.85];

/// The maximum number of triangles of a model, and of those that are left when its camera has clipped them.
pub const MOST_TRIANGLES: usize = 1 << 20;

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

/// A scene that a user brings. Methods draw it in place of a built-in scene.
#[derive(Debug)]
pub struct Model {
    triangles: usize,
    camera: Camera,
    seen: SeenModel,
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

impl Model {
    /// Returns the scene of these triangles, seen by a camera, or by one that sees them all.
    ///
    /// # Errors
    /// If the camera sees nothing, or too many triangles.
    pub fn new(
        triangles: &[ModelTriangle],
        camera: Option<Camera>,
    ) -> Result<Self, ParameterError> {
        let wrong = |message: String| ParameterError::new("camera", &message);
        let camera = match camera {
            Some(camera) => camera,
            None => fitted(triangles)
                .ok_or_else(|| wrong("the scene has no extent to fit a camera to".into()))?,
        };
        let seen = SeenModel::new(triangles, &camera)
            .ok_or_else(|| wrong("the camera sees no triangle".into()))?;
        let count = seen.opaque.len() + seen.transparent.iter().map(Vec::len).sum::<usize>();
        if count > MOST_TRIANGLES {
            return Err(wrong(format!(
                "it sees {count} triangles; at most {MOST_TRIANGLES} are drawn"
            )));
        }
        Ok(Self {
            triangles: triangles.len(),
            camera,
            seen,
        })
    }

    /// Returns the number of triangles, seen or not.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Returns the questions that the scene can answer, each with the methods that draw it.
    pub fn questions(&self) -> Vec<(&'static str, Vec<&'static str>)> {
        let mut questions = Vec::new();
        if !self.seen.transparent.is_empty() {
            questions.push(("transparency", transparency::MODEL_METHODS.to_vec()));
        }
        if !self.seen.opaque.is_empty() {
            questions.push(("anti-aliasing", anti_aliasing::MODEL_METHODS.to_vec()));
            if matches!(self.camera.lens, Lens::Perspective(_)) {
                questions.push(("depth-precision", depth_precision::MODEL_METHODS.to_vec()));
            }
        }
        questions
    }

    /// Draws the scene by a method of one of its [`questions`](Self::questions).
    ///
    /// # Errors
    /// If the question or the method is another one.
    pub fn draw(&self, question: &str, method: &str) -> Result<MethodScene, ParameterError> {
        let made = match question {
            "transparency" => transparency::of_model(&self.seen, method),
            "anti-aliasing" => anti_aliasing::of_model(&self.seen, method),
            "depth-precision" => depth_precision::of_model(&self.seen, self.camera.planes, method),
            _ => None,
        };
        made.ok_or_else(|| {
            ParameterError::new(
                "method",
                "no method of this name draws a scene of one's own",
            )
        })
    }
}

/// Returns the method of this name.
pub(crate) fn named<'de, M: Deserialize<'de>>(method: &'de str) -> Option<M> {
    let name: StrDeserializer<'de, Error> = method.into_deserializer();
    M::deserialize(name).ok()
}

impl SeenModel {
    /// Projects the triangles; `None` if no triangle is seen.
    fn new(triangles: &[ModelTriangle], camera: &Camera) -> Option<Self> {
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

/// Half of a fitted camera's vertical field of view, in degrees.
const HALF_VIEW: f64 = 20.0;

/// Returns a camera that sees all triangles from the front, slightly from the right and above; `None` if they have no
/// extent.
fn fitted(triangles: &[ModelTriangle]) -> Option<Camera> {
    let corners = || triangles.iter().flat_map(|t| t.corners);
    let low = corners().reduce(DVec3::min)?;
    let high = corners().reduce(DVec3::max)?;
    let (middle, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    if !(radius.is_normal() && middle.is_finite()) {
        return None;
    }
    let back = DVec3::new(0.45, 0.35, 1.0).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let distance = radius / HALF_VIEW.to_radians().sin();
    let eye = middle + back * distance;
    Some(Camera {
        world: DMat4::from_cols(
            right.extend(0.0),
            back.cross(right).extend(0.0),
            back.extend(0.0),
            eye.extend(1.0),
        ),
        lens: Lens::Perspective(HALF_VIEW.to_radians().tan()),
        planes: [distance - radius, distance + radius],
    })
}
