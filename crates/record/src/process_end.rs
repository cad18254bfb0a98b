//! The end of a process that was lost.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The way in which a process was lost.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum LossKind {
    /// The worker exited or was ended by a signal.
    #[default]
    Died,
    /// The worker did not answer in time.
    Timeout,
    /// The worker exceeded its memory limit.
    Memory,
    /// The worker's output was not a message of the protocol.
    Garbage,
    /// The worker could not be started again.
    NotStarted,
}

/// The end of a process that was lost. Its `Display` is the cause and the end of standard error, which errors on
/// starting a worker show too.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProcessEnd {
    /// The way in which the process was lost.
    pub kind: LossKind,
    /// The number of the signal that ended the process, if one did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signal: Option<i32>,
    /// The exit status; on Windows, the code of an exception is a negative number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exit: Option<i32>,
    /// The end of the launcher between suite and process, which says nothing about the process itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub launcher: Option<ExitStatus>,
    /// The limit that the process broke: seconds for `Timeout`, MiB for `Memory`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// The memory that the process held when it was stopped, in MiB; only for `Memory`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<u64>,
    /// The fault of the message for `Garbage`, and the error for `NotStarted`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub error: String,
    /// The end of the process's standard error.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub stderr: String,
    /// Seconds from the time when the process could begin the case until the loss was noticed.
    pub seconds: f64,
}

/// The end of a process: by a signal, or with a status.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExitStatus {
    /// The number of the signal that ended the process, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signal: Option<i32>,
    /// The exit status, if the process exited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exit: Option<i32>,
}

impl ProcessEnd {
    /// Returns the cause in a few words.
    pub fn cause(&self) -> String {
        let own = ExitStatus {
            signal: self.signal,
            exit: self.exit,
        };
        match (self.kind, self.launcher) {
            (LossKind::Died, Some(launcher)) => {
                format!("the worker was lost, and its launcher {launcher}")
            }
            (LossKind::Died, None) => match own {
                ExitStatus {
                    signal: None,
                    exit: None,
                } => "the worker closed its pipe".to_owned(),
                own => format!("the worker {own}"),
            },
            (LossKind::Timeout, _) => match self.limit {
                Some(limit) => format!("no answer within {limit} s"),
                None => "the worker did not answer in time".to_owned(),
            },
            (LossKind::Memory, _) => match (self.held, self.limit) {
                (Some(held), Some(limit)) => {
                    format!("the worker held {held} MiB of memory, more than {limit} MiB")
                }
                _ => "the worker exceeded its memory limit".to_owned(),
            },
            (LossKind::Garbage, _) => match self.error.as_str() {
                "" => "the worker wrote an invalid message".to_owned(),
                error => format!("the worker wrote garbage: {error}"),
            },
            (LossKind::NotStarted, _) => match self.error.as_str() {
                "" => "the worker could not be started".to_owned(),
                error => error.to_owned(),
            },
        }
    }
}

impl fmt::Display for ProcessEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.cause())?;
        match self.stderr.as_str() {
            "" => Ok(()),
            text => write!(f, "; stderr ends with: {text}"),
        }
    }
}

impl fmt::Display for ExitStatus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.signal, self.exit) {
            (Some(signal), _) => match signal_name(signal) {
                Some(name) => write!(f, "died of signal {signal} ({name})"),
                None => write!(f, "died of signal {signal}"),
            },
            // Windows exceptions are negative, and known by their hexadecimal codes.
            (None, Some(exit)) if exit < 0 => {
                write!(f, "ended with exit status 0x{exit:08X}")?;
                match exception_name(exit) {
                    Some(name) => write!(f, " ({name})"),
                    None => Ok(()),
                }
            }
            (None, Some(exit)) => write!(f, "ended with exit status {exit}"),
            (None, None) => f.write_str("ended"),
        }
    }
}

/// Returns the name of a signal that ends processes, by its number on most Linux machines.
fn signal_name(signal: i32) -> Option<&'static str> {
    Some(match signal {
        1 => "SIGHUP",
        2 => "SIGINT",
        3 => "SIGQUIT",
        4 => "SIGILL",
        5 => "SIGTRAP",
        6 => "SIGABRT",
        7 => "SIGBUS",
        8 => "SIGFPE",
        9 => "SIGKILL",
        11 => "SIGSEGV",
        13 => "SIGPIPE",
        14 => "SIGALRM",
        15 => "SIGTERM",
        24 => "SIGXCPU",
        25 => "SIGXFSZ",
        31 => "SIGSYS",
        _ => return None,
    })
}

/// Returns the name of the exception that ended a process of Windows, by its exit status.
fn exception_name(exit: i32) -> Option<&'static str> {
    Some(match exit as u32 {
        0x8000_0003 => "breakpoint",
        0xC000_0005 => "access violation",
        0xC000_001D => "illegal instruction",
        0xC000_0094 => "division by zero",
        0xC000_00FD => "stack overflow",
        0xC000_0374 => "heap corruption",
        0xC000_0409 => "abort",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_way_to_lose_a_process_has_its_cause() {
        let died = |signal, exit| ProcessEnd {
            signal,
            exit,
            ..ProcessEnd::default()
        };
        let cause = |end: ProcessEnd| end.cause();
        assert_eq!(
            cause(died(Some(6), None)),
            "the worker died of signal 6 (SIGABRT)"
        );
        assert_eq!(cause(died(Some(-7), None)), "the worker died of signal -7");
        assert_eq!(
            cause(died(None, Some(3))),
            "the worker ended with exit status 3"
        );
        let violation = died(None, Some(0xC000_0005_u32 as i32));
        let text = "the worker ended with exit status 0xC0000005 (access violation)";
        assert_eq!(cause(violation), text);
        assert_eq!(cause(died(None, None)), "the worker closed its pipe");
        for (kind, error, text) in [
            (LossKind::Garbage, "", "the worker wrote an invalid message"),
            (LossKind::Garbage, "x", "the worker wrote garbage: x"),
            (LossKind::NotStarted, "", "the worker could not be started"),
            (LossKind::NotStarted, "no such file", "no such file"),
            (LossKind::Timeout, "", "the worker did not answer in time"),
            (LossKind::Memory, "", "the worker exceeded its memory limit"),
        ] {
            let end = ProcessEnd {
                kind,
                error: error.to_owned(),
                ..ProcessEnd::default()
            };
            assert_eq!(cause(end), text);
        }
        let launched = ProcessEnd {
            launcher: Some(ExitStatus {
                signal: None,
                exit: Some(1),
            }),
            stderr: "no such container".to_owned(),
            ..ProcessEnd::default()
        };
        let text = "the worker was lost, and its launcher ended with exit status 1; stderr ends with: no such container";
        assert_eq!(launched.to_string(), text);
        let limited = |kind, limit, held| ProcessEnd {
            kind,
            limit: Some(limit),
            held,
            ..ProcessEnd::default()
        };
        assert_eq!(
            cause(limited(LossKind::Timeout, 0.3, None)),
            "no answer within 0.3 s"
        );
        let text = "the worker held 200 MiB of memory, more than 192 MiB";
        assert_eq!(cause(limited(LossKind::Memory, 192.0, Some(200))), text);
    }
}
