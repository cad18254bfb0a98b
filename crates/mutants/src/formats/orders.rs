//! Bugs of the order of channels in uploads, clears and read-back.

use crate::list::{CONFUSION, List};
use crate::plant::{Plant, images_of, scene};
use etalon_frame::TextureFormat::{self, *};
use etalon_scene::{Contents, Draw, Scene};

/// The formats, and the two channels that a mistake would exchange.
const ORDERS: [(TextureFormat, [usize; 2]); 11] = [
    (Rg8Unorm, [0, 1]),
    (Rgba8UnormSrgb, [0, 2]),
    (Bgra8Unorm, [0, 2]),
    (Rgba8Snorm, [0, 2]),
    (Rgb10a2Unorm, [0, 2]),
    (B5g6r5Unorm, [0, 2]),
    (Bgr5a1Unorm, [0, 2]),
    (Bgra4Unorm, [0, 2]),
    (Rg11b10Ufloat, [0, 1]),
    (Rgba16Float, [0, 2]),
    (Rgba32Float, [0, 2]),
];

pub(super) fn add(list: &mut List) {
    for (format, [a, b]) in ORDERS {
        let name = format.name();
        let channels = ["red", "green", "blue", "alpha"];
        let (first, second) = (channels[a], channels[b]);
        let n = format.color_channels().len();
        let mut add = |what: &str, about: &str, plant| {
            list.add(
                &format!("{name}-{what}-{first}-{second}-swapped"),
                CONFUSION,
                format!("On {name}, {first} and {second} are exchanged {about}."),
                plant,
            );
        };
        add(
            "read",
            "in read-back",
            images_of(format, move |image| {
                image.codes.chunks_exact_mut(n).for_each(|t| t.swap(a, b));
            }),
        );
        add(
            "clear",
            "in clear values",
            contents(format, move |contents| {
                if let Contents::Color(color) = contents {
                    color.swap(a, b);
                }
            }),
        );
        if format != Rgba32Float {
            add(
                "upload",
                "in uploads",
                contents(format, move |contents| {
                    if let Contents::Texels(codes) = contents {
                        codes.chunks_exact_mut(n).for_each(|t| t.swap(a, b));
                    }
                }),
            );
        }
    }
    list.add(
        "bgra8unorm-constant-red-blue-swapped",
        CONFUSION,
        "On bgra8unorm, red and blue of the blend constant are exchanged.",
        bgra(|draw| draw.blend_constant.swap(0, 2)),
    );
    list.add(
        "bgra8unorm-write-mask-red-blue-swapped",
        CONFUSION,
        "On bgra8unorm, red and blue of the write mask are exchanged.",
        bgra(|draw| {
            for target in &mut draw.targets {
                let mask = target.write_mask;
                target.write_mask = (mask & 0b1010) | (mask & 1) << 2 | (mask >> 2 & 1);
            }
        }),
    );
}

/// Changes the first contents of attachments of a format.
fn contents(format: TextureFormat, bug: impl Fn(&mut Contents) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        let all = scene.attachments.iter_mut();
        all.filter(|a| a.format == format)
            .for_each(|a| bug(&mut a.contents));
    })
}

/// Changes draws to `bgra8unorm`.
fn bgra(bug: fn(&mut Draw)) -> Plant {
    scene(move |scene: &mut Scene| {
        for pass in &mut scene.passes {
            let mut formats = pass.color.iter().map(|i| scene.attachments[*i].format);
            if formats.any(|f| f == Bgra8Unorm) {
                pass.draws.iter_mut().for_each(bug);
            }
        }
    })
}
