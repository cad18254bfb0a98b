//! The fragment pipeline's arithmetic, written once and generic over its number system.
//!
//! There are two number systems: [`Plain`], 32-bit floats in lanes, for the rasterizer, and the intervals of
//! the judge. Both callers use the same functions and therefore the same pipeline; a property test in
//! `reference` checks that plain results are inside judging ones.
//!
//! Values that are exact in every specification (stencil values, write masks, the edge functions of
//! snapped vertices) are computed in integers and have no number system.
//!
//! The sRGB functions of [`Plain`] are also available for many values at once.

mod advanced;
mod arithmetic;
mod blend;
mod cell_hash;
mod coverage;
mod depth;
mod half_float;
mod homogeneous;
mod logic;
mod plain;
mod rounding;
mod sampling;
pub mod shader;
mod srgb;
mod stencil;
mod viewport;

pub use advanced::advanced_blend;
pub use arithmetic::Arithmetic;
pub use blend::{BlendInput, blend};
pub use cell_hash::cell_hash;
pub use coverage::{Point, SnappedTriangle, edge_value, is_top_left, signed_area};
pub use depth::{DepthPlane, slope};
pub use homogeneous::{
    CutEdge, FARTHEST, HomogeneousTriangle, WindowVertex, clipped_segment, dot, is_cut,
    line_through, window_vertex,
};
pub use logic::{logic_operation, takes_logic};
pub use plain::Plain;
pub use sampling::texel_position;
pub use srgb::{srgb_codes, srgb_values};
pub use stencil::{compare, exported_reference, stencil_operation, stencil_passes, stencil_write};
pub use viewport::{front_facing, is_beyond, is_culled, window_coordinate, window_position};
