//! Bugs of uploads.

use super::list::{List, Row, SMALL};
use super::plant::{Plant, in_bits, scene};
use etalon_frame::{ChannelEncoding, TextureFormat};
use etalon_scene::Contents;

pub(super) fn add(list: &mut List) {
    list.class("upload", "blend");
    uploads(list);
}

/// The codes that are uploaded to an attachment.
struct Upload {
    format: TextureFormat,
    /// Codes per texel.
    texel: usize,
    /// Codes per row.
    row: usize,
}

/// Changes the codes of uploads.
fn texels(bug: impl Fn(&Upload, &mut Vec<u32>) + Send + Sync + 'static) -> Plant {
    scene(move |scene| {
        for attachment in &mut scene.attachments {
            if let Contents::Texels(codes) = &mut attachment.contents {
                let texel = attachment.format.color_channels().len();
                let upload = Upload {
                    format: attachment.format,
                    texel,
                    row: texel * attachment.size[0] as usize,
                };
                bug(&upload, codes);
            }
        }
    })
}

/// Changes every code of uploads of one format.
fn codes(format: TextureFormat, bug: fn(u32) -> u32) -> Plant {
    texels(move |upload, codes| {
        if upload.format == format {
            codes.iter_mut().for_each(|c| *c = bug(*c));
        }
    })
}

/// A value rounded to a 16-bit float.
fn half(value: f32) -> f32 {
    let encoding = ChannelEncoding::Float16;
    let order = encoding.order_of_code(encoding.nearest_code(f64::from(value)));
    encoding.value_of_order(order) as f32
}

fn uploads(list: &mut List) {
    type Bug = fn(&Upload, &mut Vec<u32>);
    let places: [Row<Bug>; 5] = [
        (
            "red-blue-swapped",
            "Red and blue of uploads are exchanged.",
            |upload, codes| {
                if upload.texel > 2 {
                    let texels = codes.chunks_exact_mut(upload.texel);
                    texels.for_each(|t| t.swap(0, 2));
                }
            },
        ),
        (
            "upside-down",
            "Uploads are upside down.",
            |upload, codes| {
                let rows = codes.chunks_exact(upload.row).rev();
                *codes = rows.flatten().copied().collect();
            },
        ),
        (
            "rows-one-late",
            "Uploads start one row late.",
            |upload, codes| codes.rotate_right(upload.row),
        ),
        (
            "texels-one-late",
            "Uploads start one texel late.",
            |upload, codes| codes.rotate_right(upload.texel),
        ),
        (
            "last-row-lost",
            "The last row of uploads is 0.",
            |upload, codes| {
                let n = codes.len();
                codes[n - upload.row..].fill(0);
            },
        ),
    ];
    list.rows("a wrong row pitch or origin", texels, &places);
    type Code = (&'static str, TextureFormat, &'static str, fn(u32) -> u32);
    let precisions: [Code; 5] = [
        (
            "code-plus-1",
            TextureFormat::Rgba8Unorm,
            "Uploaded 8-bit codes below 255 are one too large.",
            |code| (code + 1).min(255),
        ),
        (
            "lowest-bit-lost",
            TextureFormat::Rgba8Unorm,
            "Uploaded 8-bit codes lose their lowest bit.",
            |code| code & 0xfe,
        ),
        (
            "float-source-clamped-to-8-bits",
            TextureFormat::Rgba32Float,
            "Uploaded floats are clamped and kept in 8 bits.",
            |code| in_bits(f32::from_bits(code).clamp(0.0, 1.0), 8).to_bits(),
        ),
        (
            "float-source-in-6-bits",
            TextureFormat::Rgba32Float,
            "Uploaded floats keep 6 bits.",
            |code| in_bits(f32::from_bits(code), 6).to_bits(),
        ),
        (
            "float-source-in-16-bits",
            TextureFormat::Rgba32Float,
            "Uploaded floats are rounded to 16-bit ones.",
            |code| half(f32::from_bits(code)).to_bits(),
        ),
    ];
    for (name, format, about, bug) in precisions {
        list.add(name, SMALL, about, codes(format, bug));
    }
}
