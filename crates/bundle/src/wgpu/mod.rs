//! wgpu: a package of one file that depends on wgpu, and a page for browsers.

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
use etalon_backend::Recording;
use program::Api;

/// Returns the files of the program for an API below wgpu and a device, and a page if WebGPU has all that it needs.
pub(crate) fn program(
    head: &Head,
    [api, device]: [&str; 2],
    features: &[String],
    calls: &str,
    recording: &Recording,
    due: &Due,
) -> Result<Vec<File>, BundleError> {
    let api = match api {
        "vulkan" => Api::Vulkan,
        "gl" => Api::Gl,
        other => return Err(BundleError::Call(other.to_owned())),
    };
    let unread = |error| BundleError::Call(format!("wgpu: {error}"));
    let calls = serde_json::from_str(calls).map_err(unread)?;
    let statements = printer::statements(recording, &calls, features);
    let check = check::check(recording, due)?;
    let text = program::program(head, api, device, &statements, &check);
    let mut files = vec![
        File::text("main.rs", "the program", text),
        File::text("Cargo.toml", "its package", program::package(api)),
    ];
    if let Some(page) = page::page(head, &statements, &check) {
        let about = "the same calls as a page: open it in a browser";
        files.push(File::text("repro.html", about, page));
    }
    Ok(files)
}
