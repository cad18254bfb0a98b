//! Printing the program of a bundle, for the API whose calls were recorded.

use crate::archive::File;
use crate::due::Due;
use crate::error::BundleError;
use crate::gl::{self, Trim};
use crate::head::Head;
use crate::language::Language;
use crate::program::Program;
use crate::vulkan;
use crate::wgpu;
use etalon_backend::{RecordedContext, Recording};

/// Returns the program, with the state that `trim` names removed.
///
/// # Errors
/// If a call cannot be printed, or a value that must be checked was not read.
pub fn program(
    head: &Head,
    recording: &Recording,
    expected: &Due,
    trim: Trim,
) -> Result<Program, BundleError> {
    let text = match &recording.context {
        RecordedContext::Egl {
            es,
            version,
            library,
            device,
        } => {
            let context = gl::ProgramContext {
                es: *es,
                version: *version,
                library: library.as_deref(),
                device: *device,
            };
            gl::program(head, &context, recording, expected, trim)
        }
        RecordedContext::Vulkan {
            device,
            version,
            needs,
        } => {
            let program_device = vulkan::ProgramDevice {
                name: device,
                version: *version,
                needs,
            };
            vulkan::program(head, &program_device, recording, expected)
        }
        RecordedContext::Wgpu {
            api,
            device,
            features,
            list,
        } => return wgpu::program(head, [api, device], features, list, recording, expected),
    };
    Ok(Program {
        language: Language::C,
        files: vec![File::text("repro.c", "the program", text?)],
    })
}
