//! Bugs of the stencil reference that a shader writes.

use crate::fields::{EARLY_TESTS, STENCIL_OPERATIONS, STENCIL_TEST};
use crate::hooks::exported;
use crate::list::bugs;
use crate::plant::{each, from_draw, set};
use etalon_cpu::steps::{ExportedReference, TestOutcome};
use etalon_scene::{Draw, EarlyTests, Shader, StencilOperation};

/// Returns true for draws whose shader writes a stencil reference.
fn exports(draw: &Draw) -> bool {
    draw.shader.writes_reference()
}

/// Returns the value that the shader writes for the texel.
fn value(exported: &ExportedReference) -> i32 {
    exported.written[exported.lane]
}

/// Returns the shader's reference if `exported` is true, otherwise the draw's.
fn if_so(export: &ExportedReference, exported: bool) -> u8 {
    if exported {
        value(export) as u8
    } else {
        export.face.reference
    }
}

bugs! {
    class "stencil-export", "stencil";
    "ignored: The reference that a shader writes does nothing." => exported(|e| e.face.reference);
    "test-alone: The stencil test takes the shader's reference, `replace` the draw's." =>
        exported(|e| if_so(e, e.outcome.is_none()));
    "replace-alone: `replace` takes the shader's reference, the stencil test the draw's." =>
        exported(|e| if_so(e, e.outcome.is_some()));
    "fail-ignores: `replace` takes the draw's reference where the stencil test fails." =>
        exported(|e| if_so(e, e.outcome != Some(TestOutcome::Fail)));
    "depth-fail-ignores: `replace` takes the draw's where the depth test fails." =>
        exported(|e| if_so(e, e.outcome != Some(TestOutcome::DepthFail)));
    "pass-ignores: `replace` takes the draw's reference where both tests pass." =>
        exported(|e| if_so(e, e.outcome != Some(TestOutcome::Pass)));
    "back-ignores: Back faces take the draw's reference." => exported(|e| if_so(e, e.front));
    "front-ignores: Front faces take the draw's reference." => exported(|e| if_so(e, !e.front));
    "first-of-the-quad: The first texel of a pair of columns writes for both." =>
        exported(|e| e.written[e.lane & !1] as u8);
    "first-of-the-row: The first texel of a span writes for all." => exported(|e| e.written[0] as u8);
    "next-texel: Each texel takes the reference of its neighbour." => exported(|e| e.written[e.lane ^ 1] as u8);
    "clamped: Numbers below 0 count as 0, those above 255 as 255." => exported(|e| value(e).clamp(0, 255) as u8);
    "negative-as-zero: Numbers below 0 count as 0." => exported(|e| value(e).max(0) as u8);
    "large-as-255: Numbers above 255 count as 255." => exported(|e| value(e).min(255) as u8);
    "absolute: Numbers lose their sign." => exported(|e| value(e).unsigned_abs() as u8);
    "seven-bits: The highest bit of a reference is lost." => exported(|e| value(e) as u8 & 0x7f);
    "ninth-bit: The ninth bit falls into the lowest." => exported(|e| (value(e) | (value(e) >> 8 & 1)) as u8);
    "read-mask-at-replace: `replace` stores the reference under the read mask." =>
        exported(|e| match e.outcome { None => value(e) as u8, Some(_) => value(e) as u8 & e.face.read_mask, });
    "write-mask-at-test: The stencil test compares the reference under the write mask." =>
        exported(|e| match e.outcome { None => value(e) as u8 & e.face.write_mask, Some(_) => value(e) as u8, });
    "or-the-draws: The bits of the draw's reference are set too." => exported(|e| value(e) as u8 | e.face.reference);
    "under-the-draws: The bits that the draw's reference lacks are lost." =>
        exported(|e| value(e) as u8 & e.face.reference);
    "zero-means-none: Where the shader writes 0 the draw's reference counts." =>
        exported(|e| if_so(e, value(e) as u8 != 0));
    "first-sample-alone: Samples after the first take the draw's reference." => exported(|e| if_so(e, e.sample == 0));
    "sample-number-lost: Samples that run one by one share the first one's reference." =>
        exported(|e| value(e).wrapping_sub(e.plus) as u8);
    "tested-early: Shaders that write a reference are tested early." =>
        set(EARLY_TESTS, EarlyTests::Forced),
        source "llvmpipe, panfrost: early tests despite what a shader does", when exports;
    "forced-as-late: Forced early tests come late where the shader writes a reference." =>
        set(EARLY_TESTS, EarlyTests::Implicit), when exports;
    "off-without-reading-the-draws: A draw whose own reference is 0 has no stencil test." =>
        each(STENCIL_TEST, |s| *s = s.filter(|s| s.front.reference | s.back.reference != 0)), when exports;
    "update-lost: `replace` keeps the stored value." =>
        each(STENCIL_OPERATIONS, |operation| {
            if *operation == StencilOperation::Replace { *operation = StencilOperation::Keep; }
        }), source "drivers that take stencil for unchanged where the draw's own reference leaves it so", when exports;
    "lingers: A draw takes the reference that the shader of the draw before it writes." =>
        from_draw(|before, draw| {
            if before.shader.writes_reference() && draw.shader == Shader::UniformColor {
                draw.shader = Shader::ExportedColor;
                draw.textures.clone_from(&before.textures);
            }
        });
    "off-after-a-draw-without: After a draw whose shader writes no reference, the next one's is ignored." =>
        from_draw(|before, draw| {
            if !before.shader.writes_reference() && draw.shader == Shader::ExportedColor {
                draw.shader = Shader::UniformColor;
                draw.textures.clear();
            }
        });
}
