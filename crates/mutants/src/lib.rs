//! Planted bugs: the proof that the suite can fail.
//!
//! A [`Mutant`] is a small, named mutation of the rasterizer: of the scene that it draws, of one step
//! of its arithmetic, or of the frame that it returns. A mutation of data or of a single step keeps the
//! rasterizer free of test code. `tests/hunt` holds that cases catch each mutant or that a clause allows
//! it; `etalon mutants` reports which cases do.
//!
//! To add one, call `List::add` in the file of its class.

mod backend;
mod bias;
mod blend;
mod bounds;
mod capability;
mod carried;
mod clear;
mod clip_distance;
mod counter;
mod cull;
mod depth;
mod depth_range;
mod discard;
mod dual_source;
mod early;
mod fetch;
mod formats;
mod geometry;
mod held;
mod hierarchy;
mod hooks;
mod invariance;
mod library;
mod list;
mod logic;
mod mask;
mod memory;
mod mutant;
mod plant;
mod provoking;
mod read_only;
mod readback;
mod resolve;
mod sample_coverage;
mod sample_shading;
mod samples;
mod scissor;
mod sequence;
mod shader_mask;
mod size;
mod stencil;
mod stencil_export;
mod sticky;
mod tables;
mod targets;
mod tessellation;
mod texture;
mod tiled;
mod topology;
mod upload;
mod viewport;

pub use backend::MutantBackend;
pub use library::mutants;
pub use mutant::Mutant;

#[cfg(test)]
mod tests;
