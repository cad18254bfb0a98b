//! Checks of what a driver reports, before anything relies on it.

use crate::egl::{EglContext, function_at};
use etalon_backend::Unavailable;
use std::ffi::{CStr, c_char};

/// The largest alignment of an offset in a buffer that a context can need (OpenGL 4.6: table 23.63).
const MAX_ALIGNMENT: i32 = 256;

/// The functions of OpenGL 3.3 and OpenGL ES 3.0 that the backend calls in every context. `glow` panics if it
/// calls one that is missing.
const FUNCTIONS: [&CStr; 96] = [
    c"glActiveTexture",
    c"glAttachShader",
    c"glBeginQuery",
    c"glBindBuffer",
    c"glBindBufferRange",
    c"glBindFramebuffer",
    c"glBindSampler",
    c"glBindTexture",
    c"glBindVertexArray",
    c"glBlendColor",
    c"glBlendEquation",
    c"glBlendEquationSeparate",
    c"glBlendFunc",
    c"glBlendFuncSeparate",
    c"glBlitFramebuffer",
    c"glBufferData",
    c"glBufferSubData",
    c"glCheckFramebufferStatus",
    c"glClear",
    c"glClearBufferfi",
    c"glClearBufferfv",
    c"glClearBufferiv",
    c"glClearBufferuiv",
    c"glClearColor",
    c"glClearStencil",
    c"glColorMask",
    c"glCompileShader",
    c"glCreateProgram",
    c"glCreateShader",
    c"glCullFace",
    c"glDeleteBuffers",
    c"glDeleteFramebuffers",
    c"glDeleteProgram",
    c"glDeleteQueries",
    c"glDeleteShader",
    c"glDeleteTextures",
    c"glDepthFunc",
    c"glDepthMask",
    c"glDisable",
    c"glDrawArrays",
    c"glDrawArraysInstanced",
    c"glDrawBuffers",
    c"glDrawElements",
    c"glDrawElementsInstanced",
    c"glEnable",
    c"glEnableVertexAttribArray",
    c"glEndQuery",
    c"glFinish",
    c"glFlush",
    c"glFramebufferTexture2D",
    c"glFramebufferTextureLayer",
    c"glFrontFace",
    c"glGenBuffers",
    c"glGenFramebuffers",
    c"glGenQueries",
    c"glGenSamplers",
    c"glGenTextures",
    c"glGenVertexArrays",
    c"glGetError",
    c"glGetFramebufferAttachmentParameteriv",
    c"glGetIntegerv",
    c"glGetProgramInfoLog",
    c"glGetProgramiv",
    c"glGetQueryObjectuiv",
    c"glGetShaderInfoLog",
    c"glGetShaderiv",
    c"glGetString",
    c"glGetStringi",
    c"glGetUniformBlockIndex",
    c"glGetUniformLocation",
    c"glLineWidth",
    c"glLinkProgram",
    c"glMapBufferRange",
    c"glPixelStorei",
    c"glPolygonOffset",
    c"glReadBuffer",
    c"glReadPixels",
    c"glSamplerParameteri",
    c"glScissor",
    c"glShaderSource",
    c"glStencilFunc",
    c"glStencilFuncSeparate",
    c"glStencilMask",
    c"glStencilMaskSeparate",
    c"glStencilOp",
    c"glStencilOpSeparate",
    c"glTexImage2D",
    c"glTexParameteri",
    c"glTexSubImage2D",
    c"glUniform1i",
    c"glUniformBlockBinding",
    c"glUnmapBuffer",
    c"glUseProgram",
    c"glVertexAttribDivisor",
    c"glVertexAttribPointer",
    c"glViewport",
];

type GetIntegers = unsafe extern "system" fn(u32, *mut i32);
type GetIndexedString = unsafe extern "system" fn(u32, u32) -> *const c_char;

