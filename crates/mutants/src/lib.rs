//! Planted bugs: the proof that the suite can fail.
//!
//! A [`Mutant`] is a small, named mutation of the rasterizer: of the scene that it draws, of one step
//! of its arithmetic, or of the frame that it returns. A mutation of data or of a single step keeps the
//! rasterizer free of test code. `tests/hunt` holds that cases catch each mutant or that a clause allows
//! it; `etalon mutants` reports which cases do.
//!
//! Each file is a table: a row has the name, the effect and what it changes. Most follow from data: an operator
//! (stale, swapped, always, never …) applied to a field of `fields`. To add one, add a row to the table of its class,
//! or name the field in `fields`.

mod aspects;
mod backend;
mod bias;
mod blend;
mod bounds;
mod capability;
mod clear;
mod clip_distance;
mod clipping;
mod combinations;
mod counter;
mod cull;
mod cull_distance;
mod depth;
mod depth_range;
mod discard;
mod dual_source;
mod early;
mod fetch;
mod fields;
mod formats;
mod geometry;
mod held;
mod hierarchy;
mod hooks;
mod input_mask;
mod interpolation;
mod invariance;
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
mod stale;
mod stencil;
mod stencil_export;
mod tables;
mod targets;
mod tessellation;
mod texture;
mod tiled;
mod topology;
mod upload;
mod viewport;

pub use backend::MutantBackend;
pub use mutant::Mutant;

use list::List;
use std::sync::LazyLock;

/// Adds the mutants of a class.
type Class = fn(&mut List);

#[rustfmt::skip]
const CLASSES: &[Class] = &[
    depth::add, bias::add, depth_range::add, bounds::add, read_only::add, stencil::add, blend::add,
    blend::precision::add, blend::advanced::add, mask::add, formats::add, targets::add, dual_source::add,
    logic::add, cull::add, topology::add, tessellation::add, provoking::add, samples::add,
    sample_shading::add, sample_coverage::add, resolve::add, scissor::add, viewport::add,
    clip_distance::add, cull_distance::add, clipping::add, interpolation::add, capability::add,
    clear::add, geometry::add, upload::add, fetch::add, early::add,
    discard::add, counter::add, texture::add, invariance::add, readback::add, stale::sticky, tiled::add,
    hierarchy::add, sequence::add, size::add, shader_mask::add, input_mask::add, stencil_export::add, held::add,
    combinations::add,
];

/// Returns all mutants, class by class.
pub fn mutants() -> &'static [Mutant] {
    static ALL: LazyLock<Vec<Mutant>> = LazyLock::new(|| {
        let mut list = List::default();
        CLASSES.iter().for_each(|add| add(&mut list));
        list.mutants
    });
    &ALL
}

#[cfg(test)]
mod tests;
