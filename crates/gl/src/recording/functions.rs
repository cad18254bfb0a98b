//! The functions that are recorded, and the functions that need not be.

use super::kinds::*;
use super::recorder::{CallPointer, announced, driver, keep, keeps, new_output};
use etalon_backend::Argument;
use std::ffi::{CStr, c_char, c_void};

/// Returns true if a function only queries the context, reports messages or deletes objects. It is not
/// recorded.
pub(super) fn only_asks(name: &str) -> bool {
    ["glGet", "glIs", "glDelete", "glDebugMessage"]
        .iter()
        .any(|start| name.starts_with(start))
}

/// Declares functions whose arguments are recorded by value, and lists the functions of [`special`].
macro_rules! functions {
    (
        $($name:ident($($arg:ident: $kind:ident),*) $(-> $result:ident)?;)+
        ;special $($other:ident)+
    ) => {
        /// Functions that call the driver's function and keep the call.
        mod plain {
            use super::*;
            $(
                #[expect(non_snake_case, reason = "the name is the API's")]
                pub(super) unsafe extern "system" fn $name(
                    $($arg: <$kind as ArgumentKind>::Raw),*
                ) $(-> <$result as ArgumentKind>::Raw)? {
                    type Own = unsafe extern "system" fn(
                        $(<$kind as ArgumentKind>::Raw),*
                    ) $(-> <$result as ArgumentKind>::Raw)?;
                    // SAFETY: the backend found this function instead of the driver's, whose address was
                    // kept, and the specification gives the name this type.
                    let own: Own = unsafe { std::mem::transmute(driver(stringify!($name))) };
                    // SAFETY: the caller passed the arguments to a function of this type.
                    let result = unsafe { own($($arg),*) };
                    if keeps() {
                        let made: Option<Argument> = None$(.or(Some($result::value(result))))?;
                        keep(stringify!($name), vec![$($kind::value($arg)),*], made);
                    }
                    result
                }
            )+
        }

        /// Returns the function that records the driver's function of this name, with its name.
        pub(super) fn shim(name: &str) -> Option<(&'static str, CallPointer)> {
            match name {
                $(stringify!($name) => Some((stringify!($name), plain::$name as CallPointer)),)+
                $(stringify!($other) => Some((stringify!($other), special::$other as CallPointer)),)+
                _ => None,
            }
        }
    };
}

