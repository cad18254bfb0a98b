//! The distance of a frame's codes from the ideal ones, whether they are legal or not.
//!
//! The ideal code of a channel is the middle of its yardstick interval. Only channels that have an ideal are
//! measured. A wide interval says that the yardstick does not know the value: the contents are undefined, the
//! range of the encoding is exceeded, or several outcomes are possible. A distance from its middle would say
//! nothing about the driver.

use crate::encoding::ChannelEncoding;
use crate::format::Aspect;
use crate::image::{Frame, FrameError};
use crate::legal::{CodeInterval, ImageInfo, LegalSet, TexelSet, WorldBox};
use serde::{Deserialize, Serialize};

mod spread;

pub use spread::Spread;

/// The largest distance in codes. Farther codes count as this far away.
const FARTHEST: f64 = 4_294_967_296.0;

/// The distance of one aspect's channels from the ideal, over the channels that have one. Distances are in
/// codes: if the ideal value is halfway between two codes, both are half a code away. For floats, a code is the
/// step at the ideal value (an ulp), but never less than the step just below 1, so that noise around 0 does not
/// outweigh everything else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// The aspect; figures of attachments with the same aspect and encoding are added up.
    pub aspect: Aspect,
    /// The encoding of the channels, whose codes are counted; `None` in records of older versions, which add
    /// up codes of several encodings.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encoding: Option<ChannelEncoding>,
    /// The number of channel values with a distance. Overflows are not among them.
    pub channels: u64,
    /// The mean distance over `channels`, in codes.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub mean: f64,
    /// The largest distance; at most 2^32.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub max: f64,
    /// The number of channel values that stand for no finite value although the ideal is finite, or the
    /// reverse. Older versions count such values as 2^32 codes away.
    #[serde(default, skip_serializing_if = "is_none")]
    pub overflow: u64,
    /// The number of channel values by distance. Records of older versions lack it.
    #[serde(default, skip_serializing_if = "Spread::is_empty")]
    pub spread: Spread,
}

fn is_zero(distance: &f64) -> bool {
    *distance == 0.0
}

fn is_none(count: &u64) -> bool {
    *count == 0
}

impl Accuracy {
    /// Returns the figures of an aspect without any channel.
    pub fn none(aspect: Aspect, encoding: Option<ChannelEncoding>) -> Self {
        Self {
            aspect,
            encoding,
            channels: 0,
            mean: 0.0,
            max: 0.0,
            overflow: 0,
            spread: Spread::default(),
        }
    }

    /// Returns true if both figures are of the same aspect and encoding, so that they can be added.
    pub fn is_alike(&self, other: &Self) -> bool {
        (self.aspect, self.encoding) == (other.aspect, other.encoding)
    }

    /// Returns true if every measured channel value is the ideal one.
    pub fn is_exact(&self) -> bool {
        self.max == 0.0 && self.overflow == 0
    }

    /// Adds another frame's figures of the same aspect and encoding.
    pub fn add(&mut self, other: &Self) {
        if self.has_spread() && other.has_spread() {
            self.spread.add(&other.spread);
        } else {
            self.spread = Spread::default();
        }
        let total = self.channels.saturating_add(other.channels);
        if other.channels > 0 {
            let share = other.channels as f64 / total as f64;
            self.mean += (other.mean - self.mean) * share;
            self.max = self.max.max(other.max);
        }
        self.channels = total;
        self.overflow = self.overflow.saturating_add(other.overflow);
    }

    /// Returns a distance that at least this share of the channel values does not exceed, in codes. It is a
    /// threshold of [`Spread`] or the largest distance, so it can be up to twice the true percentile. `None` if
    /// there is no channel value, or if a record of an older version was added.
    pub fn percentile(&self, share: f64) -> Option<f64> {
        if self.channels == 0 || !self.has_spread() {
            return None;
        }
        let within = self.spread.percentile(self.channels, share);
        Some(within.min(self.max))
    }

