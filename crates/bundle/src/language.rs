//! The language of a program, and how to build and run it.

/// The command that builds a C program in its folder.
pub(crate) const BUILD_C: &str = "cc repro.c -ldl -o repro";

/// The language of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// C99: the file `repro.c`.
    C,
    /// Rust: a package `repro`.
    Rust,
    /// JavaScript in a page: the file `repro.html`.
    Page,
}

impl Language {
    /// Returns the commands that build the program as `repro` in its folder, and then run it with `run`.
    /// `None` for a page, which a browser opens.
    pub(crate) fn commands(self, run: &str) -> Option<[String; 2]> {
        let build = match self {
            Self::C => BUILD_C,
            Self::Rust => "cargo build && cp target/debug/repro .",
            Self::Page => return None,
        };
        Some([build, run].map(str::to_owned))
    }

    /// Returns what building requires, or how to open a page and read its result, in sentences.
    pub(crate) fn needs(self) -> &'static str {
        match self {
            Self::C => "`repro.c` needs a C compiler, but no headers of the API.",
            Self::Rust => {
                "It needs Rust; `Cargo.toml` names wgpu in the version whose calls were recorded."
            }
            Self::Page => {
                "Open `repro.html` in the browser, from disk or from a local server. Its title becomes the wrong \
                 value, `right`, what the browser does not support, or the call that fails."
            }
        }
    }
}
