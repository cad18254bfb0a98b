//! Values, codes and colours in words.

use etalon_frame::{ChannelEncoding, Codes, ValueRange};

/// Returns the codes of channels: the value of a float code, number and value of a wide code, else the
/// number.
pub(super) fn codes_list(codes: &[Codes]) -> String {
    codes.iter().map(codes_text).collect::<Vec<_>>().join(", ")
}

fn codes_text(codes: &Codes) -> String {
    let encoding = codes.encoding;
    // The value of a wide code is easier to read than its number.
    let text = |order: i64| match encoding {
        ChannelEncoding::Unorm(9..) | ChannelEncoding::Snorm(9..) => {
            format!("{order} ({})", encoding.value_of_order(order) as f32)
        }
        _ if encoding.is_float() => format!("{:?}", encoding.value_of_order(order) as f32),
        _ => order.to_string(),
    };
    if codes.is_exact() {
        text(codes.low)
    } else {
        format!("{}..{}", text(codes.low), text(codes.high))
    }
}

/// Returns the name of a colour whose channels are exactly 0 or 1, else `None`.
pub(super) fn color_name(codes: &[Codes]) -> Option<&'static str> {
    let mut bits = [false; 4];
    if codes.len() < 3 {
        return None;
    }
    bits[3] = codes.len() == 3;
    for (bit, codes) in bits.iter_mut().zip(codes) {
        if matches!(codes.encoding, ChannelEncoding::Uint(_)) || !codes.is_exact() {
            return None;
        }
        let value = codes.encoding.value_of_order(codes.low);
        if value != 0.0 && value != 1.0 {
            return None;
        }
        *bit = value == 1.0;
    }
    Some(match bits {
        [false, false, false, false] => "transparent black",
        [false, false, false, true] => "black",
        [true, false, false, _] => "red",
        [false, true, false, _] => "green",
        [false, false, true, _] => "blue",
        [true, true, false, _] => "yellow",
        [true, false, true, _] => "magenta",
        [false, true, true, _] => "cyan",
        [true, true, true, _] => "white",
    })
}

/// Returns values of channels.
pub(super) fn values_list(values: &[ValueRange]) -> String {
    values.iter().map(range).collect::<Vec<_>>().join(", ")
}

/// Returns a range of values: `0.5`, or `0.5..0.75`.
pub(super) fn range(range: &ValueRange) -> String {
    if range.low == range.high {
        number(range.low)
    } else {
        format!("{}..{}", number(range.low), number(range.high))
    }
}

/// Returns a number: the shortest digits of a 32-bit float, or seven decimal places of another number.
fn number(value: f64) -> String {
    if value == f64::from(value as f32) {
        (value as f32).to_string()
    } else {
        format!("{value:.7}")
    }
}