functions! {
    glActiveTexture(unit: Enum);
    glAttachShader(program: Program, shader: Shader);
    glBeginQuery(target: Enum, query: Query);
    glBindBuffer(target: Enum, buffer: Buffer);
    glBindBufferBase(target: Enum, index: Uint, buffer: Buffer);
    glBindBufferRange(target: Enum, index: Uint, buffer: Buffer, offset: Size, size: Size);
    glBindFramebuffer(target: Enum, framebuffer: Framebuffer);
    glBindRenderbuffer(target: Enum, renderbuffer: Renderbuffer);
    glBindSampler(unit: Uint, sampler: Sampler);
    glBindTexture(target: Enum, texture: Texture);
    glBindVertexArray(array: VertexArray);
    glBlendBarrier();
    glFramebufferFetchBarrierEXT();
    glTextureBarrier();
    glTextureBarrierNV();
    glBlendBarrierKHR();
    glBlendColor(r: Float, g: Float, b: Float, a: Float);
    glBlendEquation(mode: Enum);
    glBlendEquationSeparate(color: Enum, alpha: Enum);
    glBlendEquationSeparatei(buffer: Uint, color: Enum, alpha: Enum);
    glBlendEquationi(buffer: Uint, mode: Enum);
    glBlendFunc(source: Factor, destination: Factor);
    glBlendFuncSeparate(source: Factor, destination: Factor, source_alpha: Factor, destination_alpha: Factor);
    glBlendFuncSeparatei(
        buffer: Uint, source: Factor, destination: Factor, source_alpha: Factor, destination_alpha: Factor
    );
    glBlendFunci(buffer: Uint, source: Factor, destination: Factor);
    glBlitFramebuffer(
        a: Int, b: Int, c: Int, d: Int, e: Int, f: Int, g: Int, h: Int, mask: Buffers, filter: Enum
    );
    glCheckFramebufferStatus(target: Enum) -> Enum;
    glClampColor(target: Enum, clamp: Uint);
    glClear(buffers: Buffers);
    glClearBufferfi(buffer: Enum, index: Int, depth: Float, stencil: Int);
    glClearColor(r: Float, g: Float, b: Float, a: Float);
    glClearDepth(depth: Double);
    glClearDepthf(depth: Float);
    glClearStencil(stencil: Int);
    glClipControl(origin: Enum, depth: Enum);
    glClipControlEXT(origin: Enum, depth: Enum);
    glColorMask(r: Bool, g: Bool, b: Bool, a: Bool);
    glColorMaski(buffer: Uint, r: Bool, g: Bool, b: Bool, a: Bool);
    glCompileShader(shader: Shader);
    glCreateProgram() -> Program;
    glCreateShader(stage: Enum) -> Shader;
    glCullFace(face: Enum);
    glDepthBoundsEXT(least: Double, most: Double);
    glDepthFunc(compare: Enum);
    glDepthMask(write: Bool);
    glDepthRange(near: Double, far: Double);
    glDepthRangef(near: Float, far: Float);
    glDisable(capability: Enum);
    glDisablei(capability: Enum, index: Uint);
    glDrawArrays(mode: Mode, first: Int, count: Int);
    glDrawArraysIndirect(mode: Mode, offset: Offset);
    glDrawArraysInstanced(mode: Mode, first: Int, count: Int, instances: Int);
    glDrawArraysInstancedBaseInstance(mode: Mode, first: Int, count: Int, instances: Int, base: Uint);
    glDrawArraysInstancedBaseInstanceEXT(mode: Mode, first: Int, count: Int, instances: Int, base: Uint);
    glDrawElements(mode: Mode, count: Int, kind: Enum, offset: Offset);
    glDrawElementsBaseVertex(mode: Mode, count: Int, kind: Enum, offset: Offset, base: Int);
    glDrawElementsBaseVertexEXT(mode: Mode, count: Int, kind: Enum, offset: Offset, base: Int);
    glDrawElementsBaseVertexOES(mode: Mode, count: Int, kind: Enum, offset: Offset, base: Int);
    glDrawElementsIndirect(mode: Mode, kind: Enum, offset: Offset);
    glDrawElementsInstanced(mode: Mode, count: Int, kind: Enum, offset: Offset, instances: Int);
    glDrawElementsInstancedBaseVertex(
        mode: Mode, count: Int, kind: Enum, offset: Offset, instances: Int, base: Int
    );
    glDrawElementsInstancedBaseVertexEXT(
        mode: Mode, count: Int, kind: Enum, offset: Offset, instances: Int, base: Int
    );
    glDrawElementsInstancedBaseVertexOES(
        mode: Mode, count: Int, kind: Enum, offset: Offset, instances: Int, base: Int
    );
    glDrawElementsInstancedBaseVertexBaseInstance(
        mode: Mode, count: Int, kind: Enum, offset: Offset, instances: Int, base: Int, first: Uint
    );
    glDrawElementsInstancedBaseVertexBaseInstanceEXT(
        mode: Mode, count: Int, kind: Enum, offset: Offset, instances: Int, base: Int, first: Uint
    );
    glEnable(capability: Enum);
    glEnableVertexAttribArray(attribute: Uint);
    glEnablei(capability: Enum, index: Uint);
    glEndQuery(target: Enum);
    glFinish();
    glFlush();
    glFramebufferRenderbuffer(target: Enum, point: Enum, kind: Enum, renderbuffer: Renderbuffer);
    glFramebufferTexture(target: Enum, point: Enum, texture: Texture, level: Int);
    glFramebufferTexture2D(target: Enum, point: Enum, kind: Enum, texture: Texture, level: Int);
    glFramebufferTextureLayer(target: Enum, point: Enum, texture: Texture, level: Int, layer: Int);
    glFrontFace(winding: Enum);
    glLineWidth(width: Float);
    glLinkProgram(program: Program);
    glLogicOp(operation: Enum);
    glMemoryBarrier(barriers: Barriers);
    glMinSampleShading(share: Float);
    glMinSampleShadingARB(share: Float);
    glMinSampleShadingOES(share: Float);
    glMultiDrawArraysIndirectCount(mode: Mode, offset: Offset, count: Size, most: Int, stride: Int);
    glMultiDrawArraysIndirectCountARB(mode: Mode, offset: Offset, count: Size, most: Int, stride: Int);
    glMultiDrawElementsIndirectCount(mode: Mode, kind: Enum, offset: Offset, count: Size, most: Int, stride: Int);
    glMultiDrawElementsIndirectCountARB(mode: Mode, kind: Enum, offset: Offset, count: Size, most: Int, stride: Int);
    glPatchParameteri(name: Enum, value: Int);
    glPixelStorei(name: Enum, value: Int);
    glPolygonMode(face: Enum, mode: Enum);
    glPolygonOffset(factor: Float, units: Float);
    glPolygonOffsetClamp(factor: Float, units: Float, clamp: Float);
    glPolygonOffsetClampEXT(factor: Float, units: Float, clamp: Float);
    glPrimitiveRestartIndex(index: Uint);
    glProvokingVertex(convention: Enum);
    glProvokingVertexANGLE(convention: Enum);
    glReadBuffer(buffer: Draw);
    glRenderbufferStorage(target: Enum, format: Enum, width: Int, height: Int);
    glRenderbufferStorageMultisample(target: Enum, samples: Int, format: Enum, width: Int, height: Int);
    glSampleCoverage(share: Float, invert: Bool);
    glSampleMaski(word: Uint, mask: Uint);
    glSamplerParameteri(sampler: Sampler, name: Enum, value: Parameter);
    glScissor(x: Int, y: Int, width: Int, height: Int);
    glStencilFunc(compare: Enum, reference: Int, mask: Uint);
    glStencilFuncSeparate(face: Enum, compare: Enum, reference: Int, mask: Uint);
    glStencilMask(mask: Uint);
    glStencilMaskSeparate(face: Enum, mask: Uint);
    glStencilOp(fail: Factor, depth_fail: Factor, pass: Factor);
    glStencilOpSeparate(face: Enum, fail: Factor, depth_fail: Factor, pass: Factor);
    glTexImage2DMultisample(
        target: Enum, samples: Int, format: Enum, width: Int, height: Int, fixed: Bool
    );
    glTexParameteri(target: Enum, name: Enum, value: Parameter);
    glTexStorage2D(target: Enum, levels: Int, format: Enum, width: Int, height: Int);
    glTexStorage2DMultisample(
        target: Enum, samples: Int, format: Enum, width: Int, height: Int, fixed: Bool
    );
    glTexStorage3D(target: Enum, levels: Int, format: Enum, width: Int, height: Int, depth: Int);
    glTextureView(
        texture: Texture, target: Enum, viewed: Texture, format: Enum, level: Uint, levels: Uint, layer: Uint,
        layers: Uint
    );
    glTextureViewEXT(
        texture: Texture, target: Enum, viewed: Texture, format: Enum, level: Uint, levels: Uint, layer: Uint,
        layers: Uint
    );
    glTextureViewOES(
        texture: Texture, target: Enum, viewed: Texture, format: Enum, level: Uint, levels: Uint, layer: Uint,
        layers: Uint
    );
    glUniform1i(location: Location, value: Int);
    glUniformBlockBinding(program: Program, block: Block, binding: Uint);
    glUnmapBuffer(target: Enum) -> Bool;
    glUseProgram(program: Program);
    glVertexAttribDivisor(attribute: Uint, divisor: Uint);
    glVertexAttribIPointer(attribute: Uint, size: Int, kind: Enum, stride: Int, offset: Offset);
    glVertexAttribPointer(
        attribute: Uint, size: Int, kind: Enum, normalized: Bool, stride: Int, offset: Offset
    );
    glViewport(x: Int, y: Int, width: Int, height: Int);
    glViewportIndexedf(index: Uint, x: Float, y: Float, width: Float, height: Float);
    glViewportIndexedfOES(index: Uint, x: Float, y: Float, width: Float, height: Float);

    ;special
    glBufferData glBufferSubData glClearBufferfv glClearBufferiv glClearBufferuiv glCopyImageSubData
    glDepthRangeArrayv glDrawBuffers glGenBuffers glGenFramebuffers glGenQueries glGenRenderbuffers glGenSamplers
    glGenTextures glGenVertexArrays glGetQueryObjectui64v glGetQueryObjectui64vEXT glGetQueryObjectuiv
    glGetUniformBlockIndex glGetUniformLocation glInvalidateFramebuffer glInvalidateSubFramebuffer
    glMapBufferRange glReadPixels
    glScissorArrayv glShaderSource glTexImage2D glTexImage3D glTexSubImage2D glTexSubImage3D glViewportArrayv
}

