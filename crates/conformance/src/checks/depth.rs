//! Clears, writes, compares and stores depth.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, RED, depth, stencil, texels, values};
use crate::scenes::{blue, green, painted, rect, red, scene, test, with};
use crate::subject::{CheckedBackend, Missing};
use etalon_frame::{ChannelEncoding, Frame, ReadPath, Requirement, TextureFormat};
use etalon_scene::Scene;
use serde_json::{Value, json};

/// Returns every format with depth; all backends must offer all of them, unless their limits exempt them.
fn formats(s: &CheckedBackend) -> impl Iterator<Item = TextureFormat> {
    let limits = s.limits();
    let exempt = |format| limits.exempt.contains(&Requirement::Format(format));
    let formats = TextureFormat::ALL.iter().copied();
    let formats = formats.filter(|f| f.has_depth());
    formats.filter(move |format| {
        let offered = limits.formats.contains_key(format);
        assert!(offered || exempt(*format), "{format}");
        offered
    })
}

/// Returns an attachment of a format with depth; its stencil, if any, is cleared to 93.
fn cleared(format: TextureFormat, depth: f64) -> Value {
    if format.has_stencil() {
        json!({ "format": format, "clear": { "depth": depth, "stencil": 93 } })
    } else {
        json!({ "format": format, "clear": depth })
    }
}

/// Asserts that `depth` has the stored depths: 0 and 1 exactly, others within a step of the format.
#[track_caller]
fn check_stored(
    s: &CheckedBackend,
    format: TextureFormat,
    frame: &Frame,
    expected: impl Fn(u32) -> f64,
) {
    let (image, support) = (depth(frame, "depth"), &s.limits().formats[&format]);
    assert_eq!(image.read, support.read, "{format}");
    match image.read {
        ReadPath::Copy => assert_eq!(image.channels, support.depth, "{format}"),
        ReadPath::Shader => assert_eq!(image.channels, [ChannelEncoding::Float32]),
    }
    for (x, y) in texels(image.size) {
        let (expected, came) = (expected(x), values(image, x, y)[0]);
        let step = match support.depth[0] {
            encoding if expected == 0.0 || expected == 1.0 => {
                let code = image.sample(x, y, 0);
                let exact = code == [encoding.nearest_code(expected)];
                assert!(exact || image.channels != [encoding], "{format}: {code:?}");
                0.0
            }
            ChannelEncoding::Float32 => 0.0,
            encoding => 1.0 / encoding.max_order() as f64,
        };
        let near = (came - expected).abs() <= step;
        assert!(near, "{format}: {came} at ({x}, {y}), expected {expected}");
    }
}

pub(crate) fn depths_start_from_their_clear(s: &CheckedBackend) -> CheckEnd {
    for format in formats(s) {
        for value in [0.0, 1.0] {
            let depth = with(cleared(format, value), json!({ "size": [3, 5] }));
            let frame = s.show(json!({ "attachments": { "depth": depth }, "passes": [] }))?;
            check_stored(s, format, &frame, |_| value);
        }
    }
    Ok(())
}

