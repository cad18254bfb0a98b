//! The origin of records: version, commit, machine, time and command.

use crate::processors::processors;
use etalon_record::{Machine, Provenance};
use std::time::SystemTime;

/// Returns the origin of what this process begins to record now.
pub(crate) fn here() -> Provenance {
    Provenance {
        etalon: env!("CARGO_PKG_VERSION").to_owned(),
        // Set by the build script if the commit is known.
        commit: option_env!("ETALON_COMMIT").map(str::to_owned),
        machine: machine(),
        started: now(),
        command: command(),
    }
}

/// Returns the current time in UTC, such as `2027-01-31T12:00:00Z`.
pub(crate) fn now() -> String {
    written(SystemTime::now())
}

/// Formats a time. Times before 1970, which a machine without a clock battery can have, become the start of
/// 1970.
fn written(time: SystemTime) -> String {
    let time = time.max(SystemTime::UNIX_EPOCH);
    humantime::format_rfc3339_seconds(time).to_string()
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
            .or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok())
            .unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
        cores: processors() as u32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_clock_before_1970_is_no_panic() {
        let day = Duration::from_secs(86_400);
        let before = SystemTime::UNIX_EPOCH - day;
        assert_eq!(written(before), "1970-01-01T00:00:00Z");
        assert_eq!(
            written(SystemTime::UNIX_EPOCH + day),
            "1970-01-02T00:00:00Z"
        );
    }
}
