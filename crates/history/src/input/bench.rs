//! Reading a `bench.jsonl`.

use super::started::started;
use crate::adapter::Adapter;
use crate::digest::Digesting;
use crate::error::HistoryError;
use crate::frame_times::FrameTimes;
use crate::kind::Kind;
use crate::new_run::{NewAdapter, NewRun};
use crate::outcome::Outcome;
use etalon_record::{Bench, Labels};
use std::io::Read;
use std::path::Path;

pub(super) fn read(path: &Path, mut text: Digesting<impl Read>) -> Result<NewRun, HistoryError> {
    let bench = Bench::parse(path, &mut text)?;
    let (digest, header_digest) = text.digests();
    let missing = bench.missing();
    let header = bench.header;
    let mut adapters: Vec<NewAdapter> = header
        .adapters
        .iter()
        .map(|a| NewAdapter::new(Adapter::from(a)))
        .collect();
    for record in &bench.records {
        let name = &record.picture.adapter;
        // The reader has already refused pictures of other adapters.
        let Some(adapter) = adapters.iter_mut().find(|a| a.adapter.info.name == *name) else {
            continue;
        };
        let case = record.picture.case.clone();
        if FrameTimes::are_kept(&case)
            && let Some(times) = FrameTimes::of_bench(record)
        {
            adapter.times.insert(case.clone(), times);
        }
        // The asserted fraction is dropped, because a picture does not record its number of channels.
        adapter.take(case, Outcome::new(record.picture.verdict));
    }
    Ok(NewRun {
        digest,
        header: header_digest,
        kind: Kind::Bench,
        started: started(path, &header.provenance.started)?,
        released: None,
        missing,
        etalon: header.provenance.etalon,
        commit: header.provenance.commit,
        machine: header.provenance.machine,
        profile: Some(header.profile),
        ruler: Some(header.ruler),
        labels: Labels::new(),
        adapters,
    })
}
