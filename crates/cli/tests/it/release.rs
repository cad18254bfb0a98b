//! `ci/release`: what prevents a release is named, and two builds of one commit are equal.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::house::root;
use crate::sample;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn git(folder: &Path, arguments: &[&str]) {
    let output = Command::new("git")
        .current_dir(folder)
        .args(["-c", "user.name=a", "-c", "user.email=a@example.org"])
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
}

const README: &str =
    "# a\n\nIt takes 3 s (`etalon run`), see [the page](page.md#part) and <https://example.org>.\n";
const CHANGELOG: &str = "# Changelog\n\n## [1.2.3] - 2026-01-02\n\n- a\n";

/// Makes a repository that can be released but for one file with another text.
fn check(file: &str, text: &str) -> Output {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path();
    fs::create_dir(folder.join("ci")).unwrap();
    fs::copy(root().join("ci/release"), folder.join("ci/release")).unwrap();
    for (name, text) in [
        ("Cargo.toml", "[workspace.package]\nversion = \"1.2.3\"\n"),
        ("CHANGELOG.md", CHANGELOG),
        ("README.md", README),
        ("page.md", ""),
    ] {
        fs::write(folder.join(name), text).unwrap();
    }
    git(folder, &["init", "--quiet"]);
    if file != "dirty" {
        fs::write(folder.join(file), text).unwrap();
    }
    git(folder, &["add", "."]);
    git(folder, &["commit", "--quiet", "--message", "a"]);
    if file == "dirty" {
        fs::write(folder.join(file), text).unwrap();
    }
    Command::new(folder.join("ci/release"))
        .arg("--check")
        .output()
        .unwrap()
}

#[test]
fn what_prevents_a_release_is_named() {
    let output = check("page.md", "no obstacle");
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text, "1.2.3 can be released\n");
    assert!(output.status.success());
    for (file, text, problem) in [
        ("dirty", "", "files are not committed"),
        (
            "Cargo.toml",
            "version = \"1.2.3\"\nrepository = \"https://a.invalid/a\"\n",
            "Cargo.toml: the repository's address is a placeholder",
        ),
        (
            "CHANGELOG.md",
            "## [1.2.3] - Unreleased\n",
            "CHANGELOG.md has no section",
        ),
        (
            "CHANGELOG.md",
            "## [1.2.4] - 2026-01-02\n",
            "CHANGELOG.md has no section",
        ),
        (
            "README.md",
            "[a](no-such.md)\n",
            "README.md: dead link to no-such.md",
        ),
        (
            "README.md",
            "# a\n\n`etalon run`\n\n# b\n\nIt takes 3 s.\n",
            "README.md, # b: no command for 3 s",
        ),
    ] {
        let output = check(file, text);
        let found = String::from_utf8(output.stdout).unwrap();
        assert!(found.starts_with(problem), "{file}: {found}");
        assert_eq!(found.lines().count(), 1, "{file}: {found}");
        assert_eq!(output.status.code(), Some(1));
    }
}

/// Builds what is for Linux into a folder of its own, from nothing. Returns the folder.
fn released(folder: &Path) -> PathBuf {
    let status = Command::new(root().join("ci/release"))
        .args(["linux", "debian", "wheel", "image"])
        .env("ETALON_RELEASE", folder.join("release"))
        .env("ETALON_RELEASE_WORK", folder.join("work"))
        .status();
    assert!(status.unwrap().success());
    folder.join("release")
}

#[test]
fn two_builds_of_a_commit_are_equal_and_install_everywhere() {
    if !sample::all() {
        println!("not built; ETALON_TESTS=all builds twice and installs, as root");
        return;
    }
    let (one, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (first, second) = (released(one.path()), released(other.path()));
    let sums = |folder: &Path| fs::read_to_string(folder.join("SHA256SUMS")).unwrap();
    assert_eq!(sums(&first).lines().count(), 4, "{}", sums(&first));
    assert_eq!(sums(&first), sums(&second));
    let output = Command::new(root().join("ci/packaging/check"))
        .arg(&first)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    println!("{}", String::from_utf8_lossy(&output.stdout));
}
