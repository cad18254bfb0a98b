//! Files that describe adapters, built in or given by `--adapters`.

use crate::backend_name::BackendName;
use crate::error::AdapterError;
use crate::listen::Listen;
use crate::names::{MAX_NAME, is_name};
use crate::open::DrawingProgram;
use etalon_backend::Fault;
use etalon_browser::Browser;
use etalon_case::parse_json;
use etalon_frame::{AdapterName, without_mark};
use etalon_keeper::Server;
use etalon_record::Release;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::env::consts::{DLL_EXTENSION, EXE_SUFFIX};
use std::fs::File;
use std::io::Read;
use std::net::SocketAddr;
use std::path::{Path, PathBuf, is_separator};
use thiserror::Error;

/// The maximum size of a file in bytes.
const MAX_BYTES: u64 = 1 << 20;
/// The first part of the names of programs.
const EXTERNAL: &str = "external";
/// The maximum number of entries of a file; each starts a process.
const MAX_ENTRIES: usize = 64;

/// The folders of Vulkan driver manifests, in addition to the user's data folder.
const MANIFEST_FOLDERS: [&str; 6] = [
    "/etc/vulkan/icd.d",
    "/usr/local/etc/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
    "/usr/share/vulkan/icd.d",
    "/usr/lib/chromium",
    "/usr/lib64/chromium",
];

/// An entry of a file that describes adapters. `${NAME}` in paths and in values of the environment is
/// replaced by an environment variable; a relative path with a `/` is relative to the folder of the file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Description {
    /// The adapter's name: ASCII letters, digits, `:`, `-`, `_`, `.` and `@`, at most [`MAX_NAME`].
    pub(crate) name: String,
    pub(crate) backend: BackendName,
    /// Environment variables of the worker; `null` removes a variable.
    #[serde(default)]
    environment: BTreeMap<String, Option<String>>,
    /// Vulkan driver manifests; the first one found is used. Each is a path, or a file name that is searched
    /// in the folders of manifests.
    #[serde(default)]
    manifests: Vec<String>,
    /// The EGL library to open instead of the system's; for the backends `gl` and `gl-es`. A name without an
    /// extension gets the system's.
    egl: Option<String>,
    /// Folders searched for libraries before those of the system.
    #[serde(default)]
    library_path: Vec<String>,
    /// The words of a browser's command, for the backend `webgpu`. `{url}` and `{profile}` are replaced.
    #[serde(default)]
    browser: Vec<String>,
    /// Files of the browser's profile: names and contents.
    #[serde(default)]
    profile: BTreeMap<String, String>,
    /// The words of the command of a program, for the backend `external`.
    #[serde(default)]
    command: Vec<String>,
    /// The address at which a browser, possibly on another machine, opens the worker's page, for the backend
    /// `webgpu`.
    pub(crate) listen: Option<SocketAddr>,
    /// The server that the driver sends its commands to.
    server: Option<Server>,
    /// The index of the device in the backend's order. By default the first device; in OpenGL the device that
    /// the environment selects.
    pub(crate) device: Option<usize>,
    /// A word that the name of the device or driver must contain: if the driver that the environment selects
    /// is missing, a different driver answers.
    pub(crate) answers: Option<String>,
    /// A planted fault; files cannot set it.
    #[serde(skip)]
    pub(crate) fault: Option<Fault>,
    /// The words of a command that starts the worker elsewhere: in another userland, in a container, on
    /// another machine. Paths then refer to that system and are not checked.
    #[serde(default)]
    launcher: Vec<String>,
    /// The path of etalon where the launcher starts it; by default this program's path.
    program: Option<String>,
    /// The driver line to which the adapter's release belongs; requires `version`.
    line: Option<String>,
    /// The version of the release: numbers with dots.
    version: Option<String>,
    /// Instructions to get the driver.
    #[serde(default)]
    pub(crate) remedy: String,
}

