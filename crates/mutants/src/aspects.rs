//! The operations of passes and clear commands on one aspect.

use etalon_frame::Aspect;
use etalon_scene::{Clear, ClearTarget, LoadOperation, Operations, Pass, StoreOperation};

pub(super) const ASPECTS: [Aspect; 3] = [Aspect::Color, Aspect::Depth, Aspect::Stencil];

/// Depth with stencil and stencil with depth, and the value to which a bug clears the second aspect.
pub(super) const ASPECT_PAIRS: [(Aspect, Aspect, u32); 2] = [
    (Aspect::Depth, Aspect::Stencil, 0),
    (Aspect::Stencil, Aspect::Depth, 1),
];

/// Returns the name for use in a sentence.
pub(super) fn word(aspect: Aspect) -> &'static str {
    match aspect {
        Aspect::Color => "colour",
        Aspect::Depth => "depth",
        Aspect::Stencil => "stencil",
    }
}

/// Changes the operations of all colour attachments.
fn each_color(pass: &mut Pass, change: impl FnMut(&mut Operations<[f32; 4]>)) {
    let operations = &mut pass.operations.color;
    operations.resize_with(pass.color.len(), Default::default);
    operations.iter_mut().for_each(change);
}

fn clears<T: PartialEq>(operations: &Operations<T>) -> bool {
    operations.load != LoadOperation::Load
}

/// Returns true if a pass begins with a clear of this aspect, of any colour attachment for colours.
pub(super) fn is_cleared(pass: &Pass, aspect: Aspect) -> bool {
    match aspect {
        Aspect::Color => pass.operations.color.iter().any(clears),
        Aspect::Depth => clears(&pass.operations.depth),
        Aspect::Stencil => clears(&pass.operations.stencil),
    }
}

/// Makes a pass begin with a clear: to 0, or to a depth of 1.
pub(super) fn clear(pass: &mut Pass, aspect: Aspect) {
    match aspect {
        Aspect::Color => each_color(pass, |o| o.load = LoadOperation::Clear([0.0; 4])),
        _ if pass.depth_stencil_read_only => {}
        Aspect::Depth => pass.operations.depth.load = LoadOperation::Clear(1.0),
        Aspect::Stencil => pass.operations.stencil.load = LoadOperation::Clear(0),
    }
}

/// Makes a pass load an aspect at its beginning, and keep depth or stencil at its end.
pub(super) fn load(pass: &mut Pass, aspect: Aspect) {
    match aspect {
        Aspect::Color => each_color(pass, |o| o.load = LoadOperation::Load),
        Aspect::Depth => pass.operations.depth = Operations::default(),
        Aspect::Stencil => pass.operations.stencil = Operations::default(),
    }
}

fn discards<T>(operations: &Operations<T>) -> bool {
    operations.store == StoreOperation::Discard
}

/// Returns true if a pass ends with a discard of this aspect, of any colour attachment for colours.
pub(super) fn is_discarded(pass: &Pass, aspect: Aspect) -> bool {
    match aspect {
        Aspect::Color => pass.operations.color.iter().any(discards),
        Aspect::Depth => discards(&pass.operations.depth),
        Aspect::Stencil => discards(&pass.operations.stencil),
    }
}

/// Makes a pass end with a discard.
pub(super) fn discard(pass: &mut Pass, aspect: Aspect) {
    match aspect {
        Aspect::Color => each_color(pass, |o| o.store = StoreOperation::Discard),
        _ if pass.depth_stencil.is_none() || pass.depth_stencil_read_only => {}
        Aspect::Depth => pass.operations.depth.store = StoreOperation::Discard,
        Aspect::Stencil => pass.operations.stencil.store = StoreOperation::Discard,
    }
}

/// Returns true if a command clears an aspect.
pub(super) fn reaches(command: &Clear, aspect: Aspect) -> bool {
    match command.target {
        ClearTarget::Color { .. } => aspect == Aspect::Color,
        ClearTarget::DepthStencil { depth, stencil, .. } => match aspect {
            Aspect::Color => false,
            Aspect::Depth => depth.is_some(),
            Aspect::Stencil => stencil.is_some(),
        },
    }
}

/// Makes a command that clears depth or stencil clear both.
pub(super) fn reach_both(command: &mut Clear) {
    if let ClearTarget::DepthStencil { depth, stencil, .. } = &mut command.target {
        depth.get_or_insert(1.0);
        stencil.get_or_insert(0);
    }
}
