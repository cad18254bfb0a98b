//! Exact pictures, computed from geometry alone.
//!
//! All surfaces that cover a point are sorted by their depth there and composed over the background in 64-bit
//! floats. Nothing is rasterized, stored or rounded to a format, so the distance of a driver's picture from
//! the truth is the error of the rendering method.

mod area;
mod cell;
mod distance;
mod flip;
mod order;
mod paint;
mod picture;
mod quadrature;
mod render;
mod rgb8;
mod surface;

pub use distance::{distance, lattice_distance};
pub use etalon_methods::{MethodScene, Truth, at_size};
pub use picture::{Lattice, LatticeTruth, TruthPicture};
pub use render::{truth, truth_on};
pub use rgb8::rgb8;
