//! Making the record of an adapter from its worker's report.

use crate::worker::Worker;
use etalon_record::AdapterRecord;

impl From<&Worker> for AdapterRecord {
    fn from(worker: &Worker) -> Self {
        Self {
            info: worker.hello.info.clone(),
            release: worker.release.clone(),
            limits: worker.hello.limits.clone(),
        }
    }
}
