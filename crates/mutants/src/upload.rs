//! Bugs of uploads.

use crate::list::{List, SMALL};
use crate::plant::{Plant, contents, in_bits};
use etalon_frame::{ChannelEncoding, TextureFormat};
use etalon_scene::Contents;

/// Changes the codes of uploads, given the attachment and the numbers of codes per texel and row.
fn texels(bug: impl Fn(&mut Vec<u32>, TextureFormat, [usize; 2]) + Send + Sync + 'static) -> Plant {
    contents(move |attachment| {
        let texel = attachment.format.color_channels().len();
        let row = texel * attachment.size[0] as usize;
        if let Contents::Texels(codes) = &mut attachment.contents {
            bug(codes, attachment.format, [texel, row]);
        }
    })
}

/// Changes every code of uploads of one format.
fn codes(format: TextureFormat, bug: fn(u32) -> u32) -> Plant {
    texels(move |codes, encoding, _| {
        if encoding == format {
            codes.iter_mut().for_each(|c| *c = bug(*c));
        }
    })
}

/// Changes every value of uploaded floats.
fn floats(list: &mut List, text: &str, bug: fn(f32) -> f32) {
    let values = texels(move |codes, format, _| {
        if format == TextureFormat::Rgba32Float {
            codes
                .iter_mut()
                .for_each(|c| *c = bug(f32::from_bits(*c)).to_bits());
        }
    });
    list.bug(text).plant(values);
}

/// A value rounded to a 16-bit float.
fn half(value: f32) -> f32 {
    let encoding = ChannelEncoding::Float16;
    let order = encoding.order_of_code(encoding.nearest_code(f64::from(value)));
    encoding.value_of_order(order) as f32
}

pub(super) fn add(list: &mut List) {
    list.class("upload", "blend");
    list.source("a wrong row pitch or origin");
    list.bug("red-blue-swapped: Red and blue of uploads are exchanged.")
        .plant(texels(|codes, _, [texel, _]| {
            if texel > 2 {
                codes.chunks_exact_mut(texel).for_each(|t| t.swap(0, 2));
            }
        }));
    list.bug("upside-down: Uploads are upside down.")
        .plant(texels(|codes, _, [_, row]| {
            *codes = codes.chunks_exact(row).rev().flatten().copied().collect();
        }));
    list.bug("rows-one-late: Uploads start one row late.")
        .plant(texels(|codes, _, [_, row]| codes.rotate_right(row)));
    list.bug("texels-one-late: Uploads start one texel late.")
        .plant(texels(|codes, _, [texel, _]| codes.rotate_right(texel)));
    list.bug("last-row-lost: The last row of uploads is 0.")
        .plant(texels(|codes, _, [_, row]| {
            codes.iter_mut().rev().take(row).for_each(|c| *c = 0)
        }));
    list.source(SMALL);
    list.bug("code-plus-1: Uploaded 8-bit codes below 255 are one too large.")
        .plant(codes(TextureFormat::Rgba8Unorm, |code| (code + 1).min(255)));
    list.bug("lowest-bit-lost: Uploaded 8-bit codes lose their lowest bit.")
        .plant(codes(TextureFormat::Rgba8Unorm, |code| code & 0xfe));
    floats(
        list,
        "float-source-clamped-to-8-bits: Uploaded floats are clamped and kept in 8 bits.",
        |v| in_bits(v.clamp(0.0, 1.0), 8),
    );
    floats(
        list,
        "float-source-in-6-bits: Uploaded floats keep 6 bits.",
        |v| in_bits(v, 6),
    );
    floats(
        list,
        "float-source-in-16-bits: Uploaded floats become 16-bit ones.",
        half,
    );
}
