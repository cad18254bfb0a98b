//! From Vulkan's result codes to the seam's errors.

use ash::vk;
use etalon_backend::{BackendError, Unavailable};

/// Names what was being done when a Vulkan call failed.
pub(crate) trait Check<T> {
    /// `DEVICE_LOST` becomes [`BackendError::DeviceLost`], all else [`BackendError::Resource`].
    fn check(self, what: &str) -> Result<T, BackendError>;
}

impl<T> Check<T> for Result<T, vk::Result> {
    fn check(self, what: &str) -> Result<T, BackendError> {
        self.map_err(|code| match code {
            vk::Result::ERROR_DEVICE_LOST => BackendError::DeviceLost(what.to_owned()),
            code => BackendError::Resource {
                what: what.to_owned(),
                message: describe(code),
            },
        })
    }
}

/// An error that the backend's own logic rules out.
pub(crate) fn internal(message: &str) -> BackendError {
    BackendError::Internal(message.to_owned())
}

/// A code's name and meaning, as in `ERROR_OUT_OF_HOST_MEMORY: A host memory allocation has failed`.
pub(crate) fn describe(code: vk::Result) -> String {
    format!("{code:?}: {code}")
}

/// A driver that fails while it is being opened cannot be used.
pub(crate) fn unavailable(error: &BackendError) -> Unavailable {
    Unavailable::new(
        error.to_string(),
        "update the driver, or choose another adapter",
    )
}
