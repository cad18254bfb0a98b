//! Comparison of a frame with its legal set and the yardstick.

use crate::band::Band;
use crate::counter::CounterOutcome;
use crate::encoding::ChannelEncoding;
use crate::format::Aspect;
use crate::image::{Frame, FrameError};
use crate::legal::{ImageInfo, LegalSet, TexelSet};
use serde::{Deserialize, Serialize};

/// One channel outside its interval. Codes are bit patterns in the channel's encoding.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelMismatch {
    /// The attachment's name in the scene.
    pub attachment: String,
    /// The aspect to which the channel belongs.
    pub aspect: Aspect,
    /// The channel's position: red is 0.
    pub channel: u8,
    /// The encoding of the three codes below.
    pub encoding: ChannelEncoding,
    /// Code of the lowest allowed value.
    pub low: u32,
    /// Code of the highest allowed value.
    pub high: u32,
    /// The code that came back.
    pub actual: u32,
}

/// One sample outside a band. The channels are those outside the nearest allowed box.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WrongTexel {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Sample within the texel, from 0; always 0 for single-sample attachments.
    pub sample: u32,
    /// The worst band that the sample is outside of.
    pub band: Band,
    /// The channels outside the nearest allowed box, in the order of the images.
    pub channels: Vec<ChannelMismatch>,
}

/// Counts of samples by band.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TexelCounts {
    /// The number of judged samples.
    pub total: u64,
    /// Samples outside the legal set.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub wrong: u64,
    /// Legal samples outside the yardstick.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub imprecise: u64,
    /// Samples about which the legal set asserts nothing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub open: u64,
}

impl TexelCounts {
    /// Returns true if no sample was judged.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// The outcome of [`compare`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Counts over all samples.
    pub texels: TexelCounts,
    /// The first wrong samples, failures before imprecise ones, up to the requested number.
    pub wrong: Vec<WrongTexel>,
    /// One outcome per counter, in the order of the scene's counters.
    pub counters: Vec<CounterOutcome>,
}

impl Comparison {
    /// Returns the worst band that a sample or a counter is outside of.
    pub fn worst(&self) -> Option<Band> {
        let texels = if self.texels.wrong > 0 {
            Some(Band::Fail)
        } else if self.texels.imprecise > 0 {
            Some(Band::Imprecise)
        } else {
            None
        };
        let counters = self.counters.iter().filter_map(|c| c.band).max();
        texels.max(counters)
    }
}

/// Compares a frame with both bands, keeping the first `keep` samples that are outside one.
///
/// # Errors
/// If the frame's images are not those of the legal set.
pub fn compare(
    frame: &Frame,
    legal: &LegalSet,
    yardstick: &LegalSet,
    keep: usize,
) -> Result<Comparison, FrameError> {
    legal.check_images(frame)?;
    let mut result = Comparison::default();
    let mut imprecise = Vec::new();
    let mut orders: Vec<i64> = Vec::new();
    for (g, group) in legal.groups.iter().enumerate() {
        let images: Vec<(usize, &ImageInfo)> = legal
            .images
            .iter()
            .enumerate()
            .filter(|(_, i)| i.group == g)
            .collect();
        let ideal = &yardstick.groups[g];
        let codes = |(i, info): &(usize, &ImageInfo), index: usize| {
            let n = info.channels.len();
            &frame.images[*i].codes[index * n..(index + 1) * n]
        };
        // Compares code by code: a sample has too few codes for a call of `memcmp` to pay off.
        let same = |index: usize| {
            images.iter().all(|i| {
                let mut both = codes(i, index).iter().zip(codes(i, index - 1));
                both.all(|(a, b)| a == b)
            })
        };
        let mut start = 0;
        let (mut sets, mut ideals) = (group.runs().peekable(), ideal.runs().peekable());
        while let (Some((end, allowed)), Some((ideal_end, tight))) =
            (sets.peek().copied(), ideals.peek().copied())
        {
            // Most samples equal the previous one, both in their codes and in their legal set.
            let most = end.min(ideal_end);
            let next = (start + 1..most).find(|next| !same(*next)).unwrap_or(most);
            let run = start..next;
            orders.clear();
            for image in &images {
                let channels = codes(image, start).iter().zip(&image.1.channels);
                orders.extend(channels.map(|(code, e)| e.order_of_code(*code)));
            }
            let times = run.len() as u64;
            result.texels.total += times;
            if allowed.is_open() {
                result.texels.open += times;
            }
            let describe = |band, set: &TexelSet, index: usize| {
                let [x, y, sample] = group.position(index);
                WrongTexel {
                    x,
                    y,
                    sample,
                    band,
                    channels: mismatches(&images, set, &orders),
                }
            };
            if !allowed.allows(&orders) {
                result.texels.wrong += times;
                let left = keep - result.wrong.len();
                let first = run.clone().take(left);
                let wrong = first.map(|index| describe(Band::Fail, allowed, index));
                result.wrong.extend(wrong);
            } else if !tight.allows(&orders) {
                result.texels.imprecise += times;
                let left = keep - imprecise.len();
                let first = run.clone().take(left);
                imprecise.extend(first.map(|index| describe(Band::Imprecise, tight, index)));
            }
            start = next;
            sets.next_if(|(end, _)| *end <= start);
            ideals.next_if(|(end, _)| *end <= start);
        }
    }
    for ((set, tight), actual) in legal
        .counters
        .iter()
        .zip(&yardstick.counters)
        .zip(&frame.counters)
    {
        let outcome = CounterOutcome::new(set, tight.range, *actual);
        result.counters.push(outcome);
    }
    imprecise.truncate(keep - result.wrong.len());
    result.wrong.append(&mut imprecise);
    Ok(result)
}

