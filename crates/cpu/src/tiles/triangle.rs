//! Triangles in the window.

use etalon_pipeline::{Point, signed_area};

/// A vertex in the window.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Placed {
    /// In sub-texel units.
    pub(crate) at: [i32; 2],
    pub(crate) z: f32,
}

/// A triangle that may cover samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// In the order of the primitive, which the depth's plane depends on.
    pub(crate) corners: [Placed; 3],
    pub(crate) bias: f64,
    /// The place of its vertices in its part, if its colour is a texture's.
    pub(crate) vertices: u32,
    /// The code of all its depths, if it is flat.
    pub(crate) code: u32,
    /// The place of its draw among the pass's kernels.
    pub(crate) draw: u32,
    /// The place of its paint in its part.
    pub(crate) paint: u32,
    /// The first and the last column and row of the texels that it may cover.
    pub(crate) around: [i16; 4],
    pub(crate) front: bool,
    /// True if all of it has one depth.
    pub(crate) flat: bool,
    /// True if numbers of 32 bits hold its edge functions in its own surroundings.
    pub(crate) small: bool,
    /// True if scissor or viewport may cut it.
    pub(crate) cut: bool,
}

/// Returns a position as the pipeline has it.
pub(crate) fn point([x, y]: [i32; 2]) -> Point {
    Point {
        x: i64::from(x),
        y: i64::from(y),
    }
}

/// Returns the clockwise order of a triangle's corners on the screen.
pub(crate) fn clockwise(corners: &[Placed; 3]) -> [[i32; 2]; 3] {
    let [a, b, c] = corners.map(|v| v.at);
    match signed_area([a, b, c].map(point)) > 0 {
        true => [a, c, b],
        false => [a, b, c],
    }
}
