//! The fragment pipeline's arithmetic, written once and generic over its number system.
//!
//! Two systems exist: [`Plain`], 32-bit floats in lanes, which the rasterizer computes with, and
//! the judging intervals of the reference. Whoever walks over samples (tiles there, worlds here)
//! calls the same functions, so that both mean the same pipeline; a property test in the reference
//! holds that plain results lie inside judging ones.
//!
//! What is exact in every specification, as stencil values, write masks and the edge functions of
//! snapped vertices, is computed in integers and has no number system.

mod arithmetic;
mod blend;
mod coverage;
mod depth;
mod logic;
mod plain;
mod sampling;
pub mod shader;
mod stencil;
mod viewport;

pub use arithmetic::Arithmetic;
pub use blend::{BlendInput, blend};
pub use coverage::{Point, SnappedTriangle, edge_value, is_top_left, signed_area};
pub use depth::{DepthPlane, slope};
pub use logic::{logic_operation, takes_logic};
pub use plain::Plain;
pub use sampling::texel_position;
pub use stencil::{compare, stencil_operation, stencil_passes, stencil_write};
pub use viewport::{front_facing, is_culled, window_position};
