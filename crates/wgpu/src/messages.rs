//! The messages of validation layers and debug output, which wgpu hands to the `log` crate.

use crate::error::locked;
use log::{Level, LevelFilter, Log, Metadata, Record};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The most messages kept; a broken driver may send one per call.
const MOST: usize = 1000;

struct Collector {
    messages: Mutex<Vec<String>>,
    no_layer: AtomicBool,
}

static COLLECTOR: Collector = Collector {
    messages: Mutex::new(Vec::new()),
    no_layer: AtomicBool::new(false),
};

impl Log for Collector {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.target().starts_with("wgpu_hal")
    }

    fn log(&self, record: &Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        let text = record.args().to_string();
        if record.level() <= Level::Warn {
            if !is_grave(&text) {
                return;
            }
            let mut messages = locked(&self.messages);
            if messages.len() < MOST {
                messages.push(text);
            }
        } else if text.contains("unable to find layer") {
            self.no_layer.store(true, Ordering::Relaxed);
        }
    }

    fn flush(&self) {}
}

/// Whether a record of wgpu's tells of a mistake. It begins with the kind of the message, in Vulkan as
/// flags and in OpenGL behind the source: `VALIDATION [id (number)]`, `GLES: [API/Error]`. Its other records
/// are the objects of the message before, chatter of loader and driver, hints about speed, and wgpu's own
/// thoughts about the machine.
fn is_grave(text: &str) -> bool {
    // A depth-only pass has no use for a shader's colour.
    let meant = ["ShaderOutputNotConsumed", "Shader-OutputNotConsumed"];
    // What layers before 1.3.240 get wrong: wgpu tags shaders with WGSL as their source, of which they have
    // not heard, and no pipeline of wgpu's leaves the line width to be set.
    let wrong = [
        "Invalid source language operand",
        "VK_DYNAMIC_STATE_LINE_WIDTH state not set",
    ];
    if wrong.iter().any(|w| text.contains(w)) {
        return false;
    }
    let mistakes = [
        "/Error]",
        "/Undefined Behavior]",
        "/Deprecated Behavior]",
        "/Portability]",
    ];
    let head = text.lines().next().unwrap_or_default();
    match head.strip_prefix("GLES: ") {
        Some(rest) => {
            let kind = rest.split_inclusive(']').next().unwrap_or_default();
            mistakes.iter().any(|m| kind.ends_with(m))
        }
        None => head.starts_with("VALIDATION") && !meant.iter().any(|m| head.contains(m)),
    }
}

/// Collects warnings and errors from now on, unless the program has a logger of its own: then they
/// go there.
pub(crate) fn collect() {
    if log::set_logger(&COLLECTOR).is_ok() {
        log::set_max_level(LevelFilter::Warn);
    }
}

/// Everything collected since the last call.
pub(crate) fn take() -> Vec<String> {
    std::mem::take(&mut *locked(&COLLECTOR.messages))
}

/// Whether `create`, which makes an instance, asked for a validation layer in vain. wgpu tells it
/// in a debug message only; the level is raised for this one instance because the layer sends all
/// its verbose messages to an instance that was created with it raised.
pub(crate) fn misses_layer(create: impl FnOnce()) -> bool {
    let level = log::max_level();
    COLLECTOR.no_layer.store(false, Ordering::Relaxed);
    log::set_max_level(LevelFilter::Debug);
    create();
    log::set_max_level(level);
    COLLECTOR.no_layer.load(Ordering::Relaxed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_are_kept_and_chatter_is_not() {
        for text in [
            "VALIDATION [VUID-VkBufferCreateInfo-size-00912 (0x7de4ae4d)]\n\tno size",
            "VALIDATION | PERFORMANCE [x (0x1)]\n\tboth",
            "GLES: [API/Error] ID 1 : GL_INVALID_ENUM",
            "GLES: [ShaderCompiler/Undefined Behavior] ID 2 : read before it was written",
        ] {
            assert!(is_grave(text), "{text}");
        }
        for text in [
            "",
            "\tobjects: (type: BUFFER, hndl: 0x1, name: ?)",
            "GENERAL [Loader Message (0x0)]\n\tVALIDATION of a manifest",
            "PERFORMANCE [UNASSIGNED-BestPractices (0x1)]\n\tslow",
            "VALIDATION [Undefined-Value-ShaderOutputNotConsumed (0x1)]\n\tattachment 0",
            "GLES: [API/Performance] ID 3 : [API/Error] in a shader's name",
            "GLES: [Other/Other] ID 4 : hello",
            "VALIDATION [UNASSIGNED-CoreValidation-Shader-InconsistentSpirv (0x6bbb14)]\n\tSPIR-V module not \
             valid: Invalid source language operand: 10",
            "EGL has no surface",
        ] {
            assert!(!is_grave(text), "{text}");
        }
    }
}
