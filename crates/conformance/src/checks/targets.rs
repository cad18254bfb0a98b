//! Several colour attachments, two sources and logic operations.

use super::Checked;
use crate::frames::{RED, check, check_red, codes, color};
use crate::scenes::{PAINT, blend, one_draw, scene_of, uploaded};
use crate::subject::Subject;
use etalon_frame::TextureFormat;
use etalon_scene::LogicOperation;

const ROWS: [[u32; 4]; 4] = [
    [255, 0, 255, 0],
    [0, 255, 51, 255],
    [255, 255, 0, 0],
    [0, 0, 0, 255],
];

pub(crate) fn images_of_all_targets_agree(s: &Subject) -> Checked {
    assert!(s.limits().max_color_attachments >= 4);
    let frame = s.draw(&scene_of(
        &format!(
            r#""a": {{ "format": "rgba8unorm", "size": [4, 4] }}, "b": {{ "format": "rgba8unorm" }},
               "c": {{ "format": "rgba8unorm" }}, "d": {{ "format": "rgba8unorm" }},
               "t": {{ "format": "rgba8unorm", "texels": {{ "kind": "rows", "values": {ROWS:?} }} }}"#
        ),
        r#"{ "color": ["a", "b", "c", "d"], "draws": [
             { "mesh": { "kind": "full" }, "shader": "texel_color_all", "textures": ["t"] } ] }"#,
        &["a", "b", "c", "d"],
    ))?;
    for image in &frame.images {
        check(image, |_, y| ROWS[y as usize]);
    }
    Ok(())
}

/// The last draw, which writes nothing, and the one before it share no state.
pub(crate) fn targets_blend_and_mask_on_their_own(s: &Subject) -> Checked {
    let add = r#"{ "operation": "add", "src_factor": "one", "dst_factor": "one" }"#;
    let subtract =
        r#"{ "operation": "reverse-subtract", "src_factor": "one", "dst_factor": "one" }"#;
    let frame = s.draw(&scene_of(
        &format!(
            r#""a": {{ "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] }},
               "b": {{ "format": "rgba8unorm", "clear": [0, 0, 1, 1] }},
               "c": {{ "format": "rgba8unorm", "clear": [0, 0, 1, 1] }},
               "t": {{ "format": "rgba8unorm", "texels": {{ "kind": "rows", "values": {ROWS:?} }} }}"#
        ),
        &format!(
            r#"{{ "color": ["a", "b", "c"], "draws": [
                {{ "mesh": {{ "kind": "full" }}, "shader": "texel_color_all", "textures": ["t"], "targets": [
                    {{ "blend": {{ "color": {add}, "alpha": {subtract} }} }},
                    {{ "write_mask": "gb" }},
                    {{ "blend": {{ "color": {subtract}, "alpha": {add} }}, "write_mask": "rba" }} ] }},
                {{ "mesh": {{ "kind": "rect", "texels": [0, 3, 4, 4] }}, "shader": "texel_color_all",
                  "textures": ["t"], "write_mask": "" }} ] }}"#
        ),
        &["a", "b", "c"],
    ))?;
    let row = |y: u32| ROWS[y as usize];
    check(color(&frame, "a"), |_, y| {
        let [r, g, _, a] = row(y);
        [r, g, 255, 255 - a]
    });
    check(color(&frame, "b"), |_, y| [0, row(y)[1], row(y)[2], 255]);
    check(color(&frame, "c"), |_, y| [0, 0, 255 - row(y)[2], 255]);
    Ok(())
}

/// Sums that keep to their channels, and one target in the order of bytes that windows use.
pub(crate) fn targets_keep_apart(s: &Subject) -> Checked {
    let add = r#"{ "operation": "add", "src_factor": "one", "dst_factor": "one" }"#;
    let keep = r#"{ "operation": "reverse-subtract", "src_factor": "zero", "dst_factor": "one" }"#;
    let stored = [100, 1, 2, 3];
    for last in ["rgba8unorm", "bgra8unorm"] {
        let scene = scene_of(
            &[
                uploaded("a", stored),
                uploaded("b", stored),
                uploaded("c", stored),
                uploaded("d", stored).replace("rgba8unorm", last),
                uploaded("source", [50, 60, 70, 80]),
            ]
            .join(","),
            &format!(
                r#"{{ "color": ["a", "b", "c", "d"], "draws": [ {{ "mesh": {{ "kind": "full" }},
                    "shader": "texel_color_all", "textures": ["source"], "targets": [
                        {{}}, {{ "blend": {{ "color": {add}, "alpha": {keep} }} }},
                        {{ "write_mask": "ga" }}, {{ "blend": {{ "color": {keep}, "alpha": {add} }}, "write_mask": "ra" }} ] }} ] }}"#
            ),
            &["a", "b", "c", "d"],
        );
        let Ok(frame) = s.draw(&scene) else {
            continue;
        };
        for (name, due) in [
            ("a", [50, 60, 70, 80]),
            ("b", [150, 61, 72, 3]),
            ("c", [100, 60, 2, 80]),
            ("d", [100, 1, 2, 83]),
        ] {
            check(color(&frame, name), |_, _| due);
        }
    }
    Ok(())
}

