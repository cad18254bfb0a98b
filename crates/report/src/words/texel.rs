//! Codes and texels in words.

use super::value::codes_list;
use crate::numbers::{count, trimmed};
use etalon_frame::{Band, ChannelEncoding, ChannelMismatch, CodeInterval, Codes, WrongTexel};
use etalon_record::{FrameImage, Record};

/// Returns the attachment and the channel, or one word if they have the same name.
pub(crate) fn channel_of(m: &ChannelMismatch) -> String {
    let name = m.aspect.channel(m.channel.into());
    if m.attachment == name {
        name.to_owned()
    } else {
        format!("{} {name}", m.attachment)
    }
}

/// Returns a code in the notation of its encoding.
pub(crate) fn code_text(encoding: ChannelEncoding, code: u32) -> String {
    match encoding {
        ChannelEncoding::Unorm(bits) | ChannelEncoding::Snorm(bits) => {
            format!("0x{code:0width$x}", width = usize::from(bits).div_ceil(4))
        }
        ChannelEncoding::Srgb8 => format!("0x{code:02x}"),
        ChannelEncoding::Float16 => format!("0x{code:04x}"),
        ChannelEncoding::Ufloat(_) => format!("0x{code:03x}"),
        ChannelEncoding::Uint(_) => code.to_string(),
        ChannelEncoding::Float32 => format!("0x{code:08x}"),
    }
}

/// Returns the value of a code.
pub(crate) fn value_text(encoding: ChannelEncoding, code: u32) -> String {
    if encoding == ChannelEncoding::Float32 {
        // `Debug` keeps all digits and the sign of zero, and prints infinities and NaNs.
        return format!("{:?}", f32::from_bits(code));
    }
    let value = encoding.value_of_order(encoding.order_of_code(code));
    match encoding {
        ChannelEncoding::Uint(_) => format!("{value}"),
        _ => trimmed(format!("{value:.7}")),
    }
}

/// Returns a code with its value: `0x80 = 0.5019608`.
pub(crate) fn code_and_value(encoding: ChannelEncoding, code: u32) -> String {
    let text = code_text(encoding, code);
    match encoding {
        ChannelEncoding::Uint(_) => text,
        _ => format!("{text} = {}", value_text(encoding, code)),
    }
}

/// Returns `low to high`, or one code if both are equal, in the notation of `text`.
pub(crate) fn allowed(m: &ChannelMismatch, text: fn(ChannelEncoding, u32) -> String) -> String {
    let low = text(m.encoding, m.low);
    if m.low == m.high {
        low
    } else {
        format!("{low} to {}", text(m.encoding, m.high))
    }
}

/// Returns the name of a texel: `texel (3, 4)`, with its sample if there are several.
pub(crate) fn place(texel: &WrongTexel, multisampled: bool) -> String {
    let place_name = format!("texel ({}, {})", texel.x, texel.y);
    if multisampled {
        format!("{place_name} sample {}", texel.sample)
    } else {
        place_name
    }
}

/// Returns true if a wrong texel has a sample other than the first.
pub(crate) fn multisampled(record: &Record) -> bool {
    record.wrong.iter().any(|t| t.sample > 0)
}

/// Returns the values of a sample of an image: `allowed [0, 255, 0, 255], drawn [255, 0, 0, 255]: outside`.
pub(crate) fn texel_values(
    image: &FrameImage,
    sample: usize,
    [allowed, actual]: [&str; 2],
) -> String {
    let first = sample * image.channels.len();
    let text = |low: &[u32], high: &[u32]| {
        let codes = image.channels.iter().enumerate().map(|(i, encoding)| {
            let order = |codes: &[u32]| encoding.order_of_code(codes[first + i]);
            let ends = [order(low), order(high)];
            let interval = CodeInterval::new(ends[0].min(ends[1]), ends[0].max(ends[1]));
            Codes::new(*encoding, interval)
        });
        codes_list(&codes.collect::<Vec<_>>())
    };
    let outcome = match image.wrong.get(sample).copied() {
        None | Some(FrameImage::FINE) => "",
        Some(FrameImage::IMPRECISE) => ": legal, outside the yardstick",
        Some(_) => ": ✗",
    };
    format!(
        "{allowed} [{}], {actual} [{}]{outcome}",
        text(&image.low, &image.high),
        text(&image.actual, &image.actual)
    )
}

/// Returns a wrong texel in one line.
pub(super) fn texel_line(texel: &WrongTexel, multisampled: bool) -> String {
    const SHOWN: usize = 2;
    // The bounds of an imprecise texel are those of the yardstick, not of the legal set.
    let (bound, legal) = match texel.band {
        Band::Imprecise => ("yardstick", " (legal)"),
        Band::Fail => ("allowed", ""),
        Band::RequiredByCts => ("allowed by the CTS", ""),
        Band::Disputed => ("allowed as read", ""),
    };
    let channel = |m: &ChannelMismatch| {
        format!(
            "{} {bound} {}, got {}",
            channel_of(m),
            allowed(m, code_text),
            code_text(m.encoding, m.actual)
        )
    };
    let mut parts: Vec<String> = texel.channels.iter().take(SHOWN).map(channel).collect();
    match texel.channels.len().saturating_sub(SHOWN) {
        0 => {}
        n => parts.push(count(n as u64, "more channel")),
    }
    format!(
        "{}{legal}: {}",
        place(texel, multisampled),
        parts.join("; ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::Aspect;

    fn mismatch(encoding: ChannelEncoding, low: u32, high: u32, actual: u32) -> ChannelMismatch {
        ChannelMismatch {
            attachment: "depth".to_owned(),
            aspect: Aspect::Depth,
            channel: 0,
            encoding,
            low,
            high,
            actual,
        }
    }

    #[test]
    fn a_texel_is_described_in_one_line() {
        let mut texel = WrongTexel {
            x: 3,
            y: 4,
            sample: 0,
            band: Band::Fail,
            channels: vec![mismatch(ChannelEncoding::Unorm(16), 0x7ff, 0x800, 1)],
        };
        assert_eq!(
            texel_line(&texel, false),
            "texel (3, 4): depth allowed 0x07ff to 0x0800, got 0x0001"
        );
        texel.sample = 2;
        texel.channels = vec![mismatch(ChannelEncoding::Uint(8), 7, 7, 9); 3];
        texel.channels[0].attachment = "ds".to_owned();
        texel.channels[0].aspect = Aspect::Stencil;
        let line = texel_line(&texel, true);
        assert!(
            line.starts_with("texel (3, 4) sample 2: ds stencil allowed 7, got 9"),
            "{line}"
        );
        assert!(line.ends_with("1 more channel"), "{line}");
    }

    #[test]
    fn texts_of_values_keep_signs_and_special_values() {
        let float = |v: f32| value_text(ChannelEncoding::Float32, v.to_bits());
        assert_eq!(float(-0.0), "-0.0");
        assert_eq!(float(f32::NAN), "NaN");
        assert_eq!(float(f32::INFINITY), "inf");
        assert_eq!(value_text(ChannelEncoding::Unorm(8), 255), "1");
        assert_eq!(
            code_and_value(ChannelEncoding::Unorm(8), 1),
            "0x01 = 0.0039216"
        );
    }
}