/// An entry with paths and variables resolved on this machine.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Resolved {
    /// The words of the launcher; empty if the worker runs on this machine.
    pub(crate) launcher: Vec<String>,
    /// The path of etalon where the launcher starts it, if it differs.
    pub(crate) program: Option<PathBuf>,
    pub(crate) environment: Vec<(String, Option<String>)>,
    pub(crate) manifest: Option<PathBuf>,
    pub(crate) egl: Option<PathBuf>,
    pub(crate) library_path: Vec<PathBuf>,
    pub(crate) browser: Option<Browser>,
    pub(crate) drawing: Option<DrawingProgram>,
    pub(crate) server: Option<Server>,
    /// The address of the page, with a token of this run.
    pub(crate) listen: Option<Listen>,
}

/// The reason why an entry cannot be used on this machine.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub(crate) enum Unresolved {
    /// An environment variable is not set.
    #[error("the variable {0} is not set")]
    Variable(String),
    /// `${` without a name and `}` after it.
    #[error("`{0}` has `${{` without a variable's name and `}}`")]
    Form(String),
    /// A file or folder does not exist.
    #[error("{0}")]
    Missing(String),
}

/// Returns the entries of the built-in file.
pub(crate) fn built_in() -> Result<Vec<Description>, AdapterError> {
    parse(
        include_str!("../adapters.json"),
        "the built-in adapters.json",
    )
}

/// Returns the names of the adapters that the built-in file and another one describe.
pub fn described_names(file: Option<&Path>) -> Result<Vec<String>, AdapterError> {
    let mut descriptions = built_in()?;
    if let Some(file) = file {
        descriptions.append(&mut read(file)?);
    }
    Ok(descriptions.into_iter().map(|entry| entry.name).collect())
}

/// Returns the adapters of a line, oldest release first.
///
/// # Errors
/// If there are fewer than two releases, or two have the same version.
pub fn releases_of(
    file: Option<&Path>,
    line: &str,
) -> Result<Vec<(String, Release)>, AdapterError> {
    let entries = match file {
        Some(file) => read(file)?,
        None => built_in()?,
    };
    let what = file.map_or("the built-in adapters.json".to_owned(), |f| {
        f.display().to_string()
    });
    let described = |entry: &Description| Some((entry.name.clone(), entry.release()?));
    let described_releases: Vec<(String, Release)> = entries.iter().filter_map(described).collect();
    let mut releases: Vec<(String, Release)> = described_releases
        .iter()
        .filter(|(_, r)| r.line == line)
        .cloned()
        .collect();
    releases.sort_by_key(|(_, release)| version_key(&release.version));
    if let Some(pair) = releases.windows(2).find(|pair| pair[0].1 == pair[1].1) {
        return Err(AdapterError::SameVersion {
            file: what,
            names: [pair[0].0.clone(), pair[1].0.clone()],
            version: pair[0].1.version.clone(),
            line: line.to_owned(),
        });
    }
    if releases.len() < 2 {
        let lines: BTreeSet<String> = described_releases
            .into_iter()
            .map(|(_, release)| release.line)
            .collect();
        return Err(AdapterError::TooFewReleases {
            file: what,
            line: line.escape_default().to_string(),
            releases: releases.len(),
            lines: lines.into_iter().collect(),
        });
    }
    Ok(releases)
}

/// Returns the numbers of a version as a sort key.
fn version_key(version: &str) -> Vec<u64> {
    let parts = version.split('.').map(|part| part.parse().unwrap_or(0));
    parts.collect()
}

/// Reads the entries of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<Description>, AdapterError> {
    let what = path.display().to_string();
    let unreadable = |source| AdapterError::Unreadable {
        file: what.clone(),
        source,
    };
    let file = File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(AdapterError::TooLong { file: what });
    }
    let text = String::from_utf8(bytes).map_err(|source| AdapterError::NotText {
        file: what.clone(),
        source,
    })?;
    parse(&text, &what)
}

