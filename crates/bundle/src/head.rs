//! The head of a program: a comment for its readers.

use crate::c::{comment, paragraph};

/// The head of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Head {
    /// The bug, in one line.
    pub title: String,
    /// A sentence about the wrong value.
    pub sentence: String,
    /// What the program draws, and with which states: one line for each attachment, pass and draw.
    pub scene: Vec<String>,
    /// The command that runs the program on the driver.
    pub run: String,
}

/// The headers of a C program, and its exit statuses.
const BEGINNING: &str = r#"
#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BUG = 1, FAILED = 2, LACKS = 77 };
"#;

/// Returns a line of the scene as lines of a comment. A continued line is indented further.
fn indented(line: &str) -> String {
    let depth = line.len() - line.trim_start().len();
    let text = paragraph(line);
    let mut indent = " ".repeat(depth + 2);
    let mut lines = String::new();
    for line in text.lines() {
        lines += &format!(" *{indent}{}\n", line.trim_start_matches(" *"));
        indent = " ".repeat(depth + 4);
    }
    lines
}

impl Head {
    /// Returns the beginning of a C program. `argument` describes its first argument, and `names` how the
    /// API's names are declared.
    pub(crate) fn beginning(&self, build: &str, argument: &str, names: &str) -> String {
        format!(
            "/*\n{} *\n{} *\n * What it draws:\n{} *\n * Build and run:\n *   {build}\n *   {}\n *\n{}{} */\n{BEGINNING}",
            paragraph(&self.title),
            paragraph(&self.sentence),
            self.scene
                .iter()
                .map(|line| indented(line))
                .collect::<String>(),
            comment(&self.run),
            paragraph(&format!(
                "The optional first argument is {argument}. Exit status: 1 if the bug is there, 0 if not, 77 if \
                 the driver lacks something, 2 if a call fails."
            )),
            paragraph(&format!(
                "Needs only the headers of the C library, not those of the API. {names}"
            )),
        )
    }
}
