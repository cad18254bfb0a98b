//! Clears, uploads, draws, masks and resolves attachments of integers.

use super::CheckEnd;
use crate::frames::{Expect, check_samples, color, texels};
use crate::scenes::rect;
use crate::subject::CheckedBackend;
use etalon_frame::{Api, ReadPath, TextureFormat};
use serde_json::json;

pub(crate) fn integers_are_cleared_and_uploaded(s: &CheckedBackend) -> CheckEnd {
    let support = s.support(TextureFormat::Rgba8Uint)?;
    assert_eq!((support.read, support.blendable), (ReadPath::Copy, false));
    let rows: Vec<_> = (0..16).map(|y| [y, 255 - y, 7 * y, 128]).collect();
    let frame = s.show(json!({
        "attachments": {
            "cleared": { "format": "rgba8uint", "clear": [1, 254, 0, 255] },
            "source": { "format": "rgba8uint", "texels": { "kind": "rows", "values": rows } } },
        "passes": [],
    }))?;
    frame.color_is("cleared", |_, _| [1, 254, 0, 255]);
    frame.color_is("source", |_, y| rows[y as usize]);
    Ok(())
}

/// Covers all texels, so that the clear does not matter.
pub(crate) fn integers_are_drawn_over_all(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "color": { "format": "rgba8uint", "clear": [1, 1, 1, 1] } },
        "draws": [
            { "mesh": rect([0, 0, 8, 16]), "shader": "uint_color", "params": { "color": [0, 1, 1, 0] } },
            { "mesh": rect([8, 0, 16, 16]), "shader": "uint_color", "params": { "color": [1, 0, 0, 1] } },
            { "mesh": rect([0, 0, 16, 1]), "shader": "uint_color", "params": { "color": [3, 4, 5, 6] },
              "write_mask": "ga" }],
    }))?;
    frame.color_is("color", |x, y| {
        let [r, g, b, a] = if x < 8 { [0, 1, 1, 0] } else { [1, 0, 0, 1] };
        if y == 0 { [r, 4, b, 6] } else { [r, g, b, a] }
    });
    Ok(())
}

pub(crate) fn integers_are_drawn_through_the_write_mask(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "color": { "format": "rgba8uint", "clear": [1, 128, 254, 255] } },
        "draws": [{ "mesh": rect([2, 3, 9, 12]), "shader": "uint_color",
                    "params": { "color": [200, 3, 127, 0] }, "write_mask": "rba" }],
    }))?;
    frame.color_is("color", |x, y| match (x, y) {
        (2..9, 3..12) => [200, 128, 127, 0],
        _ => [1, 128, 254, 255],
    });
    Ok(())
}

/// The samples differ, and the resolve takes one of them; in Vulkan the first one, which the mode requires.
pub(crate) fn one_sample_of_integers_is_taken(s: &CheckedBackend) -> CheckEnd {
    let (cleared, drawn) = ([1, 2, 3, 4], [200, 100, 50, 25]);
    for mask in [1, 2] {
        let frame = s.show(json!({
            "attachments": {
                "color": { "format": "rgba8uint", "samples": 4, "clear": cleared },
                "one": { "format": "rgba8uint", "clear": [7, 7, 7, 7] } },
            "passes": [{ "color": ["color"], "resolve": ["one"], "draws": [
                { "mesh": { "kind": "cover" }, "shader": "uint_color", "params": { "color": drawn },
                  "multisample": { "mask": mask } }] }],
        }))?;
        check_samples(color(&frame, "color"), |_, _, sample| {
            [cleared, drawn][mask >> sample & 1]
        });
        for (x, y) in texels([16, 16]) {
            let single = color(&frame, "one").sample(x, y, 0);
            assert!(single == cleared || single == drawn, "{single:?}");
            if s.limits().api == Api::Vulkan {
                assert_eq!(single, color(&frame, "color").sample(x, y, 0));
            }
        }
    }
    Ok(())
}
