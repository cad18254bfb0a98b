//! The distance of a frame's codes from the ideal ones, whether they are legal or not.

use crate::encoding::ChannelEncoding;
use crate::format::Aspect;
use crate::legal::{CodeInterval, ImageInfo, TexelSet, WorldBox};
use serde::{Deserialize, Serialize};

/// The distance, in codes, of a code that stands for no finite value.
const NOT_FINITE: f64 = 4_294_967_296.0;

/// The distance of one aspect's channels from the ideal, which is the middle of the yardstick's interval.
/// Distances are in codes: if the ideal value is halfway between two codes, both are half a code away. For
/// floats, a code is the step at the ideal value, but never less than the step just below 1, so that noise
/// around 0 does not outweigh everything else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// The aspect; figures of attachments with the same aspect and encoding are added up.
    pub aspect: Aspect,
    /// The encoding of the channels, whose codes are counted; `None` in records of older versions, which add
    /// up codes of several encodings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encoding: Option<ChannelEncoding>,
    /// The number of channel values about which the yardstick asserts something.
    pub channels: u64,
    /// The mean distance over `channels`, in codes.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub mean: f64,
    /// The largest distance; a code that stands for no finite value counts as 2^32 away.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub max: f64,
}

fn is_zero(distance: &f64) -> bool {
    *distance == 0.0
}

impl Accuracy {
    /// Returns true if both figures are of the same aspect and encoding, so that they can be added.
    pub fn is_alike(&self, other: &Self) -> bool {
        (self.aspect, self.encoding) == (other.aspect, other.encoding)
    }

    /// Adds another frame's figures of the same aspect and encoding.
    pub fn add(&mut self, other: &Self) {
        let total = self.channels.saturating_add(other.channels);
        if other.channels > 0 {
            let share = other.channels as f64 / total as f64;
            self.mean += (other.mean - self.mean) * share;
            self.max = self.max.max(other.max);
        }
        self.channels = total;
    }
}

/// Sums up the distances of one group's samples.
#[derive(Debug)]
pub(crate) struct Distances<'a> {
    channels: Vec<MeasuredChannel<'a>>,
}

#[derive(Debug)]
struct MeasuredChannel<'a> {
    info: &'a ImageInfo,
    encoding: ChannelEncoding,
    /// The interval that asserts nothing.
    all: CodeInterval,
    asserted: u64,
    sum: f64,
    max: f64,
}