/// Parses entries from a text; `what` names the text in messages.
fn parse(text: &str, what: &str) -> Result<Vec<Description>, AdapterError> {
    let text = without_mark(text);
    let wrong = |source| AdapterError::NotAList {
        file: what.to_owned(),
        source,
    };
    let entries: Vec<Description> = serde_json::from_str(text).map_err(wrong)?;
    // serde would silently use the last value of a repeated key; this parser refuses it.
    parse_json(text).map_err(wrong)?;
    if entries.len() > MAX_ENTRIES {
        return Err(AdapterError::TooManyEntries {
            file: what.to_owned(),
            entries: entries.len(),
            limit: MAX_ENTRIES,
        });
    }
    let mut names = BTreeSet::new();
    for (index, entry) in entries.iter().enumerate() {
        let refused = |reason: String| AdapterError::WrongEntry {
            file: what.to_owned(),
            number: index + 1,
            // Control characters must not reach the terminal.
            name: entry.name.escape_default().to_string(),
            reason,
        };
        entry.check().map_err(refused)?;
        if !names.insert(entry.name.as_str()) {
            return Err(refused(
                "an entry before it has the same name; rename one".to_owned(),
            ));
        }
    }
    Ok(entries)
}

impl Description {
    /// Checks everything that does not depend on the machine.
    fn check(&self) -> Result<(), String> {
        if !is_name(&self.name) {
            return Err(format!(
                "a name starts with an ASCII letter or digit and continues with letters, digits, `:`, `-`, `_`, \
                 `.` and `@`, at most {MAX_NAME} in all"
            ));
        }
        let served = self.server.iter().flat_map(|server| &server.environment);
        for (name, value) in self.environment.iter().chain(served) {
            let value = value.as_deref().unwrap_or_default();
            if name.is_empty() || name.contains(['=', '\0']) || value.contains('\0') {
                return Err(format!(
                    "`{}` and its value cannot be an environment variable",
                    name.escape_default()
                ));
            }
        }
        let paths = self.manifests.iter().chain(&self.egl);
        if paths
            .chain(&self.library_path)
            .any(|p| p.is_empty() || p.contains('\0'))
        {
            return Err("a path is empty or contains a zero byte".to_owned());
        }
        self.check_launcher()?;
        self.check_browser()?;
        self.check_command()?;
        if let Some(fault) = self.server.as_ref().and_then(Server::fault) {
            return Err(fault.to_owned());
        }
        self.check_release()?;
        let is_gl = matches!(self.backend, BackendName::Gl | BackendName::GlEs);
        if self.egl.is_some() && !is_gl {
            return Err(
                "`egl` is for the backends gl and gl-es; name its folder in `library_path`"
                    .to_owned(),
            );
        }
        let chooses = self.device.is_some() || !self.manifests.is_empty();
        if self.backend == BackendName::Cpu && chooses {
            return Err(
                "the backend cpu has no `device` and no `manifests`; remove them".to_owned(),
            );
        }
        Ok(())
    }

    fn check_launcher(&self) -> Result<(), String> {
        let mut words = self.launcher.iter().chain(&self.program);
        if words.any(|word| word.contains('\0'))
            || self.launcher.first().is_some_and(String::is_empty)
        {
            return Err("`launcher` or `program` contains a zero byte, or no command".to_owned());
        }
        if self.program.is_some() && self.launcher.is_empty() {
            return Err("`program` is for entries with a `launcher`; remove it".to_owned());
        }
        let named = |text: &String| !text.contains(is_separator);
        if !self.launcher.is_empty() && self.manifests.iter().any(named) {
            return Err(
                "with a `launcher`, manifests are not searched; give the path there".to_owned(),
            );
        }
        Ok(())
    }

    fn check_browser(&self) -> Result<(), String> {
        let has = !self.browser.is_empty();
        if self.backend != BackendName::Webgpu {
            let none = !has && self.profile.is_empty() && self.listen.is_none();
            return none.then_some(()).ok_or_else(|| {
                "`browser`, `profile` and `listen` are for the backend webgpu".to_owned()
            });
        }
        if self.device.is_some() {
            return Err("the backend webgpu has no `device`; remove it".to_owned());
        }
        if has == self.listen.is_some() {
            return Err("the backend webgpu needs either `browser` or `listen`".to_owned());
        }
        let fault = self.browser().and_then(|browser| browser.fault());
        fault.map_or(Ok(()), |fault| Err(fault.to_owned()))
    }

