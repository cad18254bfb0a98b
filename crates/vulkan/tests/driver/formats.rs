//! Every colour format: cleared, uploaded, fetched, drawn, blended, sample by sample.

use crate::common::{backend, check, draw, draw_if_there, image, one_draw, scene_of};
use etalon_backend::Backend;
use etalon_frame::{Aspect, ChannelEncoding, TextureFormat};
use etalon_scene::Contents;

/// What the columns of [`COLUMNS`] hold, as values.
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
const COLUMNS: &str = r#"{ "kind": "columns", "values": [ [1,0,0,0], [0,1,0,0], [0,0,1,0],
    [0,0,0,1], 0, 1, [1,0,1,0], [0,1,0,1] ] }"#;

fn colors() -> impl Iterator<Item = TextureFormat> {
    TextureFormat::ALL.into_iter().filter(|f| f.is_color())
}

/// Those that shaders of floats write and fetch.
fn floats() -> impl Iterator<Item = TextureFormat> {
    colors().filter(|f| !f.is_integer())
}

/// The codes of a texel that holds values which every format has exactly.
fn codes(format: TextureFormat, values: [f64; 4]) -> Vec<u32> {
    let channels = format.color_channels().iter().zip(values);
    channels.map(|(e, v)| e.nearest_code(v)).collect()
}

/// The sample counts in which an attachment of the format is drawn here; lavapipe has 1 and 4.
fn counts(backend: &impl Backend, format: TextureFormat) -> Vec<u32> {
    let support = backend.limits().formats.get(&format);
    let counts = support.map_or(Vec::new(), |s| s.samples.clone());
    if backend.adapter().name == "vulkan:lavapipe" {
        assert_eq!(counts, [1, 4], "{format}");
    }
    counts
}

#[test]
fn clears_store_0_and_1() {
    let backend = backend(true);
    for format in colors() {
        for values in [VALUES[0], VALUES[2], VALUES[3], VALUES[5]] {
            for samples in counts(&backend, format) {
                let scene = scene_of(
                    &format!(
                        r#""color": {{ "format": "{format}", "samples": {samples}, "clear": {values:?} }}"#
                    ),
                    "",
                    &["color"],
                );
                let frame = draw(&backend, &scene);
                check(image(&frame, "color", Aspect::Color), |_, _| {
                    codes(format, values)
                });
            }
        }
    }
}

/// Codes from the whole range of each channel, and what a shader sees of them.
#[test]
fn uploads_come_back_and_are_fetched() {
    let backend = backend(true);
    for format in floats() {
        let mut scene = scene_of(
            &format!(
                r#""seen": {{ "format": "rgba32float", "size": [16, 16] }}, "source": {{ "format": "r8unorm",
                    "texels": {{ "kind": "columns", "values": {:?} }} }}"#,
                [[0; 4]; 16]
            ),
            r#"{ "color": ["seen"], "draws": [
                { "mesh": { "kind": "full" }, "shader": "texel_color", "textures": ["source"] } ] }"#,
            &["source", "seen"],
        );
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
        let codes: Vec<u32> = pairs.map(|(e, o)| e.code_of_order(*o)).collect();
        scene.attachments[1].format = format;
        scene.attachments[1].contents = Contents::Texels(codes.clone());
        let Some(frame) = draw_if_there(&backend, &scene) else {
            continue;
        };
        assert_eq!(image(&frame, "source", Aspect::Color).codes, codes);
        let seen = image(&frame, "seen", Aspect::Color);
        for (texel, orders) in orders.chunks(channels.len()).enumerate() {
            let (x, y) = (texel as u32 % 16, texel as u32 / 16);
            let mut due = [0.0, 0.0, 0.0, 1.0];
            for ((due, e), order) in due.iter_mut().zip(channels).zip(orders) {
                *due = e.value_of_order(*order);
            }
            let seen = seen.sample(x, y, 0).iter().zip(due).enumerate();
            for (c, (seen, due)) in seen {
                let seen = f64::from(f32::from_bits(*seen));
                let near = match channels.get(c) {
                    // A texture unit may be half a code off (Direct3D allows as much), and software
                    // drivers make use of it.
                    Some(e @ ChannelEncoding::Srgb8) => {
                        let position = e.position(seen).unwrap();
                        (position - orders[c] as f64).abs() <= 0.5
                    }
                    _ => (seen - due).abs() <= 1e-5 * due.abs().max(1e-3),
                };
                assert!(near, "{format} ({x}, {y}): {seen}, and {due} is stored");
            }
        }
    }
}

