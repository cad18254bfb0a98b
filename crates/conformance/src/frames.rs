//! Images of a frame, and the texels that must be in them.

use etalon_frame::{Aspect, ChannelEncoding, Frame, Image};

pub(crate) const RED: [u32; 4] = [255, 0, 0, 255];
pub(crate) const GREEN: [u32; 4] = [0, 255, 0, 255];
pub(crate) const BLUE: [u32; 4] = [0, 0, 255, 255];
pub(crate) const NONE: [u32; 4] = [0; 4];

/// The image of an attachment's aspect.
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

/// The positions of all texels, or of all within a border.
pub(crate) fn texels([width, height]: [u32; 2]) -> impl Iterator<Item = (u32, u32)> {
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// Holds every sample against the codes due at its column and row.
#[track_caller]
pub(crate) fn check<C: AsRef<[u32]>>(image: &Image, due: impl Fn(u32, u32) -> C) {
    check_samples(image, |x, y, _| due(x, y));
}

/// Holds every sample against the codes due at its column, row and number.
#[track_caller]
pub(crate) fn check_samples<C: AsRef<[u32]>>(image: &Image, due: impl Fn(u32, u32, u32) -> C) {
    let Image {
        attachment, aspect, ..
    } = image;
    for (x, y) in texels(image.size) {
        for sample in 0..image.samples {
            let (came, due) = (image.sample(x, y, sample), due(x, y, sample));
            assert_eq!(
                came,
                due.as_ref(),
                "{attachment} {aspect} at ({x}, {y}), sample {sample}"
            );
        }
    }
}

/// Holds images of a frame against what is due at each column and row, in all samples.
pub(crate) trait Expect {
    /// Holds `color` to be red where told and blue elsewhere.
    #[track_caller]
    fn is_red(&self, red: impl Fn(u32, u32) -> bool) {
        self.color_is("color", |x, y| if red(x, y) { RED } else { BLUE });
    }

    /// Holds an attachment against the codes due.
    fn color_is<C: AsRef<[u32]>>(&self, attachment: &str, due: impl Fn(u32, u32) -> C);

    /// Holds an attachment against the codes of depths.
    fn depth_is(&self, attachment: &str, due: impl Fn(u32, u32) -> f64);

    /// Holds an attachment against stencil values.
    fn stencil_is(&self, attachment: &str, due: impl Fn(u32, u32) -> u32);
}

impl Expect for Frame {
    #[track_caller]
    fn color_is<C: AsRef<[u32]>>(&self, attachment: &str, due: impl Fn(u32, u32) -> C) {
        check(color(self, attachment), due);
    }

    #[track_caller]
    fn depth_is(&self, attachment: &str, due: impl Fn(u32, u32) -> f64) {
        let image = depth(self, attachment);
        check(image, |x, y| [image.channels[0].nearest_code(due(x, y))]);
    }

    #[track_caller]
    fn stencil_is(&self, attachment: &str, due: impl Fn(u32, u32) -> u32) {
        check(stencil(self, attachment), |x, y| [due(x, y)]);
    }
}

/// Holds numbers to be near others.
#[track_caller]
pub(crate) fn check_near(came: &[f64], due: &[f64], off: f64) {
    assert_eq!(came.len(), due.len());
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= off;
    assert!(
        came.iter().zip(due).all(near),
        "{came:?}, and {due:?} is due"
    );
}

/// Holds codes to differ by 1 at most from others.
#[track_caller]
pub(crate) fn check_within_one(came: &[u32], due: [u32; 4]) {
    let near = came.iter().zip(due).all(|(a, b)| a.abs_diff(b) <= 1);
    assert!(near, "{came:?}, and {due:?} is due");
}

/// The values of a texel's channels.
pub(crate) fn values(image: &Image, x: u32, y: u32) -> Vec<f64> {
    let codes = image.channels.iter().zip(image.sample(x, y, 0));
    codes
        .map(|(e, code)| e.value_of_order(e.order_of_code(*code)))
        .collect()
}

/// The codes of values that the channels hold exactly.
pub(crate) fn codes(channels: &[ChannelEncoding], values: [f64; 4]) -> Vec<u32> {
    let both = channels.iter().zip(values);
    both.map(|(e, value)| e.nearest_code(value)).collect()
}