    fn check_command(&self) -> Result<(), String> {
        let has = !self.command.is_empty();
        if self.backend != BackendName::External {
            return if has {
                Err("`command` is for the backend external; remove it".to_owned())
            } else {
                Ok(())
            };
        }
        if self.command.first().is_none_or(String::is_empty)
            || self.command.iter().any(|word| word.contains('\0'))
        {
            return Err(
                "the backend external needs `command`, words without zero bytes".to_owned(),
            );
        }
        if self.device.is_some() {
            return Err("the backend external has no `device`; remove it".to_owned());
        }
        if AdapterName::new(&self.name).backend() != EXTERNAL {
            return Err(format!("the name of a program begins with `{EXTERNAL}:`"));
        }
        Ok(())
    }

    /// Returns the browser, with the words unresolved.
    fn browser(&self) -> Option<Browser> {
        (!self.browser.is_empty()).then(|| Browser {
            command: self.browser.clone(),
            profile: self.profile.clone(),
        })
    }

    fn check_release(&self) -> Result<(), String> {
        match (&self.line, &self.version) {
            (None, None) => Ok(()),
            (Some(line), Some(version)) => {
                if !is_name(line) {
                    return Err("the name of a line follows the rules of adapter names".to_owned());
                }
                let numbers = version.split('.').all(|part| part.parse::<u64>().is_ok());
                if numbers {
                    Ok(())
                } else {
                    Err(format!(
                        "the version `{}` is not made of numbers with dots",
                        version.escape_default()
                    ))
                }
            }
            _ => Err("`line` and `version` belong together; give both or none".to_owned()),
        }
    }

    /// Returns the driver release that the entry names.
    pub(crate) fn release(&self) -> Option<Release> {
        let (Some(line), Some(version)) = (&self.line, &self.version) else {
            return None;
        };
        Some(Release {
            line: line.clone(),
            version: version.clone(),
        })
    }

    /// Resolves the entry on this machine; `folder` is the folder of its file.
    pub(crate) fn resolve(
        &self,
        folder: &Path,
        variable: &dyn Fn(&str) -> Option<String>,
    ) -> Result<Resolved, Unresolved> {
        let mut resolved = Resolved::default();
        for (name, value) in &self.environment {
            let value = value.as_deref().map(|v| expand(v, variable)).transpose()?;
            resolved.environment.push((name.clone(), value));
        }
        for word in &self.launcher {
            resolved.launcher.push(expand(word, variable)?);
        }
        let here = self.launcher.is_empty();
        let path = |text: &str| -> Result<PathBuf, Unresolved> {
            let text = expand(text, variable)?;
            // The loader searches for a name without a folder.
            let is_path = text.contains(is_separator);
            Ok(if is_path {
                folder.join(text)
            } else {
                PathBuf::from(text)
            })
        };
        for text in &self.library_path {
            let found = folder.join(path(text)?);
            if here && !found.is_dir() {
                return Err(missing(format!(
                    "the folder {} does not exist",
                    found.display()
                )));
            }
            resolved.library_path.push(found);
        }
        if let Some(text) = &self.egl {
            let mut found = path(text)?;
            if found.extension().is_none() {
                found.set_extension(DLL_EXTENSION);
            }
            if here && found.components().count() > 1 && !found.is_file() {
                return Err(missing(format!(
                    "the library {} does not exist",
                    found.display()
                )));
            }
            resolved.egl = Some(found);
        }
        resolved.listen = self.listen.map(Listen::new);
        if let Some(mut browser) = self.browser() {
            for word in &mut browser.command {
                *word = expand(word, variable)?;
            }
            if let Some(program) = browser.command.first_mut() {
                if program.contains(is_separator) {
                    *program = folder.join(&*program).to_string_lossy().into_owned();
                }
                if here && !is_program(program, variable) {
                    return Err(missing(format!("the browser {program} is not installed")));
                }
            }
            resolved.browser = Some(browser);
        }
        if !self.command.is_empty() {
            let words = self.command.iter().map(|word| expand(word, variable));
            let mut command = words.collect::<Result<Vec<_>, _>>()?;
            if let Some(program) = command.first_mut() {
                if program.contains(is_separator) {
                    *program = folder.join(&*program).to_string_lossy().into_owned();
                }
                if here && !is_program(program, variable) {
                    return Err(missing(format!("the program {program} does not exist")));
                }
            }
            resolved.drawing = Some(DrawingProgram {
                command,
                folder: here.then(|| folder.to_owned()),
            });
        }
        if let Some(mut server) = self.server.clone() {
            let values = server.environment.values_mut().flatten();
            for text in server.command.iter_mut().chain(values) {
                *text = expand(text, variable)?;
            }
            if let Some(program) = server.command.first_mut() {
                if program.contains(is_separator) {
                    *program = folder.join(&*program).to_string_lossy().into_owned();
                }
                if here && !is_program(program, variable) {
                    return Err(missing(format!("the server {program} is not installed")));
                }
            }
            resolved.server = Some(server);
        }
        let manifests = self.manifests.iter().map(|text| path(text));
        let manifests = manifests.collect::<Result<Vec<_>, _>>()?;
        if let Some(program) = &self.program {
            resolved.program = Some(path(program)?);
        }
        if let Some(first) = manifests.first() {
            let found = if here {
                manifest(&manifests, variable)
            } else {
                Some(first.clone())
            };
            let found = found.ok_or_else(|| {
                missing(format!(
                    "no Vulkan driver manifest {} found",
                    first.display()
                ))
            })?;
            resolved.manifest = Some(found);
        }
        Ok(resolved)
    }
}

