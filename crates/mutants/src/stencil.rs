//! Bugs of the stencil test and its updates.

use crate::fields::{
    FACE_PARTS, FACES, Places, STENCIL, STENCIL_COMPARE, STENCIL_OPERATIONS, STENCIL_TEST,
};
use crate::hooks::{stencil_passes, stencil_write, written};
use crate::list::{CONFUSION, List};
use crate::plant::Plant;
use crate::tables::{compare_neighbours, round};
use etalon_cpu::steps::Path;
use etalon_frame::TextureFormat;
use etalon_pipeline::{compare, stencil_operation, stencil_passes as right};
use etalon_scene::{CompareFunction, StencilFace, StencilOperation};

pub(super) fn add(list: &mut List) {
    use StencilOperation as Op;
    list.class("stencil", "stencil");
    list.swaps(
        "compare-",
        "The stencil test ",
        STENCIL_COMPARE,
        compare_neighbours(),
    );
    let paths: [(&str, &str, Places<Op>); 3] = [
        ("fail-", "The fail operation ", |d| {
            FACES(d).into_iter().map(|f| &mut f.fail_op).collect()
        }),
        ("depth-fail-", "The depth-fail operation ", |d| {
            FACES(d).into_iter().map(|f| &mut f.depth_fail_op).collect()
        }),
        ("pass-", "The pass operation ", |d| {
            FACES(d).into_iter().map(|f| &mut f.pass_op).collect()
        }),
    ];
    for (name, about, operation) in paths {
        list.swaps(name, about, operation, round(Op::ALL));
    }
    list.source("zink: wrap mapped to clamp");
    let ends = [
        (Op::IncrementWrap, Op::IncrementClamp),
        (Op::IncrementClamp, Op::IncrementWrap),
        (Op::DecrementWrap, Op::DecrementClamp),
        (Op::DecrementClamp, Op::DecrementWrap),
    ];
    list.swaps("", "On every path, ", STENCIL_OPERATIONS, ends);
    list.source(CONFUSION);
    sides(list);
    masks(list);
    references(list);
    operations(list);
    switches(list);
}

fn sides(list: &mut List) {
    const BACK_LAST: &str = "wgpu: back stencil overwriting front";
    list.bug("faces-swapped: The states of front and back faces are exchanged.")
        .each(STENCIL, |s| std::mem::swap(&mut s.front, &mut s.back));
    list.bug("back-overwrites-front: Both faces take the back's state.")
        .source(BACK_LAST)
        .each(STENCIL, |s| s.front = s.back);
    list.bug("front-overwrites-back: Both faces take the front's state.")
        .each(STENCIL, |s| s.back = s.front);
    for (name, take) in FACE_PARTS {
        list.bug(format!(
            "back-{name}-from-front: Back faces take the front's {name}."
        ))
        .source("WebGPU CTS never tests the back's state apart from the front's")
        .each(STENCIL, move |s| take(&mut s.back, &s.front));
        list.bug(format!(
            "front-{name}-from-back: Front faces take the back's {name}."
        ))
        .source(BACK_LAST)
        .each(STENCIL, move |s| take(&mut s.front, &s.back));
    }
}

