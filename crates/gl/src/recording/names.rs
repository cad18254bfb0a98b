//! The names of GL's constants, for recorded calls.

use etalon_backend::Constant;

/// Declares a table of names and values.
macro_rules! names {
    ($table:ident: $($name:ident)+) => {
        const $table: &[(&str, u32)] = &[$((concat!("GL_", stringify!($name)), glow::$name)),+];
    };
}

names! { NAMES:
    NEVER LESS EQUAL LEQUAL GREATER NOTEQUAL GEQUAL ALWAYS
    SRC_COLOR ONE_MINUS_SRC_COLOR SRC_ALPHA ONE_MINUS_SRC_ALPHA DST_ALPHA ONE_MINUS_DST_ALPHA DST_COLOR
    ONE_MINUS_DST_COLOR SRC_ALPHA_SATURATE CONSTANT_COLOR ONE_MINUS_CONSTANT_COLOR CONSTANT_ALPHA
    ONE_MINUS_CONSTANT_ALPHA SRC1_ALPHA SRC1_COLOR ONE_MINUS_SRC1_COLOR ONE_MINUS_SRC1_ALPHA
    FUNC_ADD FUNC_SUBTRACT FUNC_REVERSE_SUBTRACT MIN MAX
    KEEP REPLACE INCR DECR INVERT INCR_WRAP DECR_WRAP
    FRONT BACK FRONT_AND_BACK CW CCW
    CULL_FACE DEPTH_TEST STENCIL_TEST BLEND SCISSOR_TEST DITHER POLYGON_OFFSET_FILL POLYGON_OFFSET_LINE
    POLYGON_OFFSET_POINT SAMPLE_ALPHA_TO_COVERAGE SAMPLE_ALPHA_TO_ONE SAMPLE_COVERAGE SAMPLE_MASK
    RASTERIZER_DISCARD DEPTH_CLAMP PRIMITIVE_RESTART PRIMITIVE_RESTART_FIXED_INDEX COLOR_LOGIC_OP MULTISAMPLE
    FRAMEBUFFER_SRGB PROGRAM_POINT_SIZE
    CLEAR AND AND_REVERSE COPY AND_INVERTED NOOP XOR OR NOR EQUIV OR_REVERSE COPY_INVERTED OR_INVERTED NAND SET
    POINT LINE FILL
    BYTE UNSIGNED_BYTE SHORT UNSIGNED_SHORT INT UNSIGNED_INT FLOAT HALF_FLOAT
    UNSIGNED_SHORT_4_4_4_4 UNSIGNED_SHORT_5_5_5_1 UNSIGNED_SHORT_5_6_5 UNSIGNED_INT_2_10_10_10_REV
    UNSIGNED_INT_10F_11F_11F_REV UNSIGNED_INT_24_8 FLOAT_32_UNSIGNED_INT_24_8_REV
    RED RG RGB RGBA RGBA_INTEGER DEPTH_COMPONENT DEPTH_STENCIL STENCIL_INDEX
    R8 RG8 RGBA8 SRGB8_ALPHA8 RGBA8_SNORM RGB10_A2 RGB565 RGB5_A1 RGBA4 R11F_G11F_B10F RGBA8UI RGBA16F RGBA32F
    RGBA32UI DEPTH_COMPONENT16 DEPTH_COMPONENT24 DEPTH24_STENCIL8 DEPTH_COMPONENT32F DEPTH32F_STENCIL8
    STENCIL_INDEX8
    ARRAY_BUFFER ELEMENT_ARRAY_BUFFER UNIFORM_BUFFER SHADER_STORAGE_BUFFER DRAW_INDIRECT_BUFFER
    STREAM_DRAW STATIC_DRAW DYNAMIC_DRAW
    FRAMEBUFFER READ_FRAMEBUFFER DRAW_FRAMEBUFFER RENDERBUFFER
    COLOR_ATTACHMENT0 COLOR_ATTACHMENT1 COLOR_ATTACHMENT2 COLOR_ATTACHMENT3 COLOR_ATTACHMENT4 COLOR_ATTACHMENT5
    COLOR_ATTACHMENT6 COLOR_ATTACHMENT7 DEPTH_ATTACHMENT STENCIL_ATTACHMENT DEPTH_STENCIL_ATTACHMENT
    COLOR DEPTH STENCIL
    TEXTURE_2D TEXTURE_3D TEXTURE_2D_ARRAY TEXTURE_2D_MULTISAMPLE TEXTURE_CUBE_MAP
    TEXTURE_CUBE_MAP_POSITIVE_X TEXTURE_CUBE_MAP_NEGATIVE_X TEXTURE_CUBE_MAP_POSITIVE_Y
    TEXTURE_CUBE_MAP_NEGATIVE_Y TEXTURE_CUBE_MAP_POSITIVE_Z TEXTURE_CUBE_MAP_NEGATIVE_Z
    TEXTURE0 TEXTURE1 TEXTURE2 TEXTURE3
    TEXTURE_MIN_FILTER TEXTURE_MAG_FILTER TEXTURE_WRAP_S TEXTURE_WRAP_T TEXTURE_WRAP_R TEXTURE_BASE_LEVEL
    TEXTURE_MAX_LEVEL DEPTH_STENCIL_TEXTURE_MODE
    NEAREST LINEAR NEAREST_MIPMAP_NEAREST CLAMP_TO_EDGE REPEAT MIRRORED_REPEAT
    PACK_ALIGNMENT UNPACK_ALIGNMENT PACK_ROW_LENGTH PACK_SKIP_PIXELS PACK_SKIP_ROWS
    SAMPLES_PASSED ANY_SAMPLES_PASSED ANY_SAMPLES_PASSED_CONSERVATIVE TIME_ELAPSED FRAGMENT_SHADER_INVOCATIONS
    QUERY_RESULT
    VERTEX_SHADER FRAGMENT_SHADER TESS_CONTROL_SHADER TESS_EVALUATION_SHADER
    LOWER_LEFT UPPER_LEFT NEGATIVE_ONE_TO_ONE ZERO_TO_ONE CLAMP_READ_COLOR
    PATCH_VERTICES CLIP_DISTANCE0 CLIP_DISTANCE1
}

