//! The drivers' shader caches on disk.

use etalon_record::ShaderCache;

/// Variables that disable the caches. SwiftShader, softpipe and `wgpu` have no cache on disk; ANGLE has one
/// only for programs that supply storage.
const OFF: [(&str, &str); 3] = [
    // Mesa since 22.0, all drivers, OpenGL and Vulkan.
    (MESA, "true"),
    // Mesa before 22.0; newer versions ignore it if the variable above is set.
    ("MESA_GLSL_CACHE_DISABLE", "true"),
    // NVIDIA's driver, OpenGL and Vulkan.
    ("__GL_SHADER_DISK_CACHE", "0"),
];

const MESA: &str = "MESA_SHADER_CACHE_DISABLE";

/// Returns the environment of a worker without shader caches.
pub(crate) fn disable() -> impl Iterator<Item = (String, Option<String>)> {
    OFF.iter()
        .map(|(name, value)| ((*name).to_owned(), Some((*value).to_owned())))
}

/// Returns the state of the caches: cold if the workers or the environment disable them.
pub fn state(cold: bool) -> ShaderCache {
    if cold || is_disabled() {
        ShaderCache::Cold
    } else {
        ShaderCache::Warm
    }
}

/// Returns true if the environment disables Mesa's shader cache; parses the variable as Mesa does.
fn is_disabled() -> bool {
    let value = std::env::var(MESA).unwrap_or_default();
    ["1", "true", "yes", "y"].contains(&value.to_lowercase().as_str())
}
