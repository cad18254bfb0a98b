//! Whatever a run folder contains, its reports are made or a message explains why not.
//!
//! `PROPTEST_CASES` sets the number of inputs.

#[path = "../../../record/tests/spoil/mod.rs"]
mod spoil;

use etalon_record::{Bench, Run};
use etalon_report::{TableOptions, table, write};
use proptest::prelude::*;
use spoil::spoilings;
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
    fn reports(spoilt in spoilings()) {
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
