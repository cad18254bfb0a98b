//! Images of frames as PNG data URIs: the allowed codes, the actual codes, and their difference.

mod strip;
mod window;

pub(crate) use strip::Strip;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_frame::{Aspect, ChannelEncoding, Image};
use etalon_record::{FrameImage, png_file};
use png::{ColorType, Compression};
use std::collections::HashMap;
use std::sync::Mutex;
use strip::{PagePicture, StripPlace, StripValues};
use window::TexelWindow;

/// The largest width and height of a picture, in texels. Larger images are cut around the first wrong texel.
const WINDOW: u32 = 128;
/// The difference of the lowest and highest allowed value above which a texel is striped, of 255.
const STRIPED: u8 = 16;
/// The largest side of a texel in the file of a picture, in pixels.
const BLOCK: u32 = 8;
/// The least height to which images are enlarged on the page, in pixels.
const TARGET: u32 = 256;
/// The width above which the samples of a texel are not enlarged further, in pixels.
const WIDEST: u32 = 512;

const FAIL: [u8; 3] = [0xd5, 0x5e, 0x00];
const IMPRECISE: [u8; 3] = [0x56, 0xb4, 0xe9];
const FINE: [u8; 3] = [0x20, 0x24, 0x2a];

struct PictureView<'a> {
    image: &'a FrameImage,
    window: TexelWindow,
    /// Page pixels per texel.
    scale: u32,
    /// Darkest and lightest value of grey pictures.
    range: [f64; 2],
}

/// The pixels of a picture.
struct Canvas {
    pixels: Vec<[u8; 4]>,
    width: u32,
    height: u32,
}

impl Canvas {
    /// Draws the border of a square. Parts outside the canvas are left out.
    fn frame(&mut self, left: i64, top: i64, side: i64, color: [u8; 4]) {
        for i in 0..side {
            for (x, y) in [
                (left + i, top),
                (left + i, top + side - 1),
                (left, top + i),
                (left + side - 1, top + i),
            ] {
                let inside = |v: i64, most: u32| (0..i64::from(most)).contains(&v);
                if inside(x, self.width) && inside(y, self.height) {
                    self.pixels[(y * i64::from(self.width) + x) as usize] = color;
                }
            }
        }
    }
}

/// Pictures of an image as PNG files with a ring around a sample.
#[derive(Clone, Debug)]
pub struct Ringed {
    /// The lowest allowed codes, the actual codes, and their difference.
    pub pictures: [Vec<u8>; 3],
    /// True if the first two show alpha as grey, because no other channel differs.
    pub alpha: bool,
}

/// Returns the pictures of an image with a ring around a sample (column, row and number), or `None` if the
/// image's lists do not fit its size.
pub fn ringed_pictures(image: &FrameImage, sample: [u32; 3]) -> Option<Ringed> {
    let view = PictureView::of(image)?;
    let color = image.aspect == Aspect::Color;
    let value = |codes: &[u32], sample, channel| view.value(codes, sample, channel);
    let alike =
        |sample| (0..3).all(|c| value(&image.low, sample, c) == value(&image.actual, sample, c));
    let alpha = color && image.channels.len() == 4 && (0..image.wrong.len()).all(alike);
    let look = match (color, alpha) {
        (true, false) => ShownChannels::Rgb,
        (true, true) => ShownChannels::Grey(3),
        (false, _) => ShownChannels::Grey(0),
    };
    let codes = |codes: &[u32]| view.ringed(sample, |sample, _, _| view.texel(codes, sample, look));
    let difference = view.ringed(sample, |sample, _, _| match image.wrong[sample] {
        FrameImage::FINE => FINE,
        FrameImage::IMPRECISE => IMPRECISE,
        _ => {
            let bright = 0.4 + 0.6 * view.distance(sample);
            FAIL.map(|c| (f64::from(c) * bright).round() as u8)
        }
    });
    Some(Ringed {
        pictures: [codes(&image.low)?, codes(&image.actual)?, difference?],
        alpha,
    })
}

/// Returns the pictures of an image, or `None` if its lists do not fit its size.
pub(crate) fn strip(image: &FrameImage) -> Option<Strip> {
    named(image, ["allowed", "drawn"], true)
}

