//! The program of a bundle, by the API whose calls were recorded.

use crate::due::Due;
use crate::error::BundleError;
use crate::gl::{self, Trim};
use crate::head::Head;
use crate::vulkan;
use etalon_backend::{RecordedContext, Recording};

/// Returns the program, with `trim` taken out of it.
///
/// # Errors
/// If a call cannot be printed, or a value that must be checked was not read.
pub fn program(
    head: &Head,
    recording: &Recording,
    due: &Due,
    trim: Trim,
) -> Result<String, BundleError> {
    match &recording.context {
        RecordedContext::Egl {
            es,
            version,
            library,
            device,
        } => {
            let context = gl::Context {
                es: *es,
                version: *version,
                library: library.as_deref(),
                device: *device,
            };
            gl::program(head, &context, recording, due, trim)
        }
        RecordedContext::Vulkan {
            device,
            version,
            needs,
        } => {
            let context = vulkan::Context {
                device,
                version: *version,
                needs,
            };
            vulkan::program(head, &context, recording, due)
        }
    }
}

/// Returns the scene as a test for piglit's `shader_runner`; `None` if the format cannot say it.
pub fn shader_test(recording: &Recording, due: &Due) -> Option<String> {
    match &recording.context {
        RecordedContext::Egl { es, version, .. } => gl::shader_test(*es, *version, recording, due),
        RecordedContext::Vulkan { .. } => None,
    }
}
