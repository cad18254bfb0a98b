//! Bugs of read-only depth and stencil.

use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, scene};
use etalon_scene::{Pass, StencilOperation};

pub(super) fn add(list: &mut List) {
    list.class("read-only", "depth");
    read_only(list);
}

fn read_only(list: &mut List) {
    fn passes(bug: fn(&mut Pass)) -> Plant {
        scene(move |scene| {
            let all = scene.passes.iter_mut();
            all.filter(|p| p.depth_stencil_read_only).for_each(bug);
        })
    }
    let rows: [Row<fn(&mut Pass)>; 4] = [
        (
            "depth-still-written",
            "Read-only depth is still written.",
            |pass| {
                let states = pass.draws.iter_mut().filter_map(|d| d.depth.as_mut());
                states.for_each(|d| d.write = true);
            },
        ),
        ("depth-untested", "Read-only depth is not tested.", |pass| {
            pass.draws.iter_mut().for_each(|d| d.depth = None);
        }),
        (
            "stencil-still-written",
            "Read-only stencil is replaced.",
            |pass| {
                for stencil in pass.draws.iter_mut().filter_map(|d| d.stencil.as_mut()) {
                    stencil.front.pass_op = StencilOperation::Replace;
                    stencil.back.pass_op = StencilOperation::Replace;
                }
            },
        ),
        (
            "stencil-untested",
            "Read-only stencil is not tested.",
            |pass| {
                pass.draws.iter_mut().for_each(|d| d.stencil = None);
            },
        ),
    ];
    list.rows("read-only attachments treated as writable", passes, &rows);
    list.add(
        "from-the-start",
        CONFUSION,
        "A read-only attachment is not written by earlier passes either.",
        scene(|scene| {
            if scene.passes.iter().any(|p| p.depth_stencil_read_only) {
                for draw in scene.passes.iter_mut().flat_map(|p| &mut p.draws) {
                    if let Some(depth) = &mut draw.depth {
                        depth.write = false;
                    }
                }
            }
        }),
    );
}
