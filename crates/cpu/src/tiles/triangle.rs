//! Triangles in the window.

use etalon_pipeline::Point;

/// A vertex in the window.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Placed {
    /// The position in sub-texel units.
    pub(crate) at: [i32; 2],
    pub(crate) z: f32,
}

/// A triangle that might cover samples. It fills one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct RasterTriangle {
    /// The vertices in the order of the primitive, on which the depth plane depends.
    pub(crate) corners: [Placed; 3],
    /// The index of the triangle's rare properties in its part; `u32::MAX` if it has none.
    pub(crate) rare: u32,
    /// The depth code, if the triangle is flat.
    pub(crate) code: u32,
    /// The index of the triangle's draw among the pass's kernels.
    pub(crate) draw: u32,
    /// The index of the triangle's paint in its part.
    pub(crate) paint: u32,
    /// The first column, first row, last column and last row of the texels that the triangle might cover.
    pub(crate) around: [i16; 4],
    pub(crate) front: bool,
    pub(crate) shape: TriangleKind,
    /// True if the vertices are counter-clockwise on the screen.
    pub(crate) counter: bool,
    /// True if scissor or viewport might cut the triangle.
    pub(crate) cut: bool,
}

const _: () = assert!(size_of::<RasterTriangle>() == 64);

/// The properties that few triangles have.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rare {
    /// The depth bias.
    pub(crate) bias: f64,
    /// The vertices, if the colour comes from a texture.
    pub(crate) vertices: [u32; 3],
}

/// The kind of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TriangleKind {
    /// A triangle whose depth varies.
    Sloped,
    /// A triangle whose depth varies, not larger than a tile.
    SlopedNear,
    /// A triangle of constant depth.
    Flat,
    /// A triangle of constant depth, not larger than a tile.
    FlatNear,
    /// A triangle of constant depth that is inside one tile, few columns wide, and not cut.
    Small,
}

impl RasterTriangle {
    /// Returns true if the triangle has a constant depth.
    #[inline(always)]
    pub(crate) fn is_flat(&self) -> bool {
        matches!(
            self.shape,
            TriangleKind::Flat | TriangleKind::FlatNear | TriangleKind::Small
        )
    }

    /// Returns true if the triangle is not larger than a tile.
    #[inline(always)]
    pub(crate) fn is_near(&self) -> bool {
        !matches!(self.shape, TriangleKind::Flat | TriangleKind::Sloped)
    }
}

/// Returns a position in the pipeline's type.
pub(crate) fn point([x, y]: [i32; 2]) -> Point {
    Point {
        x: i64::from(x),
        y: i64::from(y),
    }
}

/// Returns the corners in clockwise order on the screen.
#[inline(always)]
pub(crate) fn clockwise(triangle: &RasterTriangle) -> [[i32; 2]; 3] {
    let [a, b, c] = [0, 1, 2].map(|i: usize| triangle.corners[i].at);
    if triangle.counter {
        [a, c, b]
    } else {
        [a, b, c]
    }
}
