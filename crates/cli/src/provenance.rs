//! The origin of records: version, commit, machine, time and command.

use crate::processors::processors;
use etalon_record::Machine;
use std::time::SystemTime;

/// The version of the suite.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Returns the commit that the binary was built from, if it is known.
pub(crate) fn commit() -> Option<String> {
    option_env!("ETALON_COMMIT").map(str::to_owned)
}

/// Returns the current time in UTC, such as `2027-01-31T12:00:00Z`.
pub(crate) fn now() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}

/// Returns the words of the command line, with the name of the program instead of its path.
pub(crate) fn command() -> Vec<String> {
    let arguments = std::env::args_os().skip(1);
    std::iter::once("etalon".to_owned())
        .chain(arguments.map(|word| word.to_string_lossy().into_owned()))
        .collect()
}

/// Returns the operating system and processor, without the host name.
pub(crate) fn machine() -> Machine {
    let field = |path: &str, key: &str, separator: char| {
        let text = std::fs::read_to_string(path).ok()?;
        let value = text.lines().find_map(|line| {
            let (name, value) = line.split_once(separator)?;
            (name.trim() == key).then(|| value.trim().trim_matches('"').to_owned())
        })?;
        (!value.is_empty()).then_some(value)
    };
    Machine {
        os: field("/etc/os-release", "PRETTY_NAME", '=')
            .unwrap_or_else(|| std::env::consts::OS.to_owned()),
        cpu: field("/proc/cpuinfo", "model name", ':')
            .unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
        cores: processors() as u32,
    }
}