/// The stored depth, the comparison, whether the draw writes, the depths of four columns, and which columns
/// pass.
type DepthComparison = (f64, &'static str, bool, [f64; 4], [bool; 4]);

/// Columns that are compared with a quarter and with one.
const FOURTHS: [[f64; 4]; 2] = [[0.0, 0.25, 1.0, 1.0], [0.0, 1.0, 0.25, 0.5]];
const COMPARISONS: [DepthComparison; 7] = [
    (0.25, "less", true, FOURTHS[0], [true, false, false, false]),
    (0.25, "equal", true, FOURTHS[0], [false, true, false, false]),
    (
        0.25,
        "greater",
        true,
        FOURTHS[0],
        [false, false, true, true],
    ),
    (0.25, "always", true, FOURTHS[0], [true; 4]),
    (1.0, "always", true, FOURTHS[1], [true; 4]),
    (1.0, "less", true, FOURTHS[1], [true, false, true, true]),
    (
        1.0,
        "greater-equal",
        false,
        FOURTHS[1],
        [false, true, false, false],
    ),
];

/// First draws a depth that differs from the clear value. The last draw does not write depth, so it changes
/// nothing.
pub(crate) fn depths_are_compared_with_the_stored_one(s: &CheckedBackend) -> CheckEnd {
    for format in formats(s) {
        for (stored, compare, write, columns, passes) in COMPARISONS {
            let mut draws = vec![
                json!({ "mesh": { "kind": "columns", "values": columns }, "shader": "flat_color_depth",
                        "params": red(), "depth": test(compare, write) }),
                json!({ "mesh": { "kind": "rect", "texels": [0, 12, 16, 16], "value": 0.5 },
                        "shader": "flat_color_depth", "depth": test("always", false), "write_mask": "" }),
            ];
            if stored != 1.0 {
                let mesh = json!({ "kind": "full", "value": stored });
                draws.insert(
                    0,
                    json!({ "mesh": mesh, "shader": "flat_color_depth",
                    "params": { "color": [0, 0, 1, 1] }, "depth": test("always", true) }),
                );
            }
            let frame = s.show(json!({
                "attachments": { "color": blue(), "depth": cleared(format, 1.0) },
                "draws": draws,
                "read": ["depth", "color"],
            }))?;
            let passes = |x: u32| passes[x as usize / 4];
            frame.is_red(|x, _| passes(x));
            check_stored(s, format, &frame, |x| {
                if write && passes(x) {
                    columns[x as usize / 4]
                } else {
                    stored
                }
            });
            if format.has_stencil() {
                let image = stencil(&frame, "depth");
                assert_eq!(image.read, ReadPath::Copy);
                assert_eq!(image.channels, [ChannelEncoding::Uint(8)]);
                frame.stencil_is("depth", |_, _| 93);
            }
        }
    }
    Ok(())
}

/// Only clears and draws, with depths that no normalized format can represent.
pub(crate) fn floats_keep_any_depth(s: &CheckedBackend) -> CheckEnd {
    let written = [0.1_f32, 0.333_333_3, 1e-7, 0.999_999_9, 0.7];
    let frame = s.show(json!({
        "attachments": { "d": { "format": "depth32float", "size": [10, 4], "clear": 0.3 } },
        "draws": [{ "mesh": { "kind": "columns", "values": written }, "scissor": [0, 0, 10, 2],
                    "shader": "flat_color_depth", "depth": test("always", true) }],
    }))?;
    frame.depth_is("d", |x, y| {
        f64::from(if y < 2 { written[x as usize / 2] } else { 0.3 })
    });
    Ok(())
}

pub(crate) fn a_draw_without_a_depth_test_neither_tests_nor_writes(s: &CheckedBackend) -> CheckEnd {
    let draws = json!([{ "mesh": { "kind": "full", "value": 1 }, "shader": "flat_color_depth",
                         "params": red() }]);
    let frame = s.show(json!({
        "attachments": {
            "alone": { "format": "rgba8unorm" }, "color": { "format": "rgba8unorm" },
            "depth": { "format": "depth32float", "clear": 0 } },
        "passes": [{ "color": ["color"], "depth_stencil": "depth", "draws": draws },
                   { "color": ["alone"], "draws": draws }],
    }))?;
    frame.color_is("color", |_, _| RED);
    frame.color_is("alone", |_, _| RED);
    frame.depth_is("depth", |_, _| 0.0);
    Ok(())
}

pub(crate) fn depth_and_stencil_may_be_read_only(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": {
            "color": blue(),
            "ds": { "format": "depth32float-stencil8", "clear": { "depth": 0.5, "stencil": 7 } } },
        "passes": [{ "color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true, "draws": [{
            "mesh": { "kind": "columns", "values": [0, 0], "z": [0.25, 0.75] }, "shader": "uniform_color",
            "params": red(), "depth": test("less", false),
            "stencil": { "reference": 7, "front": { "compare": "equal" } } }] }],
    }))?;
    frame.is_red(|x, _| x < 8);
    assert_eq!(depth(&frame, "ds").channels, [ChannelEncoding::Float32]);
    frame.depth_is("ds", |_, _| 0.5);
    frame.stencil_is("ds", |_, _| 7);
    Ok(())
}

