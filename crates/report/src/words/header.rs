//! The header of a run in words.

use crate::numbers::{count, round_duration};
use etalon_frame::Api;
use etalon_record::{Machine, Settings};

/// Returns the name of an API as its authors spell it.
pub fn api_name(api: Api) -> &'static str {
    match api {
        Api::Vulkan => "Vulkan",
        Api::OpenGl => "OpenGL",
        Api::OpenGlEs => "OpenGL ES",
        Api::WebGpu => "WebGPU",
    }
}

/// Returns a machine in words: `Example CPU, 4 cores, Linux 6.12`.
pub(crate) fn machine(machine: &Machine) -> String {
    format!(
        "{}, {}, {}",
        machine.cpu,
        count(u64::from(machine.cores), "core"),
        machine.os
    )
}

/// Returns the settings of a run that differ from the defaults, one text each.
pub(crate) fn settings(settings: &Settings) -> Vec<String> {
    let s = settings;
    let texts = [
        s.gltf
            .as_ref()
            .map(|g| format!("scene {} (SHA-256 {})", g.name, g.sha256)),
        s.shard.map(|s| format!("shard {s}")),
        s.shuffle.map(|s| format!("shuffled with seed {s}")),
        s.repeat
            .map(|n| format!("each case drawn {}", count(u64::from(n), "time"))),
        s.shader_cache.map(|c| format!("shader cache {}", c.name())),
        s.validate.then(|| "validation layers enabled".to_owned()),
        s.timeout
            .map(|s| format!("at most {} per case", round_duration(s))),
        s.memory.map(|m| format!("at most {m} MiB per worker")),
    ];
    texts.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_changed_settings_are_listed() {
        assert!(settings(&Settings::default()).is_empty());
        let some = Settings {
            repeat: Some(3),
            validate: true,
            timeout: Some(20.0),
            ..Settings::default()
        };
        let texts = [
            "each case drawn 3 times",
            "validation layers enabled",
            "at most 20 s per case",
        ];
        assert_eq!(settings(&some), texts);
    }
}