fn masks(list: &mut List) {
    list.bug("read-mask-ignored: The read mask counts as all ones.")
        .each(FACES, |face| face.read_mask = 0xff);
    list.bug("read-mask-on-reference-alone: The read mask is not applied to the stored value.")
        .plant(stencil_passes(|f, stored| {
            compare(f.compare, f.reference & f.read_mask, stored)
        }));
    list.bug("read-mask-on-stored-alone: The read mask is not applied to the reference.")
        .plant(stencil_passes(|f, stored| {
            compare(f.compare, f.reference, stored & f.read_mask)
        }));
    list.bug("read-mask-from-write-mask: The write mask is used for reading.")
        .each(FACES, |face| face.read_mask = face.write_mask);
    list.bug("write-mask-from-read-mask: The read mask is used for writing.")
        .each(FACES, |face| face.write_mask = face.read_mask);
    list.bug("read-mask-inverted: The read mask's bits mean their opposite.")
        .each(FACES, |face| face.read_mask = !face.read_mask);
    list.bug("write-mask-ignored: All bits are written.")
        .each(FACES, |face| face.write_mask = 0xff);
    list.bug("write-mask-inverted: The write mask's bits mean their opposite.")
        .each(FACES, |face| face.write_mask = !face.write_mask);
    list.bug("write-mask-zero-still-writes: A write mask of 0 counts as all ones.")
        .source("SwiftShader: write mask 0 still writing")
        .each(FACES, |face| {
            if face.write_mask == 0 {
                face.write_mask = 0xff;
            }
        });
    list.bug("write-mask-in-7-bits: The highest bit is never written.")
        .each(FACES, |face| face.write_mask &= 0x7f);
    list.bug("read-mask-in-7-bits: The highest bit is never compared.")
        .each(FACES, |face| face.read_mask &= 0x7f);
    list.bug("off-with-read-mask-zero: A draw whose read masks are 0 has no stencil test.")
        .source("wgpu: stencil off when the read mask is 0")
        .each(STENCIL_TEST, |s| {
            *s = s.filter(|s| s.front.read_mask | s.back.read_mask != 0)
        });
    list.bug("off-with-write-mask-zero: A draw whose write masks are 0 has no stencil test.")
        .each(STENCIL_TEST, |s| {
            *s = s.filter(|s| s.front.write_mask | s.back.write_mask != 0)
        });
}

fn references(list: &mut List) {
    list.bug("reference-unset-for-replace: The reference stays 0 where no comparison needs it.")
        .source("wgpu: reference not set for replace")
        .each(FACES, |face| {
            if [CompareFunction::Always, CompareFunction::Never].contains(&face.compare) {
                face.reference = 0;
            }
        });
    list.bug("reference-zero: The reference is 0.")
        .source("wgpu: reference not set")
        .each(FACES, |face| face.reference = 0);
    list.bug("reference-in-7-bits: The reference loses its highest bit.")
        .each(FACES, |face| face.reference &= 0x7f);
    list.bug("reference-plus-1: The reference is one too large.")
        .each(FACES, |face| {
            face.reference = face.reference.wrapping_add(1)
        });
    list.bug("reference-in-16-steps: The reference loses its lowest four bits.")
        .each(FACES, |face| face.reference &= 0xf0);
    list.bug("signed-compare: Both sides are compared as signed bytes.")
        .plant(stencil_passes(|f, stored| {
            let signed = |v: u8| (v & f.read_mask).cast_signed();
            compare(f.compare, signed(f.reference), signed(stored))
        }));
    list.bug("reference-sign-extended: The masked reference alone is sign-extended.")
        .source("SwiftShader: masked stencil reference sign error")
        .plant(stencil_passes(|f, stored| {
            let reference = i32::from((f.reference & f.read_mask).cast_signed());
            compare(f.compare, reference, i32::from(stored & f.read_mask))
        }));
    list.bug("compare-operands-swapped: The stored value stands on the left of the comparison.")
        .plant(stencil_passes(|f, stored| {
            compare(f.compare, stored & f.read_mask, f.reference & f.read_mask)
        }));
}

/// Replaces the update, of which the write mask then takes the bits, given face, path and stored value.
fn update(bug: fn(&StencilFace, Path, u8) -> u8) -> Plant {
    stencil_write(move |f, path, stored| masked(f.write_mask, stored, bug(f, path, stored)))
}

/// A stored value with the bits of a mask replaced.
fn masked(mask: u8, stored: u8, new: u8) -> u8 {
    (stored & !mask) | (new & mask)
}

/// The right update.
fn write(f: &StencilFace, path: Path, stored: u8) -> u8 {
    let new = stencil_operation(path.operation(f), stored, f.reference);
    masked(f.write_mask, stored, new)
}

