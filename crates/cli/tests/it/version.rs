//! `--version`, and the build script that finds the commit.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command as Assert;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const VERSION: &str = env!("CARGO_PKG_VERSION");

#[test]
fn both_flags_print_the_version_and_the_commit() {
    for flag in ["-V", "--version"] {
        Assert::new(env!("CARGO_BIN_EXE_etalon"))
            .arg(flag)
            .assert()
            .success()
            .stdout(format!("etalon {}\n", env!("ETALON_VERSION")));
    }
}

/// The variables that the build script sets in a folder.
fn built(script: &Path, folder: &Path, path: &str) -> Vec<String> {
    let output = Command::new(script)
        .current_dir(folder)
        .env("PATH", path)
        .env("CARGO_PKG_VERSION", VERSION)
        // Repositories above the test's folder have no effect.
        .env("GIT_CEILING_DIRECTORIES", script.parent().unwrap())
        .env_remove("GIT_DIR")
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines()
        .filter_map(|line| line.strip_prefix("cargo:rustc-env="))
        .map(str::to_owned)
        .collect()
}

fn git(folder: &Path, arguments: &[&str]) {
    let output = Command::new("git")
        .current_dir(folder)
        .args(["-c", "user.name=a", "-c", "user.email=a@example.org"])
        .args(arguments)
        .env("GIT_COMMITTER_DATE", "2026-11-22T12:00:00Z")
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn the_build_script_needs_neither_a_repository_nor_git() {
    let work = tempfile::tempdir().unwrap();
    let script = work.path().join("build");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("build.rs");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let status = Command::new(rustc)
        .args(["--edition", "2024", "-o"])
        .args([&script, &source])
        .status();
    assert!(status.unwrap().success());
    let path = std::env::var("PATH").unwrap();
    let bare = vec![format!("ETALON_VERSION={VERSION}")];
    let package = |top: &str| -> PathBuf {
        let folder = work.path().join(top).join("crates/cli");
        fs::create_dir_all(&folder).unwrap();
        folder
    };

    assert_eq!(built(&script, &package("archive"), &path), bare);
    assert_eq!(built(&script, &package("archive"), ""), bare);

    let folder = package("own");
    let top = work.path().join("own");
    fs::write(folder.join("file"), "").unwrap();
    git(&top, &["init", "--quiet"]);
    assert_eq!(built(&script, &folder, &path), bare, "no commit yet");
    git(&top, &["add", "."]);
    git(&top, &["commit", "--quiet", "--message", "a"]);
    let found = built(&script, &folder, &path);
    let commit = found[0].strip_prefix("ETALON_COMMIT=").unwrap();
    assert_eq!(commit.len(), 40);
    let version = format!("ETALON_VERSION={VERSION} ({} 2026-11-22)", &commit[..12]);
    assert_eq!(found[1..], [version]);
    assert_eq!(built(&script, &folder, ""), bare, "without git");

    // An archive inside another project's repository.
    assert_eq!(built(&script, &package("own/vendor"), &path), bare);
}
