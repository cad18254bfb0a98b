//! Bugs of the depth test and of stored depths.

use crate::fields::{DEPTH, DEPTH_COMPARE, DEPTH_WRITE, WRITE_MASK};
use crate::hooks::{code, depth_code, depth_passes, written};
use crate::list::{SMALL, bugs, rounded};
use crate::plant::{Plant, draws, each, in_bits, set};
use crate::tables::compare_neighbours;
use etalon_frame::ChannelEncoding::{self, Float32, Unorm};
use etalon_pipeline::compare;
use etalon_scene::{CompareFunction, DepthState, Shader};

/// Replaces the conversion of depths to one encoding.
fn stored(encoding: ChannelEncoding, bug: impl Fn(f32) -> u32 + Send + Sync + 'static) -> Plant {
    depth_code(move |e, v| if e == encoding { bug(v) } else { code(e, v) })
}

/// Replaces the comparison of codes, incoming first.
fn codes_pass(bug: fn(CompareFunction, u32, u32) -> bool) -> Plant {
    depth_passes(move |function, depths| bug(function, depths.incoming, depths.stored))
}

bugs! {
    class "depth", "depth";
    swaps "compare-", "The depth test ", DEPTH_COMPARE, compare_neighbours();
    "compare-operands-swapped: The stored depth stands on the left of the comparison." =>
        codes_pass(|function, incoming, stored| compare(function, stored, incoming));
    "equal-within-one-code: Depths that differ by one code count as equal." =>
        codes_pass(|function, incoming, stored| match function {
            CompareFunction::Equal => incoming.abs_diff(stored) <= 1,
            CompareFunction::NotEqual => incoming.abs_diff(stored) > 1,
            _ => compare(function, incoming, stored),
        }), source SMALL;
    "compare-high-20-bits: Float depths are compared by their upper 20 bits." =>
        codes_pass(|function, incoming, stored| compare(function, incoming >> 12, stored >> 12)), source SMALL;
    let state = |compare, write| Some(DepthState { compare, write });
    "write-ignored: Depth is never written." => set(DEPTH_WRITE, false);
    "write-always: Passing fragments write depth although writing is off." => set(DEPTH_WRITE, true);
    "write-inverted: The write setting means its opposite." => each(DEPTH_WRITE, |write| *write = !*write);
    "write-with-test-off: A draw without a depth test writes its depth." =>
        set(DEPTH, state(CompareFunction::Always, true)),
        source "ANGLE: writes persisting with the test off", when |draw| draw.depth.is_none();
    "write-off-with-always: A test that always passes counts as none, and its write is lost." =>
        set(DEPTH, None), when |draw| draw.depth.is_some_and(|d| d.compare == CompareFunction::Always);
    "test-off: The depth test always passes." => set(DEPTH_COMPARE, CompareFunction::Always);
    "test-off-without-write: A draw that does not write depth is not tested either." =>
        set(DEPTH, None), when |draw| draw.depth.is_some_and(|d| !d.write);
    "test-on-with-test-off: A draw without a depth test is tested by `less`." =>
        set(DEPTH, state(CompareFunction::Less, false)), when |draw| draw.depth.is_none();
    "color-where-depth-fails: Fragments that fail the depth test write their colour." =>
        written(|[covered, stencil, depth]| [covered && stencil, covered && stencil && depth]);
    "written-where-depth-fails: Fragments that fail the depth test write their depth." =>
        written(|[covered, stencil, depth]| [covered && stencil && depth, covered && stencil]);
    "no-color-with-depth-write: A draw that writes depth writes no colour." =>
        set(WRITE_MASK, 0), when |draw| draw.depth.is_some_and(|d| d.write);
    "shader-depth-ignored: The depth that the shader writes is ignored." =>
        draws(|draw| draw.shader = Shader::UniformColor),
        source "the vertex depth kept despite a written one", when |draw| draw.shader == Shader::FlatColorDepth;
    // Only draws with a stencil test show this bug.
    "written-before-stencil-decides: Depth is written before the stencil test." =>
        written(|[covered, stencil, depth]| [covered && stencil && depth, covered && depth]),
        source "v3d: early depth against stencil writes", area "stencil";
    "d16-truncated: 16-bit depths are rounded down." =>
        stored(Unorm(16), |v| (f64::from(v) * 65535.0) as u32), source "truncation instead of rounding", permitted rounded();
    "d16-rounded-up: 16-bit depths are rounded up." =>
        stored(Unorm(16), |v| (f64::from(v) * 65535.0).ceil() as u32), source "rounding up", permitted rounded();
    for (bits, kept) in [(16, 15), (16, 12), (24, 22), (24, 16)] {
        "d{bits}-in-{kept}-bits: {bits}-bit depths keep {kept} bits." =>
            stored(Unorm(bits), move |v| code(Unorm(bits), in_bits(v, kept))),
            source "drivers that keep 22 or 15 bits of D24 or D16";
    }
    for (bits, source) in [(24, "a float format backed by D24"), (16, "a float format backed by D16")] {
        "d32f-in-{bits}-bits: Float depths are rounded to {bits}-bit normalized ones." =>
            stored(Float32, move |v| in_bits(v, bits).to_bits()), source source;
    }
    "d32f-one-ulp-up: Float depths between 0 and 1 are stored one unit too far." =>
        stored(Float32, |v| code(Float32, v) + u32::from(v > 0.0 && v < 1.0)), source SMALL;
    "d32f-denormals-and-small-flushed: Float depths below 2^-24 become 0." =>
        stored(Float32, |v| code(Float32, if v < f32::powi(2.0, -24) { 0.0 } else { v })), source SMALL;
    "one-minus-depth: Depths are stored reversed." =>
        depth_code(|encoding, v| code(encoding, 1.0 - v)), source "a reversed range";
    "one-never-reached: The farthest depth is stored one code short." =>
        depth_code(|encoding, v| code(encoding, v) - u32::from(v == 1.0)), source SMALL;
}