/// Returns the pictures of an image, with these names for the allowed and the actual codes. The allowed picture has the
/// allowed codes that are nearest to the actual ones.
pub(crate) fn named(image: &FrameImage, names: [&str; 2], bounds: bool) -> Option<Strip> {
    let view = PictureView::of(image)?;
    let [allowed, actual] = names;
    let color = match image.aspect {
        Aspect::Color => ShownChannels::Rgb,
        _ => ShownChannels::Grey(0),
    };
    let nearest = nearest(image);
    let pictures = [
        view.allowed(allowed.to_owned(), &nearest, color),
        view.plain(actual.to_owned(), &image.actual, color),
        view.difference(),
    ];
    let mut more = Vec::new();
    let mut add = |name: String, codes: &[u32], look| more.push(view.plain(name, codes, look));
    let alpha = alpha(image);
    if alpha == Alpha::Varies {
        add(format!("{allowed} alpha"), &nearest, ShownChannels::Grey(3));
        add(
            format!("{actual} alpha"),
            &image.actual,
            ShownChannels::Grey(3),
        );
    }
    let same = image.low == image.high;
    if !same {
        add(format!("{allowed} low"), &image.low, color);
        add(format!("{allowed} high"), &image.high, color);
    }
    Some(Strip {
        title: title(image),
        pictures: pictures.into_iter().collect::<Option<_>>()?,
        more: more.into_iter().collect::<Option<_>>()?,
        caption: view.caption(same && bounds, alpha),
        place: StripPlace {
            window: view.window,
            samples: image.samples,
            wrong: view.window.first_wrong(image),
        },
        values: StripValues::of(image, view.window, names),
    })
}

/// Returns the actual codes, moved into the allowed range.
fn nearest(image: &FrameImage) -> Vec<u32> {
    let bounds = image.low.iter().zip(&image.high);
    let encodings = image.channels.iter().cycle();
    let codes = image.actual.iter().zip(bounds).zip(encodings);
    let clamped = |((actual, (low, high)), encoding): ((&u32, (&u32, &u32)), &ChannelEncoding)| {
        let order = |code: &u32| encoding.order_of_code(*code);
        if encoding.is_nan(*actual) || order(actual) < order(low) {
            *low
        } else if order(actual) > order(high) {
            *high
        } else {
            *actual
        }
    };
    codes.map(clamped).collect()
}

fn title(image: &FrameImage) -> String {
    let [width, height] = image.size;
    let samples = match image.samples {
        1 => String::new(),
        n => format!(", {n} samples"),
    };
    let aspect = image.aspect.name();
    let name = if image.attachment == aspect {
        aspect.to_owned()
    } else {
        format!("{} ({aspect})", image.attachment)
    };
    format!("{name}: {width}×{height}{samples}, {}", image.channels[0])
}

/// Returns the side of a texel on the page, in pixels: a multiple of [`BLOCK`] if it is larger than a block.
fn scale(window: TexelWindow, samples: u32) -> u32 {
    let longest = window.width.max(window.height).max(1);
    let wide = (window.width * samples).max(1);
    let scale = match samples {
        1 => TARGET.div_ceil(longest),
        _ => (WIDEST / wide).clamp(1, TARGET.div_ceil(longest)),
    };
    if scale > BLOCK {
        scale.next_multiple_of(BLOCK)
    } else {
        scale
    }
}

fn window(image: &FrameImage) -> TexelWindow {
    let [width, height] = image.size;
    let first = image.wrong.iter().position(|w| *w != FrameImage::FINE);
    let texel = (first.unwrap_or(0) as u64 / u64::from(image.samples.max(1))) as u32;
    let (x, y) = (texel % width.max(1), texel / width.max(1));
    let start = |center: u32, size: u32| {
        center
            .saturating_sub(WINDOW / 2)
            .min(size.saturating_sub(WINDOW))
    };
    TexelWindow {
        x: start(x, width),
        y: start(y, height),
        width: width.min(WINDOW),
        height: height.min(WINDOW),
    }
}

