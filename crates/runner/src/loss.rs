//! How a worker was lost, and what it said last.

use etalon_record::{LossKind, ProcessEnd, Verdict};
use std::collections::VecDeque;
use std::io::Read;
use std::process::ExitStatus;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// How much of a worker's stderr is kept: its end.
const STDERR_BYTES: usize = 4096;

/// How a worker was lost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Loss {
    /// It did not answer in time.
    Timeout(Duration),
    /// It held so many MiB of memory, more than it may.
    Memory { held: u64, limit: u64 },
    /// It wrote what is no message, or no answer to what it was asked.
    Garbage(String),
    /// Its end of the pipe is closed.
    Died,
    /// The run is to end; nobody waits for the answer any more.
    Stopped,
}

impl Loss {
    /// The verdict of the case that was being drawn.
    pub(crate) fn verdict(&self) -> Verdict {
        match self {
            Self::Timeout(_) => Verdict::Timeout,
            Self::Memory { .. } => Verdict::ResourceError,
            Self::Garbage(_) | Self::Died | Self::Stopped => Verdict::Crash,
        }
    }
}

/// What is told of a lost worker.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Obituary {
    /// In words, with its last ones.
    pub(crate) message: String,
    /// For programs.
    pub(crate) end: ProcessEnd,
}

impl Obituary {
    /// Of a worker that was lost so, ended with this status if it ended by itself, and wrote this last.
    pub(crate) fn new(loss: Loss, status: Option<ExitStatus>, stderr: String) -> Self {
        let (kind, how) = match loss {
            Loss::Timeout(limit) => (
                LossKind::Timeout,
                format!("no answer within {} s", limit.as_secs_f64()),
            ),
            Loss::Memory { held, limit } => (
                LossKind::Memory,
                format!("the worker held {held} MiB of memory, more than {limit} MiB"),
            ),
            Loss::Garbage(what) => (
                LossKind::Garbage,
                format!("the worker wrote garbage: {what}"),
            ),
            Loss::Died | Loss::Stopped => (
                LossKind::Died,
                match status {
                    Some(status) => describe(status),
                    None => "the worker closed its pipe".to_owned(),
                },
            ),
        };
        let by_itself = kind == LossKind::Died;
        let message = match stderr.as_str() {
            "" => how,
            words => format!("{how}; its last words: {words}"),
        };
        Self {
            message,
            end: ProcessEnd {
                kind,
                signal: status.filter(|_| by_itself).and_then(signal),
                exit: status.filter(|_| by_itself).and_then(|s| s.code()),
                stderr,
                seconds: 0.0,
            },
        }
    }

    /// Of a worker that could not be started.
    pub(crate) fn not_started(message: String) -> Self {
        Self {
            message,
            end: ProcessEnd {
                kind: LossKind::NotStarted,
                signal: None,
                exit: None,
                stderr: String::new(),
                seconds: 0.0,
            },
        }
    }
}

fn signal(status: ExitStatus) -> Option<i32> {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        status.signal()
    }
    #[cfg(not(unix))]
    {
        let _ = status;
        None
    }
}

fn describe(status: ExitStatus) -> String {
    match signal(status) {
        Some(signal) => format!("the worker died of signal {signal}{}", signal_name(signal)),
        None => format!("the worker ended with {status}"),
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

/// Reads a worker's stderr and keeps its end.
pub(crate) fn keep_end(mut from: impl Read, kept: &Mutex<VecDeque<u8>>) {
    let mut buffer = [0; 1024];
    while let Ok(n) = from.read(&mut buffer) {
        if n == 0 {
            break;
        }
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(&buffer[..n]);
        let excess = kept.len().saturating_sub(STDERR_BYTES);
        kept.drain(..excess);
    }
}