/// Functions that have addresses among their arguments.
mod special {
    #![expect(non_snake_case, reason = "the names are the API's")]

    use super::*;

    /// Calls the driver's function.
    macro_rules! own {
        ($name:ident($($arg:ident: $kind:ty),*) $(-> $result:ty)?) => {{
            type Own = unsafe extern "system" fn($($kind),*) $(-> $result)?;
            // SAFETY: the backend found this function instead of the driver's, whose address was kept, and
            // the specification gives the name this type.
            let own: Own = unsafe { std::mem::transmute(driver(stringify!($name))) };
            // SAFETY: the caller passed the arguments to a function of this type.
            unsafe { own($($arg),*) }
        }};
    }

    /// Returns the values at an address, or none if it is null.
    ///
    /// # Safety
    /// The address is null, or points to `count` values.
    unsafe fn values<T: Copy>(address: *const T, count: usize) -> Vec<T> {
        if address.is_null() {
            return Vec::new();
        }
        // SAFETY: upheld by the caller.
        unsafe { std::slice::from_raw_parts(address, count) }.to_vec()
    }

    /// Returns the bytes at an address, or the null argument if it is null.
    ///
    /// # Safety
    /// As for [`values`].
    unsafe fn bytes(address: *const c_void, count: usize) -> Argument {
        if address.is_null() {
            return Argument::Null;
        }
        // SAFETY: upheld by the caller.
        Argument::Bytes(unsafe { values(address.cast::<u8>(), count) })
    }

