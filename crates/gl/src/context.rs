//! The current context with its entry points, capabilities and errors.

use crate::caps::Caps;
use crate::debug_output::{self, Log};
use crate::egl::{EglContext, function_at};
use crate::entry_points::EntryPoints;
use crate::options::{GlOptions, Profile, Tuning};
use crate::recording;
use crate::sanity;
use etalon_backend::{BackendError, Fault, Unavailable};
use glow::HasContext;
use std::ffi::{CStr, c_char};
use std::sync::PoisonError;

/// The largest number of errors fetched at once: a lost context can report errors forever.
const MAX_ERRORS: usize = 16;

const GPU_DISJOINT_EXT: u32 = 0x8FBB;

/// A context, and everything with the same lifetime.
pub(crate) struct Context {
    pub(crate) gl: glow::Context,
    pub(crate) caps: Caps,
    pub(crate) names: Names,
    /// The fault that a test plants.
    pub(crate) fault: Option<Fault>,
    pub(crate) entry_points: EntryPoints,
    // Fields drop in order: the driver can write to the log until the context is destroyed.
    egl: EglContext,
    log: Box<Log>,
}

/// The driver's own names.
pub(crate) struct Names {
    pub(crate) renderer: String,
    pub(crate) vendor: String,
    pub(crate) version: String,
}

impl Context {
    /// Wraps a context that was just made current.
    pub(crate) fn new(
        egl: EglContext,
        options: &GlOptions,
        tuning: Tuning,
    ) -> Result<Self, Unavailable> {
        #[cfg(feature = "faults")]
        crate::planted::plant(options.fault);
        recording::install(options.record);
        let names = Names::query(&egl)?;
        let es = options.profile == Profile::Es;
        let version = parse_version(&names.version).ok_or_else(|| unusable("GL_VERSION"))?;
        if version < if es { (3, 0) } else { (3, 3) } {
            return Err(unusable("GL_VERSION"));
        }
        sanity::check_context(&egl)?;
        // SAFETY: the context is current, reports a version in the documented form, and stays
        // current on this thread whenever the functions are called.
        let gl = unsafe { glow::Context::from_loader_function_cstr(|name| egl.proc_address(name)) };
        let known = gl.supported_extensions();
        let entry_points = EntryPoints::load(&egl, es, version, known);
        let mut caps = Caps::query(&gl, es, version);
        if let Some(value) = caps.storage_alignment {
            let value = i32::try_from(value).unwrap_or(i32::MAX);
            sanity::alignment("GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT", value)?;
        }
        caps.clip_control = entry_points.clip_control.is_some() && tuning.clip_control;
        if options.debug && entry_points.debug_callback.is_none() {
            return Err(Unavailable::new(
                "the driver has no debug output (KHR_debug)",
                "use a newer driver, or do without validation",
            ));
        }
        let mut context = Self {
            gl,
            caps,
            names,
            fault: options.fault,
            entry_points,
            egl,
            log: Box::default(),
        };
        // Querying an unknown target would be an error.
        let Caps {
            timer,
            samples_passed,
            fragment_invocations,
            ..
        } = context.caps;
        context.caps.timer = timer && context.counts(glow::TIME_ELAPSED);
        context.caps.samples_passed = samples_passed && context.counts(glow::SAMPLES_PASSED);
        context.caps.fragment_invocations =
            fragment_invocations && context.counts(glow::FRAGMENT_SHADER_INVOCATIONS);
        if options.debug {
            context.start_debug_output();
        }
        context
            .check("opening the context")
            .map_err(|e| Unavailable::new(e.to_string(), "use another driver"))?;
        Ok(context)
    }

    /// Makes the context current on this thread.
    pub(crate) fn make_current(&self) -> Result<(), BackendError> {
        self.egl.make_current().map_err(|(lost, message)| {
            if lost {
                BackendError::lost(message)
            } else {
                BackendError::internal_of("eglMakeCurrent failed", message)
            }
        })
    }

