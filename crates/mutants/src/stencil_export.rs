//! Bugs of the stencil reference that a shader writes.

use super::hooks::exported;
use super::list::{CONFUSION, List, Row};
use super::plant::{Plant, draws, from_draw};
use etalon_cpu::steps::{Exported, Path};
use etalon_scene::{Draw, EarlyTests, Shader, StencilOperation};

/// Returns the reference that counts.
type Reference = fn(&Exported) -> u8;

pub(super) fn add(list: &mut List) {
    list.class("stencil-export", "stencil");
    let rows: [Row<Reference>; 24] = [
        (
            "ignored",
            "The reference that a shader writes does nothing.",
            |of| of.face.reference,
        ),
        (
            "test-alone",
            "The stencil test takes the shader's reference, `replace` the draw's.",
            |of| if_so(of, of.path.is_none()),
        ),
        (
            "replace-alone",
            "`replace` takes the shader's reference, the stencil test the draw's.",
            |of| if_so(of, of.path.is_some()),
        ),
        (
            "fail-ignores",
            "`replace` takes the draw's reference where the stencil test fails.",
            |of| if_so(of, of.path != Some(Path::Fail)),
        ),
        (
            "depth-fail-ignores",
            "`replace` takes the draw's reference where the depth test fails.",
            |of| if_so(of, of.path != Some(Path::DepthFail)),
        ),
        (
            "pass-ignores",
            "`replace` takes the draw's reference where both tests pass.",
            |of| if_so(of, of.path != Some(Path::Pass)),
        ),
        (
            "back-ignores",
            "Back faces take the draw's reference.",
            |of| if_so(of, of.front),
        ),
        (
            "front-ignores",
            "Front faces take the draw's reference.",
            |of| if_so(of, !of.front),
        ),
        (
            "first-of-the-quad",
            "The first texel of a pair of columns writes for both.",
            |of| of.written[of.lane & !1] as u8,
        ),
        (
            "first-of-the-row",
            "The first texel of a span writes for all.",
            |of| of.written[0] as u8,
        ),
        (
            "next-texel",
            "Each texel takes the reference of its neighbour.",
            |of| of.written[of.lane ^ 1] as u8,
        ),
        (
            "clamped",
            "Numbers below 0 count as 0, those above 255 as 255.",
            |of| value(of).clamp(0, 255) as u8,
        ),
        ("negative-as-zero", "Numbers below 0 count as 0.", |of| {
            value(of).max(0) as u8
        }),
        ("large-as-255", "Numbers above 255 count as 255.", |of| {
            value(of).min(255) as u8
        }),
        ("absolute", "Numbers lose their sign.", |of| {
            value(of).unsigned_abs() as u8
        }),
        (
            "seven-bits",
            "The highest bit of a reference is lost.",
            |of| value(of) as u8 & 0x7f,
        ),
        ("ninth-bit", "The ninth bit falls into the lowest.", |of| {
            (value(of) | (value(of) >> 8 & 1)) as u8
        }),
        (
            "read-mask-at-replace",
            "`replace` stores the reference under the read mask.",
            |of| match of.path {
                None => value(of) as u8,
                Some(_) => value(of) as u8 & of.face.read_mask,
            },
        ),
        (
            "write-mask-at-test",
            "The stencil test compares the reference under the write mask.",
            |of| match of.path {
                None => value(of) as u8 & of.face.write_mask,
                Some(_) => value(of) as u8,
            },
        ),
        (
            "or-the-draws",
            "The bits of the draw's reference are set too.",
            |of| value(of) as u8 | of.face.reference,
        ),
        (
            "under-the-draws",
            "The bits that the draw's reference lacks are lost.",
            |of| value(of) as u8 & of.face.reference,
        ),
        (
            "zero-means-none",
            "Where the shader writes 0 the draw's reference counts.",
            |of| if_so(of, value(of) as u8 != 0),
        ),
        (
            "first-sample-alone",
            "Samples after the first take the draw's reference.",
            |of| if_so(of, of.sample == 0),
        ),
        (
            "sample-number-lost",
            "Samples that shaders run for one by one share the first one's reference.",
            |of| value(of).wrapping_sub(of.plus) as u8,
        ),
    ];
    list.rows(CONFUSION, exported, &rows);
    list.add(
        "tested-early",
        "llvmpipe, panfrost: early tests despite what a shader does",
        "Shaders that write a reference are tested early.",
        exporting(|draw| draw.early_tests = EarlyTests::Forced),
    );
    list.add(
        "forced-as-late",
        CONFUSION,
        "Forced early tests come late where the shader writes a reference.",
        exporting(|draw| draw.early_tests = EarlyTests::Implicit),
    );
    list.add(
        "off-without-reading-the-draws",
        CONFUSION,
        "A draw whose own reference is 0 has no stencil test.",
        exporting(|draw| {
            draw.stencil = draw
                .stencil
                .filter(|s| s.front.reference != 0 || s.back.reference != 0);
        }),
    );
    list.add(
        "update-lost",
        "drivers that take stencil for unchanged where the draw's own reference leaves it so",
        "`replace` keeps the stored value.",
        exporting(|draw| {
            if let Some(stencil) = &mut draw.stencil {
                for face in [&mut stencil.front, &mut stencil.back] {
                    for operation in [
                        &mut face.fail_op,
                        &mut face.depth_fail_op,
                        &mut face.pass_op,
                    ] {
                        if *operation == StencilOperation::Replace {
                            *operation = StencilOperation::Keep;
                        }
                    }
                }
            }
        }),
    );
    list.add(
        "lingers",
        CONFUSION,
        "A draw takes the reference that the shader of the draw before it writes.",
        from_draw(|before, draw| {
            if before.shader.writes_reference() && draw.shader == Shader::UniformColor {
                draw.shader = Shader::ExportedColor;
                draw.textures.clone_from(&before.textures);
            }
        }),
    );
    list.add(
        "off-after-a-draw-without",
        CONFUSION,
        "After a draw whose shader writes no reference, the next one's is ignored.",
        from_draw(|before, draw| {
            if !before.shader.writes_reference() && draw.shader == Shader::ExportedColor {
                draw.shader = Shader::UniformColor;
                draw.textures.clear();
            }
        }),
    );
}

/// Returns what the shader writes for the texel.
fn value(of: &Exported) -> i32 {
    of.written[of.lane]
}

/// Returns the shader's reference, or the draw's if not `exported`.
fn if_so(of: &Exported, exported: bool) -> u8 {
    match exported {
        true => value(of) as u8,
        false => of.face.reference,
    }
}

/// A bug of a draw whose shader writes a reference.
fn exporting(bug: fn(&mut Draw)) -> Plant {
    draws(move |draw| {
        if draw.shader.writes_reference() {
            bug(draw);
        }
    })
}
