//! The linear values over a primitive: depth, attributes, clip distances and bias.

use crate::lanes::{LANES, Mask};
use crate::linear::{LinearVarying, UNITS, position};
use crate::steps::Steps;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::shader::clip_distances;
use etalon_pipeline::{DepthPlane, Point, signed_area};
use etalon_scene::{Draw, Interpolation};

/// A vertex of a primitive.
#[derive(Clone, Copy)]
pub(crate) struct PlaneVertex {
    /// The clip-space position.
    pub(crate) position: [f32; 4],
    pub(crate) at: Point,
    pub(crate) z: f32,
    pub(crate) clip_z: f32,
    pub(crate) color: [f32; 4],
    pub(crate) uv: [f32; 2],
    /// The active clip distances, from the first element on.
    pub(crate) distances: [f32; MOST_DISTANCES],
}

/// The largest number of clip distances of a vertex (Vulkan, Required Limits; OpenGL 4.6, table 23.56).
const MOST_DISTANCES: usize = 8;

/// The linear values over a primitive, window depth first, and how it is clipped.
pub(crate) struct Planes {
    pub(crate) window: DepthPlane,
    /// Texture coordinates, if the shader reads them.
    pub(crate) uv: Option<[LinearVarying; 2]>,
    /// 1 over w, if the shader reads it.
    pub(crate) reciprocal_w: Option<LinearVarying>,
    pub(crate) clip: DepthPlane,
    pub(crate) range: [f32; 2],
    pub(crate) clip_range: [f64; 2],
    pub(crate) bias: f64,
    pub(crate) clamp: Option<[f32; 2]>,
    pub(crate) clips: bool,
    /// The clip distances that are negative at some vertex.
    pub(crate) distances: Vec<DepthPlane>,
    /// True if the viewport's edges might clip samples of the primitive.
    pub(crate) leaves: bool,
    /// The viewport's left, top, right and bottom edges in sub-texel units.
    pub(crate) viewport: [i64; 4],
}

/// Returns the viewport's left, top, right and bottom edges in sub-texel units.
pub(crate) fn viewport(draw: &Draw) -> [i64; 4] {
    let [x, y, w, h] = draw.viewport.area();
    [x, y, x + w, y + h].map(|v| (v * UNITS as f32).ceil() as i64)
}

impl Planes {
    pub(crate) fn new(
        draw: &Draw,
        interpolation: Interpolation,
        points: [Point; 3],
        vertices: [PlaneVertex; 3],
        bias: f64,
        wide: bool,
    ) -> Self {
        let z = vertices.map(|v| v.z);
        let clip_z = vertices.map(|v| v.clip_z);
        let [near, far] = draw.viewport.depth;
        let viewport = viewport(draw);
        let [left, top, right, bottom] = viewport;
        let inside = |p: &Point| (left..right).contains(&p.x) && (top..bottom).contains(&p.y);
        let out = clip_z.iter().any(|z| !(0.0..=1.0).contains(z));
        Self {
            window: DepthPlane::new(points, z.map(f64::from)),
            clip: DepthPlane::new(points, clip_z.map(f64::from)),
            uv: draw.shader.uses_uv().then(|| {
                let w = vertices.map(|v| f64::from(v.position[3]));
                let perspective = interpolation == Interpolation::Perspective && w != [w[0]; 3];
                [0, 1].map(|axis| {
                    let values = vertices.map(|v| f64::from(v.uv[axis]));
                    if perspective {
                        let over = [0, 1, 2].map(|i| values[i] / w[i]);
                        LinearVarying::perspective(
                            DepthPlane::new(points, over),
                            DepthPlane::new(points, w.map(|w| 1.0 / w)),
                        )
                    } else {
                        LinearVarying::linear(DepthPlane::new(points, values))
                    }
                })
            }),
            reciprocal_w: draw.shader.reads_w().then(|| {
                let values = vertices.map(|v| 1.0 / f64::from(v.position[3]));
                LinearVarying::linear(DepthPlane::new(points, values))
            }),
            clip_range: ends(clip_z).map(f64::from),
            range: ends(z),
            bias,
            clamp: draw.depth_clamp.then_some([near.min(far), near.max(far)]),
            clips: out && !draw.depth_clamp,
            distances: distances(draw, points, vertices),
            // Points and lines are clipped before they are widened, and then extend beyond the edges.
            leaves: !wide && !points.iter().all(inside),
            viewport,
        }
    }

