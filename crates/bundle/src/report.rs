//! The report that goes with a program. It answers a maintainer's first questions.

use crate::language::Language;
use etalon_frame::AdapterInfo;
use std::fmt::Write;

/// The facts of a report.
#[derive(Clone, Debug)]
pub struct Report {
    /// The bug, in one line.
    pub title: String,
    /// A sentence about the first wrong texel or counter.
    pub sentence: String,
    /// The clause that is violated.
    pub clause: Option<String>,
    /// The device and the driver.
    pub device: AdapterInfo,
    /// The machine: operating system and processor.
    pub machine: String,
    /// The releases that were tried.
    pub versions: Option<BadReleases>,
    /// The first wrong values.
    pub expected: Vec<WrongValue>,
    /// The states that differ from the default.
    pub states: Vec<String>,
    /// The number of runs that failed, and of all runs; `None` if the case was not drawn for the report.
    pub frequency: Option<[u32; 2]>,
    /// The result of the API's own checks.
    pub checks: Checks,
    /// The program's language.
    pub language: Language,
    /// The command that runs the program.
    pub run: String,
    /// The program's last line of output, if it was built and run and showed the bug.
    pub built: Option<String>,
    /// Words to search for in the tracker.
    pub search: Vec<String>,
    /// The operations that lead to the value, in order.
    pub story: Vec<String>,
    /// The other files of the bundle, with descriptions.
    pub files: Vec<(String, String)>,
}

/// The result of an API's own checks: debug output, or a validation layer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Checks {
    /// The API's checks report nothing.
    Clean,
    /// The API's checks were not available.
    Absent,
    /// The API accepts the calls, but the checks of the API below it report this about the calls of its
    /// implementation.
    Below(String),
}

/// The releases that have a bug.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadReleases {
    /// The ranges, in words.
    pub bad: String,
    /// The newest release that was tried, and whether it has the bug.
    pub newest: Option<(String, bool)>,
}

/// A wrong value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongValue {
    /// The place, in words.
    pub place: String,
    /// The expected value.
    pub due: String,
    /// The value that came back.
    pub actual: String,
}

impl Report {
    /// Returns how to run the program, in one line.
    pub fn way(&self) -> String {
        match self.language.commands(&self.run) {
            Some(commands) => format!("build and run: {}", commands.join(" && ")),
            None => "open repro.html in the browser".to_owned(),
        }
    }

    /// Returns the report as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!("# {}\n\n", plain(&self.title));
        text.push_str(
            "> Before you file this: run the program yourself, read the clause, and look for duplicates. ",
        );
        if !self.search.is_empty() {
            let words: Vec<String> = self.search.iter().map(|word| code(word)).collect();
            let _ = write!(text, "Words to search for: {}. ", words.join(", "));
        }
        text.push_str("Then delete these lines.\n\n");
        let _ = write!(text, "{}\n\n", plain(&self.sentence));
        if let Some(clause) = &self.clause {
            let _ = write!(text, "Violated: {}\n\n", plain(clause));
        }
        self.device_block(&mut text);
        text.push_str("## Expected and actual\n\n| where | must be | is |\n|---|---|---|\n");
        for wrong in &self.expected {
            let _ = writeln!(
                text,
                "| {} | {} | {} |",
                plain(&wrong.place),
                plain(&wrong.due),
                plain(&wrong.actual)
            );
        }
        let _ = match self.frequency {
            Some([failed, runs]) => write!(
                text,
                "\nIt fails in {failed} of {runs} runs, each in its own process. "
            ),
            None => write!(text, "\nThe values come from a saved run. "),
        };
        text.push_str(&match &self.checks {
            Checks::Clean => {
                "The API's own checks (debug output, validation) report nothing.\n".to_owned()
            }
            Checks::Absent => "The API's own checks were not available.\n".to_owned(),
            Checks::Below(message) => format!(
                "The API accepts the calls; below it the driver's debug output says: {}\n",
                plain(message)
            ),
        });
        text.push_str("\n## Run it\n\n");
        let needs = self.language.needs();
        let _ = match self.language.commands(&self.run) {
            Some(commands) => writeln!(
                text,
                "```sh\n{}\n```\n\n{needs} Exit status 1: the bug is there; 0: it is not; 77: the driver lacks something; 2: a call \
                 fails.",
                commands.join("\n")
            ),
            None => writeln!(text, "{needs}"),
        };
        text.push_str(&match &self.built {
            Some(line) => format!(
                "\nBuilt and run on the driver above, it ends with 1: `{}`\n",
                line.replace('`', "'")
            ),
            None => "\nIt was not run on the driver above.\n".to_owned(),
        });
        if !self.states.is_empty() {
            text.push_str("\n## State\n\nStates that differ from the default:\n\n");
            for state in &self.states {
                let _ = writeln!(text, "- {}", code(state));
            }
        }
        if !self.story.is_empty() {
            text.push_str("\n## How the value comes about\n\n```\n");
            for line in &self.story {
                let _ = writeln!(text, "{}", line.replace("```", "'''"));
            }
            text.push_str("```\n");
        }
        if !self.files.is_empty() {
            text.push_str("\n## Files\n\n");
            for (name, what) in &self.files {
                let _ = writeln!(text, "- `{name}`: {what}");
            }
        }
        text
    }

    fn device_block(&self, text: &mut String) {
        text.push_str("| | |\n|---|---|\n");
        let device = &self.device;
        let mut row = |name: &str, value: &str| {
            if !value.is_empty() {
                let _ = writeln!(text, "| {name} | {} |", plain(value));
            }
        };
        row("API", &device.api_version);
        row("device", &device.device);
        row(
            "driver",
            &format!("{} {}", device.driver, device.driver_version),
        );
        row("system", &self.machine);
        if let Some(versions) = &self.versions {
            row("releases with the bug", &versions.bad);
            if let Some((newest, bad)) = &versions.newest {
                let still = if *bad {
                    format!("still in {newest}")
                } else {
                    format!("not in {newest}")
                };
                row("newest release tried", &still);
            }
        }
        text.push('\n');
    }
}

