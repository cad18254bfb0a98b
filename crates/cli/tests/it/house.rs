//! The rules of the workspace: dependencies between crates, linked libraries, the top level.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use cargo_metadata::{
    Dependency, DependencyKind, Metadata, MetadataCommand, Node, Package, PackageId,
};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Crates that call a graphics driver or translate shaders for one.
const GRAPHICS: [&str; 9] = [
    "ash",
    "glow",
    "glutin_wgl_sys",
    "khronos-egl",
    "naga",
    "wgpu",
    "wgpu-core",
    "wgpu-hal",
    "wgpu-types",
];

pub(crate) fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap()
}

fn metadata() -> Metadata {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let version = Command::new(cargo).arg("-vV").output().unwrap();
    let version = String::from_utf8(version.stdout).unwrap();
    let host = version
        .lines()
        .find_map(|l| l.strip_prefix("host: "))
        .unwrap();
    // Packages of other platforms were never fetched, and tests do not use the network.
    MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .other_options(
            ["--offline", "--locked", "--filter-platform", host]
                .map(str::to_owned)
                .to_vec(),
        )
        .exec()
        .unwrap()
}

/// Returns the folder of a workspace package.
fn folder(package: &Package) -> &str {
    package.manifest_path.parent().unwrap().file_name().unwrap()
}

/// A row of the table in `crates/README.md`.
struct Row {
    crates: Vec<String>,
    /// The crates of the workspace; `None` for all.
    ours: Option<BTreeSet<String>>,
    graphics: BTreeSet<String>,
}

/// Returns the words of a cell that stand between backticks.
fn names(cell: &str) -> impl Iterator<Item = String> {
    cell.split('`').skip(1).step_by(2).map(str::to_owned)
}

/// Reads the table of crates: name, content, and what the crate may use, of the workspace first.
fn table() -> Vec<Row> {
    let text = fs::read_to_string(root().join("crates/README.md")).unwrap();
    let (_, table) = text
        .split_once("| crate | content | may use |\n|---|---|---|\n")
        .unwrap();
    let lines = table.lines().take_while(|line| line.starts_with('|'));
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').collect();
        let (ours, others) = cells[3].split_once(';').unwrap_or((cells[3], ""));
        Row {
            crates: names(cells[1]).collect(),
            ours: (ours.trim() != "all").then(|| names(ours).collect()),
            graphics: names(others)
                .filter(|name| GRAPHICS.contains(&&**name))
                .collect(),
        }
    };
    lines.map(row).collect()
}

fn package_name(folder: &str) -> String {
    match folder {
        "cli" => "etalon".to_owned(),
        folder => format!("etalon-{folder}"),
    }
}

/// Returns the names of a package and of everything that it links.
fn closure<'m>(metadata: &'m Metadata, package: &'m PackageId) -> BTreeSet<&'m str> {
    let nodes: BTreeMap<&PackageId, &Node> = metadata
        .resolve
        .as_ref()
        .unwrap()
        .nodes
        .iter()
        .map(|node| (&node.id, node))
        .collect();
    let mut seen = BTreeSet::from([package]);
    let mut todo = vec![package];
    while let Some(id) = todo.pop() {
        for dependency in &nodes[id].deps {
            let normal = |k: &cargo_metadata::DepKindInfo| k.kind == DependencyKind::Normal;
            if dependency.dep_kinds.iter().any(normal) && seen.insert(&dependency.pkg) {
                todo.push(&dependency.pkg);
            }
        }
    }
    seen.into_iter()
        .map(|id| metadata[id].name.as_str())
        .collect()
}

