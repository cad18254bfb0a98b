//! Solid scenes in perspective or seen along an axis. They are clipped and projected in 64-bit floats, then
//! moved to a grid, so that truth and drivers use the same triangles.

#[cfg(test)]
mod tests;

use crate::polygon::Polygon;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat4, DVec3};

/// A flat convex face in the world, counter-clockwise as seen from its front.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    /// At least three corners.
    pub(crate) corners: Vec<DVec3>,
    /// The face's straight (not premultiplied) colour.
    pub(crate) color: [f64; 4],
}

impl Face {
    /// Returns the normal, which has no particular length.
    fn normal(&self) -> DVec3 {
        let [a, b, c] = [0, 1, 2].map(|i| self.corners[i]);
        (b - a).cross(c - a)
    }

    /// Returns true if a point is in front of the face.
    pub(crate) fn looks_at(&self, point: DVec3) -> bool {
        self.normal().dot(point - self.corners[0]) > 0.0
    }

    /// Returns the face with all corners moved.
    pub(crate) fn moved(&self, by: &DMat4) -> Self {
        let corners = self.corners.iter().map(|c| by.transform_point3(*c));
        Self {
            corners: corners.collect(),
            color: self.color,
        }
    }

    /// Returns the face lit from the upper left, so that faces differ in brightness.
    pub(crate) fn lit(mut self) -> Self {
        let light = DVec3::new(-0.4, 0.8, 0.45).normalize();
        let bright = 0.65 + 0.35 * self.normal().normalize_or_zero().dot(light);
        for channel in &mut self.color[..3] {
            *channel *= bright;
        }
        self
    }
}

/// Returns the lit faces of an upright box between two corners, seen from outside.
pub(crate) fn cuboid(low: DVec3, high: DVec3, color: [f64; 4]) -> Vec<Face> {
    let corner = |x: usize, y: usize, z: usize| {
        let pick = |bit: usize, low: f64, high: f64| if bit == 0 { low } else { high };
        DVec3::new(
            pick(x, low.x, high.x),
            pick(y, low.y, high.y),
            pick(z, low.z, high.z),
        )
    };
    let face = |corners: [[usize; 3]; 4]| {
        let corners = corners.map(|[x, y, z]| corner(x, y, z)).to_vec();
        Face { corners, color }.lit()
    };
    vec![
        face([[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]]),
        face([[1, 0, 1], [1, 0, 0], [1, 1, 0], [1, 1, 1]]),
        face([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]),
        face([[0, 1, 1], [1, 1, 1], [1, 1, 0], [0, 1, 0]]),
        face([[1, 0, 0], [0, 0, 0], [0, 1, 0], [1, 1, 0]]),
        face([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]),
    ]
}

/// The projection of eye space, in which the eye looks along -z, to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Rays through the eye; the number is half the picture's height at distance 1.
    Perspective(f64),
    /// Parallel rays; the number is half the height of the picture in eye space.
    Parallel(f64),
}

/// A camera in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The place of the eye, at the origin of eye space, and its directions; without scaling.
    pub world: DMat4,
    /// The projection.
    pub lens: Lens,
    /// The nearest and the farthest distance that is seen; the latter can be infinite.
    pub planes: [f64; 2],
}

/// What a camera sees, projected to a picture.
#[derive(Clone, Debug)]
pub(crate) struct View {
    size: [f64; 2],
    world: DMat4,
    lens: Lens,
    near: f64,
    far: f64,
}

impl View {
    /// Creates a view from `eye` towards `target` with a vertical field of view in degrees, which sees nothing
    /// nearer or farther than two distances.
    pub(crate) fn perspective(
        size: [u32; 2],
        [eye, target]: [DVec3; 2],
        degrees: f64,
        [near, far]: [f64; 2],
    ) -> Self {
        Self {
            size: size.map(f64::from),
            world: look_at_mat4(eye, target, DVec3::Y),
            lens: Lens::Perspective((degrees.to_radians() / 2.0).tan()),
            near,
            far,
        }
    }

    /// Creates a view through a camera, which sees nothing nearer or farther than two distances.
    pub(crate) fn of_camera(size: [u32; 2], camera: &Camera, [near, far]: [f64; 2]) -> Self {
        Self {
            size: size.map(f64::from),
            world: camera.world.inverse(),
            lens: camera.lens,
            near,
            far,
        }
    }

