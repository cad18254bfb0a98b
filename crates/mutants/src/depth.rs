//! Bugs of the depth test and of stored depths.

use crate::fields::{DEPTH, DEPTH_COMPARE, DEPTH_WRITE, WRITE_MASK};
use crate::hooks::{code, depth_code, depth_passes, written};
use crate::list::{List, ROUNDED, SMALL};
use crate::plant::{Plant, in_bits};
use crate::tables::compare_neighbours;
use etalon_frame::ChannelEncoding::{self, Float32, Unorm};
use etalon_pipeline::compare;
use etalon_scene::{CompareFunction, DepthState, Shader};

pub(super) fn add(list: &mut List) {
    list.class("depth", "depth");
    list.swaps(
        "compare-",
        "The depth test ",
        DEPTH_COMPARE,
        compare_neighbours(),
    );
    list.bug("compare-operands-swapped: The stored depth stands on the left of the comparison.")
        .plant(depth_passes(|function, incoming, stored| {
            compare(function, stored, incoming)
        }));
    list.bug("equal-within-one-code: Depths that differ by one code count as equal.")
        .source(SMALL)
        .plant(depth_passes(|function, incoming, stored| match function {
            CompareFunction::Equal => incoming.abs_diff(stored) <= 1,
            CompareFunction::NotEqual => incoming.abs_diff(stored) > 1,
            _ => compare(function, incoming, stored),
        }));
    list.bug("compare-high-20-bits: Float depths are compared by their upper 20 bits.")
        .source(SMALL)
        .plant(depth_passes(|function, incoming, stored| {
            compare(function, incoming >> 12, stored >> 12)
        }));
    writes(list);
    precision(list);
}

fn writes(list: &mut List) {
    let state = |compare, write| Some(DepthState { compare, write });
    list.bug("write-ignored: Depth is never written.")
        .set(DEPTH_WRITE, false);
    list.bug("write-always: Passing fragments write depth although writing is off.")
        .set(DEPTH_WRITE, true);
    list.bug("write-inverted: The write setting means its opposite.")
        .each(DEPTH_WRITE, |write| *write = !*write);
    list.bug("write-with-test-off: A draw without a depth test writes its depth.")
        .source("ANGLE: writes persisting with the test off")
        .when(|draw| draw.depth.is_none())
        .set(DEPTH, state(CompareFunction::Always, true));
    list.bug(
        "write-off-with-always: A test that always passes counts as none, and its write is lost.",
    )
    .when(|draw| {
        draw.depth
            .is_some_and(|d| d.compare == CompareFunction::Always)
    })
    .set(DEPTH, None);
    list.bug("test-off: The depth test always passes.")
        .set(DEPTH_COMPARE, CompareFunction::Always);
    list.bug("test-off-without-write: A draw that does not write depth is not tested either.")
        .when(|draw| draw.depth.is_some_and(|d| !d.write))
        .set(DEPTH, None);
    list.bug("test-on-with-test-off: A draw without a depth test is tested by `less`.")
        .when(|draw| draw.depth.is_none())
        .set(DEPTH, state(CompareFunction::Less, false));
    list.bug("color-where-depth-fails: Fragments that fail the depth test write their colour.")
        .plant(written(|[covered, stencil, depth]| {
            [covered && stencil, covered && stencil && depth]
        }));
    list.bug("written-where-depth-fails: Fragments that fail the depth test write their depth.")
        .plant(written(|[covered, stencil, depth]| {
            [covered && stencil && depth, covered && stencil]
        }));
    list.bug("no-color-with-depth-write: A draw that writes depth writes no colour.")
        .when(|draw| draw.depth.is_some_and(|d| d.write))
        .set(WRITE_MASK, 0);
    list.bug("shader-depth-ignored: The depth that the shader writes is ignored.")
        .source("the vertex depth kept despite a written one")
        .when(|draw| draw.shader == Shader::FlatColorDepth)
        .draws(|draw| draw.shader = Shader::UniformColor);
    // Only draws with a stencil test show it.
    list.bug("written-before-stencil-decides: Depth is written before the stencil test.")
        .source("v3d: early depth against stencil writes")
        .area("stencil")
        .plant(written(|[covered, stencil, depth]| {
            [covered && stencil && depth, covered && depth]
        }));
}

/// Replaces the conversion to one encoding.
fn stored(encoding: ChannelEncoding, bug: impl Fn(f32) -> u32 + Send + Sync + 'static) -> Plant {
    depth_code(move |e, v| if e == encoding { bug(v) } else { code(e, v) })
}

fn precision(list: &mut List) {
    list.bug("d16-truncated: 16-bit depths are rounded down.")
        .source("truncation instead of rounding")
        .legal(ROUNDED)
        .plant(stored(Unorm(16), |v| (f64::from(v) * 65535.0) as u32));
    list.bug("d16-rounded-up: 16-bit depths are rounded up.")
        .source("rounding up")
        .legal(ROUNDED)
        .plant(stored(Unorm(16), |v| {
            (f64::from(v) * 65535.0).ceil() as u32
        }));
    for (bits, kept) in [(16, 15), (16, 12), (24, 22), (24, 16)] {
        list.bug(format!(
            "d{bits}-in-{kept}-bits: {bits}-bit depths keep {kept} bits."
        ))
        .source("drivers that keep 22 or 15 bits of D24 or D16")
        .plant(stored(Unorm(bits), move |v| {
            code(Unorm(bits), in_bits(v, kept))
        }));
    }
    for (bits, source) in [
        (24, "a float format backed by D24"),
        (16, "a float format backed by D16"),
    ] {
        list.bug(format!(
            "d32f-in-{bits}-bits: Float depths are rounded to {bits}-bit normalized ones."
        ))
        .source(source)
        .plant(stored(Float32, move |v| in_bits(v, bits).to_bits()));
    }
    list.bug("d32f-one-ulp-up: Float depths between 0 and 1 are stored one unit too far.")
        .source(SMALL)
        .plant(stored(Float32, |v| {
            code(Float32, v) + u32::from(v > 0.0 && v < 1.0)
        }));
    list.bug("d32f-denormals-and-small-flushed: Float depths below 2^-24 become 0.")
        .source(SMALL)
        .plant(stored(Float32, |v| {
            code(Float32, if v < f32::powi(2.0, -24) { 0.0 } else { v })
        }));
    list.bug("one-minus-depth: Depths are stored reversed.")
        .source("a reversed range")
        .plant(depth_code(|encoding, v| code(encoding, 1.0 - v)));
    list.bug("one-never-reached: The farthest depth is stored one code short.")
        .source(SMALL)
        .plant(depth_code(|encoding, v| {
            code(encoding, v) - u32::from(v == 1.0)
        }));
}
