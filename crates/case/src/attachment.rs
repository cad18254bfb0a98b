//! Attachments: clear values, texels, and look-up by name.

use crate::codes::{beside, codes};
use crate::error::At;
use crate::wire::{AttachmentWire, ClearWire, SceneWire, TexelsWire};
use etalon_frame::{ChannelEncoding, TextureFormat};
use etalon_scene::{Attachment, AttachmentContents, Scene};

/// The maximum width and height of an attachment in a case file.
pub(crate) const MAX_SIZE: u32 = 4096;

/// Returns the size of attachments that do not give one.
pub(crate) fn default_size(wire: &SceneWire) -> [u32; 2] {
    wire.attachments
        .values()
        .find_map(|a| a.size)
        .unwrap_or([16, 16])
}

/// Returns the index of the attachment with a name.
pub(crate) fn find(name: &str, attachments: &[Attachment]) -> Result<usize, At> {
    attachments
        .iter()
        .position(|a| a.name == name)
        .ok_or_else(|| {
            let names: Vec<_> = attachments.iter().map(|a| a.name.as_str()).collect();
            At::new(format!(
                "there is no attachment `{name}`; there are: {}",
                names.join(", ")
            ))
        })
}

/// Returns an attachment with its contents.
pub(crate) fn attachment(
    name: &str,
    wire: &AttachmentWire,
    size: [u32; 2],
) -> Result<Attachment, At> {
    let size = wire.size.unwrap_or(size);
    if size.contains(&0) || size.iter().any(|s| *s > MAX_SIZE) {
        return Err(
            At::new(format!("width and height must be 1 to {MAX_SIZE} texels")).key("size"),
        );
    }
    let samples = wire.samples.unwrap_or(1);
    if ![1, 2, 4, 8, 16].contains(&samples) {
        return Err(At::new("samples must be 1, 2, 4, 8 or 16").key("samples"));
    }
    let contents = match (&wire.clear, &wire.texels) {
        (Some(_), Some(_)) => {
            return Err(
                At::new("an attachment starts from `clear` or from `texels`").key("texels"),
            );
        }
        (None, Some(texels)) => {
            self::texels(texels, wire.format, size, samples).map_err(|e| e.key("texels"))?
        }
        (Some(clear), None) => self::clear(clear, wire.format).map_err(|e| e.key("clear"))?,
        (None, None) if wire.format.is_color() => AttachmentContents::Color([0.0; 4]),
        (None, None) => AttachmentContents::DepthStencil {
            depth: 1.0,
            stencil: 0,
        },
    };
    Ok(Attachment {
        name: name.to_owned(),
        format: wire.format,
        size,
        samples,
        contents,
    })
}

fn clear(wire: &ClearWire, format: TextureFormat) -> Result<AttachmentContents, At> {
    let (has_depth, has_stencil) = (format.has_depth(), format.has_stencil());
    let contents = match wire {
        ClearWire::Color(color) if format.is_color() => AttachmentContents::Color(*color),
        ClearWire::Number(depth) if has_depth && !has_stencil => AttachmentContents::DepthStencil {
            depth: *depth as f32,
            stencil: 0,
        },
        ClearWire::Number(stencil) if has_stencil && !has_depth => {
            AttachmentContents::DepthStencil {
                depth: 1.0,
                stencil: stencil_code(*stencil)?,
            }
        }
        ClearWire::DepthStencil(both) if has_depth && has_stencil => {
            AttachmentContents::DepthStencil {
                depth: both.depth,
                stencil: both.stencil,
            }
        }
        _ => {
            let form = match (has_depth, has_stencil) {
                (false, false) => "four numbers",
                (true, true) => "{\"depth\": …, \"stencil\": …}",
                _ => "a number",
            };
            return Err(At::new(format!("the clear value of {format} is {form}")));
        }
    };
    if let AttachmentContents::DepthStencil { depth, .. } = contents
        && !(0.0..=1.0).contains(&depth)
    {
        return Err(At::new("a cleared depth must be between 0 and 1"));
    }
    Ok(contents)
}

fn stencil_code(value: f64) -> Result<u8, At> {
    if value.fract() == 0.0 && (0.0..=255.0).contains(&value) {
        Ok(value as u8)
    } else {
        Err(At::new("a stencil value is an integer from 0 to 255"))
    }
}