pub(crate) fn targets_of_different_formats_take_one_draw(s: &Subject) -> Checked {
    let formats = [
        TextureFormat::Rgba16Float,
        TextureFormat::R8Unorm,
        TextureFormat::Rgba32Float,
        TextureFormat::Rgb10a2Unorm,
    ];
    let names = ["z", "a", "y", "b"];
    let mut attachments = vec![uploaded("source", [255, 0, 255, 255])];
    for (name, format) in names.iter().zip(formats) {
        attachments.push(format!(r#""{name}": {{ "format": "{format}" }}"#));
    }
    let frame = s.draw(&scene_of(
        &attachments.join(","),
        &format!(
            r#"{{ "color": {names:?}, "draws": [ {{ "mesh": {{ "kind": "full" }},
                "shader": "texel_color_all", "textures": ["source"] }} ] }}"#
        ),
        &names,
    ))?;
    for (name, format) in names.iter().zip(formats) {
        let due = codes(format.color_channels(), [1.0, 0.0, 1.0, 1.0]);
        check(color(&frame, name), |_, _| &due);
    }
    Ok(())
}

/// Source 0x33 and destination 0x55 show the truth table of an operation in each nibble.
pub(crate) fn logic_operations_follow_their_truth_tables(s: &Subject) -> Checked {
    let table = [
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
    assert_eq!(table.len(), LogicOperation::ALL.len());
    for (name, due) in table {
        for mask in ["rgba", "rba"] {
            let frame = s.draw(&scene_of(
                &[
                    uploaded("color", [0x55, 0x55, 0xaa, 0x55]),
                    uploaded("source", [0x33, 0x33, 0xcc, 0x33]),
                ]
                .join(","),
                &format!(
                    r#"{{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "full" }}, "shader": "texel_color",
                        "textures": ["source"], "logic": "{name}", "write_mask": "{mask}" }} ] }}"#
                ),
                &["color"],
            ))?;
            // Of 0xcc and 0xaa the table stands the other way round, from the highest bit.
            let turned = u32::from((due as u8).reverse_bits());
            let green = if mask == "rgba" { due } else { 0x55 };
            check(color(&frame, "color"), |_, _| [due, green, turned, due]);
        }
    }
    // Nothing of it is left for the next scene.
    let frame = s.draw(&one_draw(&format!(
        r#""mesh": {{ "kind": "rect", "texels": [0, 0, 4, 16] }}, {PAINT}"#
    )))?;
    check_red(&frame, |x, _| x < 4);
    Ok(())
}

/// The second source, 0 or 1 in each channel, chooses between source and destination.
pub(crate) fn the_second_source_is_a_factor(s: &Subject) -> Checked {
    let (stored, first) = ([101, 102, 103, 104], [11, 22, 33, 44]);
    for second in [[255, 0, 255, 255], [0, 255, 0, 0]] {
        for factor in [
            "src1",
            "src1-alpha",
            "one-minus-src1",
            "one-minus-src1-alpha",
        ] {
            let plain = factor.strip_prefix("one-minus-");
            let other = plain.map_or(format!("one-minus-{factor}"), str::to_owned);
            let blend = blend("add", factor, &other);
            let frame = s.draw(&scene_of(
                &[
                    uploaded("color", stored),
                    uploaded("first", first),
                    uploaded("second", second),
                ]
                .join(","),
                &format!(
                    r#"{{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "full" }},
                        "shader": "texel_dual_source", "textures": ["first", "second"], {blend} }} ] }}"#
                ),
                &["color"],
            ))?;
            let due = [0, 1, 2, 3].map(|c| {
                let by = second[if factor.ends_with("alpha") { 3 } else { c }];
                let one = if (by == 255) == plain.is_none() {
                    first
                } else {
                    stored
                };
                one[c]
            });
            check(color(&frame, "color"), |_, _| due);
        }
    }
    Ok(())
}

/// As factor of the source alone and of the destination alone.
pub(crate) fn the_second_source_weighs_one_side(s: &Subject) -> Checked {
    let part = |src: &str, dst: &str| {
        format!(r#"{{ "operation": "add", "src_factor": "{src}", "dst_factor": "{dst}" }}"#)
    };
    let drawn = |rgb: String, alpha: String| {
        s.draw(&scene_of(
            &format!(
                r#""a": {{ "format": "rgba8unorm", "size": [4, 4], "clear": [1, 1, 0, 1] }},
                   "s": {{ "format": "rgba8unorm", "texels": {{ "kind": "rows", "values": [
                        [255, 255, 255, 255], [255, 255, 255, 255], [0, 0, 0, 0], [0, 0, 0, 0]] }} }},
                   "t": {{ "format": "rgba8unorm", "texels": {{ "kind": "rows", "values": {ROWS:?} }} }}"#
            ),
            &format!(
                r#"{{ "color": ["a"], "draws": [ {{ "mesh": {{ "kind": "full" }}, "shader": "texel_dual_source",
                    "textures": ["s", "t"], "blend": {{ "color": {rgb}, "alpha": {alpha} }} }} ] }}"#
            ),
            &["a"],
        ))
    };
    let frame = drawn(part("src1", "zero"), part("src1-alpha", "zero"))?;
    check(color(&frame, "a"), |_, y| {
        if y < 2 { ROWS[y as usize] } else { [0; 4] }
    });
    let frame = drawn(
        part("zero", "one-minus-src1"),
        part("zero", "one-minus-src1-alpha"),
    )?;
    check(color(&frame, "a"), |_, y| {
        let [r, g, _, a] = ROWS[y as usize];
        [255 - r, 255 - g, 0, 255 - a]
    });
    Ok(())
}

/// Factors that name the second source do not stay.
pub(crate) fn later_draws_have_one_source(s: &Subject) -> Checked {
    the_second_source_weighs_one_side(s)?;
    images_of_all_targets_agree(s)?;
    let frame = s.draw(&one_draw(&format!(
        r#""mesh": {{ "kind": "full" }}, {PAINT}, {}"#,
        blend("add", "one", "zero")
    )))?;
    check(color(&frame, "color"), |_, _| RED);
    Ok(())
}
