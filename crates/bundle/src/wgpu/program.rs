//! The program in Rust.

use super::code::Code;
use super::literals::string;
use super::printer::Statements;
use crate::c::comment;
use crate::head::Head;
use std::fmt::Write;

/// Returns the manifest of the package, which depends on the wgpu version whose calls were recorded.
pub(super) fn package(api: ProgramApi) -> String {
    let feature = match api {
        ProgramApi::Vulkan => "vulkan",
        ProgramApi::Gl => "gles",
    };
    format!(
        r#"[package]
name = "repro"
version = "0.0.0"
edition = "2024"
publish = false

[[bin]]
name = "repro"
path = "main.rs"

[dependencies]
wgpu = {{ version = "=30.0.1", default-features = false, features = ["std", "parking_lot", "wgsl", "{feature}"] }}
pollster = "=1.0.1"

[workspace]
"#
    )
}

/// The API below wgpu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ProgramApi {
    Vulkan,
    Gl,
}

/// Returns the program for a device of an API.
pub(super) fn program(
    head: &Head,
    api: ProgramApi,
    device: &str,
    statements: &Statements<'_>,
    check: &Code,
) -> String {
    let body = &statements.body.rust;
    let mapped = &statements.mapped;
    let mut read = String::new();
    for memory in &statements.memories {
        let _ = writeln!(read, "        {},", memory.expression("&bytes"));
    }
    let mut text = String::new();
    for part in [&head.title, &head.sentence, &head.run] {
        let _ = write!(text, "//! {}\n//!\n", comment(part));
    }
    text.push_str(
        "//! The optional first argument is a part of the name of another adapter. Exit status: 1 if the bug is there,\n//! \
         0 if not, 77 if the adapter lacks something, 2 if a call fails.\n\n",
    );
    let backend = match api {
        ProgramApi::Vulkan => "VULKAN",
        ProgramApi::Gl => "GL",
    };
    let _ = write!(
        text,
        "const BACKENDS: wgpu::Backends = wgpu::Backends::{backend};\nconst ADAPTER: &str = {};\n/// Features that the calls need.\nconst \
         NEEDED: wgpu::Features = {};\n/// Features of the device on which the calls were recorded.\nconst ENABLED: \
         wgpu::Features = {};\n",
        string(device).rust,
        union(&statements.needed),
        union(&statements.features),
    );
    text.push_str(MAIN);
    for (name, definition) in HELPERS {
        if body.contains(name) || read.contains(name) {
            text.push_str(definition);
        }
    }
    let _ = write!(
        text,
        "\n/// Makes the calls. Returns what they wrote.\nfn draw(device: &wgpu::Device, queue: &wgpu::Queue) -> Vec<Vec<u8>> {{\n{body}    \
         {mapped}.slice(..).map_async(wgpu::MapMode::Read, |result| {{\n        if let Err(error) = result {{\n            \
         failed(&error);\n        }}\n    }});\n    if let Err(error) = device.poll(wgpu::PollType::wait_indefinitely()) {{\n        \
         failed(&error);\n    }}\n    let bytes = {mapped}.slice(..).get_mapped_range().unwrap_or_else(|error| failed(&error));\n    \
         vec![\n{read}    ]\n}}\n"
    );
    text + &check.rust
}

/// Returns a union of features as a constant expression.
fn union(names: &[&str]) -> String {
    let mut names = names.iter().map(|name| format!("wgpu::Features::{name}"));
    let Some(first) = names.next() else {
        return "wgpu::Features::empty()".to_owned();
    };
    names.fold(first, |union, name| format!("{union}.union({name})"))
}

const MAIN: &str = r#"
fn failed(error: &dyn std::fmt::Display) -> ! {
    println!("a call fails: {error}");
    std::process::exit(2)
}

fn lacks(what: &dyn std::fmt::Display) -> ! {
    println!("not supported: {what}");
    std::process::exit(77)
}

fn main() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: BACKENDS,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapters = pollster::block_on(instance.enumerate_adapters(BACKENDS));
    let other = std::env::args().nth(1);
    let adapter = adapters.into_iter().find(|adapter| match &other {
        Some(name) => adapter.get_info().name.contains(name.as_str()),
        None => adapter.get_info().name == ADAPTER,
    });
    let Some(adapter) = adapter else {
        lacks(&format!("an adapter {}", other.as_deref().unwrap_or(ADAPTER)));
    };
    let missing = NEEDED - adapter.features();
    if !missing.is_empty() {
        lacks(&format!("{missing:?}"));
    }
    let info = adapter.get_info();
    println!("{}, {} {}", info.name, info.driver, info.driver_info);
    let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_features: adapter.features() & ENABLED,
        required_limits: adapter.limits(),
        ..Default::default()
    }));
    let (device, queue) = opened.unwrap_or_else(|error| lacks(&error));
    device.on_uncaptured_error(std::sync::Arc::new(|error| failed(&error)));
    let memories = draw(&device, &queue);
    match wrong(&memories) {
        Some(what) => {
            println!("{what}");
            std::process::exit(1)
        }
        None => println!("right"),
    }
}
"#;

/// Functions that only some programs need: a text that occurs where they are used, and their source.
const HELPERS: [(&str, &str); 4] = [
    (
        "&floats(&[",
        r#"
fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}
"#,
    ),
    (
        "&words(&[",
        r#"
fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}
"#,
    ),
    (
        " rows(&bytes, ",
        r#"
/// Returns the rows without the bytes between them.
fn rows(bytes: &[u8], offset: usize, pitch: usize, row: usize, rows: usize) -> Vec<u8> {
    (0..rows).flat_map(|y| bytes[offset + y * pitch..][..row].to_vec()).collect()
}
"#,
    ),
    (
        " bits(rows(",
        r#"
/// Packs bits into bytes: bits 0 to 3 come from one image, and bits 4 to 7 from the other.
fn bits(low: Vec<u8>, high: Vec<u8>) -> Vec<u8> {
    let nibble = |bytes: &[u8]| (0..4).fold(0, |all, bit| all | u8::from(bytes[bit] != 0) << bit);
    low.chunks(4).zip(high.chunks(4)).map(|(low, high)| nibble(low) | nibble(high) << 4).collect()
}
"#,
    ),
];
