//! Bugs of the stencil test and its updates.

use crate::fields::{
    DEPTH_FAIL_OP, FACES, FAIL_OP, FIELDS, PASS_OP, STENCIL, STENCIL_COMPARE, STENCIL_OPERATIONS,
    STENCIL_TEST,
};
use crate::hooks::{stencil_passes, stencil_write, written};
use crate::list::{CONFUSION, bugs};
use crate::permission::under;
use crate::plant::{Plant, draws, each, passes, set};
use crate::tables::{compare_neighbours, round};
use StencilOperation as Op;
use etalon_cpu::steps::TestOutcome;
use etalon_frame::TextureFormat;
use etalon_pipeline::{compare, stencil_operation, stencil_passes as right};
use etalon_scene::{CompareFunction, Draw, StencilFace, StencilOperation};

/// Returns a draw with the states of front and back faces exchanged.
fn turned(draw: &Draw) -> Draw {
    let mut turned = draw.clone();
    let states = turned.stencil.iter_mut();
    states.for_each(|s| std::mem::swap(&mut s.front, &mut s.back));
    turned
}

/// Replaces the update before the write mask is applied, given face, outcome and stored value.
fn update(bug: fn(&StencilFace, TestOutcome, u8) -> u8) -> Plant {
    stencil_write(move |f, outcome, stored| masked(f.write_mask, stored, bug(f, outcome, stored)))
}

/// Returns the stored value with the bits of a mask replaced.
fn masked(mask: u8, stored: u8, new: u8) -> u8 {
    (stored & !mask) | (new & mask)
}

/// Returns the correct update.
fn write(f: &StencilFace, outcome: TestOutcome, stored: u8) -> u8 {
    let new = stencil_operation(outcome.operation(f), stored, f.reference);
    masked(f.write_mask, stored, new)
}

const BACK_LAST: &str = "wgpu: back stencil overwriting front";

