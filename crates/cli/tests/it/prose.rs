//! Decisions read facts. `report` makes sentences last, and no source searches in one.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use std::fs;
use std::path::Path;
use syn::visit::{self, Visit};
use syn::{
    Arm, Attribute, BinOp, Expr, ExprBinary, ExprMethodCall, ItemFn, ItemMod, Lit, Member, Pat,
};

/// Methods that search a text for another.
const SEARCHES: [&str; 17] = [
    "contains",
    "starts_with",
    "ends_with",
    "strip_prefix",
    "strip_suffix",
    "split_once",
    "rsplit_once",
    "find",
    "rfind",
    "matches",
    "trim_start_matches",
    "trim_end_matches",
    "eq_ignore_ascii_case",
    "replace",
    "replacen",
    "split",
    "splitn",
];

/// Fields and variables that hold what the suite wrote for people.
const WRITTEN: [&str; 7] = [
    "about",
    "clause",
    "detail",
    "headline",
    "message",
    "predicate",
    "sentence",
];

/// Allowed searches, in texts that other programs wrote, with their files.
const FOREIGN: [(&str, &str, &str); 12] = [
    ("gl/src/context.rs", "OpenGL ES ", "GL_VERSION"),
    ("gl/src/context.rs", "(Core Profile) ", "GL_VERSION"),
    ("case/src/error.rs", " at line ", "serde_json's position"),
    ("record/src/json.rs", " at line ", "serde_json's position"),
    (
        "record/src/driver_version.rs",
        "Mesa ",
        "a driver's description",
    ),
    ("wgpu/src/messages.rs", "unable to find layer", "wgpu's log"),
    ("wgpu/src/messages.rs", "GLES: ", "wgpu's log"),
    (
        "gl/src/program.rs",
        "gl_SampleMask = ",
        "GLSL that naga writes",
    ),
    ("gl/src/program.rs", "{name} = ", "GLSL that naga writes"),
    ("gl/src/own_pass.rs", "void main()", "GLSL that naga writes"),
    (
        "gl/src/own_pass.rs",
        "texelFetch({name}, ",
        "GLSL that naga writes",
    ),
    ("runner/src/bench/clock.rs", "cpu MHz", "/proc/cpuinfo"),
];

/// Finds searches of prose in one file, outside its tests.
struct Finder<'a> {
    path: &'a str,
    found: Vec<String>,
}

