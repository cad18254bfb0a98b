//! `etalon check`.

use crate::cases::library;
use crate::check::pairs::{self, ToldPairs};
use crate::check::{CheckedCase, CheckedFile, check};
use crate::failure::{Failure, UNEXPECTED, USAGE};
use crate::flags::{CaseProfile, OutputFormat};
use crate::output::{print, print_json, say};
use clap::Args;
use etalon_case::{CaseError, CaseFile, Library};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Case files, or folders of them. Default: the built-in cases
    #[arg(value_name = "PATH")]
    pub(crate) paths: Vec<PathBuf>,
    /// Share of each family of cases to judge; all cases are built
    #[arg(long, value_enum, default_value = "quick")]
    pub(crate) profile: CaseProfile,
    /// Count instead the pairs of facts that meet in draws, such as depth bias and several samples: pairs with a scene,
    /// pairs that cannot meet (cases/pairs.txt), and pairs that no scene has. Random scenes do not count
    #[arg(long)]
    pub(crate) pairs: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Checks case files without a driver.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let mut files = Vec::new();
    let mut broken = Vec::new();
    for path in &arguments.paths {
        let found = if path.is_dir() {
            Library::read_each(path)
        } else {
            vec![read(path)?]
        };
        for file in found {
            match file {
                Ok(file) => files.push(file),
                Err(error) => broken.push(error),
            }
        }
    }
    if arguments.paths.is_empty() {
        files = library(None)?.files().cloned().collect();
    }
    if files.is_empty() && broken.is_empty() {
        return Err(Failure::nothing("there are no case files"));
    }
    if arguments.pairs {
        return told_pairs(&files, &broken, arguments);
    }
    let checked = check(&files, arguments.profile.into());
    let report = ToldCheck {
        broken: &broken,
        files: &checked,
        // The cases of a single file fit on a screen.
        each: arguments.paths.iter().any(|path| path.is_file()),
    };
    match arguments.format {
        OutputFormat::Text => print(&report.text())?,
        OutputFormat::Json => print_json(&report.json())?,
    }
    Ok(match (report.errors(), report.warnings()) {
        (1.., _) => USAGE,
        (0, 1..) => UNEXPECTED,
        (0, 0) => 0,
    })
}

/// Prints the pairs of facts that meet in the cases.
fn told_pairs(
    files: &[CaseFile],
    broken: &[CaseError],
    arguments: &Arguments,
) -> Result<u8, Failure> {
    let pairs = ToldPairs::new(&pairs::count(files, arguments.profile.into()));
    for error in broken {
        say!("error: {error}");
    }
    match arguments.format {
        OutputFormat::Text => print(&pairs.text())?,
        OutputFormat::Json => print_json(&pairs.json())?,
    }
    Ok(if broken.is_empty() { 0 } else { USAGE })
}

/// Reads one case file. Its ids follow from its path below a folder named `cases`, or from its name alone.
fn read(path: &Path) -> Result<Result<CaseFile, CaseError>, Failure> {
    let text = fs::read_to_string(path)
        .map_err(|e| Failure::usage(format!("{}: cannot be read: {e}", path.display())))?;
    let absolute = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let parts: Vec<String> = absolute
        .components()
        .map(|c| c.as_os_str().to_string_lossy().into_owned())
        .collect();
    let start = parts
        .iter()
        .rposition(|part| part == "cases")
        .map_or(parts.len() - 1, |index| index + 1);
    Ok(CaseFile::parse(&parts[start..].join("/"), &text))
}

/// The result of a check, for text and JSON.
struct ToldCheck<'a> {
    broken: &'a [CaseError],
    files: &'a [CheckedFile],
    /// True if the text lists each case.
    each: bool,
}

impl ToldCheck<'_> {
    fn errors(&self) -> usize {
        self.broken.len() + self.files.iter().map(|f| f.errors.len()).sum::<usize>()
    }

    fn warnings(&self) -> usize {
        self.files.iter().map(|f| f.warnings.len()).sum()
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for error in self.broken {
            text.push_str(&format!("error: {error}\n"));
        }
        for file in self.files {
            let judged: Vec<&CheckedCase> = file
                .cases
                .iter()
                .filter(|c| !c.assertions.is_empty())
                .collect();
            text.push_str(&format!("{}: {} cases", file.name, file.all));
            match blurriest(&judged) {
                Some((worst, codes)) => {
                    let (share, mean) = figures(judged.iter().copied());
                    text.push_str(&format!(
                        ", {} judged: {share:.1} % of channels asserted, {mean:.2} codes allowed, {codes:.2} by {}\n",
                        judged.len(),
                        worst.id
                    ));
                }
                None => text.push('\n'),
            }
            for error in &file.errors {
                text.push_str(&format!("  error: {error}\n"));
            }
            for warning in &file.warnings {
                text.push_str(&format!("  warning: {warning}\n"));
            }
            for case in judged.iter().filter(|_| self.each) {
                let (share, mean) = figures([*case]);
                text.push_str(&format!("  {share:5.1} % {mean:8.2} codes  {}\n", case.id));
            }
        }
        let cases: usize = self.files.iter().map(|f| f.all).sum();
        text.push_str(&format!(
            "{} files, {cases} cases: {} errors, {} warnings\n",
            self.files.len() + self.broken.len(),
            self.errors(),
            self.warnings()
        ));
        text
    }

    fn json(&self) -> Value {
        let place = |e: &CaseError| json!({ "file": e.file, "line": e.line, "key": e.key, "message": e.message });
        let places = |errors: &[CaseError]| -> Vec<Value> { errors.iter().map(place).collect() };
        let files: Vec<Value> = self
            .files
            .iter()
            .map(|file| {
                let cases: Vec<Value> = file
                    .cases
                    .iter()
                    .map(|case| {
                        let aspects: Vec<Value> = case
                            .assertions
                            .iter()
                            .map(|a| {
                                json!({
                                    "aspect": a.aspect,
                                    "asserted": a.share(),
                                    "codes": a.sharpness(),
                                    "yardstick_codes": a.yardstick_sharpness(),
                                })
                            })
                            .collect();
                        json!({ "case": case.id, "asserts": case.asserts, "aspects": aspects })
                    })
                    .collect();
                json!({
                    "file": file.name,
                    "cases": file.all,
                    "judged": cases,
                    "errors": places(&file.errors),
                    "warnings": places(&file.warnings),
                })
            })
            .collect();
        json!({ "files": files, "unreadable": places(self.broken), "errors": self.errors(), "warnings": self.warnings() })
    }
}

/// Returns the share of asserted channels in percent, and the mean number of legal codes of these.
fn figures<'c>(cases: impl IntoIterator<Item = &'c CheckedCase>) -> (f64, f64) {
    let (mut channels, mut asserted, mut codes) = (0_u64, 0_u64, 0_u64);
    for a in cases.into_iter().flat_map(|c| &c.assertions) {
        channels += a.channels;
        asserted += a.asserted;
        codes = codes.saturating_add(a.codes);
    }
    let ratio = |part: u64, whole: u64| {
        if whole == 0 {
            0.0
        } else {
            part as f64 / whole as f64
        }
    };
    (100.0 * ratio(asserted, channels), ratio(codes, asserted))
}

/// Returns the case with the most legal codes per channel, and their number.
fn blurriest<'c>(cases: &[&'c CheckedCase]) -> Option<(&'c CheckedCase, f64)> {
    let shares = cases.iter().map(|case| (*case, figures([*case]).1));
    shares.reduce(|worst, share| if share.1 > worst.1 { share } else { worst })
}