#[test]
fn every_crate_uses_what_the_table_allows_and_all_of_it() {
    let metadata = metadata();
    let members = metadata.workspace_packages();
    let folders: BTreeSet<&str> = members.iter().map(|p| folder(p)).collect();
    let table = table();
    let rows: BTreeSet<&str> = table
        .iter()
        .flat_map(|row| row.crates.iter().map(String::as_str))
        .collect();
    assert_eq!(folders, rows, "crates and rows");
    for row in &table {
        let names: BTreeSet<String> = row.crates.iter().map(|f| package_name(f)).collect();
        let mut used = BTreeSet::new();
        for package in members.iter().filter(|p| names.contains(p.name.as_str())) {
            let normal = |d: &&Dependency| d.kind != DependencyKind::Development;
            let dependencies = package.dependencies.iter().filter(normal);
            used.extend(dependencies.map(|d| d.name.clone()));
            // Nor through an external crate.
            let linked = closure(&metadata, &package.id);
            if row.graphics.is_empty() && row.ours.is_some() {
                let found: Vec<_> = GRAPHICS.iter().filter(|g| linked.contains(**g)).collect();
                assert!(found.is_empty(), "{} links {found:?}", package.name);
            }
        }
        let graphics: BTreeSet<String> = used
            .iter()
            .filter(|name| GRAPHICS.contains(&&***name))
            .cloned()
            .collect();
        assert_eq!(graphics, row.graphics, "graphics of {names:?}");
        if let Some(ours) = &row.ours {
            let found: BTreeSet<String> = folders
                .iter()
                .filter(|folder| used.contains(&package_name(folder)))
                .map(|folder| (*folder).to_owned())
                .collect();
            assert_eq!(&found, ours, "crates that {names:?} use");
        }
    }
}

#[test]
fn every_package_takes_its_terms_and_versions_from_the_workspace() {
    let metadata = metadata();
    for package in metadata.workspace_packages() {
        let name = &package.name;
        assert_eq!(package.license.as_deref(), Some("MIT OR Apache-2.0"));
        let rust = package.rust_version.as_ref().unwrap();
        assert_eq!((rust.major, rust.minor), (1, 95), "{name}");
        assert!(package.description.is_some(), "{name}");

        let text = fs::read_to_string(&package.manifest_path).unwrap();
        let mut section = "";
        for line in text.lines().map(str::trim) {
            if line.starts_with('[') {
                section = line;
                let table = section.contains("dependencies.");
                assert!(!table, "{name}: {section}: one line per dependency");
            } else if section.ends_with("dependencies]") && !line.is_empty() {
                let inherited = line.contains("workspace = true") || line.starts_with('#');
                // Without a version, a package leaves the dependency out, so that tests can use what uses their crate.
                let ours = line.starts_with("etalon-") && section == "[dev-dependencies]";
                assert!(inherited != ours, "{name}: `{line}` in {section}");
            }
        }
        let lints = text.contains("[lints]\nworkspace = true");
        assert!(lints, "{name} takes the workspace's lints");
        let mut fields = vec!["version", "edition", "rust-version", "license"];
        if package.publish.is_none() {
            fields.extend(["repository", "readme", "keywords", "categories", "include"]);
        }
        for field in fields {
            let line = format!("\n{field}.workspace = true\n");
            assert!(text.contains(&line), "{name}: {field}");
        }
    }
}

#[test]
fn no_graphics_library_is_linked() {
    let metadata = metadata();
    for package in metadata.workspace_packages() {
        for dependency in &package.dependencies {
            for (name, feature) in [("ash", "linked"), ("khronos-egl", "static")] {
                let on =
                    dependency.name == name && dependency.features.iter().any(|f| f == feature);
                assert!(!on, "{} takes {name} with {feature}", package.name);
            }
        }
    }
    let nodes = &metadata.resolve.as_ref().unwrap().nodes;
    for node in nodes {
        let links = metadata[&node.id].links.as_deref().unwrap_or_default();
        let links = links.to_lowercase();
        for word in ["egl", "gl", "gles", "vulkan", "gbm", "x11", "wayland"] {
            assert!(!links.contains(word), "{} links {links}", node.id);
        }
    }
    // The libraries that the loader lists.
    let output = Command::new(env!("CARGO_BIN_EXE_etalon"))
        .env("LD_TRACE_LOADED_OBJECTS", "1")
        .output()
        .unwrap();
    let libraries = String::from_utf8(output.stdout).unwrap();
    assert!(libraries.contains("libc.so"), "{libraries}");
    for word in [
        "EGL", "libGL", "vulkan", "gbm", "X11", "wayland", "LLVM", "gallium",
    ] {
        assert!(!libraries.contains(word), "{libraries}");
    }
}

