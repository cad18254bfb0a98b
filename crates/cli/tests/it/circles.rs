//! No two files of a crate need each other, directly or through others: each can be read after those it uses.
//!
//! An edge leads from a file to the file that defines what it names, through any number of re-exports: a module that
//! only declares its children and hands their items on takes no part. Modules under `#[cfg(test)]` are left out.
//! Sources are read as tokens and not as syntax trees, which would need a parser among the dependencies; uses
//! that only types or macros show, such as methods, are not seen.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The identifiers and symbols of a source file, without comments and literals.
fn tokens(text: &str) -> Vec<String> {
    let all: Vec<char> = text.chars().collect();
    let at = |i: usize| all.get(i).copied().unwrap_or('\0');
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < all.len() {
        let c = all[i];
        if c == '/' && at(i + 1) == '/' {
            while i < all.len() && all[i] != '\n' {
                i += 1;
            }
        } else if c == '/' && at(i + 1) == '*' {
            let mut depth = 0;
            loop {
                match (at(i), at(i + 1)) {
                    ('/', '*') => depth += 1,
                    ('*', '/') => depth -= 1,
                    _ => {
                        i += 1;
                        continue;
                    }
                }
                i += 2;
                if depth == 0 || i >= all.len() {
                    break;
                }
            }
        } else if c == '"' {
            i += 1;
            while i < all.len() && all[i] != '"' {
                i += if all[i] == '\\' { 2 } else { 1 };
            }
            i += 1;
            tokens.push("\"".to_owned());
        } else if c == '\'' {
            // A character, or a lifetime, which has no closing quote.
            let closing = if at(i + 1) == '\\' {
                (i + 3..i + 12).find(|k| at(*k) == '\'')
            } else {
                Some(i + 2).filter(|k| at(*k) == '\'')
            };
            i = closing.unwrap_or(i) + 1;
        } else if is_word(c) {
            let start = i;
            while is_word(at(i)) {
                i += 1;
            }
            let word: String = all[start..i].iter().collect();
            let raw = ["r", "br", "cr"].contains(&word.as_str());
            let hashes = (i..).take_while(|k| at(*k) == '#').count();
            if raw && at(i + hashes) == '"' {
                i += hashes + 1;
                let is_end = |k: usize| at(k) == '"' && (1..=hashes).all(|n| at(k + n) == '#');
                while i < all.len() && !is_end(i) {
                    i += 1;
                }
                i += hashes + 1;
                tokens.push("\"".to_owned());
            } else {
                tokens.push(word);
            }
        } else if c == ':' && at(i + 1) == ':' {
            i += 2;
            tokens.push("::".to_owned());
        } else {
            i += 1;
            if !c.is_whitespace() {
                tokens.push(c.to_string());
            }
        }
    }
    tokens
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// A leaf of a `use` declaration; the name is `*` where all names are imported.
#[derive(Clone, Debug)]
struct Import {
    path: Vec<String>,
    name: String,
    public: bool,
}

/// A module, whether it is a file or stands inside one.
#[derive(Debug, Default)]
struct Module {
    file: String,
    children: BTreeSet<String>,
    items: BTreeSet<String>,
    imports: Vec<Import>,
    /// Names and paths in everything but declarations of `use`.
    names: BTreeSet<String>,
    paths: BTreeSet<Vec<String>>,
}

/// The segments of a path from the root of the crate.
type ModulePath = Vec<String>;

/// The target of a path.
enum Target {
    Module(ModulePath),
    /// An item of this file.
    File(String),
}

#[derive(Default)]
struct Crate {
    modules: BTreeMap<ModulePath, Module>,
}

impl Crate {
    /// Adds the module of a file and those inside it.
    fn add(&mut self, path: ModulePath, file: &str, text: &str) {
        let tokens = tokens(text);
        self.parse(path, file, &tokens);
    }

    /// Reads tokens up to the end or to the brace that closes the module; returns how many were read.
    fn parse(&mut self, path: ModulePath, file: &str, tokens: &[String]) -> usize {
        let mut module = Module {
            file: file.to_owned(),
            ..Module::default()
        };
        let token = |i: usize| tokens.get(i).map_or("", String::as_str);
        let (mut i, mut depth) = (0, 0);
        let (mut test, mut public) = (false, false);
        while i < tokens.len() {
            match token(i) {
                "{" => depth += 1,
                "}" if depth == 0 => break,
                "}" => depth -= 1,
                "#" => {
                    let end = end_of_group(tokens, i + 1 + usize::from(token(i + 1) == "!"));
                    let words: Vec<&str> = tokens[i..end].iter().map(String::as_str).collect();
                    test |= words.windows(3).any(|w| w == ["cfg", "(", "test"]);
                    i = end;
                    continue;
                }
                "pub" => {
                    public = true;
                    i += 1;
                    if token(i) == "(" {
                        i = end_of_group(tokens, i);
                    }
                    continue;
                }
                "use" => {
                    let end = (i..tokens.len()).find(|k| token(*k) == ";").unwrap();
                    if !test {
                        leaves(&tokens[i + 1..end], &[], public, &mut module.imports);
                    }
                    i = end;
                }
                "mod" if is_name(token(i + 1)) && token(i + 2) == ";" => {
                    if !test {
                        module.children.insert(token(i + 1).to_owned());
                    }
                    i += 2;
                }
                "mod" if is_name(token(i + 1)) && token(i + 2) == "{" => {
                    if test {
                        i = end_of_group(tokens, i + 2) - 1;
                    } else {
                        let name = token(i + 1).to_owned();
                        let inner = [&path[..], std::slice::from_ref(&name)].concat();
                        module.children.insert(name);
                        i += 3 + self.parse(inner, file, &tokens[i + 3..]);
                    }
                }
                "macro_rules" => {
                    module.items.insert(token(i + 2).to_owned());
                    i += 2;
                }
                word @ ("fn" | "struct" | "enum" | "trait" | "const" | "static" | "type"
                | "union") => {
                    let named = is_name(token(i + 1)) && token(i + 1) != "fn";
                    if depth == 0 && named {
                        if test && word == "fn" {
                            // A helper of tests: its body is left out.
                            let open = (i..tokens.len()).find(|k| ["{", ";"].contains(&token(*k)));
                            i = end_of_group(tokens, open.unwrap()) - 1;
                        } else {
                            module.items.insert(token(i + 1).to_owned());
                            i += 1;
                        }
                    }
                }
                word if is_name(word) => {
                    let mut segments = vec![word.to_owned()];
                    while token(i + 1) == "::" && is_name(token(i + 2)) {
                        segments.push(token(i + 2).to_owned());
                        i += 2;
                    }
                    module.names.extend(segments.first().cloned());
                    if segments.len() > 1 {
                        module.paths.insert(segments);
                    }
                    i += 1;
                    continue;
                }
                _ => {}
            }
            (test, public) = (false, false);
            i += 1;
        }
        self.modules.insert(path, module);
        i
    }

    fn resolve(&self, from: &[String], path: &[String], steps: usize) -> Option<Target> {
        // Modules may re-export from each other.
        let steps = steps.checked_sub(1)?;
        let mut rest = path;
        let mut at: ModulePath = match rest.first()?.as_str() {
            "crate" => Vec::new(),
            "self" => from.to_vec(),
            "super" => from[..from.len().checked_sub(1)?].to_vec(),
            first => {
                let here = self.modules.get(from)?;
                let known = here.children.contains(first) || here.items.contains(first);
                let imported = here.imports.iter().any(|import| import.name == first);
                if !known && !imported {
                    return None;
                }
                return self.find(from, path, steps);
            }
        };
        rest = &rest[1..];
        while rest.first().is_some_and(|segment| segment == "super") {
            at.pop()?;
            rest = &rest[1..];
        }
        self.find(&at, rest, steps)
    }

    /// The target of a path that begins in a module.
    fn find(&self, module: &[String], path: &[String], steps: usize) -> Option<Target> {
        let steps = steps.checked_sub(1)?;
        let here = self.modules.get(module)?;
        let Some((first, rest)) = path.split_first() else {
            return Some(Target::Module(module.to_vec()));
        };
        if here.children.contains(first) {
            return self.find(&[module, std::slice::from_ref(first)].concat(), rest, steps);
        }
        if here.items.contains(first) {
            return Some(Target::File(here.file.clone()));
        }
        for import in here.imports.iter().filter(|i| i.name == *first) {
            match self.resolve(module, &import.path, steps) {
                Some(Target::Module(inner)) => return self.find(&inner, rest, steps),
                Some(file) => return Some(file),
                None => {}
            }
        }
        for import in here.imports.iter().filter(|i| i.name == "*") {
            if let Some(Target::Module(inner)) = self.resolve(module, &import.path, steps)
                && inner != module
                && let Some(target) = self.find(&inner, path, steps)
            {
                return Some(target);
            }
        }
        None
    }

    /// Each file with the files that it uses, and a path by which it does.
    fn edges(&self) -> BTreeMap<String, BTreeMap<String, String>> {
        const STEPS: usize = 32;
        let mut edges: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
        for (at, module) in &self.modules {
            let own = edges.entry(module.file.clone()).or_default();
            let mut add = |path: &[String]| {
                if let Some(Target::File(file)) = self.resolve(at, path, STEPS)
                    && file != module.file
                {
                    own.insert(file, path.join("::"));
                }
            };
            for import in &module.imports {
                if import.name == "*" {
                    for name in &module.names {
                        let all = [&import.path[..], std::slice::from_ref(name)].concat();
                        add(&all);
                    }
                } else if !import.public || module.names.contains(&import.name) {
                    add(&import.path);
                }
            }
            for path in &module.paths {
                add(path);
            }
        }
        edges
    }

    /// The groups of files that need each other, with the uses among them.
    fn circles(&self) -> Vec<String> {
        let edges = self.edges();
        let reach: BTreeMap<&String, BTreeSet<&String>> = edges
            .keys()
            .map(|start| {
                let mut seen = BTreeSet::new();
                let mut todo: Vec<&String> = edges[start].keys().collect();
                while let Some(file) = todo.pop() {
                    if seen.insert(file) {
                        todo.extend(edges[file].keys());
                    }
                }
                (start, seen)
            })
            .collect();
        let mut told = BTreeSet::new();
        let mut circles = Vec::new();
        for file in edges.keys().filter(|file| reach[*file].contains(file)) {
            if told.contains(file) {
                continue;
            }
            let both = |other: &&&String| reach[**other].contains(file);
            let circle: BTreeSet<&String> = reach[file].iter().filter(both).copied().collect();
            let mut text = String::new();
            for one in &circle {
                for (other, path) in edges[*one].iter().filter(|(f, _)| circle.contains(f)) {
                    text.push_str(&format!("\n    {one} -> {other}: {path}"));
                }
            }
            circles.push(format!("{} files need each other:{text}", circle.len()));
            told.extend(circle);
        }
        circles
    }
}

/// The index behind the group in brackets that begins here, or behind the token.
fn end_of_group(tokens: &[String], start: usize) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(start) {
        match token.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

/// The leaves of the tree of a `use` declaration.
fn leaves(tree: &[String], prefix: &[String], public: bool, found: &mut Vec<Import>) {
    let mut path = prefix.to_vec();
    let mut i = 0;
    while i < tree.len() {
        match tree[i].as_str() {
            "::" => {}
            "{" => {
                let end = end_of_group(tree, i) - 1;
                let mut start = i + 1;
                for k in i + 1..=end {
                    let inner = &tree[i + 1..k];
                    let count = |c: &str| inner.iter().filter(|t| *t == c).count();
                    let outermost = count("{") == count("}");
                    if k == end || (tree[k] == "," && outermost) {
                        leaves(&tree[start..k], &path, public, found);
                        start = k + 1;
                    }
                }
                return;
            }
            "*" => {
                let name = "*".to_owned();
                found.push(Import { path, name, public });
                return;
            }
            "as" => {
                let name = tree[i + 1].clone();
                found.push(Import { path, name, public });
                return;
            }
            // `self` stands for the path before it, but at the start.
            "self" if !path.is_empty() => {}
            segment => path.push(segment.to_owned()),
        }
        i += 1;
    }
    if let Some(name) = path.last().cloned() {
        found.push(Import { path, name, public });
    }
}

/// Reads a folder of sources whose root is this file.
fn read(root: &Path) -> Crate {
    let folder = root.parent().unwrap();
    let mut found = Crate::default();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(inner) = folders.pop() {
        for entry in fs::read_dir(&inner).unwrap() {
            let path = entry.unwrap().path();
            let below = path.strip_prefix(folder).unwrap();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if path.extension().is_none_or(|e| e != "rs") {
                continue;
            }
            let mut module: ModulePath = below
                .with_extension("")
                .iter()
                .map(|segment| segment.to_str().unwrap().to_owned())
                .collect();
            if path == root || module.last().is_some_and(|name| name == "mod") {
                module.pop();
            }
            let text = fs::read_to_string(&path).unwrap();
            let words = tokens(&text);
            let moved = words.windows(3).any(|w| w == ["#", "[", "path"]);
            // Tests may share a file with another crate's tests.
            let shares = folder.ends_with("tests/it");
            assert!(!moved || shares, "{below:?} names its modules' files");
            found.add(module, below.to_str().unwrap(), &text);
        }
    }
    found
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
    for root in roots {
        let found = read(&root);
        edges += found.edges().values().map(BTreeMap::len).sum::<usize>();
        let name = root.strip_prefix(&crates).unwrap().display();
        circles.extend(found.circles().iter().map(|c| format!("{name}: {c}")));
    }
    // A reader that finds no uses would find no circles either.
    assert!(edges > 500, "{edges}");
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}

fn made(files: &[(&str, &str)]) -> Vec<String> {
    let mut made = Crate::default();
    for (path, text) in files {
        let segments = path.split('/').filter(|s| !s.is_empty());
        made.add(segments.map(str::to_owned).collect(), path, text);
    }
    made.circles()
}

#[test]
fn circles_are_seen() {
    let circle = |files: &[(&str, &str)]| assert_eq!(made(files).len(), 1, "{files:?}");
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
    // In a module inside a file.
    circle(&[
        ("", "mod a; mod b;"),
        ("a", "mod inner { use super::super::b::B; } pub struct A;"),
        ("b", "use crate::a::A; pub struct B;"),
    ]);
}

#[test]
fn what_is_no_circle_is_let_pass() {
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