    macro_rules! generators {
        ($($name:ident: $kind:literal;)+) => {
            $(
                pub(super) unsafe extern "system" fn $name(count: i32, names: *mut u32) {
                    own!($name(count: i32, names: *mut u32));
                    if keeps() {
                        // SAFETY: the driver wrote `count` names.
                        let made = unsafe { values(names.cast_const(), count.max(0) as usize) };
                        let made = made.into_iter().map(u64::from).collect();
                        let arguments = vec![
                            Int::value(count),
                            Argument::Created($kind.to_owned(), made),
                        ];
                        keep(stringify!($name), arguments, None);
                    }
                }
            )+
        };
    }

    generators! {
        glGenBuffers: "buffer";
        glGenFramebuffers: "framebuffer";
        glGenQueries: "query";
        glGenRenderbuffers: "renderbuffer";
        glGenSamplers: "sampler";
        glGenTextures: "texture";
        glGenVertexArrays: "vertex_array";
    }

    macro_rules! arrays {
        ($($name:ident($($arg:ident: $kind:ident),*; $element:ident: $count:expr);)+) => {
            $(
                pub(super) unsafe extern "system" fn $name(
                    $($arg: <$kind as ArgumentKind>::Raw,)* all: *const <$element as ArgumentKind>::Raw,
                ) {
                    own!($name($($arg: <$kind as ArgumentKind>::Raw,)* all: *const <$element as ArgumentKind>::Raw));
                    if keeps() {
                        // SAFETY: the specification gives the number of values.
                        let all = unsafe { values(all, $count as usize) };
                        let all = all.into_iter().map($element::value).collect();
                        keep(stringify!($name), vec![$($kind::value($arg),)* Argument::Array(all)], None);
                    }
                }
            )+
        };
    }

