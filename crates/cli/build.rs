//! Records the version, with the commit if the sources lie in their repository. A source archive has no commit, even
//! inside the repository of another project.

use std::env;
use std::path::Path;
use std::process::Command;

/// The output of git in this folder.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
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
    // The compiler's libraries need not be present where the program runs.
    if env::var("TARGET").is_ok_and(|target| target.ends_with("windows-gnu")) {
        println!("cargo:rustc-link-arg-bins=-static");
    }
}
