//! Prepared surfaces: edges, depth as a linear function, and bounds of the paint.

use super::cell::{ConvexCell, PicturePoint, SLACK};
use etalon_methods::{FlatSurface, Paint, StraightTexture};

/// A linear function of a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear {
    origin: PicturePoint,
    value: f64,
    slope: [f64; 2],
}

impl Linear {
    /// Returns the function with these values at these corners. If no linear function has them, returns the
    /// mean of those through the triangles around the first corner, weighted by their areas.
    fn through(corners: &[PicturePoint], values: &[f64]) -> Self {
        let (origin, value) = (corners[0], values[0]);
        let (mut area, mut slope) = (0.0, [0.0; 2]);
        for (corners, values) in corners.windows(2).zip(values.windows(2)).skip(1) {
            let [a, b] = [0, 1].map(|i| [corners[i][0] - origin[0], corners[i][1] - origin[1]]);
            let [u, v] = [values[0] - value, values[1] - value];
            area += a[0] * b[1] - a[1] * b[0];
            slope[0] += u * b[1] - v * a[1];
            slope[1] += v * a[0] - u * b[0];
        }
        Self {
            origin,
            value,
            slope: slope.map(|s| s / area),
        }
    }

    /// Returns its value at a point.
    pub(super) fn at(&self, p: PicturePoint) -> f64 {
        self.value
            + self.slope[0] * (p[0] - self.origin[0])
            + self.slope[1] * (p[1] - self.origin[1])
    }

    fn is_finite(&self) -> bool {
        self.slope.iter().all(|s| s.is_finite())
    }
}

/// One side of a polygon. The order of its ends is the same for both polygons that share it, so that they
/// compute the same number for a point up to the sign.
#[derive(Clone, Copy, Debug)]
struct SurfaceEdge {
    from: PicturePoint,
    to: PicturePoint,
    /// 1 over its length, negative if the inside is on the other side.
    scale: f64,
    /// True if a point on the edge belongs to this polygon: the top-left rule.
    owns: bool,
}

impl SurfaceEdge {
    fn new(a: PicturePoint, b: PicturePoint, orientation: f64) -> Self {
        let swapped = a > b;
        let (from, to) = if swapped { (b, a) } else { (a, b) };
        let sign = if swapped { -orientation } else { orientation };
        let along = [to[0] - from[0], to[1] - from[1]];
        // Points inwards: to the right of a left edge, down from a top edge.
        let inwards = [-along[1] * sign, along[0] * sign];
        Self {
            from,
            to,
            scale: sign / along[0].hypot(along[1]),
            owns: inwards[0] > 0.0 || (inwards[0] == 0.0 && inwards[1] > 0.0),
        }
    }

    /// Returns the signed distance of a point from the edge in texels, positive inside.
    fn distance(&self, p: PicturePoint) -> f64 {
        let across = (self.to[0] - self.from[0]) * (p[1] - self.from[1])
            - (self.to[1] - self.from[1]) * (p[0] - self.from[0]);
        across * self.scale
    }
}

/// The part of a rectangle that a polygon covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Overlap {
    /// The polygon misses the rectangle by more than rounding error.
    None,
    /// The polygon may cover a part of the rectangle.
    Part,
    /// The polygon covers the whole rectangle, with more than rounding error to spare.
    Whole,
}

/// A surface of positive area, ready to be evaluated.
#[derive(Debug)]
pub(super) struct PreparedSurface<'a> {
    pub(super) paint: &'a Paint,
    pub(super) depth: Linear,
    /// The texture coordinates of a textured surface, across and down.
    pub(super) uv: Option<[Linear; 2]>,
    /// The largest rounding error of a depth.
    pub(super) slack: f64,
    /// True if the surface hides everything behind it.
    pub(super) opaque: bool,
    /// The least and the largest value of any channel of its colour.
    pub(super) tones: [(f64, f64); 3],
    edges: Vec<SurfaceEdge>,
    low: PicturePoint,
    high: PicturePoint,
}

