//! Counting runs.

use crate::made::{run, with};
use etalon_history::{History, Writer};
use etalon_record::Verdict;

#[test]
fn counts_are_by_area_and_verdict() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let made = run(1, "2026-01-01", vec![with("cpu", "1", "pffpnf")]);
    writer.add(&made).unwrap();
    let history = History::open_read(&path).unwrap();
    let tallies = history.tallies(&history.adapter_runs()[0]).unwrap();
    let rows: Vec<_> = tallies
        .iter()
        .map(|t| (t.area.as_str(), t.verdict, t.unexpected, t.records))
        .collect();
    assert_eq!(
        rows,
        [
            ("depth", Verdict::Pass, false, 2),
            ("perf", Verdict::Fail, true, 2),
            ("stencil", Verdict::Fail, true, 1),
            ("stencil", Verdict::NotSupported, false, 1),
        ]
    );
}
