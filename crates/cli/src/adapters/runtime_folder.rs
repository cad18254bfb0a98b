//! The run-time folder that drivers expect.

/// Drivers complain on standard error where the run-time folder is not set.
pub(super) fn quiet() -> Option<(String, String)> {
    let name = "XDG_RUNTIME_DIR";
    match std::env::var_os(name) {
        Some(_) => None,
        None => Some((
            name.to_owned(),
            std::env::temp_dir().to_string_lossy().into_owned(),
        )),
    }
}
