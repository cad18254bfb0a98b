//! Scenes with common states, drawn in tiles: with kernels that are chosen once per draw, in vectors, on
//! several threads.
//!
//! The kernels draw the same bits as the [span code](crate::raster), which tests check. The span code draws
//! scenes with a state that has no kernel. [`plan`] chooses. A pass goes through [`setup`], which transforms
//! vertices and sorts triangles into tiles, and through [`tile`], which completes a tile before the next.
//!
//! A picture depends neither on the number of threads nor on the vector instructions: no tile is shared, each
//! tile draws its triangles in order, and no product is fused with a sum.

mod affine;
mod bits;
mod depth;
mod depth_stencil;
mod edges;
mod fragments;
mod image;
mod lanes;
mod layer;
mod layout;
mod linear;
mod listing;
mod opaque;
mod paint;
mod plan;
mod planes;
mod resolve;
mod scene;
mod setup;
mod texels;
mod texture;
mod threads;
mod tile;
mod triangle;
mod varying;
mod weights;
mod work;

pub(crate) use listing::lines;
pub(crate) use plan::KernelPlan;
pub use scene::KernelMachine;
pub(crate) use scene::TiledScene;
pub(crate) use threads::on_threads;

/// The width and height of a tile in texels.
const TILE: usize = 64;

/// The texels of a tile.
const AREA: usize = TILE * TILE;
