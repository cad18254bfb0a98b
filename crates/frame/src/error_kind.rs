//! The kinds of errors of backends.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The kind of a backend's error: the part that stays the same from one failure to the next. It contains no
/// address, no size and none of the driver's words.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorKind {
    /// The device was lost.
    DeviceLost,
    /// The driver refused an object or an allocation.
    Resource {
        /// The object: `a buffer`.
        object: String,
        /// The result code of the API, if it gave one: `ERROR_OUT_OF_HOST_MEMORY`.
        code: Option<String>,
    },
    /// A shader could not be translated or compiled.
    Shader(String),
    /// A condition that the backend's own logic rules out.
    Internal {
        /// The condition, without the numbers and names of this scene: `the scene is not prepared`.
        condition: String,
        /// The result code of the API, if it gave one: `GL_INVALID_OPERATION`.
        code: Option<String>,
    },
}

impl fmt::Display for ErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (text, code) = match self {
            Self::DeviceLost => return f.write_str("the device was lost"),
            Self::Shader(shader) => return write!(f, "shader {shader}"),
            Self::Resource { object, code } => {
                write!(f, "the driver refused ")?;
                (object, code)
            }
            Self::Internal { condition, code } => (condition, code),
        };
        f.write_str(text)?;
        match code {
            Some(code) => write!(f, " ({code})"),
            None => Ok(()),
        }
    }
}
