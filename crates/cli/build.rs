//! Records the version, with the commit if the sources lie in their repository, and lists the findings under
//! `ci/findings`, so that they are compiled in. Source archives have no commit, not even inside the repository of
//! something else.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

/// The output of git in this folder.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

/// Writes the findings as pairs of a path for messages and a text.
fn findings() -> io::Result<()> {
    let manifest = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let folder = manifest.join("../../ci/findings").canonicalize()?;
    println!("cargo:rerun-if-changed={}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(&folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if name.ends_with(".json") {
            names.push(name);
        }
    }
    names.sort();
    let each = names.iter().map(|name| {
        let shown = format!("ci/findings/{name}");
        format!("    ({shown:?}, include_str!({:?})),\n", folder.join(name))
    });
    let text = format!("&[\n{}]\n", each.collect::<String>());
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    fs::write(out.join("findings.rs"), text)
}

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    findings()?;
    let mut version = env::var("CARGO_PKG_VERSION").unwrap_or_default();
    if git(&["rev-parse", "--show-prefix"]).as_deref() == Some("crates/cli/") {
        // The log of HEAD grows with every commit and checkout.
        for name in ["HEAD", "logs/HEAD"] {
            let path = git(&["rev-parse", "--git-path", name]).unwrap_or_default();
            if Path::new(&path).is_file() {
                println!("cargo:rerun-if-changed={path}");
            }
        }
        let commit = git(&["log", "-1", "--format=%H %cs"]).unwrap_or_default();
        if let Some((commit, day)) = commit.split_once(' ') {
            println!("cargo:rustc-env=ETALON_COMMIT={commit}");
            version.push_str(&format!(" ({} {day})", &commit[..12]));
        }
    }
    println!("cargo:rustc-env=ETALON_VERSION={version}");
    // The program needs no libraries of its compiler on the machine where it runs.
    if env::var("TARGET").is_ok_and(|target| target.ends_with("windows-gnu")) {
        println!("cargo:rustc-link-arg-bins=-static");
    }
    Ok(())
}
