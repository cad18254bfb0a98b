//! Clears, uploads, fetches, draws and blends every offered colour format.

use super::CheckEnd;
use crate::frames::{Expect, check_within_one, codes, color, texels, values};
use crate::scenes::{blend, full, scene};
use crate::subject::CheckedBackend;
use etalon_frame::{Api, ChannelEncoding, ReadPath, TextureFormat};
use etalon_scene::{AttachmentContents, Scene};
use serde_json::{Value, json};

/// The values of eight columns, which every format represents exactly.
const VALUES: [[f64; 4]; 8] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
    [0.0; 4],
    [1.0; 4],
    [1.0, 0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0, 1.0],
];

/// Returns the offered colour formats, with their sample counts as attachments.
fn colors<'a>(s: &'a CheckedBackend<'_>) -> impl Iterator<Item = (TextureFormat, &'a [u32])> {
    let formats = s.limits().formats.iter().filter(|f| f.0.is_color());
    formats.map(|(format, support)| (*format, &support.samples[..]))
}

pub(crate) fn clears_store_0_and_1(s: &CheckedBackend) -> CheckEnd {
    for (format, samples) in colors(s) {
        let channels = format.color_channels();
        // Even a format that cannot be drawn to can be cleared.
        let counts = if samples.is_empty() { &[1] } else { samples };
        for values in [0, 2, 3, 5, 6, 7].map(|column| VALUES[column]) {
            for samples in counts {
                let frame = s.show(json!({
                    "attachments": { "color": {
                        "format": format, "size": [4, 3], "samples": samples, "clear": values } },
                    "passes": [],
                }))?;
                let image = color(&frame, "color");
                assert_eq!(
                    (image.read, &image.channels[..]),
                    (ReadPath::Copy, channels)
                );
                frame.color_is("color", |_, _| codes(channels, values));
            }
        }
    }
    Ok(())
}

/// Uploads codes from the whole range of each channel and, if `seen` is true, shows them in a `rgba32float`
/// attachment. Returns the scene and the codes' orders.
fn whole_range(format: TextureFormat, seen: bool) -> (Scene, Vec<i64>) {
    let source = json!({ "format": format, "size": [16, 16] });
    let mut scene = scene(if seen {
        json!({
            "attachments": { "seen": { "format": "rgba32float" }, "source": source },
            "draws": [{ "mesh": full(), "shader": "texel_color", "textures": ["source"] }] })
    } else {
        json!({ "attachments": { "source": source }, "passes": [] })
    });
    let channels = format.color_channels();
    let mut orders = Vec::new();
    for texel in 0..256 {
        for (c, e) in channels.iter().enumerate() {
            let part = (texel + 64 * c as i64) % 256;
            let range = i128::from(e.max_order()) - i128::from(e.min_order());
            orders.push(e.min_order() + (range * i128::from(part) / 255) as i64);
        }
    }
    let pairs = channels.iter().cycle().zip(&orders);
    let codes = pairs.map(|(e, order)| e.code_of_order(*order)).collect();
    scene.attachments.last_mut().unwrap().contents = AttachmentContents::Texels(codes);
    (scene, orders)
}

pub(crate) fn uploads_come_back(s: &CheckedBackend) -> CheckEnd {
    for (format, _) in colors(s) {
        let (scene, _) = whole_range(format, false);
        let frame = s.draw(&scene)?;
        let expected = &scene.attachments[0].contents;
        let mut codes = color(&frame, "source").codes.clone();
        // OpenGL reads through floats (4.6, 18.2.8), in which both codes of -1 have the same value.
        let is_gl = matches!(s.limits().api, Api::OpenGl | Api::OpenGlEs);
        if is_gl && format.is_snorm() {
            let AttachmentContents::Texels(expected) = expected else {
                panic!("texels are uploaded")
            };
            for (code, expected) in codes.iter_mut().zip(expected) {
                if (*code, *expected) == (0x81, 0x80) {
                    *code = 0x80;
                }
            }
        }
        assert_eq!(&AttachmentContents::Texels(codes), expected, "{format}");
    }
    Ok(())
}