fn missing(what: String) -> Unresolved {
    Unresolved::Missing(what)
}

/// Returns the first manifest that exists: as a path, then in the user's data folder, then in those of the
/// system.
fn manifest(wanted: &[PathBuf], variable: &dyn Fn(&str) -> Option<String>) -> Option<PathBuf> {
    let home = variable("XDG_DATA_HOME")
        .map(PathBuf::from)
        .or_else(|| variable("HOME").map(|h| PathBuf::from(h).join(".local/share")))
        .map(|data| data.join("vulkan/icd.d"));
    let folders: Vec<PathBuf> = home
        .into_iter()
        .chain(MANIFEST_FOLDERS.iter().map(PathBuf::from))
        .collect();
    let (paths, names): (Vec<&PathBuf>, Vec<&PathBuf>) =
        wanted.iter().partition(|p| p.components().count() > 1);
    let named = folders
        .iter()
        .flat_map(|folder| names.iter().map(move |name| folder.join(name)));
    paths
        .into_iter()
        .cloned()
        .chain(named)
        .find(|path| path.is_file())
}

/// Returns true if a program exists: as a path, or in a folder of `PATH`.
fn is_program(program: &str, variable: &dyn Fn(&str) -> Option<String>) -> bool {
    let names = [program.to_owned(), format!("{program}{EXE_SUFFIX}")];
    if program.contains(is_separator) {
        return names.iter().any(|name| Path::new(name).is_file());
    }
    let folders = variable("PATH").unwrap_or_default();
    std::env::split_paths(&folders)
        .any(|folder| names.iter().any(|name| folder.join(name).is_file()))
}

/// Replaces the variables in a text.
fn expand(text: &str, variable: &dyn Fn(&str) -> Option<String>) -> Result<String, Unresolved> {
    let mut expanded = String::new();
    let mut text_left = text;
    while let Some((before, behind)) = text_left.split_once("${") {
        expanded.push_str(before);
        let (name, after) = behind
            .split_once('}')
            .filter(|(name, _)| is_variable(name))
            .ok_or_else(|| Unresolved::Form(text.to_owned()))?;
        let value = variable(name).filter(|value| !value.is_empty());
        expanded.push_str(&value.ok_or_else(|| Unresolved::Variable(name.to_owned()))?);
        text_left = after;
    }
    expanded.push_str(text_left);
    Ok(expanded)
}