names! { PRIMITIVES:
    POINTS LINES LINE_LOOP LINE_STRIP TRIANGLES TRIANGLE_STRIP TRIANGLE_FAN PATCHES
}

names! { BUFFER_BITS: COLOR_BUFFER_BIT DEPTH_BUFFER_BIT STENCIL_BUFFER_BIT }
names! { MAP_BITS: MAP_READ_BIT MAP_WRITE_BIT }
names! { BARRIER_BITS:
    BUFFER_UPDATE_BARRIER_BIT SHADER_STORAGE_BARRIER_BIT FRAMEBUFFER_BARRIER_BIT TEXTURE_FETCH_BARRIER_BIT
    TEXTURE_UPDATE_BARRIER_BIT PIXEL_BUFFER_BARRIER_BIT
}

/// Constants that `glow` lacks.
const EXTENSIONS: &[(&str, u32)] = &[
    ("GL_SAMPLE_SHADING", 0x8C36),
    ("GL_FIRST_VERTEX_CONVENTION", 0x8E4D),
    ("GL_LAST_VERTEX_CONVENTION", 0x8E4E),
    ("GL_MULTIPLY_KHR", 0x9294),
    ("GL_SCREEN_KHR", 0x9295),
    ("GL_OVERLAY_KHR", 0x9296),
    ("GL_DARKEN_KHR", 0x9297),
    ("GL_LIGHTEN_KHR", 0x9298),
    ("GL_COLORDODGE_KHR", 0x9299),
    ("GL_COLORBURN_KHR", 0x929A),
    ("GL_HARDLIGHT_KHR", 0x929B),
    ("GL_SOFTLIGHT_KHR", 0x929C),
    ("GL_DIFFERENCE_KHR", 0x929E),
    ("GL_EXCLUSION_KHR", 0x92A0),
    ("GL_DEPTH_BOUNDS_TEST_EXT", 0x8890),
    ("GL_HSL_HUE_KHR", 0x92AD),
    ("GL_HSL_SATURATION_KHR", 0x92AE),
    ("GL_HSL_COLOR_KHR", 0x92AF),
    ("GL_HSL_LUMINOSITY_KHR", 0x92B0),
];

