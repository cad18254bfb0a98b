//! Bugs of read-only depth and stencil.

use crate::fields::{DEPTH_WRITE, FACES};
use crate::list::{CONFUSION, List};
use crate::plant::{Plant, all_draws, passes};
use etalon_scene::{Draw, StencilOperation};

/// Changes the draws of read-only passes.
fn read_only(bug: fn(&mut Draw)) -> Plant {
    passes(move |_, _, pass| {
        if pass.depth_stencil_read_only {
            pass.draws.iter_mut().for_each(bug);
        }
    })
}

pub(super) fn add(list: &mut List) {
    list.class("read-only", "depth");
    list.source("read-only attachments treated as writable");
    list.bug("depth-still-written: Read-only depth is still written.")
        .plant(read_only(|d| {
            DEPTH_WRITE(d).into_iter().for_each(|write| *write = true)
        }));
    list.bug("depth-untested: Read-only depth is not tested.")
        .plant(read_only(|d| d.depth = None));
    list.bug("stencil-still-written: Read-only stencil is replaced.")
        .plant(read_only(|d| {
            FACES(d)
                .into_iter()
                .for_each(|f| f.pass_op = StencilOperation::Replace)
        }));
    list.bug("stencil-untested: Read-only stencil is not tested.")
        .plant(read_only(|d| d.stencil = None));
    list.source(CONFUSION);
    list.bug("from-the-start: A read-only attachment is not written by earlier passes either.")
        .scene(|scene| {
            if scene.passes.iter().any(|p| p.depth_stencil_read_only) {
                all_draws(scene)
                    .flat_map(DEPTH_WRITE)
                    .for_each(|write| *write = false);
            }
        });
}