    /// Returns EGL's name of the driver, if it has one, and the vendor.
    pub(crate) fn driver_id(&self) -> String {
        match self.egl.driver() {
            Some(driver) => format!("{driver}, {}", self.names.vendor),
            None => self.names.vendor.clone(),
        }
    }

    /// Returns true for a software rasterizer, recognized by the names that Mesa, SwiftShader and ANGLE use.
    pub(crate) fn is_software(&self) -> bool {
        let renderer = self.names.renderer.to_lowercase();
        let known = ["llvmpipe", "softpipe", "swiftshader", "swrast", "lavapipe"];
        known.iter().any(|name| renderer.contains(name))
            // With zink, EGL's device does not describe the Vulkan device that zink uses.
            || (self.egl.is_software() && !renderer.starts_with("zink"))
    }

    /// Sets WebGPU's conventions, if the context has `glClipControl`.
    pub(crate) fn set_clip_control(&self) {
        if self.caps.clip_control
            && let Some(clip_control) = self.entry_points.clip_control
        {
            // SAFETY: the context is current and has the function.
            unsafe { clip_control(glow::UPPER_LEFT, glow::ZERO_TO_ONE) };
        }
    }

    /// Returns the result of a finished `GL_TIME_ELAPSED` query in nanoseconds, or `None` if the timer was
    /// disjoint.
    pub(crate) fn elapsed(&self, query: glow::Query) -> Option<u64> {
        let get = self.entry_points.get_query_result?;
        let mut nanoseconds = 0;
        // SAFETY: the context is current, the query has ended and the result has room.
        unsafe {
            get(query.0.get(), glow::QUERY_RESULT, &mut nanoseconds);
            let disjoint = self.caps.es && self.gl.get_parameter_i32(GPU_DISJOINT_EXT) != 0;
            (!disjoint).then_some(nanoseconds)
        }
    }

    /// Returns the result of a finished counter query.
    pub(crate) fn query_result(&self, query: glow::Query) -> u64 {
        // ES without timer queries has only 32-bit results, which suffice for a boolean.
        let Some(get) = self.entry_points.get_query_result else {
            // SAFETY: the context is current and the query has ended.
            return u64::from(unsafe {
                self.gl.get_query_parameter_u32(query, glow::QUERY_RESULT)
            });
        };
        let mut count = 0;
        // SAFETY: the context is current, the query has ended and the result has room.
        unsafe { get(query.0.get(), glow::QUERY_RESULT, &mut count) };
        count
    }

    /// Returns true if queries of a supported target have counter bits.
    fn counts(&self, target: u32) -> bool {
        let (Some(get), Some(_)) = (
            self.entry_points.get_query,
            self.entry_points.get_query_result,
        ) else {
            return false;
        };
        let mut bits = 0;
        // SAFETY: the context is current and the result has room.
        unsafe { get(target, glow::QUERY_COUNTER_BITS, &mut bits) };
        bits > 0
    }

    fn start_debug_output(&self) {
        let Some(set) = self.entry_points.debug_callback else {
            return;
        };
        let log: *const Log = &*self.log;
        // SAFETY: the context is current and has debug output; the log outlives the context.
        unsafe {
            self.gl.enable(glow::DEBUG_OUTPUT);
            self.gl.enable(glow::DEBUG_OUTPUT_SYNCHRONOUS);
            set(Some(debug_output::collect), log.cast());
        }
    }

