//! Attachments of integers: cleared, uploaded, drawn, masked, resolved.

use super::Checked;
use crate::frames::{check, check_samples, color, texels};
use crate::scenes::scene_of;
use crate::subject::Subject;
use etalon_frame::{ReadPath, TextureFormat};

pub(crate) fn integers_are_cleared_and_uploaded(s: &Subject) -> Checked {
    let support = &s.limits().formats[&TextureFormat::Rgba8Uint];
    assert_eq!((support.read, support.blendable), (ReadPath::Copy, false));
    let rows: Vec<_> = (0..16).map(|y| [y, 255 - y, 7 * y, 128]).collect();
    let frame = s.draw(&scene_of(
        &format!(
            r#""cleared": {{ "format": "rgba8uint", "clear": [1, 254, 0, 255] }},
               "source": {{ "format": "rgba8uint", "texels": {{ "kind": "rows", "values": {rows:?} }} }}"#
        ),
        "",
        &["cleared", "source"],
    ))?;
    check(color(&frame, "cleared"), |_, _| [1, 254, 0, 255]);
    check(color(&frame, "source"), |_, y| rows[y as usize]);
    Ok(())
}

/// All texels, so that the clear plays no part.
pub(crate) fn integers_are_drawn_over_all(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""color": { "format": "rgba8uint", "clear": [1, 1, 1, 1] }"#,
        r#"{ "color": ["color"], "draws": [
             { "mesh": { "kind": "rect", "texels": [0, 0, 8, 16] }, "shader": "uint_color", "params": { "color": [0, 1, 1, 0] } },
             { "mesh": { "kind": "rect", "texels": [8, 0, 16, 16] }, "shader": "uint_color", "params": { "color": [1, 0, 0, 1] } },
             { "mesh": { "kind": "rect", "texels": [0, 0, 16, 1] }, "shader": "uint_color",
               "params": { "color": [3, 4, 5, 6] }, "write_mask": "ga" } ] }"#,
        &["color"],
    ))?;
    check(color(&frame, "color"), |x, y| {
        let [r, g, b, a] = if x < 8 { [0, 1, 1, 0] } else { [1, 0, 0, 1] };
        if y == 0 { [r, 4, b, 6] } else { [r, g, b, a] }
    });
    Ok(())
}

pub(crate) fn integers_are_drawn_through_the_write_mask(s: &Subject) -> Checked {
    let frame = s.draw(&scene_of(
        r#""color": { "format": "rgba8uint", "clear": [1, 128, 254, 255] }"#,
        r#"{ "color": ["color"], "draws": [
             { "mesh": { "kind": "rect", "texels": [2, 3, 9, 12] }, "shader": "uint_color",
               "params": { "color": [200, 3, 127, 0] }, "write_mask": "rba" } ] }"#,
        &["color"],
    ))?;
    check(color(&frame, "color"), |x, y| {
        let drawn = (2..9).contains(&x) && (3..12).contains(&y);
        let [r, b, a] = if drawn { [200, 127, 0] } else { [1, 254, 255] };
        [r, 128, b, a]
    });
    Ok(())
}

/// Samples differ, and the one that is taken is one of them; in Vulkan the first, which was asked for.
pub(crate) fn one_sample_of_integers_is_taken(s: &Subject) -> Checked {
    let (cleared, drawn) = ([1, 2, 3, 4], [200, 100, 50, 25]);
    for mask in [1, 2] {
        let frame = s.draw(&scene_of(
            &format!(
                r#""color": {{ "format": "rgba8uint", "samples": 4, "clear": {cleared:?} }},
                   "one": {{ "format": "rgba8uint", "clear": [7, 7, 7, 7] }}"#
            ),
            &format!(
                r#"{{ "color": ["color"], "resolve": ["one"], "draws": [
                     {{ "mesh": {{ "kind": "cover" }}, "shader": "uint_color",
                       "params": {{ "color": {drawn:?} }}, "multisample": {{ "mask": {mask} }} }} ] }}"#
            ),
            &["color", "one"],
        ))?;
        check_samples(color(&frame, "color"), |_, _, sample| {
            if mask >> sample & 1 == 1 {
                drawn
            } else {
                cleared
            }
        });
        for (x, y) in texels([16, 16]) {
            let one = color(&frame, "one").sample(x, y, 0);
            assert!(
                [cleared, drawn].contains(&one.try_into().unwrap()),
                "{one:?}"
            );
            if s.limits().api == etalon_frame::Api::Vulkan {
                assert_eq!(one, color(&frame, "color").sample(x, y, 0));
            }
        }
    }
    Ok(())
}
