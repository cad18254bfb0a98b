//! Logic operations: exact integers (Vulkan, Logical Operations; OpenGL 4.6, 17.3.9).

use etalon_frame::{ChannelEncoding, TextureFormat};
use etalon_scene::LogicOperation;

/// Returns true if logic operations apply to attachments of a format. If one channel is a float or sRGB, all
/// channels store the source unchanged.
pub fn takes_logic(format: TextureFormat) -> bool {
    format
        .color_channels()
        .iter()
        .all(|e| !e.is_float() && *e != ChannelEncoding::Srgb8)
}

/// Returns the code that an operation stores. Float and sRGB encodings store the source unchanged.
#[inline(always)]
pub fn logic_operation(
    encoding: ChannelEncoding,
    operation: LogicOperation,
    s: u32,
    d: u32,
) -> u32 {
    if encoding.is_float() || encoding == ChannelEncoding::Srgb8 {
        return s;
    }
    let result = match operation {
        LogicOperation::Clear => 0,
        LogicOperation::And => s & d,
        LogicOperation::AndReverse => s & !d,
        LogicOperation::Copy => s,
        LogicOperation::AndInverted => !s & d,
        LogicOperation::Noop => d,
        LogicOperation::Xor => s ^ d,
        LogicOperation::Or => s | d,
        LogicOperation::Nor => !(s | d),
        LogicOperation::Equivalent => !(s ^ d),
        LogicOperation::Invert => !d,
        LogicOperation::OrReverse => s | !d,
        LogicOperation::CopyInverted => !s,
        LogicOperation::OrInverted => !s | d,
        LogicOperation::Nand => !(s & d),
        LogicOperation::Set => u32::MAX,
    };
    result & encoding.mask()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The truth table of Vulkan's `VkLogicOp`: bit `2s + d` of each entry, in declaration order.
    #[test]
    fn the_operations_have_their_truth_tables() {
        let tables = [
            0b0000, 0b1000, 0b0100, 0b1100, 0b0010, 0b1010, 0b0110, 0b1110, 0b0001, 0b1001, 0b0101,
            0b1101, 0b0011, 0b1011, 0b0111, 0b1111,
        ];
        assert_eq!(LogicOperation::ALL.len(), tables.len());
        for (operation, table) in LogicOperation::ALL.iter().zip(tables) {
            for (s, d) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let encoding = ChannelEncoding::Unorm(1);
                let result = logic_operation(encoding, *operation, s, d);
                assert_eq!(result, (table >> (2 * s + d)) & 1, "{operation:?} {s} {d}");
            }
        }
    }
}
