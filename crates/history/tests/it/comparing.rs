//! Comparing two runs, and counting runs.

use crate::made::{case, run, with};
use etalon_history::{ChangeKind, History, RunId, Writer};
use etalon_record::Verdict;

#[test]
fn a_comparison_is_over_the_cases_of_both() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let before = vec![with("cpu", "1", "pfpfnp."), with("gl:gone", "1", "p")];
    let after = vec![with("cpu", "2", "ppfyp.p"), with("gl:new", "1", "p")];
    writer.add(&run(1, "2026-01-01", before)).unwrap();
    writer.add(&run(2, "2026-01-02", after)).unwrap();
    let history = History::open_read(&path).unwrap();
    let found = history.compare(1.into(), 2.into()).unwrap();
    assert_eq!(found.gone, ["gl:gone".into()]);
    assert_eq!(found.appeared, ["gl:new".into()]);
    let [cpu] = &found.adapters[..] else {
        panic!("{:?}", found.adapters);
    };
    assert_eq!(cpu.common, 5);
    let name = |id| history.case_name(id).unwrap().to_string();
    let changed = |kind| cpu.of(kind).map(|c| name(c.case)).collect::<Vec<_>>();
    assert_eq!(changed(ChangeKind::Fixed), [case(1)]);
    assert_eq!(changed(ChangeKind::Broken), [case(2)]);
    assert_eq!(changed(ChangeKind::Verdict), [case(3), case(4)]);
    assert_eq!(
        cpu.gone.iter().map(|c| name(*c)).collect::<Vec<_>>(),
        [case(5)]
    );
    assert_eq!(
        cpu.appeared.iter().map(|c| name(*c)).collect::<Vec<_>>(),
        [case(6)]
    );

    let same = history.compare(2.into(), 2.into()).unwrap();
    assert!(
        same.adapters
            .iter()
            .all(|a| a.changes.is_empty() && a.gone.is_empty())
    );
    let error = history.compare(2.into(), RunId::from(9)).unwrap_err();
    assert!(error.to_string().contains("no run 9"), "{error}");
}

#[test]
fn other_numbers_and_expectations_are_told_from_other_verdicts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    let before = with("cpu", "1", "fff");
    let mut after = before.clone();
    after.outcomes.get_mut(&case(0)).unwrap().expected = Some("known".to_owned());
    after
        .outcomes
        .get_mut(&case(1))
        .unwrap()
        .measures
        .texels
        .wrong = 7;
    writer.add(&run(1, "2026-01-01", vec![before])).unwrap();
    writer.add(&run(2, "2026-01-02", vec![after])).unwrap();
    let history = History::open_read(&path).unwrap();
    let found = history.compare(1.into(), 2.into()).unwrap();
    let kinds: Vec<_> = found.adapters[0].changes.iter().map(|c| c.kind).collect();
    assert_eq!(kinds, [ChangeKind::Expectation, ChangeKind::Measures]);
}

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
