//! The report on a failed request to a worker: its verdict, its cause and the end of the process.

use crate::exit_report::ExitReport;
use crate::loss::Failure;
use crate::process::WorkerProcess;
use etalon_record::{ProcessEnd, Verdict};

/// The report on a failed request.
pub(crate) struct FailureReport {
    /// The verdict of the case that was being drawn.
    pub(crate) verdict: Verdict,
    /// The cause.
    pub(crate) message: String,
    /// The end of the worker's process, if it was lost.
    pub(crate) process: Option<ProcessEnd>,
}

impl FailureReport {
    /// The report on a failed request to a worker; `None` where there was no worker to ask.
    pub(crate) fn new(failure: Failure, worker: Option<&mut WorkerProcess>) -> Self {
        let verdict = failure.verdict();
        match failure {
            Failure::Backend(error) => Self {
                verdict,
                message: error.to_string(),
                process: None,
            },
            Failure::Lost(loss) => {
                let ExitReport { message, end } = match worker {
                    Some(process) => process.exit_report(loss),
                    None => ExitReport::new(loss, None, false, String::new()),
                };
                Self {
                    verdict,
                    message,
                    process: Some(end),
                }
            }
        }
    }
}
