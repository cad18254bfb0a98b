//! Bugs of the stencil test and its updates.

use super::hooks::{stencil_passes, stencil_write, written};
use super::list::{CONFUSION, List};
use super::plant::{Plant, draws, faces, scene};
use super::tables;
use etalon_cpu::steps::Path;
use etalon_frame::TextureFormat;
use etalon_pipeline::{compare, stencil_operation, stencil_passes as passes};
use etalon_scene::{CompareFunction, StencilFace, StencilOperation, StencilState};

pub(super) fn add(list: &mut List) {
    list.class("stencil", "stencil");
    for (right, wrong) in tables::compare_neighbours() {
        list.add(
            &format!("compare-{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!(
                "The stencil test {} acts as {}.",
                right.name(),
                wrong.name()
            ),
            faces(move |face| {
                if face.compare == right {
                    face.compare = wrong;
                }
            }),
        );
    }
    type Operation = fn(&mut StencilFace) -> &mut StencilOperation;
    let paths: [(&str, Operation); 3] = [
        ("fail", |face| &mut face.fail_op),
        ("depth-fail", |face| &mut face.depth_fail_op),
        ("pass", |face| &mut face.pass_op),
    ];
    for (path, operation) in paths {
        for (right, wrong) in tables::stencil_neighbours() {
            list.add(
                &format!("{path}-{}-as-{}", right.name(), wrong.name()),
                CONFUSION,
                format!(
                    "The {path} operation {} acts as {}.",
                    right.name(),
                    wrong.name()
                ),
                faces(move |face| {
                    let operation = operation(face);
                    if *operation == right {
                        *operation = wrong;
                    }
                }),
            );
        }
    }
    let ends = [
        (
            StencilOperation::IncrementWrap,
            StencilOperation::IncrementClamp,
        ),
        (
            StencilOperation::IncrementClamp,
            StencilOperation::IncrementWrap,
        ),
        (
            StencilOperation::DecrementWrap,
            StencilOperation::DecrementClamp,
        ),
        (
            StencilOperation::DecrementClamp,
            StencilOperation::DecrementWrap,
        ),
    ];
    for (right, wrong) in ends {
        list.add(
            &format!("{}-as-{}", right.name(), wrong.name()),
            "zink: wrap mapped to clamp",
            format!("{} is {} on every path.", right.name(), wrong.name()),
            faces(move |face| {
                for operation in [
                    &mut face.fail_op,
                    &mut face.depth_fail_op,
                    &mut face.pass_op,
                ] {
                    if *operation == right {
                        *operation = wrong;
                    }
                }
            }),
        );
    }
    sides(list);
    masks(list);
    references(list);
    operations(list);
    switches(list);
}

fn stencils(bug: impl Fn(&mut StencilState) + Send + Sync + 'static) -> Plant {
    draws(move |draw| {
        if let Some(stencil) = &mut draw.stencil {
            bug(stencil);
        }
    })
}

