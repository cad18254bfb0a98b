//! The report on a lost worker: exit status, signal and the end of its standard error.

use crate::loss::Loss;
use etalon_record::{LossKind, ProcessEnd};
use std::process::ExitStatus;

/// The report on a lost worker.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ExitReport {
    /// A message for people: the cause, and the end of standard error.
    pub(crate) message: String,
    /// The same facts for programs.
    pub(crate) end: ProcessEnd,
}

impl ExitReport {
    /// Returns the report on a worker that was lost in this way. `status` is the exit status of its
    /// process, if the process ended by itself; a launcher's status says nothing about the worker.
    pub(crate) fn new(
        loss: Loss,
        status: Option<ExitStatus>,
        launched: bool,
        stderr: String,
    ) -> Self {
        let (kind, cause) = match loss {
            Loss::Timeout(limit) => (
                LossKind::Timeout,
                format!("no answer within {} s", limit.as_secs_f64()),
            ),
            Loss::Memory { held, limit } => (
                LossKind::Memory,
                format!("the worker held {held} MiB of memory, more than {limit} MiB"),
            ),
            Loss::Garbage(message) => (
                LossKind::Garbage,
                format!("the worker wrote garbage: {message}"),
            ),
            Loss::NotStarted(message) => (LossKind::NotStarted, message),
            Loss::Died | Loss::Cancelled => (
                LossKind::Died,
                match status {
                    Some(status) if launched => {
                        format!("the worker was lost, and its launcher {}", ending(status))
                    }
                    Some(status) => format!("the worker {}", ending(status)),
                    None => "the worker closed its pipe".to_owned(),
                },
            ),
        };
        let own_status = status.filter(|_| kind == LossKind::Died && !launched);
        let message = match stderr.as_str() {
            "" => cause,
            text => format!("{cause}; stderr ends with: {text}"),
        };
        Self {
            message,
            end: ProcessEnd {
                kind,
                signal: own_status.and_then(etalon_process::signal),
                exit: own_status.and_then(|s| s.code()),
                stderr,
                seconds: 0.0,
            },
        }
    }
}

fn ending(status: ExitStatus) -> String {
    match etalon_process::signal(status) {
        Some(signal) => format!("died of signal {signal}{}", signal_name(signal)),
        None => {
            let name = status.code().map_or("", exception_name);
            format!("ended with {status}{name}")
        }
    }
}

fn signal_name(signal: i32) -> &'static str {
    match signal {
        4 => " (illegal instruction)",
        5 => " (trap)",
        6 => " (abort)",
        7 => " (bus error)",
        8 => " (arithmetic exception)",
        9 => " (killed)",
        11 => " (segmentation fault)",
        15 => " (terminated)",
        31 => " (bad system call)",
        _ => "",
    }
}

/// Returns the name of the exception that ended a process of Windows, by its exit code.
fn exception_name(code: i32) -> &'static str {
    match code as u32 {
        0x8000_0003 => " (breakpoint)",
        0xC000_0005 => " (access violation)",
        0xC000_001D => " (illegal instruction)",
        0xC000_0094 => " (division by zero)",
        0xC000_00FD => " (stack overflow)",
        0xC000_0374 => " (heap corruption)",
        0xC000_0409 => " (abort)",
        _ => "",
    }
}
