//! Refuses query scopes that a scene cannot have.

use crate::error::At;
use etalon_frame::PathCommands;
use etalon_scene::{Draw, Pass, QueryScope, Scene};
use std::collections::BTreeSet;

/// Checks that a query scope changes something, and that a query over passes encloses whole passes.
pub(crate) fn check_queries(scene: &Scene) -> Result<(), At> {
    let scope = scene.query_scope;
    if scope == QueryScope::Draw {
        return Ok(());
    }
    let made = scene.on_path();
    let mut apart = made.clone().into_owned();
    apart.query_scope = QueryScope::Draw;
    let queries = made.queries();
    if queries.len() == apart.queries().len() {
        return Err(At::new("no query encloses more than one draw"));
    }
    if scope == QueryScope::Pass {
        return Ok(());
    }
    let named = |draw: &Draw| -> BTreeSet<usize> {
        let counters = draw.counters.iter().copied();
        counters
            .filter(|counter| queries.iter().any(|q| q.counter == *counter))
            .collect()
    };
    let is_whole = |pass: &Pass| {
        pass.draws
            .windows(2)
            .all(|two| named(&two[0]) == named(&two[1]))
    };
    if !made.passes.iter().all(is_whole) {
        return Err(At::new("the draws of a pass must use the same counters"));
    }
    if scene.path.commands == PathCommands::Several {
        return Err(At::new(
            "a query must end in the command buffer in which it began",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::resolve::parse_scene;
    use serde_json::{Value, json};

    /// Returns a scene of passes whose draws use these counters.
    fn scene(queries: &str, path: Value, passes: &[&[&[&str]]]) -> Value {
        let draw = |counters: &&[&str]| json!({ "mesh": { "kind": "full" }, "shader": "uniform_color", "counters": counters });
        let pass = |draws: &&[&[&str]]| json!({ "color": ["color"], "draws": draws.iter().map(draw).collect::<Vec<_>>() });
        json!({
            "attachments": { "color": { "format": "rgba8unorm" } },
            "passes": passes.iter().map(pass).collect::<Vec<_>>(),
            "read": ["color"],
            "counters": { "a": "samples-passed", "b": "samples-passed" },
            "queries": queries,
            "path": path,
        })
    }

    #[test]
    fn scopes_that_say_nothing_or_cut_passes_are_refused() {
        let single: &[&[&[&str]]] = &[&[&["a"], &["b"]]];
        let several: &[&[&[&str]]] = &[&[&["a"], &["a"], &["b"]]];
        let whole_passes: &[&[&[&str]]] = &[&[&["a"], &["a"]], &[], &[&["a"]]];
        for (queries, path, passes, message) in [
            (
                "pass",
                json!({}),
                single,
                "no query encloses more than one draw",
            ),
            (
                "frame",
                json!({}),
                single,
                "no query encloses more than one draw",
            ),
            (
                "frame",
                json!({}),
                several,
                "the draws of a pass must use the same counters",
            ),
            (
                "frame",
                json!({ "start": "draw" }),
                whole_passes,
                "the draws of a pass must use the same counters",
            ),
            (
                "frame",
                json!({ "commands": "several" }),
                whole_passes,
                "a query must end in the command buffer in which it began",
            ),
        ] {
            let error = parse_scene(&scene(queries, path, passes)).expect_err(message);
            assert_eq!(error.message, message);
        }
        for (queries, path, passes) in [
            ("draw", json!({}), single),
            ("pass", json!({ "commands": "several" }), several),
            ("frame", json!({ "commands": "secondary" }), whole_passes),
        ] {
            let parsed = parse_scene(&scene(queries, path, passes));
            assert!(parsed.is_ok(), "{queries}: {parsed:?}");
        }
    }
}
