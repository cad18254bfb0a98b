//! Files of earlier schemas.

use etalon_history::{History, SCHEMA, Writer};
use etalon_record::Verdict;
use rusqlite::Connection;

/// A history of schema 1 as the suite wrote it then: a run of one adapter with two cases; one case improved
/// in a second run.
const SCHEMA_1: &str = include_str!("schema-1.sql");

#[test]
fn the_first_schema_is_read_and_added_to() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    Connection::open(&path)
        .unwrap()
        .execute_batch(SCHEMA_1)
        .unwrap();
    for _ in 0..2 {
        let history = History::open_read(&path).unwrap();
        let verdicts = |case: &str| -> Vec<Verdict> {
            let found = history.case_history(case, Some("cpu")).unwrap();
            let points = found.iter().flat_map(|h| &h.points);
            points
                .map(|p| history.outcome(p.outcome).unwrap().verdict)
                .collect()
        };
        assert_eq!(verdicts("depth/made/n=0"), [Verdict::Pass, Verdict::Pass]);
        assert_eq!(verdicts("stencil/made/n=1"), [Verdict::Fail, Verdict::Pass]);
        assert_eq!(history.runs()[0].labels["branch"], "main");
        let keys = history.series_keys().unwrap();
        assert_eq!(history.series(&keys[0]).unwrap()[0].times.wall, [1.5, 2.5]);
        drop(history);
        // Opening it for writing does not change it.
        Writer::open(&path).unwrap();
    }
    let schema: u32 = Connection::open(&path)
        .unwrap()
        .query_row("PRAGMA user_version", [], |row| row.get(0))
        .unwrap();
    assert_eq!(schema, SCHEMA);
}
