//! Polygons, and meshes of them.

use crate::truth::{FlatSurface, Paint};
use etalon_scene::{Mesh, Vertex};

/// A flat convex polygon that is drawn.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    /// Corners in order: x and y in texels from the top left corner, and the window depth.
    pub(crate) corners: Vec<[f64; 3]>,
    /// The vertex colour: straight red, green, blue and alpha.
    pub(crate) color: [f64; 4],
    /// Texture coordinates of each corner; empty if unused.
    pub(crate) uv: Vec<[f64; 2]>,
    /// Clip-space w of each corner, by which the driver divides; empty if every w is 1.
    pub(crate) w: Vec<f64>,
}

impl Polygon {
    /// Creates a polygon of one colour.
    pub(crate) fn new(corners: Vec<[f64; 3]>, color: [f64; 4]) -> Self {
        Self {
            corners,
            color,
            uv: Vec::new(),
            w: Vec::new(),
        }
    }

    /// Creates an upright rectangle between left, top, right and bottom in texels, at one depth,
    /// counter-clockwise as seen: a front face.
    pub(crate) fn rect([left, top, right, bottom]: [f64; 4], depth: f64, color: [f64; 4]) -> Self {
        let corners = vec![
            [left, top, depth],
            [left, bottom, depth],
            [right, bottom, depth],
            [right, top, depth],
        ];
        Self::new(corners, color)
    }

    /// Returns the polygon as a surface of the truth, in its own colour.
    pub(crate) fn surface(&self) -> FlatSurface {
        FlatSurface {
            corners: self.corners.clone(),
            paint: Paint::Flat(self.color),
        }
    }
}

/// Returns the polygons as a list of triangles, each polygon a fan around its first corner.
pub(crate) fn mesh(size: [u32; 2], polygons: &[Polygon]) -> Mesh {
    let clip = |value: f64, size: u32| value / f64::from(size) * 2.0 - 1.0;
    let vertex = |polygon: &Polygon, i: usize| {
        let [x, y, z] = polygon.corners[i];
        let uv = polygon.uv.get(i).copied().unwrap_or_default();
        let w = polygon.w.get(i).copied().unwrap_or(1.0);
        let position = [clip(x, size[0]) * w, -clip(y, size[1]) * w, z * w, w];
        Vertex {
            position: position.map(|v| v as f32),
            color: polygon.color.map(|c| c as f32),
            uv: uv.map(|c| c as f32),
        }
    };
    let mut vertices = Vec::new();
    for polygon in polygons {
        for i in 1..polygon.corners.len().saturating_sub(1) {
            vertices.extend([0, i, i + 1].map(|i| vertex(polygon, i)));
        }
    }
    Mesh {
        vertices,
        indices: None,
    }
}

/// Returns a triangle that covers everything, with texture coordinates 0 to 1 from the top left corner.
pub(crate) fn cover() -> Mesh {
    let vertex = |x: f32, y: f32| Vertex {
        position: [x, y, 0.0, 1.0],
        color: [1.0; 4],
        uv: [(x + 1.0) / 2.0, (1.0 - y) / 2.0],
    };
    Mesh {
        vertices: vec![vertex(-1.0, 1.0), vertex(-1.0, -3.0), vertex(3.0, 1.0)],
        indices: None,
    }
}