/// Files that git tracks or would track.
pub(crate) fn files() -> Vec<String> {
    let output = Command::new("git")
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "git ls-files: {output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    let files: Vec<String> = text
        .split_terminator('\0')
        .filter(|name| root().join(name).is_file())
        .map(str::to_owned)
        .collect();
    assert!(files.len() > 100, "{files:?}");
    files
}

#[test]
fn the_top_level_holds_what_belongs_there() {
    let mut found: BTreeSet<String> = files()
        .iter()
        .filter_map(|name| name.split('/').next())
        .filter(|name| !name.starts_with('.'))
        .map(str::to_owned)
        .collect();
    // Git keeps no empty folders.
    found.insert("reports".to_owned());
    let expected = [
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "Cargo.lock",
        "Cargo.toml",
        "LICENSE-APACHE",
        "LICENSE-MIT",
        "README.md",
        "cases",
        "ci",
        "crates",
        "reports",
        "shaders",
    ];
    assert_eq!(found, expected.map(str::to_owned).into());
}

/// Returns the link targets of a Markdown text, and the code in it that begins with a folder of the
/// repository.
fn targets(text: &str) -> (Vec<&str>, Vec<&str>) {
    let (mut links, mut code) = (Vec::new(), Vec::new());
    let mut fenced = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            let after = line.split("](").skip(1);
            links.extend(after.filter_map(|rest| rest.split(')').next()));
            let spans = line.split('`').skip(1).step_by(2);
            code.extend(spans.filter_map(|span| {
                let path = span.split_whitespace().next()?;
                let (top, below) = path.split_once('/')?;
                let ours = ["cases", "ci", "crates", "reports", "shaders"].contains(&top);
                // New runs and patterns are not files.
                let is_new = below.contains("latest") || below.starts_with("earlier");
                let named = !is_new && !path.contains(['<', '*', '{', '…']);
                (ours && named).then_some(path)
            }));
        }
    }
    (links, code)
}

/// Returns the anchors of a page's headings, as GitHub and GitLab make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let titles = headings.map(|line| line.trim_start_matches('#').trim().to_lowercase());
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    titles
        .map(|title| title.chars().filter(kept).collect::<String>())
        .map(|title| title.replace(' ', "-"))
        .collect()
}

#[test]
fn links_and_paths_in_pages_lead_somewhere() {
    let mut broken = Vec::new();
    for name in files().iter().filter(|name| name.ends_with(".md")) {
        let page = root().join(name);
        let text = fs::read_to_string(&page).unwrap();
        let (links, code) = targets(&text);
        for link in links.into_iter().filter(|link| !link.contains("://")) {
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = match path {
                "" => page.clone(),
                path => page.parent().unwrap().join(path),
            };
            let reached = match anchor {
                "" => target.exists(),
                anchor => {
                    fs::read_to_string(&target).is_ok_and(|text| anchors(&text).contains(anchor))
                }
            };
            if !reached {
                broken.push(format!("{name}: {link}"));
            }
        }
        let missing = code.iter().filter(|path| !root().join(path).exists());
        broken.extend(missing.map(|path| format!("{name}: `{path}`")));
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn every_dependency_is_explained() {
    let page = fs::read_to_string(root().join("crates/dependencies.md")).unwrap();
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let (_, table) = manifest.split_once("[workspace.dependencies]").unwrap();
    let names = table
        .lines()
        .skip(1)
        .take_while(|line| !line.starts_with('['))
        .filter_map(|line| line.split_once(" = "))
        .map(|(name, _)| name)
        .filter(|name| !name.starts_with("etalon-"));
    let unexplained: Vec<&str> = names
        .filter(|name| !page.contains(&format!("`{name}`")))
        .collect();
    assert!(unexplained.is_empty(), "no row for {unexplained:?}");
}

#[test]
fn every_shader_has_its_twin() {
    let stems = |folder: &str, extension: &str| -> BTreeSet<String> {
        fs::read_dir(root().join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter_map(|name| name.strip_suffix(extension).map(str::to_owned))
            .collect()
    };
    let shaders = stems("shaders", ".wgsl");
    let mut twins = stems("crates/pipeline/src/shader", ".rs");
    // Helpers that all twins share.
    for shared in ["mod", "interface", "arithmetic"] {
        assert!(twins.remove(shared), "{shared}");
    }
    assert!(!shaders.is_empty());
    assert_eq!(shaders, twins);
}
