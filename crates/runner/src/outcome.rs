//! The record of a case that was drawn alone, for callers that keep no run folder.

use crate::failure_report::FailureReport;
use crate::loss::RequestError;
use crate::process::WorkerProcess;
use etalon_case::Case;
use etalon_frame::{Frame, Limits};
use etalon_judge::Judge;
use etalon_record::Record;

/// Returns the record of a drawing, and whether its worker must not be used again. The judge is not shared,
/// because the legal sets of one case are of no use to another.
pub(crate) fn outcome(
    process: &mut WorkerProcess,
    case: &Case,
    limits: &Limits,
    frames: Result<Vec<Frame>, RequestError>,
) -> (Record, bool) {
    match frames {
        Ok(frames) => {
            let judged = Judge::default().judge(0, case, "", limits, &frames);
            (judged.record, false)
        }
        Err(failure) => {
            let ends = failure.ends_worker();
            let report = FailureReport::new(failure, Some(process));
            (report.record(&case.id, ""), ends)
        }
    }
}
