//! Plain results are inside judged intervals, and wider rules give wider intervals.

use crate::common::{all_rules, assert_inside, assert_within, config};
use etalon_frame::{ChannelEncoding, CodeInterval};
use etalon_pipeline::{Arithmetic, BlendInput, Plain, blend, window_position};
use etalon_reference::rules::{BlendPrecision, Rounding};
use etalon_reference::{Interval, Judging, Range, Rules};
use etalon_scene::{BlendComponent, BlendFactor, BlendOperation, BlendState, Viewport};
use proptest::prelude::*;
use proptest::sample::select;

fn component() -> impl Strategy<Value = BlendComponent> {
    (
        select(BlendOperation::ALL),
        select(BlendFactor::ALL),
        select(BlendFactor::ALL),
    )
        .prop_map(|(operation, src_factor, dst_factor)| BlendComponent {
            operation,
            src_factor,
            dst_factor,
        })
}

fn state() -> impl Strategy<Value = BlendState> {
    (component(), component()).prop_map(|(color, alpha)| BlendState { color, alpha })
}

/// Values inside and outside 0..=1, exactly representable ones among them.
fn value() -> impl Strategy<Value = f32> {
    prop_oneof![
        select(vec![
            0.0_f32,
            -0.0,
            1.0,
            0.5,
            2.0,
            -1.0,
            1e-30,
            -1e-30,
            0.999_999_94,
            1.000_000_1,
            0.25
        ]),
        0.0_f32..=1.0,
        -2.0_f32..3.0,
        (0_u8..=255).prop_map(|code| f32::from(code) / 255.0),
        (0_u8..=254).prop_map(|code| (f32::from(code) + 0.5) / 255.0),
    ]
}

fn code() -> impl Strategy<Value = u32> {
    prop_oneof![select(vec![0_u32, 1, 127, 128, 254, 255]), 0_u32..=255]
}

/// One blend: state, source, destination codes, constant, second source.
type Blend = (BlendState, [f32; 4], [u32; 4], [f32; 4], [f32; 4]);

fn blends() -> impl Strategy<Value = Blend> {
    (
        state(),
        [value(), value(), value(), value()],
        [code(), code(), code(), code()],
        [value(), value(), value(), value()],
        [value(), value(), value(), value()],
    )
}

fn plain(encoding: ChannelEncoding, (state, src, dst, constant, src1): &Blend) -> [i64; 4] {
    let mut a = Plain::<1>;
    let input = BlendInput {
        src: src.map(|v| [v]),
        src1: src1.map(|v| [v]),
        dst: dst.map(|c| a.decode(encoding, [c])),
        constant: constant.map(|v| [v]),
    };
    blend(&mut a, state, [encoding; 4], &input)
        .map(|v| encoding.order_of_code(a.encode(encoding, v)[0]))
}

fn judged(
    rules: &Rules,
    encoding: ChannelEncoding,
    (state, src, dst, constant, src1): &Blend,
) -> [CodeInterval; 4] {
    let mut a = Judging::new(rules);
    let input = BlendInput {
        src: src.map(|v| a.constant(v)),
        src1: src1.map(|v| a.constant(v)),
        dst: dst.map(|c| a.decode(encoding, CodeInterval::exact(encoding.order_of_code(c)))),
        constant: constant.map(|v| a.constant(v)),
    };
    blend(&mut a, state, [encoding; 4], &input).map(|v| a.encode(encoding, v))
}

/// Pairs of rules in which the second permits everything that the first permits.
pub(crate) fn wider() -> Vec<(Rules, Rules)> {
    use etalon_reference::rules::{DepthOrder, SharedEdge, Snap};
    let yardstick = || all_rules().pop().expect("the yardstick comes last");
    let mut pairs = Vec::new();
    for rules in all_rules() {
        pairs.push((yardstick(), rules.clone()));
        for factor in [1.5, 10.0, 1000.0] {
            let mut wide = rules.clone();
            wide.float_error.set(wide.float_error.value() * factor);
            pairs.push((rules.clone(), wide.clone()));
            wide.decode_error.set(wide.decode_error.value() * factor);
            pairs.push((rules.clone(), wide));
        }
    }
    let changes: [fn(&mut Rules); 7] = [
        |r| r.store.set(Rounding::EitherNeighbour),
        |r| r.blend.set(BlendPrecision::DestinationCodes),
        |r| r.blend.set(BlendPrecision::AnySteps),
        |r| r.snap.set(Snap::EitherSide),
        |r| r.shared_edge.set(SharedEdge::ExactlyOne),
        |r| r.shared_edge.set(SharedEdge::Independent),
        |r| r.depth_order.set(DepthOrder::Either),
    ];
    for change in changes {
        let mut wide = yardstick();
        change(&mut wide);
        pairs.push((yardstick(), wide));
        let mut wide = Rules::of(&crate::common::limits(etalon_frame::Api::Vulkan));
        let tight = wide.clone();
        change(&mut wide);
        pairs.push((tight, wide));
    }
    pairs
}

