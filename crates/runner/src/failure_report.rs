//! The report on a failed request to a worker: its verdict, its cause and the end of the process.

use crate::loss::RequestError;
use crate::process::WorkerProcess;
use crate::process_end::process_end;
use etalon_frame::ErrorKind;
use etalon_record::{ProcessEnd, Reason, Record, Verdict};

/// The report on a failed request.
pub(crate) struct FailureReport {
    /// The verdict of the case that was being drawn.
    pub(crate) verdict: Verdict,
    /// The words and the kind of the backend's error, if it failed.
    pub(crate) error: Option<(String, Option<ErrorKind>)>,
    /// The end of the worker's process, if it was lost.
    pub(crate) process: Option<ProcessEnd>,
}

impl FailureReport {
    /// Returns the report on a failed request. `worker` is `None` if there was no worker to ask.
    pub(crate) fn new(failure: RequestError, worker: Option<&mut WorkerProcess>) -> Self {
        let verdict = failure.verdict();
        match failure {
            RequestError::Backend(error) => Self {
                verdict,
                error: Some((error.to_string(), error.kind().cloned())),
                process: None,
            },
            RequestError::Lost(loss) => {
                let end = match worker {
                    Some(process) => process.end_of(loss),
                    None => process_end(loss, None, false, String::new()),
                };
                Self {
                    verdict,
                    error: None,
                    process: Some(end),
                }
            }
        }
    }

    /// Returns the cause in one list, for lines without fields of their own for it.
    pub(crate) fn reasons(self) -> Vec<Reason> {
        let text = self.error.map(|(text, _)| Reason::Text(text));
        let end = self.process.map(|end| Reason::Process(Box::new(end)));
        text.into_iter().chain(end).collect()
    }

    /// Returns the record of the case that was being drawn.
    pub(crate) fn record(self, case: &str, adapter: &str) -> Record {
        let mut record = Record::new(case, adapter, self.verdict);
        if let Some((text, kind)) = self.error {
            record.reasons = vec![Reason::Text(text)];
            record.error = kind;
        }
        record.process = self.process;
        record
    }
}
