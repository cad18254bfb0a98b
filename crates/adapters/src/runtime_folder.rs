//! The run-time folder of drivers.

/// Returns a value for `XDG_RUNTIME_DIR` if it is not set; drivers print warnings without it.
pub(crate) fn default_runtime_folder() -> Option<(String, String)> {
    let name = "XDG_RUNTIME_DIR";
    match std::env::var_os(name) {
        Some(_) => None,
        None => Some((
            name.to_owned(),
            std::env::temp_dir().to_string_lossy().into_owned(),
        )),
    }
}