    /// Returns the debug messages since the last call.
    pub(crate) fn messages(&self) -> Vec<String> {
        std::mem::take(&mut *self.log.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Fetches pending errors and returns the most severe one.
    pub(crate) fn check(&self, what: &str) -> Result<(), BackendError> {
        let mut result = Ok(());
        for _ in 0..MAX_ERRORS {
            // SAFETY: the context is current.
            let code = unsafe { self.gl.get_error() };
            match code {
                glow::NO_ERROR => break,
                glow::CONTEXT_LOST => {
                    result = Err(lost(what));
                    break;
                }
                glow::OUT_OF_MEMORY => {
                    result = Err(BackendError::refused(what, "GL_OUT_OF_MEMORY"));
                }
                _ if result.is_ok() => {
                    let name = error_name(code);
                    result = Err(BackendError::internal_of(what, &name).with_code(&name));
                }
                _ => {}
            }
        }
        if let Some(status) = self.entry_points.get_reset_status {
            // SAFETY: the context is current and has the function.
            if unsafe { status() } != glow::NO_ERROR {
                result = Err(lost(what));
            }
        }
        result
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        if self.egl.make_current().is_ok()
            && let Some(set) = self.entry_points.debug_callback
        {
            // SAFETY: the context is current and has debug output.
            unsafe { set(None, std::ptr::null()) };
        }
    }
}

impl Names {
    fn query(egl: &EglContext) -> Result<Self, Unavailable> {
        type GetString = unsafe extern "system" fn(u32) -> *const c_char;
        // SAFETY: every version of GL gives this name this type.
        let get: Option<GetString> = unsafe { function_at(egl.proc_address(c"glGetString")) };
        let get = get.ok_or_else(|| unusable("glGetString"))?;
        let text = |name, what| {
            // SAFETY: a context is current, and GL's strings are zero-terminated.
            let pointer = unsafe { get(name) };
            if pointer.is_null() {
                return Err(unusable(what));
            }
            // SAFETY: as above.
            Ok(unsafe { CStr::from_ptr(pointer) }
                .to_string_lossy()
                .into_owned())
        };
        Ok(Self {
            renderer: text(glow::RENDERER, "GL_RENDERER")?,
            vendor: text(glow::VENDOR, "GL_VENDOR")?,
            version: text(glow::VERSION, "GL_VERSION")?,
        })
    }

    /// Returns the part of `GL_VERSION` that names the driver's version: `Mesa 22.3.6`.
    pub(crate) fn driver_version(&self) -> &str {
        let version = self.version.trim_start_matches("OpenGL ES ");
        let driver = version.split_once(' ').map_or("", |(_, driver)| driver);
        driver.trim_start_matches("(Core Profile) ").trim()
    }
}

fn lost(what: &str) -> BackendError {
    BackendError::lost(format!("{what}: the context was lost"))
}

fn unusable(what: &str) -> Unavailable {
    Unavailable::new(
        format!("the context reports no usable {what}"),
        "use another driver",
    )
}

fn error_name(code: u32) -> String {
    match code {
        glow::INVALID_ENUM => "GL_INVALID_ENUM".to_owned(),
        glow::INVALID_VALUE => "GL_INVALID_VALUE".to_owned(),
        glow::INVALID_OPERATION => "GL_INVALID_OPERATION".to_owned(),
        glow::INVALID_FRAMEBUFFER_OPERATION => "GL_INVALID_FRAMEBUFFER_OPERATION".to_owned(),
        _ => format!("GL error 0x{code:04X}"),
    }
}

/// Returns the first two numbers of `GL_VERSION`; `None` if the text is not in the documented form, which `glow`
/// requires too.
fn parse_version(text: &str) -> Option<(u32, u32)> {
    let text = text.trim_start_matches("OpenGL ES ");
    if text.contains(char::REPLACEMENT_CHARACTER) {
        return None;
    }
    let mut numbers = text.split(' ').next()?.split('.');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_parsed() {
        let names = |version: &str| Names {
            renderer: String::new(),
            vendor: String::new(),
            version: version.to_owned(),
        };
        for (text, numbers, driver) in [
            ("4.5 (Core Profile) Mesa 22.3.6", (4, 5), "Mesa 22.3.6"),
            ("OpenGL ES 3.1 Mesa 22.3.6", (3, 1), "Mesa 22.3.6"),
            ("4.6.0 NVIDIA 535.54", (4, 6), "NVIDIA 535.54"),
        ] {
            assert_eq!(parse_version(text), Some(numbers));
            assert_eq!(names(text).driver_version(), driver);
        }
        for text in ["none", "4", "4.x", "4.6-pre", "4.6 \u{fffd}"] {
            assert_eq!(parse_version(text), None, "{text}");
        }
    }
}
