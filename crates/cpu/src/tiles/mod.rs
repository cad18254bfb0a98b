//! Scenes of common states in tiles: kernels that are chosen once per draw, in vectors, on several threads.
//!
//! What the kernels draw is bit for bit what the [span code](crate::raster) draws, which tests hold; a scene with a
//! state that has no kernel is left to it. [`plan`] chooses. A pass goes through [`setup`], which transforms vertices
//! and sorts triangles into tiles, and through [`tile`], which draws a tile to its end before the next.
//!
//! A picture depends neither on the number of threads nor on the vector instructions: no tile is shared, each draws
//! its triangles in their order, and no product is fused with a sum.

mod affine;
mod bits;
mod depth;
mod depth_stencil;
mod edges;
mod fragments;
mod image;
mod lanes;
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
pub(crate) use plan::Plan;
pub(crate) use scene::{Machine, TiledScene};

/// The texels of a tile's sides.
const TILE: usize = 64;

#[cfg(test)]
mod tests;