    /// Returns true if the distribution of the distances is known.
    fn has_spread(&self) -> bool {
        self.max == 0.0 || !self.spread.is_empty()
    }
}

/// Returns the accuracy of a frame, for each aspect and encoding that was read back. `ideal` has the yardstick's
/// values, `legal` the values that the rules allow.
///
/// # Errors
/// If the frame's images are not those of the sets.
pub fn accuracy(
    frame: &Frame,
    legal: &LegalSet,
    ideal: &LegalSet,
) -> Result<Vec<Accuracy>, FrameError> {
    legal.check_images(frame)?;
    ideal.check_images(frame)?;
    let mut result = Vec::new();
    for (g, group) in legal.groups.iter().enumerate() {
        let images = legal.images.iter().enumerate();
        let images: Vec<(usize, &ImageInfo)> = images.filter(|(_, i)| i.group == g).collect();
        let mut distances = Distances::new(&images);
        let mut orders: Vec<i64> = Vec::new();
        let mut start = 0;
        let (mut sets, mut ideals) = (group.runs().peekable(), ideal.groups[g].runs().peekable());
        while let (Some((end, allowed)), Some((ideal_end, tight))) =
            (sets.peek().copied(), ideals.peek().copied())
        {
            let end = end.min(ideal_end);
            distances.begin(allowed, tight);
            for index in start..end {
                orders.clear();
                for (i, info) in &images {
                    let n = info.channels.len();
                    let codes = &frame.images[*i].codes[index * n..(index + 1) * n];
                    let orders_of = codes.iter().zip(&info.channels);
                    orders.extend(orders_of.map(|(code, e)| e.order_of_code(*code)));
                }
                distances.add(allowed, tight, &orders);
            }
            start = end;
            sets.next_if(|(end, _)| *end <= start);
            ideals.next_if(|(end, _)| *end <= start);
        }
        distances.add_to(&mut result);
    }
    Ok(result)
}

/// Sums up the distances of one group's samples.
#[derive(Debug)]
struct Distances<'a> {
    channels: Vec<MeasuredChannel<'a>>,
}

#[derive(Debug)]
struct MeasuredChannel<'a> {
    info: &'a ImageInfo,
    encoding: ChannelEncoding,
    /// The ideal of the samples that are being added.
    ideal: Option<CodeInterval>,
    /// The last code and its distance: most samples equal the one before.
    last: Option<(i64, CodeDistance)>,
    measured: u64,
    overflow: u64,
    sum: f64,
    max: f64,
    spread: Spread,
}

