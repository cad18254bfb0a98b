//! Images of a frame, and the texels that they must have.

use etalon_frame::{Aspect, ChannelEncoding, Frame, Image};

pub(crate) const RED: [u32; 4] = [255, 0, 0, 255];
pub(crate) const GREEN: [u32; 4] = [0, 255, 0, 255];
pub(crate) const BLUE: [u32; 4] = [0, 0, 255, 255];
pub(crate) const NONE: [u32; 4] = [0; 4];

/// Returns the image of an attachment's aspect.
pub(crate) fn image<'a>(frame: &'a Frame, attachment: &str, aspect: Aspect) -> &'a Image {
    let mut images = frame.images.iter();
    let found = images.find(|i| i.attachment == attachment && i.aspect == aspect);
    found.unwrap_or_else(|| panic!("the frame has no {aspect} of {attachment}"))
}

pub(crate) fn color<'a>(frame: &'a Frame, attachment: &str) -> &'a Image {
    image(frame, attachment, Aspect::Color)
}

pub(crate) fn depth<'a>(frame: &'a Frame, attachment: &str) -> &'a Image {
    image(frame, attachment, Aspect::Depth)
}

pub(crate) fn stencil<'a>(frame: &'a Frame, attachment: &str) -> &'a Image {
    image(frame, attachment, Aspect::Stencil)
}

/// Returns the positions of all texels.
pub(crate) fn texels([width, height]: [u32; 2]) -> impl Iterator<Item = (u32, u32)> {
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// Asserts that every sample has the codes that are expected at its column and row.
#[track_caller]
pub(crate) fn check<C: AsRef<[u32]>>(image: &Image, expected: impl Fn(u32, u32) -> C) {
    check_samples(image, |x, y, _| expected(x, y));
}

/// Asserts that every sample has the codes that are expected at its column, row and index.
#[track_caller]
pub(crate) fn check_samples<C: AsRef<[u32]>>(image: &Image, expected: impl Fn(u32, u32, u32) -> C) {
    let Image {
        attachment, aspect, ..
    } = image;
    for (x, y) in texels(image.size) {
        for sample in 0..image.samples {
            let (came, expected) = (image.sample(x, y, sample), expected(x, y, sample));
            assert_eq!(
                came,
                expected.as_ref(),
                "{attachment} {aspect} at ({x}, {y}), sample {sample}"
            );
        }
    }
}

/// Assertions about images of a frame: the expected values depend on column and row, and apply to all
/// samples.
pub(crate) trait Expect {
    /// Asserts that `color` is red at the given texels and blue elsewhere.
    #[track_caller]
    fn is_red(&self, red: impl Fn(u32, u32) -> bool) {
        self.color_is("color", |x, y| if red(x, y) { RED } else { BLUE });
    }

    /// Asserts the codes of a colour attachment.
    fn color_is<C: AsRef<[u32]>>(&self, attachment: &str, expected: impl Fn(u32, u32) -> C);

    /// Asserts the depths of an attachment.
    fn depth_is(&self, attachment: &str, expected: impl Fn(u32, u32) -> f64);

    /// Asserts the stencil values of an attachment.
    fn stencil_is(&self, attachment: &str, expected: impl Fn(u32, u32) -> u32);
}

impl Expect for Frame {
    #[track_caller]
    fn color_is<C: AsRef<[u32]>>(&self, attachment: &str, expected: impl Fn(u32, u32) -> C) {
        check(color(self, attachment), expected);
    }

    #[track_caller]
    fn depth_is(&self, attachment: &str, expected: impl Fn(u32, u32) -> f64) {
        let image = depth(self, attachment);
        check(image, |x, y| {
            [image.channels[0].nearest_code(expected(x, y))]
        });
    }

    #[track_caller]
    fn stencil_is(&self, attachment: &str, expected: impl Fn(u32, u32) -> u32) {
        check(stencil(self, attachment), |x, y| [expected(x, y)]);
    }
}

/// Asserts that numbers are within `off` of others.
#[track_caller]
pub(crate) fn check_near(came: &[f64], expected: &[f64], off: f64) {
    assert_eq!(came.len(), expected.len());
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= off;
    assert!(
        came.iter().zip(expected).all(near),
        "{came:?}, expected {expected:?}"
    );
}

/// Asserts that codes differ from others by at most 1.
#[track_caller]
pub(crate) fn check_within_one(came: &[u32], expected: [u32; 4]) {
    let near = came.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
    assert!(near, "{came:?}, expected {expected:?}");
}

/// Returns the values of a texel's channels.
pub(crate) fn values(image: &Image, x: u32, y: u32) -> Vec<f64> {
    let codes = image.channels.iter().zip(image.sample(x, y, 0));
    codes
        .map(|(e, code)| e.value_of_order(e.order_of_code(*code)))
        .collect()
}

/// Returns the codes of values that the channels represent exactly.
pub(crate) fn codes(channels: &[ChannelEncoding], values: [f64; 4]) -> Vec<u32> {
    let both = channels.iter().zip(values);
    both.map(|(e, value)| e.nearest_code(value)).collect()
}
