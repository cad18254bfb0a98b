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
mod clear;
mod cull;
mod depth;
mod early;
mod formats;
mod geometry;
mod hooks;
mod invariance;
mod library;
mod list;
mod logic;
mod mask;
mod multisample;
mod mutant;
mod plant;
mod readback;
mod scissor;
mod stencil;
mod sticky;
mod tables;
mod targets;
mod texture;
mod topology;

pub use backend::MutantBackend;
pub use library::mutants;
pub use mutant::Mutant;

#[cfg(test)]
mod tests;
