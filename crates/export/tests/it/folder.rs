//! The folder of an export: which folders are accepted, and that no name leads out of it.

use crate::made::{FORMATS, daily, files, history};
use etalon_export::{ExportError, RunChoice, export};
use std::fs;

#[test]
fn every_format_is_the_same_each_time_and_stays_in_its_folder() {
    let dir = tempfile::tempdir().unwrap();
    let history = history(dir.path(), &daily(&["2026-01-01", "2026-01-02"]));
    for format in FORMATS {
        let (first, second) = (dir.path().join("x/one"), dir.path().join("x/two"));
        let everything = RunChoice::default();
        let written = export(&history, format, &everything, &first).unwrap();
        export(&history, format, &everything, &second).unwrap();
        let (a, b) = (files(&first), files(&second));
        assert_eq!(a.len() as u64, written.files, "{format:?}");
        assert!(a.values().eq(b.values()), "{format:?}");
        assert_eq!(fs::read_dir(dir.path().join("x")).unwrap().count(), 2);
        fs::remove_dir_all(dir.path().join("x")).unwrap();
    }
}

#[test]
fn a_folder_that_holds_something_stays_as_it_is() {
    let dir = tempfile::tempdir().unwrap();
    let history = history(dir.path(), &daily(&["2026-01-01"]));
    let out = dir.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("mine"), "mine").unwrap();
    for format in FORMATS {
        let refused = export(&history, format, &RunChoice::default(), &out);
        assert!(
            matches!(refused, Err(ExportError::NotEmpty { .. })),
            "{format:?}"
        );
        assert_eq!(files(&out).len(), 1, "{format:?}");
    }
}

#[test]
fn a_place_that_cannot_be_a_folder_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let history = history(dir.path(), &daily(&["2026-01-01"]));
    let file = dir.path().join("file");
    fs::write(&file, "").unwrap();
    for format in FORMATS {
        for out in [file.clone(), file.join("below")] {
            let error = export(&history, format, &RunChoice::default(), &out).unwrap_err();
            assert!(matches!(error, ExportError::Folder(_)), "{error:?}");
            let line = error.to_string();
            assert!(line.contains(&file.display().to_string()), "{line}");
            assert!(!line.contains('\n'), "{line}");
        }
    }
}
