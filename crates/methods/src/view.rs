//! Solid scenes in perspective or seen along an axis: clipped and projected in 64-bit floats, then
//! brought to a grid, so that truth and drivers speak of the same triangles.

#[cfg(test)]
mod tests;

use super::stage::Polygon;
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat4, DVec3};
use std::collections::HashMap;

/// Vertices lie on multiples of one over this many texels, which every driver keeps exactly: Vulkan and
/// OpenGL ask for 4 sub-pixel bits.
const GRID: f64 = 16.0;

/// A flat convex face in the world, counter-clockwise as it is seen from its front.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    /// At least three corners.
    pub(crate) corners: Vec<DVec3>,
    /// Its straight colour.
    pub(crate) color: [f64; 4],
}

impl Face {
    /// The normal, of no special length.
    fn normal(&self) -> DVec3 {
        let [a, b, c] = [0, 1, 2].map(|i| self.corners[i]);
        (b - a).cross(c - a)
    }

    /// Whether a point lies before its front.
    pub(crate) fn looks_at(&self, point: DVec3) -> bool {
        self.normal().dot(point - self.corners[0]) > 0.0
    }

    /// The face with all corners moved.
    pub(crate) fn moved(&self, by: &DMat4) -> Self {
        let corners = self.corners.iter().map(|c| by.transform_point3(*c));
        Self {
            corners: corners.collect(),
            color: self.color,
        }
    }

    /// The face in a light from above the viewer's left shoulder, so that faces can be told apart.
    pub(crate) fn lit(mut self) -> Self {
        let light = DVec3::new(-0.4, 0.8, 0.45).normalize();
        let bright = 0.65 + 0.35 * self.normal().normalize_or_zero().dot(light);
        for channel in &mut self.color[..3] {
            *channel *= bright;
        }
        self
    }
}

/// The faces of an upright box between two corners, seen from outside; each in the light.
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

/// How eye space, in which the eye looks along -z, becomes a picture.
#[derive(Clone, Copy, Debug)]
enum Lens {
    /// Rays through the eye; the number is half the picture's height at distance 1.
    Perspective(f64),
    /// Parallel rays; the number is half the picture's height.
    Parallel(f64),
}

/// Where the eye is and what it sees.
#[derive(Clone, Debug)]
pub(crate) struct View {
    size: [f64; 2],
    world: DMat4,
    lens: Lens,
    near: f64,
    far: f64,
}

impl View {
    /// An eye at one point that looks at another, sees so many degrees from top to bottom, and nothing
    /// nearer or farther than two distances.
    pub(crate) fn perspective(
        size: [u32; 2],
        [eye, at]: [DVec3; 2],
        degrees: f64,
        [near, far]: [f64; 2],
    ) -> Self {
        Self {
            size: size.map(f64::from),
            world: look_at_mat4(eye, at, DVec3::Y),
            lens: Lens::Perspective((degrees.to_radians() / 2.0).tan()),
            near,
            far,
        }
    }

    /// The same with parallel rays, a picture of so much height.
    pub(crate) fn parallel(
        size: [u32; 2],
        [eye, at]: [DVec3; 2],
        height: f64,
        [near, far]: [f64; 2],
    ) -> Self {
        Self {
            lens: Lens::Parallel(height / 2.0),
            ..Self::perspective(size, [eye, at], 90.0, [near, far])
        }
    }

    /// The window depth of a distance: 0 at the near, 1 at the far plane, linear in the picture.
    pub(crate) fn depth(&self, distance: f64) -> f64 {
        match self.lens {
            Lens::Perspective(_) => window_depth(distance, [self.near, self.far]),
            Lens::Parallel(_) => (distance - self.near) / (self.far - self.near),
        }
    }

    /// A point of eye space in the picture: x and y in texels, and the window depth.
    fn project(&self, point: DVec3) -> DVec3 {
        let distance = -point.z;
        let half = match self.lens {
            Lens::Perspective(half) => half * distance,
            Lens::Parallel(half) => half,
        };
        let [width, height] = self.size;
        // As many texels to the unit across as down.
        let texels = height / 2.0 / half;
        DVec3::new(
            width / 2.0 + point.x * texels,
            height / 2.0 - point.y * texels,
            self.depth(distance),
        )
    }

    /// What is left of faces between the near and the far plane, in the picture but not cut by its
    /// edges. Faces without anything left are left out.
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

    /// What is seen of faces, each polygon inside of the picture.
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

/// The window depth of a distance in a perspective projection: 0 at the near, 1 at the far plane.
pub(crate) fn window_depth(distance: f64, [near, far]: [f64; 2]) -> f64 {
    far * (distance - near) / (distance * (far - near))
}

/// What is left of a convex polygon where a function that is linear in space is not negative
/// (Sutherland and Hodgman 1974). Neighbours cut a common edge at the same point, whichever way they
/// run along it.
pub(crate) fn clip(corners: &[DVec3], inside: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut left = Vec::with_capacity(corners.len() + 1);
    for (i, a) in corners.iter().copied().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let [at, next] = [inside(a), inside(b)];
        if at >= 0.0 {
            left.push(a);
        }
        if (at > 0.0 && next < 0.0) || (at < 0.0 && next > 0.0) {
            // Always from the inner to the outer end.
            let (from, to, d, e) = match at > 0.0 {
                true => (a, b, at, next),
                false => (b, a, next, at),
            };
            left.push(from + (to - from) * (d / (d - e)));
        }
    }
    left
}