impl Finder<'_> {
    fn is_test(attributes: &[Attribute]) -> bool {
        let gate = |a: &Attribute| {
            let tokens = a.meta.require_list().map(|list| list.tokens.to_string());
            a.path().is_ident("test")
                || a.path().is_ident("cfg") && tokens.is_ok_and(|t| t == "test")
        };
        attributes.iter().any(gate)
    }

    fn is_foreign(&self, text: &str) -> bool {
        FOREIGN
            .iter()
            .any(|(file, foreign, _)| self.path.ends_with(file) && *foreign == text)
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if !Self::is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_fn(&mut self, function: &'ast ItemFn) {
        if !Self::is_test(&function.attrs) {
            visit::visit_item_fn(self, function);
        }
    }

    fn visit_expr_method_call(&mut self, call: &'ast ExprMethodCall) {
        let method = call.method.to_string();
        if SEARCHES.contains(&method.as_str()) {
            let text = call.args.first().and_then(text_of);
            let prose = text.as_deref().is_some_and(is_prose);
            let written = name_of(&call.receiver).is_some_and(|n| WRITTEN.contains(&n.as_str()));
            let foreign = text.as_deref().is_some_and(|t| self.is_foreign(t));
            if (prose || written && call.args.first().is_some_and(is_text)) && !foreign {
                let text = text.unwrap_or_default();
                self.found
                    .push(format!("{}: .{method}({text:?})", self.path));
            }
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_expr_binary(&mut self, binary: &'ast ExprBinary) {
        if matches!(binary.op, BinOp::Eq(_) | BinOp::Ne(_)) {
            self.compare([&binary.left, &binary.right]);
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_arm(&mut self, arm: &'ast Arm) {
        for text in texts(&arm.pat).into_iter().filter(|text| is_prose(text)) {
            self.found.push(format!("{}: match {text:?}", self.path));
        }
        visit::visit_arm(self, arm);
    }
}

/// Returns the texts of a pattern that are alternatives.
fn texts(pattern: &Pat) -> Vec<String> {
    match pattern {
        Pat::Or(alternatives) => alternatives.cases.iter().flat_map(texts).collect(),
        Pat::Lit(literal) => match &literal.lit {
            Lit::Str(text) => vec![text.value()],
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

impl Finder<'_> {
    /// Records a comparison with a text that is more than a name, or of a value that was written for people.
    fn compare(&mut self, sides: [&Expr; 2]) {
        for (text, other) in [(sides[0], sides[1]), (sides[1], sides[0])] {
            let Some(text) = text_of(text).filter(|text| !text.is_empty()) else {
                continue;
            };
            let written = name_of(other).is_some_and(|n| WRITTEN.contains(&n.as_str()));
            if (is_prose(&text) || written) && !self.is_foreign(&text) {
                self.found.push(format!("{}: == {text:?}", self.path));
            }
        }
    }
}

/// Returns true if a text is more than a name: it has letters and a space.
fn is_prose(text: &str) -> bool {
    text.contains(' ') && text.chars().any(char::is_alphabetic)
}

/// Returns true if an argument can be a text; a closure searches for something else.
fn is_text(argument: &Expr) -> bool {
    !matches!(argument, Expr::Closure(_))
}

fn text_of(argument: &Expr) -> Option<String> {
    match argument {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Str(text) => Some(text.value()),
            _ => None,
        },
        Expr::Reference(reference) => text_of(&reference.expr),
        Expr::Macro(format) => {
            let tokens = format.mac.tokens.to_string();
            Some(tokens.split('"').nth(1)?.to_owned())
        }
        _ => None,
    }
}

/// Returns the name of the field, the variable or the getter that a method is called on.
fn name_of(receiver: &Expr) -> Option<String> {
    match receiver {
        Expr::Path(path) => path.path.get_ident().map(ToString::to_string),
        Expr::Field(field) => match &field.member {
            Member::Named(name) => Some(name.to_string()),
            Member::Unnamed(_) => None,
        },
        Expr::MethodCall(call) if call.args.is_empty() => match call.method.to_string().as_str() {
            "as_str" | "as_deref" | "unwrap_or_default" | "to_lowercase" | "clone" => {
                name_of(&call.receiver)
            }
            getter => Some(getter.to_owned()),
        },
        Expr::Reference(reference) => name_of(&reference.expr),
        Expr::Paren(inner) => name_of(&inner.expr),
        _ => None,
    }
}

/// Reads the sources of all crates, without files that only tests have.
fn sources() -> Vec<(String, String)> {
    fn read(folder: &Path, sources: &mut Vec<(String, String)>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && !path.ends_with("tests") {
                read(&path, sources);
            } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("tests.rs") {
                let name = path.display().to_string().replace('\\', "/");
                sources.push((name, fs::read_to_string(&path).unwrap()));
            }
        }
    }
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut sources = Vec::new();
    for entry in fs::read_dir(crates).unwrap() {
        let folder = entry.unwrap().path().join("src");
        if folder.is_dir() {
            read(&folder, &mut sources);
        }
    }
    assert!(sources.len() > 500, "{} files", sources.len());
    sources
}

fn searches(path: &str, text: &str) -> Vec<String> {
    let file = syn::parse_file(text).unwrap_or_else(|e| panic!("{path}: {e}"));
    let mut finder = Finder {
        path,
        found: Vec::new(),
    };
    finder.visit_file(&file);
    finder.found
}

#[test]
fn no_source_searches_what_the_suite_wrote_for_people() {
    let found: Vec<String> = sources()
        .iter()
        .flat_map(|(path, text)| searches(path, text))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn every_exception_is_in_use() {
    let sources = sources();
    for (file, foreign, why) in FOREIGN {
        let (_, text) = sources
            .iter()
            .find(|(path, _)| path.ends_with(file))
            .unwrap();
        assert!(text.contains(&format!("{foreign:?}")), "{file}: {why}");
    }
}

#[test]
fn searches_of_sentences_are_found() {
    let refused = [
        r#"fn f(r: &Record) -> bool { r.message.contains("kept") }"#,
        r#"fn f(s: &str) -> bool { s.ends_with(" is true") }"#,
        r#"fn f(s: &str) -> bool { s.contains(&format!("{} still holds", 1)) }"#,
        r#"fn f(r: &Line, a: &str) -> bool { r.detail.as_str().starts_with(a) }"#,
        r#"fn f(s: &str) -> bool { s == "not reduced" }"#,
        r#"fn f(r: &Line) -> bool { "slower" != r.headline }"#,
        r#"fn f(s: &str) -> u8 { match s { "a b" | "c" => 1, _ => 0 } }"#,
        r#"fn f(s: &str) -> String { s.replace(" and more", "") }"#,
    ];
    for text in refused {
        assert_eq!(searches("a.rs", text).len(), 1, "{text}");
    }
    let allowed = [
        r#"fn f(s: &str) -> bool { s.contains("$") || s.starts_with("perf/") }"#,
        r#"fn f(v: &[u32]) -> bool { v.contains(&3) }"#,
        r#"#[cfg(test)] mod tests { fn f(s: &str) -> bool { s.contains("a b") } }"#,
    ];
    for text in allowed {
        assert!(searches("a.rs", text).is_empty(), "{text}");
    }
}
