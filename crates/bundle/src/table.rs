//! The comparison of the values read back with the permitted ones, as a table that each language prints.

use crate::due::{Due, DueChannel, DueCounter, DueTexel};
use crate::error::BundleError;
use etalon_backend::{NumberForm, RecordedCounter, Recording};
use etalon_frame::ChannelEncoding;

/// The comparison of a channel's bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BitOrder {
    /// As an unsigned number.
    Unsigned,
    /// As a signed number.
    Signed,
    /// As a 16-bit float, by sign and magnitude.
    Half,
    /// As a 32-bit float, by sign and magnitude.
    Single,
    /// As a 32-bit float, by value.
    Value,
    /// As a byte to which a shorter code was widened.
    Widened,
}

/// A sample to check.
pub(crate) struct TableTexel {
    /// The place, in words.
    pub(crate) place: String,
    /// The channels.
    pub(crate) channels: Vec<CheckedChannel>,
    /// The permitted outcomes: the lowest and the highest number of each channel.
    pub(crate) allowed: Vec<Vec<[f64; 2]>>,
}

/// A channel to check.
pub(crate) struct CheckedChannel {
    /// The name.
    pub(crate) name: String,
    /// The number of the memory that it was read to.
    pub(crate) output: u32,
    /// The offset of the texel's first byte.
    pub(crate) at: u64,
    /// The first bit, counted from there.
    pub(crate) bit: u32,
    /// The number of bits.
    pub(crate) bits: u32,
    /// The comparison of the bits.
    pub(crate) order: BitOrder,
    /// The width of the code, in bits.
    pub(crate) width: u32,
}

/// Returns the samples to check.
pub(crate) fn texels(
    recording: &Recording,
    expected: &Due,
) -> Result<Vec<TableTexel>, BundleError> {
    let texel = |texel: &DueTexel| {
        let channels = texel.channels.iter().map(|c| place(recording, texel, c));
        let range = |(range, channel): (&[i64; 2], &DueChannel)| {
            bounds(*range, channel.encoding, form(recording, channel))
        };
        let outcome =
            |ranges: &Vec<[i64; 2]>| ranges.iter().zip(&texel.channels).map(range).collect();
        Ok(TableTexel {
            place: match texel.sample {
                0 => format!("texel {},{}", texel.x, texel.y),
                sample => format!("sample {sample} of texel {},{}", texel.x, texel.y),
            },
            channels: channels.collect::<Result<_, _>>()?,
            allowed: texel.allowed.iter().map(outcome).collect(),
        })
    };
    expected.texels.iter().map(texel).collect()
}

/// Returns where a counter was read back.
pub(crate) fn counter<'a>(
    recording: &'a Recording,
    expected: &DueCounter,
) -> Result<&'a RecordedCounter, BundleError> {
    let counter = recording.counters.get(expected.index);
    counter
        .filter(|c| !c.parts.is_empty())
        .ok_or_else(|| BundleError::Unread(format!("counter {}", expected.name)))
}

fn unread(channel: &DueChannel) -> BundleError {
    BundleError::Unread(channel.name())
}

/// Returns the form in which a channel was read back.
fn form(recording: &Recording, channel: &DueChannel) -> NumberForm {
    let image = recording
        .images
        .iter()
        .find(|i| i.attachment == channel.attachment && i.aspect == channel.aspect);
    image
        .and_then(|i| i.planes.first())
        .map_or(NumberForm::Code, |plane| plane.form)
}

/// Returns where a channel was read back.
fn place(
    recording: &Recording,
    texel: &DueTexel,
    channel: &DueChannel,
) -> Result<CheckedChannel, BundleError> {
    let is_image = |i: &&etalon_backend::RecordedImage| {
        i.attachment == channel.attachment && i.aspect == channel.aspect
    };
    let image = recording
        .images
        .iter()
        .find(is_image)
        .ok_or_else(|| unread(channel))?;
    let plane = image
        .planes
        .get(texel.sample as usize)
        .ok_or_else(|| unread(channel))?;
    let [bit, bits] = plane
        .channels
        .get(channel.channel)
        .ok_or_else(|| unread(channel))?;
    let offset = (u64::from(texel.y) * u64::from(image.size[0]) + u64::from(texel.x))
        * u64::from(plane.texel);
    let (order, width) = match (plane.form, channel.encoding) {
        (NumberForm::Float | NumberForm::Fraction, _) => (BitOrder::Value, 32),
        (NumberForm::Byte, encoding) => match encoding.bits() {
            8 => (BitOrder::Unsigned, 8),
            width => (BitOrder::Widened, width),
        },
        (NumberForm::Code, ChannelEncoding::Snorm(bits)) => (BitOrder::Signed, u32::from(bits)),
        (NumberForm::Code, ChannelEncoding::Float16) => (BitOrder::Half, 16),
        (NumberForm::Code, ChannelEncoding::Float32) => (BitOrder::Single, 32),
        (NumberForm::Code, encoding) => (BitOrder::Unsigned, encoding.bits()),
    };
    Ok(CheckedChannel {
        name: channel.name(),
        output: plane.output,
        at: offset,
        bit: *bit,
        bits: *bits,
        order,
        width,
    })
}

/// Returns the bounds of a range of orders, as the numbers that the program compares. For a value that was
/// read back as a float, the bounds are halfway to the next code.
fn bounds([least, most]: [i64; 2], encoding: ChannelEncoding, form: NumberForm) -> [f64; 2] {
    let encoding = match (form, encoding) {
        (NumberForm::Fraction, ChannelEncoding::Srgb8) => ChannelEncoding::Unorm(8),
        _ => encoding,
    };
    if !matches!(form, NumberForm::Float | NumberForm::Fraction) {
        return [least as f64, most as f64];
    }
    let value = |order: i64| encoding.value_of_order(order);
    if encoding == ChannelEncoding::Float32 {
        return [value(least), value(most)];
    }
    let below = if least > encoding.min_order() {
        (value(least - 1) + value(least)) / 2.0
    } else {
        f64::NEG_INFINITY
    };
    let above = if most < encoding.max_order() {
        (value(most) + value(most + 1)) / 2.0
    } else {
        f64::INFINITY
    };
    [below, above]
}
