//! The end of a lost worker: exit status, signal and the end of its standard error.

use crate::loss::Loss;
use etalon_record::{LossKind, ProcessEnd};
use std::process::ExitStatus;

/// Returns the end of a worker that was lost in this way. `status` is the exit status of its process, if the
/// process ended by itself; a launcher's status says nothing about the worker.
pub(crate) fn process_end(
    loss: Loss,
    status: Option<ExitStatus>,
    launched: bool,
    stderr: String,
) -> ProcessEnd {
    let end = ProcessEnd {
        stderr,
        ..ProcessEnd::default()
    };
    match loss {
        Loss::Timeout(limit) => ProcessEnd {
            kind: LossKind::Timeout,
            limit: Some(limit.as_secs_f64()),
            ..end
        },
        Loss::Memory { held, limit } => ProcessEnd {
            kind: LossKind::Memory,
            limit: Some(limit as f64),
            held: Some(held),
            ..end
        },
        Loss::Garbage(error) => ProcessEnd {
            kind: LossKind::Garbage,
            error,
            ..end
        },
        Loss::NotStarted(error) => ProcessEnd {
            kind: LossKind::NotStarted,
            error,
            ..end
        },
        Loss::Died | Loss::Cancelled => {
            let status = status.map(|status| etalon_record::ExitStatus {
                signal: etalon_process::signal(status),
                exit: status.code(),
            });
            let (own, launcher) = match launched {
                true => (None, status),
                false => (status, None),
            };
            ProcessEnd {
                signal: own.and_then(|status| status.signal),
                exit: own.and_then(|status| status.exit),
                launcher,
                ..end
            }
        }
    }
}