/// Returns the values of black and white. Stencil values are small numbers in a large range, so grey spans
/// the values that occur.
fn range(image: &FrameImage) -> [f64; 2] {
    let ChannelEncoding::Uint(_) = image.channels[0] else {
        return [0.0, 1.0];
    };
    let full = |low: u32, high: u32| {
        let e = image.channels[0];
        (e.order_of_code(low), e.order_of_code(high)) == (e.min_order(), e.max_order())
    };
    let allowed = image.low.iter().zip(&image.high);
    let values = allowed
        .filter(|(low, high)| !full(**low, **high))
        .flat_map(|(low, high)| [*low, *high])
        .chain(image.actual.iter().copied());
    let (mut least, mut most) = (u32::MAX, 0);
    for value in values {
        least = least.min(value);
        most = most.max(value);
    }
    [f64::from(least), f64::from(most)]
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Alpha {
    None,
    One(u32),
    Varies,
}

fn alpha(image: &FrameImage) -> Alpha {
    if image.aspect != Aspect::Color || image.channels.len() < 4 {
        return Alpha::None;
    }
    let first = image.actual[3];
    let n = image.channels.len();
    let images = [&image.low, &image.high, &image.actual];
    let same = images
        .iter()
        .all(|codes| codes.iter().skip(3).step_by(n).all(|c| *c == first));
    if same {
        Alpha::One(first)
    } else {
        Alpha::Varies
    }
}

/// The channels of a texel that a picture shows.
#[derive(Clone, Copy)]
enum ShownChannels {
    Rgb,
    Grey(usize),
}

impl<'a> PictureView<'a> {
    /// Returns the view of an image, or `None` if its lists do not fit its size.
    fn of(image: &'a FrameImage) -> Option<Self> {
        if !image.is_whole() || image.wrong.is_empty() || image.channels.is_empty() {
            return None;
        }
        let window = window(image);
        Some(Self {
            image,
            window,
            scale: scale(window, image.samples),
            range: range(image),
        })
    }

    fn value(&self, codes: &[u32], sample: usize, channel: usize) -> u8 {
        let Some(encoding) = self.image.channels.get(channel) else {
            return 0;
        };
        let code = codes[sample * self.image.channels.len() + channel];
        if encoding.is_nan(code) {
            return 0;
        }
        let value = encoding.value_of_order(encoding.order_of_code(code));
        let [low, high] = self.range;
        let t = if high > low {
            (value - low) / (high - low)
        } else {
            0.0
        };
        (t.clamp(0.0, 1.0) * 255.0).round() as u8
    }

    /// Draws the allowed codes, and stripes of the lowest and the highest ones where they differ much.
    fn allowed(&self, label: String, nearest: &[u32], look: ShownChannels) -> Option<PagePicture> {
        let image = self.image;
        let ends = |sample| [&image.low, &image.high].map(|codes| self.texel(codes, sample, look));
        let is_wide = |sample| {
            let [low, high] = ends(sample);
            let wide = low
                .iter()
                .zip(high)
                .any(|(low, high)| low.abs_diff(high) > STRIPED);
            wide.then_some([low, high])
        };
        if !(0..image.wrong.len()).any(|sample| is_wide(sample).is_some()) {
            return self.plain(label, nearest, look);
        }
        self.draw(label, self.scale.min(BLOCK), |sample, x, y| {
            let stripe = ((x + y) / 2 % 2) as usize;
            let striped = is_wide(sample).map(|ends| ends[stripe]);
            striped.unwrap_or_else(|| self.texel(nearest, sample, look))
        })
    }

    /// Draws one pixel per sample. Each sample of the texels has a separate tile, side by side.
    fn plain(&self, label: String, codes: &[u32], look: ShownChannels) -> Option<PagePicture> {
        self.draw(label, 1, |sample, _, _| self.texel(codes, sample, look))
    }

    fn texel(&self, codes: &[u32], sample: usize, look: ShownChannels) -> [u8; 3] {
        match look {
            ShownChannels::Rgb => [0, 1, 2].map(|c| self.value(codes, sample, c)),
            ShownChannels::Grey(channel) => [self.value(codes, sample, channel); 3],
        }
    }

    /// Draws blocks of pixels, so that a wrong texel can show a mark.
    fn difference(&self) -> Option<PagePicture> {
        let block = self.scale.min(BLOCK);
        // The pixels of a row come sample by sample, so the last distance can be reused.
        let mut last = (usize::MAX, 0.0);
        self.draw("difference".to_owned(), block, |sample, x, y| {
            let (base, mark) = match self.image.wrong[sample] {
                FrameImage::FINE => return FINE,
                FrameImage::IMPRECISE => {
                    // The mark is a dot.
                    let inside = |v: u32| v * 2 + 2 >= block && v * 2 <= block;
                    (IMPRECISE, inside(x) && inside(y))
                }
                _ => {
                    // The mark is a cross.
                    let edge = x == 0 || y == 0 || x == block - 1 || y == block - 1;
                    (FAIL, !edge && (x == y || x + y == block - 1))
                }
            };
            if mark && block >= 5 {
                return [255; 3];
            }
            if last.0 != sample {
                last = (sample, self.distance(sample));
            }
            let bright = 0.4 + 0.6 * last.1;
            base.map(|c| (f64::from(c) * bright).round() as u8)
        })
    }

    /// Returns the distance of a sample from the allowed range, in codes on a logarithmic scale from 0 to 1.
    fn distance(&self, sample: usize) -> f64 {
        let n = self.image.channels.len();
        let channel = |(i, e): (usize, &ChannelEncoding)| {
            let index = sample * n + i;
            let low = e.order_of_code(self.image.low[index]);
            let high = e.order_of_code(self.image.high[index]);
            let actual = e.order_of_code(self.image.actual[index]);
            let codes = (low - actual).max(actual - high).max(0) as f64;
            let most = (e.max_order() - e.min_order()) as f64;
            (1.0 + codes).log2() / (1.0 + most).log2()
        };
        let channels = self.image.channels.iter().enumerate().map(channel);
        channels.fold(0.0, f64::max).min(1.0)
    }

    /// Draws a picture of `block`² pixels per sample with a gap between the samples' tiles.
    fn draw(
        &self,
        label: String,
        block: u32,
        pixel: impl FnMut(usize, u32, u32) -> [u8; 3],
    ) -> Option<PagePicture> {
        let Canvas {
            pixels,
            width,
            height,
        } = self.canvas(block, pixel);
        let enlarge = self.scale / block;
        Some(PagePicture {
            label,
            uri: uri(&pixels, width, height)?,
            size: [width * enlarge, height * enlarge],
        })
    }

    fn canvas(&self, block: u32, mut pixel: impl FnMut(usize, u32, u32) -> [u8; 3]) -> Canvas {
        let w = self.window;
        let samples = self.image.samples;
        let gap = if samples > 1 { block } else { 0 };
        let tile = w.width * block + gap;
        let (width, height) = (tile * samples - gap, w.height * block);
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for py in 0..height {
            for px in 0..width {
                let (sample, x) = (px / tile, px % tile);
                if x >= w.width * block {
                    pixels.push([0; 4]);
                    continue;
                }
                let texel = u64::from(w.y + py / block) * u64::from(self.image.size[0])
                    + u64::from(w.x + x / block);
                let index = texel * u64::from(samples) + u64::from(sample);
                let [r, g, b] = pixel(index as usize, x % block, py % block);
                pixels.push([r, g, b, 255]);
            }
        }
        Canvas {
            pixels,
            width,
            height,
        }
    }

    /// Returns a picture as a PNG file with a ring around a sample.
    fn ringed(
        &self,
        [x, y, sample]: [u32; 3],
        pixel: impl FnMut(usize, u32, u32) -> [u8; 3],
    ) -> Option<Vec<u8>> {
        let block = self.scale.max(4);
        let mut canvas = self.canvas(block, pixel);
        let w = self.window;
        let tile = w.width * block + if self.image.samples > 1 { block } else { 0 };
        let left = sample * tile + x.checked_sub(w.x)? * block;
        let top = y.checked_sub(w.y)? * block;
        // White inside the texel and black around it, so one of them is visible on any colour.
        canvas.frame(i64::from(left), i64::from(top), i64::from(block), [255; 4]);
        canvas.frame(
            i64::from(left) - 1,
            i64::from(top) - 1,
            i64::from(block) + 2,
            [0, 0, 0, 255],
        );
        png(&canvas.pixels, canvas.width, canvas.height)
    }

    fn caption(&self, same: bool, alpha: Alpha) -> String {
        let image = self.image;
        let [low, high] = self.range;
        let mut text = match image.aspect {
            Aspect::Color => "Colours are opaque, 0 to 1, without a transfer function.".to_owned(),
            Aspect::Depth => "Black is depth 0, white is depth 1.".to_owned(),
            Aspect::Stencil => format!("Black is {low}, white is {high}."),
        };
        match alpha {
            Alpha::None => {}
            Alpha::One(code) => {
                let value = crate::words::value_text(image.channels[3], code);
                text += &format!(" Alpha is {value} everywhere.");
            }
            Alpha::Varies => text.push_str(" Alpha has grey pictures of its own."),
        }
        if same {
            text.push_str(" Exactly one code is allowed everywhere.");
        }
        if image.samples > 1 {
            text.push_str(" Samples lie side by side.");
        }
        let [width, height] = image.size;
        if (self.window.width, self.window.height) != (width, height) {
            let TexelWindow { x, y, .. } = self.window;
            text += &format!(" Only the part from texel ({x}, {y}) is shown.");
        }
        text
    }
}

/// Small pictures of images. An equal picture is compressed once: many cases share theirs.
#[derive(Debug, Default)]
pub struct Thumbnails {
    made: Mutex<HashMap<Runs, String>>,
}

/// The size of a picture, and its pixels with the number of times that each is repeated.
type Runs = ([u32; 2], Vec<([u8; 4], u32)>);

impl Thumbnails {
    /// Returns a picture of an image as a `data:` URL. Colour is shown as stored, without a transfer function;
    /// depth and stencil are grey; several samples are averaged. Empty if the image cannot be shown.
    pub fn uri(&self, image: &Image) -> String {
        let Some((pixels, size)) = pixels(image) else {
            return String::new();
        };
        let mut runs: Vec<([u8; 4], u32)> = Vec::new();
        for pixel in &pixels {
            match runs.last_mut() {
                Some((last, times)) if last == pixel => *times += 1,
                _ => runs.push((*pixel, 1)),
            }
        }
        let key = (size, runs);
        let made = self
            .made
            .lock()
            .ok()
            .and_then(|made| made.get(&key).cloned());
        if let Some(uri) = made {
            return uri;
        }
        let uri = uri(&pixels, size[0], size[1]).unwrap_or_default();
        if let Ok(mut made) = self.made.lock() {
            made.insert(key, uri.clone());
        }
        uri
    }
}

/// Returns the same picture as a PNG file, with each texel as a block of pixels.
pub(crate) fn enlarged(image: &Image) -> Option<Vec<u8>> {
    let (pixels, [width, height]) = pixels(image)?;
    let block = (512 / width.max(height).max(1)).clamp(1, 16);
    let (wide, high) = (width * block, height * block);
    let places = (0..high).flat_map(|y| (0..wide).map(move |x| (x / block, y / block)));
    let pixels: Vec<[u8; 4]> = places
        .map(|(x, y)| pixels[(y * width + x) as usize])
        .collect();
    png(&pixels, wide, high)
}

fn pixels(image: &Image) -> Option<(Vec<[u8; 4]>, [u32; 2])> {
    let channels = image.channels.len();
    if channels == 0 || image.samples == 0 || image.codes.len() != image.expected_len() {
        return None;
    }
    // Stencil values are small numbers in a large range.
    let most = match image.channels[0] {
        ChannelEncoding::Uint(_) => {
            f64::from(image.codes.iter().copied().max().unwrap_or(0)).max(1.0)
        }
        _ => 1.0,
    };
    let decoded = |channel: usize, code: u32| {
        let encoding = image.channels[channel];
        if encoding.is_nan(code) {
            0.0
        } else {
            (encoding.value_of_order(encoding.order_of_code(code)) / most).clamp(0.0, 1.0)
        }
    };
    let value = |codes: &[u32], channel: usize| {
        let samples = codes.chunks_exact(channels);
        let sum: f64 = samples.map(|codes| decoded(channel, codes[channel])).sum();
        (sum / f64::from(image.samples) * 255.0).round() as u8
    };
    let pixel = |codes: &[u32]| match (image.aspect, channels) {
        (Aspect::Color, 3..) => [value(codes, 0), value(codes, 1), value(codes, 2), 255],
        (Aspect::Color, 2) => [value(codes, 0), value(codes, 1), 0, 255],
        _ => {
            let grey = value(codes, 0);
            [grey, grey, grey, 255]
        }
    };
    // Neighbours mostly have the same codes.
    let mut last = (&[][..], [0; 4]);
    let mut pixels = Vec::with_capacity(image.size[0] as usize * image.size[1] as usize);
    for codes in image.codes.chunks_exact(channels * image.samples as usize) {
        if codes != last.0 {
            last = (codes, pixel(codes));
        }
        pixels.push(last.1);
    }
    Some((pixels, image.size))
}

/// Returns the pixels as a `data:` URL, in the smallest suitable PNG format.
fn uri(pixels: &[[u8; 4]], width: u32, height: u32) -> Option<String> {
    let png = png(pixels, width, height)?;
    Some(format!("data:image/png;base64,{}", STANDARD.encode(&png)))
}

fn png(pixels: &[[u8; 4]], width: u32, height: u32) -> Option<Vec<u8>> {
    let opaque = pixels.iter().all(|p| p[3] == 255);
    let grey = pixels.iter().all(|p| p[0] == p[1] && p[1] == p[2]);
    let (bytes, color): (Vec<u8>, _) = match (opaque, grey) {
        (true, true) => (pixels.iter().map(|p| p[0]).collect(), ColorType::Grayscale),
        (true, false) => (
            pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect(),
            ColorType::Rgb,
        ),
        (false, _) => (pixels.concat(), ColorType::Rgba),
    };
    png_file([width, height], color, Compression::High, &bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use maud::Render;

    fn image(samples: u32, size: [u32; 2]) -> FrameImage {
        let n = (size[0] * size[1] * samples) as usize;
        let mut wrong = vec![0; n];
        wrong[n - 1] = FrameImage::FAIL;
        FrameImage {
            attachment: "depth".to_owned(),
            aspect: Aspect::Depth,
            size,
            samples,
            channels: vec![ChannelEncoding::Unorm(16)],
            low: vec![0; n],
            high: vec![65535; n],
            actual: vec![0x8000; n],
            wrong,
        }
    }

    fn decode(picture: &PagePicture) -> image::RgbaImage {
        let data = picture.uri.strip_prefix("data:image/png;base64,").unwrap();
        let bytes = STANDARD.decode(data).unwrap();
        image::load_from_memory(&bytes).unwrap().to_rgba8()
    }

    #[test]
    fn pictures_show_codes_and_mark_wrong_texels() {
        let strip = strip(&image(1, [16, 16])).unwrap();
        let labels: Vec<_> = strip.pictures.iter().map(|p| &*p.label).collect();
        assert_eq!(labels, ["allowed", "drawn", "difference"]);
        let bounds: Vec<_> = strip.more.iter().map(|p| &*p.label).collect();
        assert_eq!(bounds, ["allowed low", "allowed high"]);
        let mut all = strip.pictures.iter().chain(&strip.more);
        assert!(all.all(|p| p.size == [256, 256]));
        let pixel = |picture: &PagePicture, x, y| decode(picture).get_pixel(x, y).0;
        assert_eq!(pixel(&strip.more[0], 0, 0), [0, 0, 0, 255]);
        assert_eq!(pixel(&strip.more[1], 0, 0), [255, 255, 255, 255]);
        assert_eq!(pixel(&strip.pictures[0], 0, 0), [0, 0, 0, 255], "a stripe");
        assert_eq!(pixel(&strip.pictures[0], 2, 0), [255, 255, 255, 255]);
        assert_eq!(pixel(&strip.pictures[1], 0, 0), [128, 128, 128, 255]);
        let difference = |x, y| pixel(&strip.pictures[2], x, y);
        assert_eq!(difference(0, 0)[..3], FINE);
        assert_eq!(difference(124, 124)[..3], [255; 3], "the cross's middle");
        assert_ne!(difference(127, 127)[..3], FINE);
    }

    #[test]
    fn the_wrong_texel_is_marked_and_every_texel_has_its_values() {
        let html = strip(&image(1, [16, 16])).unwrap().render().into_string();
        let ring = "left:93.7500%;top:93.7500%;width:6.2500%;height:6.2500%";
        assert_eq!(html.matches(ring).count(), 5);
        assert!(html.contains("data-window=\"0 0 16 16 1\" data-wrong=\"15 15 0\""));
        assert!(html.contains("data-runs=\"0 255 1 1\""), "{html}");
    }

    #[test]
    fn samples_are_shown_side_by_side_and_large_images_are_cut() {
        let four = strip(&image(4, [16, 16])).unwrap();
        assert_eq!(four.pictures[0].size, [(4 * 17 - 1) * 8, 128]);
        let small = strip(&image(1, [1, 1])).unwrap();
        assert_eq!(small.pictures[2].size, [256, 256]);
        let large = strip(&image(1, [1280, 720])).unwrap();
        assert_eq!(large.pictures[0].size, [2 * WINDOW, 2 * WINDOW]);
        assert!(large.caption.contains("(1152, 592)"), "{}", large.caption);
        let last = decode(&large.pictures[2]).get_pixel(255, 255).0;
        assert_ne!(last[..3], FINE, "the wrong texel is in sight");
    }

    #[test]
    fn images_of_the_wrong_shape_are_refused() {
        let mut short = image(1, [4, 4]);
        short.actual.pop();
        assert!(strip(&short).is_none());
        let mut huge = image(1, [4, 4]);
        huge.size = [u32::MAX, u32::MAX];
        assert!(strip(&huge).is_none());
        assert!(
            strip(&FrameImage {
                size: [0, 0],
                ..image(1, [1, 1])
            })
            .is_none()
        );
    }
}
