//! Messages of validation layers and debug output, which wgpu passes to the `log` crate.

use crate::error::locked;
use log::{Level, LevelFilter, Log, Metadata, Record};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The largest number of messages kept: a broken driver could send one per call.
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
            if !is_mistake(&text) {
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

/// Returns true if a log record reports a mistake. Such a record begins with the message type: in Vulkan as
/// flags, in OpenGL after the source: `VALIDATION [id (number)]`, `GLES: [API/Error]`. Other records list the
/// objects of the message before them, or are messages of the loader and driver, performance hints, or wgpu's
/// own.
fn is_mistake(text: &str) -> bool {
    // A depth-only pass does not use the shader's colour.
    let intended = ["ShaderOutputNotConsumed", "Shader-OutputNotConsumed"];
    // False positives of layers before 1.3.240: they do not accept WGSL, which wgpu declares, as a shader's
    // source language. No pipeline of wgpu has a dynamic line width.
    let false_positives = [
        "Invalid source language operand",
        "VK_DYNAMIC_STATE_LINE_WIDTH state not set",
    ];
    if false_positives.iter().any(|w| text.contains(w)) {
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
        Some(message) => {
            let kind = message.split_inclusive(']').next().unwrap_or_default();
            mistakes.iter().any(|m| kind.ends_with(m))
        }
        None => head.starts_with("VALIDATION") && !intended.iter().any(|m| head.contains(m)),
    }
}

/// Collects warnings and errors from now on, unless the program has its own logger.
pub(crate) fn collect() {
    if log::set_logger(&COLLECTOR).is_ok() {
        log::set_max_level(LevelFilter::Warn);
    }
}

/// Returns the messages since the last call.
pub(crate) fn take() -> Vec<String> {
    std::mem::take(&mut *locked(&COLLECTOR.messages))
}

/// Returns true if `create`, which creates an instance, requested a validation layer that is missing. wgpu
/// logs this only at debug level. The level is raised for this instance alone, because a layer sends verbose
/// messages to any instance created at that level.
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
    fn mistakes_are_kept_and_other_records_are_not() {
        for text in [
            "VALIDATION [VUID-VkBufferCreateInfo-size-00912 (0x7de4ae4d)]\n\tno size",
            "VALIDATION | PERFORMANCE [x (0x1)]\n\tboth",
            "GLES: [API/Error] ID 1 : GL_INVALID_ENUM",
            "GLES: [ShaderCompiler/Undefined Behavior] ID 2 : read before it was written",
        ] {
            assert!(is_mistake(text), "{text}");
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
            assert!(!is_mistake(text), "{text}");
        }
    }
}
