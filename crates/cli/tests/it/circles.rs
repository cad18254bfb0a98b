//! No two files of a crate need each other, directly or through others: each can be read after those it uses.
//!
//! An edge leads from a file to the file that defines what it names, through any number of re-exports: a
//! module that only declares its children and re-exports their items has no edges. Items under `#[cfg(test)]`
//! are left out. Uses that only types show, such as methods, are not found.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::slice::from_ref;
use syn::buffer::{Cursor, TokenBuffer};
use syn::visit::{self, Visit};
use syn::{Attribute, Ident, Item, ItemMod, ItemUse, Macro, UseTree, Visibility};

/// The segments of a path, without `self`.
type Segments = Vec<String>;

/// Returns the name and the text of a module's file.
type Source<'a> = &'a dyn Fn(&[String]) -> Option<(String, String)>;

/// A module: a file, or a part of one.
#[derive(Default)]
struct Module {
    file: String,
    children: BTreeSet<String>,
    items: BTreeSet<String>,
    /// The path and the name of each import; the name is `*` if all names are imported.
    imports: Vec<(Segments, String)>,
    /// The paths that are used.
    paths: BTreeSet<Segments>,
}

impl Module {
    /// Returns the paths that are imported by a name.
    fn imported<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a [String]> {
        self.imports
            .iter()
            .filter(move |import| import.1 == name)
            .map(|(path, _)| &path[..])
    }
}

/// The target of a path.
enum Target {
    Module(Segments),
    /// An item of this file.
    File(String),
}

/// The modules of a crate.
struct Crate<'a> {
    source: Source<'a>,
    modules: BTreeMap<Segments, Module>,
    /// The module that is being read.
    here: Segments,
}

impl<'a> Crate<'a> {
    fn read(source: Source<'a>) -> Self {
        let mut found = Self {
            source,
            modules: BTreeMap::new(),
            here: Segments::new(),
        };
        found.file();
        found
    }

    fn module(&mut self) -> &mut Module {
        self.modules.entry(self.here.clone()).or_default()
    }

    fn file(&mut self) {
        if let Some((file, text)) = (self.source)(&self.here) {
            let parsed = syn::parse_file(&text).unwrap_or_else(|e| panic!("{file}: {e}"));
            self.items(file, &parsed.items);
        }
    }

    fn items(&mut self, file: String, items: &[Item]) {
        self.module().file = file;
        for item in items {
            let (attributes, name) = described(item);
            if !attributes.iter().any(is_test) {
                self.module().items.extend(name.map(Ident::to_string));
                self.visit_item(item);
            }
        }
    }

    /// Adds the leaves of the tree of an import.
    fn import(&mut self, tree: &UseTree, mut path: Segments, public: bool) {
        let (segment, name) = match tree {
            UseTree::Group(group) => {
                for inner in &group.items {
                    self.import(inner, path.clone(), public);
                }
                return;
            }
            UseTree::Path(inner) => {
                extend(&mut path, &inner.ident);
                return self.import(&inner.tree, path, public);
            }
            UseTree::Glob(_) => (None, "*".to_owned()),
            UseTree::Name(leaf) if leaf.ident == "self" => (None, path.last().unwrap().clone()),
            UseTree::Name(leaf) => (Some(&leaf.ident), leaf.ident.to_string()),
            UseTree::Rename(leaf) => (Some(&leaf.ident), leaf.rename.to_string()),
        };
        if let Some(segment) = segment {
            extend(&mut path, segment);
        }
        if !public {
            self.module().paths.insert(path.clone());
        }
        self.module().imports.push((path, name));
    }

    /// Adds the paths among the tokens of a macro.
    fn tokens(&mut self, mut cursor: Cursor<'_>) {
        let mut path = Segments::new();
        while let Some((_, mut rest)) = cursor.token_tree() {
            if let Some((ident, _)) = cursor.ident() {
                extend(&mut path, &ident);
            } else if let Some((inner, ..)) = cursor.any_group() {
                self.tokens(inner);
            }
            match colon(rest).and_then(colon) {
                Some(behind) => rest = behind,
                None => _ = self.module().paths.insert(std::mem::take(&mut path)),
            }
            cursor = rest;
        }
    }

    /// Returns the target of a path that a module names.
    fn find(&self, module: &[String], path: &[String], steps: usize) -> Option<Target> {
        // Modules can re-export from each other.
        let steps = steps.checked_sub(1)?;
        let here = self.modules.get(module)?;
        let Some((first, rest)) = path.split_first() else {
            return Some(Target::Module(module.to_vec()));
        };
        match first.as_str() {
            "crate" => return self.inside(&[], rest, steps),
            "super" => return self.inside(module.split_last()?.1, rest, steps),
            child
                if here.children.contains(child)
                    && !(rest.is_empty() && here.items.contains(child)) =>
            {
                return self.inside(&[module, from_ref(first)].concat(), rest, steps);
            }
            item if here.items.contains(item) => return Some(Target::File(here.file.clone())),
            _ => {}
        }
        // A name imported as itself is a crate's name.
        let mut named = here
            .imported(first)
            .filter(|import| import.first() != Some(first));
        let mut globs = here.imported("*");
        named
            .find_map(|import| self.find(module, &[import, rest].concat(), steps))
            .or_else(|| {
                globs.find_map(|glob| match self.find(module, glob, steps)? {
                    Target::Module(inner) if inner != module => self.find(&inner, path, steps),
                    _ => None,
                })
            })
    }