/// Checks that the current context has the functions that the backend calls, and that all its extensions have
/// names.
///
/// # Errors
/// If something is missing; the reason names it.
pub(crate) fn check_context(egl: &EglContext) -> Result<(), Unavailable> {
    check_functions(|name| egl.has_function(name))?;
    // SAFETY: every version of GL gives these names these types.
    let (integers, string): (Option<GetIntegers>, Option<GetIndexedString>) = unsafe {
        (
            function_at(egl.proc_address(c"glGetIntegerv")),
            function_at(egl.proc_address(c"glGetStringi")),
        )
    };
    let (Some(integers), Some(string)) = (integers, string) else {
        return Ok(());
    };
    let mut count = 0;
    // SAFETY: the context is current, and the number has room.
    unsafe { integers(glow::NUM_EXTENSIONS, &mut count) };
    let count = u32::try_from(count).unwrap_or(0);
    check_extensions((0..count).map(|index| {
        // SAFETY: the context is current and has an extension of this index.
        let name = unsafe { string(glow::EXTENSIONS, index) };
        // SAFETY: GL's strings are zero-terminated.
        (!name.is_null()).then(|| unsafe { CStr::from_ptr(name) })
    }))
}

fn check_functions(has: impl Fn(&CStr) -> bool) -> Result<(), Unavailable> {
    match FUNCTIONS.into_iter().find(|name| !has(name)) {
        None => Ok(()),
        Some(name) => Err(wrong(format!("{} is missing", name.to_string_lossy()))),
    }
}

fn check_extensions<'n>(names: impl Iterator<Item = Option<&'n CStr>>) -> Result<(), Unavailable> {
    for (index, name) in names.enumerate() {
        let Some(name) = name else {
            return Err(wrong(format!("extension {index} has no name")));
        };
        if name.to_str().is_err() {
            let bytes = name.to_bytes().escape_ascii();
            return Err(wrong(format!(
                "the name of extension {index} is no UTF-8: {bytes}"
            )));
        }
    }
    Ok(())
}

/// Returns the alignment of offsets in buffers that a context reports.
///
/// # Errors
/// If it is impossible; the reason names it.
pub(crate) fn alignment(name: &str, value: i32) -> Result<usize, Unavailable> {
    match usize::try_from(value) {
        Ok(alignment @ 1..) if value <= MAX_ALIGNMENT => Ok(alignment),
        _ => Err(wrong(format!(
            "{name} is {value}, which must be 1 to {MAX_ALIGNMENT}"
        ))),
    }
}

fn wrong(reason: String) -> Unavailable {
    Unavailable::new(
        format!("the driver breaks the specification: {reason}"),
        "use another version of the driver",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_function_is_an_error_that_names_it() {
        assert_eq!(check_functions(|_| true), Ok(()));
        let error = check_functions(|name| name != c"glDrawArrays").expect_err("refused");
        assert!(error.reason.contains("glDrawArrays is missing"), "{error}");
    }

    #[test]
    fn an_extension_whose_name_is_no_utf_8_is_an_error_that_names_it() {
        let names = |last| check_extensions([Some(c"GL_ARB_sync"), last].into_iter());
        assert_eq!(names(Some(c"GL_EXT_x")), Ok(()));
        let error = names(Some(c"GL_\xff\n")).expect_err("refused");
        assert!(
            error
                .reason
                .contains("extension 1 is no UTF-8: GL_\\xff\\n"),
            "{error}"
        );
        let error = names(None).expect_err("refused");
        assert!(error.reason.contains("extension 1 has no name"), "{error}");
    }

    #[test]
    fn an_impossible_alignment_is_an_error_that_names_it() {
        assert_eq!(alignment("GL_X", 1), Ok(1));
        assert_eq!(alignment("GL_X", 256), Ok(256));
        for value in [i32::MIN, -1, 0, 257, i32::MAX] {
            let error = alignment("GL_X", value).expect_err("refused");
            assert!(
                error.reason.contains(&format!("GL_X is {value}")),
                "{error}"
            );
        }
    }
}
