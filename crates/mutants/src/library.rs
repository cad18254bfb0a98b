//! The whole library, class by class.

use crate::list::List;
use crate::mutant::Mutant;
use crate::{
    bias, blend, clear, cull, depth, early, formats, geometry, invariance, logic, mask,
    multisample, readback, scissor, stencil, sticky, targets, texture, topology,
};
use std::sync::LazyLock;

/// Returns all mutants, class by class.
pub fn mutants() -> &'static [Mutant] {
    static ALL: LazyLock<Vec<Mutant>> = LazyLock::new(|| {
        let mut list = List::default();
        depth::add(&mut list);
        bias::add(&mut list);
        stencil::add(&mut list);
        blend::add(&mut list);
        blend::precision::add(&mut list);
        mask::add(&mut list);
        formats::add(&mut list);
        targets::add(&mut list);
        logic::add(&mut list);
        cull::add(&mut list);
        topology::add(&mut list);
        multisample::add(&mut list);
        scissor::add(&mut list);
        clear::add(&mut list);
        geometry::add(&mut list);
        early::add(&mut list);
        texture::add(&mut list);
        invariance::add(&mut list);
        readback::add(&mut list);
        sticky::add(&mut list);
        list.mutants
    });
    &ALL
}