fn texels(
    wire: &TexelsWire,
    format: TextureFormat,
    size: [u32; 2],
    samples: u32,
) -> Result<AttachmentContents, At> {
    if !format.is_color() || samples != 1 {
        return Err(At::new(
            "only single-sample colour attachments take texels; use `clear`",
        ));
    }
    let channels = format.color_channels().len();
    let code = |texel: &[f64; 4]| -> Result<Vec<u32>, At> {
        let each = format.color_channels().iter().zip(texel).enumerate();
        each.map(|(c, (encoding, value))| encode(*encoding, *value).map_err(|e| e.index(c)))
            .collect()
    };
    let [width, height] = size.map(|s| s as usize);
    let right_length = |length: usize, expected: usize| {
        if length == expected {
            return Ok(());
        }
        let message = format!("{length} texels are given, the attachment has {expected}");
        Err(At::new(message))
    };
    let list = |values: &[[f64; 4]], expected: usize| -> Result<Vec<Vec<u32>>, At> {
        right_length(values.len(), expected)?;
        let each = values.iter().enumerate();
        each.map(|(i, texel)| code(texel).map_err(|e| e.index(i)))
            .collect()
    };
    let rows = match wire {
        TexelsWire::Columns { values } => list(values, width).map(|row| vec![row.concat(); height]),
        TexelsWire::Rows { values } => list(values, height)
            .map(|column| column.iter().map(|texel| texel.repeat(width)).collect()),
        TexelsWire::Grid { values } => right_length(values.len(), height).and_then(|()| {
            let each = values.iter().enumerate();
            each.map(|(y, row)| {
                let row = list(row, width).map_err(|e| e.index(y))?;
                Ok(row.concat())
            })
            .collect::<Result<Vec<_>, At>>()
        }),
        TexelsWire::Codes => return Ok(AttachmentContents::Texels(codes(format, size))),
        TexelsWire::BesideCodes(wire) => {
            if format != TextureFormat::Rgba32Float {
                return Err(At::new("only rgba32float holds values beside codes").key("kind"));
            }
            let colors = beside(wire.of, &wire.by, size)?;
            let codes = colors.concat().into_iter().map(f32::to_bits);
            return Ok(AttachmentContents::Texels(codes.collect()));
        }
    };
    let codes = rows.map_err(|e| e.key("values"))?.concat();
    debug_assert_eq!(codes.len(), width * height * channels);
    Ok(AttachmentContents::Texels(codes))
}

fn encode(encoding: ChannelEncoding, value: f64) -> Result<u32, At> {
    match encoding {
        ChannelEncoding::Unorm(_)
        | ChannelEncoding::Snorm(_)
        | ChannelEncoding::Srgb8
        | ChannelEncoding::Uint(_) => {
            let (least, most) = (encoding.min_order(), encoding.max_order());
            if value.fract() == 0.0 && (least as f64..=most as f64).contains(&value) {
                Ok(encoding.code_of_order(value as i64))
            } else {
                Err(At::new(format!(
                    "an uploaded code of a {encoding} is an integer from {least} to {most}"
                )))
            }
        }
        ChannelEncoding::Float16 | ChannelEncoding::Float32 | ChannelEncoding::Ufloat(_) => {
            let code = encoding.nearest_code(value);
            let found = encoding.value_of_order(encoding.order_of_code(code));
            let limit = encoding.value_of_order(encoding.max_order());
            // A decimal number stands for the nearest 32-bit float, which a shorter format must represent
            // exactly.
            let hit = encoding == ChannelEncoding::Float32 || found as f32 == value as f32;
            if value.abs() > limit || !hit {
                return Err(At::new(format!("the number is not exactly a {encoding}")));
            }
            Ok(code)
        }
    }
}

/// Returns the attachment with a name, which must be read back.
pub(crate) fn read_back(scene: &Scene, name: &str) -> Result<usize, At> {
    let mut read = scene.read.iter().copied();
    read.find(|index| scene.attachments[*index].name == name)
        .ok_or_else(|| At::new(format!("`{name}` is not read back")))
}
/// Checks that the channels of an integer format hold a value.
pub(crate) fn check_integer_value(format: TextureFormat, value: [f32; 4]) -> Result<(), At> {
    if !format.is_integer() {
        return Ok(());
    }
    for (channel, value) in format.color_channels().iter().zip(value) {
        let most = channel.mask();
        if value.fract() != 0.0 || !(0.0..=most as f32).contains(&value) {
            return Err(At::new(format!("integers must be from 0 to {most}")));
        }
    }
    Ok(())
}
