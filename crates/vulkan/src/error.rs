//! Vulkan result codes as backend errors.

use ash::vk;
use etalon_backend::{BackendError, Unavailable};

/// Adds the failed operation to a Vulkan error.
pub(crate) trait Check<T> {
    /// Maps `DEVICE_LOST` to a lost device, and other codes to a refusal by the driver.
    fn check(self, what: &str) -> Result<T, BackendError>;
}

impl<T> Check<T> for Result<T, vk::Result> {
    fn check(self, what: &str) -> Result<T, BackendError> {
        self.map_err(|code| match code {
            vk::Result::ERROR_DEVICE_LOST => BackendError::lost(what),
            code => BackendError::refused(what, describe(code)).with_code(format!("{code:?}")),
        })
    }
}

/// Returns the error of a condition that the backend's logic rules out.
pub(crate) fn internal(condition: &str) -> BackendError {
    BackendError::internal(condition)
}

/// Returns a code's name and meaning: `ERROR_OUT_OF_HOST_MEMORY: A host memory allocation has
/// failed`.
pub(crate) fn describe(code: vk::Result) -> String {
    format!("{code:?}: {code}")
}

/// Returns the error of an adapter whose driver failed when it was opened.
pub(crate) fn unavailable(error: &BackendError) -> Unavailable {
    Unavailable::new(
        error.to_string(),
        "update the driver, or choose another adapter",
    )
}