    /// Returns the target of a path inside a module. A name that nothing there declares is made by a macro.
    fn inside(&self, module: &[String], path: &[String], steps: usize) -> Option<Target> {
        self.find(module, path, steps).or_else(|| {
            let here = self.modules.get(module)?;
            let macro_made = here.imported(&path[0]).next().is_none();
            macro_made.then(|| Target::File(here.file.clone()))
        })
    }

    /// Returns pairs of files in which the first uses the second, with the path of that use.
    fn edges(&self) -> BTreeMap<[String; 2], String> {
        let mut edges = BTreeMap::new();
        for (name, module) in &self.modules {
            for path in &module.paths {
                if let Some(Target::File(file)) = self.find(name, path, 16)
                    && file != module.file
                {
                    edges.insert([module.file.clone(), file], path.join("::"));
                }
            }
        }
        edges
    }

    /// Returns the edges between files that need each other.
    fn circles(&self) -> Vec<String> {
        let mut edges = self.edges();
        loop {
            let files = |end: usize| edges.keys().map(move |edge| edge[end].clone());
            let users: BTreeSet<String> = files(0).collect();
            let used: BTreeSet<String> = files(1).collect();
            let before = edges.len();
            edges.retain(|[user, file], _| used.contains(user) && users.contains(file));
            if edges.len() == before {
                break;
            }
        }
        let lines = edges
            .iter()
            .map(|([user, file], path)| format!("{user} -> {file}: {path}"));
        lines.collect()
    }
}

impl Visit<'_> for Crate<'_> {
    fn visit_item_mod(&mut self, item: &ItemMod) {
        let name = item.ident.to_string();
        self.module().children.insert(name.clone());
        let file = self.module().file.clone();
        self.here.push(name);
        match &item.content {
            Some((_, items)) => self.items(file, items),
            None => self.file(),
        }
        self.here.pop();
    }

    fn visit_item_use(&mut self, item: &ItemUse) {
        let public = !matches!(item.vis, Visibility::Inherited);
        self.import(&item.tree, Segments::new(), public);
    }

    fn visit_path(&mut self, path: &syn::Path) {
        let mut segments = Segments::new();
        path.segments
            .iter()
            .for_each(|segment| extend(&mut segments, &segment.ident));
        self.module().paths.insert(segments);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &Macro) {
        self.visit_path(&item.path);
        self.tokens(TokenBuffer::new2(item.tokens.clone()).begin());
    }
}

fn extend(path: &mut Segments, segment: &Ident) {
    if segment != "self" {
        path.push(segment.to_string());
    }
}

fn colon(cursor: Cursor<'_>) -> Option<Cursor<'_>> {
    let (punct, rest) = cursor.punct()?;
    (punct.as_char() == ':').then_some(rest)
}

fn is_test(attribute: &Attribute) -> bool {
    let word = attribute.parse_args::<Ident>();
    attribute.path().is_ident("cfg") && word.is_ok_and(|word| word == "test")
}

/// Returns the attributes of an item, and the name that it declares, except for modules and imports.
fn described(item: &Item) -> (&[Attribute], Option<&Ident>) {
    match item {
        Item::Const(item) => (&item.attrs, Some(&item.ident)),
        Item::Enum(item) => (&item.attrs, Some(&item.ident)),
        Item::Fn(item) => (&item.attrs, Some(&item.sig.ident)),
        Item::Macro(item) => (&item.attrs, item.ident.as_ref()),
        Item::Static(item) => (&item.attrs, Some(&item.ident)),
        Item::Struct(item) => (&item.attrs, Some(&item.ident)),
        Item::Trait(item) => (&item.attrs, Some(&item.ident)),
        Item::Type(item) => (&item.attrs, Some(&item.ident)),
        Item::Union(item) => (&item.attrs, Some(&item.ident)),
        Item::Impl(item) => (&item.attrs, None),
        Item::Mod(item) => (&item.attrs, None),
        Item::Use(item) => (&item.attrs, None),
        _ => (&[], None),
    }
}

#[test]
fn the_files_of_each_crate_form_no_circle() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut roots: Vec<PathBuf> = Vec::new();
    for entry in fs::read_dir(&crates).unwrap() {
        let folder = entry.unwrap().path();
        let names = ["src/lib.rs", "src/main.rs", "tests/it/main.rs"];
        let there = names.map(|name| folder.join(name));
        roots.extend(there.into_iter().filter(|root| root.is_file()));
    }
    roots.sort();
    assert!(roots.len() > 18, "{roots:?}");
    let (mut circles, mut edges) = (Vec::new(), 0);
    for root in &roots {
        let folder = root.parent().unwrap();
        let source = |module: &[String]| {
            let path = folder.join(module.join("/"));
            let files = [path.with_extension("rs"), path.join("mod.rs")];
            let file = if module.is_empty() {
                root
            } else {
                files.iter().find(|file| file.is_file())?
            };
            let text = fs::read_to_string(file).unwrap();
            // Tests can share a file with another crate's tests.
            let shares = folder.ends_with("tests/it");
            let is_for_tests = !text.replace("#[cfg(test)]\n#[path", "").contains("#[path");
            assert!(is_for_tests || shares, "{file:?} names its modules' files");
            Some((
                file.strip_prefix(&crates).unwrap().display().to_string(),
                text,
            ))
        };
        let found = Crate::read(&source);
        edges += found.edges().len();
        circles.extend(found.circles());
    }
    // A reader that finds no uses would find no circles either.
    assert!(edges > 500, "{edges}");
    assert!(
        circles.is_empty(),
        "files need each other:\n{}",
        circles.join("\n")
    );
}

