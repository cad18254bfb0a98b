//! The small picture of a frame in the page's mosaic.

use etalon_frame::{Aspect, ChannelEncoding, Frame, Image};

/// Width and height of a tile, in texels.
const SIDE: usize = 16;

/// Returns red, green and blue of each texel of a tile, row by row from the top: the nearest texels of the frame's
/// first colour image, or of its first image, in grey. Empty if the frame has no image.
pub(crate) fn tile(frame: &Frame) -> Vec<u8> {
    let images = || {
        let is_whole =
            |image: &&Image| !image.codes.is_empty() && image.codes.len() == image.expected_len();
        frame.images.iter().filter(is_whole)
    };
    let color = images().find(|image| image.aspect == Aspect::Color);
    let Some(image) = color.or_else(|| images().next()) else {
        return Vec::new();
    };
    let grey = image.aspect != Aspect::Color;
    let range = range(image);
    let texel = |index: usize| {
        let [x, y] = [index % SIDE, index / SIDE];
        let [width, height] = image.size;
        let nearest = |at: usize, size: u32| ((2 * at + 1) * size as usize / (2 * SIDE)) as u32;
        let codes = image.sample(nearest(x, width), nearest(y, height), 0);
        [0, 1, 2].map(|channel| {
            let channel = if grey { 0 } else { channel };
            match (codes.get(channel), image.channels.get(channel)) {
                (Some(code), Some(encoding)) => byte(value(*encoding, *code), range),
                _ => 0,
            }
        })
    };
    (0..SIDE * SIDE).flat_map(texel).collect()
}

/// Returns the values that are shown as 0 and as 255: 0 and the largest value of an image of integers, or 0 and 1.
fn range(image: &Image) -> [f64; 2] {
    let is_integer = |e: &ChannelEncoding| matches!(e, ChannelEncoding::Uint(_));
    if !image.channels.iter().all(is_integer) {
        return [0.0, 1.0];
    }
    let most = image.codes.iter().max().copied().unwrap_or(0);
    [0.0, f64::from(most.max(1))]
}

fn value(encoding: ChannelEncoding, code: u32) -> f64 {
    if encoding.is_nan(code) {
        0.0
    } else {
        encoding.value_of_order(encoding.order_of_code(code))
    }
}

fn byte(value: f64, [low, high]: [f64; 2]) -> u8 {
    (((value - low) / (high - low)).clamp(0.0, 1.0) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::ReadPath;

    fn image(aspect: Aspect, size: [u32; 2], channels: usize, codes: Vec<u32>) -> Image {
        let encoding = match aspect {
            Aspect::Stencil => ChannelEncoding::Uint(8),
            _ => ChannelEncoding::Unorm(8),
        };
        Image {
            attachment: "image".to_owned(),
            aspect,
            size,
            samples: 1,
            channels: vec![encoding; channels],
            read: ReadPath::Copy,
            codes,
        }
    }

    #[test]
    fn a_tile_shows_the_first_color_image() {
        let depth = image(Aspect::Depth, [1, 1], 1, vec![255]);
        let color = image(Aspect::Color, [2, 1], 4, vec![255, 0, 0, 255, 0, 0, 255, 0]);
        let frame = Frame {
            images: vec![depth, color],
            counters: Vec::new(),
        };
        let tile = tile(&frame);
        assert_eq!(tile.len(), 3 * SIDE * SIDE);
        assert_eq!(tile[..3], [255, 0, 0]);
        assert_eq!(tile[3 * SIDE - 3..3 * SIDE], [0, 0, 255]);
    }

    #[test]
    fn a_tile_of_stencil_spans_the_values_that_occur() {
        let stencil = image(Aspect::Stencil, [1, 2], 1, vec![0, 4]);
        let frame = Frame {
            images: vec![stencil],
            counters: Vec::new(),
        };
        let tile = tile(&frame);
        assert_eq!((tile[0], tile[tile.len() - 1]), (0, 255));
    }

    #[test]
    fn a_frame_without_whole_images_has_no_tile() {
        let short = image(Aspect::Color, [2, 2], 4, vec![0; 4]);
        let frame = Frame {
            images: vec![short],
            counters: vec![3],
        };
        assert!(tile(&frame).is_empty());
    }
}