fn operations(list: &mut List) {
    list.bug("write-mask-clears: Bits outside the write mask become 0.")
        .plant(stencil_write(|f, path, stored| {
            write(f, path, stored) & f.write_mask
        }));
    list.bug("operation-on-masked-value: Operations start from the stored bits of the write mask.")
        .plant(update(|f, path, stored| {
            stencil_operation(path.operation(f), stored & f.write_mask, f.reference)
        }));
    list.bug("replace-by-masked-reference: Replace writes the reference under the read mask.")
        .plant(update(|f, path, stored| {
            stencil_operation(path.operation(f), stored, f.reference & f.read_mask)
        }));
    list.bug("invert-7-bits: Invert leaves the highest bit.")
        .plant(update(|f, path, stored| match path.operation(f) {
            StencilOperation::Invert => stored ^ 0x7f,
            operation => stencil_operation(operation, stored, f.reference),
        }));
    list.bug("update-needs-read-mask: Only bits of the read mask are written.")
        .plant(update(|f, path, stored| {
            masked(f.read_mask, stored, write(f, path, stored))
        }));
    let (fail, depth_fail) = (Path::Fail, Path::DepthFail);
    for (name, about, path) in [
        ("fail", "the stencil test", fail),
        ("depth-fail", "the depth test", depth_fail),
    ] {
        list.bug(format!(
            "{name}-and-pass-op-both-applied: A fragment that fails {about} takes the pass operation too."
        ))
        .source("llvmpipe: fail op and pass op both applied")
        .plant(stencil_write(move |f, taken, stored| {
            let new = write(f, taken, stored);
            if taken == path { write(f, Path::Pass, new) } else { new }
        }));
    }
    list.bug("applied-twice: Operations are applied twice.")
        .plant(stencil_write(|f, path, stored| {
            write(f, path, write(f, path, stored))
        }));
    list.bug("depth-fail-op-on-pass: Passing fragments take the depth-fail operation.")
        .each(FACES, |face| face.pass_op = face.depth_fail_op);
    list.bug("pass-op-on-depth-fail: Fragments that fail the depth test take the pass operation.")
        .each(FACES, |face| face.depth_fail_op = face.pass_op);
    list.bug("fail-op-on-depth-fail: Fragments that fail the depth test take the fail operation.")
        .each(FACES, |face| face.depth_fail_op = face.fail_op);
    list.bug("fail-and-depth-fail-swapped: The fail and the depth-fail operation are exchanged.")
        .each(FACES, |face| {
            std::mem::swap(&mut face.fail_op, &mut face.depth_fail_op)
        });
    list.bug("fail-and-pass-swapped: The fail and the pass operation are exchanged.")
        .each(FACES, |face| {
            std::mem::swap(&mut face.fail_op, &mut face.pass_op)
        });
    list.bug("dropped-on-depth-fail: Fragments that fail the depth test leave stencil alone.")
        .source("v3d: early depth test against stencil write")
        .each(FACES, |face| face.depth_fail_op = StencilOperation::Keep);
    list.bug("dropped-on-fail: Fragments that fail the stencil test leave stencil alone.")
        .each(FACES, |face| face.fail_op = StencilOperation::Keep);
    list.bug("dropped-on-pass: Passing fragments leave stencil alone.")
        .each(FACES, |face| face.pass_op = StencilOperation::Keep);
}

fn switches(list: &mut List) {
    list.bug("test-off: There is no stencil test.")
        .set(STENCIL_TEST, None);
    list.bug("test-passes-always: The stencil test always passes.")
        .plant(stencil_passes(|_, _| true));
    list.bug("off-without-depth: An attachment of stencil alone is not tested.")
        .passes(|scene, _, pass| {
            let format = pass.depth_stencil.map(|i| scene.attachments[i].format);
            if format == Some(TextureFormat::Stencil8) {
                pass.draws.iter_mut().for_each(|d| d.stencil = None);
            }
        });
    list.bug("off-without-depth-test: A draw without a depth test has no stencil test.")
        .when(|draw| draw.depth.is_none())
        .set(STENCIL_TEST, None);
    list.bug("color-where-stencil-fails: Fragments that fail the stencil test write their colour.")
        .plant(written(|[covered, stencil, depth]| {
            [covered && depth, covered && stencil && depth]
        }));
    list.bug("largest-value-never-passes: A stored value of 255 fails.")
        .plant(stencil_passes(|f, stored| {
            stored != 255 && right(f, stored)
        }));
}