/// Values as in a case file, different in each channel, and the clear of another attachment.
pub(crate) fn values_are_uploaded_as_codes(s: &CheckedBackend) -> CheckEnd {
    for (format, _) in colors(s) {
        let channels = format.color_channels();
        // Float formats take values and other formats take codes, as in case files.
        let texel = |x: u32, c: usize| match channels.get(c) {
            None => (0.0, 0),
            Some(e) if e.is_float() => {
                let code = e.nearest_code(f64::from(x) * 0.5 + c as f64);
                (e.value_of_order(e.order_of_code(code)), code)
            }
            Some(e) => {
                let order = i64::from(x * (c as u32 + 3) + 1) % (e.max_order() + 1);
                (order as f64, e.code_of_order(order))
            }
        };
        let columns = (0..16).map(|x| [0, 1, 2, 3].map(|c| texel(x, c).0));
        let texels = json!({ "kind": "columns", "values": columns.collect::<Vec<_>>() });
        let frame = s.show(json!({
            "attachments": {
                "a": { "format": format, "size": [16, 4], "texels": texels },
                "b": { "format": format, "clear": VALUES[7] } },
            "passes": [],
        }))?;
        let column = |x| (0..channels.len()).map(move |c| texel(x, c).1);
        frame.color_is("a", |x, _| column(x).collect::<Vec<_>>());
        frame.color_is("b", |_, _| codes(channels, VALUES[7]));
    }
    Ok(())
}

pub(crate) fn uploads_are_fetched(s: &CheckedBackend) -> CheckEnd {
    for (format, _) in colors(s).filter(|(f, _)| !f.is_integer()) {
        let (scene, orders) = whole_range(format, true);
        let frame = s.draw(&scene)?;
        let channels = format.color_channels();
        for (texel, orders) in orders.chunks(channels.len()).enumerate() {
            let (x, y) = (texel as u32 % 16, texel as u32 / 16);
            let mut expected = [0.0, 0.0, 0.0, 1.0];
            for ((expected, e), order) in expected.iter_mut().zip(channels).zip(orders) {
                *expected = e.value_of_order(*order);
            }
            let seen = values(color(&frame, "seen"), x, y);
            for (c, (seen, expected)) in seen.into_iter().zip(expected).enumerate() {
                let near = match channels.get(c) {
                    // A texture unit may be half a code off (Direct3D allows this much), and software
                    // drivers make use of it.
                    Some(e @ ChannelEncoding::Srgb8) => {
                        let position = e.position(seen).unwrap();
                        (position - orders[c] as f64).abs() <= 0.5
                    }
                    _ => (seen - expected).abs() <= 1e-5 * expected.abs().max(1e-3),
                };
                assert!(
                    near,
                    "{format} ({x}, {y}): {seen}, and {expected} is stored"
                );
            }
        }
    }
    Ok(())
}

/// Tests each channel by itself, so that channels cannot be confused. Columns are squares four texels wide;
/// all samples of their inner texels are covered.
pub(crate) fn draws_store_0_and_1(s: &CheckedBackend) -> CheckEnd {
    for (format, counts) in colors(s).filter(|(f, _)| !f.is_integer()) {
        for samples in counts {
            let frame = s.show(json!({
                "attachments": { "color": {
                    "format": format, "size": [32, 8], "samples": samples, "clear": [1, 0, 1, 0] } },
                "draws": [{ "mesh": { "kind": "columns", "values": VALUES }, "shader": "flat_color" }],
            }))?;
            let image = color(&frame, "color");
            let on_border = |position| matches!(position % 4, 0 | 3);
            for (x, y) in texels(image.size) {
                if *samples > 1 && (on_border(x) || on_border(y)) {
                    continue;
                }
                let expected = codes(format.color_channels(), VALUES[x as usize / 4]);
                for sample in 0..*samples {
                    let came = image.sample(x, y, sample);
                    assert_eq!(came, expected, "{format} ({x}, {y}) {sample}");
                }
            }
        }
    }
    Ok(())
}