impl<'a> Distances<'a> {
    /// Returns empty sums for the images of one group, in the order of their channels.
    fn new(images: &[(usize, &'a ImageInfo)]) -> Self {
        let channels_of = |info: &'a ImageInfo| {
            info.channels.iter().map(move |encoding| MeasuredChannel {
                info,
                encoding: *encoding,
                ideal: None,
                last: None,
                measured: 0,
                overflow: 0,
                sum: 0.0,
                max: 0.0,
                spread: Spread::default(),
            })
        };
        Self {
            channels: images
                .iter()
                .flat_map(|(_, info)| channels_of(info))
                .collect(),
        }
    }

    /// Begins samples with these sets. A value about which the rules assert nothing has no ideal.
    fn begin(&mut self, allowed: &TexelSet, tight: &TexelSet) {
        for (i, channel) in self.channels.iter_mut().enumerate() {
            let encoding = channel.encoding;
            let everything = CodeInterval::new(encoding.min_order(), encoding.max_order());
            let asserted = allowed.hull(i).filter(|hull| *hull != everything);
            channel.ideal = asserted.and_then(|_| ideal(encoding, tight, i));
            channel.last = None;
        }
    }

    /// Adds a sample, unless its codes follow from a choice that the rules allow and the yardstick does not
    /// make.
    fn add(&mut self, allowed: &TexelSet, tight: &TexelSet, orders: &[i64]) {
        if is_other_choice(allowed, tight, orders) {
            return;
        }
        for (channel, order) in self.channels.iter_mut().zip(orders) {
            let Some(ideal) = channel.ideal else { continue };
            let found = match channel.last {
                Some((last, found)) if last == *order => found,
                _ => distance(channel.encoding, ideal, *order),
            };
            channel.last = Some((*order, found));
            match found {
                CodeDistance::Overflow => channel.overflow += 1,
                CodeDistance::Codes(codes) => {
                    channel.measured += 1;
                    channel.sum += codes;
                    channel.max = channel.max.max(codes);
                    channel.spread.count(codes);
                }
            }
        }
    }

    /// Adds the group's figures to those of a frame, in the order of aspects.
    fn add_to(self, result: &mut Vec<Accuracy>) {
        for channel in self.channels {
            let aspect = channel.info.aspect;
            let entry = Accuracy {
                channels: channel.measured,
                mean: channel.sum / channel.measured.max(1) as f64,
                max: channel.max,
                overflow: channel.overflow,
                spread: channel.spread,
                ..Accuracy::none(aspect, Some(channel.encoding))
            };
            match result.binary_search_by_key(&(aspect, entry.encoding), |a| (a.aspect, a.encoding))
            {
                Ok(index) => result[index].add(&entry),
                Err(index) => result.insert(index, entry),
            }
        }
    }
}

/// Returns true if a sample is legal only in worlds that contain no value of the yardstick. Its codes are then
/// those of another choice, such as the other side of an edge, and no worse result of the same one.
fn is_other_choice(allowed: &TexelSet, tight: &TexelSet, orders: &[i64]) -> bool {
    if tight.is_open() || tight.allows(orders) {
        return false;
    }
    let overlap = |a: &WorldBox, b: &WorldBox| {
        let mut channels = a.channels.iter().zip(&b.channels);
        channels.all(|(a, b)| a.low <= b.high && b.low <= a.high)
    };
    let worlds = allowed.worlds.iter();
    let mut own = worlds.filter(|w| w.violations(orders) == 0).peekable();
    own.peek().is_some() && own.all(|w| tight.worlds.iter().all(|t| !overlap(w, t)))
}

/// Returns the ideal of one channel: the values of all worlds of the yardstick, if they are close enough to
/// each other. Returns `None` if there is no ideal.
fn ideal(encoding: ChannelEncoding, tight: &TexelSet, channel: usize) -> Option<CodeInterval> {
    let hull = tight.hull(channel)?;
    if hull.is_exact() {
        return Some(hull);
    }
    let range = CodeInterval::new(encoding.min_order(), encoding.max_order());
    let is_bounded = range.low <= hull.low && hull.high <= range.high && hull != range;
    (is_bounded && hull.count() - 1 <= widest(encoding)).then_some(hull)
}

/// A distance from the ideal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum CodeDistance {
    /// In codes.
    Codes(f64),
    /// Only one of the two values is finite.
    Overflow,
}

