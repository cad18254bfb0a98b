//! Properties of the judge for any input: judging arithmetic encloses plain arithmetic, the rasterizer's
//! frames are legal, and wider rules never forbid what tighter rules allow.

mod advanced;
mod arithmetic;
mod asked;
mod blending;
mod common;
mod evidence;
mod families;
mod frames;
mod golden;
mod homogeneous;
mod lines;
mod resolves;
mod scenes;
mod steps;
mod textures;
mod wide;
mod worlds;
