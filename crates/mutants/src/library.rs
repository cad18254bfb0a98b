//! The whole library, class by class.

use crate::list::List;
use crate::mutant::Mutant;
use crate::{
    bias, blend, bounds, capability, carried, clear, clip_distance, counter, cull, depth,
    depth_range, discard, dual_source, early, fetch, formats, geometry, held, hierarchy,
    invariance, logic, mask, provoking, read_only, readback, resolve, sample_coverage,
    sample_shading, samples, scissor, sequence, shader_mask, size, stencil, stencil_export, sticky,
    targets, tessellation, texture, tiled, topology, upload, viewport,
};
use std::sync::LazyLock;

/// Returns all mutants, class by class.
pub fn mutants() -> &'static [Mutant] {
    static ALL: LazyLock<Vec<Mutant>> = LazyLock::new(|| {
        let mut list = List::default();
        depth::add(&mut list);
        bias::add(&mut list);
        depth_range::add(&mut list);
        bounds::add(&mut list);
        read_only::add(&mut list);
        stencil::add(&mut list);
        blend::add(&mut list);
        blend::precision::add(&mut list);
        blend::advanced::add(&mut list);
        mask::add(&mut list);
        formats::add(&mut list);
        targets::add(&mut list);
        dual_source::add(&mut list);
        logic::add(&mut list);
        cull::add(&mut list);
        topology::add(&mut list);
        tessellation::add(&mut list);
        provoking::add(&mut list);
        samples::add(&mut list);
        sample_shading::add(&mut list);
        sample_coverage::add(&mut list);
        resolve::add(&mut list);
        scissor::add(&mut list);
        viewport::add(&mut list);
        clip_distance::add(&mut list);
        capability::add(&mut list);
        clear::add(&mut list);
        geometry::add(&mut list);
        upload::add(&mut list);
        fetch::add(&mut list);
        early::add(&mut list);
        discard::add(&mut list);
        counter::add(&mut list);
        texture::add(&mut list);
        invariance::add(&mut list);
        readback::add(&mut list);
        sticky::add(&mut list);
        tiled::add(&mut list);
        hierarchy::add(&mut list);
        carried::add(&mut list);
        sequence::add(&mut list);
        size::add(&mut list);
        shader_mask::add(&mut list);
        stencil_export::add(&mut list);
        held::add(&mut list);
        list.mutants
    });
    &ALL
}