fn sides(list: &mut List) {
    list.add(
        "faces-swapped",
        CONFUSION,
        "The states of front and back faces are exchanged.",
        stencils(|s| std::mem::swap(&mut s.front, &mut s.back)),
    );
    list.add(
        "back-overwrites-front",
        "wgpu: back stencil overwriting front",
        "Both faces take the back's state.",
        stencils(|s| s.front = s.back),
    );
    list.add(
        "front-overwrites-back",
        CONFUSION,
        "Both faces take the front's state.",
        stencils(|s| s.back = s.front),
    );
    type Part = (&'static str, fn(&mut StencilFace, &StencilFace));
    let parts: [Part; 7] = [
        ("compare", |to, from| to.compare = from.compare),
        ("fail-op", |to, from| to.fail_op = from.fail_op),
        ("depth-fail-op", |to, from| {
            to.depth_fail_op = from.depth_fail_op
        }),
        ("pass-op", |to, from| to.pass_op = from.pass_op),
        ("read-mask", |to, from| to.read_mask = from.read_mask),
        ("write-mask", |to, from| to.write_mask = from.write_mask),
        ("reference", |to, from| to.reference = from.reference),
    ];
    for (name, take) in parts {
        list.add(
            &format!("back-{name}-from-front"),
            "WebGPU CTS never tests the back's state apart from the front's",
            format!("Back faces take the front's {name}."),
            stencils(move |s| take(&mut s.back, &s.front.clone())),
        );
        list.add(
            &format!("front-{name}-from-back"),
            "wgpu: back stencil overwriting front",
            format!("Front faces take the back's {name}."),
            stencils(move |s| take(&mut s.front, &s.back.clone())),
        );
    }
}

fn masks(list: &mut List) {
    list.add(
        "read-mask-ignored",
        CONFUSION,
        "The read mask counts as all ones.",
        faces(|face| face.read_mask = 0xff),
    );
    list.add(
        "read-mask-on-reference-alone",
        CONFUSION,
        "The read mask is not applied to the stored value.",
        stencil_passes(|f, stored| compare(f.compare, f.reference & f.read_mask, stored)),
    );
    list.add(
        "read-mask-on-stored-alone",
        CONFUSION,
        "The read mask is not applied to the reference.",
        stencil_passes(|f, stored| compare(f.compare, f.reference, stored & f.read_mask)),
    );
    list.add(
        "read-mask-from-write-mask",
        CONFUSION,
        "The write mask is used for reading.",
        faces(|face| face.read_mask = face.write_mask),
    );
    list.add(
        "write-mask-from-read-mask",
        CONFUSION,
        "The read mask is used for writing.",
        faces(|face| face.write_mask = face.read_mask),
    );
    list.add(
        "read-mask-inverted",
        CONFUSION,
        "The read mask's bits mean their opposite.",
        faces(|face| face.read_mask = !face.read_mask),
    );
    list.add(
        "write-mask-ignored",
        CONFUSION,
        "All bits are written.",
        faces(|face| face.write_mask = 0xff),
    );
    list.add(
        "write-mask-inverted",
        CONFUSION,
        "The write mask's bits mean their opposite.",
        faces(|face| face.write_mask = !face.write_mask),
    );
    list.add(
        "write-mask-zero-still-writes",
        "SwiftShader: write mask 0 still writing",
        "A write mask of 0 counts as all ones.",
        faces(|face| {
            if face.write_mask == 0 {
                face.write_mask = 0xff;
            }
        }),
    );
    list.add(
        "write-mask-in-7-bits",
        CONFUSION,
        "The highest bit is never written.",
        faces(|face| face.write_mask &= 0x7f),
    );
    list.add(
        "read-mask-in-7-bits",
        CONFUSION,
        "The highest bit is never compared.",
        faces(|face| face.read_mask &= 0x7f),
    );
    list.add(
        "write-mask-clears",
        CONFUSION,
        "Bits outside the write mask become 0.",
        stencil_write(|f, path, stored| {
            stencil_operation(path.operation(f), stored, f.reference) & f.write_mask
        }),
    );
    list.add(
        "operation-on-masked-value",
        CONFUSION,
        "Operations start from the stored value under the write mask.",
        stencil_write(|f, path, stored| {
            let value = stored & f.write_mask;
            let new = stencil_operation(path.operation(f), value, f.reference);
            (stored & !f.write_mask) | (new & f.write_mask)
        }),
    );
    list.add(
        "off-with-read-mask-zero",
        "wgpu: stencil off when the read mask is 0",
        "A draw whose read masks are 0 has no stencil test.",
        draws(|draw| {
            draw.stencil = draw
                .stencil
                .filter(|s| s.front.read_mask != 0 || s.back.read_mask != 0);
        }),
    );
    list.add(
        "off-with-write-mask-zero",
        CONFUSION,
        "A draw whose write masks are 0 has no stencil test.",
        draws(|draw| {
            draw.stencil = draw
                .stencil
                .filter(|s| s.front.write_mask != 0 || s.back.write_mask != 0);
        }),
    );
}

fn references(list: &mut List) {
    list.add(
        "reference-unset-for-replace",
        "wgpu: reference not set for replace",
        "The reference stays 0 where no comparison needs it.",
        faces(|face| {
            if matches!(
                face.compare,
                CompareFunction::Always | CompareFunction::Never
            ) {
                face.reference = 0;
            }
        }),
    );
    list.add(
        "reference-zero",
        "wgpu: reference not set",
        "The reference is 0.",
        faces(|face| face.reference = 0),
    );
    list.add(
        "reference-in-7-bits",
        CONFUSION,
        "The reference loses its highest bit.",
        faces(|face| face.reference &= 0x7f),
    );
    list.add(
        "reference-plus-1",
        CONFUSION,
        "The reference is one too large.",
        faces(|face| face.reference = face.reference.wrapping_add(1)),
    );
    list.add(
        "reference-in-16-steps",
        CONFUSION,
        "The reference loses its lowest four bits.",
        faces(|face| face.reference &= 0xf0),
    );
    list.add(
        "signed-compare",
        CONFUSION,
        "Both sides are compared as signed bytes.",
        stencil_passes(|f, stored| {
            let signed = |v: u8| (v & f.read_mask).cast_signed();
            compare(f.compare, signed(f.reference), signed(stored))
        }),
    );
    list.add(
        "reference-sign-extended",
        "SwiftShader: masked stencil reference sign error",
        "The masked reference is sign-extended, the stored value is not.",
        stencil_passes(|f, stored| {
            let reference = i32::from((f.reference & f.read_mask).cast_signed());
            compare(f.compare, reference, i32::from(stored & f.read_mask))
        }),
    );
    list.add(
        "compare-operands-swapped",
        CONFUSION,
        "The stored value stands on the left of the comparison.",
        stencil_passes(|f, stored| {
            compare(f.compare, stored & f.read_mask, f.reference & f.read_mask)
        }),
    );
    list.add(
        "replace-by-masked-reference",
        CONFUSION,
        "Replace writes the reference under the read mask.",
        stencil_write(|f, path, stored| {
            let reference = f.reference & f.read_mask;
            let new = stencil_operation(path.operation(f), stored, reference);
            (stored & !f.write_mask) | (new & f.write_mask)
        }),
    );
}

fn operations(list: &mut List) {
    let write = |f: &StencilFace, path: Path, stored: u8| {
        let new = stencil_operation(path.operation(f), stored, f.reference);
        (stored & !f.write_mask) | (new & f.write_mask)
    };
    list.add(
        "fail-and-pass-op-both-applied",
        "llvmpipe: fail op and pass op both applied",
        "A fragment that fails the stencil test takes the pass operation too.",
        stencil_write(move |f, path, stored| match path {
            Path::Fail => write(f, Path::Pass, write(f, Path::Fail, stored)),
            _ => write(f, path, stored),
        }),
    );
    list.add(
        "depth-fail-and-pass-op-both-applied",
        "llvmpipe: fail op and pass op both applied",
        "A fragment that fails the depth test takes the pass operation too.",
        stencil_write(move |f, path, stored| match path {
            Path::DepthFail => write(f, Path::Pass, write(f, path, stored)),
            _ => write(f, path, stored),
        }),
    );
    list.add(
        "applied-twice",
        CONFUSION,
        "Operations are applied twice.",
        stencil_write(move |f, path, stored| write(f, path, write(f, path, stored))),
    );
    list.add(
        "depth-fail-op-on-pass",
        CONFUSION,
        "Passing fragments take the depth-fail operation.",
        faces(|face| face.pass_op = face.depth_fail_op),
    );
    list.add(
        "pass-op-on-depth-fail",
        CONFUSION,
        "Fragments that fail the depth test take the pass operation.",
        faces(|face| face.depth_fail_op = face.pass_op),
    );
    list.add(
        "fail-op-on-depth-fail",
        CONFUSION,
        "Fragments that fail the depth test take the fail operation.",
        faces(|face| face.depth_fail_op = face.fail_op),
    );
    list.add(
        "fail-and-depth-fail-swapped",
        CONFUSION,
        "The fail and the depth-fail operation are exchanged.",
        faces(|face| std::mem::swap(&mut face.fail_op, &mut face.depth_fail_op)),
    );
    list.add(
        "fail-and-pass-swapped",
        CONFUSION,
        "The fail and the pass operation are exchanged.",
        faces(|face| std::mem::swap(&mut face.fail_op, &mut face.pass_op)),
    );
    list.add(
        "dropped-on-depth-fail",
        "v3d: early depth test against stencil write",
        "Fragments that fail the depth test leave stencil alone.",
        faces(|face| face.depth_fail_op = StencilOperation::Keep),
    );
    list.add(
        "dropped-on-fail",
        CONFUSION,
        "Fragments that fail the stencil test leave stencil alone.",
        faces(|face| face.fail_op = StencilOperation::Keep),
    );
    list.add(
        "dropped-on-pass",
        CONFUSION,
        "Passing fragments leave stencil alone.",
        faces(|face| face.pass_op = StencilOperation::Keep),
    );
    list.add(
        "invert-7-bits",
        CONFUSION,
        "Invert leaves the highest bit.",
        stencil_write(move |f, path, stored| match path.operation(f) {
            StencilOperation::Invert => (stored & !f.write_mask) | ((stored ^ 0x7f) & f.write_mask),
            _ => write(f, path, stored),
        }),
    );
}

fn switches(list: &mut List) {
    list.add(
        "test-off",
        CONFUSION,
        "There is no stencil test.",
        draws(|draw| draw.stencil = None),
    );
    list.add(
        "test-passes-always",
        CONFUSION,
        "The stencil test always passes.",
        stencil_passes(|_, _| true),
    );
    list.add(
        "off-without-depth",
        CONFUSION,
        "An attachment of stencil alone is not tested.",
        scene(|scene| {
            for pass in &mut scene.passes {
                let format = pass.depth_stencil.map(|i| scene.attachments[i].format);
                if format == Some(TextureFormat::Stencil8) {
                    pass.draws.iter_mut().for_each(|d| d.stencil = None);
                }
            }
        }),
    );
    list.add(
        "off-without-depth-test",
        CONFUSION,
        "A draw without a depth test has no stencil test.",
        draws(|draw| {
            if draw.depth.is_none() {
                draw.stencil = None;
            }
        }),
    );
    list.add(
        "color-where-stencil-fails",
        CONFUSION,
        "Fragments that fail the stencil test still write their colour.",
        written(|[covered, stencil, depth]| [covered && depth, covered && stencil && depth]),
    );
    list.add(
        "update-needs-read-mask",
        CONFUSION,
        "Only bits of the read mask are written.",
        stencil_write(|f, path, stored| {
            let mask = f.write_mask & f.read_mask;
            let new = stencil_operation(path.operation(f), stored, f.reference);
            (stored & !mask) | (new & mask)
        }),
    );
    list.add(
        "largest-value-never-passes",
        CONFUSION,
        "A stored value of 255 fails.",
        stencil_passes(|f, stored| stored != 255 && passes(f, stored)),
    );
}
