//! Bugs of read-only depth and stencil.

use crate::fields::{DEPTH, DEPTH_WRITE, PASS_OP, STENCIL_TEST};
use crate::list::{CONFUSION, bugs};
use crate::plant::{Plant, all_draws, passes, scene, setter};
use etalon_scene::{Draw, StencilOperation};

/// Changes the draws of passes that come `behind` passes after a read-only pass.
pub(super) fn read_only(behind: usize, bug: impl Fn(&mut Draw) + Send + Sync + 'static) -> Plant {
    passes(move |scene, number, pass| {
        let before = number.checked_sub(behind).map(|n| &scene.passes[n]);
        if before.is_some_and(|before| before.depth_stencil_read_only) {
            pass.draws.iter_mut().for_each(&bug);
        }
    })
}

bugs! {
    class "read-only", "depth";
    source "read-only attachments treated as writable";
    "depth-still-written: Read-only depth is still written." => read_only(0, setter(DEPTH_WRITE, true));
    "depth-untested: Read-only depth is not tested." => read_only(0, setter(DEPTH, None));
    "stencil-still-written: Read-only stencil is replaced." => read_only(0, setter(PASS_OP, StencilOperation::Replace));
    "stencil-untested: Read-only stencil is not tested." => read_only(0, setter(STENCIL_TEST, None));
    source CONFUSION;
    "from-the-start: A read-only attachment is not written by earlier passes either." =>
        scene(|scene| if scene.passes.iter().any(|p| p.depth_stencil_read_only) {
            all_draws(scene).for_each(setter(DEPTH_WRITE, false));
        });
}
