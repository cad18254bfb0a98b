//! Reading a `run.jsonl`.

use super::started::started;
use crate::adapter::Adapter;
use crate::digest::Digesting;
use crate::error::HistoryError;
use crate::frame_times::FrameTimes;
use crate::kind::Kind;
use crate::new_run::{NewAdapter, NewRun};
use crate::outcome::Outcome;
use etalon_record::{Header, Labels, Record, Run};
use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

/// The run read so far.
struct RunAssembly {
    header: Header,
    adapters: Vec<NewAdapter>,
    /// Names to indices in `adapters`.
    places: HashMap<String, usize>,
}

impl RunAssembly {
    fn new(header: Header) -> Self {
        let adapters: Vec<NewAdapter> = header
            .adapters
            .iter()
            .map(|a| NewAdapter::new(Adapter::from(a)))
            .collect();
        let names = header.adapters.iter().map(|a| a.info.name.clone());
        let places = names.zip(0..).collect();
        Self {
            header,
            adapters,
            places,
        }
    }

    fn take(&mut self, record: Record) -> Result<(), String> {
        let place = self.places.get(&record.adapter).copied();
        let Some(adapter) = place.and_then(|index| self.adapters.get_mut(index)) else {
            let name = &record.adapter;
            return Err(format!("the header names no adapter {name:?}"));
        };
        let time = record.measured.as_ref().and_then(|m| m.time.as_ref());
        if let Some(time) = time.filter(|_| FrameTimes::are_kept(&record.case)) {
            let times = FrameTimes::from(time);
            adapter.times.insert(record.case.clone(), times);
        }
        let outcome = Outcome::from(&record);
        adapter.take(record.case, outcome);
        Ok(())
    }
}

pub(super) fn read(path: &Path, mut text: Digesting<impl Read>) -> Result<NewRun, HistoryError> {
    let (assembly, _) = Run::fold(path, &mut text, RunAssembly::new, RunAssembly::take)?;
    let (digest, header_digest) = text.digests();
    let header = assembly.header;
    let records: u64 = assembly
        .adapters
        .iter()
        .map(|a| a.outcomes.len() as u64)
        .sum();
    Ok(NewRun {
        digest,
        header: header_digest,
        kind: Kind::Run,
        started: started(path, &header.provenance.started)?,
        released: None,
        missing: header.expected_records().saturating_sub(records),
        etalon: header.provenance.etalon,
        commit: header.provenance.commit,
        machine: header.provenance.machine,
        profile: header.settings.profile,
        ruler: None,
        labels: Labels::new(),
        adapters: assembly.adapters,
    })
}