fn made(files: &[(&str, &str)]) -> Vec<String> {
    Crate::read(&|module: &[String]| {
        let name = module.join("/");
        let (_, text) = files.iter().find(|(path, _)| *path == name)?;
        Some((name, (*text).to_owned()))
    })
    .circles()
}

#[test]
fn circles_are_found() {
    let circle = |files: &[(&str, &str)]| {
        let circles = made(files);
        let is_on = |file: &str| {
            circles
                .iter()
                .any(|edge| edge.starts_with(&format!("{file} -> ")))
        };
        assert!(
            files.iter().all(|(file, _)| file.is_empty() || is_on(file)),
            "{circles:?}"
        );
    };
    // Directly, through a third, by a path in an expression, through an imported module.
    circle(&[
        ("", "mod a; mod b;"),
        ("a", "use crate::b::B; struct A;"),
        ("b", "use super::a::A; struct B;"),
    ]);
    circle(&[
        ("", "mod a; mod b; mod c;"),
        ("a", "use crate::{b::{B as X, self}}; struct A;"),
        ("b", "fn f() { crate::c::g() } struct B;"),
        ("c", "use super::a; fn g() { a::A }"),
    ]);
    // A child that uses what its parent defines and needs it for.
    circle(&[
        ("", "mod p;"),
        ("p", "mod c; use c::C; pub struct P(C);"),
        ("p/c", "use super::P; pub struct C;"),
    ]);
    // Through re-exports, by name and all at once.
    circle(&[
        ("", "mod a; mod b; pub use a::*; pub(crate) use b::B;"),
        ("a", "use crate::B; pub struct A;"),
        (
            "b",
            "fn f<'a>(x: &'a str) -> char { crate::A; '\\'' } pub struct B;",
        ),
    ]);
    // With an item that a macro makes.
    circle(&[
        ("", "mod a; mod b;"),
        ("a", "use crate::b::B; made! { A }"),
        ("b", "use crate::a::A; pub struct B;"),
    ]);
    // In a module inside a file, and in a macro's call.
    circle(&[
        ("", "mod a; mod b;"),
        (
            "a",
            "mod inner { fn f() { g!(1, (super::super::b::B)) } } pub struct A;",
        ),
        ("b", "use crate::a::A; pub struct B;"),
    ]);
    // With a function that has the name of a module beside it.
    circle(&[
        ("", "mod a; mod b;"),
        ("a", "use crate::b; pub struct A; fn f() { b::c() }"),
        ("b", "mod c {} use crate::a::A; pub fn c() {}"),
    ]);
    // In a module inside a file.
    circle(&[
        ("", "mod a; mod b;"),
        ("a", "mod inner { use super::super::b::B; } pub struct A;"),
        ("b", "use crate::a::A; pub struct B;"),
    ]);
}

#[test]
fn dependencies_without_a_circle_are_accepted() {
    let fine = |files: &[(&str, &str)]| assert_eq!(made(files), [""; 0]);
    // A parent that declares and re-exports; siblings that are read through it.
    fine(&[
        ("", "mod p; pub use p::A;"),
        ("p", "mod a; mod b; pub use a::A; pub use b::B;"),
        ("p/a", "use super::B; pub struct A;"),
        ("p/b", "pub struct B;"),
    ]);
    // Tests, comments, literals.
    fine(&[
        ("", "mod a; mod b;"),
        ("a", "use crate::b::B; pub struct A;"),
        (
            "b",
            "//! crate::a::A\n/* use crate::a::A; /* */ */ pub struct B(&'static str);\n\
             const C: &str = r#\"use \"crate::a::A;\"#; const D: &str = \"\\\"crate::a::A\";\n\
             #[cfg(test)] mod tests { use super::*; use crate::a::A; }",
        ),
    ]);
}