    /// Returns the number of values that `glClearBuffer*` reads.
    fn of_clear(buffer: u32) -> usize {
        if buffer == glow::COLOR { 4 } else { 1 }
    }

    arrays! {
        glClearBufferfv(buffer: Enum, index: Int; Float: of_clear(buffer));
        glClearBufferiv(buffer: Enum, index: Int; Int: of_clear(buffer));
        glClearBufferuiv(buffer: Enum, index: Int; Uint: of_clear(buffer));
        glDepthRangeArrayv(first: Uint, count: Int; Double: 2 * count);
        glDrawBuffers(count: Int; Draw: count);
        glInvalidateFramebuffer(target: Enum, count: Int; Enum: count);
        glScissorArrayv(first: Uint, count: Int; Int: 4 * count);
        glViewportArrayv(first: Uint, count: Int; Float: 4 * count);
    }

    pub(super) unsafe extern "system" fn glInvalidateSubFramebuffer(
        target: u32,
        count: i32,
        points: *const u32,
        x: i32,
        y: i32,
        width: i32,
        height: i32,
    ) {
        own!(glInvalidateSubFramebuffer(
            target: u32, count: i32, points: *const u32, x: i32, y: i32, width: i32, height: i32
        ));
        if keeps() {
            // SAFETY: the caller passed `count` points.
            let points = unsafe { values(points, count.max(0) as usize) };
            let mut arguments = vec![
                Enum::value(target),
                Int::value(count),
                Argument::Array(points.into_iter().map(Enum::value).collect()),
            ];
            arguments.extend([x, y, width, height].map(Int::value));
            keep("glInvalidateSubFramebuffer", arguments, None);
        }
    }

    pub(super) unsafe extern "system" fn glBufferData(
        target: u32,
        size: isize,
        data: CallPointer,
        usage: u32,
    ) {
        own!(glBufferData(target: u32, size: isize, data: CallPointer, usage: u32));
        if keeps() {
            // SAFETY: the caller's data has this size.
            let data = unsafe { bytes(data, size.max(0) as usize) };
            let arguments = vec![
                Enum::value(target),
                Size::value(size),
                data,
                Enum::value(usage),
            ];
            keep("glBufferData", arguments, None);
        }
    }

    pub(super) unsafe extern "system" fn glBufferSubData(
        target: u32,
        offset: isize,
        size: isize,
        data: CallPointer,
    ) {
        own!(glBufferSubData(target: u32, offset: isize, size: isize, data: CallPointer));
        if keeps() {
            // SAFETY: the caller's data has this size.
            let data = unsafe { bytes(data, size.max(0) as usize) };
            let arguments = vec![
                Enum::value(target),
                Size::value(offset),
                Size::value(size),
                data,
            ];
            keep("glBufferSubData", arguments, None);
        }
    }

    /// Returns the image that a copy names: a renderbuffer or a texture.
    fn copied(name: u32, target: u32) -> Argument {
        match target {
            glow::RENDERBUFFER => Renderbuffer::value(name),
            _ => Texture::value(name),
        }
    }

