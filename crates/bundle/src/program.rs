//! The program of a bundle.

use crate::archive::File;
use crate::language::Language;

/// The program of a bundle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// The program's language.
    pub language: Language,
    /// The files from which the program is built, and other files that show the same bug.
    pub files: Vec<File>,
}
