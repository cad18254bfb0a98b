//! Several colour attachments, two sources and logic operations.

use super::CheckEnd;
use crate::frames::{Expect, RED, check, codes};
use crate::scenes::{
    blend, blue, component, filled, full, over_blue, painted, rect, uploaded, with,
};
use crate::subject::CheckedBackend;
use etalon_frame::TextureFormat;
use etalon_scene::LogicOperation;
use serde_json::{Value, json};

const ROWS: [[u32; 4]; 4] = [
    [255, 0, 255, 0],
    [0, 255, 51, 255],
    [255, 255, 0, 0],
    [0, 0, 0, 255],
];

pub(crate) fn images_of_all_targets_agree(s: &CheckedBackend) -> CheckEnd {
    let target = json!({ "format": "rgba8unorm", "size": [4, 4] });
    let frame = s.show(json!({
        "attachments": { "a": target, "b": target, "c": target, "d": target, "t": uploaded("rows", ROWS) },
        "draws": [{ "mesh": full(), "shader": "texel_color_all", "textures": ["t"] }],
        "read": ["a", "b", "c", "d"],
    }))?;
    for image in &frame.images {
        check(image, |_, y| ROWS[y as usize]);
    }
    Ok(())
}

/// The last two draws share no state; the last one writes nothing.
pub(crate) fn targets_blend_and_mask_on_their_own(s: &CheckedBackend) -> CheckEnd {
    let add = component("add", "one", "one");
    let subtract = component("reverse-subtract", "one", "one");
    let target = with(blue(), json!({ "size": [4, 4] }));
    let frame = s.show(json!({
        "attachments": { "a": target, "b": target, "c": target, "t": uploaded("rows", ROWS) },
        "draws": [
            { "mesh": full(), "shader": "texel_color_all", "textures": ["t"], "targets": [
                { "blend": { "color": add, "alpha": subtract } },
                { "write_mask": "gb" },
                { "blend": { "color": subtract, "alpha": add }, "write_mask": "rba" }] },
            { "mesh": rect([0, 3, 4, 4]), "shader": "texel_color_all", "textures": ["t"],
              "write_mask": "" }],
    }))?;
    let row = |y: u32| ROWS[y as usize];
    frame.color_is("a", |_, y| [row(y)[0], row(y)[1], 255, 255 - row(y)[3]]);
    frame.color_is("b", |_, y| [0, row(y)[1], row(y)[2], 255]);
    frame.color_is("c", |_, y| [0, 0, 255 - row(y)[2], 255]);
    Ok(())
}

/// The sums do not overflow their channels. One target is also tested with the byte order of windows.
pub(crate) fn targets_keep_apart(s: &CheckedBackend) -> CheckEnd {
    let add = component("add", "one", "one");
    let keep = component("reverse-subtract", "zero", "one");
    let stored = filled([100, 1, 2, 3]);
    for last in ["rgba8unorm", "bgra8unorm"] {
        let Ok(frame) = s.show(json!({
            "attachments": {
                "a": stored, "b": stored, "c": stored, "source": filled([50, 60, 70, 80]),
                "d": with(stored.clone(), json!({ "format": last })) },
            "draws": [{ "mesh": full(), "shader": "texel_color_all", "textures": ["source"], "targets": [
                {}, { "blend": { "color": add, "alpha": keep } },
                { "write_mask": "ga" }, { "blend": { "color": keep, "alpha": add }, "write_mask": "ra" }] }],
        })) else {
            continue;
        };
        frame.color_is("a", |_, _| [50, 60, 70, 80]);
        frame.color_is("b", |_, _| [150, 61, 72, 3]);
        frame.color_is("c", |_, _| [100, 60, 2, 80]);
        frame.color_is("d", |_, _| [100, 1, 2, 83]);
    }
    Ok(())
}

pub(crate) fn targets_of_different_formats_take_one_draw(s: &CheckedBackend) -> CheckEnd {
    let targets = [
        ("z", TextureFormat::Rgba16Float),
        ("a", TextureFormat::R8Unorm),
        ("y", TextureFormat::Rgba32Float),
        ("b", TextureFormat::Rgb10a2Unorm),
    ];
    let mut attachments = json!({ "source": filled([255, 0, 255, 255]) });
    for (name, format) in targets {
        attachments[name] = json!({ "format": format });
    }
    let frame = s.show(json!({
        "attachments": attachments,
        "passes": [{ "color": targets.map(|(name, _)| name), "draws": [
            { "mesh": full(), "shader": "texel_color_all", "textures": ["source"] }] }],
        "read": targets.map(|(name, _)| name),
    }))?;
    for (name, format) in targets {
        let expected = codes(format.color_channels(), [1.0, 0.0, 1.0, 1.0]);
        frame.color_is(name, |_, _| &expected);
    }
    Ok(())
}

