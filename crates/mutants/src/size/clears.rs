//! Bugs of clears of memory that a driver only notes as cleared.

use crate::list::{CONFUSION, List};
use crate::plant::{Plant, scene};
use etalon_scene::{Clear, ClearTarget, Contents, LoadOperation, Pass, Scene};

/// Changes clear commands in passes over attachments of more than 64 texels, given their size.
fn commands(bug: impl Fn(&mut Clear, [u32; 2]) + Send + Sync + 'static) -> Plant {
    large(move |pass, size| pass.clears.iter_mut().for_each(|c| bug(c, size)))
}

/// Changes passes over attachments of more than 64 texels, given their size.
fn large(bug: impl Fn(&mut Pass, [u32; 2]) + Send + Sync + 'static) -> Plant {
    scene(move |scene: &mut Scene| {
        for at in 0..scene.passes.len() {
            let size = scene.pass_size(&scene.passes[at]);
            if size[0].max(size[1]) > 64 {
                bug(&mut scene.passes[at], size);
            }
        }
    })
}

/// A rectangle with its edges on multiples of a side, at most as large as the attachments.
fn outward([x, y, w, h]: [u32; 4], side: u32, size: [u32; 2]) -> [u32; 4] {
    let [left, top] = [x, y].map(|v| v / side * side);
    let right = (x + w).next_multiple_of(side).min(size[0]);
    let bottom = (y + h).next_multiple_of(side).min(size[1]);
    [left, top, right - left, bottom - top]
}

/// The whole tiles in a rectangle.
fn inward([x, y, w, h]: [u32; 4], side: u32) -> [u32; 4] {
    let [left, top] = [x, y].map(|v| v.next_multiple_of(side));
    let [right, bottom] = [x + w, y + h].map(|v| v / side * side);
    [
        left,
        top,
        right.saturating_sub(left),
        bottom.saturating_sub(top),
    ]
}

pub(super) fn add(list: &mut List) {
    rectangles(list);
    type Bug = fn(&mut Clear, [u32; 2]);
    let rows: [(&str, &str, Bug); 7] = [
        (
            "clear-mask-ignored",
            "Clears write all channels and bits.",
            |clear, _| match &mut clear.target {
                ClearTarget::Color { write_mask, .. } => *write_mask = 0b1111,
                ClearTarget::DepthStencil {
                    depth_write,
                    stencil_write_mask,
                    ..
                } => (*depth_write, *stencil_write_mask) = (true, 0xff),
            },
        ),
        (
            "clear-alpha-lost",
            "Clears of colour leave alpha.",
            |clear, _| {
                if let ClearTarget::Color { write_mask, .. } = &mut clear.target {
                    *write_mask &= 0b0111;
                }
            },
        ),
        (
            "stencil-cleared-with-depth",
            "A clear of depth alone clears stencil to 0.",
            |clear, _| {
                if let ClearTarget::DepthStencil {
                    depth: Some(_),
                    stencil,
                    ..
                } = &mut clear.target
                {
                    *stencil = stencil.or(Some(0));
                }
            },
        ),
        (
            "depth-cleared-with-stencil",
            "A clear of stencil alone clears depth to 1.",
            |clear, _| {
                if let ClearTarget::DepthStencil {
                    depth,
                    stencil: Some(_),
                    ..
                } = &mut clear.target
                {
                    *depth = depth.or(Some(1.0));
                }
            },
        ),
        (
            "both-cleared-as-depth",
            "A clear of depth and stencil clears depth alone.",
            |clear, _| {
                if let ClearTarget::DepthStencil {
                    depth: Some(_),
                    stencil,
                    ..
                } = &mut clear.target
                {
                    *stencil = None;
                }
            },
        ),
        (
            "clear-depth-to-an-end",
            "Depth is cleared to the nearer end of its range.",
            |clear, _| {
                if let ClearTarget::DepthStencil {
                    depth: Some(depth), ..
                } = &mut clear.target
                {
                    *depth = depth.round();
                }
            },
        ),
        (
            "clear-too-late",
            "A clear is executed behind the next draw.",
            |clear, _| {
                clear.before += 1;
            },
        ),
    ];
    for (name, about, bug) in rows {
        list.add(name, CONFUSION, about, commands(bug));
    }
    list.add(
        "clear-command-skipped",
        CONFUSION,
        "A clear of everything within a pass is skipped: the attachment is noted as cleared.",
        large(|pass, size| {
            let whole = [0, 0, size[0], size[1]];
            pass.clears.retain(|c| c.rect.is_some_and(|r| r != whole));
        }),
    );
    loads(list);
    initial(list);
}