    /// Creates the same view with parallel rays, for a picture of this height.
    pub(crate) fn parallel(
        size: [u32; 2],
        [eye, target]: [DVec3; 2],
        height: f64,
        [near, far]: [f64; 2],
    ) -> Self {
        Self {
            lens: Lens::Parallel(height / 2.0),
            ..Self::perspective(size, [eye, target], 90.0, [near, far])
        }
    }

    /// Returns the window depth of a distance: 0 at the near plane, 1 at the far plane, linear in the
    /// picture.
    pub(crate) fn depth(&self, distance: f64) -> f64 {
        match self.lens {
            Lens::Perspective(_) => window_depth(distance, [self.near, self.far]),
            Lens::Parallel(_) => (distance - self.near) / (self.far - self.near),
        }
    }

    /// Projects a point of eye space to the picture: x and y in texels, and the window depth.
    fn project(&self, point: DVec3) -> DVec3 {
        let distance = -point.z;
        let half = match self.lens {
            Lens::Perspective(half) => half * distance,
            Lens::Parallel(half) => half,
        };
        let [width, height] = self.size;
        // A unit has the same number of texels across and down.
        let texels = height / 2.0 / half;
        DVec3::new(
            width / 2.0 + point.x * texels,
            height / 2.0 - point.y * texels,
            self.depth(distance),
        )
    }

    /// Returns a point of the world in clip space, without clipping: the driver clips and divides.
    pub(crate) fn clip_position(&self, point: DVec3) -> [f64; 4] {
        let eye = self.world.transform_point3(point);
        let distance = -eye.z;
        let [width, height] = self.size;
        let (half, w, z) = match self.lens {
            Lens::Perspective(half) => {
                let z = self.far * (distance - self.near) / (self.far - self.near);
                (half, distance, z)
            }
            Lens::Parallel(half) => (half, 1.0, self.depth(distance)),
        };
        [eye.x / half * height / width, eye.y / half, z, w]
    }

    /// Projects faces, clipped to the near and far plane but not to the picture's edges. Drops
    /// faces that are clipped entirely.
    pub(crate) fn unbounded(&self, faces: &[Face]) -> Vec<Polygon> {
        let polygon = |face: &Face| {
            let eye: Vec<DVec3> = face.moved(&self.world).corners;
            let eye = clip(&eye, |p| -p.z - self.near);
            let eye = clip(&eye, |p| self.far + p.z);
            if eye.len() < 3 {
                return None;
            }
            let corners = eye.into_iter().map(|p| self.project(p).to_array());
            Some(Polygon::new(corners.collect(), face.color))
        };
        faces.iter().filter_map(polygon).collect()
    }

    /// Projects faces, clipped to the picture.
    pub(crate) fn see(&self, faces: &[Face]) -> Vec<Polygon> {
        let [width, height] = self.size;
        let inside = |polygon: Polygon| {
            let mut points: Vec<DVec3> = polygon.corners.into_iter().map(DVec3::from).collect();
            points = clip(&points, |p| p.x);
            points = clip(&points, |p| width - p.x);
            points = clip(&points, |p| p.y);
            points = clip(&points, |p| height - p.y);
            let corners: Vec<[f64; 3]> = points.iter().map(DVec3::to_array).collect();
            (corners.len() >= 3).then(|| Polygon::new(corners, polygon.color))
        };
        let polygons = self.unbounded(faces);
        polygons.into_iter().filter_map(inside).collect()
    }
}

/// Returns the window depth of a distance in a perspective projection: 0 at the near plane, 1 at the far
/// plane.
pub(crate) fn window_depth(distance: f64, [near, far]: [f64; 2]) -> f64 {
    far * (distance - near) / (distance * (far - near))
}

/// Returns the distance of a window depth: the inverse of [`window_depth`].
pub(crate) fn distance(depth: f64, [near, far]: [f64; 2]) -> f64 {
    far * near / (far - depth * (far - near))
}

/// Clips a convex polygon to the half space in which a linear function is not negative (Sutherland and
/// Hodgman 1974). Neighbours cut a common edge at the same point, in whichever direction they traverse it.
pub(crate) fn clip(corners: &[DVec3], inside: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut left = Vec::with_capacity(corners.len() + 1);
    for (i, a) in corners.iter().copied().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let [here, next] = [inside(a), inside(b)];
        if here >= 0.0 {
            left.push(a);
        }
        if (here > 0.0 && next < 0.0) || (here < 0.0 && next > 0.0) {
            // Always interpolates from the inner to the outer end.
            let (from, to, d, e) = if here > 0.0 {
                (a, b, here, next)
            } else {
                (b, a, next, here)
            };
            left.push(from + (to - from) * (d / (d - e)));
        }
    }
    left
}
