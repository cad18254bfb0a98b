//! The findings of `ci/findings`: all were read twice, and pages list them. A test in `src/dead.rs` finds dead globs.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use etalon_case::{Library, Profile, select};
use etalon_explore::{draw_facts, fact_names};
use etalon_glob::Glob;
use etalon_record::{Expectations, Finding, Grade, KnownSource};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// If this variable is set, the pages are written anew instead of compared.
const WRITE: &str = "ETALON_WRITE_FINDINGS";
const BEGIN: &str = "<!-- findings: ETALON_WRITE_FINDINGS=1 cargo nextest run -p etalon the_pages_list_the_findings -->\n";
const END: &str = "<!-- end of findings -->\n";

fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap()
}

/// The findings by the names of their files.
fn findings() -> Vec<(String, Finding)> {
    let expectations = Expectations::read(&root().join("ci/findings")).unwrap();
    let named = expectations.all().iter().map(|known| {
        let KnownSource::Finding(finding) = &known.source else {
            panic!("{}: no finding", known.place());
        };
        let name = known.path.file_stem().unwrap().to_str().unwrap();
        (name.to_owned(), Finding::clone(finding))
    });
    named.collect()
}

/// A numbered file is about the same bug on adapters that show it in other cases.
fn is_numbered(name: &str) -> bool {
    let last = name.rsplit('-').next().unwrap();
    last.len() == 1 && last.chars().all(|c| c.is_ascii_digit())
}

#[test]
fn every_finding_was_read_twice() {
    let findings = findings();
    // The folder was read.
    assert!(findings.len() > 20);
    for (name, finding) in &findings {
        assert_ne!(
            finding.grade,
            Grade::Unread,
            "ci/findings/{name}.json: read the clause that the driver breaks, and state the grade"
        );
        assert!(finding.clause.len() > 10, "{name}: {}", finding.clause);
        assert!(finding.expected().is_bad(), "{name}");
        assert!(
            finding.read.is_some(),
            "ci/findings/{name}.json: `read` is missing: somebody who did not write the finding holds it against \
             the text"
        );
    }
}

#[test]
fn names_of_findings_are_plain_and_numbers_follow_a_first_one() {
    let findings = findings();
    for (name, _) in &findings {
        let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(name.chars().all(is_plain), "{name}");
        if is_numbered(name) {
            let (first, _) = name.rsplit_once('-').unwrap();
            assert!(findings.iter().any(|(other, _)| other == first), "{name}");
        }
    }
}

/// The bugs of each driver, by the first word of the files' names.
fn by_driver() -> BTreeMap<String, Vec<(String, Finding)>> {
    let mut drivers: BTreeMap<String, Vec<(String, Finding)>> = BTreeMap::new();
    for (name, finding) in findings() {
        if !is_numbered(&name) {
            let driver = name.split('-').next().unwrap().to_owned();
            drivers.entry(driver).or_default().push((name, finding));
        }
    }
    drivers
}

/// Returns the page of a driver's bugs.
fn driver_page(driver: &str, bugs: &[(String, Finding)]) -> String {
    let rows = bugs.iter().map(|(name, finding)| {
        let grade = finding.grade.name().replace('-', " ");
        let releases = releases(finding);
        format!(
            "| [{}]({name}.json) | {releases} | {grade} |\n",
            finding.title
        )
    });
    format!(
        "# Bugs of {driver}\n\n{BEGIN}\n| bug | releases | grade |\n|---|---|---|\n{}\n[All drivers](../findings.md)\n",
        rows.collect::<String>()
    )
}

/// Returns the table of the drivers, with the number of their bugs.
fn table_of_drivers() -> String {
    let rows = by_driver().into_iter().map(|(driver, bugs)| {
        let is_open = |(_, finding): &&(String, Finding)| is_in_newest_release(finding);
        let open = bugs.iter().filter(is_open).count();
        format!(
            "| [{driver}](findings/{driver}.md) | {} | {open} |\n",
            bugs.len()
        )
    });
    format!(
        "| driver | bugs | in the newest release that was drawn |\n|---|---|---|\n{}",
        rows.collect::<String>()
    )
}

/// Returns true if the newest drawn release has the bug, as far as is known.
fn is_in_newest_release(finding: &Finding) -> bool {
    match &finding.versions {
        None => single_release(finding).is_none(),
        Some(bounds) => bounds.split(", ").all(|bound| bound.starts_with('>')),
    }
}

/// The release that the finding's driver name ends with, if it names one.
fn single_release(finding: &Finding) -> Option<&str> {
    let last = finding.driver.trim_matches('*').rsplit(' ').next()?;
    last.starts_with(|c: char| c.is_ascii_digit())
        .then_some(last)
}

/// Returns the releases that a finding is about, in words.
fn releases(finding: &Finding) -> String {
    match &finding.versions {
        None => single_release(finding)
            .unwrap_or("all that were drawn")
            .to_owned(),
        Some(bounds) => {
            let texts = bounds.split(", ").map(|bound| match bound.split_at(1) {
                (">", rest) => format!("from {}", rest.trim_start_matches('=')),
                ("<", rest) => format!("before {}", rest.trim_start_matches('=')),
                ("=", rest) => format!("{rest} alone"),
                _ => panic!("{bound}: no comparison"),
            });
            texts.collect::<Vec<_>>().join(", ")
        }
    }
}

/// Writes a page anew if [`WRITE`] is set; else compares it.
fn check_page(path: &Path, expected: &str) {
    if std::env::var_os(WRITE).is_some() {
        fs::write(path, expected).unwrap();
        return;
    }
    let page = fs::read_to_string(path).unwrap_or_default();
    assert_eq!(
        page,
        expected,
        "{}: set {WRITE} to write the page anew",
        path.display()
    );
}

#[test]
fn the_pages_list_the_findings() {
    let path = root().join("ci/findings.md");
    let text = fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    check_page(
        &path,
        &format!("{before}{BEGIN}\n{}\n{END}{after}", table_of_drivers()),
    );
    let drivers = by_driver();
    for (driver, bugs) in &drivers {
        let path = root().join(format!("ci/findings/{driver}.md"));
        check_page(&path, &driver_page(driver, bugs));
    }
    for entry in fs::read_dir(root().join("ci/findings")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "md") {
            let driver = path.file_stem().unwrap().to_str().unwrap();
            assert!(
                drivers.contains_key(driver),
                "{}: no finding of this driver",
                path.display()
            );
        }
    }
}

#[test]
fn every_case_of_a_finding_has_what_the_finding_needs() {
    let expectations = Expectations::read(&root().join("ci/findings")).unwrap();
    let known: Vec<String> = fact_names().collect();
    let mut with_needs = 0;
    for (number, finding) in expectations.all().iter().enumerate() {
        let (place, needs) = (finding.place(), &finding.needs);
        for need in needs {
            let glob = Glob::new(need).unwrap();
            let is_fact = known.iter().any(|fact| glob.is_match(fact));
            assert!(is_fact, "{place}: no draw has a fact `{need}`");
        }
        if needs.is_empty() {
            continue;
        }
        with_needs += 1;
        let selected = select(Library::built_in(), Profile::Full, &finding.cases).unwrap();
        for case in selected.cases {
            let draws = draw_facts(&case.build().unwrap());
            let has_all = expectations.are_needs_met(number, &draws);
            let id = case.id();
            assert!(has_all, "{place}: no draw of {id} has all of {needs:?}");
        }
    }
    // Bugs of clears, resolves and copies need no draw.
    assert!(with_needs > 150, "{with_needs}");
}
