//! Wrapping of texture coordinates.

use etalon_scene::AddressMode;

/// Returns the texel at a position of an axis with `size` texels, inside or outside (Vulkan, Texel
/// Coordinate Wrapping; OpenGL 4.6, 8.14.2; WebGPU, GPUAddressMode).
pub fn texel_position(mode: AddressMode, position: i64, size: u32) -> usize {
    let size = i64::from(size.max(1));
    let inside = match mode {
        AddressMode::ClampToEdge => position.clamp(0, size - 1),
        AddressMode::Repeat => position.rem_euclid(size),
        AddressMode::MirrorRepeat => {
            let twice = position.rem_euclid(2 * size);
            twice.min(2 * size - 1 - twice)
        }
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outside_of_a_texture_its_texels_come_back_as_the_mode_says() {
        let positions =
            |mode| -> Vec<usize> { (-5..9).map(|i| texel_position(mode, i, 4)).collect() };
        assert_eq!(
            positions(AddressMode::ClampToEdge),
            [0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3]
        );
        assert_eq!(
            positions(AddressMode::Repeat),
            [3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0]
        );
        assert_eq!(
            positions(AddressMode::MirrorRepeat),
            [3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0]
        );
    }
}