fn is_variable(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variable(name: &str) -> Option<String> {
        match name {
            "A" => Some("a".to_owned()),
            "EMPTY" => Some(String::new()),
            _ => None,
        }
    }

    #[test]
    fn the_built_in_file_is_well_formed_and_names_remedies() {
        let descriptions = built_in().unwrap();
        assert!(descriptions.len() >= 9);
        for entry in &descriptions {
            // Only a user's own file names programs.
            assert_ne!(entry.backend, BackendName::External);
            let needs = entry.backend != BackendName::Cpu;
            assert_eq!(needs, !entry.remedy.is_empty(), "{}", entry.name);
            assert_eq!(needs, entry.answers.is_some(), "{}", entry.name);
        }
    }

    #[test]
    fn variables_are_replaced() {
        assert_eq!(expand("x", &variable), Ok("x".to_owned()));
        assert_eq!(expand("${A}/$/${A}$", &variable), Ok("a/$/a$".to_owned()));
        for unset in ["EMPTY", "B"] {
            let wanted = Err(Unresolved::Variable(unset.to_owned()));
            assert_eq!(expand(&format!("${{A}}${{{unset}}}"), &variable), wanted);
        }
        for wrong in ["${", "${A", "${}", "${A B}", "${${A}}"] {
            assert_eq!(
                expand(wrong, &variable),
                Err(Unresolved::Form(wrong.to_owned()))
            );
        }
    }

    #[test]
    fn errors_in_an_entry_are_named() {
        let long: Vec<String> = (0..=MAX_ENTRIES)
            .map(|n| format!(r#"{{"name":"n{n}","backend":"cpu"}}"#))
            .collect();
        let long = format!("[{}]", long.join(","));
        for (text, start) in [
            ("", "EOF while parsing a value"),
            ("{}", "invalid type: map, expected a sequence"),
            (
                r#"[{"name":"a","backend":"cpu","colour":1}]"#,
                "unknown field `colour`",
            ),
            (
                r#"[{"name":"a","backend":"metal"}]"#,
                "unknown variant `metal`",
            ),
            (r#"[{"backend":"cpu"}]"#, "missing field `name`"),
        ] {
            let message = parse(text, "mine.json").unwrap_err().to_string();
            assert!(
                message.starts_with(&format!("mine.json: {start}")),
                "{message}"
            );
            let remedy = "; a file of adapters is a JSON array of objects with name and backend";
            assert!(message.ends_with(remedy), "{message}");
        }
        for (text, message) in [
            (
                r#"[{"name":"a","backend":"cpu"},{"name":"a","backend":"gl"}]"#,
                "entry 2 (`a`): an entry before it has the same name; rename one",
            ),
            (
                "[{\"name\":\"\\u001b[31m\",\"backend\":\"cpu\"}]",
                "entry 1 (`\\u{1b}[31m`): a name starts with an ASCII letter or digit and continues with letters, \
                 digits, `:`, `-`, `_`, `.` and `@`, at most 64 in all",
            ),
            (
                r#"[{"name":"a","backend":"gl","environment":{"A=B":"c"}}]"#,
                "entry 1 (`a`): `A=B` and its value cannot be an environment variable",
            ),
            (
                r#"[{"name":"a","backend":"gl","environment":{"A":"\u0000"}}]"#,
                "entry 1 (`a`): `A` and its value cannot be an environment variable",
            ),
            (
                r#"[{"name":"a","backend":"gl","library_path":[""]}]"#,
                "entry 1 (`a`): a path is empty or contains a zero byte",
            ),
            (
                r#"[{"name":"a","backend":"vulkan","egl":"x.so"}]"#,
                "entry 1 (`a`): `egl` is for the backends gl and gl-es; name its folder in `library_path`",
            ),
            (
                r#"[{"name":"a","backend":"cpu","device":0}]"#,
                "entry 1 (`a`): the backend cpu has no `device` and no `manifests`; remove them",
            ),
            (
                r#"[{"name":"a","backend":"gl","command":["x"]}]"#,
                "entry 1 (`a`): `command` is for the backend external; remove it",
            ),
            (
                r#"[{"name":"external:a","backend":"external"}]"#,
                "entry 1 (`external:a`): the backend external needs `command`, words without zero bytes",
            ),
            (
                r#"[{"name":"a","backend":"external","command":["x"]}]"#,
                "entry 1 (`a`): the name of a program begins with `external:`",
            ),
            (
                r#"[{"name":"a","backend":"gl","launcher":[""]}]"#,
                "entry 1 (`a`): `launcher` or `program` contains a zero byte, or no command",
            ),
            (
                r#"[{"name":"a","backend":"gl","program":"/x"}]"#,
                "entry 1 (`a`): `program` is for entries with a `launcher`; remove it",
            ),
            (
                r#"[{"name":"a","backend":"vulkan","launcher":["env"],"manifests":["x.json"]}]"#,
                "entry 1 (`a`): with a `launcher`, manifests are not searched; give the path there",
            ),
            (
                r#"[{"name":"a","backend":"gl","server":{"command":[],"socket":"/s"}}]"#,
                "entry 1 (`a`): `server` names no command",
            ),
            (
                r#"[{"name":"a","backend":"gl","server":{"command":["x"],"socket":"/s"}}]"#,
                "entry 1 (`a`): `server` needs a word with `{socket}`, the path at which it listens",
            ),
            (
                r#"[{"name":"a","backend":"gl","server":{"command":["x","{socket}"],"socket":"s"}}]"#,
                "entry 1 (`a`): the `socket` of a `server` is a path from the root",
            ),
            (
                r#"[{"name":"a","backend":"gl","line":"mesa"}]"#,
                "entry 1 (`a`): `line` and `version` belong together; give both or none",
            ),
            (
                r#"[{"name":"a","backend":"gl","line":"mesa","version":"22-rc1"}]"#,
                "entry 1 (`a`): the version `22-rc1` is not made of numbers with dots",
            ),
            (
                r#"[{"name":"a","backend":"gl","line":"me sa","version":"22"}]"#,
                "entry 1 (`a`): the name of a line follows the rules of adapter names",
            ),
            (&long, "65 entries, at most 64 are allowed; split the file"),
        ] {
            let error = parse(text, "mine.json").unwrap_err().to_string();
            assert_eq!(error, format!("mine.json: {message}"), "{text}");
        }
    }

    #[test]
    fn paths_start_at_the_file_and_names_are_looked_for() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("driver.json"), "{}").unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        let text = r#"[{"name":"a","backend":"gl-es","library_path":["${A}"],"egl":"libEGL.so.9",
            "manifests":["nobody_has_this.json","./driver.json"],"environment":{"X":null,"Y":"${A}b"}}]"#;
        let entry = &parse(text, "t").unwrap()[0];
        let resolved = entry.resolve(folder.path(), &variable).unwrap();
        assert_eq!(
            resolved,
            Resolved {
                environment: vec![
                    ("X".to_owned(), None),
                    ("Y".to_owned(), Some("ab".to_owned()))
                ],
                manifest: Some(folder.path().join("./driver.json")),
                egl: Some(PathBuf::from("libEGL.so.9")),
                library_path: vec![folder.path().join("a")],
                ..Resolved::default()
            }
        );
        let below = |name: &str| folder.path().join(name).display().to_string();
        for (key, message) in [
            (
                r#""egl":"./none.so""#,
                format!("the library {} does not exist", below("./none.so")),
            ),
            (
                r#""library_path":["none"]"#,
                format!("the folder {} does not exist", below("none")),
            ),
            (
                r#""manifests":["nobody_has_this.json"]"#,
                "no Vulkan driver manifest nobody_has_this.json found".to_owned(),
            ),
        ] {
            let text = format!(r#"[{{"name":"a","backend":"gl",{key}}}]"#);
            let error = parse(&text, "t").unwrap()[0]
                .resolve(folder.path(), &variable)
                .unwrap_err();
            assert!(matches!(error, Unresolved::Missing(_)), "{error}");
            assert_eq!(error.to_string(), message);
        }
    }
}
