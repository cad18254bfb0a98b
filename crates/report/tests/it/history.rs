//! The pages of a history: their files, and where they are written.

use crate::history_made::{self, BROKEN, FIXED, FLAKY, IGNORED, NEW, SLOWER};
use etalon_history::History;
use etalon_record::{Labels, parse_labels};
use etalon_report::{HISTORY_PAGE_FILE, ReportError, write_history};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

fn made(folder: &Path) -> History {
    let path = folder.join("etalon.db");
    history_made::write(&path);
    History::open_read(&path).unwrap()
}

/// All files by name.
fn files(folder: &Path) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    for sub in [folder.to_owned(), folder.join("data")] {
        for entry in fs::read_dir(sub).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let name = path.strip_prefix(folder).unwrap().display().to_string();
                files.insert(name, fs::read_to_string(&path).unwrap());
            }
        }
    }
    files
}

/// Returns the value that a file hands to the script.
fn value(files: &BTreeMap<String, String>, name: &str) -> Value {
    let text = &files[&format!("data/{name}.js")];
    let inner = text
        .strip_prefix(&format!("etalonHistory(\"{name}\","))
        .unwrap();
    serde_json::from_str(inner.strip_suffix(");\n").unwrap()).unwrap()
}

#[test]
fn the_worst_news_come_first_and_known_failures_last() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("page");
    write_history(&made(folder.path()), &Labels::new(), &to, true).unwrap();
    let files = files(&to);
    let news = value(&files, "news");
    let lines = news.as_array().unwrap();
    let position = |subject: &str| lines.iter().position(|line| line[2] == subject).unwrap();
    assert_eq!(lines[position(BROKEN)][1], "✗ broken");
    assert_eq!(
        lines[position(BROKEN)][4],
        "✓ pass → ✗ fail on vulkan:first"
    );
    assert_eq!(lines[position(FLAKY)][1], "⇄ flaky");
    assert_eq!(lines[position("blend/factors")][1], "+ appeared");
    assert_eq!(lines[position(IGNORED)][5], "ignored: bug 7");
    let order = [BROKEN, FLAKY, "blend/factors", IGNORED].map(position);
    assert!(order.is_sorted(), "{order:?}");
    // It was fixed two nights before.
    assert!(lines.iter().all(|line| line[2] != FIXED));
    assert!(files["index.html"].contains("ignored: bug 7"));
}

#[test]
fn every_case_has_its_course_and_every_series_its_changes() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("page");
    write_history(&made(folder.path()), &Labels::new(), &to, true).unwrap();
    let files = files(&to);
    let mut ids: Vec<String> = Vec::new();
    for entry in value(&files, "cases").as_array().unwrap() {
        let shared = entry[0].as_u64().unwrap() as usize;
        let start = ids.last().map_or("", |id| &id[..shared]);
        ids.push(format!("{start}{}", entry[1].as_str().unwrap()));
    }
    assert_eq!(ids.len(), 11);
    assert!(ids.is_sorted());
    let place = |id: &str| ids.iter().position(|candidate| candidate == id).unwrap();
    let file = value(&files, "case-0");
    let course = |id: &str| file[0][file[1][place(id)].as_u64().unwrap() as usize].clone();
    // Timeline, first and last run, spans, gaps, events: broken in the fifth run, after the fourth.
    let broken = course(BROKEN);
    assert_eq!(broken[0][3].as_array().unwrap()[2], 4);
    assert_eq!(broken[0][5], serde_json::json!([0, 3, 4]));
    assert_eq!(
        broken[1].as_array().unwrap().len(),
        4,
        "nothing on the second"
    );
    assert_eq!(course(FIXED)[0][5], serde_json::json!([2, 1, 2]));
    assert_eq!(course(NEW)[1][5], serde_json::json!([3, 3, 4]));
    let times = value(&files, "times-0");
    assert_eq!(times[0][0], SLOWER);
    let wall = &times[0][1][0][3][0];
    assert_eq!(wall[0], "wall");
    let changes = wall[4].as_array().unwrap();
    assert_eq!(changes.len(), 1, "{changes:?}");
    assert_eq!(changes[0][0], 10);
    assert_eq!(changes[0][8], "the ruler stayed where it was");
    assert_eq!(changes[0][13][1], "real");
}

#[test]
fn equal_histories_make_equal_pages() {
    let folder = tempfile::tempdir().unwrap();
    let history = made(folder.path());
    let files_of = |name: &str| {
        let to = folder.path().join(name);
        write_history(&history, &Labels::new(), &to, true).unwrap();
        files(&to)
    };
    assert!(files_of("a") == files_of("b"));
}

#[test]
fn an_earlier_page_is_replaced_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let history = made(folder.path());
    let to = folder.path().join("page");
    let write = || write_history(&history, &Labels::new(), &to, true);
    write().unwrap();
    write().unwrap();
    let deep = to.join("data/case-99.js");
    fs::write(&deep, "mine").unwrap();
    assert!(matches!(write(), Err(ReportError::Foreign { .. })));
    assert_eq!(fs::read_to_string(&deep).unwrap(), "mine");
    fs::remove_file(&deep).unwrap();
    fs::write(to.join("notes.txt"), "mine").unwrap();
    assert!(matches!(write(), Err(ReportError::Foreign { .. })));
    fs::remove_file(to.join(HISTORY_PAGE_FILE)).unwrap();
    let error = write().unwrap_err().to_string();
    assert!(error.ends_with("name another folder"), "{error}");
    assert_eq!(fs::read_to_string(to.join("notes.txt")).unwrap(), "mine");
    let beside: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with(".page"))
        .collect();
    assert_eq!(beside, [] as [&str; 0]);
}

#[test]
fn labels_choose_runs() {
    let folder = tempfile::tempdir().unwrap();
    let history = made(folder.path());
    let to = folder.path().join("page");
    let only = parse_labels(&["branch=other".to_owned()]).unwrap();
    let error = write_history(&history, &only, &to, true).unwrap_err();
    assert!(matches!(error, ReportError::NoRuns { .. }), "{error}");
    let only = parse_labels(&["job=https://example.org/job/1".to_owned()]).unwrap();
    write_history(&history, &only, &to, true).unwrap();
}