/// Uses factors that give the larger of source and destination, and sums of zeros and ones.
pub(crate) fn blendable_formats_blend(s: &CheckedBackend) -> CheckEnd {
    for (format, support) in &s.limits().formats {
        assert!(format.is_color() || !support.blendable, "{format}");
        if !support.blendable || support.samples.is_empty() {
            continue;
        }
        let drawn = |clear: [f64; 4], mesh: Value, blend: Value| {
            s.show(json!({
                "attachments": { "color": { "format": format, "clear": clear } },
                "draws": [{ "mesh": mesh, "shader": "flat_color", "blend": blend }],
            }))
        };
        let channels = format.color_channels();
        let columns = json!({ "kind": "columns", "values": VALUES });
        let larger = blend("add", "one-minus-dst", "one");
        let frame = drawn([1.0, 0.0, 1.0, 0.0], columns, larger)?;
        frame.color_is("color", |x, _| {
            let [_, green, _, alpha] = VALUES[x as usize / 2];
            codes(channels, [1.0, green, 1.0, alpha])
        });
        let green = json!({ "kind": "full", "value": [0, 1, 0, 0] });
        let frame = drawn([1.0, 0.0, 0.0, 1.0], green, blend("add", "one", "one"))?;
        frame.color_is("color", |_, _| codes(channels, [1.0, 1.0, 0.0, 1.0]));
    }
    Ok(())
}

/// sRGB codes are the stored bytes: linear 0.5 is stored as 188, whether cleared or drawn, in every sample.
pub(crate) fn srgb_codes_are_the_stored_bytes(s: &CheckedBackend) -> CheckEnd {
    let half = json!({ "kind": "rect", "texels": [0, 0, 16, 4], "value": 0.5 });
    let draws = json!([{ "mesh": half, "shader": "flat_color" }]);
    for samples in &s.support(TextureFormat::Rgba8UnormSrgb)?.samples {
        let cleared = |format: &str| json!({ "format": format, "samples": samples, "clear": [0.5, 0.5, 0.5, 0.5] });
        let frame = s.show(json!({
            "attachments": { "a": cleared("rgba8unorm-srgb"), "b": cleared("rgba8unorm") },
            "passes": [{ "color": ["a"], "draws": draws }, { "color": ["b"], "draws": draws }],
        }))?;
        for (name, expected) in [("a", [188, 188, 188, 128]), ("b", [128; 4])] {
            for y in [1, 6] {
                check_within_one(color(&frame, name).sample(3, y, samples - 1), expected);
            }
        }
        let drawn = color(&frame, "a").sample(3, 1, samples - 1);
        let is_half = drawn[..3].iter().all(|c| (187..=188).contains(c));
        assert!(is_half && (127..=128).contains(&drawn[3]), "{drawn:?}");
    }
    Ok(())
}

/// The fetch decodes sRGB, and the draw encodes it.
pub(crate) fn srgb_is_fetched_and_drawn(s: &CheckedBackend) -> CheckEnd {
    let steps = [0, 10, 50, 90, 130, 170, 210, 251].repeat(2);
    let columns: Vec<_> = steps.iter().map(|v| [*v, v + 1, v + 2, v + 3]).collect();
    let texels = json!({ "kind": "columns", "values": columns });
    let frame = s.show(json!({
        "attachments": { "a": { "format": "rgba8unorm-srgb" },
                         "t": { "format": "rgba8unorm-srgb", "texels": texels } },
        "draws": [{ "mesh": full(), "shader": "texel_color", "textures": ["t"] }],
    }))?;
    frame.color_is("t", |x, _| columns[x as usize]);
    for x in 0..16 {
        check_within_one(color(&frame, "a").sample(x, 12, 0), columns[x as usize]);
    }
    Ok(())
}
