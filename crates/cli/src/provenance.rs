//! What a record of any kind states about the process that wrote it: suite, machine, time, command.

use etalon_record::Machine;
use std::time::SystemTime;

/// The suite's version.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The commit that the binary was built from, where that is known.
pub(crate) fn commit() -> Option<String> {
    option_env!("ETALON_COMMIT").map(str::to_owned)
}

/// The time, in UTC, as `2027-01-31T12:00:00Z`.
pub(crate) fn now() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}

/// The command line, as the program is called and not where it lies.
pub(crate) fn command() -> Vec<String> {
    let own = std::env::args_os().skip(1);
    std::iter::once("etalon".to_owned())
        .chain(own.map(|word| word.to_string_lossy().into_owned()))
        .collect()
}

/// The machine as it names itself, without its owner's names for it.
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
        cores: std::thread::available_parallelism().map_or(1, |n| n.get() as u32),
    }
}
