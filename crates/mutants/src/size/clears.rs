//! Bugs of clears that a driver only records instead of writing memory.

use crate::aspects::{ASPECT_PAIRS, clear, is_cleared, load, reach_both, reaches};
use crate::list::bugs;
use crate::plant::{Plant, contents, passes};
use etalon_frame::Aspect;
use etalon_scene::{
    Attachment, AttachmentContents, Clear, ClearTarget, LoadOperation, Pass, Scene,
};

/// Changes passes whose attachments are larger than 64 texels, given the scene and their size.
fn large(bug: impl Fn(&mut Pass, &Scene, [u32; 2]) + Send + Sync + 'static) -> Plant {
    passes(move |scene, number, pass| {
        let size = scene.pass_size(&scene.passes[number]);
        if size[0].max(size[1]) > 64 {
            bug(pass, scene, size);
        }
    })
}

/// Changes clear commands in such passes, given their size.
fn commands(bug: impl Fn(&mut Clear, [u32; 2]) + Send + Sync + 'static) -> Plant {
    large(move |pass, _, size| pass.clears.iter_mut().for_each(|c| bug(c, size)))
}

/// Changes the clear colours of such passes.
fn color_loads(bug: impl Fn(&mut [f32; 4]) + Send + Sync + 'static) -> Plant {
    large(move |pass, _, _| {
        for operations in &mut pass.operations.color {
            if let LoadOperation::Clear(value) = &mut operations.load {
                bug(value);
            }
        }
    })
}

/// Extends a rectangle to multiples of a tile's side, within the attachments.
fn outward([x, y, w, h]: [u32; 4], side: u32, size: [u32; 2]) -> [u32; 4] {
    let [left, top] = [x, y].map(|v| v / side * side);
    let right = (x + w).next_multiple_of(side).min(size[0]);
    let bottom = (y + h).next_multiple_of(side).min(size[1]);
    [left, top, right - left, bottom - top]
}

/// Returns the whole tiles inside a rectangle.
fn inward([x, y, w, h]: [u32; 4], side: u32) -> [u32; 4] {
    let [left, top] = [x, y].map(|v| v.next_multiple_of(side));
    let [width, height] =
        [(x + w, left), (y + h, top)].map(|(end, start)| (end / side * side).saturating_sub(start));
    [left, top, width, height]
}

/// Changes the initial contents of large attachments.
fn large_contents(bug: impl Fn(&mut AttachmentContents) + Send + Sync + 'static) -> Plant {
    contents(move |attachment: &mut Attachment| {
        if attachment.size[0].max(attachment.size[1]) > 64 {
            bug(&mut attachment.contents);
        }
    })
}

bugs! {
    for side in [8, 16, 64] {
        "clear-rect-outward-{side}: Whole tiles of {side} texels are cleared, those cut among them." =>
            commands(move |c, size| c.rect = c.rect.map(|r| outward(r, side, size)));
        "clear-rect-inward-{side}: Whole tiles of {side} texels are cleared, without those cut." =>
            commands(move |c, _| c.rect = c.rect.map(|r| inward(r, side)));
    }
    "clear-rect-ignored: Clears ignore their rectangle." => commands(|c, _| c.rect = None);
    "clear-mask-ignored: Clears write all channels and bits." =>
        commands(|c, _| match &mut c.target {
            ClearTarget::Color { write_mask, .. } => *write_mask = 0b1111,
            ClearTarget::DepthStencil { depth_write, stencil_write_mask, .. } =>
                (*depth_write, *stencil_write_mask) = (true, 0xff),
        });
    "clear-alpha-lost: Clears of colour leave alpha." =>
        commands(|c, _| if let ClearTarget::Color { write_mask, .. } = &mut c.target { *write_mask &= 0b0111 });
    for (cleared, other, value) in ASPECT_PAIRS {
        let (a, b) = (cleared.name(), other.name());
        "{b}-cleared-with-{a}: A clear of {a} alone clears {b} to {value}." =>
            commands(move |c, _| if reaches(c, cleared) { reach_both(c) });
    }
    "both-cleared-as-depth: A clear of depth and stencil clears depth alone." =>
        commands(|c, _| {
            if let ClearTarget::DepthStencil { depth: Some(_), stencil, .. } = &mut c.target { *stencil = None; }
        });
    "clear-depth-to-an-end: Depth is cleared to the nearer end of its range." =>
        commands(|c, _| {
            if let ClearTarget::DepthStencil { depth, .. } = &mut c.target { *depth = depth.map(f32::round); }
        });
    "clear-too-late: A clear is executed behind the next draw." => commands(|c, _| c.before += 1);
    "clear-command-skipped: A clear of everything within a pass is skipped." =>
        large(|pass, _, [w, h]| { pass.clears.retain(|c| c.rect.is_some_and(|r| r != [0, 0, w, h])); });
    "second-equal-clear-skipped: A clear to the value of the clear before is skipped." =>
        large(|pass, scene, _| {
            let first = pass.color.first().map(|i| &scene.attachments[*i].contents);
            for operations in &mut pass.operations.color {
                if let (Some(AttachmentContents::Color(first)), LoadOperation::Clear(value)) =
                    (first, operations.load) && *first == value
                {
                    operations.load = LoadOperation::Load;
                }
            }
        });
    "load-clear-skipped: A clear on load of colour does nothing." => large(|pass, _, _| load(pass, Aspect::Color));
    "load-clear-to-ends: A load operation clears to 0 and 1 alone." =>
        color_loads(|value| *value = value.map(f32::round));
    "load-clear-first-64x64: A load operation clears the first 64 by 64 texels alone." =>
        large(|pass, _, _| {
            for (location, operations) in pass.operations.color.iter_mut().enumerate() {
                if let LoadOperation::Clear(value) = operations.load {
                    operations.load = LoadOperation::Load;
                    let write_mask = 0b1111;
                    let target = ClearTarget::Color { location, value, write_mask, };
                    let rect = Some([0, 0, 64, 64]);
                    pass.clears.insert(0, Clear { before: 0, target, rect, });
                }
            }
        });
    let named = ["load-clears-both", "load-clears-depth-with-stencil"].into_iter().zip(ASPECT_PAIRS);
    for (name, (cleared, other, value)) in named {
        let (a, b) = (cleared.name(), other.name());
        "{name}: A load operation that clears {a} alone clears {b} to {value}." =>
            large(move |pass, _, _| if is_cleared(pass, cleared) && !is_cleared(pass, other) { clear(pass, other) });
    }
    "clear-color-to-ends: Large attachments are cleared to 0 and 1 alone." =>
        large_contents(|contents| if let AttachmentContents::Color(value) = contents { *value = value.map(f32::round) });
    "clear-color-first-channel: Large attachments take the first channel's value." =>
        large_contents(|contents| { if let AttachmentContents::Color(value) = contents { *value = [value[0]; 4]; } });
    "clear-depth-to-ends: The depths of large attachments are cleared to 0 and 1 alone." =>
        large_contents(|contents| if let AttachmentContents::DepthStencil { depth, .. } = contents { *depth = depth.round() });
    "clear-stencil-lost: The stencil values of large attachments are cleared to 0." =>
        large_contents(|contents| if let AttachmentContents::DepthStencil { stencil, .. } = contents { *stencil = 0 });
}
