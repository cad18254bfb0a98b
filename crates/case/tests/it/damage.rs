//! Whatever a case file contains, reading it ends, with a message if it is wrong.
//!
//! `PROPTEST_CASES` sets the number of inputs.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

#[path = "../../../record/tests/spoil/mod.rs"]
mod spoil;

use etalon_case::{Library, Profile};
use proptest::prelude::*;
use spoil::{keep_trying, spoilings};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The largest number of a file's cases that are built: common errors show in a few.
const BUILT: usize = 12;

/// All case files of the repository that are at most a screen or two long.
fn texts() -> &'static [String] {
    static TEXTS: OnceLock<Vec<String>> = OnceLock::new();
    fn below(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                below(&path, found);
            } else if path.extension().is_some_and(|e| e == "json") {
                found.push(path);
            }
        }
    }
    TEXTS.get_or_init(|| {
        let mut paths = Vec::new();
        below(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases"),
            &mut paths,
        );
        paths.sort();
        let texts = paths.iter().map(|p| fs::read_to_string(p).unwrap());
        texts.filter(|t| t.len() < 6000).collect()
    })
}

/// Reads a folder of one file and builds some of its cases. Returns true on success.
fn build(text: &[u8]) -> bool {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("area")).unwrap();
    fs::write(folder.path().join("area/file.json"), text).unwrap();
    let check = |error: String| {
        assert!(!error.is_empty() && error.len() < 8000, "{error}");
        assert!(error.contains("file.json"), "{error}");
        false
    };
    let library = match Library::from_folder(folder.path()) {
        Ok(library) => library,
        Err(error) => return check(error.to_string()),
    };
    for case in library.cases(Profile::Quick).take(BUILT) {
        let id = case.id();
        assert!(!id.contains([',', ' ', '\n', '\0']), "{id:?}");
        match case.build() {
            Ok(case) => {
                let _ = (case.requirements(), case.scene.bytes());
            }
            Err(error) => return check(error.to_string()),
        }
    }
    true
}

proptest! {
    #[test]
    fn a_spoilt_case_file_is_built_or_refused(which in any::<prop::sample::Index>(), spoilt in spoilings()) {
        build(&spoilt.of(which.get::<String>(texts())));
    }
}

#[test]
fn no_case_file_panics_or_hangs_a_reader() {
    let corpus: Vec<&[u8]> = texts().iter().map(|text| text.as_bytes()).collect();
    keep_trying("case files", &corpus, |input| {
        build(input);
    });
}

/// Returns a file that draws one colour, with further members.
fn file(more: &str, axes: &str, size: &str) -> String {
    format!(
        r#"{{ "about": "a", "spec": ["s"], {more} "axes": {axes}, "scene": {{
        "attachments": {{ "color": {{ "format": "rgba8unorm", "size": {size} }} }},
        "passes": [ {{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "full" }},
            "shader": "uniform_color", "params": {{ "color": [1, 0, 0, 1] }} }} ] }} ],
        "read": ["color"] }} }}"#
    )
}

/// Absurd sizes, counts and nesting are refused with a message, at once.
#[test]
fn absurd_sizes_counts_and_nesting_are_refused() {
    let with = |axes: &str, size: &str| file("", axes, size);
    assert!(build(with("{}", "[4, 4]").as_bytes()));
    for size in [
        "[4294967295, 4294967295]",
        "[0, 4]",
        "[1e9, 1]",
        "[4]",
        "[-1, 1]",
        "[65536, 65536]",
    ] {
        assert!(!build(with("{}", size).as_bytes()), "{size}");
    }
    // A product of axes that is far too large to draw.
    let values: Vec<String> = (0..100).map(|n| n.to_string()).collect();
    let axis = |n: usize| format!("\"a{n}\": [{}]", values.join(","));
    let axes: Vec<String> = (0..12).map(axis).collect();
    assert!(!build(
        with(&format!("{{{}}}", axes.join(",")), "[4, 4]").as_bytes()
    ));
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(!build(
        with(&format!("{{\"a\": {deep}}}"), "[4, 4]").as_bytes()
    ));
    assert!(!build(deep.as_bytes()));
    assert!(!build(b""));
    assert!(!build(&[0xff, 0xfe, 0]));
}

/// A count beyond what the axes hold takes all they hold, and a shift beyond an axis goes round.
#[test]
fn counts_beyond_the_axes_take_all_that_the_axes_hold() {
    let most = usize::MAX.to_string();
    for quick in ["each", "first"] {
        let more = format!(
            r#""quick": {{ "{quick}": {most} }},
            "derived": {{ "other": {{ "axis": "y", "shift": {most} }} }},"#
        );
        for axes in [
            r#"{ "y": [1, 2, 4] }"#,
            r#"{ "x": [1], "y": [1, 2, 4] }"#,
            r#"{ "x": [1, 2], "y": [4] }"#,
        ] {
            let text = file(&more, axes, r#"["$other", 4]"#);
            assert!(build(text.as_bytes()), "{quick} {axes}");
        }
    }
}