/// Each channel by itself, so that none may be taken for another. Columns are squares four texels
/// wide, of which all samples of the inner texels are covered.
#[test]
fn draws_store_0_and_1() {
    let backend = backend(true);
    for format in floats() {
        for samples in counts(&backend, format) {
            let scene = scene_of(
                &format!(
                    r#""color": {{ "format": "{format}", "size": [32, 8], "samples": {samples}, "clear": [1, 0, 1, 0] }}"#
                ),
                &format!(
                    r#"{{ "color": ["color"], "draws": [ {{ "mesh": {COLUMNS}, "shader": "flat_color" }} ] }}"#
                ),
                &["color"],
            );
            let frame = draw(&backend, &scene);
            let color = image(&frame, "color", Aspect::Color);
            for (x, y) in (1..31).flat_map(|x| (1..7).map(move |y| (x, y))) {
                let on_border = |at| matches!(at % 4, 0 | 3);
                if samples > 1 && (on_border(x) || on_border(y)) {
                    continue;
                }
                let due = codes(format, VALUES[x as usize / 4]);
                for sample in 0..samples {
                    assert_eq!(
                        color.sample(x, y, sample),
                        due,
                        "{format} ({x}, {y}) {sample}"
                    );
                }
            }
        }
    }
}

/// The larger of source and destination 0 or 1, wherever blending is offered.
#[test]
fn blendable_formats_blend() {
    let backend = backend(true);
    let blendable = |f: &TextureFormat| {
        let support = backend.limits().formats.get(f);
        support.is_some_and(|s| s.blendable)
    };
    // Vulkan, Mandatory Format Support.
    for due in [
        TextureFormat::R8Unorm,
        TextureFormat::Rg8Unorm,
        TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Bgr5a1Unorm,
        TextureFormat::Rgba16Float,
    ] {
        assert!(blendable(&due), "{due}");
    }
    for format in colors().filter(blendable) {
        let both = r#"{ "operation": "add", "src_factor": "one-minus-dst", "dst_factor": "one" }"#;
        let scene = scene_of(
            &format!(r#""color": {{ "format": "{format}", "clear": [1, 0, 1, 0] }}"#),
            &format!(
                r#"{{ "color": ["color"], "draws": [ {{ "mesh": {COLUMNS}, "shader": "flat_color",
                    "blend": {{ "color": {both}, "alpha": {both} }} }} ] }}"#
            ),
            &["color"],
        );
        let frame = draw(&backend, &scene);
        check(image(&frame, "color", Aspect::Color), |x, _| {
            let [_, green, _, alpha] = VALUES[x as usize / 2];
            codes(format, [1.0, green, 1.0, alpha])
        });
    }
}

/// sRGB codes are the stored bytes: linear 0.5 is stored as 188, and 188 read as linear 0.5029.
#[test]
fn srgb_codes_are_the_stored_bytes() {
    let backend = backend(true);
    let mut scene = one_draw(r#""mesh": { "kind": "full", "value": 0.5 }, "shader": "flat_color""#);
    for samples in counts(&backend, TextureFormat::Rgba8UnormSrgb) {
        scene.attachments[0].format = TextureFormat::Rgba8UnormSrgb;
        scene.attachments[0].samples = samples;
        let frame = draw(&backend, &scene);
        let texel = image(&frame, "color", Aspect::Color).sample(3, 3, samples - 1);
        let [red, green, blue, alpha] = texel else {
            panic!("{texel:?}");
        };
        assert!([red, green, blue].iter().all(|c| (187..=188).contains(*c)));
        assert!((127..=128).contains(alpha));
    }
}