/// Returns the distance of a code from the middle of an interval.
fn distance(encoding: ChannelEncoding, interval: CodeInterval, order: i64) -> CodeDistance {
    if interval.is_exact() && interval.low == order {
        return CodeDistance::Codes(0.0);
    }
    let is_finite = |order: i64| (encoding.min_order()..=encoding.max_order()).contains(&order);
    if ![interval.low, interval.high, order]
        .into_iter()
        .all(is_finite)
    {
        return CodeDistance::Overflow;
    }
    let Some(mantissa) = mantissa(encoding) else {
        // The sum of halves of codes is exact in integers.
        let halves = (2 * order - interval.low - interval.high).unsigned_abs();
        return CodeDistance::Codes(halves as f64 / 2.0);
    };
    let [low, high, actual] =
        [interval.low, interval.high, order].map(|o| encoding.value_of_order(o));
    let ideal = low + (high - low) / 2.0;
    let exponent = ideal.abs().log2().floor().max(-1.0);
    let codes = (actual - ideal).abs() / (exponent - f64::from(mantissa)).exp2();
    CodeDistance::Codes(codes.min(FARTHEST))
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

/// The spread, in codes, of two conversions in a row that are each within 0.6 codes, which is what the yardstick
/// asks of a conversion. A chain of blends that keep half of the stored value spreads as much, however long it
/// is: 1.2 + 0.6 + 0.3 + ….
const CONVERSIONS: f64 = 2.4;

/// The spread, in steps of 32-bit floats, of 16 operations that the yardstick lets be off by one step up or down.
const OPERATIONS: f64 = 32.0;

/// Returns the largest number of codes between the ends of an interval that rounding makes. A wider one comes
/// from something else than rounding, or from more roundings than leave its middle an ideal.
fn widest(encoding: ChannelEncoding) -> u64 {
    // The steps of the encoding in one step of a 32-bit float, for values just below 1.
    let precision = mantissa(encoding).map_or(encoding.bits(), |bits| u32::from(bits) + 1);
    let finer = (f64::from(precision) - 24.0).exp2();
    (CONVERSIONS + OPERATIONS * finer).ceil() as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Image, ReadPath};
    use crate::legal::LegalSetBuilder;

    const UNORM: ChannelEncoding = ChannelEncoding::Unorm(8);

    fn order(value: f32) -> i64 {
        ChannelEncoding::Float32.order_of_code(value.to_bits())
    }

    fn interval(low: i64, high: i64) -> CodeInterval {
        CodeInterval::new(low, high)
    }

    /// Returns a set of worlds, each with the intervals of its channels.
    fn set(worlds: &[&[(i64, i64)]]) -> TexelSet {
        let world = |channels: &&[(i64, i64)]| WorldBox {
            channels: channels.iter().map(|(l, h)| interval(*l, *h)).collect(),
        };
        TexelSet {
            worlds: worlds.iter().map(world).collect(),
            operands: None,
        }
    }

    /// A texel: its legal set, its ideal set, and the orders that came back.
    type JudgedTexel<'a> = (TexelSet, TexelSet, &'a [i64]);

    /// Returns the accuracy of a frame of one row.
    fn of_row(encodings: &[ChannelEncoding], texels: &[JudgedTexel<'_>]) -> Vec<Accuracy> {
        let size = [texels.len() as u32, 1];
        let sets = |select: for<'a> fn(&'a JudgedTexel<'_>) -> &'a TexelSet| {
            let mut builder = LegalSetBuilder::default();
            builder.image("color", Aspect::Color, size, 1, encodings, ReadPath::Copy);
            for texel in texels {
                let number = builder.set(0, select(texel).clone());
                builder.samples(0, number, 1);
            }
            builder.build()
        };
        let orders = texels.iter().flat_map(|(.., orders)| orders.iter());
        let codes = orders.zip(encodings.iter().cycle());
        let frame = Frame {
            images: vec![Image {
                attachment: "color".to_owned(),
                aspect: Aspect::Color,
                size,
                samples: 1,
                channels: encodings.to_vec(),
                read: ReadPath::Copy,
                codes: codes.map(|(order, e)| e.code_of_order(*order)).collect(),
            }],
            counters: Vec::new(),
        };
        accuracy(&frame, &sets(|t| &t.0), &sets(|t| &t.1)).unwrap()
    }

    /// Returns the accuracy of one texel with one channel that is judged and measured by the same set.
    fn of_channel(encoding: ChannelEncoding, worlds: &[(i64, i64)], order: i64) -> Accuracy {
        let worlds: Vec<[(i64, i64); 1]> = worlds.iter().map(|w| [*w]).collect();
        let worlds: Vec<&[(i64, i64)]> = worlds.iter().map(|w| &w[..]).collect();
        of_row(&[encoding], &[(set(&worlds), set(&worlds), &[order])])[0]
    }

    #[test]
    fn distances_are_in_codes_of_the_encoding() {
        let codes = |encoding, ends, order| match distance(encoding, ends, order) {
            CodeDistance::Codes(codes) => codes,
            CodeDistance::Overflow => panic!("an overflow"),
        };
        assert_eq!(codes(UNORM, interval(7, 7), 7), 0.0);
        assert_eq!(codes(UNORM, interval(7, 7), 9), 2.0);
        assert_eq!(codes(UNORM, interval(7, 8), 7), 0.5);
        assert_eq!(codes(UNORM, interval(7, 8), 8), 0.5);
        assert_eq!(codes(UNORM, interval(7, 9), 8), 0.0);
        let snorm = ChannelEncoding::Snorm(8);
        assert_eq!(codes(snorm, interval(-128, -128), 127), 255.0);

        let float = ChannelEncoding::Float32;
        let exact = |v: f32| CodeInterval::exact(order(v));
        let next = |v: f32| order(v.next_up());
        assert_eq!(codes(float, exact(1.0), next(1.0)), 1.0);
        assert_eq!(codes(float, exact(0.5), next(0.5)), 1.0);
        assert_eq!(codes(float, exact(1000.0), next(1000.0)), 1.0);
        // A value 2^-24 from zero counts as one step away, not as a billion steps.
        assert_eq!(codes(float, exact(0.0), order(2_f32.powi(-24))), 1.0);
        assert_eq!(
            codes(float, exact(-0.25), order(0.25)),
            0.5 * 2_f64.powi(24)
        );
        assert_eq!(codes(float, exact(1.0), order(f32::MAX)), FARTHEST);
        let half = ChannelEncoding::Float16;
        assert_eq!(codes(half, CodeInterval::exact(0x3c00), 0x3c01), 1.0);
    }

    #[test]
    fn an_overflow_is_counted_and_is_no_distance() {
        let float = ChannelEncoding::Float32;
        let infinity = order(f32::INFINITY);
        for (ideal, came, overflow) in [
            (order(1.0), infinity, 1),
            (order(1.0), order(f32::NAN), 1),
            (infinity, order(f32::MAX), 1),
            (infinity, infinity, 0),
        ] {
            let found = of_channel(float, &[(ideal, ideal)], came);
            assert_eq!(
                (found.overflow, found.max, found.mean),
                (overflow, 0.0, 0.0)
            );
            assert_eq!(found.channels, 1 - overflow);
            assert_eq!(found.is_exact(), overflow == 0);
        }
        // The largest finite value or infinity: the yardstick does not know which.
        let either = of_channel(float, &[(order(f32::MAX), infinity)], order(f32::MAX));
        assert_eq!(either, Accuracy::none(Aspect::Color, Some(float)));
    }

    #[test]
    fn values_without_an_ideal_are_not_measured() {
        let none = Accuracy::none(Aspect::Color, Some(UNORM));
        // Undefined contents, contents of two outcomes, and contents that many roundings leave uncertain.
        assert_eq!(of_channel(UNORM, &[], 7), none);
        assert_eq!(of_channel(UNORM, &[(0, 255)], 7), none);
        assert_eq!(of_channel(UNORM, &[(0, 0), (200, 201)], 200), none);
        let widest = widest(UNORM) as i64;
        assert_eq!(of_channel(UNORM, &[(10, 11 + widest)], 10), none);
        let narrow = of_channel(UNORM, &[(10, 10 + widest)], 10);
        assert_eq!((narrow.channels, narrow.max), (1, widest as f64 / 2.0));
        // Two outcomes that differ by rounding only have one ideal between them.
        let near = of_channel(UNORM, &[(7, 7), (8, 8)], 8);
        assert_eq!((near.channels, near.max), (1, 0.5));
    }

    #[test]
    fn another_choice_that_the_rules_allow_is_no_distance() {
        let ideal = set(&[&[(200, 201), (5, 5)]]);
        let legal = set(&[&[(0, 0), (0, 0)], &[(198, 203), (0, 9)]]);
        let measured = |legal: &TexelSet, orders: &[i64]| {
            let texels = [(legal.clone(), ideal.clone(), orders)];
            let found = of_row(&[UNORM; 2], &texels)[0];
            (found.channels, found.max)
        };
        // Not covered, covered with rough colours, and neither.
        assert_eq!(measured(&legal, &[0, 0]), (0, 0.0));
        assert_eq!(measured(&legal, &[203, 5]), (2, 2.5));
        assert_eq!(measured(&legal, &[100, 5]), (2, 100.5));
        // If the rules assert nothing about a value, they leave its contents to the driver.
        assert_eq!(measured(&TexelSet::default(), &[100, 5]), (0, 0.0));
        assert_eq!(measured(&set(&[&[(0, 255), (5, 5)]]), &[100, 5]), (1, 0.0));
    }

    #[test]
    fn codes_of_different_encodings_are_not_added() {
        let encodings = [ChannelEncoding::Float32, UNORM];
        let exact = set(&[&[(0, 0), (0, 0)]]);
        let found = of_row(&encodings, &[(exact.clone(), exact, &[order(1.0), 2])]);
        let largest: Vec<_> = found.iter().map(|a| (a.encoding, a.max)).collect();
        let float = (Some(ChannelEncoding::Float32), 2_f64.powi(24));
        assert_eq!(largest, [(Some(UNORM), 2.0), float]);
        assert!(!found[0].is_alike(&found[1]));
    }

    #[test]
    fn figures_add_up_by_their_channels() {
        let figures = |channels, mean, max, overflow| Accuracy {
            channels,
            mean,
            max,
            overflow,
            ..Accuracy::none(Aspect::Depth, None)
        };
        let mut sum = figures(0, 0.0, 0.0, 0);
        sum.add(&figures(0, 0.0, 0.0, 0));
        assert_eq!(sum, figures(0, 0.0, 0.0, 0));
        sum.add(&figures(30, 1.0, 2.0, 1));
        sum.add(&figures(10, 5.0, 9.0, 4));
        assert_eq!(sum, figures(40, 2.0, 9.0, 5));
    }

    #[test]
    fn percentiles_add_up_over_frames() {
        let frame = |orders: &[i64]| {
            let seven = set(&[&[(7, 7)]]);
            let texels: Vec<_> = orders
                .iter()
                .map(|order| (seven.clone(), seven.clone(), std::slice::from_ref(order)))
                .collect();
            of_row(&[UNORM], &texels)[0]
        };
        let mut sum = frame(&[7; 90]);
        sum.add(&frame(&[8, 8, 8, 8, 8, 8, 8, 8]));
        sum.add(&frame(&[10, 100]));
        let together: Vec<i64> = [vec![7; 90], vec![8; 8], vec![10, 100]].concat();
        let together = frame(&together);
        assert_eq!((sum.spread, sum.max), (together.spread, together.max));
        let at = |share| sum.percentile(share);
        assert_eq!(
            [at(0.9), at(0.98), at(0.99)],
            [Some(0.0), Some(1.0), Some(4.0)]
        );
        // The largest distance is a tighter bound than the threshold above it, which is 128.
        assert_eq!(at(1.0), Some(93.0));
    }

    #[test]
    fn figures_of_older_records_are_read_and_make_percentiles_unknown() {
        let old = r#"{"aspect":"color","encoding":{"unorm":8},"channels":4,"mean":0.5,"max":2}"#;
        let mut sum: Accuracy = serde_json::from_str(old).unwrap();
        assert_eq!((sum.overflow, sum.percentile(0.99)), (0, None));
        assert_eq!(serde_json::to_string(&sum).unwrap().len(), old.len() + 2);
        sum.add(&of_channel(UNORM, &[(7, 7)], 9));
        assert_eq!((sum.channels, sum.max), (5, 2.0));
        assert_eq!(sum.percentile(0.99), None);
        let exact: Accuracy = serde_json::from_str(r#"{"aspect":"color","channels":4}"#).unwrap();
        assert_eq!(exact.percentile(0.99), Some(0.0));
    }
}
