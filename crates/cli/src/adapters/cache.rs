//! The drivers' shader caches on disk, and how they are switched off.

/// Variables that make a driver neither read nor write a cache on disk. SwiftShader, softpipe and `wgpu`
/// keep none; ANGLE keeps one only for a program that hands it a place.
const OFF: [(&str, &str); 3] = [
    // Mesa since 22.0, all drivers, OpenGL and Vulkan.
    (MESA, "true"),
    // Mesa before that; a newer one does not look at it where the first is set.
    ("MESA_GLSL_CACHE_DISABLE", "true"),
    // NVIDIA's driver, OpenGL and Vulkan.
    ("__GL_SHADER_DISK_CACHE", "0"),
];

const MESA: &str = "MESA_SHADER_CACHE_DISABLE";

/// The environment of a worker whose driver finds and keeps no compiled shaders.
pub(crate) fn off() -> impl Iterator<Item = (String, Option<String>)> {
    OFF.iter()
        .map(|(name, value)| ((*name).to_owned(), Some((*value).to_owned())))
}

/// Whether the user's environment switches Mesa's shader cache off, by Mesa's own reading of it.
pub(crate) fn is_off() -> bool {
    let value = std::env::var(MESA).unwrap_or_default();
    ["1", "true", "yes", "y"].contains(&value.to_lowercase().as_str())
}
