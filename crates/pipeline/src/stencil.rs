//! Comparisons and stencil operations: exact integers in every specification (Vulkan, Stencil
//! Test; OpenGL 4.6, 17.3.3; WebGPU, stencil state).

use etalon_scene::{CompareFunction, StencilFace, StencilOperation};

/// Returns the result of comparing `incoming` with `stored`.
#[inline(always)]
pub fn compare<T: PartialOrd>(function: CompareFunction, incoming: T, stored: T) -> bool {
    match function {
        CompareFunction::Never => false,
        CompareFunction::Less => incoming < stored,
        CompareFunction::Equal => incoming == stored,
        CompareFunction::LessEqual => incoming <= stored,
        CompareFunction::Greater => incoming > stored,
        CompareFunction::NotEqual => incoming != stored,
        CompareFunction::GreaterEqual => incoming >= stored,
        CompareFunction::Always => true,
    }
}

/// Returns true if a stored value passes the stencil test.
#[inline(always)]
pub fn stencil_passes(face: &StencilFace, stored: u8) -> bool {
    compare(
        face.compare,
        face.reference & face.read_mask,
        stored & face.read_mask,
    )
}

/// Returns a stored value after an operation, before the write mask.
#[inline(always)]
pub fn stencil_operation(operation: StencilOperation, stored: u8, reference: u8) -> u8 {
    match operation {
        StencilOperation::Keep => stored,
        StencilOperation::Zero => 0,
        StencilOperation::Replace => reference,
        StencilOperation::Invert => !stored,
        StencilOperation::IncrementClamp => stored.saturating_add(1),
        StencilOperation::DecrementClamp => stored.saturating_sub(1),
        StencilOperation::IncrementWrap => stored.wrapping_add(1),
        StencilOperation::DecrementWrap => stored.wrapping_sub(1),
    }
}

/// Returns the value that is stored after an operation: bits outside the write mask are unchanged.
#[inline(always)]
pub fn stencil_write(face: &StencilFace, operation: StencilOperation, stored: u8) -> u8 {
    let new = stencil_operation(operation, stored, face.reference);
    (stored & !face.write_mask) | (new & face.write_mask)
}

/// Returns the relevant bits of a reference that a shader writes: as many as the attachment has (Vulkan,
/// FragStencilRefEXT; GL_ARB_shader_stencil_export, 3.3.x).
#[inline(always)]
pub fn exported_reference(written: i32) -> u8 {
    written as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamp_and_wrap_differ_only_at_the_ends() {
        use StencilOperation as Op;
        assert_eq!(stencil_operation(Op::IncrementClamp, 255, 7), 255);
        assert_eq!(stencil_operation(Op::IncrementWrap, 255, 7), 0);
        assert_eq!(stencil_operation(Op::DecrementClamp, 0, 7), 0);
        assert_eq!(stencil_operation(Op::DecrementWrap, 0, 7), 255);
        for stored in 1..255 {
            let up = stencil_operation(Op::IncrementClamp, stored, 7);
            assert_eq!(up, stencil_operation(Op::IncrementWrap, stored, 7));
        }
        assert_eq!(stencil_operation(Op::Invert, 0b0110_0001, 7), 0b1001_1110);
        assert_eq!(stencil_operation(Op::Replace, 3, 7), 7);
    }

    #[test]
    fn the_lowest_eight_bits_of_a_written_reference_count() {
        let written = [0, 255, 256, 300, -1, -255, 65535];
        let counted = [0, 255, 0, 44, 255, 1, 255];
        assert_eq!(written.map(exported_reference), counted);
    }

    #[test]
    fn masks_apply_to_both_sides_of_the_test_and_to_the_written_bits() {
        let face = StencilFace {
            compare: CompareFunction::Less,
            fail_op: StencilOperation::Keep,
            depth_fail_op: StencilOperation::Keep,
            pass_op: StencilOperation::Replace,
            read_mask: 0x0f,
            write_mask: 0xf0,
            reference: 0x71,
        };
        assert!(stencil_passes(&face, 0x02));
        assert!(!stencil_passes(&face, 0xf1));
        assert_eq!(stencil_write(&face, face.pass_op, 0x0a), 0x7a);
    }
}
