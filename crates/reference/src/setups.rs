//! The primitives of a scene, pass by pass.

use crate::bins::PassSetup;
use crate::context::PassContext;
use crate::primitive::Shape;
use crate::read_back::depth_encoding;
use crate::rules::Rules;
use crate::texels::Texels;
use etalon_frame::{ChannelEncoding, Limits};
use etalon_scene::{Pass, Scene};
use rustc_hash::FxHashMap;
use std::num::NonZeroU64;

/// Returns the setup of each pass, with the triangles that miss all judged samples or without them.
pub(crate) fn setups(
    scene: &Scene,
    limits: &Limits,
    rules: &Rules,
    texels: Texels,
    keeps_misses: bool,
) -> Vec<PassSetup> {
    let setups = scene.passes.iter().map(|pass| {
        let context = PassContext {
            rules,
            limits,
            size: scene.pass_size(pass),
            samples: scene.pass_samples(pass),
            keeps_misses,
            lattice: texels.lattice(scene.pass_size(pass)),
            depth: pass_depth(scene, limits, pass),
        };
        PassSetup::new(&context, pass)
    });
    without_lone_geometry(setups.collect())
}

/// Returns the encoding of a pass's depth, if it has one.
pub(crate) fn pass_depth(scene: &Scene, limits: &Limits, pass: &Pass) -> Option<ChannelEncoding> {
    pass.depth_stencil
        .filter(|i| scene.attachments[*i].format.has_depth())
        .map(|i| depth_encoding(scene, limits, i))
}

/// Removes the geometry numbers of primitives that no other primitive of the scene repeats: they would only
/// distinguish states that are otherwise equal.
fn without_lone_geometry(mut setups: Vec<PassSetup>) -> Vec<PassSetup> {
    let mut times: FxHashMap<NonZeroU64, u32> = FxHashMap::default();
    let primitives = setups.iter_mut().flat_map(PassSetup::primitives_mut);
    for geometry in primitives.filter_map(|primitive| primitive.geometry) {
        *times.entry(geometry).or_default() += 1;
    }
    for primitive in setups.iter_mut().flat_map(PassSetup::primitives_mut) {
        let lone = |geometry: &NonZeroU64| times[geometry] == 1;
        if matches!(primitive.shape, Shape::Triangle(_)) {
            primitive.geometry = primitive.geometry.filter(|g| !lone(g));
        }
    }
    setups
}
