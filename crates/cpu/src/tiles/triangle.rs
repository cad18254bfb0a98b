//! Triangles in the window.

use etalon_pipeline::Point;

/// A vertex in the window.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Placed {
    /// In sub-texel units.
    pub(crate) at: [i32; 2],
    pub(crate) z: f32,
}

/// A triangle that may cover samples: a line of the processor's cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Triangle {
    /// In the order of the primitive, which the depth's plane depends on.
    pub(crate) corners: [Placed; 3],
    /// The place in its part of what few triangles have; the number of all of them if it has nothing.
    pub(crate) rare: u32,
    /// The code of all its depths, if it is flat.
    pub(crate) code: u32,
    /// The place of its draw among the pass's kernels.
    pub(crate) draw: u32,
    /// The place of its paint in its part.
    pub(crate) paint: u32,
    /// The first and the last column and row of the texels that it may cover.
    pub(crate) around: [i16; 4],
    pub(crate) front: bool,
    pub(crate) shape: Shape,
    /// True if its corners stand counter-clockwise on the screen.
    pub(crate) counter: bool,
    /// True if scissor or viewport may cut it.
    pub(crate) cut: bool,
}

const _: () = assert!(size_of::<Triangle>() == 64);

/// The properties that few triangles have.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rare {
    /// The bias of its depths.
    pub(crate) bias: f64,
    /// Its vertices, if its colour is a texture's.
    pub(crate) vertices: [u32; 3],
}

/// The form of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Of several depths.
    Sloped,
    /// The same, and not larger than a tile.
    SlopedNear,
    /// Of one depth.
    Flat,
    /// The same, and not larger than a tile.
    FlatNear,
    /// Of one depth, within one tile, in few columns, and cut by nothing.
    Small,
}

impl Triangle {
    /// True if all of it has one depth.
    #[inline(always)]
    pub(crate) fn is_flat(&self) -> bool {
        matches!(self.shape, Shape::Flat | Shape::FlatNear | Shape::Small)
    }

    /// True if it is not larger than a tile.
    #[inline(always)]
    pub(crate) fn is_near(&self) -> bool {
        !matches!(self.shape, Shape::Flat | Shape::Sloped)
    }
}

/// Returns a position as the pipeline has it.
pub(crate) fn point([x, y]: [i32; 2]) -> Point {
    Point {
        x: i64::from(x),
        y: i64::from(y),
    }
}

/// Returns the corners in clockwise order on the screen.
#[inline(always)]
pub(crate) fn clockwise(triangle: &Triangle) -> [[i32; 2]; 3] {
    let [a, b, c] = [0, 1, 2].map(|i: usize| triangle.corners[i].at);
    if triangle.counter {
        [a, c, b]
    } else {
        [a, b, c]
    }
}
