//! Bugs of the order of channels in uploads, clears and read-back.

use crate::list::{CONFUSION, bugs};
use crate::plant::{Plant, contents, images_of, passes};
use crate::tables::CHANNELS;
use etalon_frame::TextureFormat::{self, *};
use etalon_scene::{AttachmentContents, Draw};

/// Exchanges two codes of each texel.
fn swap<T>(codes: &mut [T], texel: usize, [a, b]: [usize; 2]) {
    codes.chunks_exact_mut(texel).for_each(|t| t.swap(a, b));
}

/// Changes the initial contents of attachments of a format.
fn contents_of(
    format: TextureFormat,
    bug: impl Fn(&mut AttachmentContents) + Send + Sync + 'static,
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

/// Returns the mask with red and blue exchanged.
fn exchanged(mask: u8) -> u8 {
    (mask & 0b1010) | (mask & 1) << 2 | (mask >> 2 & 1)
}

bugs! {
    class "format", "blend";
    // The formats, and the two channels that a mistake would exchange.
    for (format, channels) in [
        (Rg8Unorm, [0, 1]), (Rgba8UnormSrgb, [0, 2]), (Bgra8Unorm, [0, 2]), (Rgba8Snorm, [0, 2]),
        (Rgb10a2Unorm, [0, 2]), (B5g6r5Unorm, [0, 2]), (Bgr5a1Unorm, [0, 2]), (Bgra4Unorm, [0, 2]),
        (Rg11b10Ufloat, [0, 1]), (Rgba16Float, [0, 2]), (Rgba32Float, [0, 2]),
        (Rgba16Unorm, [0, 2]),
    ] {
        let name = format.name();
        let [first, second] = channels.map(|c| CHANNELS[c]);
        let n = format.color_channels().len();
        let read = images_of(move |a| a.format == format, move |image| swap(&mut image.codes, n, channels));
        "{name}-read-{first}-{second}-swapped: Each read of {name} exchanges {first} and {second}." => read;
        let clear = contents_of(format, move |c| if let AttachmentContents::Color(color) = c { swap(color, 4, channels) });
        "{name}-clear-{first}-{second}-swapped: Each clear of {name} exchanges {first} and {second}." => clear;
        let upload = contents_of(format, move |c| if let AttachmentContents::Texels(codes) = c { swap(codes, n, channels) });
        if (format != Rgba32Float) {
            "{name}-upload-{first}-{second}-swapped: Each upload of {name} exchanges {first} and {second}." => upload;
        }
    }
    "bgra8unorm-srgb-read-red-blue-swapped: Each read of bgra8unorm-srgb exchanges red and blue." =>
        images_of(|a| a.format == Bgra8UnormSrgb, |image| swap(&mut image.codes, 4, [0, 2]));
    "rg16unorm-upload-red-green-swapped: Each upload of rg16unorm exchanges red and green." =>
        contents_of(Rg16Unorm, |c| if let AttachmentContents::Texels(codes) = c { swap(codes, 2, [0, 1]) });
    "rgba16unorm-read-in-8-bits: Each read of rgba16unorm loses 8 bits." =>
        images_of(|a| a.format == Rgba16Unorm, |image| image.codes.iter_mut().for_each(|c| *c = (*c >> 8) * 257));
    "rgba16uint-read-in-8-bits: Each read of rgba16uint loses the upper 8 bits." =>
        images_of(|a| a.format == Rgba16Uint, |image| image.codes.iter_mut().for_each(|c| *c &= 0xff));
    source "SwiftShader: clears of 10 bits limited to 255";
    "rgb10a2uint-cleared-in-8-bits: Clears of rgb10a2uint are limited to 255." =>
        contents_of(Rgb10a2Uint, |c| if let AttachmentContents::Color(color) = c { *color = color.map(|v| v.min(255.0)) });
    source CONFUSION;
    "bgra8unorm-constant-red-blue-swapped: The blend constant's red and blue are exchanged." =>
        bgra(|draw| draw.blend_constant.swap(0, 2));
    "bgra8unorm-write-mask-red-blue-swapped: The mask's red and blue are exchanged." =>
        bgra(|draw| draw.targets.iter_mut().for_each(|t| t.write_mask = exchanged(t.write_mask)));
}
