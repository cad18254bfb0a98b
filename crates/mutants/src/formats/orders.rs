//! Bugs of the order of channels in uploads, clears and read-back.

use crate::list::List;
use crate::plant::{Plant, contents, images_of, passes};
use etalon_frame::TextureFormat::{self, *};
use etalon_scene::{Attachment, Contents, Draw};

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
        let mut add = |what: &str, plant| {
            list.bug(format!(
                "{name}-{what}-{first}-{second}-swapped: Each {what} of {name} exchanges {first} and \
                 {second}."
            ))
            .plant(plant);
        };
        let texels = move |codes: &mut [u32]| codes.chunks_exact_mut(n).for_each(|t| t.swap(a, b));
        let has_format = move |attachment: &Attachment| attachment.format == format;
        add(
            "read",
            images_of(has_format, move |image| texels(&mut image.codes)),
        );
        let clear = move |contents: &mut Contents| {
            if let Contents::Color(color) = contents {
                color.swap(a, b);
            }
        };
        add("clear", contents_of(format, clear));
        let upload = move |contents: &mut Contents| {
            if let Contents::Texels(codes) = contents {
                texels(codes);
            }
        };
        if format != Rgba32Float {
            add("upload", contents_of(format, upload));
        }
    }
    list.bug(
        "bgra8unorm-constant-red-blue-swapped: The blend constant's red and blue are exchanged.",
    )
    .plant(bgra(|draw| draw.blend_constant.swap(0, 2)));
    list.bug("bgra8unorm-write-mask-red-blue-swapped: The mask's red and blue are exchanged.")
        .plant(bgra(|draw| {
            for target in &mut draw.targets {
                let mask = target.write_mask;
                target.write_mask = (mask & 0b1010) | (mask & 1) << 2 | (mask >> 2 & 1);
            }
        }));
}

/// Changes the first contents of attachments of a format.
fn contents_of(
    format: TextureFormat,
    bug: impl Fn(&mut Contents) + Send + Sync + 'static,
) -> Plant {
    contents(move |attachment| {
        if attachment.format == format {
            bug(&mut attachment.contents);
        }
    })
}

/// Changes draws to `bgra8unorm`.
fn bgra(bug: fn(&mut Draw)) -> Plant {
    passes(move |scene, _, pass| {
        let mut formats = pass.color.iter().map(|i| scene.attachments[*i].format);
        if formats.any(|f| f == Bgra8Unorm) {
            pass.draws.iter_mut().for_each(bug);
        }
    })
}