fn viewport() -> impl Strategy<Value = Viewport> {
    let length = || (1_u32..=4096).prop_map(|n| n as f32);
    let start = || prop_oneof![Just(0.0_f32), -64.0_f32..64.0, 0.0_f32..2048.0];
    let depth = prop_oneof![
        2 => Just([0.0, 1.0]),
        1 => Just([1.0, 0.0]),
        3 => [0.0_f32..=1.0, 0.0_f32..=1.0],
    ];
    (start(), start(), length(), length(), depth).prop_map(|(x, y, w, h, depth)| Viewport {
        rect: [x, y, w, h],
        depth,
    })
}

fn check_window_position([x, y, z]: [f32; 3], viewport: Viewport) -> Result<(), TestCaseError> {
    let plain = window_position(&mut Plain::<1>, [x, y, z, 1.0], &viewport);
    for rules in all_rules() {
        let judged = window_position(&mut Judging::new(&rules), [x, y, z, 1.0], &viewport);
        for axis in 0..3 {
            prop_assert!(
                judged[axis].float.contains(f64::from(plain[axis][0])),
                "{}, axis {axis}: {} is not in {:?}",
                rules.name,
                plain[axis][0],
                judged[axis].float
            );
        }
    }
    Ok(())
}

fn normalized() -> impl Strategy<Value = f32> {
    prop_oneof![0.0_f32..=1.0, code().prop_map(|code| code as f32 / 255.0)]
}

fn factor() -> impl Strategy<Value = f32> {
    prop_oneof![-8.0_f32..=8.0, -0.01_f32..=0.01]
}

/// Rounds to a float with a significand of `bits` bits: down, up or to the nearest.
fn short(bits: i32, direction: i8, value: f64) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let step = (value.abs().log2().floor() + 1.0 - f64::from(bits)).exp2();
    let steps = value / step;
    step * match direction {
        -1 => steps.floor(),
        1 => steps.ceil(),
        _ => steps.round(),
    }
}

/// The source weighted by the complement of the destination's alpha, and the destination by the source's
/// alpha.
const SHORT_BLEND: BlendComponent = BlendComponent {
    operation: BlendOperation::Add,
    src_factor: BlendFactor::OneMinusDstAlpha,
    dst_factor: BlendFactor::SrcAlpha,
};

/// Blends by [`SHORT_BLEND`], with every operand and result rounded by `short`.
fn short_blend(
    encoding: ChannelEncoding,
    short: impl Fn(f64) -> f64,
    src: [f32; 4],
    dst: [u32; 4],
) -> [f64; 4] {
    let src = src.map(|v| short(f64::from(v)));
    let dst = dst.map(|c| short(decoded(encoding, c)));
    std::array::from_fn(|c| {
        let from_src = short(src[c] * short(1.0 - dst[3]));
        short(from_src + short(dst[c] * src[3]))
    })
}

fn decoded(encoding: ChannelEncoding, code: u32) -> f64 {
    match encoding {
        ChannelEncoding::Srgb8 => etalon_frame::srgb_to_linear(f64::from(code) / 255.0),
        ChannelEncoding::Float16 | ChannelEncoding::Ufloat(_) => {
            encoding.value_of_order(encoding.order_of_code(code))
        }
        _ => f64::from(code) / 255.0,
    }
}

/// The rules of every API, without the yardstick, which requires 32-bit blending.
fn api_rules() -> Vec<Rules> {
    let mut rules = all_rules();
    rules.pop();
    rules
}

