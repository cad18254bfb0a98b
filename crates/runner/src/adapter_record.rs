//! Making the record of an adapter from its worker's report.

use crate::worker::Worker;
use etalon_record::AdapterRecord;

impl From<&Worker> for AdapterRecord {
    fn from(worker: &Worker) -> Self {
        let info = &worker.hello.info;
        Self {
            name: info.name.clone(),
            backend: info.backend.clone(),
            device: info.device.clone(),
            driver: info.driver.clone(),
            driver_version: info.driver_version.clone(),
            driver_id: info.driver_id.clone(),
            api_version: info.api_version.clone(),
            software: info.software,
            release: worker.release.clone(),
            offer: info.offer.clone(),
            limits: worker.hello.limits.clone(),
        }
    }
}