/// The polygons as triangles whose vertices lie on a grid that every driver keeps, and whose edges
/// lead through no texel's centre: what covers a texel is then beyond doubt. Vertices at the same place
/// stay together, depths stay with their vertices, and triangles without area are left out.
///
/// A polygon of more than three corners becomes a fan around its middle.
pub(crate) fn settle(size: [u32; 2], polygons: &[Polygon]) -> Vec<Polygon> {
    let mut places: HashMap<[u64; 2], usize> = HashMap::new();
    let mut points: Vec<[i64; 2]> = Vec::new();
    let mut triangles = Vec::new();
    for polygon in polygons {
        let mut place = |[x, y, depth]: [f64; 3]| {
            let key = [x.to_bits(), y.to_bits()];
            let index = *places.entry(key).or_insert_with(|| {
                points.push([x, y].map(|c| (c * GRID).round() as i64));
                points.len() - 1
            });
            (index, depth)
        };
        let corners: Vec<(usize, f64)> = polygon.corners.iter().map(|c| place(*c)).collect();
        let mut triangle = |corners: [(usize, f64); 3]| triangles.push((corners, polygon.color));
        if let [a, b, c] = corners[..] {
            triangle([a, b, c]);
            continue;
        }
        let sum: DVec3 = polygon.corners.iter().map(|c| DVec3::from(*c)).sum();
        let middle = place((sum / corners.len() as f64).to_array());
        for (i, corner) in corners.iter().enumerate() {
            triangle([middle, *corner, corners[(i + 1) % corners.len()]]);
        }
    }
    let edges: Vec<[usize; 2]> = triangles
        .iter()
        .flat_map(|(c, _)| [[c[0].0, c[1].0], [c[1].0, c[2].0], [c[2].0, c[0].0]])
        .collect();
    untie(size, &mut points, &edges);
    let polygon = |(corners, color): ([(usize, f64); 3], [f64; 4])| {
        let [a, b, c] = corners.map(|(index, _)| points[index]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        let corner = |(index, depth): (usize, f64)| {
            let [x, y] = points[index].map(|c| c as f64 / GRID);
            [x, y, depth]
        };
        (area != 0).then(|| Polygon::new(corners.map(corner).to_vec(), color))
    };
    triangles.into_iter().filter_map(polygon).collect()
}

/// Moves points by single steps of the grid until no edge leads through a centre. Points on the edges
/// of the picture stay there.
fn untie(size: [u32; 2], points: &mut [[i64; 2]], edges: &[[usize; 2]]) {
    let ends = size.map(|s| i64::from(s) * GRID as i64);
    // Far more than needed: a step frees most edges, and each pass takes a step for each tied edge.
    for pass in 0..64_usize {
        let mut tied = false;
        for (i, [a, b]) in edges.iter().copied().enumerate() {
            if !touches_centre(size, points[a], points[b]) {
                continue;
            }
            tied = true;
            let free = |index: usize, axis: usize| {
                let at = points[index][axis];
                at != 0 && at != ends[axis]
            };
            // Another end and axis each time, or two edges could push a point to and fro.
            let ways = [(a, 0), (b, 1), (a, 1), (b, 0)];
            let turn = pass + i;
            let way = (0..4).map(|k| ways[(turn + k) % 4]);
            if let Some((index, axis)) = way.into_iter().find(|(index, axis)| free(*index, *axis)) {
                let step = if (turn / 4).is_multiple_of(2) { 1 } else { -1 };
                let at = points[index][axis] + step;
                points[index][axis] = if at == ends[axis] || at == 0 {
                    at - 2 * step
                } else {
                    at
                };
            }
        }
        if !tied {
            break;
        }
    }
}

/// Whether an edge leads through the centre of a texel of the picture.
fn touches_centre(size: [u32; 2], a: [i64; 2], b: [i64; 2]) -> bool {
    let step = GRID as i64;
    let half = step / 2;
    let is_centre = |x: i64| x.rem_euclid(step) == half;
    let within = |c: i64, axis: usize| (0..i64::from(size[axis]) * step).contains(&c);
    // Along the axis on which the edge is longer, so that it is never divided by nothing.
    let long = usize::from((b[1] - a[1]).abs() > (b[0] - a[0]).abs());
    let short = 1 - long;
    let (from, to) = if a[long] <= b[long] { (a, b) } else { (b, a) };
    let length = to[long] - from[long];
    if length == 0 {
        return is_centre(a[0]) && is_centre(a[1]) && within(a[0], 0) && within(a[1], 1);
    }
    let first = from[long] + (half - from[long]).rem_euclid(step);
    let mut at = first.max(half);
    while at <= to[long] && within(at, long) {
        let run = (to[short] - from[short]) * (at - from[long]);
        if run % length == 0 {
            let other = from[short] + run / length;
            if is_centre(other) && within(other, short) {
                return true;
            }
        }
        at += step;
    }
    false
}
