//! How an adapter is opened.

use crate::egl::Platform;
use std::path::PathBuf;

/// Which OpenGL to open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Profile {
    /// OpenGL 3.3 to 4.6, core profile; the highest that the driver has.
    Core,
    /// OpenGL ES 3.0 to 3.2; the highest that the driver has.
    Es,
}

/// How to open an adapter.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Options {
    /// The API.
    pub profile: Profile,
    /// The way to the driver.
    pub platform: Platform,
    /// The EGL library: a path, or a name that the system's loader looks for; without it, `libEGL.so.1`.
    pub library: Option<PathBuf>,
    /// Whether to collect the driver's debug messages, see [`etalon_backend::Backend::messages`].
    pub debug: bool,
}

/// What tests may hold back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tuning {
    /// Use `glClipControl` where there is one.
    pub(crate) clip_control: bool,
}