fn rectangles(list: &mut List) {
    for side in [8, 16, 64] {
        list.add(
            &format!("clear-rect-outward-{side}"),
            CONFUSION,
            format!(
                "Rectangles are cleared in whole tiles of {side} texels, those they cut among them."
            ),
            commands(move |clear, size| clear.rect = clear.rect.map(|r| outward(r, side, size))),
        );
        list.add(
            &format!("clear-rect-inward-{side}"),
            CONFUSION,
            format!(
                "Rectangles are cleared in whole tiles of {side} texels, without those they cut."
            ),
            commands(move |clear, _| clear.rect = clear.rect.map(|r| inward(r, side))),
        );
    }
    list.add(
        "clear-rect-ignored",
        CONFUSION,
        "Clears ignore their rectangle.",
        commands(|clear, _| clear.rect = None),
    );
}

/// Changes load operations of colour in passes over large attachments.
fn color_loads(bug: impl Fn(&mut LoadOperation<[f32; 4]>) + Send + Sync + 'static) -> Plant {
    large(move |pass, _| {
        pass.operations
            .color
            .iter_mut()
            .for_each(|o| bug(&mut o.load))
    })
}

fn loads(list: &mut List) {
    list.add(
        "second-equal-clear-skipped",
        CONFUSION,
        "A load operation that clears to the value of the clear before does nothing.",
        scene(|scene| {
            for at in 0..scene.passes.len() {
                let [w, h] = scene.pass_size(&scene.passes[at]);
                let Some(index) = scene.passes[at].color.first().copied() else {
                    continue;
                };
                let Contents::Color(first) = scene.attachments[index].contents else {
                    continue;
                };
                for operations in &mut scene.passes[at].operations.color {
                    if w.max(h) > 64 && operations.load == LoadOperation::Clear(first) {
                        operations.load = LoadOperation::Load;
                    }
                }
            }
        }),
    );
    list.add(
        "load-clear-skipped",
        CONFUSION,
        "A load operation that clears an attachment which was drawn to before does nothing.",
        color_loads(|load| *load = LoadOperation::Load),
    );
    list.add(
        "load-clear-to-ends",
        CONFUSION,
        "A load operation clears to 0 and 1 alone.",
        color_loads(|load| {
            if let LoadOperation::Clear(value) = load {
                *value = value.map(f32::round);
            }
        }),
    );
    list.add(
        "load-clear-first-64x64",
        CONFUSION,
        "A load operation clears the first 64 by 64 texels alone.",
        large(|pass, _| {
            for (location, operations) in pass.operations.color.iter_mut().enumerate() {
                if let LoadOperation::Clear(value) = operations.load {
                    operations.load = LoadOperation::Load;
                    let target = ClearTarget::Color {
                        location,
                        value,
                        write_mask: 0b1111,
                    };
                    let rect = Some([0, 0, 64, 64]);
                    pass.clears.insert(
                        0,
                        Clear {
                            before: 0,
                            target,
                            rect,
                        },
                    );
                }
            }
        }),
    );
    list.add(
        "load-clears-both",
        CONFUSION,
        "A load operation that clears depth alone clears stencil to 0.",
        large(|pass, _| {
            let operations = &mut pass.operations;
            let alone = operations.stencil.load == LoadOperation::Load;
            if operations.depth.load != LoadOperation::Load && alone {
                operations.stencil.load = LoadOperation::Clear(0);
            }
        }),
    );
    list.add(
        "load-clears-depth-with-stencil",
        CONFUSION,
        "A load operation that clears stencil alone clears depth to 1.",
        large(|pass, _| {
            let operations = &mut pass.operations;
            let alone = operations.depth.load == LoadOperation::Load;
            if operations.stencil.load != LoadOperation::Load && alone {
                operations.depth.load = LoadOperation::Clear(1.0);
            }
        }),
    );
}

/// Changes what large attachments start from.
fn contents(bug: impl Fn(&mut Contents) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let large = scene.attachments.iter_mut();
        let large = large.filter(|a| a.size[0].max(a.size[1]) > 64);
        large.for_each(|a| bug(&mut a.contents));
    })
}

fn initial(list: &mut List) {
    list.add(
        "clear-color-to-ends",
        CONFUSION,
        "Large attachments are cleared to 0 and 1 alone.",
        contents(|contents| {
            if let Contents::Color(value) = contents {
                *value = value.map(f32::round);
            }
        }),
    );
    list.add(
        "clear-color-first-channel",
        CONFUSION,
        "Large attachments are cleared to the first channel's value in all.",
        contents(|contents| {
            if let Contents::Color(value) = contents {
                *value = [value[0]; 4];
            }
        }),
    );
    list.add(
        "clear-depth-to-ends",
        CONFUSION,
        "The depths of large attachments are cleared to 0 and 1 alone.",
        contents(|contents| {
            if let Contents::DepthStencil { depth, .. } = contents {
                *depth = depth.round();
            }
        }),
    );
    list.add(
        "clear-stencil-lost",
        CONFUSION,
        "The stencil values of large attachments are cleared to 0.",
        contents(|contents| {
            if let Contents::DepthStencil { stencil, .. } = contents {
                *stencil = 0;
            }
        }),
    );
}
