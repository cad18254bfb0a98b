//! The options of an adapter: the API, and how to reach the driver.

use crate::egl::Platform;
use etalon_backend::{Fault, RecordedContext};
use std::path::PathBuf;

/// The OpenGL variant of a context.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Profile {
    /// The highest available version of OpenGL 3.3 to 4.6, core profile.
    Core,
    /// The highest available version of OpenGL ES 3.0 to 3.2.
    Es,
}

/// Options for [`crate::open`].
#[derive(Clone, Debug, PartialEq)]
pub struct GlOptions {
    /// The variant of OpenGL.
    pub profile: Profile,
    /// The platform that selects the driver.
    pub platform: Platform,
    /// The EGL library, a path or a name for the system's loader; `libEGL.so.1` by default.
    pub library: Option<PathBuf>,
    /// Enables debug output. Its messages are returned by [`etalon_backend::Backend::messages`].
    pub debug: bool,
    /// A fault that a test plants in the calls to the driver or in the values read back.
    pub fault: Option<Fault>,
    /// Records the calls of the first scene that is prepared, for [`etalon_backend::Backend::recording`]. The context
    /// then has no timer.
    pub record: bool,
}

impl GlOptions {
    /// Returns the context that recorded calls need. `version` is its major and minor version.
    pub(crate) fn recorded_context(&self, version: (u32, u32)) -> RecordedContext {
        RecordedContext::Egl {
            es: self.profile == Profile::Es,
            version: [version.0, version.1],
            library: self.library.as_ref().map(|p| p.display().to_string()),
            device: match self.platform {
                Platform::Surfaceless => None,
                Platform::Device(index) => u32::try_from(index).ok(),
            },
        }
    }
}

/// Capabilities that tests can disable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tuning {
    /// Use `glClipControl` if available.
    pub(crate) clip_control: bool,
}
