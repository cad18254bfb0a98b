//! Bugs of the stencil reference that a shader writes.

use crate::fields::{EARLY_TESTS, STENCIL_OPERATIONS, STENCIL_TEST};
use crate::hooks::exported;
use crate::list::List;
use crate::plant::from_draw;
use etalon_cpu::steps::{Exported, Path};
use etalon_scene::{Draw, EarlyTests, Shader, StencilOperation};

pub(super) fn add(list: &mut List) {
    list.class("stencil-export", "stencil");
    list.bug("ignored: The reference that a shader writes does nothing.")
        .plant(exported(|e| e.face.reference));
    list.bug("test-alone: The stencil test takes the shader's reference, `replace` the draw's.")
        .plant(exported(|e| if_so(e, e.path.is_none())));
    list.bug("replace-alone: `replace` takes the shader's reference, the stencil test the draw's.")
        .plant(exported(|e| if_so(e, e.path.is_some())));
    list.bug("fail-ignores: `replace` takes the draw's reference where the stencil test fails.")
        .plant(exported(|e| if_so(e, e.path != Some(Path::Fail))));
    list.bug("depth-fail-ignores: `replace` takes the draw's where the depth test fails.")
        .plant(exported(|e| if_so(e, e.path != Some(Path::DepthFail))));
    list.bug("pass-ignores: `replace` takes the draw's reference where both tests pass.")
        .plant(exported(|e| if_so(e, e.path != Some(Path::Pass))));
    list.bug("back-ignores: Back faces take the draw's reference.")
        .plant(exported(|e| if_so(e, e.front)));
    list.bug("front-ignores: Front faces take the draw's reference.")
        .plant(exported(|e| if_so(e, !e.front)));
    list.bug("first-of-the-quad: The first texel of a pair of columns writes for both.")
        .plant(exported(|e| e.written[e.lane & !1] as u8));
    list.bug("first-of-the-row: The first texel of a span writes for all.")
        .plant(exported(|e| e.written[0] as u8));
    list.bug("next-texel: Each texel takes the reference of its neighbour.")
        .plant(exported(|e| e.written[e.lane ^ 1] as u8));
    list.bug("clamped: Numbers below 0 count as 0, those above 255 as 255.")
        .plant(exported(|e| value(e).clamp(0, 255) as u8));
    list.bug("negative-as-zero: Numbers below 0 count as 0.")
        .plant(exported(|e| value(e).max(0) as u8));
    list.bug("large-as-255: Numbers above 255 count as 255.")
        .plant(exported(|e| value(e).min(255) as u8));
    list.bug("absolute: Numbers lose their sign.")
        .plant(exported(|e| value(e).unsigned_abs() as u8));
    list.bug("seven-bits: The highest bit of a reference is lost.")
        .plant(exported(|e| value(e) as u8 & 0x7f));
    list.bug("ninth-bit: The ninth bit falls into the lowest.")
        .plant(exported(|e| (value(e) | (value(e) >> 8 & 1)) as u8));
    list.bug("read-mask-at-replace: `replace` stores the reference under the read mask.")
        .plant(exported(|e| match e.path {
            None => value(e) as u8,
            Some(_) => value(e) as u8 & e.face.read_mask,
        }));
    list.bug("write-mask-at-test: The stencil test compares the reference under the write mask.")
        .plant(exported(|e| match e.path {
            None => value(e) as u8 & e.face.write_mask,
            Some(_) => value(e) as u8,
        }));
    list.bug("or-the-draws: The bits of the draw's reference are set too.")
        .plant(exported(|e| value(e) as u8 | e.face.reference));
    list.bug("under-the-draws: The bits that the draw's reference lacks are lost.")
        .plant(exported(|e| value(e) as u8 & e.face.reference));
    list.bug("zero-means-none: Where the shader writes 0 the draw's reference counts.")
        .plant(exported(|e| if_so(e, value(e) as u8 != 0)));
    list.bug("first-sample-alone: Samples after the first take the draw's reference.")
        .plant(exported(|e| if_so(e, e.sample == 0)));
    list.bug("sample-number-lost: Samples that run one by one share the first one's reference.")
        .plant(exported(|e| value(e).wrapping_sub(e.plus) as u8));
    list.bug("tested-early: Shaders that write a reference are tested early.")
        .source("llvmpipe, panfrost: early tests despite what a shader does")
        .when(exports)
        .set(EARLY_TESTS, EarlyTests::Forced);
    list.bug("forced-as-late: Forced early tests come late where the shader writes a reference.")
        .when(exports)
        .set(EARLY_TESTS, EarlyTests::Implicit);
    list.bug("off-without-reading-the-draws: A draw whose own reference is 0 has no stencil test.")
        .when(exports)
        .each(STENCIL_TEST, |s| {
            *s = s.filter(|s| s.front.reference | s.back.reference != 0)
        });
    list.bug("update-lost: `replace` keeps the stored value.")
        .source(
            "drivers that take stencil for unchanged where the draw's own reference leaves it so",
        )
        .when(exports)
        .each(STENCIL_OPERATIONS, |operation| {
            if *operation == StencilOperation::Replace {
                *operation = StencilOperation::Keep;
            }
        });
    list.bug("lingers: A draw takes the reference that the shader of the draw before it writes.")
        .plant(from_draw(|before, draw| {
            if before.shader.writes_reference() && draw.shader == Shader::UniformColor {
                draw.shader = Shader::ExportedColor;
                draw.textures.clone_from(&before.textures);
            }
        }));
    list.bug(
        "off-after-a-draw-without: After a draw whose shader writes no reference, the next \
         one's is ignored.",
    )
    .plant(from_draw(|before, draw| {
        if !before.shader.writes_reference() && draw.shader == Shader::ExportedColor {
            draw.shader = Shader::UniformColor;
            draw.textures.clear();
        }
    }));
}

/// True of draws whose shader writes a reference.
fn exports(draw: &Draw) -> bool {
    draw.shader.writes_reference()
}

/// Returns what the shader writes for the texel.
fn value(exported: &Exported) -> i32 {
    exported.written[exported.lane]
}

/// Returns the shader's reference, or the draw's if not `exported`.
fn if_so(export: &Exported, exported: bool) -> u8 {
    if exported {
        value(export) as u8
    } else {
        export.face.reference
    }
}
