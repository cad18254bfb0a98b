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
