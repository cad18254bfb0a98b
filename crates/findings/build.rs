//! Lists the findings under `ci/findings`, to which `data` is a link, so that they are compiled in.

use std::path::PathBuf;
use std::{env, fs, io};

/// Writes the findings as pairs of a path for messages and a text.
fn main() -> io::Result<()> {
    let manifest = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let folder = manifest.join("data").canonicalize()?;
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
