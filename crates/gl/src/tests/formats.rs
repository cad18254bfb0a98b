//! Every colour format that is offered: clears, uploads, drawn zeros and ones.
#![expect(clippy::unwrap_used, reason = "these are tests")]

use super::help::{draw, each};
use crate::GlBackend;
use etalon_backend::Backend;
use etalon_frame::{ChannelEncoding, ReadPath, TextureFormat};

pub(super) fn all(backend: &GlBackend) {
    the_common_formats_are_offered(backend);
    for (format, support) in &backend.limits().formats {
        if format.is_color() && !support.samples.is_empty() {
            codes_survive(backend, *format);
            zeros_and_ones_are_drawn(backend, *format);
            if support.blendable {
                ones_are_added(backend, *format);
            }
        }
    }
    srgb_is_encoded(backend);
    integers_are_cleared_drawn_and_masked(backend);
}

fn integers_are_cleared_drawn_and_masked(backend: &GlBackend) {
    let support = &backend.limits().formats[&TextureFormat::Rgba8Uint];
    assert_eq!((support.read, support.blendable), (ReadPath::Copy, false));
    let frame = draw(
        backend,
        r#"{"attachments": {"a": {"format":"rgba8uint","size":[16,16],"clear":[1,128,254,255]}},
        "passes": [{"color":["a"],"draws":[
            {"mesh":{"kind":"rect","texels":[0,0,5,3]},"shader":"uint_color",
             "params":{"color":[200,3,127,0]},"write_mask":"rba"}]}],
        "read": ["a"]}"#,
    );
    each(&frame.images[0], |x, y| {
        let drawn = x < 5 && y < 3;
        let [r, b, a] = if drawn { [200, 127, 0] } else { [1, 254, 255] };
        vec![r, 128, b, a]
    });
}

fn the_common_formats_are_offered(backend: &GlBackend) {
    let formats = &backend.limits().formats;
    for format in TextureFormat::ALL {
        let told = match formats.get(&format) {
            Some(support) => format!("{support:?}"),
            None => "not offered".to_owned(),
        };
        println!("{format}: {told}");
    }
    assert!(!formats.contains_key(&TextureFormat::Bgra8Unorm));
    for format in [
        TextureFormat::R8Unorm,
        TextureFormat::Rg8Unorm,
        TextureFormat::Rgba8Unorm,
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Rgb10a2Unorm,
        TextureFormat::Rg11b10Ufloat,
        TextureFormat::Rgba16Float,
        TextureFormat::Rgba32Float,
    ] {
        let support = &formats[&format];
        assert!(
            support.samples.contains(&1) && support.blendable,
            "{format}"
        );
        assert_eq!(support.read, ReadPath::Copy);
    }
}

fn one(encoding: ChannelEncoding) -> u32 {
    encoding.nearest_code(1.0)
}

/// Uploaded codes come back, and a clear has the value that the shader's twin would have.
fn codes_survive(backend: &GlBackend, format: TextureFormat) {
    let channels = format.color_channels();
    let code = |x: u32, c: usize| match channels[c] {
        e if e.is_float() => e.nearest_code(f64::from(x) * 0.5 + c as f64),
        e => e.code_of_order(i64::from(x * (c as u32 + 3) + 1) % (e.max_order() + 1)),
    };
    let value = |x: u32, c: usize| match channels.get(c) {
        Some(e) if e.is_float() => e.value_of_order(e.order_of_code(code(x, c))),
        Some(e) => e.order_of_code(code(x, c)) as f64,
        None => 0.0,
    };
    let values: Vec<[f64; 4]> = (0..16).map(|x| [0, 1, 2, 3].map(|c| value(x, c))).collect();
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{
                "a": {{"format":"{format}","size":[16,16],"texels":{{"kind":"columns","values":{values:?}}}}},
                "b": {{"format":"{format}","clear":[0,1,0,1]}}}},
            "passes": [], "read": ["a","b"]}}"#
        ),
    );
    each(&frame.images[0], |x, _| {
        (0..channels.len()).map(|c| code(x, c)).collect()
    });
    let cleared = [false, true, false, true].into_iter().zip(channels);
    let cleared: Vec<u32> = cleared
        .map(|(on, e)| if on { one(*e) } else { 0 })
        .collect();
    each(&frame.images[1], |_, _| cleared.clone());
}

