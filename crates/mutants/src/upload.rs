//! Bugs of uploads.

use crate::list::{SMALL, bugs};
use crate::plant::{Plant, contents, in_bits};
use etalon_frame::ChannelEncoding::Float16;
use etalon_frame::TextureFormat::{self, Rgba8Unorm, Rgba32Float};
use etalon_scene::AttachmentContents;

/// Changes the codes of uploads, given the format and the number of codes per texel and per row.
fn texels(bug: impl Fn(&mut Vec<u32>, TextureFormat, [usize; 2]) + Send + Sync + 'static) -> Plant {
    contents(move |attachment| {
        let texel = attachment.format.color_channels().len();
        let row = texel * attachment.size[0] as usize;
        if let AttachmentContents::Texels(codes) = &mut attachment.contents {
            bug(codes, attachment.format, [texel, row]);
        }
    })
}

/// Changes every code of uploads in one format.
fn codes(struck: TextureFormat, bug: impl Fn(u32) -> u32 + Send + Sync + 'static) -> Plant {
    texels(move |codes, format, _| {
        if format == struck {
            codes.iter_mut().for_each(|c| *c = bug(*c));
        }
    })
}

/// Changes every value of uploaded 32-bit floats.
fn floats(bug: fn(f32) -> f32) -> Plant {
    codes(Rgba32Float, move |c| bug(f32::from_bits(c)).to_bits())
}

/// Rounds a value to a 16-bit float.
fn half(value: f32) -> f32 {
    let order = Float16.order_of_code(Float16.nearest_code(f64::from(value)));
    Float16.value_of_order(order) as f32
}

bugs! {
    class "upload", "blend";
    source "a wrong row pitch or origin";
    "red-blue-swapped: Red and blue of uploads are exchanged." =>
        texels(|codes, _, [n, _]| if n > 2 { codes.chunks_exact_mut(n).for_each(|t| t.swap(0, 2)) });
    "upside-down: Uploads are upside down." =>
        texels(|codes, _, [_, row]| *codes = codes.chunks_exact(row).rev().flatten().copied().collect());
    "rows-one-late: Uploads start one row late." => texels(|codes, _, [_, row]| codes.rotate_right(row));
    "texels-one-late: Uploads start one texel late." => texels(|codes, _, [texel, _]| codes.rotate_right(texel));
    "last-row-lost: The last row of uploads is 0." =>
        texels(|codes, _, [_, row]| codes.iter_mut().rev().take(row).for_each(|c| *c = 0));
    source SMALL;
    "code-plus-1: Uploaded 8-bit codes below 255 are one too large." => codes(Rgba8Unorm, |code| (code + 1).min(255));
    "lowest-bit-lost: Uploaded 8-bit codes lose their lowest bit." => codes(Rgba8Unorm, |code| code & 0xfe);
    "float-source-clamped-to-8-bits: Uploaded floats are clamped and kept in 8 bits." =>
        floats(|v| in_bits(v.clamp(0.0, 1.0), 8));
    "float-source-in-6-bits: Uploaded floats keep 6 bits." => floats(|v| in_bits(v, 6));
    "float-source-in-16-bits: Uploaded floats become 16-bit ones." => floats(half);
}