impl LegalSet {
    /// Checks that a frame has the images and counters of this set.
    pub(crate) fn check_images(&self, frame: &Frame) -> Result<(), FrameError> {
        if frame.images.len() != self.images.len() {
            return Err(FrameError::ImageCount {
                actual: frame.images.len(),
                expected: self.images.len(),
            });
        }
        if frame.counters.len() != self.counters.len() {
            return Err(FrameError::CounterCount {
                actual: frame.counters.len(),
                expected: self.counters.len(),
            });
        }
        for (index, (image, info)) in frame.images.iter().zip(&self.images).enumerate() {
            if !info.matches(image) {
                return Err(FrameError::Image {
                    index,
                    actual: format!(
                        "{} {} {:?} x{} {:?} by {:?}, {} codes",
                        image.attachment,
                        image.aspect,
                        image.size,
                        image.samples,
                        image.channels,
                        image.read,
                        image.codes.len()
                    ),
                    expected: format!(
                        "{} {} {:?} x{} {:?} by {:?}",
                        info.attachment,
                        info.aspect,
                        info.size,
                        info.samples,
                        info.channels,
                        info.read
                    ),
                });
            }
        }
        Ok(())
    }

    /// Compares one sample of a frame, whose images are the set's, with another set. The shape selects the
    /// images of one size and sample count; the sample is given by column, row and sample. Returns `None` if
    /// it is legal.
    pub fn refused(
        &self,
        frame: &Frame,
        shape: ([u32; 2], u32),
        [x, y, sample]: [u32; 3],
        set: &TexelSet,
    ) -> Option<WrongTexel> {
        let numbered = self.images.iter().enumerate();
        let images: Vec<_> = numbered
            .filter(|(_, info)| (info.size, info.samples) == shape)
            .collect();
        let orders = images.iter().flat_map(|(i, info)| {
            let codes = frame.images[*i].sample(x, y, sample).iter();
            codes
                .zip(&info.channels)
                .map(|(code, e)| e.order_of_code(*code))
        });
        let orders: Vec<i64> = orders.collect();
        (!set.allows(&orders)).then(|| WrongTexel {
            x,
            y,
            sample,
            band: Band::Fail,
            channels: mismatches(&images, set, &orders),
        })
    }
}

fn mismatches(
    images: &[(usize, &ImageInfo)],
    set: &TexelSet,
    orders: &[i64],
) -> Vec<ChannelMismatch> {
    let Some(world) = set.nearest(orders) else {
        return Vec::new();
    };
    let mut result = Vec::new();
    for (_, info) in images {
        for (channel, encoding) in info.channels.iter().enumerate() {
            let position = info.first_channel + channel;
            let interval = world.channels[position];
            if !interval.contains(orders[position]) {
                result.push(ChannelMismatch {
                    attachment: info.attachment.clone(),
                    aspect: info.aspect,
                    channel: channel as u8,
                    encoding: *encoding,
                    low: encoding.code_of_order(interval.low),
                    high: encoding.code_of_order(interval.high),
                    actual: encoding.code_of_order(orders[position]),
                });
            }
        }
    }
    result
}