    /// Returns the depths of a span's texels at one sample position, biased and clamped.
    pub(crate) fn at(&self, x: usize, y: usize, sample: Point) -> [f32; LANES] {
        std::array::from_fn(|lane| {
            let depth = self.window.at(position(x + lane, y, sample)) as f32;
            // Interpolation stays within the depths of the vertices.
            let depth = depth.clamp(self.range[0], self.range[1]);
            let depth = (f64::from(depth) + self.bias) as f32;
            match self.clamp {
                Some([low, high]) => depth.clamp(low, high),
                None => depth,
            }
        })
    }

    /// Removes from a mask the texels that are clipped by the viewport's edges, the near or far plane, or a
    /// clip distance.
    pub(crate) fn clip(&self, mask: &mut Mask, x: usize, y: usize, sample: Point) {
        if self.leaves {
            let [left, top, right, bottom] = self.viewport;
            for (lane, covered) in mask.iter_mut().enumerate() {
                let point = position(x + lane, y, sample);
                *covered &= (left..right).contains(&point.x) && (top..bottom).contains(&point.y);
            }
        }
        for distance in &self.distances {
            for (lane, covered) in mask.iter_mut().enumerate() {
                *covered &= distance.at(position(x + lane, y, sample)) >= 0.0;
            }
        }
        if self.clips {
            for (lane, covered) in mask.iter_mut().enumerate() {
                let z = self.clip.at(position(x + lane, y, sample));
                let z = z.clamp(self.clip_range[0], self.clip_range[1]);
                *covered &= (0.0..=1.0).contains(&z);
            }
        }
    }
}

/// Returns the planes of the clip distances that are negative at a vertex. The vertices are a triangle's, or
/// a line's or point's with the first vertex repeated.
fn distances(draw: &Draw, points: [Point; 3], vertices: [PlaneVertex; 3]) -> Vec<DepthPlane> {
    let count = draw.clipping_distances().count_ones() as usize;
    // The distances over w are linear in the window, and have the same signs.
    let over_w = |v: PlaneVertex, n: usize| f64::from(v.distances[n]) / f64::from(v.position[3]);
    let distances = (0..count).map(|n| vertices.map(|v| over_w(v, n)));
    distances
        .filter(|values| values.iter().any(|v| *v < 0.0))
        .map(|values| {
            if signed_area(points) == 0 {
                return DepthPlane::along([points[0], points[1]], [values[0], values[1]]);
            }
            DepthPlane::new(points, values)
        })
        .collect()
}

/// Returns the active clip distances of a vertex.
pub(crate) fn clipping(draw: &Draw, vertex: &etalon_scene::Vertex) -> [f32; MOST_DISTANCES] {
    let mut result = [0.0; MOST_DISTANCES];
    let distances = clip_distances(draw.shader, vertex).into_iter().enumerate();
    let clip = distances.filter(|(n, _)| draw.clipping_distances() & (1 << n) != 0);
    for (slot, (_, distance)) in result.iter_mut().zip(clip) {
        *slot = distance;
    }
    result
}

/// Returns the least and the greatest of three numbers.
fn ends([a, b, c]: [f32; 3]) -> [f32; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Returns the depth bias of a polygon.
pub(crate) fn depth_bias(
    draw: &Draw,
    points: [Point; 3],
    z: [f32; 3],
    encoding: Option<ChannelEncoding>,
    steps: &impl Steps,
) -> f64 {
    let plane = || DepthPlane::new(points, z.map(f64::from));
    plane_bias(
        draw,
        plane,
        f64::from(z[0].max(z[1]).max(z[2])),
        encoding,
        steps,
    )
}

/// Returns the depth bias of a polygon with this plane and greatest depth.
pub(crate) fn plane_bias(
    draw: &Draw,
    plane: impl FnOnce() -> DepthPlane,
    largest: f64,
    encoding: Option<ChannelEncoding>,
    steps: &impl Steps,
) -> f64 {
    let state = &draw.depth_bias;
    let Some(encoding) = encoding else { return 0.0 };
    if state.constant == 0 && state.slope == 0.0 {
        return 0.0;
    }
    let unit = steps.bias_unit(encoding, largest);
    let plane = plane();
    let slope = steps.slope(plane.dx * UNITS as f64, plane.dy * UNITS as f64);
    steps.bias(state, unit, slope)
}