    pub(super) unsafe extern "system" fn glCopyImageSubData(
        from: u32,
        from_target: u32,
        from_level: i32,
        from_x: i32,
        from_y: i32,
        from_z: i32,
        to: u32,
        to_target: u32,
        to_level: i32,
        to_x: i32,
        to_y: i32,
        to_z: i32,
        width: i32,
        height: i32,
        depth: i32,
    ) {
        own!(glCopyImageSubData(
            from: u32, from_target: u32, from_level: i32, from_x: i32, from_y: i32, from_z: i32,
            to: u32, to_target: u32, to_level: i32, to_x: i32, to_y: i32, to_z: i32,
            width: i32, height: i32, depth: i32
        ));
        if keeps() {
            let mut arguments = vec![copied(from, from_target), Enum::value(from_target)];
            arguments.extend([from_level, from_x, from_y, from_z].map(Int::value));
            arguments.extend([copied(to, to_target), Enum::value(to_target)]);
            arguments.extend([to_level, to_x, to_y, to_z, width, height, depth].map(Int::value));
            keep("glCopyImageSubData", arguments, None);
        }
    }

    macro_rules! queries {
        ($($name:ident: $result:ty;)+) => {
            $(
                pub(super) unsafe extern "system" fn $name(query: u32, name: u32, result: *mut $result) {
                    own!($name(query: u32, name: u32, result: *mut $result));
                    if keeps() {
                        let output = new_output(size_of::<$result>() as u64);
                        let arguments = vec![Query::value(query), Enum::value(name), output];
                        keep(stringify!($name), arguments, None);
                    }
                }
            )+
        };
    }

    queries! {
        glGetQueryObjectui64v: u64;
        glGetQueryObjectui64vEXT: u64;
        glGetQueryObjectuiv: u32;
    }

    /// Returns the string at an address.
    ///
    /// # Safety
    /// The address points to a zero-terminated string.
    unsafe fn text(address: *const c_char) -> Argument {
        // SAFETY: upheld by the caller.
        let text = unsafe { CStr::from_ptr(address) };
        Argument::Text(text.to_string_lossy().into_owned())
    }

    pub(super) unsafe extern "system" fn glGetUniformLocation(
        program: u32,
        name: *const c_char,
    ) -> i32 {
        let place = own!(glGetUniformLocation(program: u32, name: *const c_char) -> i32);
        if keeps() {
            // SAFETY: the caller's name is zero-terminated.
            let arguments = vec![Program::value(program), unsafe { text(name) }];
            keep(
                "glGetUniformLocation",
                arguments,
                Some(Location::value(place)),
            );
        }
        place
    }

    pub(super) unsafe extern "system" fn glGetUniformBlockIndex(
        program: u32,
        name: *const c_char,
    ) -> u32 {
        let place = own!(glGetUniformBlockIndex(program: u32, name: *const c_char) -> u32);
        if keeps() {
            // SAFETY: the caller's name is zero-terminated.
            let arguments = vec![Program::value(program), unsafe { text(name) }];
            keep(
                "glGetUniformBlockIndex",
                arguments,
                Some(Block::value(place)),
            );
        }
        place
    }

    pub(super) unsafe extern "system" fn glMapBufferRange(
        target: u32,
        offset: isize,
        size: isize,
        access: u32,
    ) -> *mut c_void {
        let mapped = own!(
            glMapBufferRange(target: u32, offset: isize, size: isize, access: u32) -> *mut c_void
        );
        if keeps() {
            let arguments = vec![
                Enum::value(target),
                Size::value(offset),
                Size::value(size),
                Access::value(access),
            ];
            keep(
                "glMapBufferRange",
                arguments,
                Some(new_output(size.max(0) as u64)),
            );
        }
        mapped
    }

    pub(super) unsafe extern "system" fn glReadPixels(
        x: i32,
        y: i32,
        width: i32,
        height: i32,
        format: u32,
        kind: u32,
        pixels: *mut c_void,
    ) {
        own!(glReadPixels(
            x: i32, y: i32, width: i32, height: i32, format: u32, kind: u32, pixels: *mut c_void
        ));
        if keeps() {
            let mut arguments: Vec<Argument> = [x, y, width, height].map(Int::value).into();
            arguments.extend([
                Enum::value(format),
                Enum::value(kind),
                announced(pixels as usize),
            ]);
            keep("glReadPixels", arguments, None);
        }
    }

