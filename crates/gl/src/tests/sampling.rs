//! Textures that are sampled.

use super::help::{draw, each};
use crate::GlBackend;
use etalon_scene::AddressMode;

pub(super) fn all(backend: &GlBackend) {
    the_nearest_texel_is_taken(backend);
    neighbours_are_averaged(backend);
    fetches_need_no_sampler(backend);
}

const TEXELS: &str = r#"{"kind":"grid","values":[
    [[1,0,0,255],[2,0,0,255],[3,0,0,255],[4,0,0,255]],
    [[11,0,0,255],[12,0,0,255],[13,0,0,255],[14,0,0,255]]]}"#;

/// Row 0 of a texture, the first that is uploaded, lies at coordinate 0.
fn the_nearest_texel_is_taken(backend: &GlBackend) {
    // Three times the texture in either direction.
    for across in AddressMode::ALL {
        for down in AddressMode::ALL {
            let frame = draw(
                backend,
                &format!(
                    r#"{{"attachments": {{
                        "a": {{"format":"rgba8unorm","size":[24,12],"clear":[0,0,1,1]}},
                        "t": {{"format":"rgba8unorm","size":[4,2],"texels":{TEXELS}}}}},
                    "passes": [{{"color":["a"],"draws":[
                        {{"mesh":{{"kind":"cover","uv":[-1,-1,2,2]}},"shader":"sampled_color",
                          "textures":["t"],"sampler":{{"filter":"nearest",
                              "address":["{}","{}"]}}}}]}}],
                    "read": ["a"]}}"#,
                    across.name(),
                    down.name()
                ),
            );
            each(&frame.images[0], |x, y| {
                let texel = |at: u32, count: i32, mode: &AddressMode| {
                    let at = at as i32 / 2 - count;
                    match mode {
                        AddressMode::ClampToEdge => at.clamp(0, count - 1),
                        AddressMode::Repeat => at.rem_euclid(count),
                        AddressMode::MirrorRepeat => match at.rem_euclid(2 * count) {
                            far if far >= count => 2 * count - 1 - far,
                            near => near,
                        },
                    }
                };
                let red = 1 + texel(x, 4, across) + 10 * texel(y, 2, down);
                vec![red as u32, 0, 0, 255]
            });
        }
    }
}

fn neighbours_are_averaged(backend: &GlBackend) {
    let frame = draw(
        backend,
        r#"{"attachments": {
            "a": {"format":"rgba32float","size":[8,8]},
            "t": {"format":"rgba16float","size":[2,2],"texels":{"kind":"grid","values":[
                [[0,0,0,1],[1,0,0,1]],[[0,1,0,1],[1,1,0,1]]]}}},
        "passes": [{"color":["a"],"draws":[
            {"mesh":{"kind":"cover","uv":[0,0,1,1]},"shader":"sampled_color","textures":["t"],
             "sampler":{"filter":"linear","address":["clamp-to-edge","repeat"]}}]}],
        "read": ["a"]}"#,
    );
    let image = &frame.images[0];
    for (x, y) in (0..8).flat_map(|x| (0..8).map(move |y| (x, y))) {
        let position = |at: u32| (f64::from(at) + 0.5) / 4.0 - 0.5;
        let red = position(x).clamp(0.0, 1.0);
        // Beyond the ends lie the texels of the other end.
        let green = position(y).abs().min(2.0 - position(y));
        let seen = image.sample(x, y, 0);
        for (code, due) in seen.iter().zip([red, green, 0.0, 1.0]) {
            let value = f64::from(f32::from_bits(*code));
            // Weights may have no more than 8 bits.
            assert!(
                (value - due).abs() <= 1.0 / 256.0,
                "{value} for {due} at {x} {y}"
            );
        }
    }
}

/// A sampler that an earlier draw used has no say in fetches.
fn fetches_need_no_sampler(backend: &GlBackend) {
    let frame = draw(
        backend,
        &format!(
            r#"{{"attachments": {{
                "a": {{"format":"rgba8unorm","size":[4,2],"clear":[0,0,1,1]}},
                "t": {{"format":"rgba8unorm","texels":{TEXELS}}},
                "f": {{"format":"rgba32float","texels":{{"kind":"columns","values":[
                    [0,1,0,1],[1,0,0,1],[0,0,1,1],[1,1,1,1]]}}}}}},
            "passes": [{{"color":["a"],"draws":[
                {{"mesh":{{"kind":"cover","uv":[0,0,1,1]}},"shader":"sampled_color","textures":["t"],
                  "sampler":{{"filter":"linear","address":["repeat","repeat"]}}}},
                {{"mesh":{{"kind":"rect","texels":[0,0,4,1]}},"shader":"texel_color",
                  "textures":["f"]}}]}}],
            "read": ["a","t","f"]}}"#
        ),
    );
    let fetched = [
        [0, 255, 0, 255],
        [255, 0, 0, 255],
        [0, 0, 255, 255],
        [255; 4],
    ];
    each(&frame.images[0], |x, y| match y {
        0 => fetched[x as usize].to_vec(),
        // The middle of a texel is that texel.
        _ => vec![11 + x, 0, 0, 255],
    });
    each(&frame.images[1], |x, y| vec![1 + x + 10 * y, 0, 0, 255]);
}
