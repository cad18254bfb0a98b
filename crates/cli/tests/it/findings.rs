//! The findings of `ci/findings`: all can be read, all are alive, and a page lists them.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Expectations, Finding, Grade, Source};
use predicates::prelude::*;
use predicates::str::contains;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// If this variable is set, the list is written anew instead of compared.
const WRITE: &str = "ETALON_WRITE_FINDINGS";
const BEGIN: &str = "<!-- findings: ETALON_WRITE_FINDINGS=1 cargo nextest run -p etalon the_page_lists_the_findings -->\n";
const END: &str = "<!-- end of findings -->\n";

fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap()
}

/// The findings by the names of their files.
fn findings() -> Vec<(String, Finding)> {
    let all = Expectations::read(&root().join("ci/findings")).unwrap();
    let each = all.all().iter().map(|known| {
        let Source::Finding(finding) = &known.source else {
            panic!("{}: no finding", known.place());
        };
        let name = known.path.file_stem().unwrap().to_str().unwrap();
        (name.to_owned(), finding.clone())
    });
    each.collect()
}

/// A numbered file is about the same bug on adapters that show it in other cases.
fn is_numbered(name: &str) -> bool {
    let last = name.rsplit('-').next().unwrap();
    last.len() == 1 && last.chars().all(|c| c.is_ascii_digit())
}

#[test]
fn every_finding_has_a_clause_and_a_second_reader() {
    let all = findings();
    assert!(all.len() > 20);
    for (name, finding) in &all {
        assert_ne!(
            finding.grade,
            Grade::Unread,
            "ci/findings/{name}.json: read the clause that the driver breaks, and state the grade"
        );
        assert!(finding.clause.len() > 10, "{name}: {}", finding.clause);
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(name.chars().all(plain), "{name}");
        assert!(finding.expected().is_bad(), "{name}");
        assert!(
            finding.read.is_some(),
            "ci/findings/{name}.json: `read` is missing: somebody who did not write the finding holds it against \
             the text"
        );
        if is_numbered(name) {
            let (first, _) = name.rsplit_once('-').unwrap();
            assert!(all.iter().any(|(other, _)| other == first), "{name}");
        }
    }
}

#[test]
fn no_finding_is_dead() {
    let out = tempfile::tempdir().unwrap();
    etalon(&[
        "run",
        "depth/clear*",
        "--adapter",
        "cpu",
        "--strict-expectations",
    ])
    .arg("--out")
    .arg(out.path().join("run"))
    .assert()
    .code(0)
    .stderr(contains("dead").not());
}

/// Returns the list: a table per driver, by the first word of the files' names.
fn listed() -> String {
    let mut drivers: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (name, finding) in findings().iter().filter(|(name, _)| !is_numbered(name)) {
        let driver = name.split('-').next().unwrap().to_owned();
        let grade = finding.grade.name().replace('-', " ");
        let row = format!(
            "| [{}](findings/{name}.json) | {} | {grade} |",
            finding.title,
            releases(finding)
        );
        drivers.entry(driver).or_default().push(row);
    }
    let tables = drivers.into_iter().map(|(driver, rows)| {
        format!(
            "## {driver}\n\n| bug | releases | grade |\n|---|---|---|\n{}\n\n",
            rows.join("\n")
        )
    });
    tables.collect()
}

/// Returns the releases that a finding is about, in words.
fn releases(finding: &Finding) -> String {
    let single = finding.driver.trim_matches('*').rsplit(' ').next().unwrap();
    match &finding.versions {
        None if single.starts_with(|c: char| c.is_ascii_digit()) => single.to_owned(),
        None => "all that were drawn".to_owned(),
        Some(range) => {
            let ends = range.split(", ").map(|end| match end.split_at(1) {
                (">", rest) => format!("from {}", rest.trim_start_matches('=')),
                ("<", rest) => format!("before {}", rest.trim_start_matches('=')),
                (_, rest) => format!("{rest} alone"),
            });
            ends.collect::<Vec<_>>().join(", ")
        }
    }
}

#[test]
fn the_page_lists_the_findings() {
    let path = root().join("ci/findings.md");
    let text = fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(BEGIN).unwrap();
    let (list, after) = rest.split_once(END).unwrap();
    let due = format!("\n{}", listed());
    if std::env::var_os(WRITE).is_some() {
        fs::write(&path, format!("{before}{BEGIN}{due}{END}{after}")).unwrap();
        return;
    }
    assert_eq!(list, due, "set {WRITE} to write the list anew");
}