proptest! {
    #![proptest_config(config(4000))]

    #[test]
    fn a_blend_into_8_bits_by_floats_of_8_bits_or_more_is_legal(
        src in [normalized(), normalized(), normalized(), normalized()],
        dst in [code(), code(), code(), code()],
        bits in 8_i32..=24,
        direction in -1_i8..=1,
        srgb in any::<bool>(),
    ) {
        let encoding = if srgb { ChannelEncoding::Srgb8 } else { ChannelEncoding::Unorm(8) };
        let state = BlendState { color: SHORT_BLEND, alpha: SHORT_BLEND };
        let results = short_blend(encoding, |v| short(bits, direction, v), src, dst);
        let codes = results.map(|v| encoding.position(v.clamp(0.0, 1.0)).map_or(0, |p| p.round() as i64));
        for rules in api_rules() {
            let intervals = judged(&rules, encoding, &(state, src, dst, [0.0; 4], [0.0; 4]));
            assert_inside(rules.name, codes, intervals)?;
        }
    }

    #[test]
    fn a_blend_into_floats_by_floats_of_as_many_bits_or_more_is_legal(
        src in [factor(), factor(), factor(), factor()],
        dst in [factor(), factor(), factor(), factor()],
        is_short in any::<bool>(),
        more_bits in 0_i32..=13,
        direction in -1_i8..=1,
    ) {
        let (encoding, bits) = if is_short {
            (ChannelEncoding::Ufloat(6), 7)
        } else {
            (ChannelEncoding::Float16, 11)
        };
        let dst = dst.map(|v| encoding.nearest_code(f64::from(v)));
        let results = short_blend(encoding, |v| short(bits + more_bits, direction, v), src, dst);
        let codes = results.map(|v| encoding.order_below(v));
        let state = BlendState { color: SHORT_BLEND, alpha: SHORT_BLEND };
        for rules in api_rules() {
            let intervals = judged(&rules, encoding, &(state, src, dst, [0.0; 4], [0.0; 4]));
            assert_inside(rules.name, codes, intervals)?;
        }
    }

    #[test]
    fn a_plain_blend_into_8_bits_is_inside_every_judged_interval(blend in blends()) {
        let encoding = ChannelEncoding::Unorm(8);
        let codes = plain(encoding, &blend);
        for rules in all_rules() {
            let intervals = judged(&rules, encoding, &blend);
            assert_inside(rules.name, codes, intervals)?;
        }
    }

    #[test]
    fn a_plain_blend_into_floats_is_inside_every_judged_interval(
        (state, src, constant, dst, src1) in
            (state(), [value(), value(), value(), value()], [value(), value(), value(), value()],
             [value(), value(), value(), value()], [value(), value(), value(), value()])
    ) {
        let encoding = ChannelEncoding::Float32;
        let blend = (state, src, dst.map(f32::to_bits), constant, src1);
        let codes = plain(encoding, &blend);
        for rules in all_rules() {
            let intervals = judged(&rules, encoding, &blend);
            assert_inside(rules.name, codes, intervals)?;
        }
    }

    #[test]
    fn wider_rules_give_wider_blends(blend in blends()) {
        let encoding = ChannelEncoding::Unorm(8);
        for (tight, wide) in wider() {
            let (inner, outer) =
                (judged(&tight, encoding, &blend), judged(&wide, encoding, &blend));
            assert_within(inner, outer, &wide)?;
        }
    }

    #[test]
    fn a_plain_store_is_inside_every_judged_interval(
        depth in prop_oneof![0.0_f32..=1.0, value(), (0_u32..=0x3f80_0000).prop_map(f32::from_bits)]
    ) {
        for encoding in [
            ChannelEncoding::Unorm(8),
            ChannelEncoding::Unorm(16),
            ChannelEncoding::Unorm(24),
            ChannelEncoding::Float32,
        ] {
            let code = Plain::<1>.encode(encoding, [depth])[0];
            let order = encoding.order_of_code(code);
            for rules in all_rules() {
                let mut a = Judging::new(&rules);
                let v = a.constant(depth);
                let allowed = a.encode(encoding, v);
                prop_assert!(allowed.contains(order), "{} {encoding}: {order} not in {allowed:?}", rules.name);
                prop_assert!(allowed.contains(encoding.order_of_code(encoding.nearest_code(f64::from(depth)))), "{} {encoding}", rules.name);
                // Three codes around the value, and the codes by which the computed code can be off.
                let off = match encoding {
                    ChannelEncoding::Float32 => 0.0,
                    _ => rules.float_error.value() * order as f64,
                };
                let most = 3.0 + 2.0 * off;
                prop_assert!(allowed.count() as f64 <= most, "{} {encoding}: {allowed:?}", rules.name);
            }
        }
    }

    #[test]
    fn a_plain_round_trip_of_a_code_is_inside_every_judged_interval(code in 0_u32..1 << 24) {
        for bits in [8, 16, 24] {
            let encoding = ChannelEncoding::Unorm(bits);
            let code = code & ((1 << bits) - 1);
            let value = Plain::<1>.decode(encoding, [code]);
            let back = Plain::<1>.encode(encoding, value)[0];
            let seen = i64::from(value[0].to_bits());
            for rules in all_rules() {
                let mut a = Judging::new(&rules);
                let range = a.decode(encoding, CodeInterval::exact(i64::from(code)));
                prop_assert!(range.float.contains(f64::from(value[0])), "{} {bits} bits", rules.name);
                let again = a.encode(encoding, range);
                prop_assert!(again.contains(i64::from(back)), "{} {bits} bits", rules.name);
                prop_assert!(again.contains(i64::from(code)), "{} {bits} bits", rules.name);
                // The values that a shader can read from the attachment.
                let read = a.encode(ChannelEncoding::Float32, range);
                prop_assert!(read.contains(seen), "{} {bits} bits", rules.name);
            }
        }
    }

    #[test]
    fn a_plain_window_position_in_the_viewport_is_inside_every_judged_interval(
        position in [-1.0_f32..=1.0, -1.0_f32..=1.0, 0.0_f32..=1.0],
        viewport in viewport(),
    ) {
        check_window_position(position, viewport)?;
    }

    #[test]
    fn a_plain_window_position_anywhere_is_inside_every_judged_interval(
        position in [-64.0_f32..=64.0, -64.0_f32..=64.0, 0.0_f32..=1.0],
        viewport in viewport(),
    ) {
        check_window_position(position, viewport)?;
    }
}

