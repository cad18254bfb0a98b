//! A run with every verdict, expected in every way.

use crate::synthetic::{adapter, header};
use etalon_frame::Api;
use etalon_record::{Expected, Header, ProcessEnd, Record, RunWriter, Verdict};
use std::path::Path;

/// One record per verdict on `gl:a`, and another for each way in which it can be expected.
pub(crate) fn every_verdict(folder: &Path) -> Vec<Record> {
    let mut records: Vec<Record> = Verdict::ALL
        .into_iter()
        .map(|v| Record::new(format!("depth/all/verdict={v}"), "gl:a", v))
        .collect();
    for verdict in Verdict::ALL.into_iter().filter(|v| v.is_bad()) {
        let mut record = Record::new(format!("blend/expected/verdict={verdict}"), "gl:a", verdict);
        record.expected = Some(Expected {
            reason: "bug 12 of the driver".to_owned(),
        });
        records.push(record);
    }
    for (verdict, expected) in [
        (Verdict::Pass, Verdict::Fail),
        (Verdict::Imprecise, Verdict::Flaky),
    ] {
        let mut record = Record::new(format!("blend/better/verdict={verdict}"), "gl:a", verdict);
        record.improves = Some(expected);
        records.push(record);
    }
    // Better than a crash, but still bad.
    let mut still_bad = Record::new("blend/still-bad", "gl:a", Verdict::Fail);
    still_bad.improves = Some(Verdict::Crash);
    records.push(still_bad);
    for verdict in [Verdict::Fail, Verdict::Pass, Verdict::Crash] {
        let mut record = Record::new(format!("selftest/due/verdict={verdict}"), "gl:a", verdict);
        record.due_fail = true;
        records.push(record);
    }
    let mut lost = Record::new("depth/lost", "gl:a", Verdict::Crash);
    lost.process = Some(ProcessEnd {
        signal: Some(6),
        stderr: "LLVM ERROR\nout of registers".to_owned(),
        seconds: 1.5,
        ..ProcessEnd::default()
    });
    lost.after = vec!["depth/first".to_owned(), "depth/second".to_owned()];
    let mut repeated = Record::new("depth/repeated", "gl:a", Verdict::Pass);
    repeated.repeats = vec![Verdict::Pass; 4];
    repeated.validation = vec!["VUID-1: something".to_owned()];
    records.extend([lost, repeated]);
    let header = header(records.len() as u64, vec![adapter("gl:a", Api::OpenGl)]);
    record_all(folder, &header, &records);
    records
}

pub(crate) fn record_all(folder: &Path, header: &Header, records: &[Record]) {
    let mut writer = RunWriter::create(folder, header).unwrap();
    records.iter().for_each(|r| writer.append(r).unwrap());
}