/// Writes, tests without writing, and writes again.
pub(crate) fn passes_that_write_take_turns_with_passes_that_do_not(s: &CheckedBackend) -> CheckEnd {
    for format in [
        TextureFormat::Depth32FloatStencil8,
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth16Unorm,
        TextureFormat::Stencil8,
    ] {
        let drawn = |mesh: Value, depth: Value, stencil: Value| {
            let mut draw = json!({ "mesh": mesh, "shader": "flat_color_depth", "params": red() });
            if format.has_depth() {
                draw["depth"] = depth;
            }
            if format.has_stencil() {
                draw["stencil"] = stencil;
            }
            draw
        };
        let write = |mesh: Value| {
            let stencil = json!({ "front": { "compare": "always", "pass_op": "increment-clamp" } });
            json!({ "depth_stencil": "ds", "draws": [drawn(mesh, test("always", true), stencil)] })
        };
        let read_only = |draw: Value| {
            json!({ "color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true,
                    "draws": [draw] })
        };
        let ones = json!({ "front": { "compare": "equal", "pass_op": "zero" }, "reference": 1,
                           "write_mask": 0 });
        let far = json!({ "kind": "full", "value": 1 });
        let corner =
            json!({ "mesh": rect([0, 8, 4, 16]), "shader": "uniform_color", "params": green() });
        let frame = s.show(json!({
            "attachments": { "color": blue(), "ds": { "format": format } },
            "passes": [
                write(json!({ "kind": "columns", "values": [0, 1] })),
                read_only(drawn(far, test("equal", false), ones)),
                write(rect([0, 0, 16, 8])),
                read_only(corner)],
        }))?;
        frame.color_is("color", |x, y| match (x, y) {
            (0..4, 8..) => GREEN,
            (8.., _) => RED,
            _ if !format.has_depth() => RED,
            _ => BLUE,
        });
        if format.has_stencil() {
            frame.stencil_is("ds", |_, y| if y < 8 { 2 } else { 1 });
        }
        if format.has_depth() {
            frame.depth_is("ds", |x, y| if x >= 8 && y >= 8 { 1.0 } else { 0.0 });
        }
    }
    Ok(())
}

/// Returns a scene that stores two columns of vertex depths in `depth32float`, cleared to 1/2, if they
/// pass.
fn columns(z: [f64; 2], state: Value) -> Scene {
    let draw = json!({ "mesh": { "kind": "columns", "values": [0, 0], "z": z },
                       "shader": "uniform_color", "params": red(), "depth": test("always", true) });
    scene(json!({
        "attachments": { "color": blue(), "depth": { "format": "depth32float", "clear": 0.5 } },
        "draws": [with(draw, state)],
    }))
}

/// Draws columns, and returns the depths of both.
fn depths(s: &CheckedBackend, z: [f64; 2], state: Value) -> Result<[f64; 2], Missing> {
    let frame = s.draw(&columns(z, state))?;
    let columns = [2, 12].map(|x| values(depth(&frame, "depth"), x, 9)[0]);
    frame.depth_is("depth", |x, _| columns[x as usize / 8]);
    Ok(columns)
}

/// Draws columns, and asserts that they are red and have these depths.
fn stores(s: &CheckedBackend, z: [f64; 2], state: Value, expected: [f64; 2]) -> CheckEnd {
    let frame = s.draw(&columns(z, state))?;
    frame.is_red(|_, _| true);
    frame.depth_is("depth", |x, _| expected[x as usize / 8]);
    Ok(())
}

fn range(depth: [f64; 2]) -> Value {
    json!({ "viewport": { "rect": [0, 0, 16, 16], "depth": depth } })
}

fn clamped(range_of: [f64; 2]) -> Value {
    with(range(range_of), json!({ "depth_clamp": true }))
}

pub(crate) fn a_viewport_moves_depths_into_its_range(s: &CheckedBackend) -> CheckEnd {
    stores(s, [0.0, 1.0], json!({}), [0.0, 1.0])?;
    stores(s, [0.0, 1.0], range([0.0, 1.0]), [0.0, 1.0])?;
    stores(s, [0.0, 1.0], range([0.25, 0.75]), [0.25, 0.75])
}

pub(crate) fn a_range_of_depths_may_be_reversed(s: &CheckedBackend) -> CheckEnd {
    stores(s, [0.0, 1.0], range([1.0, 0.0]), [1.0, 0.0])?;
    stores(s, [0.0, 1.0], range([0.75, 0.5]), [0.75, 0.5])
}

/// Depths on both sides of every range.
const OUTSIDE: [[f64; 2]; 2] = [[-1.0, 2.0], [-0.5, 1.5]];

pub(crate) fn depths_outside_are_clipped(s: &CheckedBackend) -> CheckEnd {
    for z in OUTSIDE {
        for state in [json!({}), range([0.25, 0.75])] {
            let frame = s.draw(&columns(z, state))?;
            frame.is_red(|_, _| false);
            frame.depth_is("depth", |_, _| 0.5);
        }
    }
    Ok(())
}

