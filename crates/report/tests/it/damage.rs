//! Whatever a run folder contains, its reports are made or a message explains why not.
//!
//! `PROPTEST_CASES` sets the number of inputs.

#[path = "../../../record/tests/spoil/mod.rs"]
mod spoil;

use crate::history_made;
use etalon_history::History;
use etalon_record::{Bench, Labels, Run};
use etalon_report::{TableOptions, table, write, write_history};
use proptest::prelude::*;
use spoil::{keep_trying, spoilings};
use std::fs;
use std::path::Path;
use std::sync::OnceLock;

/// The header and the first records of a real run of methods.
fn text() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/methods.jsonl");
        let text = fs::read_to_string(path).unwrap();
        text.lines().map(|l| format!("{l}\n")).collect()
    })
}

proptest! {
    #[test]
    fn a_report_of_a_spoilt_run_holds_no_foreign_markup(spoilt in spoilings()) {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("run.jsonl"), spoilt.of(text())).unwrap();
        let _ = Bench::read(folder.path());
        match write(folder.path()) {
            Err(error) => {
                let said = error.to_string();
                prop_assert!(!said.is_empty() && said.len() < 4000, "{said}");
            }
            Ok(written) => {
                let page = fs::read_to_string(&written.html).unwrap();
                // Only the page's own scripts, each at its known place.
                let scripts = page.matches("<script").count();
                let ends = page.matches("</script").count();
                prop_assert_eq!(scripts, ends);
                prop_assert!(scripts <= 3, "{scripts} scripts");
                let run = Run::read(folder.path()).unwrap();
                let shown = table(&run, TableOptions::default());
                prop_assert!(!shown.contains('\u{1b}') && !shown.contains('\0'), "{shown:?}");
            }
        }
    }
}

#[test]
fn no_history_panics_or_hangs_a_reader() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.db");
    history_made::write(&path);
    let whole = fs::read(&path).unwrap();
    keep_trying("histories", &[&whole], |input| {
        let path = folder.path().join("spoiled.db");
        fs::write(&path, input).unwrap();
        let to = folder.path().join("pages");
        if let Ok(history) = History::open_read(&path)
            && let Err(error) = write_history(&history, &Labels::new(), &to, true)
        {
            assert!(!error.to_string().is_empty());
        }
    });
}
