//! PNG files.

use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use std::io;

/// Returns a PNG file. `bytes` holds the channels of each texel, a byte each, row by row from the top.
///
/// # Errors
/// If the number of bytes does not match the size, or the size is 0.
pub fn png_file(
    [width, height]: [u32; 2],
    color: ColorType,
    compression: Compression,
    bytes: &[u8],
) -> io::Result<Vec<u8>> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_filter(Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_another_size_is_an_error() {
        let file = |size, bytes: &[u8]| png_file(size, ColorType::Rgb, Compression::Fast, bytes);
        assert!(file([2, 1], &[0; 6]).is_ok());
        assert!(file([2, 1], &[0; 5]).is_err());
        assert!(file([2, 1], &[0; 7]).is_err());
        assert!(file([0, 1], &[]).is_err());
        assert!(file([u32::MAX, u32::MAX], &[0; 6]).is_err());
    }
}