impl<'a> Distances<'a> {
    /// Returns empty sums for the images of one group, in the order of their channels.
    pub(crate) fn new(images: &[(usize, &'a ImageInfo)]) -> Self {
        let channels_of = |info: &'a ImageInfo| {
            info.channels.iter().map(move |encoding| MeasuredChannel {
                info,
                encoding: *encoding,
                all: CodeInterval::new(encoding.min_order(), encoding.max_order()),
                asserted: 0,
                sum: 0.0,
                max: 0.0,
            })
        };
        Self {
            channels: images
                .iter()
                .flat_map(|(_, info)| channels_of(info))
                .collect(),
        }
    }

    /// Adds `times` samples with equal codes, compared with the nearest outcome of the yardstick.
    pub(crate) fn add(&mut self, yardstick: &TexelSet, orders: &[i64], times: u64) {
        let world = match yardstick.worlds.as_slice() {
            [] => return,
            [only] => only,
            several => {
                let key = |w: &&WorldBox| (w.violations(orders), self.total(w, orders));
                let nearer = |a: &&WorldBox, b: &&WorldBox| {
                    let (a, b) = (key(a), key(b));
                    a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
                };
                match several.iter().min_by(nearer) {
                    Some(world) => world,
                    None => return,
                }
            }
        };
        for ((channel, interval), order) in
            self.channels.iter_mut().zip(&world.channels).zip(orders)
        {
            if *interval == channel.all {
                continue;
            }
            channel.asserted += times;
            let distance = distance(channel.encoding, *interval, *order);
            if distance > 0.0 {
                channel.sum += distance * times as f64;
                channel.max = channel.max.max(distance);
            }
        }
    }

    fn total(&self, world: &WorldBox, orders: &[i64]) -> f64 {
        let channels = self.channels.iter().zip(&world.channels).zip(orders);
        channels
            .map(|((c, interval), order)| distance(c.encoding, *interval, *order))
            .sum()
    }

    /// Adds the group's figures to those of a frame, in the order of aspects.
    pub(crate) fn add_to(self, result: &mut Vec<Accuracy>) {
        for channel in self.channels {
            let aspect = channel.info.aspect;
            let entry = Accuracy {
                aspect,
                encoding: Some(channel.encoding),
                channels: channel.asserted,
                mean: channel.sum / channel.asserted.max(1) as f64,
                max: channel.max,
            };
            match result.binary_search_by_key(&(aspect, entry.encoding), |a| (a.aspect, a.encoding))
            {
                Ok(index) => result[index].add(&entry),
                Err(index) => result.insert(index, entry),
            }
        }
    }
}

/// Returns the distance of a code from the middle of an interval, in codes.
fn distance(encoding: ChannelEncoding, interval: CodeInterval, order: i64) -> f64 {
    if interval.is_exact() && interval.low == order {
        return 0.0;
    }
    let Some(mantissa) = mantissa(encoding) else {
        // The sum of halves of codes is exact in integers.
        return (2 * order - interval.low - interval.high).unsigned_abs() as f64 / 2.0;
    };
    let [low, high, actual] =
        [interval.low, interval.high, order].map(|o| encoding.value_of_order(o));
    let ideal = low + (high - low) / 2.0;
    let exponent = ideal.abs().log2().floor().max(-1.0);
    let distance = (actual - ideal).abs() / (exponent - f64::from(mantissa)).exp2();
    if distance.is_finite() {
        distance.min(NOT_FINITE)
    } else {
        NOT_FINITE
    }
}

/// Returns the number of a float's bits that follow the leading one.
fn mantissa(encoding: ChannelEncoding) -> Option<u8> {
    match encoding {
        ChannelEncoding::Float16 => Some(10),
        ChannelEncoding::Float32 => Some(23),
        ChannelEncoding::Ufloat(bits) => Some(bits),
        ChannelEncoding::Unorm(_)
        | ChannelEncoding::Snorm(_)
        | ChannelEncoding::Srgb8
        | ChannelEncoding::Uint(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::ReadPath;

    fn order(value: f32) -> i64 {
        ChannelEncoding::Float32.order_of_code(value.to_bits())
    }

    #[test]
    fn distances_are_in_codes_of_the_encoding() {
        let unorm = ChannelEncoding::Unorm(8);
        let interval = CodeInterval::new;
        assert_eq!(distance(unorm, interval(7, 7), 7), 0.0);
        assert_eq!(distance(unorm, interval(7, 7), 9), 2.0);
        assert_eq!(distance(unorm, interval(7, 8), 7), 0.5);
        assert_eq!(distance(unorm, interval(7, 8), 8), 0.5);
        assert_eq!(distance(unorm, interval(7, 9), 8), 0.0);
        assert_eq!(
            distance(ChannelEncoding::Snorm(8), interval(-128, -128), 127),
            255.0
        );

        let float = ChannelEncoding::Float32;
        let interval = |v: f32| CodeInterval::exact(order(v));
        let next = |v: f32| order(v.next_up());
        assert_eq!(distance(float, interval(1.0), next(1.0)), 1.0);
        assert_eq!(distance(float, interval(0.5), next(0.5)), 1.0);
        assert_eq!(distance(float, interval(1000.0), next(1000.0)), 1.0);
        // A value 2^-24 from zero counts as one step away, not as a billion steps.
        assert_eq!(distance(float, interval(0.0), order(2_f32.powi(-24))), 1.0);
        assert_eq!(
            distance(float, interval(-0.25), order(0.25)),
            0.5 * 2_f64.powi(24)
        );
        for far in [f32::NAN, f32::INFINITY, f32::MAX] {
            assert_eq!(
                distance(float, interval(1.0), order(far)),
                NOT_FINITE,
                "{far}"
            );
        }
        let half = ChannelEncoding::Float16;
        assert_eq!(distance(half, CodeInterval::exact(0x3c00), 0x3c01), 1.0);
    }

    #[test]
    fn the_nearest_outcome_counts_and_an_unasserted_value_does_not() {
        let unorm = ChannelEncoding::Unorm(8);
        let info = ImageInfo {
            attachment: "color".to_owned(),
            aspect: Aspect::Color,
            size: [1, 1],
            samples: 1,
            channels: vec![unorm; 2],
            read: ReadPath::Copy,
            group: 0,
            first_channel: 0,
        };
        let world = |channels: [(i64, i64); 2]| WorldBox {
            channels: channels
                .iter()
                .map(|(l, h)| CodeInterval::new(*l, *h))
                .collect(),
        };
        let mut distances = Distances::new(&[(0, &info)]);
        let edge = TexelSet {
            worlds: vec![world([(0, 0), (0, 0)]), world([(200, 202), (100, 100)])],
            ..TexelSet::default()
        };
        distances.add(&edge, &[200, 100], 1);
        distances.add(&edge, &[0, 0], 1);
        let free = TexelSet {
            worlds: vec![world([(0, 255), (5, 5)])],
            ..TexelSet::default()
        };
        distances.add(&free, &[77, 8], 1);
        distances.add(&TexelSet::default(), &[1, 2], 3);
        let mut result = Vec::new();
        distances.add_to(&mut result);
        assert_eq!(
            result,
            [Accuracy {
                aspect: Aspect::Color,
                encoding: Some(unorm),
                channels: 5,
                mean: (1.0 + 3.0) / 5.0,
                max: 3.0,
            }]
        );
    }

    #[test]
    fn codes_of_different_encodings_are_not_added() {
        let encodings = [ChannelEncoding::Float32, ChannelEncoding::Unorm(8)];
        let image = |attachment: &str, group: usize, encoding| ImageInfo {
            attachment: attachment.to_owned(),
            aspect: Aspect::Color,
            size: [1, 1],
            samples: 1,
            channels: vec![encoding],
            read: ReadPath::Copy,
            group,
            first_channel: 0,
        };
        let mut result = Vec::new();
        for (i, encoding) in encodings.into_iter().enumerate() {
            let info = image("color", i, encoding);
            let mut distances = Distances::new(&[(i, &info)]);
            let allowed = TexelSet {
                worlds: vec![WorldBox {
                    channels: [CodeInterval::exact(encoding.order_of_code(0))]
                        .into_iter()
                        .collect(),
                }],
                operands: None,
            };
            distances.add(
                &allowed,
                &[encoding.order_of_code(if i == 0 { 0x3f80_0000 } else { 2 })],
                1,
            );
            distances.add_to(&mut result);
        }
        let found: Vec<_> = result.iter().map(|a| (a.encoding, a.max)).collect();
        assert_eq!(
            found,
            [
                (Some(ChannelEncoding::Unorm(8)), 2.0),
                (Some(ChannelEncoding::Float32), 2_f64.powi(24))
            ]
        );
        assert!(!result[0].is_alike(&result[1]));
        // Relative to the encodings' ranges, the distances are comparable.
        assert_eq!(
            result[0].max / ChannelEncoding::Unorm(8).range(),
            2.0 / 255.0
        );
        assert_eq!(result[1].max / ChannelEncoding::Float32.range(), 2.0);
    }

    #[test]
    fn figures_add_up_by_their_channels() {
        let accuracy = |channels, mean, max| Accuracy {
            aspect: Aspect::Depth,
            encoding: None,
            channels,
            mean,
            max,
        };
        let mut sum = accuracy(0, 0.0, 0.0);
        sum.add(&accuracy(0, 0.0, 0.0));
        assert_eq!(sum, accuracy(0, 0.0, 0.0));
        sum.add(&accuracy(30, 1.0, 2.0));
        sum.add(&accuracy(10, 5.0, 9.0));
        assert_eq!(sum, accuracy(40, 2.0, 9.0));
    }
}