fn constant_in(table: &[(&str, u32)], value: u32) -> Option<Constant> {
    let name = table.iter().find(|(_, v)| *v == value)?.0.to_owned();
    Some(Constant { name, value })
}

fn nameless(value: u32) -> Constant {
    Constant {
        name: String::new(),
        value,
    }
}

/// Returns a constant whose kind is unknown.
pub(super) fn constant(value: u32) -> Constant {
    constant_in(NAMES, value)
        .or_else(|| constant_in(EXTENSIONS, value))
        .unwrap_or_else(|| nameless(value))
}

/// Returns a constant, or `GL_NONE`.
pub(super) fn or_none(value: u32) -> Constant {
    constant_in(&[("GL_NONE", 0)], value).unwrap_or_else(|| constant(value))
}

/// Returns a blend factor or a stencil operation.
pub(super) fn factor(value: u32) -> Constant {
    constant_in(&[("GL_ZERO", 0), ("GL_ONE", 1)], value).unwrap_or_else(|| constant(value))
}

/// Returns the mode of a draw.
pub(super) fn primitive(value: u32) -> Constant {
    constant_in(PRIMITIVES, value).unwrap_or_else(|| nameless(value))
}

/// Returns the constant that a parameter's value names, if any. Small numbers are not constants.
pub(super) fn parameter(value: i32) -> Option<Constant> {
    let value = u32::try_from(value).ok().filter(|v| *v >= 0x100)?;
    Some(constant(value)).filter(|c| !c.name.is_empty())
}

fn bits(table: &[(&str, u32)], value: u32) -> Vec<Constant> {
    let named = |(name, bit): &(&str, u32)| Constant {
        name: (*name).to_owned(),
        value: *bit,
    };
    let mut bits: Vec<Constant> = table
        .iter()
        .filter(|(_, bit)| value & bit != 0)
        .map(named)
        .collect();
    let rest = bits.iter().fold(value, |rest, bit| rest & !bit.value);
    if rest != 0 || bits.is_empty() {
        bits.push(nameless(rest));
    }
    bits
}

/// Returns the buffer bits of a blit.
pub(super) fn buffer_bits(value: u32) -> Vec<Constant> {
    bits(BUFFER_BITS, value)
}

/// Returns the access bits of a mapped buffer.
pub(super) fn map_bits(value: u32) -> Vec<Constant> {
    bits(MAP_BITS, value)
}

/// Returns the bits of a memory barrier.
pub(super) fn barrier_bits(value: u32) -> Vec<Constant> {
    bits(BARRIER_BITS, value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn no_value_has_two_names() {
        for table in [NAMES, PRIMITIVES, BUFFER_BITS, MAP_BITS, BARRIER_BITS] {
            let mut values = HashSet::new();
            for (name, value) in table {
                assert!(values.insert(value), "{name}");
            }
        }
    }

    #[test]
    fn bits_are_named_and_unknown_ones_are_numbers() {
        let both = glow::COLOR_BUFFER_BIT | glow::STENCIL_BUFFER_BIT;
        let names =
            |value| -> Vec<String> { buffer_bits(value).into_iter().map(|c| c.name).collect() };
        assert_eq!(
            names(both),
            ["GL_COLOR_BUFFER_BIT", "GL_STENCIL_BUFFER_BIT"]
        );
        assert_eq!(names(both | 1).last().map(String::as_str), Some(""));
        assert_eq!(names(0), [""]);
        assert_eq!(parameter(5), None);
        assert_eq!(factor(1).name, "GL_ONE");
    }
}