fn zeros_and_ones_are_drawn(backend: &GlBackend, format: TextureFormat) {
    let draws = if format.is_integer() {
        r#"{"mesh":{"kind":"rect","texels":[0,0,8,16]},"shader":"uint_color","params":{"color":[0,1,1,0]}},
           {"mesh":{"kind":"rect","texels":[8,0,16,16]},"shader":"uint_color","params":{"color":[1,0,0,1]}}"#
    } else {
        r#"{"mesh":{"kind":"columns","values":[[0,1,1,0],[1,0,0,1]]},"shader":"flat_color"}"#
    };
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{"a": {{"format":"{format}","size":[16,16],"clear":[1,1,1,1]}}}},
            "passes": [{{"color":["a"],"draws":[{draws}]}}],
            "read": ["a"]}}"#
        ),
    );
    let on = [[false, true, true, false], [true, false, false, true]];
    let channels = format.color_channels();
    each(&frame.images[0], |x, _| {
        let on = on[x as usize / 8].into_iter().zip(channels);
        on.map(|(on, e)| if on { one(*e) } else { 0 }).collect()
    });
}

fn ones_are_added(backend: &GlBackend, format: TextureFormat) {
    let add = r#"{"operation":"add","src_factor":"one","dst_factor":"one"}"#;
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{"a": {{"format":"{format}","size":[16,16],"clear":[1,0,0,1]}}}},
            "passes": [{{"color":["a"],"draws":[
                {{"mesh":{{"kind":"full","value":[0,1,0,0]}},"shader":"flat_color",
                  "blend":{{"color":{add},"alpha":{add}}}}}]}}],
            "read": ["a"]}}"#
        ),
    );
    let channels = format.color_channels();
    let due: Vec<u32> = [true, true, false, true]
        .into_iter()
        .zip(channels)
        .map(|(on, e)| if on { one(*e) } else { 0 })
        .collect();
    each(&frame.images[0], |_, _| due.clone());
}

/// Linear one half is code 188 of sRGB, one in three neighbours at most.
fn srgb_is_encoded(backend: &GlBackend) {
    let frame = draw(
        backend,
        r#"{"attachments": {
            "a": {"format":"rgba8unorm-srgb","size":[16,16],"clear":[0.5,0.5,0.5,0.5]},
            "b": {"format":"rgba8unorm","clear":[0.5,0.5,0.5,0.5]},
            "t": {"format":"rgba8unorm-srgb","texels":{"kind":"columns","values":[
                [0,1,2,3],[10,20,30,40],[50,60,70,80],[90,100,110,120],[130,140,150,160],
                [170,180,190,200],[210,220,230,240],[251,252,253,254],
                [0,1,2,3],[10,20,30,40],[50,60,70,80],[90,100,110,120],[130,140,150,160],
                [170,180,190,200],[210,220,230,240],[251,252,253,254]]}}},
        "passes": [
            {"color":["a"],"draws":[
                {"mesh":{"kind":"rect","texels":[0,0,16,4]},"shader":"uniform_color",
                 "params":{"color":[0.5,0.5,0.5,0.5]}},
                {"mesh":{"kind":"rect","texels":[0,8,16,16]},"shader":"texel_color","textures":["t"]}]},
            {"color":["b"],"draws":[
                {"mesh":{"kind":"rect","texels":[0,0,16,4]},"shader":"uniform_color",
                 "params":{"color":[0.5,0.5,0.5,0.5]}}]}],
        "read": ["a","b","t"]}"#,
    );
    let near = |image: usize, y: u32, due: [u32; 4]| {
        let sample = frame.images[image].sample(3, y, 0);
        let close = sample.iter().zip(due).all(|(a, d)| a.abs_diff(d) <= 1);
        assert!(close, "{sample:?}, due {due:?}");
    };
    for y in [0, 6] {
        near(0, y, [188, 188, 188, 128]);
        near(1, y, [128; 4]);
    }
    for x in 0..16 {
        let due = frame.images[2].sample(x, 12, 0);
        let drawn = frame.images[0].sample(x, 12, 0);
        let close = drawn.iter().zip(due).all(|(a, d)| a.abs_diff(*d) <= 1);
        assert!(close, "{drawn:?}, due {due:?}");
    }
    let texel: [u32; 4] = frame.images[2].sample(1, 0, 0).try_into().unwrap();
    assert_eq!(texel, [10, 20, 30, 40]);
}
