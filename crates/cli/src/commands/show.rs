//! `etalon show`.

use crate::cases::{find, library};
use crate::catalogue::drawn;
use crate::counted::counted;
use crate::failure::Failure;
use crate::named_files::{Renewed, replace};
use crate::output::{print, say};
use crate::scene_text;
use clap::Args;
use etalon_case::{CaseRef, Library, Profile, select};
use etalon_scene::Shader;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Id of the case; or a glob or the beginning of ids, whose case files are listed
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// Write the reference picture of the first attachment that is read back to this file
    #[arg(long, value_name = "FILE")]
    pub(crate) png: Option<PathBuf>,
    /// Also print how the adapter `cpu` draws the case: the kernels of each draw, or why it has no kernels
    #[arg(long)]
    pub(crate) kernels: bool,
    /// Also print the link that draws the case in the page that `ci/page` built, hosted at this URL
    #[arg(long, value_name = "URL")]
    pub(crate) page: Option<String>,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

/// Prints the case files whose cases match a glob; the only one with the ids of these cases.
fn family(library: &Library, arguments: &Arguments, unknown: Failure) -> Result<u8, Failure> {
    let globs = [arguments.case.clone()];
    let of_profile = |profile| select(library, profile, &globs).map_err(Failure::usage);
    let full = of_profile(Profile::Full)?.cases;
    if full.is_empty() || arguments.png.is_some() || arguments.kernels || arguments.page.is_some() {
        return Err(unknown);
    }
    let quick = of_profile(Profile::Quick)?.cases;
    let quick: BTreeSet<String> = quick.iter().map(CaseRef::id).collect();
    let files = full.chunk_by(|a, b| a.file().stem() == b.file().stem());
    let files: Vec<_> = files.collect();
    let mut text = String::new();
    for cases in &files {
        let first = cases[0];
        let file = first.file().stem();
        let ids: Vec<String> = cases.iter().map(CaseRef::id).collect();
        let in_quick = ids.iter().filter(|id| quick.contains(*id)).count();
        let count = counted(ids.len() as u64, "case");
        text.push_str(&format!(
            "{file}: {count}, {in_quick} in the quick profile\n"
        ));
        let case = first.build().map_err(Failure::usage)?;
        text.push_str(&format!("  {}\n", case.about));
        if files.len() == 1 {
            case.spec
                .iter()
                .for_each(|clause| text.push_str(&format!("  {clause}\n")));
            ids.iter().for_each(|id| text.push_str(&format!("{id}\n")));
        }
    }
    print(&text)?;
    Ok(0)
}

/// Prints a case: purpose, scene, JSON, shaders.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    if let Some(path) = &arguments.png {
        Renewed::Picture.check(path)?;
    }
    let library = library(arguments.cases.as_ref())?;
    let found = match find(&library, &arguments.case) {
        Ok(found) => found,
        Err(unknown) => return family(&library, arguments, unknown),
    };
    let case = found.build().map_err(Failure::usage)?;
    let mut text = format!("{}\n{}\n", case.id, case.about);
    for clause in &case.spec {
        text.push_str(&format!("  {clause}\n"));
    }
    let needs: Vec<String> = case
        .requirements()
        .iter()
        .map(ToString::to_string)
        .collect();
    if !needs.is_empty() {
        text.push_str(&format!("needs {}\n", needs.join(", ")));
    }
    if let Some(page) = &arguments.page {
        let id = case.id.replace('%', "%25").replace('&', "%26");
        text.push_str(&format!("{page}#run={id}&profile=full\n"));
    }
    text.push('\n');
    for line in scene_text::lines(&case.scene) {
        text.push_str(&format!("{line}\n"));
    }
    if arguments.kernels {
        text.push_str("\nkernels\n");
        for line in etalon_cpu::kernels(&case.scene) {
            text.push_str(&format!("  {line}\n"));
        }
    }
    for variant in &case.variants {
        text.push_str(&format!("\nvariant {}\n", variant.name));
    }
    let json = found.expanded().map_err(Failure::usage)?;
    let json = serde_json::to_string_pretty(&json).unwrap_or_default();
    text.push_str(&format!("\n{json}\n"));
    let draws = case.scene.passes.iter().flat_map(|p| &p.draws);
    let shaders: BTreeMap<&str, Shader> = draws.map(|d| (d.shader.name(), d.shader)).collect();
    for (name, shader) in shaders {
        let (about, wgsl) = (shader.about(), shader.wgsl());
        text.push_str(&format!("\nshaders/{name}.wgsl: {about}\n{wgsl}"));
    }
    print(&text)?;
    if let Some(path) = &arguments.png {
        let frame = drawn(&case);
        let png = frame.as_ref().and_then(etalon_report::reference_png);
        let png = png.ok_or_else(|| {
            Failure::usage(format!("{} has no picture of a suitable size", case.id))
        })?;
        replace(path, &png)?;
        say!("{}: the rasterizer's picture", path.display());
    }
    Ok(0)
}