pub(crate) fn depths_outside_are_clamped(s: &CheckedBackend) -> CheckEnd {
    for z in OUTSIDE {
        for expected in [[0.0, 1.0], [0.25, 0.75]] {
            stores(s, z, clamped(expected), expected)?;
        }
    }
    Ok(())
}

pub(crate) fn depths_are_clamped_to_a_reversed_range(s: &CheckedBackend) -> CheckEnd {
    stores(s, [-0.5, 1.5], clamped([0.75, 0.25]), [0.75, 0.25])
}

/// In 32-bit floats, the smallest step follows the exponent of the largest depth: 2^-24 from 0.5 to 1, and
/// up to twice that (OpenGL 4.6, 14.6.5).
pub(crate) fn a_constant_bias_counts_least_steps(s: &CheckedBackend) -> CheckEnd {
    let biased = |bias: Value| depths(s, [0.5, 0.75], json!({ "depth_bias": bias }));
    let bias = |constant: i32| biased(json!({ "constant": constant }));
    let plain = biased(json!({}))?;
    assert_eq!(plain, [0.5, 0.75]);
    assert_eq!(bias(0)?, plain);
    let steps = |from: f64, to: f64| (to - from) * 2_f64.powi(24);
    for (count, least, most) in [(1024, 1024.0, 2048.0), (64, 32.0, 160.0)] {
        let (raised, lowered) = (bias(count)?, bias(-count)?);
        for column in 0..2 {
            let steps = steps(plain[column], raised[column]);
            assert!((least..=most).contains(&steps), "{steps} of {count}");
        }
        // Around 0.75 the exponent is the same on both sides.
        let steps = steps(lowered[1], plain[1]);
        assert!((least..=most).contains(&steps), "{steps} of -{count}");
    }
    Ok(())
}

pub(crate) fn a_bias_is_held_to_its_clamp(s: &CheckedBackend) -> CheckEnd {
    for (constant, clamp) in [
        (16_777_216, 0.125),
        (4_000_000, 0.0625),
        (-4_000_000, -0.0625),
    ] {
        let bias = json!({ "depth_bias": { "constant": constant, "clamp": clamp } });
        stores(s, [0.5, 0.25], bias, [0.5 + clamp, 0.25 + clamp])?;
    }
    Ok(())
}

/// Depth grows by 1/16 per texel to the right, so a slope factor of 2 adds 1/8.
pub(crate) fn a_slope_bias_counts_the_slope(s: &CheckedBackend) -> CheckEnd {
    let at_4 = |slope: u32| -> Result<f64, Missing> {
        let positions = [[-1, 1, 0], [-1, -1, 0], [1, 1, 1], [1, -1, 1]];
        let frame = s.show(json!({
            "attachments": { "depth": { "format": "depth32float", "clear": 0 } },
            "draws": [{
                "mesh": { "kind": "vertices", "positions": positions }, "topology": "triangle-strip",
                "shader": "uniform_color", "depth": test("always", true),
                "depth_bias": { "slope": slope } }],
        }))?;
        Ok(values(depth(&frame, "depth"), 4, 7)[0])
    };
    let (plain, biased) = (at_4(0)?, at_4(2)?);
    assert!((plain - 4.5 / 16.0).abs() < 1e-5, "{plain}");
    assert!((biased - plain - 0.125).abs() < 1e-5, "{biased}");
    Ok(())
}

/// The fragment's own depth is not tested against the bounds.
pub(crate) fn bounds_reject_by_the_stored_depth(s: &CheckedBackend) -> CheckEnd {
    for (bounds, expected) in [([0.5, 0.75], [0.0, 1.0]), ([0.625, 1.0], [0.5, 0.5])] {
        let came = depths(s, [0.0, 1.0], json!({ "depth_bounds": bounds }))?;
        assert_eq!(came, expected, "{bounds:?}");
    }
    let stored = json!({ "kind": "columns", "values": [0, 0.25, 0.5, 0.75] });
    let frame = s.show(json!({
        "attachments": { "color": blue(), "depth": { "format": "depth32float" } },
        "draws": [
            { "mesh": stored, "shader": "flat_color_depth", "params": { "color": [0, 0, 1, 1] },
              "depth": test("always", true) },
            with(painted(), json!({ "mesh": { "kind": "full" }, "depth_bounds": [0.25, 0.5] }))],
    }))?;
    frame.is_red(|x, _| (4..12).contains(&x));
    Ok(())
}
