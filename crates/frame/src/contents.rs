//! Contents of attachments and ranges of values, as stories hold them.

use crate::encoding::ChannelEncoding;
use crate::format::Aspect;
use crate::legal::CodeInterval;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The contents of one aspect of an attachment at a sample.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contents {
    /// The attachment.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// The codes, channel by channel.
    pub codes: Vec<Codes>,
}

/// The codes that a channel can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Codes {
    /// The encoding.
    pub encoding: ChannelEncoding,
    /// The order of the lowest code.
    pub low: i64,
    /// The order of the highest code.
    pub high: i64,
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

    /// True if there is one code.
    pub fn is_exact(&self) -> bool {
        self.low == self.high
    }
}

/// A closed range of values; an end can be infinite or NaN.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValueRange {
    /// The lowest value.
    #[serde(serialize_with = "write", deserialize_with = "read")]
    pub low: f64,
    /// The highest value.
    #[serde(serialize_with = "write", deserialize_with = "read")]
    pub high: f64,
}

/// Writes a number so that it is read back bit for bit: JSON has no infinities, and its readers can be off by a unit in
/// the last place.
fn write<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}

fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let text = std::borrow::Cow::<'_, str>::deserialize(deserializer)?;
    text.parse().map_err(serde::de::Error::custom)
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
        ] {
            let range = ValueRange { low, high };
            let text = serde_json::to_string(&range).unwrap();
            let again: ValueRange = serde_json::from_str(&text).unwrap();
            assert_eq!(again.low.to_bits(), low.to_bits(), "{text}");
            assert_eq!(again.high.to_bits(), high.to_bits(), "{text}");
        }
    }
}