bugs! {
    class "stencil", "stencil";
    swaps "compare-", "The stencil test ", STENCIL_COMPARE, compare_neighbours();
    swaps "fail-", "The fail operation ", FAIL_OP, round(Op::ALL);
    swaps "depth-fail-", "The depth-fail operation ", DEPTH_FAIL_OP, round(Op::ALL);
    swaps "pass-", "The pass operation ", PASS_OP, round(Op::ALL);
    source "zink: wrap mapped to clamp";
    for [wrap, clamp] in [[Op::IncrementWrap, Op::IncrementClamp], [Op::DecrementWrap, Op::DecrementClamp]] {
        swaps "", "On every path, ", STENCIL_OPERATIONS, [(wrap, clamp), (clamp, wrap)];
    }
    source CONFUSION;
    "faces-swapped: The states of front and back faces are exchanged." =>
        each(STENCIL, |s| std::mem::swap(&mut s.front, &mut s.back));
    "back-overwrites-front: Both faces take the back's state." => each(STENCIL, |s| s.front = s.back), source BACK_LAST;
    "front-overwrites-back: Both faces take the front's state." => each(STENCIL, |s| s.back = s.front);
    for (side, face, other, source) in [
        ("back", "Back", "front", "WebGPU CTS never tests the back's state apart from the front's"),
        ("front", "Front", "back", BACK_LAST),
    ] {
        let prefix = format!("stencil-{side}-");
        let parts = FIELDS.iter().filter_map(|f| Some((f.name.strip_prefix(&prefix)?, f.take)));
        for (part, take) in parts {
            "{side}-{part}-from-{other}: {face} faces take the {other}'s {part}." =>
                draws(move |draw| take(&turned(draw), draw)), source source;
        }
    }
    "read-mask-ignored: The read mask counts as all ones." => each(FACES, |face| face.read_mask = 0xff);
    "read-mask-on-reference-alone: The read mask is not applied to the stored value." =>
        stencil_passes(|f, stored| compare(f.compare, f.reference & f.read_mask, stored));
    "read-mask-on-stored-alone: The read mask is not applied to the reference." =>
        stencil_passes(|f, stored| compare(f.compare, f.reference, stored & f.read_mask)), permitted vec![under!(masks_reference: false)];
    "read-mask-from-write-mask: The write mask is used for reading." =>
        each(FACES, |face| face.read_mask = face.write_mask);
    "write-mask-from-read-mask: The read mask is used for writing." =>
        each(FACES, |face| face.write_mask = face.read_mask);
    "read-mask-inverted: The read mask's bits mean their opposite." =>
        each(FACES, |face| face.read_mask = !face.read_mask);
    "write-mask-ignored: All bits are written." => each(FACES, |face| face.write_mask = 0xff);
    "write-mask-inverted: The write mask's bits mean their opposite." =>
        each(FACES, |face| face.write_mask = !face.write_mask);
    "write-mask-zero-still-writes: A write mask of 0 counts as all ones." =>
        each(FACES, |face| if face.write_mask == 0 { face.write_mask = 0xff }),
        source "SwiftShader: write mask 0 still writing";
    "write-mask-in-7-bits: The highest bit is never written." => each(FACES, |face| face.write_mask &= 0x7f);
    "read-mask-in-7-bits: The highest bit is never compared." => each(FACES, |face| face.read_mask &= 0x7f);
    "off-with-read-mask-zero: A draw whose read masks are 0 has no stencil test." =>
        each(STENCIL_TEST, |s| *s = s.filter(|s| s.front.read_mask | s.back.read_mask != 0)),
        source "wgpu: stencil off when the read mask is 0";
    "off-with-write-mask-zero: A draw whose write masks are 0 has no stencil test." =>
        each(STENCIL_TEST, |s| *s = s.filter(|s| s.front.write_mask | s.back.write_mask != 0));
    "reference-unset-for-replace: The reference stays 0 where no comparison needs it." =>
        each(FACES, |face| {
            if [CompareFunction::Always, CompareFunction::Never].contains(&face.compare) { face.reference = 0; }
        }), source "wgpu: reference not set for replace";
    "reference-zero: The reference is 0." => each(FACES, |face| face.reference = 0), source "wgpu: reference not set";
    "reference-in-7-bits: The reference loses its highest bit." => each(FACES, |face| face.reference &= 0x7f);
    "reference-plus-1: The reference is one too large." =>
        each(FACES, |face| face.reference = face.reference.wrapping_add(1));
    "reference-in-16-steps: The reference loses its lowest four bits." => each(FACES, |face| face.reference &= 0xf0);
    "signed-compare: Both sides are compared as signed bytes." =>
        stencil_passes(|f, stored| {
            let signed = |v: u8| (v & f.read_mask).cast_signed();
            compare(f.compare, signed(f.reference), signed(stored))
        });
    "reference-sign-extended: The masked reference alone is sign-extended." =>
        stencil_passes(|f, stored| {
            let reference = i32::from((f.reference & f.read_mask).cast_signed());
            compare(f.compare, reference, i32::from(stored & f.read_mask))
        }), source "SwiftShader: masked stencil reference sign error";
    "compare-operands-swapped: The stored value stands on the left of the comparison." =>
        stencil_passes(|f, stored| compare(f.compare, stored & f.read_mask, f.reference & f.read_mask));
    "write-mask-clears: Bits outside the write mask become 0." =>
        stencil_write(|f, outcome, stored| write(f, outcome, stored) & f.write_mask);
    "operation-on-masked-value: Operations start from the stored bits of the write mask." =>
        update(|f, outcome, stored| stencil_operation(outcome.operation(f), stored & f.write_mask, f.reference));
    "replace-by-masked-reference: Replace writes the reference under the read mask." =>
        update(|f, outcome, stored| stencil_operation(outcome.operation(f), stored, f.reference & f.read_mask));
    "invert-7-bits: Invert leaves the highest bit." =>
        update(|f, outcome, stored| match outcome.operation(f) {
            StencilOperation::Invert => stored ^ 0x7f,
            operation => stencil_operation(operation, stored, f.reference),
        });
    "update-needs-read-mask: Only bits of the read mask are written." =>
        update(|f, outcome, stored| masked(f.read_mask, stored, write(f, outcome, stored)));
    let (fail, depth_fail) = (TestOutcome::Fail, TestOutcome::DepthFail);
    for (name, about, outcome) in [("fail", "the stencil test", fail), ("depth-fail", "the depth test", depth_fail)] {
        "{name}-and-pass-op-both-applied: A fragment that fails {about} takes the pass operation too." =>
            stencil_write(move |f, taken, stored| {
                let new = write(f, taken, stored);
                if taken == outcome { write(f, TestOutcome::Pass, new) } else { new }
            }), source "llvmpipe: fail op and pass op both applied";
    }
    "applied-twice: Operations are applied twice." =>
        stencil_write(|f, outcome, stored| write(f, outcome, write(f, outcome, stored)));
    "depth-fail-op-on-pass: Passing fragments take the depth-fail operation." =>
        each(FACES, |face| face.pass_op = face.depth_fail_op);
    "pass-op-on-depth-fail: Fragments that fail the depth test take the pass operation." =>
        each(FACES, |face| face.depth_fail_op = face.pass_op);
    "fail-op-on-depth-fail: Fragments that fail the depth test take the fail operation." =>
        each(FACES, |face| face.depth_fail_op = face.fail_op);
    "fail-and-depth-fail-swapped: The fail and the depth-fail operation are exchanged." =>
        each(FACES, |face| std::mem::swap(&mut face.fail_op, &mut face.depth_fail_op));
    "fail-and-pass-swapped: The fail and the pass operation are exchanged." =>
        each(FACES, |face| std::mem::swap(&mut face.fail_op, &mut face.pass_op));
    "dropped-on-depth-fail: Fragments that fail the depth test leave stencil alone." =>
        each(FACES, |face| face.depth_fail_op = StencilOperation::Keep),
        source "v3d: early depth test against stencil write";
    "dropped-on-fail: Fragments that fail the stencil test leave stencil alone." =>
        each(FACES, |face| face.fail_op = StencilOperation::Keep);
    "dropped-on-pass: Passing fragments leave stencil alone." =>
        each(FACES, |face| face.pass_op = StencilOperation::Keep);
    "test-off: There is no stencil test." => set(STENCIL_TEST, None);
    "test-passes-always: The stencil test always passes." => stencil_passes(|_, _| true);
    "off-without-depth: An attachment of stencil alone is not tested." =>
        passes(|scene, _, pass| {
            let format = pass.depth_stencil.map(|i| scene.attachments[i].format);
            if format == Some(TextureFormat::Stencil8) { pass.draws.iter_mut().for_each(|d| d.stencil = None); }
        });
    "off-without-depth-test: A draw without a depth test has no stencil test." =>
        set(STENCIL_TEST, None), when |draw| draw.depth.is_none();
    "color-where-stencil-fails: Fragments that fail the stencil test write their colour." =>
        written(|[covered, stencil, depth]| [covered && depth, covered && stencil && depth]);
    "largest-value-never-passes: A stored value of 255 fails." =>
        stencil_passes(|f, stored| stored != 255 && right(f, stored));
}