impl<'a> PreparedSurface<'a> {
    /// Returns the prepared surface; `None` if it covers nothing: fewer than three distinct corners, no area,
    /// or invalid numbers in it or in its paint.
    pub(super) fn new(surface: &'a FlatSurface) -> Option<Self> {
        let corners: Vec<PicturePoint> = surface.corners.iter().map(|c| [c[0], c[1]]).collect();
        let depths: Vec<f64> = surface.corners.iter().map(|c| c[2]).collect();
        let finite = surface.corners.iter().flatten().all(|v| v.is_finite());
        if corners.len() < 3 || !finite {
            return None;
        }
        let bound = |pick: fn(f64, f64) -> f64, axis: usize| {
            corners.iter().map(|c| c[axis]).fold(corners[0][axis], pick)
        };
        let low = [0, 1].map(|axis| bound(f64::min, axis));
        let high = [0, 1].map(|axis| bound(f64::max, axis));
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let area: f64 = corners
            .windows(2)
            .map(|side| {
                let [a, b] =
                    [0, 1].map(|i| [side[i][0] - corners[0][0], side[i][1] - corners[0][1]]);
                a[0] * b[1] - a[1] * b[0]
            })
            .sum();
        // A smaller area is due to rounding. An extent or an area that overflows also fails the test.
        let least = 1e-13 * extent * extent;
        if !(area.is_finite() && area.abs() > least) {
            return None;
        }
        let next = corners.iter().cycle().skip(1);
        let edges = corners.iter().zip(next).filter(|(a, b)| a != b);
        let edges: Vec<SurfaceEdge> = edges
            .map(|(a, b)| SurfaceEdge::new(*a, *b, area.signum()))
            .collect();
        let depth = Linear::through(&corners, &depths);
        let uv = match &surface.paint {
            Paint::Texture { uv, .. } => {
                if uv.len() != corners.len() {
                    return None;
                }
                let along = |axis: usize| {
                    let values: Vec<f64> = uv.iter().map(|uv| uv[axis]).collect();
                    Linear::through(&corners, &values)
                };
                Some([along(0), along(1)])
            }
            _ => None,
        };
        let largest = depths.iter().fold(0.0, |m: f64, z| m.max(z.abs()));
        let across = (depth.slope[0].abs() + depth.slope[1].abs()) * (extent + 1.0);
        let mut linears = uv.iter().flatten().chain([&depth]);
        if !linears.all(Linear::is_finite) {
            return None;
        }
        Some(Self {
            paint: &surface.paint,
            depth,
            uv,
            slack: 64.0 * f64::EPSILON * (largest + across),
            opaque: is_opaque(&surface.paint),
            tones: tones(&surface.paint, &depths)?,
            edges,
            low,
            high,
        })
    }

    /// Returns true if the surface covers a point. Of two surfaces that share an edge, exactly one covers a
    /// point on it.
    pub(super) fn covers(&self, p: PicturePoint) -> bool {
        self.edges.iter().all(|edge| {
            let distance = edge.distance(p);
            distance > 0.0 || (distance == 0.0 && edge.owns)
        })
    }

    /// Returns how much of a rectangle the surface covers; `Part` if rounding could decide.
    pub(super) fn overlap(&self, low: PicturePoint, high: PicturePoint) -> Overlap {
        const ROOM: f64 = 1e-9;
        let apart =
            |axis: usize| self.high[axis] < low[axis] - ROOM || self.low[axis] > high[axis] + ROOM;
        if apart(0) || apart(1) {
            return Overlap::None;
        }
        let rectangle = ConvexCell::rectangle(low, high);
        let mut overlap = Overlap::Whole;
        for edge in &self.edges {
            let (least, most) = rectangle.range(|p| edge.distance(p));
            if most < -ROOM {
                return Overlap::None;
            }
            if least < ROOM {
                overlap = Overlap::Part;
            }
        }
        overlap
    }

    /// Returns the number of edges.
    pub(super) fn edges(&self) -> usize {
        self.edges.len()
    }

    /// Returns true if the line through one of its edges is at most this many texels away from a point.
    pub(super) fn edge_is_near(&self, p: PicturePoint, distance: f64) -> bool {
        self.edges
            .iter()
            .any(|edge| edge.distance(p).abs() <= distance)
    }

    /// Returns the signed distance of a point from one of its edges in texels, positive inside.
    pub(super) fn inside(&self, edge: usize, p: PicturePoint) -> f64 {
        self.edges[edge].distance(p)
    }

    /// Returns true if a cell is outside one of the edges.
    pub(super) fn misses(&self, cell: &ConvexCell) -> bool {
        let mut edges = self.edges.iter();
        edges.any(|edge| cell.range(|p| edge.distance(p)).1 <= SLACK)
    }
}

fn is_opaque(paint: &Paint) -> bool {
    match paint {
        Paint::Flat(color) => color[3] >= 1.0,
        Paint::Depth | Paint::Distance { .. } | Paint::Fog { .. } => true,
        Paint::Texture { texture, .. } => texture.texels.iter().all(|texel| texel[3] >= 1.0),
    }
}

/// Returns the least and the largest value of each channel; `None` if the paint is invalid.
fn tones(paint: &Paint, depths: &[f64]) -> Option<[(f64, f64); 3]> {
    let hull = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        })
    };
    let planes =
        |near: f64, far: f64| near > 0.0 && far > 0.0 && near != far && (near + far).is_finite();
    match paint {
        Paint::Flat(color) => {
            let meant = color.iter().all(|v| v.is_finite());
            meant.then(|| [0, 1, 2].map(|c| (color[c], color[c])))
        }
        Paint::Depth => Some([hull(&mut depths.iter().copied()); 3]),
        Paint::Distance { near, far } => planes(*near, *far).then_some([(0.0, 1.0); 3]),
        Paint::Fog {
            color,
            fog,
            near,
            far,
        } => {
            let meant = color.iter().chain(fog).all(|v| v.is_finite()) && planes(*near, *far);
            meant.then(|| [0, 1, 2].map(|c| (color[c].min(fog[c]), color[c].max(fog[c]))))
        }
        Paint::Texture { texture, .. } => {
            let meant =
                has_all_texels(texture) && texture.texels.iter().flatten().all(|v| v.is_finite());
            meant.then(|| [0, 1, 2].map(|c| hull(&mut texture.texels.iter().map(|t| t[c]))))
        }
    }
}

fn has_all_texels(texture: &StraightTexture) -> bool {
    let [width, height] = texture.size.map(|n| n as usize);
    let texels = width.checked_mul(height);
    texels.is_some_and(|n| n > 0 && n == texture.texels.len())
}