/// Escapes a text as one line of plain Markdown.
fn plain(text: &str) -> String {
    let mut safe = String::new();
    for c in text.chars() {
        match c {
            // At the start of a paragraph it would begin a quotation.
            '>' if !safe.trim().is_empty() => safe.push('>'),
            '\n' | '\r' | '\t' => safe.push(' '),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '&' => safe.push_str("&amp;"),
            '|' | '`' | '*' | '[' | ']' | '\\' | '#' => {
                safe.push('\\');
                safe.push(c);
            }
            c => safe.push(c),
        }
    }
    safe
}

/// Returns a text as inline code.
fn code(text: &str) -> String {
    format!("`{}`", text.replace(['`', '\n', '\r'], "'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        Report {
            title: "lines have the facing of the triangle before them".to_owned(),
            sentence: "texel 3,4 is [0, 0, 255, 255]".to_owned(),
            clause: Some("OpenGL 4.6: 14.6.1".to_owned()),
            device: AdapterInfo {
                name: "gl:softpipe".to_owned(),
                backend: "gl".to_owned(),
                device: "softpipe".to_owned(),
                driver: "Mesa".to_owned(),
                driver_version: "22.3.6".to_owned(),
                driver_id: String::new(),
                api_version: "OpenGL 3.3 core".to_owned(),
                software: true,
                offer: None,
            },
            machine: "Linux".to_owned(),
            versions: Some(BadReleases {
                bad: "22.3.6 to 26.2.6".to_owned(),
                newest: Some(("26.2.6".to_owned(), true)),
            }),
            expected: vec![WrongValue {
                place: "texel 3,4 | red".to_owned(),
                due: "255".to_owned(),
                actual: "0".to_owned(),
            }],
            states: vec!["cull_mode: back".to_owned()],
            frequency: Some([20, 20]),
            checks: Checks::Clean,
            language: Language::C,
            run: "GALLIUM_DRIVER=softpipe ./repro".to_owned(),
            built: Some("texel 3,4 is wrong".to_owned()),
            search: vec!["facing".to_owned()],
            story: Vec::new(),
            files: vec![("repro.c".to_owned(), "the program".to_owned())],
        }
    }

    #[test]
    fn a_report_has_what_a_maintainer_asks() {
        let text = report().markdown();
        for part in [
            "# lines have the facing",
            "look for duplicates",
            "`facing`",
            "| driver | Mesa 22.3.6 |",
            "| releases with the bug | 22.3.6 to 26.2.6 |",
            "still in 26.2.6",
            "| texel 3,4 \\| red | 255 | 0 |",
            "20 of 20 runs",
            "GALLIUM_DRIVER=softpipe ./repro",
            "it ends with 1: `texel 3,4 is wrong`",
            "- `cull_mode: back`",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }

    #[test]
    fn hostile_names_stay_text() {
        let mut hostile = report();
        hostile.title = "a\n# b <script>alert(1)</script> `x` [y](z)".to_owned();
        hostile.states = vec!["`; rm -rf`\n".to_owned()];
        let text = hostile.markdown();
        assert!(
            !text.contains("<script>") && !text.contains("\n# b"),
            "{text}"
        );
        assert!(text.contains("\\[y\\](z)"), "{text}");
        assert!(text.contains("- `'; rm -rf''`"), "{text}");
    }
}
