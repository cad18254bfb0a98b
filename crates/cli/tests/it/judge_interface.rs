//! The public interfaces of `etalon-judge` and `etalon-assert`, as snapshots: a change of them is a change of version
//! (`crates/stability.md`).
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::house::root;
use std::fs;

/// Returns the public items of a formatted source: signatures of functions, fields, and variants of enums.
///
/// The workspace's lint `unreachable_pub` leaves `pub` to what other crates reach.
fn public_items(source: &str) -> Vec<String> {
    let source = source.split("\n#[cfg(test)]").next().unwrap_or_default();
    let mut lines = source.lines();
    let mut items = Vec::new();
    let mut block = String::new();
    while let Some(line) = lines.next() {
        if line.is_empty() {
            continue;
        }
        if !line.starts_with([' ', '}']) {
            let opens = line.starts_with("impl") || line.starts_with("pub struct");
            block = if opens {
                line.to_owned()
            } else {
                String::new()
            };
        }
        let indent = line.len() - line.trim_start().len();
        if !line.trim_start().starts_with("pub ") {
            continue;
        }
        let end = format!("{}}}", &line[..indent]);
        let mut text = line.trim().to_owned();
        let is_enum = text.starts_with("pub enum");
        // A signature has commas inside.
        let is_field = indent > 0 && !text.contains("fn ");
        while !(text.ends_with(['{', ';']) || is_field && text.ends_with(',')) {
            text = format!("{text} {}", lines.next().unwrap().trim());
        }
        if is_enum {
            let body = lines.by_ref().take_while(|line| *line != end);
            let variants = body
                .map(str::trim)
                .filter(|line| !line.starts_with(['/', '#']));
            text = format!("{text} {} }}", variants.collect::<Vec<_>>().join(" "));
        }
        let text = text.trim_end_matches(['{', ';', ',', ' ']);
        let owner = block.trim_end_matches([' ', '{']);
        items.push(if indent > 0 && !owner.is_empty() {
            format!("{owner}: {text}")
        } else {
            text.to_owned()
        });
    }
    items
}

#[test]
fn the_interfaces_are_as_recorded() {
    for name in ["judge", "assert"] {
        insta::assert_snapshot!(format!("{name}-interface"), listing(name));
    }
}

/// Returns the public items of a crate, by file.
fn listing(name: &str) -> String {
    let folder = root().join("crates").join(name).join("src");
    let mut names: Vec<String> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| !name.ends_with("_test.rs"))
        .collect();
    names.sort();
    let mut listing = String::new();
    for name in names {
        let items = public_items(&fs::read_to_string(folder.join(&name)).unwrap());
        if !items.is_empty() {
            listing += &format!("{name}\n  {}\n", items.join("\n  "));
        }
    }
    listing
}

#[test]
fn signatures_fields_and_variants_are_listed() {
    let source = "/// A.\npub struct A {\n    /// B.\n    pub b: u8,\n    c: u8,\n}\n\nimpl A {\n    pub fn d(\n        &self,\n        \
                  e: u8,\n    ) -> u8 {\n        0\n    }\n    pub(crate) fn f() {}\n}\n\npub enum G {\n    /// H.\n    H,\n    I { j: u8 },\n}\n\n\
                  pub const K: u8 = 1;\n#[cfg(test)]\nmod tests {\n    pub fn l() {}\n}\n";
    assert_eq!(
        public_items(source),
        [
            "pub struct A",
            "pub struct A: pub b: u8",
            "impl A: pub fn d( &self, e: u8, ) -> u8",
            "pub enum G { H, I { j: u8 }, }",
            "pub const K: u8 = 1",
        ]
    );
}
