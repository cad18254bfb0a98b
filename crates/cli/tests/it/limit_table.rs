//! The page of limits, held against the registry's list.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

#[test]
fn the_page_of_limits_names_each_limit_of_vulkan_once() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let page = fs::read_to_string(crates.join("limits.md")).unwrap();
    let part = page
        .split("## ")
        .find(|part| part.starts_with("Vulkan"))
        .unwrap();
    let list = fs::read_to_string(crates.join("vulkan/limits.txt")).unwrap();
    let limits: BTreeSet<&str> = list.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(limits.len() > 100);
    let rows = part.lines().filter_map(|line| line.strip_prefix("| `"));
    let cells = rows.filter_map(|row| row.split('|').next());
    let names: Vec<&str> = cells
        .flat_map(|cell| cell.split(['`', ',', ' ']))
        .filter(|name| limits.contains(name))
        .collect();
    let named: BTreeSet<&str> = names.iter().copied().collect();
    let missing: Vec<_> = limits.difference(&named).collect();
    assert!(missing.is_empty(), "not on the page: {missing:?}");
    assert_eq!(names.len(), named.len(), "a limit stands twice");
}
