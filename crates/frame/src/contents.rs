//! Contents of attachments and ranges of values, as stored in stories.

use crate::encoding::ChannelEncoding;
use crate::format::Aspect;
use crate::legal::CodeInterval;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The contents of one aspect of an attachment at a sample.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contents {
    /// The attachment's name in the scene.
    pub attachment: String,
    /// The aspect to which the channels belong.
    pub aspect: Aspect,
    /// One entry per channel; one for depth and for stencil.
    pub codes: Vec<Codes>,
}

/// The codes that a channel can have, written as `[encoding, low, high]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    from = "(ChannelEncoding, i64, i64)",
    into = "(ChannelEncoding, i64, i64)"
)]
pub struct Codes {
    /// The encoding in which `low` and `high` are orders.
    pub encoding: ChannelEncoding,
    /// The order of the lowest code.
    pub low: i64,
    /// The order of the highest code.
    pub high: i64,
}

impl From<(ChannelEncoding, i64, i64)> for Codes {
    fn from((encoding, low, high): (ChannelEncoding, i64, i64)) -> Self {
        Self {
            encoding,
            low,
            high,
        }
    }
}

impl From<Codes> for (ChannelEncoding, i64, i64) {
    fn from(codes: Codes) -> Self {
        (codes.encoding, codes.low, codes.high)
    }
}

impl Codes {
    /// Returns the codes of an interval of orders.
    pub fn new(encoding: ChannelEncoding, orders: CodeInterval) -> Self {
        Self {
            encoding,
            low: orders.low,
            high: orders.high,
        }
    }

    /// Returns the codes of channels.
    pub fn of_channels<'a>(
        encodings: impl IntoIterator<Item = &'a ChannelEncoding>,
        orders: impl IntoIterator<Item = CodeInterval>,
    ) -> Vec<Self> {
        let channels = encodings.into_iter().zip(orders);
        channels.map(|(e, orders)| Self::new(*e, orders)).collect()
    }

    /// Returns true if there is only one code.
    pub fn is_exact(&self) -> bool {
        self.low == self.high
    }
}

/// A closed range of values; an end can be infinite or NaN.
///
/// It is written as text, `0.5` or `0.5..0.75`, and read back bit for bit, because JSON has no infinities,
/// and JSON readers can be off by a unit in the last place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// The lower end; equal to `high` for a value that the rules pin.
    pub low: f64,
    /// The upper end, which belongs to the range.
    pub high: f64,
}

impl Serialize for ValueRange {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { low, high } = self;
        if low.to_bits() == high.to_bits() {
            serializer.collect_str(low)
        } else {
            serializer.collect_str(&format_args!("{low}..{high}"))
        }
    }
}

impl<'de> Deserialize<'de> for ValueRange {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = std::borrow::Cow::<'_, str>::deserialize(deserializer)?;
        let (low, high) = text.split_once("..").unwrap_or((&text, &text));
        let end = |text: &str| text.parse().map_err(serde::de::Error::custom);
        Ok(Self {
            low: end(low)?,
            high: end(high)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_back_bit_for_bit() {
        for (low, high) in [
            (f64::NEG_INFINITY, f64::INFINITY),
            (f64::from(0.1_f32), 0.1),
            (-0.0, f64::MIN_POSITIVE),
            (-0.5, -0.5),
            (f64::NAN, f64::NAN),
        ] {
            let range = ValueRange { low, high };
            let text = serde_json::to_string(&range).unwrap();
            let again: ValueRange = serde_json::from_str(&text).unwrap();
            assert_eq!(again.low.to_bits(), low.to_bits(), "{text}");
            assert_eq!(again.high.to_bits(), high.to_bits(), "{text}");
        }
    }
}