/// The results for source 0x33 and destination 0x55: a truth table in each nibble.
const OPERATIONS: [(&str, u32); 16] = [
    ("clear", 0x00),
    ("and", 0x11),
    ("and-reverse", 0x22),
    ("copy", 0x33),
    ("and-inverted", 0x44),
    ("noop", 0x55),
    ("xor", 0x66),
    ("or", 0x77),
    ("nor", 0x88),
    ("equivalent", 0x99),
    ("invert", 0xaa),
    ("or-reverse", 0xbb),
    ("copy-inverted", 0xcc),
    ("or-inverted", 0xdd),
    ("nand", 0xee),
    ("set", 0xff),
];

pub(crate) fn logic_operations_follow_their_truth_tables(s: &CheckedBackend) -> CheckEnd {
    assert_eq!(OPERATIONS.len(), LogicOperation::ALL.len());
    for (name, expected) in OPERATIONS {
        for mask in ["rgba", "rba"] {
            let frame = s.show(json!({
                "attachments": { "color": filled([0x55, 0x55, 0xaa, 0x55]),
                                 "source": filled([0x33, 0x33, 0xcc, 0x33]) },
                "draws": [{ "mesh": full(), "shader": "texel_color", "textures": ["source"],
                            "logic": name, "write_mask": mask }],
            }))?;
            // For 0xcc and 0xaa, the table is in reverse bit order.
            let turned = u32::from((expected as u8).reverse_bits());
            let green = if mask == "rgba" { expected } else { 0x55 };
            frame.color_is("color", |_, _| [expected, green, turned, expected]);
        }
    }
    // The operation does not affect the next scene.
    let draw = json!({ "mesh": rect([0, 0, 4, 16]) });
    s.show(over_blue(with(draw, painted())))?
        .is_red(|x, _| x < 4);
    Ok(())
}

/// The second source, 0 or 1 in each channel, chooses between source and destination.
pub(crate) fn the_second_source_is_a_factor(s: &CheckedBackend) -> CheckEnd {
    let (stored, first) = ([101, 102, 103, 104], [11, 22, 33, 44]);
    for second in [[255, 0, 255, 255], [0, 255, 0, 0]] {
        for (factor, other) in [
            ("src1", "one-minus-src1"),
            ("src1-alpha", "one-minus-src1-alpha"),
            ("one-minus-src1", "src1"),
            ("one-minus-src1-alpha", "src1-alpha"),
        ] {
            let frame = s.show(json!({
                "attachments": { "color": filled(stored), "first": filled(first),
                                 "second": filled(second) },
                "draws": [{ "mesh": full(), "shader": "texel_dual_source",
                            "textures": ["first", "second"], "blend": blend("add", factor, other) }],
            }))?;
            frame.color_is("color", |_, _| {
                [0, 1, 2, 3].map(|c| {
                    let by = second[if factor.ends_with("alpha") { 3 } else { c }];
                    let takes_first = (by == 255) == factor.starts_with("src1");
                    if takes_first { first[c] } else { stored[c] }
                })
            });
        }
    }
    Ok(())
}

/// The second source is a factor of only the source, and then of only the destination.
pub(crate) fn the_second_source_weighs_one_side(s: &CheckedBackend) -> CheckEnd {
    let drawn = |rgb: Value, alpha: Value| {
        s.show(json!({
            "attachments": {
                "a": { "format": "rgba8unorm", "size": [4, 4], "clear": [1, 1, 0, 1] },
                "s": uploaded("rows", [[255; 4], [255; 4], [0; 4], [0; 4]]),
                "t": uploaded("rows", ROWS) },
            "draws": [{ "mesh": full(), "shader": "texel_dual_source", "textures": ["s", "t"],
                        "blend": { "color": rgb, "alpha": alpha } }],
        }))
    };
    let of_source = ["src1", "src1-alpha"].map(|f| component("add", f, "zero"));
    let of_stored = ["one-minus-src1", "one-minus-src1-alpha"].map(|f| component("add", "zero", f));
    let [rgb, alpha] = of_source;
    let frame = drawn(rgb, alpha)?;
    frame.color_is("a", |_, y| if y < 2 { ROWS[y as usize] } else { [0; 4] });
    let [rgb, alpha] = of_stored;
    let frame = drawn(rgb, alpha)?;
    frame.color_is("a", |_, y| {
        let [r, g, _, a] = ROWS[y as usize];
        [255 - r, 255 - g, 0, 255 - a]
    });
    Ok(())
}

/// Factors that use the second source do not affect later draws.
pub(crate) fn later_draws_have_one_source(s: &CheckedBackend) -> CheckEnd {
    the_second_source_weighs_one_side(s)?;
    images_of_all_targets_agree(s)?;
    let draw = json!({ "mesh": full(), "blend": blend("add", "one", "zero") });
    s.show(over_blue(with(draw, painted())))?
        .color_is("color", |_, _| RED);
    Ok(())
}
