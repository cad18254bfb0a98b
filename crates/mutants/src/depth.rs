//! Bugs of the depth test and of stored depths.

use super::hooks::{code, depth_code, depth_passes, written};
use super::list::{CONFUSION, List, SMALL};
use super::plant::{draws, in_bits};
use super::tables;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::compare;
use etalon_scene::{CompareFunction, DepthState, Shader};

const KEPT_BITS: &str = "drivers that keep 22 or 15 bits of D24 or D16";

pub(super) fn add(list: &mut List) {
    list.class("depth", "depth");
    for (right, wrong) in tables::compare_neighbours() {
        list.add(
            &format!("compare-{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!("The depth test {} acts as {}.", right.name(), wrong.name()),
            draws(move |draw| {
                if let Some(depth) = &mut draw.depth
                    && depth.compare == right
                {
                    depth.compare = wrong;
                }
            }),
        );
    }
    list.add(
        "compare-operands-swapped",
        CONFUSION,
        "The stored depth stands on the left of the comparison.",
        depth_passes(|function, incoming, stored| compare(function, stored, incoming)),
    );
    list.add(
        "equal-within-one-code",
        SMALL,
        "Depths that differ by one code count as equal.",
        depth_passes(|function, incoming, stored| match function {
            CompareFunction::Equal => incoming.abs_diff(stored) <= 1,
            CompareFunction::NotEqual => incoming.abs_diff(stored) > 1,
            _ => compare(function, incoming, stored),
        }),
    );
    list.add(
        "compare-high-20-bits",
        SMALL,
        "Float depths are compared by their upper 20 bits.",
        depth_passes(|function, incoming, stored| compare(function, incoming >> 12, stored >> 12)),
    );
    writes(list);
    precision(list);
}

fn writes(list: &mut List) {
    list.add(
        "write-ignored",
        CONFUSION,
        "Depth is never written.",
        draws(|draw| {
            if let Some(depth) = &mut draw.depth {
                depth.write = false;
            }
        }),
    );
    list.add(
        "write-always",
        CONFUSION,
        "Passing fragments write depth although writing is off.",
        draws(|draw| {
            if let Some(depth) = &mut draw.depth {
                depth.write = true;
            }
        }),
    );
    list.add(
        "write-inverted",
        CONFUSION,
        "The write setting means its opposite.",
        draws(|draw| {
            if let Some(depth) = &mut draw.depth {
                depth.write = !depth.write;
            }
        }),
    );
    list.add(
        "write-with-test-off",
        "ANGLE: writes persisting with the test off",
        "A draw without a depth test writes its depth.",
        draws(|draw| {
            draw.depth.get_or_insert(DepthState {
                compare: CompareFunction::Always,
                write: true,
            });
        }),
    );
    list.add(
        "write-off-with-always",
        CONFUSION,
        "A test that always passes counts as no test, and its write is lost.",
        draws(|draw| {
            draw.depth = draw.depth.filter(|d| d.compare != CompareFunction::Always);
        }),
    );
    list.add(
        "test-off",
        CONFUSION,
        "The depth test always passes.",
        draws(|draw| {
            if let Some(depth) = &mut draw.depth {
                depth.compare = CompareFunction::Always;
            }
        }),
    );
    list.add(
        "test-off-without-write",
        CONFUSION,
        "A draw that does not write depth is not tested either.",
        draws(|draw| draw.depth = draw.depth.filter(|d| d.write)),
    );
    list.add(
        "test-on-with-test-off",
        CONFUSION,
        "A draw without a depth test is tested by `less`.",
        draws(|draw| {
            draw.depth.get_or_insert(DepthState {
                compare: CompareFunction::Less,
                write: false,
            });
        }),
    );
    list.add(
        "color-where-depth-fails",
        CONFUSION,
        "Fragments that fail the depth test still write their colour.",
        written(|[covered, stencil, depth]| [covered && stencil, covered && stencil && depth]),
    );
    list.add(
        "written-where-depth-fails",
        CONFUSION,
        "Fragments that fail the depth test still write their depth.",
        written(|[covered, stencil, depth]| [covered && stencil && depth, covered && stencil]),
    );
    list.add(
        "no-color-with-depth-write",
        CONFUSION,
        "A draw that writes depth is treated as depth-only and writes no colour.",
        draws(|draw| {
            if draw.depth.is_some_and(|d| d.write) {
                draw.targets.iter_mut().for_each(|t| t.write_mask = 0);
            }
        }),
    );
    list.add(
        "shader-depth-ignored",
        "the vertex depth kept despite a written one",
        "The depth that the shader writes is ignored.",
        draws(|draw| {
            if draw.shader == Shader::FlatColorDepth {
                draw.shader = Shader::UniformColor;
            }
        }),
    );
    list.add(
        "written-before-stencil-decides",
        "v3d: early depth against stencil writes",
        "Depth is written before the stencil test.",
        written(|[covered, stencil, depth]| [covered && stencil && depth, covered && depth]),
    );
    // Only draws with a stencil test show it.
    if let Some(last) = list.mutants.last_mut() {
        last.area = "stencil";
    }
}

fn precision(list: &mut List) {
    let unorm = |bits: u8, kept: u32| {
        depth_code(move |encoding, v| match encoding {
            ChannelEncoding::Unorm(b) if b == bits => code(encoding, in_bits(v, kept)),
            _ => code(encoding, v),
        })
    };
    let float = |kept: u32| {
        depth_code(move |encoding, v| match encoding {
            ChannelEncoding::Float32 => in_bits(v, kept).to_bits(),
            _ => code(encoding, v),
        })
    };
    list.add(
        "d16-truncated",
        "truncation instead of rounding",
        "16-bit depths are rounded down.",
        depth_code(|encoding, v| match encoding {
            ChannelEncoding::Unorm(16) => (f64::from(v) * 65535.0) as u32,
            _ => code(encoding, v),
        }),
    )
    .legal(
        "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized Fixed-Point: one of the \
         two closest values, the nearest only recommended",
    );
    list.add(
        "d16-rounded-up",
        "rounding up",
        "16-bit depths are rounded up.",
        depth_code(|encoding, v| match encoding {
            ChannelEncoding::Unorm(16) => (f64::from(v) * 65535.0).ceil() as u32,
            _ => code(encoding, v),
        }),
    )
    .legal(
        "Vulkan: Fundamentals, Conversion from Floating-Point to Normalized Fixed-Point: one of the \
         two closest values, the nearest only recommended",
    );
    list.add(
        "d16-in-15-bits",
        KEPT_BITS,
        "16-bit depths keep 15 bits.",
        unorm(16, 15),
    );
    list.add(
        "d16-in-12-bits",
        KEPT_BITS,
        "16-bit depths keep 12 bits.",
        unorm(16, 12),
    );
    list.add(
        "d24-in-22-bits",
        KEPT_BITS,
        "24-bit depths keep 22 bits.",
        unorm(24, 22),
    );
    list.add(
        "d24-in-16-bits",
        KEPT_BITS,
        "24-bit depths keep 16 bits.",
        unorm(24, 16),
    );
    list.add(
        "d32f-in-24-bits",
        "a float format backed by D24",
        "Float depths are rounded to 24-bit normalized ones.",
        float(24),
    );
    list.add(
        "d32f-in-16-bits",
        "a float format backed by D16",
        "Float depths are rounded to 16-bit normalized ones.",
        float(16),
    );
    list.add(
        "d32f-one-ulp-up",
        SMALL,
        "Float depths between 0 and 1 are stored one unit in the last place too far.",
        depth_code(|encoding, v| {
            let right = code(encoding, v);
            let inside = encoding == ChannelEncoding::Float32 && v > 0.0 && v < 1.0;
            right + u32::from(inside)
        }),
    );
    list.add(
        "d32f-denormals-and-small-flushed",
        SMALL,
        "Float depths below 2^-24 become 0.",
        depth_code(|encoding, v| {
            let flushed = encoding == ChannelEncoding::Float32 && v < f32::powi(2.0, -24);
            code(encoding, if flushed { 0.0 } else { v })
        }),
    );
    list.add(
        "one-minus-depth",
        "a reversed range",
        "Depths are stored reversed.",
        depth_code(|encoding, v| code(encoding, 1.0 - v)),
    );
    list.add(
        "one-never-reached",
        SMALL,
        "The farthest depth is stored one code short.",
        depth_code(|encoding, v| code(encoding, v) - u32::from(v == 1.0)),
    );
}
