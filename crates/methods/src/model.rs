//! Scenes of one's own: triangles in the world, and the camera that sees them.

use crate::error::ParameterError;
use crate::method_scene::MethodScene;
use crate::seen_model::{ModelTriangle, SeenModel};
use crate::view::{Camera, Lens};
use crate::{anti_aliasing, depth_precision, transparency};
use glam::{DMat4, DVec3};

/// The maximum number of triangles of a model, before and after its camera clips them.
pub const MOST_TRIANGLES: usize = 1 << 20;

/// A scene that a user brings. Methods draw it in place of a built-in scene.
#[derive(Debug)]
pub struct Model {
    triangles: usize,
    camera: Camera,
    seen: SeenModel,
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
