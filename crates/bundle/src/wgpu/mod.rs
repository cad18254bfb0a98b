//! wgpu: a package with one source file that depends on wgpu, and a page for browsers. Calls of a browser
//! give only the page.

mod check;
mod code;
mod commands;
mod literals;
mod memories;
mod objects;
mod page;
mod printer;
mod program;

use crate::archive::File;
use crate::due::Due;
use crate::error::BundleError;
use crate::head::Head;
use crate::language::Language;
use crate::program::Program;
use etalon_backend::Recording;
use program::ProgramApi;

/// Returns the program for a device and the API below wgpu, with a page if WebGPU has everything that it
/// needs. For a browser, the API is `webgpu` and the features have WebGPU's names.
pub(crate) fn program(
    head: &Head,
    [api, device]: [&str; 2],
    features: &[String],
    calls: &str,
    recording: &Recording,
    expected: &Due,
) -> Result<Program, BundleError> {
    let unread = |error| BundleError::Call(format!("wgpu: {error}"));
    let calls = serde_json::from_str(calls).map_err(unread)?;
    let check = check::check(recording, expected)?;
    let below = match api {
        "vulkan" => ProgramApi::Vulkan,
        "gl" => ProgramApi::Gl,
        "webgpu" => {
            let features = page::names_of_wgpu(features);
            let statements = printer::statements(recording, &calls, &features);
            let page = page::page(head, &statements, &check);
            let page = page.ok_or_else(|| BundleError::Call("a browser".to_owned()))?;
            return Ok(Program {
                language: Language::Page,
                files: vec![File::text("repro.html", "the program, a page", page)],
            });
        }
        other => return Err(BundleError::Call(other.to_owned())),
    };
    let statements = printer::statements(recording, &calls, features);
    let text = program::program(head, below, device, &statements, &check);
    let mut files = vec![
        File::text("main.rs", "the program", text),
        File::text("Cargo.toml", "its package", program::package(below)),
    ];
    if let Some(page) = page::page(head, &statements, &check) {
        let about = "the same calls as a page: open it in a browser";
        files.push(File::text("repro.html", about, page));
    }
    Ok(Program {
        language: Language::Rust,
        files,
    })
}
