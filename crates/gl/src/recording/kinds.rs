//! The kinds of arguments that are recorded by value.

use super::names::{
    barrier_bits, buffer_bits, constant, factor, map_bits, or_none, parameter, primitive,
};
use super::recorder::CallPointer;
use etalon_backend::Argument;

/// A kind of argument.
pub(super) trait ArgumentKind {
    /// The argument's type in C.
    type Raw: Copy;
    /// Returns the recorded value.
    fn value(raw: Self::Raw) -> Argument;
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $name:ident($raw:ty): $value:expr;)+) => {
        $(
            $(#[$doc])*
            pub(super) struct $name;

            impl ArgumentKind for $name {
                type Raw = $raw;

                fn value(raw: $raw) -> Argument {
                    let value: fn($raw) -> Argument = $value;
                    value(raw)
                }
            }
        )+
    };
}

fn object(kind: &str, number: u32) -> Argument {
    Argument::Object(kind.to_owned(), u64::from(number))
}

kinds! {
    /// A constant.
    Enum(u32): |v| Argument::Constant(constant(v));
    /// A blend factor or a stencil operation.
    Factor(u32): |v| Argument::Constant(factor(v));
    /// A buffer that is drawn to or read, or `GL_NONE`.
    Draw(u32): |v| Argument::Constant(or_none(v));
    /// The primitive mode of a draw.
    Mode(u32): |v| Argument::Constant(primitive(v));
    /// The buffer bits of a blit.
    Buffers(u32): |v| Argument::Bits(buffer_bits(v));
    /// The access bits of a mapped buffer.
    Access(u32): |v| Argument::Bits(map_bits(v));
    /// The bits of a memory barrier.
    Barriers(u32): |v| Argument::Bits(barrier_bits(v));
    /// The value of a parameter: a constant or a number.
    Parameter(i32): |v| parameter(v).map_or(Argument::Integer(v), Argument::Constant);
    /// A signed number.
    Int(i32): Argument::Integer;
    /// An unsigned number.
    Uint(u32): Argument::Unsigned;
    /// A boolean.
    Bool(u8): |v| Argument::Boolean(v != 0);
    /// A size in bytes, or an offset in a buffer.
    Size(isize): |v| Argument::Size(v as i64);
    /// A float.
    Float(f32): |v| Argument::Float(v.to_bits());
    /// A 64-bit float.
    Double(f64): |v| Argument::Double(v.to_bits());
    /// An offset in the bound buffer.
    Offset(CallPointer): |v| Argument::Offset(v as u64);
    /// A buffer.
    Buffer(u32): |v| object("buffer", v);
    /// A texture.
    Texture(u32): |v| object("texture", v);
    /// A framebuffer.
    Framebuffer(u32): |v| object("framebuffer", v);
    /// A renderbuffer.
    Renderbuffer(u32): |v| object("renderbuffer", v);
    /// A sampler.
    Sampler(u32): |v| object("sampler", v);
    /// A query.
    Query(u32): |v| object("query", v);
    /// A vertex array.
    VertexArray(u32): |v| object("vertex_array", v);
    /// A program.
    Program(u32): |v| object("program", v);
    /// A shader.
    Shader(u32): |v| object("shader", v);
    /// The location of a uniform in its program.
    Location(i32): |v| match u32::try_from(v) {
        Ok(place) => object("location", place + 1),
        Err(_) => Argument::Integer(v),
    };
    /// The index of a uniform block in its program.
    Block(u32): |v| object("block", v.wrapping_add(1));
}
