//! `etalon bisect`, with two drivers in the roles of older and newer releases of one driver.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Verdict, Versions};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A case that softpipe fails and llvmpipe passes.
const BROKEN: &str = "cull/points/cull=none/front_face=cw";
/// A case that both pass.
const SOUND: &str = "depth/clear/clear=1/format=depth32float";

fn release(driver: &str, line: &str, version: &str) -> Value {
    json!({
        "name": format!("gl:{driver}@{version}"), "backend": "gl", "answers": driver, "line": line, "version": version,
        "environment": { "LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": driver },
    })
}

/// A folder with a file of releases: softpipe up to version 22.10, llvmpipe from 25 on.
fn releases() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines.json");
    let entries = json!([
        release("llvmpipe", "drivers", "26"),
        release("softpipe", "drivers", "22.4"),
        release("llvmpipe", "drivers", "25"),
        release("softpipe", "drivers", "22.10"),
        release("softpipe", "alone", "1"),
        release("softpipe", "twice", "2"),
        { "name": "gl:other", "backend": "gl", "line": "twice", "version": "2" },
    ]);
    fs::write(&path, entries.to_string()).unwrap();
    (folder, path)
}

fn bisect(inputs: &[&str], line: &str, file: &Path, out: &Path) -> assert_cmd::assert::Assert {
    let mut command = etalon(&["bisect"]);
    command.args(inputs).args(["--line", line, "--adapters"]);
    command.arg(file).arg("--out").arg(out).assert()
}

fn stderr(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

#[test]
fn the_release_that_fixed_a_case_is_found() {
    let (folder, file) = releases();
    let out = folder.path().join("out");
    let assert = bisect(&[BROKEN, SOUND], "drivers", &file, &out).code(0);
    let versions = Versions::read(&out).unwrap();
    let order: Vec<&str> = versions
        .header
        .releases
        .iter()
        .map(|r| &*r.version)
        .collect();
    assert_eq!(order, ["22.4", "22.10", "25", "26"]);
    let case_of = |id: &str| versions.cases.iter().find(|case| case.case == id).unwrap();
    let (broken, sound) = (case_of(BROKEN), case_of(SOUND));
    assert_eq!(broken.bad(), [[0, 1]]);
    assert_eq!(
        broken.range(&versions.header.releases).as_deref(),
        Some("<25")
    );
    let finding = broken.finding.as_deref().unwrap_or_default();
    assert_eq!(
        finding,
        "softpipe treats points as back-facing in the fragment shader"
    );
    assert!(sound.bad().is_empty());
    // The oldest, the newest and one release between them.
    let drawn = sound.verdicts.iter().flatten().count();
    assert_eq!((drawn, sound.verdicts[0]), (3, Some(Verdict::Pass)));
    let table = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    assert!(
        table.contains("22.4 to 22.10") && table.contains("<25"),
        "{table}"
    );
    let row = |id: &str| format!("<th scope=\"row\">{id}</th>");
    let page = fs::read_to_string(out.join("versions.html")).unwrap();
    assert!(
        page.contains(&row(BROKEN)) && page.contains("fixed"),
        "{page}"
    );
    assert!(
        !page.contains(&row(SOUND)),
        "a case that is good everywhere has no row"
    );
    assert!(!out.join("work").exists());

    let again = bisect(&[SOUND], "drivers", &file, &out).code(64);
    assert!(stderr(&again).contains("--force"), "{}", stderr(&again));
    assert_eq!(Versions::read(&out).unwrap(), versions);
}

#[test]
fn bisecting_a_run_searches_the_cases_that_failed_in_it() {
    let (folder, file) = releases();
    let (run, out) = (folder.path().join("run"), folder.path().join("out"));
    let mut command = etalon(&["run", BROKEN, SOUND, "--adapter", "gl:softpipe", "--out"]);
    command.arg(&run).assert().code(0);
    bisect(&[run.to_str().unwrap()], "drivers", &file, &out).code(0);
    let versions = Versions::read(&out).unwrap();
    let ids: Vec<&str> = versions.cases.iter().map(|case| &*case.case).collect();
    assert_eq!(ids, [BROKEN]);
    let into_run = bisect(&[SOUND], "drivers", &file, &run).code(64);
    assert!(
        stderr(&into_run).contains("holds a run"),
        "{}",
        stderr(&into_run)
    );
}

#[test]
fn a_bisection_that_cannot_be_searched_says_why() {
    let (folder, file) = releases();
    let out = folder.path().join("out");
    for (input, line, code, words) in [
        (SOUND, "nobody", 64, "its lines are: alone, drivers, twice"),
        (SOUND, "alone", 64, "one release of the line `alone`"),
        (SOUND, "twice", 64, "are both version 2 of twice"),
        ("no/such/case", "drivers", 4, "no case matches"),
    ] {
        let message = stderr(&bisect(&[input], line, &file, &out).code(code));
        assert!(message.contains(words), "{line}: {message}");
    }
    assert!(!out.join("versions.jsonl").exists());
}