/// An argument of a shader's function, and the width of its interval to either side.
fn argument() -> impl Strategy<Value = (f32, [f64; 2])> {
    let value = prop_oneof![
        select(vec![
            0.0_f32, 1e-40, 1e-38, 1e-30, 1.0, 2.0, 4.0, -1.0, -126.0, -149.0, -200.0, 127.5,
            128.0, 1e30
        ]),
        -20.0_f32..=20.0,
        0.0_f32..=1e-3,
        -200.0_f32..=200.0,
    ];
    let reach = || select(vec![0.0, 1e-7, 1e-3, 1.0]);
    (value, [reach(), reach()])
}

proptest! {
    #![proptest_config(config(20_000))]

    #[test]
    fn powers_roots_and_logarithms_are_inside_the_judged_intervals((value, [below, above]) in argument()) {
        let exact = f64::from(value);
        let judged = Range::same(Interval::between(exact - below, exact + above));
        for rules in all_rules() {
            let mut a = Judging::new(&rules);
            for (name, plain, range) in [
                ("exp2", Plain::<1>.exp2([value])[0], a.exp2(judged)),
                ("sqrt", Plain::<1>.sqrt([value])[0], a.sqrt(judged)),
                ("log2", Plain::<1>.log2([value])[0], a.log2(judged)),
            ] {
                let range = range.hull();
                let held = if plain.is_nan() { range.may_be_nan() } else { range.contains(f64::from(plain)) };
                prop_assert!(held, "{name} of {value} under {}: {plain} is not in {range:?}", rules.name);
            }
        }
    }

    /// Only the error that the specification permits remains.
    #[test]
    fn the_power_of_an_exact_argument_has_a_narrow_interval(value in -20.0_f32..=20.0) {
        let exact = f64::from(value);
        for rules in all_rules() {
            let power = Judging::new(&rules).exp2(Range::same(Interval::between(exact, exact))).hull();
            prop_assert!(power.high - power.low < 1e-3 * exact.exp2(), "{value}: {power:?}");
        }
    }
}
