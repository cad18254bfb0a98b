//! The language of a program, and how it is built.

/// The language of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// C99: the file `repro.c`.
    C,
    /// Rust: a package `repro`.
    Rust,
}

impl Language {
    /// Returns the command that builds the program as `repro`, in its folder.
    pub fn build(self) -> &'static str {
        match self {
            Self::C => "cc repro.c -ldl -o repro",
            Self::Rust => "cargo build && cp target/debug/repro .",
        }
    }

    /// Returns what building needs, in a sentence.
    pub fn needs(self) -> &'static str {
        match self {
            Self::C => "`repro.c` needs a C compiler and no header of the API.",
            Self::Rust => {
                "It needs Rust; `Cargo.toml` names wgpu in the version whose calls were recorded."
            }
        }
    }
}
