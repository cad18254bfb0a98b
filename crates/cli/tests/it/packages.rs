//! The packages of the crates: what they hold, and that the binary builds from them alone.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::house::root;
use crate::sample;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The crate of the repository alone: the page.
const UNPUBLISHED: [&str; 1] = ["etalon-page"];

fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // A test of a released version must not depend on how the tests were built.
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("CARGO_PROFILE_") {
            command.env_remove(name);
        }
    }
    command
}

fn run(command: &mut Command) {
    let output = command.output().unwrap();
    assert!(
        output.status.success(),
        "{command:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// Packs every crate that is published and unpacks the packages into `folder`. Returns the files of each, by the
/// package's name, and the version.
fn unpacked(folder: &Path) -> (BTreeMap<String, BTreeSet<String>>, &'static str) {
    let version = env!("CARGO_PKG_VERSION");
    let target = folder.join("target");
    let mut pack = cargo();
    pack.current_dir(root())
        .args(["package", "--workspace", "--offline", "--locked"])
        .args(["--no-verify", "--allow-dirty", "--target-dir"])
        .arg(&target);
    for name in UNPUBLISHED {
        pack.args(["--exclude", name]);
    }
    run(&mut pack);
    let mut packages = BTreeMap::new();
    for entry in fs::read_dir(target.join("package")).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_none_or(|extension| extension != "crate")
        {
            continue;
        }
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let name = stem.strip_suffix(version).unwrap().trim_end_matches('-');
        let mut archive =
            tar::Archive::new(flate2::read::GzDecoder::new(fs::File::open(&path).unwrap()));
        archive.unpack(folder).unwrap();
        let mut files = BTreeSet::new();
        list(&folder.join(stem), "", &mut files);
        packages.insert(name.to_owned(), files);
    }
    (packages, version)
}

/// Lists the files of a folder, with slashes.
fn list(folder: &Path, prefix: &str, files: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().to_str().unwrap());
        if entry.file_type().unwrap().is_dir() {
            list(&entry.path(), &format!("{name}/"), files);
        } else {
            files.insert(name);
        }
    }
}

#[test]
fn packages_hold_their_licences_and_what_they_compile_in() {
    let work = tempfile::tempdir().unwrap();
    let (packages, _) = unpacked(work.path());
    assert!(packages.contains_key("etalon"), "{packages:?}");
    for (name, files) in &packages {
        for file in ["LICENSE-MIT", "LICENSE-APACHE", "README.md", "Cargo.toml"] {
            assert!(files.contains(file), "{name}: no {file}");
        }
        let stray = files.iter().find(|file| file.starts_with("tests/"));
        assert_eq!(stray, None, "{name}");
    }
    let data = |package: &str| -> BTreeSet<String> {
        let files = packages[package].iter();
        files
            .filter_map(|file| file.strip_prefix("data/"))
            .map(str::to_owned)
            .collect()
    };
    let kept = |folder: &str, extension: &str| -> BTreeSet<String> {
        let mut files = BTreeSet::new();
        list(&root().join(folder), "", &mut files);
        files.retain(|file| file.ends_with(extension) && !file.starts_with("gltf/"));
        files
    };
    assert!(kept("cases", ".json").is_subset(&data("etalon-case")));
    assert_eq!(kept("ci/findings", ".json"), data("etalon-findings"));
    assert!(kept("shaders", ".wgsl").is_subset(&data("etalon-scene")));
    for (package, file) in [
        ("etalon-scene", "tessellation/control.spv"),
        ("etalon-explore", "pairs.txt"),
        ("etalon", "order.txt"),
        ("etalon", "releases.json"),
        ("etalon", "Cargo.lock"),
    ] {
        assert!(data(package).contains(file), "{package}: {file}");
    }
}

#[test]
fn the_binary_installs_from_the_unpacked_packages_alone() {
    if !sample::all() {
        println!("not built from its packages; ETALON_TESTS=all does");
        return;
    }
    let work = tempfile::tempdir().unwrap();
    let folder = work.path();
    let (packages, version) = unpacked(folder);
    // Until the packages are published, cargo finds them beside each other.
    let mut settings = String::from("[patch.crates-io]\n");
    for name in packages.keys().filter(|name| *name != "etalon") {
        let path = folder.join(format!("{name}-{version}"));
        let _ = writeln!(settings, "{name} = {{ path = {path:?} }}");
    }
    fs::create_dir(folder.join(".cargo")).unwrap();
    fs::write(folder.join(".cargo/config.toml"), settings).unwrap();
    let binary = folder.join(format!("etalon-{version}"));
    let mut install = cargo();
    install
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("built"))
        .args(["install", "--offline", "--debug", "--path"])
        .arg(&binary)
        .arg("--root")
        .arg(folder.join("installed"));
    run(&mut install);
    let mut draw = Command::new(folder.join("installed/bin/etalon"));
    draw.current_dir(folder)
        .args(["run", "cull/*", "--adapter", "cpu", "--out", "reports"]);
    run(&mut draw);
}