    pub(super) unsafe extern "system" fn glShaderSource(
        shader: u32,
        count: i32,
        texts: *const *const c_char,
        lengths: *const i32,
    ) {
        own!(glShaderSource(
            shader: u32, count: i32, texts: *const *const c_char, lengths: *const i32
        ));
        if keeps() {
            // SAFETY: the caller's arrays have `count` elements.
            let (texts, lengths) = unsafe {
                (
                    values(texts, count.max(0) as usize),
                    values(lengths, count.max(0) as usize),
                )
            };
            let mut bytes = Vec::new();
            for (i, part) in texts.into_iter().enumerate() {
                match lengths.get(i).copied().map(usize::try_from) {
                    // SAFETY: the part has this length.
                    Some(Ok(length)) => bytes.extend(unsafe { values(part.cast::<u8>(), length) }),
                    // SAFETY: a part without a length is zero-terminated.
                    _ => bytes.extend(unsafe { CStr::from_ptr(part) }.to_bytes()),
                }
            }
            let source = Argument::Text(String::from_utf8_lossy(&bytes).into_owned());
            keep(
                "glShaderSource",
                vec![Shader::value(shader), Int::value(1), source],
                None,
            );
        }
    }

    /// Returns the size of a client image in bytes. Its rows are tightly packed.
    fn image_bytes(size: [i32; 3], format: u32, kind: u32) -> usize {
        let channels = match format {
            glow::RED | glow::DEPTH_COMPONENT | glow::STENCIL_INDEX | glow::RED_INTEGER => 1,
            glow::RG => 2,
            glow::RGB => 3,
            _ => 4,
        };
        let texel = match kind {
            glow::BYTE | glow::UNSIGNED_BYTE => channels,
            glow::UNSIGNED_SHORT | glow::HALF_FLOAT => 2 * channels,
            glow::UNSIGNED_SHORT_4_4_4_4
            | glow::UNSIGNED_SHORT_5_5_5_1
            | glow::UNSIGNED_SHORT_5_6_5 => 2,
            glow::UNSIGNED_INT_2_10_10_10_REV
            | glow::UNSIGNED_INT_10F_11F_11F_REV
            | glow::UNSIGNED_INT_24_8 => 4,
            glow::FLOAT_32_UNSIGNED_INT_24_8_REV => 8,
            _ => 4 * channels,
        };
        size.iter()
            .map(|side| (*side).max(0) as usize)
            .product::<usize>()
            * texel
    }

    macro_rules! uploads {
        ($($name:ident($($arg:ident: $kind:ident),*; $size:expr);)+) => {
            $(
                pub(super) unsafe extern "system" fn $name(
                    $($arg: <$kind as ArgumentKind>::Raw,)* format: u32, kind: u32, pixels: CallPointer,
                ) {
                    own!($name(
                        $($arg: <$kind as ArgumentKind>::Raw,)* format: u32, kind: u32, pixels: CallPointer
                    ));
                    if keeps() {
                        // SAFETY: the backend uploads whole images, tightly packed.
                        let pixels = unsafe { bytes(pixels, image_bytes($size, format, kind)) };
                        let mut arguments = vec![$($kind::value($arg)),*];
                        arguments.extend([Enum::value(format), Enum::value(kind), pixels]);
                        keep(stringify!($name), arguments, None);
                    }
                }
            )+
        };
    }

    uploads! {
        glTexImage2D(
            target: Enum, level: Int, internal: Parameter, width: Int, height: Int, border: Int;
            [width, height, 1]
        );
        glTexImage3D(
            target: Enum, level: Int, internal: Parameter, width: Int, height: Int, depth: Int, border: Int;
            [width, height, depth]
        );
        glTexSubImage2D(
            target: Enum, level: Int, x: Int, y: Int, width: Int, height: Int;
            [width, height, 1]
        );
        glTexSubImage3D(
            target: Enum, level: Int, x: Int, y: Int, z: Int, width: Int, height: Int, depth: Int;
            [width, height, depth]
        );
    }
}
