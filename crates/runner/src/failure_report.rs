//! The report on a failed request to a worker: its verdict, its cause and the end of the process.

use crate::exit_report::ExitReport;
use crate::loss::Failure;
use crate::process::WorkerProcess;
use etalon_frame::ErrorKind;
use etalon_record::{ProcessEnd, Record, Verdict};

/// The report on a failed request.
pub(crate) struct FailureReport {
    /// The verdict of the case that was being drawn.
    pub(crate) verdict: Verdict,
    /// The cause.
    pub(crate) message: String,
    /// The kind of the backend's error, if it failed.
    pub(crate) error: Option<ErrorKind>,
    /// The end of the worker's process, if it was lost.
    pub(crate) process: Option<ProcessEnd>,
}

impl FailureReport {
    /// Returns the report on a failed request. `worker` is `None` if there was no worker to ask.
    pub(crate) fn new(failure: Failure, worker: Option<&mut WorkerProcess>) -> Self {
        let verdict = failure.verdict();
        match failure {
            Failure::Backend(error) => Self {
                verdict,
                message: error.to_string(),
                error: error.kind().cloned(),
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
                    error: None,
                    process: Some(end),
                }
            }
        }
    }

    /// Returns the record of the case that was being drawn.
    pub(crate) fn record(self, case: &str, adapter: &str) -> Record {
        let mut record = Record::new(case, adapter, self.verdict);
        record.message = self.message;
        record.error = self.error;
        record.process = self.process;
        record
    }
}
